"""Proportional-derivative tracking of a motion, with the torques it needs fed forward."""

from __future__ import annotations

from enpointe.controllers.feedforward import FeedForward
from enpointe.controllers.gains import Gains
from enpointe.controllers.plant import Plant
from enpointe.controllers.protocol import Command, State
from enpointe.motion import Motion

__all__ = ["PD"]


class PD:
    """tau = tau_ff(t) + K (q_ref(t) - q) + D (v_ref(t) - v), joint by joint.

    It has no sense of balance: nothing is fed back from the root. Two feet on the floor and gains
    of `Gains.suggested` stand; one foot does not (see docs/control.md).

    Args:
        motion: What to track.
        gains: Stiffness and damping; `Gains.suggested` for the motion's first pose if None.
        feedforward: Torques along the motion; computed from inverse dynamics if None.
    """

    def __init__(
        self,
        motion: Motion,
        gains: Gains | None = None,
        feedforward: FeedForward | None = None,
    ) -> None:
        self.motion = motion
        self.gains = gains or Gains.suggested(motion.model, motion.qpos[0])
        self.feedforward = feedforward or FeedForward.along(motion)
        plant = Plant(motion.model)
        self._qpos, self._dofs = plant.actuated_qpos, plant.actuated_dofs

    def reset(self, state: State) -> None:
        """Nothing is remembered between commands."""

    def command(self, t: float, state: State) -> Command:
        """Targets, torques and gains at `t` seconds."""
        qpos, qvel, _ = self.motion.sample(t)
        return Command(
            position=qpos[self._qpos],
            velocity=qvel[self._dofs],
            torque=self.feedforward.at(t),
            stiffness=self.gains.stiffness,
            damping=self.gains.damping,
        )
