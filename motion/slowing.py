"""A motion in more or less time, every moment alike: rhythm and effort keep their proportions."""

from __future__ import annotations

from dataclasses import replace

from enpointe.errors import MotionError
from enpointe.motion.motion import Motion

__all__ = ["slowed"]


def slowed(motion: Motion, time_scale: float) -> Motion:
    """The motion in `time_scale` times its time.

    The share of the way gone at each share of the time stays, and with it the logistic of the
    effort (Neagle 2005, eq. 5.2), where the speed is greatest, and every ratio of durations.

    Raises:
        MotionError: A scale that is not above 0.
    """
    if not 0.0 < time_scale < float("inf"):
        raise MotionError(f"a time scale is above 0, not {time_scale:g}")
    return Motion(
        motion.model,
        motion.time * time_scale,
        motion.qpos,
        motion.qvel / time_scale,
        motion.qacc / time_scale**2,
        tuple(replace(event, time=event.time * time_scale) for event in motion.events),
        motion.name,
    )
