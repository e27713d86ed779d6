"""Feet put exactly where the plan has them: the least change of root and legs that does it.

    minimise  sum_i w_i d_i^2   subject to   J d = -r   (damped, a few Gauss-Newton steps)

with r how far a standing foot is from its place, and how deep any sole is in the floor, as in
`enpointe.motion.grounding`, which knows key poses where this knows captured feet.
"""

from __future__ import annotations

from dataclasses import dataclass

import mujoco
import numpy as np
from numpy.typing import NDArray

from enpointe.models.anatomy import SIDES
from enpointe.motion.grounding import fade_in_and_out
from enpointe.motion.retargeting.body import BALL, HEEL, NONE, TIP, Body
from enpointe.motion.retargeting.plan import FootPlan, Plan

__all__ = ["pinned"]

Array = NDArray[np.float64]
_ROOT = 4.0
"""What moving the root by 1 m costs, against turning a joint by 1 rad."""
_CLOSE = 1e-4
"""A foot nearer to its place than this, m and rad, is left alone."""
_STEPS = 8
_DAMPING = 1e-6
_LONGEST = 0.1
"""No step moves a joint, or the root, farther than this, rad and m."""
_ROUNDS = 4
"""How often joints that came to an end of their range are taken out, in one step."""


def pinned(plan: Plan, body: Body, qpos: Array) -> Array:
    """Correct a movement's legs and root so that feet stand where they should.

    Args:
        plan: Where that is.
        body: Whose.
        qpos: (T, nq).

    Returns:
        (T, nq).
    """
    feet = {side: _Pins(body, side, plan.feet[side]) for side in SIDES}
    data = mujoco.MjData(body.model)
    placed = qpos.copy()
    for i, row in enumerate(placed):
        _correct(body, data, row, feet, i)
    stands = {side: plan.feet[side].kind != NONE for side in SIDES}
    for side, foot in feet.items():
        fade_in_and_out(plan.time, qpos, placed, foot.addresses, stands[side])
    either = np.logical_or(*stands.values())
    fade_in_and_out(plan.time, qpos, placed, np.arange(3), either)
    for i, row in enumerate(placed):
        _correct(body, data, row, feet, i)
    return placed


@dataclass(frozen=True)
class _Point:
    """A point of a body of the model, in its frame."""

    body: int
    place: Array


class _Pins:
    """What holds one foot."""

    def __init__(self, body: Body, side: str, plan: FootPlan) -> None:
        model, foot = body.model, body.feet[side]
        self._model, self._plan = model, plan
        data = mujoco.MjData(model)
        data.qpos[:] = body.rest
        mujoco.mj_kinematics(model, data)
        ankle = body.at_rest[f"{side}_ankle"]
        ends = [body.bodies[f"{side}_foot"], body.bodies.get(f"{side}_toe", -1)]
        chain = _between(model, body.bodies["pelvis"], max(ends))
        dofs = np.flatnonzero(np.isin(model.dof_bodyid, chain))
        self.dofs = dofs
        self.addresses = model.jnt_qposadr[model.dof_jntid[dofs]]
        self._soles = foot.soles
        owner = max(ends)
        self._points = {
            kind: _local(data, own, ankle + place)
            for kind, place, own in (
                (BALL, foot.ball, owner),
                (TIP, foot.tip, owner),
                (HEEL, foot.heel, ends[0]),
            )
        }
        self._of = body.soles_of(side)
        self._forward = data.xmat[ends[0]].reshape(3, 3).T @ [1.0, 0.0, 0.0]
        self._foot = ends[0]

    def misplaced(self, data: mujoco.MjData, i: int) -> tuple[list[Array], list[Array]]:
        """How far a foot is from its place and its Jacobian, in pieces."""
        model, plan = self._model, self._plan
        rows: list[Array] = []
        jacobians: list[Array] = []
        kind = int(plan.kind[i])
        down: list[int] = []
        if kind != NONE:
            heel = kind == HEEL and not plan.flat[i]
            point = self._points[HEEL if heel else TIP if kind == TIP else BALL]
            found, jacobian = self._point(data, point)
            rows.append(found - plan.place[i])
            jacobians.append(jacobian)
            if plan.flat[i]:
                down = [*self._of[HEEL], *self._of[BALL], *self._of[TIP]]
            elif kind == BALL:
                down = [*self._of[BALL], *self._of[TIP]]
            if kind != TIP:
                off, jacobian = self._heading(data, plan.turn[i])
                rows.append(off)
                jacobians.append(jacobian)
        for geom in self._soles:
            depth = data.geom_xpos[geom, 2] - model.geom_size[geom, 0]
            if geom in down or depth < -_CLOSE:
                moved = np.zeros((3, model.nv))
                mujoco.mj_jac(
                    model, data, moved, None, data.geom_xpos[geom], int(model.geom_bodyid[geom])
                )
                rows.append(np.array([depth]))
                jacobians.append(moved[2:])
        return rows, jacobians

    def _point(self, data: mujoco.MjData, point: _Point) -> tuple[Array, Array]:
        turn = data.xmat[point.body].reshape(3, 3)
        place = data.xpos[point.body] + turn @ point.place
        jacobian = np.zeros((3, self._model.nv))
        mujoco.mj_jac(self._model, data, jacobian, None, place, point.body)
        return place, jacobian

    def _heading(self, data: mujoco.MjData, turn: Array) -> tuple[Array, Array]:
        """The sine of the angle, about the vertical, between a foot's heading and the plan's."""
        found = data.xmat[self._foot].reshape(3, 3) @ self._forward
        x, y = found[:2] / np.hypot(*found[:2])
        c, s = turn[:2, 0] / np.hypot(*turn[:2, 0])
        turned = np.zeros((3, self._model.nv))
        mujoco.mj_jac(self._model, data, None, turned, data.xpos[self._foot], self._foot)
        return np.array([c * y - s * x]), turned[2:]


def _between(model: mujoco.MjModel, above: int, below: int) -> list[int]:
    chain = []
    while below not in (above, 0):
        chain.append(below)
        below = int(model.body_parentid[below])
    return chain


def _local(data: mujoco.MjData, body: int, place: Array) -> _Point:
    return _Point(body, data.xmat[body].reshape(3, 3).T @ (place - data.xpos[body]))


def _correct(body: Body, data: mujoco.MjData, qpos: Array, feet: dict[str, _Pins], i: int) -> None:
    """Correct one configuration (nq,) in place."""
    model = body.model
    legs = np.concatenate([foot.dofs for foot in feet.values()])
    addresses = np.concatenate([foot.addresses for foot in feet.values()])
    joints = model.dof_jntid[legs]
    limited = model.jnt_limited[joints].astype(bool)
    low = np.where(limited, model.jnt_range[joints, 0], -np.inf)
    high = np.where(limited, model.jnt_range[joints, 1], np.inf)
    free = np.concatenate([np.arange(3), legs])
    cost = np.concatenate([np.full(3, _ROOT), np.ones(len(legs))])
    for _ in range(_STEPS):
        data.qpos[:] = qpos
        mujoco.mj_kinematics(model, data)
        mujoco.mj_comPos(model, data)
        rows: list[Array] = []
        jacobians: list[Array] = []
        for foot in feet.values():
            found, moved = foot.misplaced(data, i)
            rows += found
            jacobians += moved
        if not rows:
            return
        off = np.concatenate(rows)
        if np.abs(off).max() < _CLOSE:
            return
        step = _least(
            np.vstack(jacobians)[:, free], off, cost, room=_room(qpos[addresses], low, high)
        )
        qpos[:3] += step[:3]
        qpos[addresses] = np.clip(qpos[addresses] + step[3:], low, high)


def _room(angles: Array, low: Array, high: Array) -> tuple[Array, Array]:
    """How far root and joints may yet go, down and up."""
    free = np.full(3, np.inf)
    return np.concatenate([-free, low - angles]), np.concatenate([free, high - angles])


def _least(jacobian: Array, off: Array, cost: Array, room: tuple[Array, Array]) -> Array:
    """The least step that makes up for `off`; joints that would pass their range stop at its end."""
    step = np.zeros(len(cost))
    moving = np.ones(len(cost), dtype=bool)
    for _ in range(_ROUNDS):
        left = off + jacobian[:, ~moving] @ step[~moving]
        weighted = jacobian[:, moving] / cost[moving]
        gram = weighted @ jacobian[:, moving].T + _DAMPING * np.eye(len(off))
        step[moving] = -weighted.T @ np.linalg.solve(gram, left)
        past = moving & ((step < room[0]) | (step > room[1]))
        if not past.any():
            break
        step[past] = np.clip(step[past], room[0][past], room[1][past])
        moving &= ~past
    return step * min(1.0, _LONGEST / max(float(np.abs(step).max()), 1e-12))
