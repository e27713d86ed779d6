"""The floor under a captured body, and when its feet are on it."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from enpointe.models.anatomy import SIDES
from enpointe.motion.averaging import averaged
from enpointe.motion.contact_schedule import without_chatter
from enpointe.motion.retargeting.body import BALL, HEEL, NONE, TIP, Body
from enpointe.motion.retargeting.holding import hysteresis, runs
from enpointe.motion.retargeting.source import Source, flat_samples

__all__ = ["Steps", "levelled", "steps_of"]

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]
_LOWEST = 2.0
"""Per cent of the samples that may be noise below the floor."""
_NEAR, _SLOW = 0.05, 0.2
"""m over the lowest, and m/s: samples that say how the floor slopes."""
_STIFF = 0.3
"""How far apart, m, these must lie for a slope to be believed half (a ridge on its two numbers)."""
_ON, _OFF = 0.02, 0.045
"""m above where it stands: nearer than the first a ball is on the floor, until past the second."""
_END_ON, _END_OFF = 0.012, 0.03
"""The same of heel and tip, which are where the foot's own frame puts them."""
_STILL, _MOVING = 0.10, 0.25
"""m/s: slower than the first a foot stands, until it is faster than the second."""
_WANDER = 0.025
"""m: a foot that is farther than this from where it stood has slid there, however slowly."""
_WINDOW = 0.06
"""Speeds are averaged over this, s."""
_POINTED = np.radians(35.0)
"""A foot steeper than this may touch with its tip alone."""
_BIAS = np.radians(20.0)
"""A foot's frame is set right by at most this where it should be flat."""


@dataclass(frozen=True)
class Steps:
    """What one foot does on the floor.

    Attributes:
        kind: (T,), NONE, BALL, HEEL or TIP.
        still: (T,), whether it stands there: neither slides nor is about to leave.
        turn: (T, 3, 3), the foot's frame, set right where it is flat.
    """

    kind: NDArray[np.int8]
    still: Mask
    turn: Array


def levelled(source: Source) -> Source:
    """The same movement over a floor at height 0 (at the toe joints), level.

    The floor is a plane: its height a low percentile of those of the toe joints, its slope what
    standing feet say, held back where they stand close together.
    """
    toes = [source.points[f"{side}_toe"] for side in SIDES]
    low = min(float(np.percentile(toe[:, 2], _LOWEST)) for toe in toes)
    stood = []
    for toe in toes:
        speed = np.linalg.norm(np.gradient(toe, source.time, axis=0), axis=1)
        stood.append(toe[(speed < _SLOW) & (toe[:, 2] < low + _NEAR)])
    points = np.concatenate(stood)
    slope, middle = np.zeros(2), np.zeros(2)
    if len(points) > 2:
        middle = points[:, :2].mean(axis=0)
        out = points[:, :2] - middle
        rise = points[:, 2] - points[:, 2].mean()
        stiff = len(out) * _STIFF**2 * np.eye(2)
        slope = np.linalg.solve(out.T @ out + stiff, out.T @ rise)
    over = {name: _over(place, slope, middle) for name, place in source.points.items()}
    lowest = min(float(np.percentile(over[f"{side}_toe"][:, 2], _LOWEST)) for side in SIDES)
    raised = {name: place - [0.0, 0.0, lowest] for name, place in over.items()}
    return replace(source, points=raised)


def _over(place: Array, slope: Array, middle: Array) -> Array:
    level = place.copy()
    level[:, 2] -= (place[:, :2] - middle) @ slope
    return level


def steps_of(source: Source, body: Body, side: str, scale: float) -> Steps:
    """Contacts of one foot, from heights and speeds.

    Args:
        source: Levelled.
        body: Whose foot gives the heel and the tip that the source does not have.
        side: "left" or "right".
        scale: Size of the body over that of the source.
    """
    toe, foot = source.points[f"{side}_toe"], body.feet[side]
    turn = _flat(source, side)
    pitch = -np.arcsin(np.clip(turn[:, 2, 0], -1.0, 1.0))
    # A foot on demi-pointe, or beside a partner's weight, lowers its own toe joint by a little.
    ball = toe[:, 2] - min(float(np.percentile(toe[:, 2], _LOWEST)), _ON)
    heel = toe - turn[:, :, 0] * foot.span / scale
    tip = toe + turn[:, :, 0] * foot.toes / scale
    off = ball - toe[:, 2]
    on_ball = hysteresis(ball < _ON, ball < _OFF)
    on_heel = (pitch < 0) & hysteresis(heel[:, 2] + off < _END_ON, heel[:, 2] + off < _END_OFF)
    on_tip = (pitch > _POINTED) & hysteresis(tip[:, 2] + off < _END_ON, tip[:, 2] + off < _END_OFF)
    kind = np.where(
        on_ball & (pitch >= 0), BALL, np.where(on_heel, HEEL, np.where(on_tip, TIP, NONE))
    )
    kind = np.where(on_ball & (kind == NONE), BALL, kind)
    period = float(source.time[1])
    down = without_chatter((kind != NONE)[:, None], period)[:, 0]
    kind = np.where(down, np.where(kind == NONE, BALL, kind), NONE).astype(np.int8)
    places = {BALL: toe, HEEL: heel, TIP: tip}
    still = np.zeros(len(toe), dtype=bool)
    for each, place in places.items():
        still |= _standing(place, kind == each, source)
    return Steps(kind, still, turn)


def _standing(place: Array, mine: Mask, source: Source) -> Mask:
    smooth = averaged(place[:, :2], _WINDOW, source.rate)
    speed = np.linalg.norm(np.gradient(smooth, source.time, axis=0), axis=1)
    still = hysteresis(mine & (speed < _STILL), mine & (speed < _MOVING))
    for run in runs(still):
        away = np.linalg.norm(smooth[run] - np.median(smooth[run], axis=0), axis=1)
        still[run] &= away < _WANDER
    return np.asarray(without_chatter(still[:, None], float(source.time[1]))[:, 0] & mine)


def _flat(source: Source, side: str) -> Array:
    """A foot's frame, turned so that it lies flat where the foot must."""
    turn = source.frames[f"{side}_foot"]
    flat = flat_samples(source.points[f"{side}_ankle"], source.rate)
    up = np.median(turn[flat][:, 2, :], axis=0)
    up /= np.linalg.norm(up)
    angle = np.arccos(np.clip(up[2], -1.0, 1.0))
    if not 1e-6 < angle < _BIAS:
        return turn
    axis = np.cross(up, [0.0, 0.0, 1.0])
    right = Rotation.from_rotvec(axis / np.linalg.norm(axis) * angle).as_matrix()
    return np.asarray(turn @ right.T)
