"""The physical stage: a body under gravity and contact, what it measures, and pictures of it.

Import from the modules themselves: the painters must choose OpenGL's library before MuJoCo loads.
"""
