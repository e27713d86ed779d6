"""Movement sampled in time."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field

import mujoco
import numpy as np
from numpy.typing import ArrayLike, NDArray

from enpointe.errors import MotionError

__all__ = ["Event", "Motion"]

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class Event:
    """Something that happens at a moment of a motion.

    Attributes:
        time: s from the start of the motion.
        kind: "key pose" or "contact".
        name: What it is.
        beat: The pulse it falls on, or None.
    """

    time: float
    kind: str
    name: str
    beat: float | None = None


@dataclass(frozen=True)
class Motion:
    """A trajectory of one model.

    Attributes:
        model: The body that it belongs to.
        time: (T,), s, strictly increasing from 0.
        qpos: (T, nq), metres, unit quaternions and radians.
        qvel: (T, nv), velocities as MuJoCo has them, per second.
        qacc: (T, nv), per second squared.
        events: In order of time.
        name: For people.
    """

    model: mujoco.MjModel = field(repr=False)
    time: Array
    qpos: Array
    qvel: Array
    qacc: Array
    events: tuple[Event, ...] = ()
    name: str = "motion"

    def __post_init__(self) -> None:
        """Check shapes and times.

        Raises:
            MotionError: Shapes that do not fit the model, times that do not increase, no numbers.
        """
        frames = len(self.time)
        for name, array, width in (
            ("qpos", self.qpos, self.model.nq),
            ("qvel", self.qvel, self.model.nv),
            ("qacc", self.qacc, self.model.nv),
        ):
            if array.shape != (frames, width):
                raise MotionError(f"{name} must have shape ({frames}, {width}), got {array.shape}")
            if not np.all(np.isfinite(array)):
                raise MotionError(f"{name} of {self.name} has values that are not numbers")
        if frames < 2 or self.time[0] != 0.0 or not np.all(np.diff(self.time) > 0):
            raise MotionError("times must start at 0, increase, and be two at least")

    @classmethod
    def from_qpos(
        cls,
        model: mujoco.MjModel,
        time: ArrayLike,
        qpos: ArrayLike,
        *,
        events: Iterable[Event] = (),
        name: str = "motion",
    ) -> Motion:
        """A motion from configurations alone; velocities and accelerations by central differences.

        Args:
            model: The body.
            time: (T,), s, evenly spaced from 0.
            qpos: (T, nq).
            events: In order of time.
            name: For people.
        """
        times, frames = np.asarray(time, dtype=float), np.asarray(qpos, dtype=float)
        if frames.ndim != 2 or frames.shape[1] != model.nq or len(times) != len(frames):
            raise MotionError(
                f"qpos must have shape ({len(times)}, {model.nq}), got {frames.shape}"
            )
        velocity = _differentiate(model, times, frames)
        acceleration = np.gradient(velocity, times, axis=0)
        return cls(model, times, frames, velocity, acceleration, tuple(events), name)

    @property
    def duration(self) -> float:
        """s."""
        return float(self.time[-1])

    @property
    def key_events(self) -> tuple[Event, ...]:
        """The key poses, in order."""
        return tuple(event for event in self.events if event.kind == "key pose")

    def sample(self, t: float) -> tuple[Array, Array, Array]:
        """qpos (nq,), qvel (nv,) and qacc (nv,) at `t` seconds, held beyond both ends.

        Linear between samples, the root's quaternion normalised; velocity and acceleration are zero
        beyond the ends.
        """
        if t >= self.time[-1]:
            return self.qpos[-1].copy(), np.zeros(self.model.nv), np.zeros(self.model.nv)
        if t < 0.0:
            return self.qpos[0].copy(), np.zeros(self.model.nv), np.zeros(self.model.nv)
        i = max(int(np.searchsorted(self.time, t, side="right")) - 1, 0)
        w = min(max((t - self.time[i]) / (self.time[i + 1] - self.time[i]), 0.0), 1.0)
        qpos = (1 - w) * self.qpos[i] + w * self.qpos[i + 1]
        mujoco.mj_normalizeQuat(self.model, qpos)
        qvel = (1 - w) * self.qvel[i] + w * self.qvel[i + 1]
        qacc = (1 - w) * self.qacc[i] + w * self.qacc[i + 1]
        return qpos, qvel, qacc


def _differentiate(model: mujoco.MjModel, time: Array, qpos: Array) -> Array:
    velocity = np.zeros((len(time), model.nv))
    last = len(time) - 1
    for i in range(len(time)):
        before, after = max(i - 1, 0), min(i + 1, last)
        mujoco.mj_differentiatePos(
            model, velocity[i], time[after] - time[before], qpos[before], qpos[after]
        )
    return velocity
