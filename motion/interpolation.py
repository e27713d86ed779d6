"""From a score to a motion: expressive, or one of the two baselines it is compared with."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from itertools import pairwise

import mujoco
import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import convolve1d
from scipy.signal.windows import parzen

from enpointe.errors import MotionError
from enpointe.models.keypose import KeyPose, KeyPoseSolver
from enpointe.models.stances import StanceTracker
from enpointe.models.style import Style
from enpointe.models.target import pose_target
from enpointe.motion.bearing import bearing_columns
from enpointe.motion.effort import Effort, logistic
from enpointe.motion.inbetween import Passage, solve_passage
from enpointe.motion.kind import Interpolation
from enpointe.motion.motion import Event, Motion
from enpointe.motion.slerp import slerp_poses
from enpointe.motion.stations import Station, build_stations
from enpointe.notation import Score

__all__ = ["Choreography", "interpolate", "solve_key_poses"]

Array = NDArray[np.float64]
Progress = Callable[[int, int], None]

RATE = 250.0
"""Samples a second."""
COUNT_IN = 0.5
"""Stillness before the first beat, s."""
HOLD = 1.0
"""Stillness after the last beat, s: a dance ends balanced, not falling out of its last pose."""
ROUNDING = 0.12
"""Width of the window that rounds the corners at key poses, s.

The logistic arrives at a key pose with speed left (§5.5.2, figure 5.18) and leaves it in another
direction from rest: an acceleration without bound, which no muscle has. Muscles take 40-60 ms to
raise their force (electromechanical delay and activation time); the motion is averaged over a
Parzen window whose effective width (twice its standard deviation) is that long. A light arrival so
ends in a jolt that the feet must take; a wider window would soften it and no longer be the effort
that was asked.
"""
LEG_ROUNDING = 0.032
"""The same of root and legs, s. They are a chain closed by the floor, and an average of two angles
is not on it: over a wider window a foot that rolls through dips into the floor."""


@dataclass(frozen=True)
class Choreography:
    """A score solved on a dancer: what every way of interpolating starts from.

    Attributes:
        written: The score as it is written.
        score: What is danced: the same with its repeats unrolled.
        solver: Of the dancer.
        stations: All poses that the dance goes through, in order.
        tempo: Pulses a minute.
    """

    written: Score
    score: Score
    solver: KeyPoseSolver
    stations: tuple[Station, ...]
    tempo: float

    @property
    def key_poses(self) -> tuple[KeyPose, ...]:
        """One for each frame of the danced score."""
        return tuple(station.pose for station in self.stations if station.frame is not None)

    @property
    def key_times(self) -> Array:
        """When each key pose is reached, s from the start of the motion, (K,)."""
        times = [station.time for station in self.stations if station.frame is not None]
        return COUNT_IN + np.array(times)


def solve_key_poses(
    score: Score,
    solver: KeyPoseSolver,
    *,
    style: Style | None = None,
    tempo: float | None = None,
    still: bool = False,
    progress: Progress | None = None,
) -> Choreography:
    """Solve every frame of a score.

    Args:
        score: What is danced.
        solver: Of the dancer.
        style: The method's amounts.
        tempo: Pulses a minute; the score's own if None.
        still: Take a score of one frame, which is a pose to hold.
        progress: Called with (done, all).

    Raises:
        ScoreError: A sign out of reach, or a tempo that can't be danced.
        PoseError: A frame without a pose.
    """
    score.duration(tempo)
    danced = score.performed()
    danced.duration(tempo)
    frames = danced.resolved()
    if len(frames) < 2 and not still:
        raise MotionError(f"{score.title!r} has one frame; a motion needs two at least")
    tracker = StanceTracker(solver.figure, (style or Style()).turnout_deg)
    targets = [
        pose_target(frame, solver.figure, style, ground=tracker.follow(frame), source=score.source)
        for frame in frames
    ]
    stations = build_stations(danced, frames, targets, solver, tempo, progress)
    return Choreography(score, danced, solver, stations, tempo or score.tempo)


def interpolate(
    choreography: Choreography,
    effort: Effort,
    kind: Interpolation = Interpolation.EXPRESSIVE,
    *,
    hold: float | None = None,
    progress: Progress | None = None,
) -> Motion:
    """Fill in the movement between the key poses.

    Args:
        choreography: The solved score.
        effort: Quality of the movement.
        kind: Expressive, or a baseline.
        hold: Stillness after the last beat, s; `HOLD` if None.
        progress: Called with (done, all).

    Returns:
        A motion at `RATE`, with a count-in before the first beat and a hold after the last, and a
        "key pose" event at each frame.
    """
    stations = choreography.stations
    times = COUNT_IN + np.array([station.time for station in stations])
    count = round((times[-1] + (HOLD if hold is None else hold)) * RATE) + 1
    time = np.arange(count) / RATE
    model = choreography.solver.model
    qpos = np.empty((count, model.nq))
    qpos[:] = stations[0].pose.qpos
    curves = _Curves(choreography, effort, kind)

    def timing(phase: Array) -> Array:
        return logistic(phase, effort.time, effort.weight)

    for i, (begin, end) in enumerate(pairwise(times)):
        inside = (time >= begin) & (time <= end)
        phase = (time[inside] - begin) / (end - begin)
        law = stations[i + 1].law
        share = phase if kind is Interpolation.SLERP else law.share(phase, timing)
        qpos[inside] = curves(i)(share)
        qpos[time > end] = stations[i + 1].pose.qpos
        if progress is not None:
            progress(i + 1, len(stations) - 1)
    if kind is not Interpolation.SLERP:
        qpos = _round_corners(model, qpos)
    events = [
        Event(float(t), "key pose", pose.name, float(frame.beat))
        for t, pose, frame in zip(
            choreography.key_times, choreography.key_poses, choreography.score.frames, strict=True
        )
    ]
    return Motion.from_qpos(
        model, time, qpos, events=events, name=f"{choreography.score.title}, {kind.value}"
    )


class _Curves:
    """The way between each pair of key poses; a repeated pair is solved once."""

    def __init__(self, choreography: Choreography, effort: Effort, kind: Interpolation) -> None:
        self._choreography = choreography
        self._kind = kind
        direct = Effort(effort.time, effort.weight, 1.0)
        self._effort = effort if kind is Interpolation.EXPRESSIVE else direct
        self._known: dict[tuple[bytes, bytes], Callable[[Array], Array]] = {}

    def __call__(self, index: int) -> Callable[[Array], Array]:
        start, end = self._choreography.stations[index : index + 2]
        key = (start.pose.qpos.tobytes(), end.pose.qpos.tobytes())
        if key not in self._known:
            self._known[key] = self._make(start.pose, end.pose, end)
        return self._known[key]

    def _make(self, start: KeyPose, end: KeyPose, station: Station) -> Callable[[Array], Array]:
        solver = self._choreography.solver
        if self._kind is Interpolation.SLERP:
            return lambda share: slerp_poses(solver.model, start.qpos, end.qpos, share)
        inflect = self._kind is Interpolation.EXPRESSIVE
        passage: Passage = solve_passage(
            solver, start, end, self._effort, inflect=inflect, com=_flown(station)
        )
        return passage.curve(solver.model)


def _flown(station: Station) -> Callable[[float], Array] | None:
    """The centre of mass on the way to a station, for one reached through the air."""
    if station.flight is None:
        return None
    flight, (first, last) = station.flight, station.span
    return lambda share: flight.at((1 - share) * first + share * last)


def _round_corners(model: mujoco.MjModel, qpos: Array) -> Array:
    """Average over Parzen windows; quaternions nearly agree within one, so theirs is sound too."""
    legs = bearing_columns(model)
    smooth = _averaged(qpos, ROUNDING)
    smooth[:, legs] = _averaged(qpos[:, legs], LEG_ROUNDING)
    smooth[:, 3:7] /= np.linalg.norm(smooth[:, 3:7], axis=1, keepdims=True)
    return smooth


def _averaged(values: Array, width: float) -> Array:
    window = parzen(2 * int(width * RATE / 2) + 1, sym=True)
    return np.asarray(convolve1d(values, window / window.sum(), axis=0, mode="nearest"))
