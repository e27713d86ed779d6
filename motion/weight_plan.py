"""Where the weight must go for a motion to be possible: the centre of mass over time, in CasADi.

The floor can only push, and only under the feet. With the height c_z and the angular momentum L of
the motion given, the zero-moment point of a centre of mass c is

    p_x = c_x - (c_z c_x'' + L_y' / m) / (c_z'' + g),
    p_y = c_y - (c_z c_y'' - L_x' / m) / (c_z'' + g)

(Vukobratovic and Borovac 2004; Kajita et al. 2003, eq. 3, with L). The plan is the smoothest motion
near the one asked whose p stays inside the planned support, a convex quadratic programme:

    min  w_c |c - c_asked|^2 + w_u |c'''|^2 + w_s sum s + w_p |p - middle|^2
    s.t. A_k p_k <= b_k - margin + s_k,  s_k >= 0,  c'' = 0 in the air.

A plan that cannot be has s > 0 there: how far outside the feet the floor would have to push. The
height is planned before, the same way: the smoothest near and not above the one asked, since
straight legs are no longer than they are, that never falls faster than `_DROP`.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import casadi as ca
import mujoco
import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import gaussian_filter1d

from enpointe.models.foot_positions import support_hull
from enpointe.models.rules.balance import centroid, half_planes
from enpointe.motion.contact_schedule import ContactSchedule
from enpointe.motion.motion import Motion

__all__ = ["PLAN_RATE", "WeightPlan", "plan_weight"]

Array = NDArray[np.float64]

PLAN_RATE = 50.0
"""Knots of the plan a second."""
MARGIN = 0.020
"""How far inside the support the zero-moment point stays, m, where that is broad enough: what is
left is all that a controller has to put errors right with."""
_MOST = 0.75
"""Of a narrow support this share of its half-width is kept instead."""
_NEAR, _SMOOTH, _MIDDLE, _OUTSIDE = 30.0, 2e-5, 1.0, 300.0
"""Weights: near what is asked (1/m^2), smooth (s^6/m^2), in the middle (1/m^2), outside (1/m)."""
_HEIGHT, _HEIGHT_SMOOTH = 2000.0, 2e-4
"""Weights of the height: near what is asked (1/m^2), smooth (s^6/m^2). Bent knees show more than a
hip that moves aside."""
_TALLER = 0.002
"""m above the height asked."""
_DROP = 0.3
"""Share of gravity that the weight falls by at most: feet that carry nothing can't steer."""
_MOMENTUM_SIGMA = 0.015
"""s: differences of differences of sampled poses need some averaging; muscles do as much."""


@dataclass(frozen=True)
class WeightPlan:
    """The centre of mass of a motion that can be danced, at K knots.

    Attributes:
        time: (K,), s.
        com: (K, 3), m.
        velocity: (K, 3), m/s.
        acceleration: (K, 3), m/s^2.
        zmp: (K, 2), m.
        outside: (K,), how far outside its support the zero-moment point is planned, m: 0 where the
            floor can give what the motion needs.
        shifted: (K,), how far the centre of mass is from where the motion had it, m.
    """

    time: Array
    com: Array
    velocity: Array
    acceleration: Array
    zmp: Array
    outside: Array
    shifted: Array

    def at(self, t: float) -> tuple[Array, Array, Array]:
        """Place, velocity and acceleration (3,) at `t` seconds; at rest beyond both ends."""
        if t >= self.time[-1] or t <= self.time[0]:
            end = -1 if t >= self.time[-1] else 0
            return self.com[end], np.zeros(3), np.zeros(3)
        i = min(int((t - self.time[0]) * PLAN_RATE), len(self.time) - 2)
        dt = t - self.time[i]
        c, v, a = self.com[i], self.velocity[i], self.acceleration[i]
        jerk = (self.acceleration[i + 1] - a) * PLAN_RATE
        com = c + dt * v + dt**2 / 2 * a + dt**3 / 6 * jerk
        return com, v + dt * a + dt**2 / 2 * jerk, a + dt * jerk


def plan_weight(
    motion: Motion, contacts: ContactSchedule, posed: Motion, *, slower: bool = False
) -> WeightPlan:
    """Plan the centre of mass of a motion.

    Args:
        motion: As it was composed, balanced or not.
        contacts: Its schedule.
        posed: The motion itself, or as it was posed over an earlier plan: its height and angular
            momentum count, as what a body reaches is not quite what was asked.
        slower: Keep balance at every slower tempo as well, for which the centre of mass itself must
            be over the feet: where the zero-moment point is then, is between the two.
    """
    time = np.arange(motion.time[0], motion.time[-1] + 0.5 / PLAN_RATE, 1.0 / PLAN_RATE)
    com, _ = _centroidal(motion, time)
    there, momentum = _centroidal(posed, time)
    com[:, 2] = there[:, 2]
    sigma = _MOMENTUM_SIGMA * PLAN_RATE
    twist = np.gradient(gaussian_filter1d(momentum, sigma, axis=0), time, axis=0)
    gravity = float(-motion.model.opt.gravity[2])
    hulls = [
        support_hull(contacts.points[i, contacts.bears[i], :2])
        for i in (contacts.index(float(t)) for t in time)
    ]
    lift = _plan_height(com[:, 2], np.array([len(hull) > 0 for hull in hulls]), gravity)
    load = np.maximum(lift[2] + gravity, 0.2 * gravity)
    arm = lift[0] / load
    mass = float(motion.model.body_mass.sum())
    offset = np.stack([-twist[:, 1], twist[:, 0]], axis=1) / (mass * load)[:, None]
    place, velocity, acceleration, zmp, outside = _plan_level(
        com[:, :2], arm, offset, hulls, slower=slower
    )
    return WeightPlan(
        time,
        np.column_stack([place, lift[0]]),
        np.column_stack([velocity, lift[1]]),
        np.column_stack([acceleration, lift[2]]),
        zmp,
        outside,
        np.linalg.norm(place - com[:, :2], axis=1),
    )


def _centroidal(motion: Motion, time: Array) -> tuple[Array, Array]:
    """Centre of mass (K, 3) and angular momentum about it (K, 3) of the motion."""
    model = motion.model
    data = mujoco.MjData(model)
    com, momentum = np.empty((len(time), 3)), np.empty((len(time), 3))
    for k, t in enumerate(time):
        data.qpos[:], data.qvel[:], _ = motion.sample(float(t))
        mujoco.mj_kinematics(model, data)
        mujoco.mj_comPos(model, data)
        mujoco.mj_comVel(model, data)
        mujoco.mj_subtreeVel(model, data)
        com[k], momentum[k] = data.subtree_com[0], data.subtree_angmom[0]
    return com, momentum


def _plan_height(asked: Array, standing: NDArray[np.bool_], gravity: float) -> Array:
    """Height, its velocity and acceleration, (3, K)."""
    plan = _Chain(1, len(asked))
    plan.rest_at_ends()
    plan.add(plan.acceleration.T, -_DROP * gravity, np.inf, where=standing)
    plan.add(plan.acceleration.T + gravity, 0, 0, where=~standing)
    plan.add(plan.place.T - ca.DM(asked), -np.inf, _TALLER, where=standing)
    cost = _HEIGHT * ca.sumsqr(plan.place.T - ca.DM(asked)) + _HEIGHT_SMOOTH * ca.sumsqr(plan.jerk)
    (place, velocity, acceleration) = plan.minimise(
        cost, [plan.place, plan.velocity, plan.acceleration], asked[:, None]
    )
    return np.stack([place, velocity, acceleration])


def _plan_level(
    asked: Array, arm: Array, offset: Array, hulls: list[Array], *, slower: bool
) -> tuple[Array, Array, Array, Array, Array]:
    """Place, velocity, acceleration and zero-moment point (K, 2), and how far outside (K,)."""
    plan = _Chain(2, len(asked))
    plan.rest_at_ends()
    outside = ca.MX.sym("outside", len(asked))
    zmp = plan.place - plan.acceleration * ca.DM(np.tile(arm, (2, 1))) + ca.DM(offset.T)
    middle = np.array(asked)
    standing = np.zeros(len(asked))
    for k, hull in enumerate(hulls):
        if len(hull) == 0:
            plan.add(plan.acceleration[:, k], 0, 0)
            continue
        standing[k] = 1.0
        middle[k] = centroid(hull) if len(hull) > 2 else hull.mean(axis=0)
        normals, offsets = _shrunk(hull)
        for point in (zmp, plan.place) if slower else (zmp,):
            plan.add(ca.DM(normals) @ point[:, k] - outside[k] - ca.DM(offsets), -np.inf, 0)
    weight = ca.DM(np.tile(standing, (2, 1)))
    cost = (
        _NEAR * ca.sumsqr(plan.place - ca.DM(asked.T))
        + _SMOOTH * ca.sumsqr(plan.jerk)
        + _OUTSIDE * ca.sum1(outside)
        + _MIDDLE * ca.sumsqr(weight * (zmp - ca.DM(middle.T)))
    )
    wanted = [plan.place, plan.velocity, plan.acceleration, zmp, outside.T]
    return tuple(plan.minimise(cost, wanted, asked, outside))  # type: ignore[return-value]


class _Chain:
    """A place of some axes over K knots, driven by its jerk, constant from knot to knot."""

    def __init__(self, axes: int, count: int) -> None:
        self.place, self.velocity, self.acceleration = (
            ca.MX.sym(name, axes, count) for name in ("place", "velocity", "acceleration")
        )
        self.jerk = ca.MX.sym("jerk", axes, count - 1)
        self._rows: list[ca.MX] = []
        self._low: list[Array] = []
        self._high: list[Array] = []
        dt = 1.0 / PLAN_RATE
        c, v, a, u = self.place, self.velocity, self.acceleration, self.jerk
        now, then = slice(0, count - 1), slice(1, count)
        self.add(c[:, then] - c[:, now] - dt * v[:, now] - dt**2 / 2 * a[:, now] - dt**3 / 6 * u)
        self.add(v[:, then] - v[:, now] - dt * a[:, now] - dt**2 / 2 * u)
        self.add(a[:, then] - a[:, now] - dt * u)

    def add(
        self,
        expression: ca.MX,
        low: float = 0.0,
        high: float = 0.0,
        where: NDArray[np.bool_] | None = None,
    ) -> None:
        """Keep an expression, or those of its rows, between two bounds."""
        rows = ca.vec(expression)
        if where is not None:
            rows = rows[np.flatnonzero(where).tolist()]
        self._rows.append(rows)
        self._low.append(np.full(rows.numel(), low))
        self._high.append(np.full(rows.numel(), high))

    def rest_at_ends(self) -> None:
        """Begin and end still."""
        for k in (0, -1):
            self.add(self.velocity[:, k])
            self.add(self.acceleration[:, k])

    def minimise(
        self,
        cost: ca.MX,
        wanted: list[ca.MX],
        start: Array,
        slack: ca.MX | None = None,
    ) -> list[Array]:
        """The wanted expressions at the minimum, knots first; `slack` is not negative."""
        chain = ca.veccat(self.place, self.velocity, self.acceleration, self.jerk)
        unknowns = chain if slack is None else ca.veccat(chain, slack)
        lower = np.full(unknowns.numel(), -np.inf)
        lower[chain.numel() :] = 0.0
        problem = {"x": unknowns, "f": cost, "g": ca.vertcat(*self._rows)}
        solver = ca.nlpsol("weight", "ipopt", problem, _QUADRATIC)
        guess = np.zeros(unknowns.numel())
        guess[: start.size] = start.ravel()
        found = solver(
            x0=guess,
            lbx=lower,
            ubx=np.inf,
            lbg=np.concatenate(self._low),
            ubg=np.concatenate(self._high),
        )["x"]
        read = ca.Function("read", [unknowns], [each.T for each in wanted])
        return [np.array(part).squeeze() for part in read.call([found])]


_QUADRATIC: dict[str, Any] = {
    "ipopt": {
        "print_level": 0,
        "sb": "yes",
        "mehrotra_algorithm": "yes",
        "hessian_constant": "yes",
        "jac_c_constant": "yes",
        "jac_d_constant": "yes",
    },
    "print_time": False,
}
"""IPOPT told that the problem is a convex quadratic one, which it solves in some dozen steps."""


def _shrunk(hull: Array) -> tuple[Array, Array]:
    """Half-planes of the support, drawn in by the margin, or by most of what room there is."""
    if len(hull) < 3:
        return _around(hull)
    normals, offsets = half_planes(hull)
    room = float(np.min(offsets - normals @ centroid(hull)))
    return normals, offsets - min(MARGIN, _MOST * room)


def _around(hull: Array) -> tuple[Array, Array]:
    """A support of one or two points: the box along it."""
    along = hull[-1] - hull[0]
    length = float(np.linalg.norm(along))
    e = along / length if length > 0 else np.array([1.0, 0.0])
    across = np.array([-e[1], e[0]])
    normals = np.array([e, -e, across, -across])
    return normals, np.array([max(n @ p for p in hull) for n in normals])
