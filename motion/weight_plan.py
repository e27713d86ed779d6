"""Where the weight goes over a phrase, so that the floor can carry it there.

The floor pushes inside the support and nowhere else: the zero-moment point p must be in the hull of
the soles on the floor. With the height of the centre of mass and the angular momentum of the motion
as they are, p is linear in the horizontal centre of mass c,

    p = c - h c'' - m,    h = c_z / (c''_z + g),    m = (L'_y, -L'_x) / (M (c''_z + g)),

so that the way of the weight is a quadratic programme over the whole phrase (Kajita et al. 2003 as
a programme; Wieber 2006):

    minimise    sum |c - c_asked|^2 + jerk |c'''|^2 + even |p - middle|^2 + far |s|^2
    subject to  A_k p_k <= b_k - margin + s_k,   s >= 0,   at rest at both ends.

Weight so leaves a foot before the foot does, since it can't be stopped at once. What no way of the
weight can keep shows in the slack s, in metres, and when.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import casadi as ca
import numpy as np
from numpy.typing import NDArray

from enpointe.models.rules.balance import centroid, half_planes

__all__ = ["WeightPlan", "plan_height", "plan_weight"]

Array = NDArray[np.float64]
MARGIN = 0.012
"""How far inside the support the zero-moment point stays, m; half of what a small one leaves."""
JERK = 3e-6
"""Cost of squared jerk, m^2 per (m/s^3)^2: a second of weight shift may stray centimetres from what
is asked before its ends are rounded more."""
EVEN = 0.05
"""Cost of the zero-moment point's squared distance from the middle of the support: a push that is
always at the edge leaves nothing for keeping balance."""
FAR = 1e3
"""Cost of leaving the support by a metre squared, against straying as far from what is asked."""
GRAVITY = 9.81


@dataclass(frozen=True)
class WeightPlan:
    """The way of the weight.

    Attributes:
        time: (T,), s, evenly spaced.
        com: (T, 2), m.
        zmp: (T, 2), the zero-moment point, m.
        outside: (T,), how far it has to leave the support less its margin, m; 0 where it need not.
    """

    time: Array
    com: Array
    zmp: Array
    outside: Array


def plan_height(time: Array, height: Array, standing: NDArray[np.bool_]) -> Array:
    """The height of the centre of mass nearest to the one asked that legs can drive, (T,), m.

    |z''| <= `LIFT` while anything stands: more downwards and the feet leave the floor.

    Args:
        time: (T,), s, evenly spaced.
        height: What is asked, (T,), m.
        standing: (T,), whether a sole is on the floor.
    """
    count, dt = len(time), float(time[1] - time[0])
    way = ca.MX.sym("z", count)
    bend = (way[2:] - 2 * way[1:-1] + way[:-2]) / dt**2
    jerk = (bend[1:] - bend[:-1]) / dt
    cost = ca.sumsqr(way - ca.DM(height)) + HEIGHT_JERK * ca.sumsqr(jerk)
    most = np.where(standing[1:-1], LIFT, np.inf)
    problem: dict[str, Any] = {"x": way, "f": cost, "g": bend}
    solver = ca.nlpsol("height", "ipopt", problem, _QUIET)
    solution = solver(x0=height, lbg=-most, ubg=most)
    return np.asarray(solution["x"]).ravel()


LIFT = 5.0
"""m/s^2: half of gravity is left to the feet."""
HEIGHT_JERK = 1e-8
_QUIET: dict[str, Any] = {
    "ipopt.print_level": 0,
    "ipopt.sb": "yes",
    "print_time": False,
    "error_on_fail": False,
}


def plan_weight(
    time: Array,
    com: Array,
    momentum_rate: Array,
    supports: Sequence[Array],
    mass: float,
) -> WeightPlan:
    """Plan the way of the weight nearest to the one asked.

    Args:
        time: (T,), s, evenly spaced.
        com: What is asked, (T, 3), m; its height is kept.
        momentum_rate: L' about the centre of mass, (T, 3), N m.
        supports: Hull of the soles on the floor at each time, counter-clockwise; fewer than three
            corners ask for nothing.
        mass: M, kg.
    """
    count, dt = len(time), float(time[1] - time[0])
    lift = np.gradient(np.gradient(com[:, 2], dt), dt) + GRAVITY
    # Near free fall the floor gives nothing, and there is nothing to plan.
    lift = np.maximum(lift, 0.3 * GRAVITY)
    levers = com[:, 2] / lift
    moments = np.stack([momentum_rate[:, 1], -momentum_rate[:, 0]], axis=1) / (mass * lift[:, None])
    way, slack = ca.MX.sym("c", 2, count), ca.MX.sym("s", count)
    bend = (way[:, 2:] - 2 * way[:, 1:-1] + way[:, :-2]) / dt**2
    acceleration = ca.horzcat(ca.DM.zeros(2, 1), bend, ca.DM.zeros(2, 1))
    point = way - acceleration * ca.repmat(ca.DM(levers).T, 2, 1) - ca.DM(moments.T)
    jerk = (bend[:, 1:] - bend[:, :-1]) / dt
    cost = ca.sumsqr(way - ca.DM(com[:, :2].T)) + JERK * ca.sumsqr(jerk) + FAR * ca.sumsqr(slack)
    middles = np.array(
        [centroid(h) if len(h) > 2 else c for h, c in zip(supports, com[:, :2], strict=True)]
    )
    cost += EVEN * ca.sumsqr(point - ca.DM(middles.T))
    rows, offsets = [], []
    for k, hull in enumerate(supports):
        if len(hull) < 3:
            continue
        normals, edges = half_planes(hull)
        room = float(np.min(edges - normals @ centroid(hull)))
        rows.append(ca.mtimes(ca.DM(normals), point[:, k]) - slack[k])
        offsets.append(edges - min(MARGIN, 0.5 * room))
    rest = ca.vertcat(way[:, 1] - way[:, 0], way[:, -1] - way[:, -2])
    unknowns = ca.vertcat(ca.vec(way), slack)
    problem: dict[str, Any] = {"x": unknowns, "f": cost, "g": ca.vertcat(*rows, rest)}
    solver = ca.nlpsol("weight", "ipopt", problem, _QUIET)
    high = np.concatenate([*offsets, np.zeros(4)])
    low = np.concatenate([np.full(len(high) - 4, -np.inf), np.zeros(4)])
    solution = solver(
        x0=np.concatenate([com[:, :2].ravel(), np.zeros(count)]),
        lbx=np.concatenate([np.full(2 * count, -np.inf), np.zeros(count)]),
        lbg=low,
        ubg=high,
    )
    found = np.asarray(solution["x"]).ravel()
    planned = found[: 2 * count].reshape(count, 2)
    zmp = np.asarray(ca.Function("p", [unknowns], [point])(found)).T
    return WeightPlan(time, planned, zmp, found[2 * count :])
