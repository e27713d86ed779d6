"""How far and how much: the ranges that every form of a score keeps to."""

from __future__ import annotations

__all__ = [
    "DEFAULT_DEGREES",
    "HEIGHTS",
    "MAX_CURVE",
    "MAX_DEGREES",
    "MAX_METRES",
    "MAX_TIMES",
    "MAX_TURN",
    "TEMPO_FACTORS",
    "WIDTHS",
]

HEIGHTS = (1.0, 6.0)
"""Lowest and highest sign, in stave lines: the floor, and a stretched wrist overhead (signs.py)."""

WIDTHS = (-1.0, 1.0)
"""Widest crossed and open sign: nothing reaches further than its full reach."""

MAX_DEGREES = 90.0
"""Largest turn, tilt or bend of head, body or pelvis; the models know a body's own limits."""

DEFAULT_DEGREES = {
    ("head", "turn"): 45.0,
    ("head", "tilt"): 15.0,
    ("head", "bend"): 15.0,
    ("body", "turn"): 15.0,
    ("body", "tilt"): 10.0,
    ("body", "bend"): 10.0,
    ("pelvis", "turn"): 10.0,
    ("pelvis", "tilt"): 10.0,
    ("pelvis", "bend"): 10.0,
}
"""Degrees meant by a direction without an amount. The signs give a direction only, and Neagle (2005
§4.4.5) took each joint's limit; no source prints amounts for ballet. These are ours, modest
ones."""

MAX_METRES = 50.0
"""Furthest place and longest way; the largest stages are some 25 m across."""

MAX_CURVE = 360.0
"""Most that a path on the stage turns on its way to one frame, degrees."""

MAX_TURN = 3600.0
"""Most that a dancer turns on the way to one frame, degrees: ten pirouettes."""

MAX_TIMES = 32
"""Most times more that a repeat is danced."""

TEMPO_FACTORS = (0.1, 10.0)
"""Least and most that a phrase slows or quickens to."""
