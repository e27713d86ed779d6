"""One movement on the clock of another that dances the same: later, and slower throughout."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from enpointe.errors import MotionError
from enpointe.motion.motion import Motion
from enpointe.motion.slowing import slowed

__all__ = ["in_step"]

_TOGETHER = 0.02
"""s that a key pose may be off its moment: two samples of a rig."""


def in_step(motion: Motion, other: Motion) -> tuple[Motion, float]:
    """A motion at the times at which another one dances the same key poses.

    One scale and one delay take the first and the last key pose to their moments, and must take the
    others to theirs; without key poses in either, the ends are taken. Before it begins it stands in
    its first pose.

    Args:
        motion: To be laid on the other's clock.
        other: Of any body.

    Returns:
        The motion, and how many times its time it has now.

    Raises:
        MotionError: They do not dance the same.
    """
    here, there = _moments(motion), _moments(other)
    scale = 0.0 if len(here) != len(there) else (there[-1] - there[0]) / (here[-1] - here[0])
    delay = there[0] - scale * here[0]
    late = np.abs(scale * here + delay - there).max() if scale > 0.0 else np.inf
    if late > _TOGETHER or delay < -_TOGETHER:
        raise MotionError(
            f"{other.name} is no dance of {motion.name}: it has other key poses or another rhythm"
        )
    return _delayed(slowed(motion, float(scale)), max(float(delay), 0.0)), float(scale)


def _moments(motion: Motion) -> np.ndarray:
    moments = np.array([event.time for event in motion.key_events])
    if len(moments) < 2 or moments[-1] <= moments[0]:
        return np.array([0.0, motion.duration])
    return moments


def _delayed(motion: Motion, delay: float) -> Motion:
    if delay == 0.0:
        return motion
    still = np.zeros((1, motion.model.nv))
    return Motion(
        motion.model,
        np.concatenate([[0.0], motion.time + delay]),
        np.concatenate([motion.qpos[:1], motion.qpos]),
        np.concatenate([still, motion.qvel]),
        np.concatenate([still, motion.qacc]),
        tuple(replace(event, time=event.time + delay) for event in motion.events),
        motion.name,
    )
