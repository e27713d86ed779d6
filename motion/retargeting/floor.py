"""The floor under a captured body, and when its feet are on it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from enpointe.models.anatomy import SIDES
from enpointe.motion.averaging import averaged
from enpointe.motion.contact_schedule import without_chatter
from enpointe.motion.retargeting.aloft import flying, weight_centre
from enpointe.motion.retargeting.body import BALL, HEEL, NONE, TIP, Body, Foot
from enpointe.motion.retargeting.heading import headings
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
"""m above where it stands: nearer than the first a toe joint is on the floor, until past the
second."""
_FLAT_ON, _FLAT_OFF = 0.012, 0.03
"""The same of an ankle over a flat foot, of a heel and of the tip of the toes."""
_RESTS, _SKIMS = 0.3, 0.4
"""A foot faster than the first, m/s, must be nearer to the floor, by the second, to be on it."""
_MARGIN = 0.01
"""m: an ankle higher than the foot is long, by more than this, has no ball of a foot on the floor
under it."""
_BADLY = 0.12
"""m: a foot that seems no higher than this bears where the body's weight says that one does."""
_HEEL_ROLLS = 0.25
"""s: nobody stands on a heel alone for longer; whoever seems to has a badly captured foot."""
_ROLLS = 0.06
"""s: a foot takes so long to roll from heel to ball."""
_STILL, _MOVING = 0.12, 0.30
"""m/s: slower than the first a foot stands, until it is faster than the second."""
_WANDER = 0.025
"""m: a foot that is farther than this from where it stood has slid there, however slowly."""
_SPINS, _PIVOT = 2.0, 3.0
"""rad/s, and how much more of the last three a foot that turns faster than that may have."""
_WINDOW = 0.15
"""Speeds are averaged over this, s."""
_POINTED, _HEELED = np.radians(35.0), np.radians(8.0)
"""A foot steeper than the first may touch with its tip alone, with its toes up by more than the
second with its heel alone."""
_BIAS = np.radians(20.0)
"""A foot's frame is set right by at most this where it should be flat."""
_STEEPEST = 0.995
"""Sine: an ankle straight over the ball says nothing more about the foot's pitch."""
_ON_POINTE = np.radians(80.0)
"""The steepest foot whose toes still lie on the floor."""


@dataclass(frozen=True)
class Steps:
    """What one foot does on the floor.

    Attributes:
        kind: (T,), NONE, BALL, HEEL or TIP.
        still: (T,), whether it stands there: neither slides nor is about to leave.
        turn: (T, 3, 3), the foot's frame.
        pitch: (T,), how far it points down if it is on the floor, rad: as high as its ankle is.
        heading: (T,), where it points, rad.
        readings: Of each kind, several of where that of the foot is, (T, 3) each, m, as captured.
    """

    kind: NDArray[np.int8]
    still: Mask
    turn: Array
    pitch: Array
    heading: Array
    readings: Mapping[int, tuple[Array, ...]]


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


def steps_of(source: Source, body: Body, scale: float) -> dict[str, Steps]:
    """Contacts of both feet, from heights and speeds.

    Captured feet are the worst of a capture: toe joints rise from the floor under people who stand
    on them. Ankles are good. So a foot is on the floor where its toe joint is low, or its ankle as
    low as over a flat foot; or where its ankle rests within reach of the floor and no other foot
    carries; or where neither foot seems to be, yet the body does not fall, and it is the lower.
    How far its heel is up, its ankle's height says.

    Args:
        source: Levelled.
        body: Whose feet give what the source does not have.
        scale: Size of the body over that of the source.
    """
    feet = {side: _Seen(source, body.feet[side], side, scale) for side in SIDES}
    sure = {side: foot.on_floor() for side, foot in feet.items()}
    down = {
        side: sure[side] | (feet[side].rests() & ~sure[other])
        for side, other in zip(SIDES, reversed(SIDES), strict=True)
    }
    aloft = ~np.logical_or(*down.values())
    flies = flying(source.time, weight_centre(source.points)[:, 2], aloft)
    heights = np.array([foot.height() for foot in feet.values()])
    lowest = np.argmin(heights, axis=0)
    return {
        side: feet[side].steps(
            down[side] | (aloft & ~flies & (lowest == i) & (heights[i] < _BADLY)), flies
        )
        for i, side in enumerate(SIDES)
    }


class _Seen:
    """One foot as it was captured."""

    def __init__(self, source: Source, foot: Foot, side: str, scale: float) -> None:
        self._source, self._foot, self._scale = source, foot, scale
        self._toe, self._ankle = source.points[f"{side}_toe"], source.points[f"{side}_ankle"]
        levels = [np.percentile(source.points[f"{s}_ankle"][:, 2], _LOWEST) for s in SIDES]
        own = float(np.percentile(self._ankle[:, 2], _LOWEST))
        self._over = self._ankle[:, 2] - min(own, float(min(levels)) + _FLAT_ON)
        low = min(float(np.percentile(self._toe[:, 2], _LOWEST)), _ON)
        self._toe_over = self._toe[:, 2] - low
        self._length = float(np.median(np.linalg.norm(self._toe - self._ankle, axis=1)))
        level = float(
            np.median((self._ankle[:, 2] - self._over) - (self._toe[:, 2] - self._toe_over))
        )
        self._rise = float(np.clip(level, 0.0, 0.8 * self._length))
        self._reached = self._over < self._length - self._rise + _MARGIN
        self._turn = _flat(source, side)
        self._pitch = _pitch(self._turn)
        self._heading = headings(source, side, self._turn)

    def on_floor(self) -> Mask:
        """Where its heights leave no doubt."""
        toe = self._down(self._toe, self._toe_over, _ON, _OFF) & self._reached
        ankle = self._down(self._ankle, self._over, _FLAT_ON, _FLAT_OFF)
        return np.asarray(toe | ankle)

    def _down(self, place: Array, over: Array, on: float, off: float) -> Mask:
        """Where a point is low: noise may lift one that rests, but none that moves."""
        rests = self._speed(place) < _RESTS
        surely = (over < on) & rests | (over < _SKIMS * on)
        return hysteresis(surely, (over < off) & rests | (over < _SKIMS * off))

    def rests(self) -> Mask:
        """Where it may carry: its ankle is low enough, and moves little."""
        speed = self._speed(self._ankle)
        near = self._reached
        return hysteresis(near & (speed < _STILL), near & (speed < _MOVING))

    def height(self) -> Array:
        """How high over the floor it seems to be, (T,), m."""
        lowest = np.minimum(self._over, self._toe_over)
        return np.asarray(averaged(lowest[:, None], _WINDOW, self._source.rate)[:, 0])

    def steps(self, on_ball: Mask, flies: Mask) -> Steps:
        source, period = self._source, float(self._source.time[1])
        forward = self._turn[:, :, 0]
        heel = self._toe - forward * self._foot.span / self._scale
        tip = self._toe + forward * self._foot.toes / self._scale
        heel_over, tip_over = (
            point[:, 2] + self._toe_over - self._toe[:, 2] for point in (heel, tip)
        )
        on_heel = (self._pitch < -_HEELED) & (heel_over < _FLAT_ON) & ~on_ball
        on_heel = self._rolling(on_heel, on_ball)
        pointed = ~on_ball & (self._pitch > _POINTED)
        on_tip = pointed & hysteresis(tip_over < _FLAT_ON, tip_over < _FLAT_OFF)
        kind = np.select([flies, on_ball, on_heel, on_tip], [NONE, BALL, HEEL, TIP], NONE)
        down = without_chatter((kind != NONE)[:, None], period)[:, 0]
        kind = _lasting(kind, down, period)
        pitch = np.where((kind == HEEL) | (kind == TIP), self._pitch, self._on_ball())
        pitch = averaged(pitch[:, None], _ROLLS, source.rate)[:, 0]
        lain = Rotation.from_euler("ZY", np.stack([self._heading, pitch], axis=1))
        ball = self._ankle + lain.apply(self._foot.ball / self._scale)
        spins = np.abs(np.gradient(averaged(self._heading[:, None], _WINDOW, source.rate)[:, 0]))
        spins = spins * source.rate > _SPINS
        still = np.zeros(len(kind), dtype=bool)
        readings = {BALL: (ball, self._toe, self._ankle), HEEL: (heel,), TIP: (tip,)}
        for each, places in readings.items():
            still |= _standing(places, kind == each, source, spins)
        # A tip that only brushes the floor is kept out of it, and not to it.
        brushes = (kind == TIP) & ~hysteresis(still & (kind == TIP), kind == TIP)
        kind = np.where(brushes, NONE, kind).astype(np.int8)
        return Steps(kind, still, self._turn, pitch, self._heading, readings)

    def _rolling(self, on_heel: Mask, on_ball: Mask) -> Mask:
        """Heels that strike before the ball does, or leave after it, and are soon over."""
        rolls = on_heel.copy()
        for run in runs(on_heel):
            soon = run.stop - run.start <= _HEEL_ROLLS * self._source.rate
            around = on_ball[max(run.start - 2, 0) : run.stop + 2].any()
            rolls[run] = soon and around
        return rolls

    def _speed(self, place: Array) -> Array:
        smooth = averaged(place, _WINDOW, self._source.rate)
        return np.asarray(np.linalg.norm(np.gradient(smooth, self._source.time, axis=0), axis=1))

    def _on_ball(self) -> Array:
        """Pitch of the foot, (T,), rad, if it stands on its ball with its ankle where it is."""
        height = (self._rise + np.maximum(self._over, 0.0)) / self._length
        pitch = np.arcsin(np.minimum(height, _STEEPEST)) - np.arcsin(self._rise / self._length)
        own = np.minimum(self._pitch, _ON_POINTE)
        return np.asarray(np.where(height > _STEEPEST, np.maximum(pitch, own), pitch))


def _lasting(kind: NDArray[np.int8], down: Mask, period: float) -> NDArray[np.int8]:
    """Kinds (T,) of a foot while it is down: what does not last is as what was before it."""
    found = np.full_like(kind, NONE)
    lasts = np.zeros_like(down)
    for each in (BALL, HEEL, TIP):
        lasts |= without_chatter((kind == each)[:, None], period)[:, 0] & (kind == each)
    for run in runs(down):
        own = kind[run]
        known = np.flatnonzero(lasts[run] if lasts[run].any() else own != NONE)
        before = np.searchsorted(known, np.arange(len(own)), side="right") - 1
        found[run] = own[known[np.maximum(before, 0)]]
    return found


def _pitch(turn: Array) -> Array:
    """How far feet (T, 3, 3) point down, rad."""
    return np.asarray(-np.arcsin(np.clip(turn[:, 2, 0], -1.0, 1.0)))


def _standing(places: tuple[Array, ...], mine: Mask, source: Source, spins: Mask) -> Mask:
    """Where one of several readings of a point on the floor neither moves nor wanders.

    A foot that spins may seem to do both, since nobody captures the very point that it spins on.
    """
    standing = np.zeros(len(mine), dtype=bool)
    slow, moving, wander = (
        np.where(spins, _PIVOT * bound, bound) for bound in (_STILL, _MOVING, _WANDER)
    )
    for place in places:
        smooth = averaged(place[:, :2], _WINDOW, source.rate)
        speed = np.linalg.norm(np.gradient(smooth, source.time, axis=0), axis=1)
        still = hysteresis(mine & (speed < slow), mine & (speed < moving))
        for run in runs(still):
            away = np.linalg.norm(smooth[run] - np.median(smooth[run], axis=0), axis=1)
            still[run] &= away < wander[run]
        standing |= still
    return np.asarray(without_chatter(standing[:, None], float(source.time[1]))[:, 0] & mine)


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
