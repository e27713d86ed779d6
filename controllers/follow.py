"""Following a motion by position alone, for bodies with springs of their own: servos."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from enpointe.controllers.plant import Plant
from enpointe.controllers.protocol import Command, State
from enpointe.motion import Motion

__all__ = ["Follow"]

Array = NDArray[np.float64]


class Follow:
    """Position and velocity targets along a motion, and nothing fed forward.

    It keeps to the body's time: where a body in real time has lost periods, it dances on from where
    the music is by now.

    Args:
        motion: What to follow.
    """

    def __init__(self, motion: Motion) -> None:
        self.motion = motion
        plant = Plant(motion.model)
        self._qpos, self._dofs = plant.actuated_qpos, plant.actuated_dofs
        self._none = np.zeros(motion.model.nu)

    @property
    def first_pose(self) -> Array:
        """(nu,) targets at the start, rad."""
        return np.array(self.motion.qpos[0][self._qpos])

    def reset(self, state: State) -> None:
        """Nothing is remembered between commands."""

    def command(self, t: float, state: State) -> Command:
        """Targets at `t` seconds, or at the body's own time if that is later."""
        qpos, qvel, _ = self.motion.sample(max(t, state.time))
        none = self._none
        return Command(qpos[self._qpos], qvel[self._dofs], none, none, none)
