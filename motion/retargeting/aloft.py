"""Which times in the air are flights: those in which the body falls.

Captured feet are often too high for the floor that they stand on, above all on demi-pointe and in
turns. But a body that nothing bears falls, and one that a foot bears does not; so where no foot is
near the floor, the body's weight says whether it flies.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from enpointe.models.anatomy import SIDES
from enpointe.models.anthropometry import Anthropometry
from enpointe.motion.gravity import GRAVITY
from enpointe.motion.retargeting.holding import runs

__all__ = ["flying", "thrown", "weight_centre"]

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]
_FALLS = 0.7
"""Share of gravity with which whoever flies falls at least: what is captured of the weight is good
to a third or so over a short flight."""
_SHORTEST, _RISE = 0.1, 0.008
"""s and m: whoever flies for less, or rises by less, was not seen to fly."""
_MOST = 0.6
"""Share of a time without a foot near the floor that a flight fills at least; the rest is its feet
seen too late or left too early."""
_TOLD = 0.25
"""Share of gravity by which the fall of a flight must differ to be told from free fall: those of
ten leaps of one dancer (CMU's subject 05) scatter by 14 per cent about it."""
_LIMBS = {
    "upper_arm": ("shoulder", "elbow"),
    "forearm": ("elbow", "wrist"),
    "hand": ("wrist", "hand"),
    "thigh": ("hip", "knee"),
    "shank": ("knee", "ankle"),
    "foot": ("ankle", "toe"),
}


def weight_centre(points: Mapping[str, Array]) -> Array:
    """About where the centre of mass of a captured body is, (T, 3), m.

    Masses and their places along the limbs are de Leva's (1996); a trunk and a head are taken
    between hips, shoulders and head.
    """
    who = Anthropometry()
    hips = 0.5 * (points["left_hip"] + points["right_hip"])
    sums, mass = np.zeros_like(hips), 0.0
    for side in SIDES:
        for name, (start, end) in _LIMBS.items():
            if f"{side}_{start}" not in points or f"{side}_{end}" not in points:
                continue
            part = who.segment(name)
            share = part.com / part.length
            one, other = points[f"{side}_{start}"], points[f"{side}_{end}"]
            sums += part.mass * (one + share * (other - one))
            mass += part.mass
    trunk = sum(who.segment(f"{part}_trunk").mass for part in ("upper", "middle", "lower"))
    if "left_shoulder" in points and "right_shoulder" in points:
        top = 0.5 * (points["left_shoulder"] + points["right_shoulder"])
    else:
        top = next((points[name] for name in ("neck", "chest", "head") if name in points), hips)
    head = who.segment("head").mass
    sums += trunk * 0.5 * (hips + top) + head * points.get("head", top)
    return np.asarray(sums / (mass + trunk + head))


def flying(time: Array, height: Array, aloft: Mask) -> Mask:
    """Of the times without a foot near the floor, those in which the body falls.

    Args:
        time: (T,), s, evenly spaced.
        height: (T,), of the centre of mass, m.
        aloft: (T,), without a foot near the floor.
    """
    flies = np.zeros_like(aloft)
    shortest = max(round(_SHORTEST / float(time[1])), 4)
    for run in runs(aloft):
        least = max(shortest, round(_MOST * (run.stop - run.start)))
        found = _longest_fall(time[run], height[run], least)
        if found is not None:
            flies[run.start + found.start : run.start + found.stop] = True
    return flies


def thrown(time: Array, com: Array, aloft: Mask, scale: float) -> dict[int, Array]:
    """Where a centre of mass is in its flights, (3,), m, by sample: each on a parabola.

    Nothing but gravity moves it there; what is off the parabola that fits best was badly captured.
    Over the line between its ends, which is as drawn, it falls with gravity where the capture can't
    be told from that: limbs of another size move in the times of the capture. Where a movement
    floats, or drops, the parabola is its own.

    Args:
        time: (T,), s, evenly spaced.
        com: (T, 3), m, as drawn.
        aloft: (T,), without a foot on the floor.
        scale: Size of the body over that of the captured one.
    """
    places = {}
    for run in runs(flying(time, com[:, 2] / scale, aloft)):
        whole = float(time[run.stop - 1] - time[run.start])
        t = (time[run] - time[run.start]) / whole
        level = np.column_stack([np.ones_like(t), t])
        curved = np.column_stack([level, t * (t - 1.0)])
        way = level @ np.linalg.lstsq(level, com[run, :2], rcond=None)[0]
        start, slope, bend = np.linalg.lstsq(curved, com[run, 2], rcond=None)[0]
        free = -0.5 * GRAVITY * whole**2
        own = bend / scale
        height = curved @ [start, slope, free if abs(own / free - 1.0) < _TOLD else own]
        for i, place, z in zip(range(run.start, run.stop), way, height, strict=True):
            places[i] = np.array([*place, z])
    return places


def _longest_fall(time: Array, height: Array, least: int) -> slice | None:
    """The longest stretch of samples, of `least` or more, that falls as whoever flies does."""
    for count in range(len(time), least - 1, -1):
        falls = {}
        for start in range(len(time) - count + 1):
            span = slice(start, start + count)
            t, z = time[span] - time[start], height[span]
            fall = float(-2.0 * np.polyfit(t, z, 2)[0])
            if fall > _FALLS * GRAVITY and float(z.max() - z[0]) > _RISE:
                falls[start] = fall
        if falls:
            best = max(falls, key=lambda start: falls[start])
            return slice(best, best + count)
    return None
