"""The way of a leg through the air: joint by joint from one pose to another, round obstacles.

Hip, knee and foot go from the angles of the one pose to those of the other, slow at both ends, so
that the way meets both poses; the hip's turn by its twist about the thigh, which is what turnout
is. Where the way would lead through the other leg the leg opens to the side; where it would lead
through the floor the foot gives up its point and brushes through, the knee bending if it must. The
least detour that is clear is taken.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property, lru_cache
from math import cos, log, pi, radians, sin, sqrt

import mujoco
import numpy as np
from numpy.typing import NDArray

from enpointe.models.leg_target import FOOT_JOINTS, LEG_JOINTS
from enpointe.notation import Side

__all__ = ["Detour", "LegSwing", "leg_angles", "smooth"]

Vector = NDArray[np.float64]
APART = 0.006
"""Air between legs that pass each other, m."""
BRUSH, PASS = 0.05, 0.015
"""A foot on its way that would be deeper in the floor than this, m, makes a detour; one that is
less deep gives up its point and brushes along the floor: from the floor or to it, or passing."""
EFFORT = 0.03
"""How much of a clearance that is lacking a detour of one radian must make up to be worth it, m."""
SAMPLES = 21
_BODIES = ("thigh", "shank", "foot")
_PARTS = ("heel", "ball", "tip")


@dataclass(frozen=True, slots=True)
class Detour:
    """What a leg does on its way to pass the other leg, or the floor.

    Attributes:
        opening: How far it opens to the side, rad.
        bend: How far its knee bends besides, rad.
        flat: Whether the foot is flat then, rather than pointed.
        at: Share of the way at which it does so most.
    """

    opening: float = 0.0
    bend: float = 0.0
    flat: bool = False
    at: float = 0.5

    def shape(self, share: float) -> float:
        """From 0 at both ends to 1 at `at`: sin^2 of the share, bent so that `at` is its middle."""
        return sin(pi * share ** (log(0.5) / log(self.at))) ** 2


STRAIGHT = Detour()
BRUSHING_DEG = (5.0, 0.0, 0.0, 0.0)
"""A foot that brushes through over the floor, in the order of `FOOT_JOINTS`."""
OPENED = (4.0, 8.0, 12.0, 16.0, 20.0)
DRAWN_UP = (0.0, 6.0, 12.0, 18.0, 24.0, 30.0, 36.0, 42.0)
"""Detours, in the order in which they are tried, degrees of the hip: opened, then with a flat foot
drawn up, which bends the knee by twice as much and leaves the foot under the hip."""


@dataclass(frozen=True)
class LegSwing:
    """A leg's way between two poses.

    Attributes:
        model: The dancer.
        side: Whose leg.
        start: Configuration (nq,) that it leaves.
        end: Configuration (nq,) that it comes to.
        floor: Whether there is a floor to pass; there is none in a flight.
        body: How far the rest of the body is on its way, at a share of the leg's.
    """

    model: mujoco.MjModel
    side: Side
    start: Vector
    end: Vector
    floor: bool = True
    body: Callable[[float], float] = float

    def at(self, share: float) -> Vector:
        """The leg's angles (8,), in the order of `LEG_JOINTS`, at a share of the way, rad."""
        return self._led(share, self.detour)

    @cached_property
    def detour(self) -> Detour:
        """The least that leads the leg as clear as its two ends are, or the best that there is."""
        shares = np.linspace(0.0, 1.0, SAMPLES)
        room = np.array([self._room(STRAIGHT, float(share)) for share in shares])
        enough = min(room[0], room[-1])
        if room.min() >= enough:
            return STRAIGHT
        worst = float(np.clip(shares[int(room.argmin())], 0.35, 0.65))
        found, best = STRAIGHT, float(room.min())
        for detour in _detours(worst):
            least = min(self._room(detour, float(share)) for share in shares[1:-1])
            worth = min(least, enough) - EFFORT * (detour.opening + detour.bend)
            if worth > best:
                found, best = detour, worth
            if least >= enough:
                break
        return found

    def _led(self, share: float, detour: Detour) -> Vector:
        moved = smooth(share)
        first, last = self._twisted
        angles = (1 - moved) * first + moved * last
        shape = 0.0 if detour == STRAIGHT else detour.shape(share)
        # The hip swings about two axes at 45 degrees: sideways is both, in opposite senses.
        angles[:2] += shape * detour.opening / sqrt(2.0) * np.array([1.0, -1.0])
        angles[LEG_JOINTS.index("knee_bend")] += shape * detour.bend
        if detour.flat:
            foot = slice(-len(FOOT_JOINTS), None)
            angles[foot] += shape * (np.radians(BRUSHING_DEG) - angles[foot])
        angles[2] -= _twist_of_swing(angles[0], angles[1])
        return angles

    @cached_property
    def _twisted(self) -> tuple[Vector, Vector]:
        first, last = (_with_twist(leg_angles(self.model, q, self.side)) for q in self._ends)
        return first, last

    @property
    def _ends(self) -> tuple[Vector, Vector]:
        return self.start, self.end

    @cached_property
    def _brush(self) -> float:
        """How deep in the floor the way may lead, m."""
        data = mujoco.MjData(self.model)
        for qpos in self._ends:
            data.qpos[:] = qpos
            mujoco.mj_kinematics(self.model, data)
            if _above_floor(self.model, data, self.side) < BRUSH:
                return BRUSH
        return PASS

    def _room(self, detour: Detour, share: float) -> float:
        """Air to spare between the legs and over the floor, m, no more than 0."""
        data = mujoco.MjData(self.model)
        moved = self.body(share)
        data.qpos[:] = (1 - moved) * self.start + moved * self.end
        mujoco.mj_normalizeQuat(self.model, data.qpos)
        data.qpos[_addresses(self.model, self.side)] = self._led(share, detour)
        mujoco.mj_kinematics(self.model, data)
        room = min(0.0, _between_legs(self.model, data, APART) - APART)
        if self.floor:
            room = min(room, _above_floor(self.model, data, self.side) + self._brush)
        return room


def leg_angles(model: mujoco.MjModel, qpos: Vector, side: Side) -> Vector:
    """A leg's angles (8,) in a configuration (nq,), in the order of `LEG_JOINTS`, rad."""
    return np.array(qpos[_addresses(model, side)])


def _with_twist(angles: Vector) -> Vector:
    """A leg's angles with the twist of the thigh about itself for the third of the hip's."""
    out = angles.copy()
    out[2] += _twist_of_swing(angles[0], angles[1])
    return out


def _twist_of_swing(lifted: float, crossed: float) -> float:
    """What the hip's two swings turn the thigh about itself, rad (`thigh_twist` without a turn)."""
    half = sqrt(0.5)
    first, other = np.array([half, -half, 0.0]), np.array([-half, -half, 0.0])
    up = np.array([0.0, 0.0, 1.0])

    def turned(v: Vector, axis: Vector, angle: float) -> Vector:
        along = (1.0 - cos(angle)) * (axis @ v) * axis
        return np.asarray(cos(angle) * v + sin(angle) * _cross(axis, v) + along)

    def swung(v: Vector) -> Vector:
        return turned(turned(v, other, crossed), first, lifted)

    x, z = swung(np.array([1.0, 0.0, 0.0])), swung(up)
    # Where the shortest swing from hanging to the same direction takes front and left.
    share = 1.0 / (1.0 + z[2] + 1e-9)
    axis = _cross(up, z)
    front, left = (
        v + _cross(axis, v) + share * _cross(axis, _cross(axis, v)) for v in np.eye(3)[:2]
    )
    return float(np.arctan2(x @ left, x @ front))


def _cross(a: Vector, b: Vector) -> Vector:
    return np.array(
        [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
    )


def smooth(share: float) -> float:
    """From 0 to 1 with no speed at either end, gaining it and losing it in `EASE` of the way."""
    if share > 0.5:
        return 1.0 - smooth(1.0 - share)
    top = 1.0 / (1.0 - EASE)
    return 0.5 * top * share**2 / EASE if share < EASE else top * (share - 0.5 * EASE)


EASE = 0.3


def _detours(at: float) -> list[Detour]:
    opened = [Detour(radians(d), at=at) for d in OPENED]
    return opened + [Detour(radians(d), radians(2 * d), True, at) for d in DRAWN_UP]


@lru_cache(maxsize=8)
def _addresses(model: mujoco.MjModel, side: Side) -> NDArray[np.int64]:
    return np.array([model.joint(f"{side}_{joint}").qposadr[0] for joint in LEG_JOINTS])


def _between_legs(model: mujoco.MjModel, data: mujoco.MjData, most: float) -> float:
    """Least distance between a limb of one leg and one of the other, m, below zero inside."""
    ends = np.empty(6)
    least = most
    for one in _limbs(model, Side.LEFT):
        for other in _limbs(model, Side.RIGHT):
            least = min(least, float(mujoco.mj_geomDistance(model, data, one, other, most, ends)))
    return least


@lru_cache(maxsize=8)
def _limbs(model: mujoco.MjModel, side: Side) -> tuple[int, ...]:
    return tuple(int(model.geom(f"{side}_{part}_limb").id) for part in _BODIES)


def _above_floor(model: mujoco.MjModel, data: mujoco.MjData, side: Side) -> float:
    """Height of the lowest point of a sole, m."""
    geoms = _soles(model, side)
    return float(np.min(data.geom_xpos[geoms, 2] - model.geom_size[geoms, 0]))


@lru_cache(maxsize=8)
def _soles(model: mujoco.MjModel, side: Side) -> NDArray[np.int64]:
    rims = ("inner", "outer")
    return np.array([model.geom(f"{side}_{p}_{rim}").id for p in _PARTS for rim in rims])
