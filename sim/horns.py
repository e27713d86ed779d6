"""The joints of a simulated body as a bus of servos sees them: its horns, in the bus' own order.

The sensor of these servos knows any angle of the horn's turn again after power was away (e-manual,
Position Sensor: contactless absolute encoder, 12 bit over 360 degrees), so that it can only sit
behind the gears, on the horn: that is what it sees, play and all.
"""

from __future__ import annotations

from collections.abc import Sequence

import mujoco
import numpy as np
from numpy.typing import NDArray

from enpointe.sim.gear_play import rotor_of

__all__ = ["Horns"]

Array = NDArray[np.float64]
_STUCK = 1e3
"""N m of friction in a joint with a stone in its gears."""


class Horns:
    """Angles, velocities and torques of hinges, seen through their servos' signs and offsets.

    Args:
        model: The body, with rotors of its own where gears have play (`with_play`); `jam` changes
            it.
        joints: The hinge of each servo, in the order of the bus; all known to the model.
        signs: 1, or -1 where a servo turns the other way than its joint; all 1 if None.
        offsets: rad that a servo has where its joint is at zero; all 0 if None.

    Attributes:
        model: The body.
        data: Its state.
    """

    def __init__(
        self,
        model: mujoco.MjModel,
        joints: Sequence[str],
        signs: Sequence[float] | None = None,
        offsets: Sequence[float] | None = None,
    ) -> None:
        self.model, self.data = model, mujoco.MjData(model)
        places = np.array([model.joint(joint).id for joint in joints])
        rotors = np.array([rotor_of(model, joint) for joint in joints])
        self._qpos, self._dofs = model.jnt_qposadr[places], model.jnt_dofadr[places]
        self._rotor_qpos, self._rotors = model.jnt_qposadr[rotors], model.jnt_dofadr[rotors]
        self._sign = np.ones(len(joints)) if signs is None else np.array(signs, dtype=float)
        self._offset = np.zeros(len(joints)) if offsets is None else np.array(offsets, dtype=float)
        self._friction = np.array(model.dof_frictionloss[self._rotors])
        self._softness = (
            model.dof_solref[self._rotors].copy(),
            model.dof_solimp[self._rotors, :2].copy(),
        )

    def position(self) -> Sequence[float]:
        """Angle of each horn, rad."""
        angles: list[float] = (self._sign * self.data.qpos[self._qpos] + self._offset).tolist()
        return angles

    def velocity(self) -> Sequence[float]:
        """Velocity of each horn, rad/s."""
        speeds: list[float] = (self._sign * self.data.qvel[self._dofs]).tolist()
        return speeds

    def rotor_velocity(self) -> Sequence[float]:
        """Velocity of the motors' side of the gears, as horns would turn without play, rad/s."""
        speeds: list[float] = (self._sign * self.data.qvel[self._rotors]).tolist()
        return speeds

    def jam(self, joint: int, jammed: bool) -> None:
        """Hold a joint where it is, or let it go."""
        model, dof = self.model, self._rotors[joint]
        model.dof_frictionloss[dof] = _STUCK if jammed else self._friction[joint]
        # MuJoCo's friction is soft, and would let a jammed joint creep.
        model.dof_solref[dof] = (0.002, 1.0) if jammed else self._softness[0][joint]
        model.dof_solimp[dof, :2] = 0.9999 if jammed else self._softness[1][joint]

    def _joint_torque(self, torque: Sequence[float]) -> Array:
        """Torques at the joints for torques at the horns, N m."""
        return np.asarray(self._sign * np.asarray(torque))

    def _seat(self) -> None:
        """Put the rotors in the middle of the play about where the horns are."""
        self.data.qpos[self._rotor_qpos] = self.data.qpos[self._qpos]
        mujoco.mj_forward(self.model, self.data)
