"""The joints of a simulated body as a bus of servos sees them: its horns, in the bus' own order."""

from __future__ import annotations

from collections.abc import Sequence

import mujoco
import numpy as np
from numpy.typing import NDArray

__all__ = ["Horns"]

Array = NDArray[np.float64]
_STUCK = 1e3
"""N m of friction in a joint with a stone in its gears."""


class Horns:
    """Angles, velocities and torques of hinges, seen through their servos' signs and offsets.

    Args:
        model: The body; `jam` changes it.
        data: Its state.
        joints: The hinge of each servo, in the order of the bus; all known to the model.
        signs: 1, or -1 where a servo turns the other way than its joint; all 1 if None.
        offsets: rad that a servo has where its joint is at zero; all 0 if None.

    Attributes:
        qpos: Their places in qpos.
        dofs: Their dofs.
    """

    def __init__(
        self,
        model: mujoco.MjModel,
        data: mujoco.MjData,
        joints: Sequence[str],
        signs: Sequence[float] | None = None,
        offsets: Sequence[float] | None = None,
    ) -> None:
        self._model, self._data = model, data
        places = np.array([model.joint(joint).id for joint in joints])
        self.qpos, self.dofs = model.jnt_qposadr[places], model.jnt_dofadr[places]
        self._sign = np.ones(len(joints)) if signs is None else np.array(signs, dtype=float)
        self._offset = np.zeros(len(joints)) if offsets is None else np.array(offsets, dtype=float)
        self._friction = np.array(model.dof_frictionloss[self.dofs])
        self._softness = model.dof_solref[self.dofs].copy(), model.dof_solimp[self.dofs, :2].copy()

    def joint_torque(self, torque: Sequence[float]) -> Array:
        """Torques at the joints for torques at the horns, N m."""
        return np.asarray(self._sign * np.asarray(torque))

    def position(self) -> list[float]:
        """Angle of each horn, rad."""
        angles: list[float] = (self._sign * self._data.qpos[self.qpos] + self._offset).tolist()
        return angles

    def velocity(self) -> list[float]:
        """Velocity of each horn, rad/s."""
        speeds: list[float] = (self._sign * self._data.qvel[self.dofs]).tolist()
        return speeds

    def jam(self, joint: int, jammed: bool) -> None:
        """Hold a joint where it is, or let it go."""
        model, dof = self._model, self.dofs[joint]
        model.dof_frictionloss[dof] = _STUCK if jammed else self._friction[joint]
        # MuJoCo's friction is soft, and would let a jammed joint creep.
        model.dof_solref[dof] = (0.002, 1.0) if jammed else self._softness[0][joint]
        model.dof_solimp[dof, :2] = 0.9999 if jammed else self._softness[1][joint]
