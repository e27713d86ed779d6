"""What came of an effort: distance and speed of the wrists between key poses, and the logistic fit.

Neagle 2005 §5.4.2 and figure 5.7: between two key poses, time and distance along the path both run
from 0 to 1. The wrist is measured in the torso's frame, where the stave has it, so that an
inclination of the body does not count as movement of the arm.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Protocol

import mujoco
import numpy as np
from numpy.typing import NDArray
from scipy.optimize import least_squares

from enpointe.motion.effort import logistic
from enpointe.motion.motion import Motion
from enpointe.notation import Side

__all__ = ["LogisticFit", "Profile", "Way", "fit_logistic", "wrist_paths", "wrist_profiles"]

Array = NDArray[np.float64]
_MOVES = 0.10
"""A wrist that goes less than this (m) between two key poses waits, and is not fitted."""


@dataclass(frozen=True, slots=True)
class Profile:
    """One wrist between two key poses.

    Attributes:
        side: Whose.
        start: Name of the key pose before.
        end: Name of the next.
        phase: (S,), share of the time, 0 to 1.
        distance: (S,), share of the way, 0 to 1.
        speed: (S,), m/s.
        length: Of the way, m.
        seconds: Between the key poses.
    """

    side: Side
    start: str
    end: str
    phase: Array
    distance: Array
    speed: Array
    length: float
    seconds: float


class Way(Protocol):
    """Anything that goes its way from 0 to 1 while its time goes from 0 to 1."""

    @property
    def phase(self) -> Array:
        """(S,), share of the time."""

    @property
    def distance(self) -> Array:
        """(S,), share of the way."""


@dataclass(frozen=True, slots=True)
class LogisticFit:
    """The logistic that fits a set of profiles best.

    Attributes:
        time: Gradient b.
        weight: Centroid x0.
        rms: Root mean square of what is left, in shares of the way.
        profiles: How many were fitted.
    """

    time: float
    weight: float
    rms: float
    profiles: int


def wrist_paths(model: mujoco.MjModel, qpos: Array) -> dict[Side, Array]:
    """Both wrists in the torso's frame along a trajectory, each (T, 3), m."""
    data = mujoco.MjData(model)
    torso = model.body("torso").id
    sites = {side: model.site(f"{side}_wrist").id for side in Side}
    paths = {side: np.empty((len(qpos), 3)) for side in Side}
    for i, pose in enumerate(qpos):
        data.qpos[:] = pose
        mujoco.mj_kinematics(model, data)
        rotation = data.xmat[torso].reshape(3, 3)
        for side, site in sites.items():
            paths[side][i] = rotation.T @ (data.site_xpos[site] - data.xpos[torso])
    return paths


def wrist_profiles(motion: Motion) -> tuple[Profile, ...]:
    """The profiles of every wrist that moves between two key poses of a motion."""
    paths = wrist_paths(motion.model, motion.qpos)
    speeds = {
        side: np.linalg.norm(np.gradient(path, motion.time, axis=0), axis=1)
        for side, path in paths.items()
    }
    profiles = []
    events = motion.key_events
    for before, after in pairwise(events):
        inside = (motion.time >= before.time - 1e-9) & (motion.time <= after.time + 1e-9)
        if inside.sum() < 3:
            continue
        phase = (motion.time[inside] - before.time) / (after.time - before.time)
        for side, path in paths.items():
            steps = np.linalg.norm(np.diff(path[inside], axis=0), axis=1)
            walked = np.concatenate([[0.0], np.cumsum(steps)])
            if walked[-1] < _MOVES:
                continue
            profiles.append(
                Profile(
                    side,
                    before.name,
                    after.name,
                    phase,
                    walked / walked[-1],
                    speeds[side][inside],
                    float(walked[-1]),
                    after.time - before.time,
                )
            )
    return tuple(profiles)


def fit_logistic(profiles: Sequence[Way]) -> LogisticFit | None:
    """Fit eq. 5.2 with the asymptote of eq. 5.4 to all profiles together; None without any.

    Every profile counts alike, however many samples it has.
    """
    if not profiles:
        return None
    phase = np.concatenate([p.phase for p in profiles])
    distance = np.concatenate([p.distance for p in profiles])
    weight = np.concatenate([np.full(len(p.phase), len(p.phase) ** -0.5) for p in profiles])

    def residual(x: Array) -> Array:
        return np.asarray(weight * (logistic(phase, x[0], x[1]) - distance))

    found = least_squares(residual, x0=[-2.5, 0.5], bounds=([-12.0, 0.05], [-1.01, 1.5]))
    rms = float(np.sqrt(np.sum(found.fun**2) / len(profiles)))
    return LogisticFit(float(found.x[0]), float(found.x[1]), rms, len(profiles))
