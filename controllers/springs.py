"""Goals for joints that are springs: what a servo in position mode needs to give a torque."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from enpointe.controllers.feedforward import FeedForward
from enpointe.controllers.plant import Plant
from enpointe.controllers.protocol import Command, State
from enpointe.motion import Motion

__all__ = ["Springs"]

Array = NDArray[np.float64]


class Springs:
    """goal = q_ref(t) + tau_ff(t) / k: each goal lies ahead by what the load will pull it back.

    A servo that holds a position has no torque input; it gives torque only as far as it is off its
    goal, so that a body on servos sags under its own weight. With the torques of the motion and the
    stiffness of the servos known, the goals take the sag away beforehand. Nothing is fed back.

    Args:
        motion: What to dance.
        stiffness: (nu,), of the servos, N m/rad, in the order of the model's actuators.
        feedforward: Torques along the motion; computed from inverse dynamics if None.
    """

    def __init__(
        self,
        motion: Motion,
        stiffness: Array,
        feedforward: FeedForward | None = None,
    ) -> None:
        self.motion = motion
        self.stiffness = np.asarray(stiffness, dtype=float)
        self.feedforward = feedforward or FeedForward.along(motion)
        plant = Plant(motion.model)
        self._qpos, self._dofs = plant.actuated_qpos, plant.actuated_dofs
        self._low, self._high = motion.model.jnt_range[motion.model.actuator_trnid[:, 0]].T
        self._none = np.zeros(motion.model.nu)

    @property
    def first_pose(self) -> Array:
        """(nu,) goals at the start, rad."""
        return np.array(self._goal(0.0))

    def reset(self, state: State) -> None:
        """Nothing is remembered between commands."""

    def command(self, t: float, state: State) -> Command:
        """Goals at `t` seconds, or at the body's own time if that is later, within the ranges."""
        now = max(t, state.time)
        velocity = self.motion.sample(now)[1][self._dofs]
        return Command(self._goal(now), velocity, self._none, self._none, self._none)

    def _goal(self, t: float) -> Array:
        qpos, _, _ = self.motion.sample(t)
        goal = qpos[self._qpos] + self.feedforward.at(t) / self.stiffness
        return np.asarray(np.clip(goal, self._low, self._high))
