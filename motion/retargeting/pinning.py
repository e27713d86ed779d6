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
from enpointe.motion.retargeting.body import BALL, HEEL, NONE, TIP, Body
from enpointe.motion.retargeting.plan import FootPlan, Plan

__all__ = ["Pins", "pinned", "pins_of"]

Array = NDArray[np.float64]
_ROOT = 10.0
"""What moving the root by 1 m costs, against turning a joint by 1 rad."""
_CLOSE = 1e-4
"""A foot nearer to its place than this, m and rad, is left alone."""
_FAR = 1e-3
"""A foot that can't be brought nearer than this, m and rad, is let lie as it will."""
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
    data = mujoco.MjData(body.model)
    return _corrected(body, data, qpos, pins_of(plan, body))


def pins_of(plan: Plan, body: Body) -> dict[str, Pins]:
    """What holds each foot."""
    kinds = {side: plan.feet[side].kind for side in SIDES}
    return {
        # Nobody stands on a toe that touches the floor beside a standing foot.
        side: Pins(body, side, plan.feet[side], (kinds[side] == TIP) & (kinds[other] != NONE))
        for side, other in zip(SIDES, reversed(SIDES), strict=True)
    }


def _corrected(body: Body, data: mujoco.MjData, qpos: Array, feet: dict[str, Pins]) -> Array:
    placed = qpos.copy()
    for i, row in enumerate(placed):
        _correct(body, data, row, feet, i)
    return placed


@dataclass(frozen=True)
class _Point:
    """A point of a body of the model, in its frame."""

    body: int
    place: Array


@dataclass(frozen=True)
class Pin:
    """How far a foot is from where it should be, in one respect.

    Attributes:
        off: (n,), m, or the sine of an angle.
        jacobian: (n, nv).
        place: Whether it is a place, or a height; a heading otherwise.
    """

    off: Array
    jacobian: Array
    place: bool = True


class Pins:
    """What holds one foot."""

    def __init__(self, body: Body, side: str, plan: FootPlan, loose: NDArray[np.bool_]) -> None:
        model, foot = body.model, body.feet[side]
        self._model, self._plan = model, plan
        self._kind = np.where(loose, NONE, plan.kind)
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

    def misplaced(self, data: mujoco.MjData, i: int, *, whole: bool = True) -> list[Pin]:
        """How far a foot is from its place.

        Args:
            data: Its kinematics.
            i: The sample.
            whole: Whether it must also lie as it should, not only touch where it should.
        """
        model, plan = self._model, self._plan
        found: list[Pin] = []
        kind = int(self._kind[i])
        down: list[int] = []
        if kind != NONE:
            heel = kind == HEEL and not plan.flat[i]
            place, jacobian = self._point(
                data, self._points[HEEL if heel else TIP if kind == TIP else BALL]
            )
            # A foot that slides is told its height alone; where to, its ankle is.
            held = slice(0, 3) if plan.still[i] else slice(2, 3)
            found.append(Pin((place - plan.place[i])[held], jacobian[held]))
            if whole and plan.flat[i]:
                down = [*self._of[HEEL], *self._of[BALL], *self._of[TIP]]
            elif whole and kind == BALL:
                down = [*self._of[BALL], *self._of[TIP]]
            if whole and kind != TIP:
                found.append(Pin(*self._heading(data, plan.turn[i]), place=False))
        for geom in self._soles:
            depth = data.geom_xpos[geom, 2] - model.geom_size[geom, 0]
            if geom in down or depth < -_CLOSE:
                moved = np.zeros((3, model.nv))
                mujoco.mj_jac(
                    model, data, moved, None, data.geom_xpos[geom], int(model.geom_bodyid[geom])
                )
                found.append(Pin(np.array([depth]), moved[2:]))
        return found

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


def _correct(body: Body, data: mujoco.MjData, qpos: Array, feet: dict[str, Pins], i: int) -> None:
    """Correct one configuration (nq,) in place: feet that can't lie as they should still touch."""
    asked = qpos.copy()
    if _approach(body, data, qpos, feet, i, whole=True) > _FAR:
        qpos[:] = asked
        _approach(body, data, qpos, feet, i, whole=False)


def _approach(
    body: Body, data: mujoco.MjData, qpos: Array, feet: dict[str, Pins], i: int, *, whole: bool
) -> float:
    """A few steps, in place, and how far off what is left is."""
    model = body.model
    legs = np.concatenate([foot.dofs for foot in feet.values()])
    addresses = np.concatenate([foot.addresses for foot in feet.values()])
    joints = model.dof_jntid[legs]
    limited = model.jnt_limited[joints].astype(bool)
    low = np.where(limited, model.jnt_range[joints, 0], -np.inf)
    high = np.where(limited, model.jnt_range[joints, 1], np.inf)
    free = np.concatenate([np.arange(3), legs])
    cost = np.concatenate([np.full(3, _ROOT), np.ones(len(legs))])
    for step in range(_STEPS + 1):
        data.qpos[:] = qpos
        mujoco.mj_kinematics(model, data)
        mujoco.mj_comPos(model, data)
        found = [pin for foot in feet.values() for pin in foot.misplaced(data, i, whole=whole)]
        off = np.concatenate([np.empty(0), *(pin.off for pin in found)])
        left = float(np.abs(off).max(initial=0.0))
        if left < _CLOSE or step == _STEPS:
            break
        jacobian = np.vstack([pin.jacobian for pin in found])[:, free]
        moved = _least(jacobian, off, cost, _room(qpos[addresses], low, high))
        qpos[:3] += moved[:3]
        qpos[addresses] = np.clip(qpos[addresses] + moved[3:], low, high)
    return left


def _room(angles: Array, low: Array, high: Array) -> tuple[Array, Array]:
    """How far root and joints may yet go, down and up."""
    free = np.full(3, np.inf)
    return np.concatenate([-free, low - angles]), np.concatenate([free, high - angles])


def _least(jacobian: Array, off: Array, cost: Array, room: tuple[Array, Array]) -> Array:
    """The least step that makes up for `off`; joints stop at the ends of their ranges."""
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
