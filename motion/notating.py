"""From a motion to a score: key moments, the beats they fall on, and the poses by their names."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from copy import copy
from dataclasses import dataclass, replace
from fractions import Fraction
from itertools import zip_longest
from math import atan2, degrees, hypot

import numpy as np
from numpy.typing import NDArray

from enpointe.errors import MotionError
from enpointe.models.foot_positions import DEFAULT_TURNOUT_DEG, Footprint
from enpointe.models.joints import Joints
from enpointe.models.recognition import Recogniser, Recognition, recogniser_of
from enpointe.models.stances import StanceTracker
from enpointe.motion.beats import Pulse, find_pulse, on_the_beat
from enpointe.motion.in_flight import TOUCH, in_flight, is_position, landed
from enpointe.motion.inscribing import Scribe, same_position
from enpointe.motion.keyframes import (
    LEAST_SPACING,
    Flight,
    KeyMoment,
    MotionOutline,
    key_moments,
)
from enpointe.motion.motion import Motion
from enpointe.notation import Frame, Jump, Score, Side, StagePlace, Travel

__all__ = ["NotatedFrame", "NotatedMotion", "notate", "read_motion"]

_RATE = 50.0
"""Samples a second that are looked at."""
_TRAVEL = 0.12
"""Least way on the stage that is written, m: half a foot's length."""


@dataclass(frozen=True)
class NotatedFrame:
    """One frame and the moment that it was read from.

    Attributes:
        frame: As the score has it.
        time: s from the start of the motion.
        recognition: What the pose there is called, and how far it is from that.
    """

    frame: Frame
    time: float
    recognition: Recognition


@dataclass(frozen=True)
class NotatedMotion:
    """A motion read back.

    Attributes:
        score: What was danced.
        frames: Its frames, with their moments.
        pulse: The pulse that was found or given.
        estimated: Whether it was found.
    """

    score: Score
    frames: tuple[NotatedFrame, ...]
    pulse: Pulse
    estimated: bool


def notate(motion: Motion, tempo: float | None = None, *, metre: tuple[int, int] = (4, 4)) -> Score:
    """Write a motion down.

    Args:
        motion: Of any dancer of ours.
        tempo: Pulses a minute; estimated from the key moments if None, which may find a pulse half
            or twice as fast as the dancer's.
        metre: Pulses in a bar and the note value of a pulse; it can't be seen.

    Returns:
        A valid score: named positions where they are recognised, signs otherwise, only what
        changes.

    Raises:
        MotionError: A motion in which nothing moves, or a tempo that can't be danced.
    """
    return read_motion(motion, tempo, metre=metre).score


def read_motion(
    motion: Motion, tempo: float | None = None, *, metre: tuple[int, int] = (4, 4)
) -> NotatedMotion:
    """The same, with the moments that the frames were read from; see `notate`."""
    recogniser = recogniser_of(motion.model)
    every = max(round((len(motion.time) - 1) / (motion.duration * _RATE)), 1)
    time, qpos = motion.time[::every], motion.qpos[::every]
    outline = MotionOutline(time, [Joints.of(motion.model, pose) for pose in qpos])
    if outline.still.all():
        raise MotionError(f"nothing moves in {motion.name}; a score needs two poses at least")
    moments = _positions(outline, motion, recogniser)
    pulse = find_pulse(_marked([moment for moment, _ in moments]), tempo)
    scribe = Scribe()
    kept: list[tuple[KeyMoment, Recognition]] = []
    for beat, moment, recognition in _on_beats(moments, pulse):
        turned = _turned(outline, kept[-1][0].time if kept else moment.time, moment.time)
        scribe.write(beat, recognition, turned, moment.holds and bool(kept))
        kept.append((moment, recognition))
    frames = _with_jumps(scribe.frames, [m.time for m, _ in kept], outline.flights, pulse)
    own = pulse.tempo if tempo is None else tempo
    score = Score(motion.name, "Cecchetti", metre, own, tuple(frames))
    score = _with_travel(score, motion, [m.time for m, _ in kept], recogniser)
    notated = tuple(
        NotatedFrame(frame, moment.time, recognition)
        for frame, (moment, recognition) in zip(score.frames, kept, strict=True)
    )
    return NotatedMotion(score, notated, pulse, tempo is None)


def _positions(
    outline: MotionOutline, motion: Motion, recogniser: Recogniser
) -> list[tuple[KeyMoment, Recognition]]:
    """The moments to write, each with its pose: unsure ones only where the pose has a name.

    Neither are those that say nothing new: a limb that pauses in a position which she has not left,
    or into which all the rest still settles.
    """

    def pose_at(time: float) -> Recognition:
        pose = recogniser.recognise(motion.sample(time)[0])
        landing = any(flight.end <= time <= flight.end + TOUCH for flight in outline.flights)
        return landed(pose) if landing else pose

    found = [(moment, pose_at(moment.time)) for moment in key_moments(outline)]
    kept = [(moment, pose) for moment, pose in found if moment.sure]
    unsure = [*in_flight(outline, pose_at), *(each for each in found if not each[0].sure)]
    for moment, pose in unsure:
        apart = min(abs(moment.time - other.time) for other, _ in kept)
        if apart >= LEAST_SPACING and (moment.sure or is_position(pose)):
            kept.append((moment, pose))
    return _without_repeats(sorted(kept, key=lambda each: each[0].time))


def _without_repeats(
    found: Sequence[tuple[KeyMoment, Recognition]],
) -> list[tuple[KeyMoment, Recognition]]:
    """The moments without the unsure ones that read as the one before or the sure one after."""
    kept: list[tuple[KeyMoment, Recognition]] = []
    for (moment, pose), after in zip_longest(found, found[1:]):
        settles = after is not None and after[0].sure and same_position(pose, after[1])
        stays = bool(kept) and same_position(pose, kept[-1][1])
        if moment.sure or not (settles or stays):
            kept.append((moment, pose))
    return kept


def _marked(moments: Sequence[KeyMoment]) -> list[float]:
    """The times that say what the pulse is: those of pauses, if there are enough."""
    sure = [moment.time for moment in moments if moment.sure]
    return sure if len(sure) > 2 else [moment.time for moment in moments]


def _on_beats(
    moments: Sequence[tuple[KeyMoment, Recognition]], pulse: Pulse
) -> list[tuple[Fraction, KeyMoment, Recognition]]:
    """Each moment on its own beat, the first on 0; of two on one beat the more marked."""
    placed: list[tuple[Fraction, KeyMoment, Recognition]] = []
    for moment, recognition in moments:
        beat = on_the_beat(pulse.beat(moment.time)) if placed else Fraction(0)
        if placed and beat <= placed[-1][0]:
            if moment.depth > placed[-1][1].depth and len(placed) > 1:
                placed[-1] = (placed[-1][0], moment, recognition)
            continue
        placed.append((beat, moment, recognition))
    return placed


def _turned(outline: MotionOutline, start: float, end: float) -> float:
    """How far the pelvis turns from one moment to another, degrees, + to the left."""
    angles = np.interp([start, end], outline.time, outline.turned)
    return degrees(float(angles[1] - angles[0]))


def _with_jumps(
    frames: Sequence[Frame], times: Sequence[float], flights: Sequence[Flight], pulse: Pulse
) -> list[Frame]:
    """Each flight in the frame that it lands in."""
    written = list(frames)
    landed = Fraction(0)
    for flight in flights:
        i = int(np.searchsorted(times, flight.end - 1e-9))
        if not 0 < i < len(written) or written[i].jump is not None:
            continue
        on = min(_to_a_quarter(pulse.beat(flight.end)), written[i].beat)
        off = max(min(_to_a_quarter(pulse.beat(flight.start)), on - Fraction(1, 4)), landed)
        if off < on:
            written[i] = replace(written[i], jump=Jump(off, on))
            landed = on
    return written


def _to_a_quarter(beat: float) -> Fraction:
    return Fraction(round(4 * beat), 4)


def _with_travel(
    score: Score, motion: Motion, times: Sequence[float], recogniser: Recogniser
) -> Score:
    """The same score with the ways on the stage that its steps alone do not make."""
    frames = list(score.frames)
    tracker = StanceTracker(recogniser.figure, DEFAULT_TURNOUT_DEG)
    for i, time in enumerate(times):
        joints = Joints.of(motion.model, motion.sample(time)[0])
        resolved = replace(score, frames=tuple(frames)).resolved()[i]
        ground = copy(tracker).follow(resolved)
        missing = _missing(ground.prints, joints, recogniser)
        if missing is not None and hypot(*missing) > _TRAVEL:
            frames[i] = _moved(frames[i], missing, first=i == 0)
            resolved = replace(score, frames=tuple(frames)).resolved()[i]
        tracker.follow(resolved)
    return replace(score, frames=tuple(frames))


def _missing(
    predicted: Mapping[Side, Footprint], joints: Joints, recogniser: Recogniser
) -> NDArray[np.float64] | None:
    """How far the feet that bear are from where the frames put them, forward and left, m."""
    if not predicted:
        return None
    forward = recogniser.figure.ball_forward
    away = [joints[f"{side}_ball"][:2] - foot.point(forward) for side, foot in predicted.items()]
    return np.asarray(np.mean(away, axis=0))


def _moved(frame: Frame, way: NDArray[np.float64], *, first: bool) -> Frame:
    forward, left = (0.05 * round(float(each) / 0.05) + 0.0 for each in way)
    if first:
        return replace(frame, place=StagePlace(round(left, 2), round(-forward, 2)))
    towards = 5.0 * round(degrees(atan2(left, forward)) / 5.0)
    return replace(frame, travel=Travel(towards, round(hypot(left, forward), 2)))
