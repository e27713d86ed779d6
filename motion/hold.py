"""Standing still: one pose, held."""

from __future__ import annotations

import mujoco
import numpy as np
from numpy.typing import ArrayLike

from enpointe.errors import MotionError
from enpointe.motion.motion import Event, Motion

__all__ = ["hold"]

_RATE = 50.0


def hold(model: mujoco.MjModel, qpos: ArrayLike, seconds: float, *, name: str = "hold") -> Motion:
    """A pose held without moving.

    Args:
        model: The body.
        qpos: (nq,).
        seconds: How long, s, positive.
        name: Of the pose, for people.

    Returns:
        A motion with one "key pose" event at its start.

    Raises:
        MotionError: A time that can't be held, or a pose of another size.
    """
    if not (np.isfinite(seconds) and seconds > 0.0):
        raise MotionError(f"a pose is held for a positive time, not {seconds:g} s")
    pose = np.asarray(qpos, dtype=float)
    if pose.shape != (model.nq,):
        raise MotionError(f"a pose of this body has shape ({model.nq},), got {pose.shape}")
    frames = max(round(seconds * _RATE), 1) + 1
    time = np.linspace(0.0, seconds, frames)
    still = np.zeros((frames, model.nv))
    return Motion(
        model, time, np.tile(pose, (frames, 1)), still, still, (Event(0.0, "key pose", name),), name
    )
