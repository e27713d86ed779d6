"""How far the feet of a captured movement slide while they bear: what an animator sees as skating.

Said of the file's own feet, in its own size, before anything is pinned. Where one foot is on the
floor it bears; where both are, one that is at rest bears, and one that slides beside it is drawn
along, as in a tendu or a glissade, which is no fault; so is the tip of the toes that touches beside
another foot. Where both slide, both skate.

A foot is followed by what of it is on the floor: heel, tip, or ball; of the ball by the one of
several readings (toe joint, ankle, and the ankle with the foot's heading and pitch) that slides
least, since captured toes swim under feet that stand.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from enpointe.models.anatomy import SIDES
from enpointe.motion.retargeting.body import NONE, TIP
from enpointe.motion.retargeting.floor import Steps
from enpointe.motion.retargeting.holding import runs

__all__ = ["slides"]

Array = NDArray[np.float64]
_ARRIVED = 0.3
"""m/s: a foot that has once been slower has arrived, and until it is last so has not left."""


def slides(steps: Mapping[str, Steps], time: Array) -> dict[str, Array]:
    """By side, (T,), how far a bearing foot is from where it came to stand, m; 0 if none bears.

    Args:
        steps: What each foot does on the floor.
        time: (T,), s.
    """
    found = {}
    for side, other in zip(SIDES, reversed(SIDES), strict=True):
        mine, beside = steps[side], steps[other]
        carries = (mine.kind != NONE) & ((mine.kind != TIP) | (beside.kind == NONE))
        bears = carries & (mine.still | ~((beside.kind != NONE) & beside.still))
        found[side] = np.zeros(len(time))
        for kind, readings in mine.readings.items():
            for run in runs(bears & (mine.kind == kind)):
                ways = [_slid(reading[run, :2], time[run]) for reading in readings]
                found[side][run] = min(ways, key=lambda way: float(way.max()))
    return found


def _slid(place: Array, time: Array) -> Array:
    """(K,), how far a point is from where it arrived, m; 0 before, and once it leaves."""
    way = np.zeros(len(place))
    if len(place) < 2:
        return way
    speed = np.linalg.norm(np.gradient(place, time, axis=0), axis=1)
    slow = np.flatnonzero(speed < _ARRIVED)
    first, last = (int(slow[0]), int(slow[-1])) if len(slow) else (0, len(place) - 1)
    way[first : last + 1] = np.linalg.norm(place[first : last + 1] - place[first], axis=1)
    return way
