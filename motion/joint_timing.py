"""How joints share out a way over its time: what of an effort is left in a body without wrists.

`wrist_profiles` follows the wrists in space, which a puppet may not have. Joints it has: between
two key poses a joint's way is the sum of what it turns, and the share of it gone at each share of
the time is fitted with the same logistic (Neagle 2005, eqs 5.2 and 5.4).
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from itertools import pairwise

import mujoco
import numpy as np
from numpy.typing import NDArray

from enpointe.motion.motion import Motion
from enpointe.motion.wrist import LogisticFit, fit_logistic

__all__ = ["JointTiming", "TimingKept", "joint_timings", "timing_kept"]

Array = NDArray[np.float64]
_MOVES = np.radians(10.0)
"""A joint that goes less than this between two key poses waits, and is not counted."""
_POINTS = 101


@dataclass(frozen=True, slots=True)
class JointTiming:
    """One joint between two key poses.

    Attributes:
        joint: Its name.
        start: Name of the key pose before.
        end: Name of the next.
        phase: (S,), share of the time, 0 to 1.
        distance: (S,), share of the way, 0 to 1.
        speed: (S,), share of the way a share of the time: its mean is 1.
        length: Of the way, rad.
    """

    joint: str
    start: str
    end: str
    phase: Array
    distance: Array
    speed: Array
    length: float

    @property
    def peak(self) -> float:
        """The share of the time at which it is fastest."""
        return float(self.phase[int(np.argmax(self.speed))])


@dataclass(frozen=True, slots=True)
class TimingKept:
    """What of the timing that was asked came out.

    Attributes:
        asked: The logistic of what was asked; None where nothing moves.
        done: Of what was done.
        distance_rms: Root mean square between the shares of the way, at equal shares of the time.
        speed_correlation: Of the speed profiles, 1 for the same shape; the mean over all.
        peak_shift: Share of the time by which the greatest speed comes later; the median.
        lag: s by which all comes later, taken out of the three above.
        ways: How many joints' ways were compared.
    """

    asked: LogisticFit | None
    done: LogisticFit | None
    distance_rms: float
    speed_correlation: float
    peak_shift: float
    lag: float
    ways: int


def joint_timings(motion: Motion, joints: Iterable[str], lag: float = 0.0) -> list[JointTiming]:
    """The ways of joints between the key poses of a motion.

    Args:
        motion: With key poses among its events.
        joints: Names of hinges.
        lag: s by which the motion is late at all its key poses.
    """
    model = motion.model
    angles = {name: motion.qpos[:, model.joint(name).qposadr[0]] for name in joints}
    phase = np.linspace(0.0, 1.0, _POINTS)
    found = []
    for before, after in pairwise(motion.key_events):
        moments = before.time + phase * (after.time - before.time) + lag
        if after.time <= before.time:
            continue
        for name, angle in angles.items():
            steps = np.abs(np.diff(np.interp(moments, motion.time, angle)))
            length = float(steps.sum())
            if length < _MOVES:
                continue
            distance = np.concatenate([[0.0], np.cumsum(steps)]) / length
            speed = np.gradient(distance, phase)
            found.append(JointTiming(name, before.name, after.name, phase, distance, speed, length))
    return found


def timing_kept(asked: Motion, done: Motion, joints: Sequence[str]) -> TimingKept:
    """Compare the timing of two motions of one body, the second a performance of the first."""
    lag = _lag(asked, done, joints)
    wanted = {_key(each): each for each in joint_timings(asked, joints)}
    came = {_key(each): each for each in joint_timings(done, joints, lag)}
    both = [(wanted[key], came[key]) for key in wanted if key in came]
    if not both:
        return TimingKept(None, None, 0.0, 1.0, 0.0, lag, 0)
    apart = [np.mean((a.distance - b.distance) ** 2) for a, b in both]
    alike = [np.corrcoef(a.speed, b.speed)[0, 1] for a, b in both]
    return TimingKept(
        fit_logistic([a for a, _ in both]),
        fit_logistic([b for _, b in both]),
        float(np.sqrt(np.mean(apart))),
        float(np.mean(alike)),
        float(np.median([b.peak - a.peak for a, b in both])),
        lag,
        len(both),
    )


def _key(timing: JointTiming) -> tuple[str, str, str]:
    return timing.joint, timing.start, timing.end


def _lag(asked: Motion, done: Motion, joints: Sequence[str]) -> float:
    """The delay at which the angles of both differ least, s, up to half a second."""
    model: mujoco.MjModel = asked.model
    columns = [int(model.joint(name).qposadr[0]) for name in joints]
    moments = np.arange(0.0, min(asked.duration, done.duration), 0.01)

    def apart(delay: float) -> float:
        total = 0.0
        for column in columns:
            wanted = np.interp(moments, asked.time, asked.qpos[:, column])
            came = np.interp(moments + delay, done.time, done.qpos[:, column])
            total += float(np.sum((wanted - came) ** 2))
        return total

    delays = np.arange(0.0, 0.5, 0.005)
    return float(delays[int(np.argmin([apart(delay) for delay in delays]))])
