"""What a floor can't give a movement, as inequalities in the speed at which it is danced.

With F = F_0 + s^2 F_1 the force and M the moment about the centre of mass c that the movement needs
at a share s of its speed, the zero-moment point p is where (Vukobratovic and Borovac 2004)

    p_x F_z = c_x F_z - c_z F_x - M_y,    p_y F_z = c_y F_z - c_z F_y + M_x,

which is of first degree in s^2, and so is  n p <= d  times F_z for each edge of the support: the
speeds at which a body keeps its balance are found exactly. So are those at which soles don't slide,
|F_x|, |F_y| <= mu F_z, and those at which a body that flies falls as freely as it is drawn.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from enpointe.models.rules.balance import half_planes
from enpointe.sim.joint_loads import JointLoads

__all__ = ["FloorLimit", "floor_limits"]

Array = NDArray[np.float64]
FREE_FALL = 0.2
"""Of the weight: more than this off free fall and a body in the air is held there by a hand. Two
differences of a drawn movement are not better than this where feet leave the floor."""


@dataclass(frozen=True)
class FloorLimit:
    """Rows  constant + dynamic s^2 <= 0.

    Attributes:
        kind: "balance" (the zero-moment point beyond the support, m), "push" (the floor would have
            to pull), "friction" (soles would slide) or "flight" (no free fall), of the weight.
        unit: "m" or "of weight".
        sample: (K,).
        constant: (K,).
        dynamic: (K,).
    """

    kind: str
    unit: str
    sample: NDArray[np.int64]
    constant: Array
    dynamic: Array


def floor_limits(loads: JointLoads) -> tuple[FloorLimit, ...]:
    """All that the floor asks of a movement that stands on it by itself."""
    standing, aloft = np.flatnonzero(~loads.aloft), np.flatnonzero(loads.aloft)
    force = loads.force / loads.weight
    push, friction = [], []
    for axis, sign in ((0, 1.0), (0, -1.0), (1, 1.0), (1, -1.0)):
        pull = sign * force[standing, :, axis] - loads.friction * force[standing, :, 2]
        friction.append((standing, pull[:, 0], pull[:, 1]))
    push.append((standing, -force[standing, 0, 2], -force[standing, 1, 2]))
    flight = [
        (aloft, sign * force[aloft, 0, axis] - FREE_FALL, sign * force[aloft, 1, axis])
        for axis in range(3)
        for sign in (1.0, -1.0)
    ]
    found = (
        _limit("balance", "m", _edges(loads, standing)),
        _limit("push", "of weight", push),
        _limit("friction", "of weight", friction),
        _limit("flight", "of weight", flight),
    )
    return tuple(limit for limit in found if len(limit.sample))


_Row = tuple[NDArray[np.int64], Array, Array]


def _edges(loads: JointLoads, standing: NDArray[np.int64]) -> Iterable[_Row]:
    """One row an edge of the support and sample, m."""
    force, height = loads.force / loads.weight, loads.com[:, 2]
    turn = np.stack([-loads.moment[:, :, 1], loads.moment[:, :, 0]], axis=2) / loads.weight
    # (T, 2, 2): the zero-moment point from below the centre of mass, times the vertical force.
    lean = turn - height[:, None, None] * force[:, :, :2]
    for i in standing.tolist():
        normals, offsets = _half_planes(loads.supports[i])
        room = offsets - normals @ loads.com[i, :2]
        beyond = lean[i] @ normals.T - force[i, :, 2:] * room
        yield np.full(len(room), i), beyond[0], beyond[1]


def _half_planes(hull: Array) -> tuple[Array, Array]:
    """Of a support with an inside; of a line or a point, both ways across and along it."""
    if len(hull) > 2:
        return half_planes(hull)
    along = hull[-1] - hull[0]
    length = float(np.linalg.norm(along))
    along = along / length if length > 0.0 else np.array([1.0, 0.0])
    normals = np.stack([along, -along, [-along[1], along[0]], [along[1], -along[0]]])
    return normals, np.asarray((normals @ hull.T).max(axis=1))


def _limit(kind: str, unit: str, rows: Iterable[_Row]) -> FloorLimit:
    parts = list(rows)
    if not parts:
        return FloorLimit(kind, unit, np.empty(0, dtype=np.int64), np.empty(0), np.empty(0))
    return FloorLimit(
        kind,
        unit,
        np.concatenate([part[0] for part in parts]),
        np.concatenate([part[1] for part in parts]),
        np.concatenate([part[2] for part in parts]),
    )
