"""Feet put exactly where they stand, and out of the floor, in every sample of a motion.

Poses that keep to the floor do not make a curve between them that does: joint angles between two
poses of a closed chain are not on it, nor is their average over a window. Each sample is corrected
by the least change of root and legs that brings planted feet to their places,

    minimise  sum_i w_i d_i^2   subject to   J d = -r   (damped, a few Gauss-Newton steps)

with r the misplacement of a planted foot (ball on its mark, toes flat, direction, rise) or the
depth of a sole in the floor. What a foot was moved by fades out when it has left, and in before it
arrives.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from math import cos, sin

import mujoco
import numpy as np
from numpy.typing import NDArray

from enpointe.models.figure import Figure
from enpointe.models.leg_target import LEG_JOINTS, OnPointe, Standing
from enpointe.notation import Side

__all__ = ["Contact", "fade_in_and_out", "ground"]

Array = NDArray[np.float64]
Contact = Standing | OnPointe | None
ROOT_WEIGHT = 4.0
"""What moving the root by 1 m costs, against turning a joint by 1 rad."""
CLOSE = 1e-4
"""A foot nearer to its place than this, m and rad, is left alone."""
STEPS = 3
DAMPING = 1e-8
FADE = 0.06
"""Over how long a correction fades once a foot has left, or before it arrives, s."""


def ground(
    model: mujoco.MjModel,
    time: Array,
    qpos: Array,
    contacts: Mapping[Side, Sequence[Contact]],
) -> Array:
    """Correct a motion's legs and root so that feet stand still and stay out of the floor.

    Args:
        model: The dancer.
        time: (T,), s.
        qpos: (T, nq).
        contacts: How each foot stands at each sample, None where it does not.

    Returns:
        (T, nq).
    """
    feet = {side: _Foot(model, side) for side in Side}
    placed = qpos.copy()
    data = mujoco.MjData(model)
    standing = {side: [c is not None for c in contacts[side]] for side in Side}
    for i in range(len(time)):
        now = {side: contacts[side][i] for side in Side}
        if any(now.values()):
            _correct(model, data, placed[i], feet, now)
    for side, foot in feet.items():
        fade_in_and_out(time, qpos, placed, foot.addresses, np.array(standing[side]))
    either = np.logical_or(*(np.array(standing[side]) for side in Side))
    fade_in_and_out(time, qpos, placed, np.arange(3), either)
    for i in range(len(time)):
        _correct(model, data, placed[i], feet, {side: contacts[side][i] for side in Side})
    return placed


class _Foot:
    """One foot of a dancer: where it should be, and what its leg can do about it."""

    def __init__(self, model: mujoco.MjModel, side: Side) -> None:
        self.figure = Figure.of(model)
        self._model = model
        joints = [model.joint(f"{side}_{name}") for name in LEG_JOINTS]
        self.addresses = np.array([joint.qposadr[0] for joint in joints])
        self.dofs = np.array([joint.dofadr[0] for joint in joints])
        self._toe = int(model.body(f"{side}_toe").id)
        self._tip = int(model.site(f"{side}_toe_tip").id)
        self._height = -float(model.site(f"{side}_toe_tip").pos[2])
        rims = [f"{side}_{p}_{rim}" for p in ("heel", "ball", "tip") for rim in ("inner", "outer")]
        self._soles = [int(model.geom(rim).id) for rim in rims]

    def misplaced(self, data: mujoco.MjData, contact: Contact) -> tuple[Array, Array]:
        """How far the foot is from its place, (n,), and its Jacobian, (n, nv)."""
        rows, jacobians = [], []
        if contact is not None:
            found, jacobian = self._off_its_mark(data, contact)
            rows.append(found)
            jacobians.append(jacobian)
        if isinstance(contact, Standing) and not contact.yields:
            raised = np.zeros((1, self._model.nv))
            raised[0, self.dofs[-1]] = 1.0
            rows.append(np.array([data.qpos[self.addresses[-1]] - contact.rise]))
            jacobians.append(raised)
        for geom in self._soles[: 2 if contact is not None else 6]:
            depth = data.geom_xpos[geom, 2] - self._model.geom_size[geom, 0]
            if depth < -CLOSE:
                moved = np.zeros((3, self._model.nv))
                body = int(self._model.geom_bodyid[geom])
                mujoco.mj_jac(self._model, data, moved, None, data.geom_xpos[geom], body)
                rows.append(np.array([depth]))
                jacobians.append(moved[2:])
        if not rows:
            return np.empty(0), np.empty((0, self._model.nv))
        return np.concatenate(rows), np.vstack(jacobians)

    def _off_its_mark(
        self, data: mujoco.MjData, contact: Standing | OnPointe
    ) -> tuple[Array, Array]:
        moved, turned = np.zeros((3, self._model.nv)), np.zeros((3, self._model.nv))
        footprint, figure = contact.footprint, self.figure
        if isinstance(contact, OnPointe):
            tip = data.site_xpos[self._tip]
            mujoco.mj_jac(self._model, data, moved, None, tip, self._toe)
            mark = footprint.point(figure.ball_forward + figure.toe_length)
            return tip - np.array([*mark, 0.0]), moved
        place = data.xpos[self._toe]
        mujoco.mj_jac(self._model, data, moved, turned, place, self._toe)
        rotation = data.xmat[self._toe].reshape(3, 3)
        mark = footprint.point(figure.ball_forward)
        c, s = cos(footprint.direction), sin(footprint.direction)
        # The small rotation, about x, y and z, by which the toes are off lying flat and pointing
        # where they should: up x z_toes and direction x x_toes.
        (x, _, up_x), (y, _, up_y), _ = rotation
        off = [*(place - [*mark, self._height]), -up_y, up_x, c * y - s * x]
        return np.array(off), np.vstack([moved, turned])


def _correct(
    model: mujoco.MjModel,
    data: mujoco.MjData,
    qpos: Array,
    feet: Mapping[Side, _Foot],
    contacts: Mapping[Side, Contact],
) -> None:
    """Correct one configuration (nq,) in place."""
    legs = np.concatenate([foot.dofs for foot in feet.values()])
    addresses = np.concatenate([foot.addresses for foot in feet.values()])
    low, high = model.jnt_range[model.dof_jntid[legs]].T
    rooted = any(contact is not None for contact in contacts.values())
    free = np.concatenate([np.arange(3), legs]) if rooted else legs
    cost = np.concatenate([np.full(len(free) - len(legs), ROOT_WEIGHT), np.ones(len(legs))])
    for _ in range(STEPS):
        data.qpos[:] = qpos
        mujoco.mj_kinematics(model, data)
        mujoco.mj_comPos(model, data)
        parts = [foot.misplaced(data, contacts[side]) for side, foot in feet.items()]
        off = np.concatenate([part[0] for part in parts])
        if not off.size or np.abs(off).max() < CLOSE:
            return
        jacobian = np.vstack([part[1] for part in parts])[:, free]
        weighted = jacobian / cost
        gram = weighted @ jacobian.T + DAMPING * np.eye(len(off))
        step = -weighted.T @ np.linalg.solve(gram, off)
        if rooted:
            qpos[:3] += step[:3]
        moved = qpos[addresses] + step[-len(legs) :]
        qpos[addresses] = np.clip(moved, low, high)


def fade_in_and_out(
    time: Array,
    before: Array,
    after: Array,
    addresses: NDArray[np.int64],
    standing: NDArray[np.bool_],
) -> None:
    """Let the correction of some coordinates fade where no foot stands that would keep it.

    Args:
        time: (T,), s.
        before: (T, nq), as it was.
        after: (T, nq), as corrected where a foot stands; changed in place elsewhere.
        addresses: Of the coordinates, in qpos.
        standing: (T,), where.
    """
    change = after[:, addresses] - before[:, addresses]
    kept = np.flatnonzero(standing)
    if not kept.size:
        return
    loose = np.flatnonzero(~standing)
    place = np.searchsorted(kept, loose)
    faded = np.zeros((len(loose), len(addresses)))
    for nearest, there in ((place - 1, place > 0), (place, place < len(kept))):
        edge = kept[np.clip(nearest, 0, len(kept) - 1)]
        left = there * np.clip(1.0 - np.abs(time[loose] - time[edge]) / FADE, 0.0, 1.0)
        faded += (left**2 * (3.0 - 2.0 * left))[:, None] * change[edge]
    after[np.ix_(loose, addresses)] = before[np.ix_(loose, addresses)] + faded
