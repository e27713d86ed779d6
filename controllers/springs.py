"""Goals for joints that are springs: what a servo in position mode needs to give a torque."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from enpointe.controllers.feedforward import FeedForward
from enpointe.controllers.plant import Plant
from enpointe.controllers.protocol import Command, State
from enpointe.motion import Motion
from enpointe.motion.contact_schedule import ContactSchedule

__all__ = ["Springs"]

Array = NDArray[np.float64]


class Springs:
    """goal = q_ref(t') + (tau_ff(t') + d v_ref(t')) / k: ahead by what load and speed hold back.

    A servo that holds a position has no torque input; it gives torque only as far as it is off its
    goal, so that a body on servos sags under its own weight, and one whose motor is braked by its
    own voltage follows late. With the torques of the motion and the servos' stiffness k and damping
    d known, the goals take both away beforehand, at t' = t + lead, when they will be heard. Nothing
    is fed back.

    Args:
        motion: What to dance.
        stiffness: (nu,), of the servos, N m/rad, in the order of the model's actuators.
        damping: (nu,), N m s/rad; none if None.
        contacts: Which soles bear, and when; whatever is near the floor if None.
        lead: s from a command until its servos act on it.
        feedforward: Torques along the motion; computed from inverse dynamics if None.
    """

    def __init__(
        self,
        motion: Motion,
        stiffness: Array,
        *,
        damping: Array | None = None,
        contacts: ContactSchedule | None = None,
        lead: float = 0.0,
        feedforward: FeedForward | None = None,
    ) -> None:
        self.motion = motion
        self.stiffness = np.asarray(stiffness, dtype=float)
        self.damping = np.zeros(motion.model.nu) if damping is None else np.asarray(damping)
        self.feedforward = feedforward or FeedForward.along(motion, contacts)
        self._lead = lead
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
        now = max(t, state.time) + self._lead
        velocity = self.motion.sample(now)[1][self._dofs]
        return Command(self._goal(now), velocity, self._none, self._none, self._none)

    def _goal(self, t: float) -> Array:
        qpos, qvel, _ = self.motion.sample(t)
        ahead = self.feedforward.at(t) + self.damping * qvel[self._dofs]
        goal = qpos[self._qpos] + ahead / self.stiffness
        return np.asarray(np.clip(goal, self._low, self._high))
