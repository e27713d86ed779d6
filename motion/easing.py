"""A stretch of a movement that is under way, made one that begins and ends at rest.

A body on its own feet starts from standing, and a capture seldom does. Nothing is invented for it:
the body goes the same way through the same poses, and only the clock runs up to speed at the
start and down at the end,

    u' = 3 x^2 - 2 x^3,    x = t / r,    0 <= x <= 1,

so that the first and last r/2 seconds of the stretch take r.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from enpointe.errors import MotionError
from enpointe.motion.contact_schedule import ContactSchedule
from enpointe.motion.motion import Motion

__all__ = ["Eased", "cut", "ease", "still_at"]

Array = NDArray[np.float64]
_RAMP = 1.0
"""s that the clock takes to run up, and to run down."""
_STAND = 0.5
"""s of standing still before the movement and after it."""
_STILL, _LOOKED_AT = 0.1, 0.05
"""rad/s and m/s, and s: a movement no faster than this for so long is still."""
_SLOWEST, _FASTEST = 100.0, 250.0
"""Samples a second: what is danced is followed by these at least, and at most."""


@dataclass(frozen=True)
class Eased:
    """A stretch of a movement from rest to rest.

    Attributes:
        motion: T samples.
        contacts: Of the same samples.
        source: (T,), the moment of the movement that each shows, s.
    """

    motion: Motion
    contacts: ContactSchedule
    source: Array

    def source_time(self, t: float) -> float:
        """The moment of the movement that is shown at `t` seconds, s."""
        return float(np.interp(t, self.motion.time, self.source))


def still_at(motion: Motion, t: float) -> bool:
    """Whether a movement is at rest about `t` seconds."""
    near = np.abs(motion.time - t) <= _LOOKED_AT
    return bool(np.max(np.abs(motion.qvel[near]), initial=0.0) < _STILL)


def ease(
    motion: Motion, contacts: ContactSchedule, start: float, end: float, speed: float = 1.0
) -> Eased:
    """Take a stretch of a movement, from rest to rest.

    An end of the stretch at which the movement is at rest is left as it is.

    Args:
        motion: What moves.
        contacts: Which soles stand, of the same samples.
        start: s.
        end: s.
        speed: How much faster than the movement, once under way.

    Raises:
        MotionError: The stretch is not in the movement, or shorter than two samples.
    """
    still = (still_at(motion, start), still_at(motion, end))
    return _taken(motion, contacts, (start, end), speed, still)


def cut(
    motion: Motion, contacts: ContactSchedule, start: float, end: float, speed: float = 1.0
) -> Eased:
    """Take a stretch of a movement as it is; as `ease`, but that it may begin and end under way."""
    return _taken(motion, contacts, (start, end), speed, (True, True))


def _taken(
    motion: Motion,
    contacts: ContactSchedule,
    span: tuple[float, float],
    speed: float,
    still: tuple[bool, bool],
) -> Eased:
    start, end = span
    rate = (len(motion.time) - 1) / motion.duration
    if not 0.0 <= start < end <= motion.duration + 1e-9 or (end - start) * rate < 2.0:
        raise MotionError(f"{start:g} to {end:g} s is no stretch of {motion.duration:.2f} s")
    if all(still) and speed == 1.0 and end - start > motion.duration - 0.5 / rate:
        return Eased(motion, contacts, motion.time)
    source = _clock(start, end, still, float(np.clip(rate * speed, _SLOWEST, _FASTEST)), speed)
    time, events = source[0], []
    for event in motion.events:
        if start <= event.time <= end:
            events.append(replace(event, time=float(np.interp(event.time, source[1], time))))
    qpos = np.array([motion.sample(float(t))[0] for t in source[1]])
    taken = Motion.from_qpos(motion.model, time, qpos, events=events, name=motion.name)
    return Eased(taken, _resampled(contacts, time, source[1]), source[1])


def _clock(
    start: float, end: float, still: tuple[bool, bool], rate: float, speed: float
) -> tuple[Array, Array]:
    """Times from 0, evenly, and the moments of the movement that they show."""
    length = end - start
    ramps = [0.0 if each else min(_RAMP, length / speed) for each in still]
    stands = [0.0 if each else _STAND for each in still]
    moving = length / speed + 0.5 * sum(ramps)
    time = np.arange(round((sum(stands) + moving) * rate) + 1) / rate
    since, left = time - stands[0], stands[0] + moving - time
    run_up, run_down = (_lag(x, ramp) for x, ramp in zip((since, left), ramps, strict=True))
    shown = speed * np.where(since < left, run_up, moving - 0.5 * sum(ramps) - run_down)
    return time, np.clip(start + shown, start, end)


def _lag(since: Array, ramp: float) -> Array:
    """How far a clock has run, s, that runs up over `ramp` seconds."""
    if ramp == 0.0:
        return np.maximum(since, 0.0)
    x = np.clip(since / ramp, 0.0, 1.0)
    return np.asarray(ramp * (x**3 - 0.5 * x**4) + np.maximum(since - ramp, 0.0))


def _resampled(contacts: ContactSchedule, time: Array, source: Array) -> ContactSchedule:
    rows = np.array([contacts.index(float(t)) for t in source])
    following = np.minimum(rows + 1, len(contacts.time) - 1)
    width = np.maximum(contacts.time[following] - contacts.time[rows], 1e-9)
    share = np.clip((source - contacts.time[rows]) / width, 0.0, 1.0)
    points = (1 - share)[:, None, None] * contacts.points[rows]
    points += share[:, None, None] * contacts.points[following]
    return ContactSchedule(time, contacts.soles, points, contacts.bears[rows])
