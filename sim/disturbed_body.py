"""A simulated body whose senses are late and noisy, and which is pushed."""

from __future__ import annotations

import dataclasses
from collections import deque

import mujoco
import numpy as np
from numpy.random import default_rng
from numpy.typing import NDArray

from enpointe.controllers import Command, State
from enpointe.motion import Motion
from enpointe.sim.body import CONTROL_PERIOD
from enpointe.sim.disturbance import ANGLE_NOISE, VELOCITY_NOISE, Factors
from enpointe.sim.push import PushedBody

__all__ = ["DisturbedBody"]

Array = NDArray[np.float64]


class DisturbedBody(PushedBody):
    """The body of one run of a sweep, at the start of a motion and at rest.

    What `read` tells is as old as the delay, between two samples on the straight way from one to
    the other, with white noise on the joints' angles and velocities and on the pelvis' orientation
    and rate of turn. Where the pelvis is in the room is told without noise. What really happened
    stands in the channels `true_qpos` and `true_qvel`.

    Args:
        motion: What is to be danced.
        factors: What was drawn.
    """

    def __init__(self, motion: Motion, factors: Factors) -> None:
        pushes = () if factors.push is None else (factors.push,)
        period = factors.period or CONTROL_PERIOD
        super().__init__(pushes, factors.applied(motion.model), motion.qpos[0], period=period)
        self._rng = default_rng(factors.senses)
        self._noise = factors.noise or 0.0
        self._delay = factors.delay or 0.0
        self._turning = _turning(self.model)
        self._age = np.full(self.model.nu, self._delay)
        remembered = int(np.ceil(self._delay / period - 1e-9)) + 1
        self._past: deque[State] = deque([super().read()], maxlen=remembered)
        self._true = self._past[-1]
        self._sensed = self._sense()

    def read(self) -> State:
        """The state as the senses tell it; the same until the next command."""
        return self._sensed

    def write(self, command: Command) -> None:
        """Take a command, let one period pass, and sense what came of it."""
        self._true = self._past[-1]
        super().write(command)
        self._past.append(super().read())
        self._sensed = self._sense()

    def observe(self) -> dict[str, NDArray[np.generic]]:
        """What the simulated body observes, and the state before the last command as it was."""
        return {
            **super().observe(),
            "true_qpos": self._true.qpos,
            "true_qvel": self._true.qvel,
        }

    def _sense(self) -> State:
        now = self._past[-1]
        qpos, qvel = self._at(now.time - self._delay)
        if self._noise:
            turn, rate = np.zeros((2, self.model.nv))
            count = int(self._turning.sum())
            turn[self._turning] = self._noise * ANGLE_NOISE * self._rng.standard_normal(count)
            rate[self._turning] = self._noise * VELOCITY_NOISE * self._rng.standard_normal(count)
            mujoco.mj_integratePos(self.model, qpos, turn, 1.0)
            qvel = qvel + rate
        return dataclasses.replace(now, qpos=qpos, qvel=qvel, age=self._age)

    def _at(self, time: float) -> tuple[Array, Array]:
        """State at a moment of the past; the oldest one known before that."""
        older = newer = self._past[0]
        for newer in self._past:
            if newer.time >= time:
                break
            older = newer
        span = newer.time - older.time
        share = min(max((time - older.time) / span, 0.0), 1.0) if span > 0.0 else 0.0
        qpos, way = older.qpos.copy(), np.zeros(self.model.nv)
        mujoco.mj_differentiatePos(self.model, way, 1.0, older.qpos, newer.qpos)
        mujoco.mj_integratePos(self.model, qpos, way, share)
        return qpos, (1.0 - share) * older.qvel + share * newer.qvel


def _turning(model: mujoco.MjModel) -> NDArray[np.bool_]:
    """The degrees of freedom that are angles, (nv,): all but a free root's three of place."""
    turning = np.ones(model.nv, dtype=bool)
    for joint in np.flatnonzero(model.jnt_type == mujoco.mjtJoint.mjJNT_FREE):
        first = int(model.jnt_dofadr[joint])
        turning[first : first + 3] = False
    return turning
