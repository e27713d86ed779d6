"""From a score to a motion: expressive, or one of the two baselines it is compared with."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import pairwise

import mujoco
import numpy as np
from numpy.typing import NDArray

from enpointe.errors import MotionError
from enpointe.models.keypose import KeyPose, KeyPoseSolver
from enpointe.models.leg_target import OnPointe, Standing
from enpointe.models.stances import StanceTracker
from enpointe.models.style import Style
from enpointe.models.target import pose_target
from enpointe.motion.averaging import averaged_qpos
from enpointe.motion.bearing import bearing_columns
from enpointe.motion.effort import Effort, find_effort
from enpointe.motion.grounding import Contact, ground
from enpointe.motion.kind import Interpolation
from enpointe.motion.motion import Event, Motion
from enpointe.motion.stations import Station, build_stations
from enpointe.motion.ways import Ways
from enpointe.notation import Score, Side

__all__ = ["COUNT_IN", "Choreography", "interpolate", "solve_key_poses", "ways_of"]

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
    ways: Ways | None = None,
    hold: float | None = None,
    progress: Progress | None = None,
) -> Motion:
    """Fill in the movement between the key poses.

    Args:
        choreography: The solved score.
        effort: Quality of the movement.
        kind: Expressive, or a baseline.
        ways: Those of `ways_of` with the same arguments, where they are wanted afterwards.
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
    ways = ways or ways_of(choreography, effort, kind)
    contacts: dict[Side, list[Contact]] = {side: [None] * count for side in Side}

    for i, (begin, end) in enumerate(pairwise(times)):
        inside = (time >= begin) & (time <= end)
        phase = (time[inside] - begin) / (end - begin)
        share = ways.shares(i, phase)
        way = ways[i]
        qpos[inside] = way.curve(share)
        qpos[time > end] = stations[i + 1].pose.qpos
        for side in Side:
            for sample, gone in zip(np.flatnonzero(inside), share, strict=True):
                contacts[side][sample] = way.contact(side, float(gone))
        if progress is not None:
            progress(i + 1, len(stations) - 1)
    if kind is not Interpolation.SLERP:
        _hold(contacts, stations, time, times)
        qpos = ground(model, time, _round_corners(model, qpos), contacts)
    events = [
        Event(float(t), "key pose", pose.name, float(frame.beat))
        for t, pose, frame in zip(
            choreography.key_times, choreography.key_poses, choreography.score.frames, strict=True
        )
    ]
    return Motion.from_qpos(
        model, time, qpos, events=events, name=f"{choreography.score.title}, {kind.value}"
    )


def ways_of(
    choreography: Choreography,
    effort: Effort,
    kind: Interpolation = Interpolation.EXPRESSIVE,
    *,
    phrased: bool = False,
) -> Ways:
    """The ways between the stations of a choreography, to be solved one by one.

    Args:
        choreography: The solved score.
        effort: Quality of the movement.
        kind: Expressive, or a baseline.
        phrased: Whether a phrase of the score that is marked with a quality is danced in its own.
    """
    stations = choreography.stations
    efforts = [effort] * (len(stations) - 1)
    if phrased:
        efforts = [_own_effort(choreography, i, effort) for i in range(1, len(stations))]
    return Ways(choreography.solver, stations, efforts, kind)


def _own_effort(choreography: Choreography, station: int, effort: Effort) -> Effort:
    """The quality of the way to a station: that of the phrase in which its next frame is."""
    frame = next(s.frame for s in choreography.stations[station:] if s.frame is not None)
    beat = choreography.score.frames[frame].beat
    for phrase in choreography.score.phrases:
        if phrase.effort is not None and phrase.start < beat <= phrase.end:
            return find_effort(phrase.effort)[0]
    return effort


def _hold(
    contacts: dict[Side, list[Contact]], stations: Sequence[Station], time: Array, times: Array
) -> None:
    """Before the first station and after the last its feet stand as they do there."""
    for station, samples in (
        (stations[0], np.flatnonzero(time <= times[0])),
        (stations[-1], np.flatnonzero(time >= times[-1])),
    ):
        for side, leg in station.pose.target.legs.items():
            for sample in samples:
                contacts[side][sample] = leg if isinstance(leg, Standing | OnPointe) else None


def _round_corners(model: mujoco.MjModel, qpos: Array) -> Array:
    """Average over Parzen windows; quaternions nearly agree within one, so theirs is sound too."""
    legs = bearing_columns(model)
    smooth = averaged_qpos(qpos, ROUNDING, RATE)
    smooth[:, legs] = averaged_qpos(qpos, LEG_ROUNDING, RATE)[:, legs]
    return smooth
