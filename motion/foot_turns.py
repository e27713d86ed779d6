"""How a standing foot turns: as little as its play lets it."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import find_objects, label

from enpointe.motion.averaging import averaged

__all__ = ["held_headings", "turned_about"]

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]
PLAY = np.radians(25.0)
"""rad, to either side: a captured foot that turns by less while it stands is taken not to turn, as
the hip can make up for it. People turn on feet that they hardly load; a sole that carries the body
is held by the floor's friction, with some 40 N m where it is flat."""
_SMOOTH = 0.2
"""s: what turns farther is averaged over this window."""


def held_headings(heading: Array, stands: Mask, rate: float) -> Array:
    """Headings (T,) of a foot that turns in a stance only where it must, to be within its play.

    Args:
        heading: As captured, rad, without jumps of a turn.
        stands: (T,).
        rate: Samples per second.
    """
    held = heading.copy()
    for (stance,) in find_objects(label(stands)[0]):
        own = heading[stance]
        middle = 0.5 * (float(own.min()) + float(own.max()))
        if np.ptp(own) <= 2 * PLAY:
            held[stance] = middle
            continue
        now, followed = float(np.clip(middle, own[0] - PLAY, own[0] + PLAY)), []
        for each in own.tolist():
            now = min(max(now, each - PLAY), each + PLAY)
            followed.append(now)
        held[stance] = averaged(np.array(followed)[:, None], _SMOOTH, rate)[:, 0]
    return held


def turned_about(points: Array, centres: Array, angles: Array) -> Array:
    """Points (T, N, 3) turned about the vertical through centres (T, 2) by angles (T,), rad."""
    cosine, sine = np.cos(angles)[:, None], np.sin(angles)[:, None]
    x, y = (points[:, :, axis] - centres[:, None, axis] for axis in (0, 1))
    turned = points.copy()
    turned[:, :, 0] = centres[:, None, 0] + cosine * x - sine * y
    turned[:, :, 1] = centres[:, None, 1] + sine * x + cosine * y
    return turned
