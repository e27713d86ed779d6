"""The controller's own picture of the body it drives: a model, never the body itself."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cached_property

import mujoco
import numpy as np
from numpy.typing import NDArray

from enpointe.models.soles import sole_geoms

__all__ = ["Plant"]

Array = NDArray[np.float64]
_ON_FLOOR = 0.006
"""A sole is planned to carry weight when it is nearer to the floor than this, m."""


class Plant:
    """Dynamics of a model placed at one state, for controllers.

    The floor is the horizontal plane z = 0; soles are the sphere geoms that meet a plane geom and
    nothing else.

    Args:
        model: A free root and hinges, torque actuators on hinges.
    """

    def __init__(self, model: mujoco.MjModel) -> None:
        self.model = model
        self.data = mujoco.MjData(model)
        self.mass = float(model.body_mass.sum())
        self.gravity = float(-model.opt.gravity[2])
        joints = model.actuator_trnid[:, 0]
        self.actuated_qpos = np.array(model.jnt_qposadr[joints])
        self.actuated_dofs = np.array(model.jnt_dofadr[joints])
        self.torque_limit = np.array(model.actuator_forcerange[:, 1])

    def place(self, qpos: Array, qvel: Array | None = None) -> None:
        """Bring kinematics, mass matrix and bias forces to a state."""
        self.data.qpos[:] = qpos
        self.data.qvel[:] = 0.0 if qvel is None else qvel
        mujoco.mj_fwdPosition(self.model, self.data)
        mujoco.mj_fwdVelocity(self.model, self.data)

    @property
    def com(self) -> Array:
        """Centre of mass (3,), m."""
        return np.array(self.data.subtree_com[0])

    @cached_property
    def sole_geoms(self) -> NDArray[np.int64]:
        """Geoms that meet the floor and nothing else, (S,)."""
        return sole_geoms(self.model)

    def soles_on_floor(self) -> NDArray[np.int64]:
        """The sole geoms that touch the floor in this pose."""
        geoms = self.sole_geoms
        gap = self.data.geom_xpos[geoms, 2] - self.model.geom_size[geoms, 0]
        return np.asarray(geoms[gap < _ON_FLOOR])

    def standing_bodies(self) -> tuple[int, ...]:
        """Feet on the floor: one body a leg, the one nearest the root."""
        bodies = {int(self.model.geom_bodyid[g]) for g in self.soles_on_floor()}
        parents = self.model.body_parentid
        return tuple(sorted(b for b in bodies if int(parents[b]) not in bodies))

    def bearing_actuators(self, feet: Sequence[int]) -> NDArray[np.int64]:
        """Actuators between the trunk and the given feet, the feet's own joints included."""
        bearing: set[int] = set()
        for foot in feet:
            body = foot
            while self.model.body_parentid[body] != 0:
                bearing.add(body)
                body = int(self.model.body_parentid[body])
        joints = self.model.actuator_trnid[:, 0]
        return np.flatnonzero(np.isin(self.model.jnt_bodyid[joints], sorted(bearing)))

    def joint_inertia(self) -> Array:
        """Inertia of everything beyond each actuated joint, about its axis, (nu,), kg m^2."""
        full = np.zeros((self.model.nv, self.model.nv))
        mujoco.mj_fullM(self.model, self.data, full)
        return np.array(np.diag(full)[self.actuated_dofs])

    def inverse_dynamics(self, qacc: Array) -> Array:
        """M qacc + h without contacts: what joints, root and floor must give together, (nv,)."""
        full = np.zeros((self.model.nv, self.model.nv))
        mujoco.mj_fullM(self.model, self.data, full)
        return np.asarray(full @ qacc + self.data.qfrc_bias - self.data.qfrc_passive)

    def contact_jacobians(self, geoms: NDArray[np.int64]) -> Array:
        """Jacobians of the lowest point of each sole sphere, (S, 3, nv)."""
        jacobians = np.zeros((len(geoms), 3, self.model.nv))
        for row, geom in zip(jacobians, geoms, strict=True):
            point = self.data.geom_xpos[geom] - [0, 0, self.model.geom_size[geom, 0]]
            body = int(self.model.geom_bodyid[geom])
            mujoco.mj_jac(self.model, self.data, row, None, point, body)
        return jacobians
