"""What everything falls with."""

from __future__ import annotations

__all__ = ["GRAVITY"]

GRAVITY = 9.81
"""m/s^2, downwards, as MuJoCo has it."""
