"""A score: frames at beats, each with what it writes, and what that means once all is filled in.

Benesh notation writes only what changes: what a frame leaves out stays as it was. A :class:`Frame`
keeps exactly what is written; :meth:`Score.resolved` fills in the rest.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from fractions import Fraction

from enpointe.errors import ScoreError
from enpointe.notation.signs import (
    ArmsPosition,
    FeetPosition,
    Location,
    Orientation,
    Side,
    Sign,
)
from enpointe.notation.vocabulary import arm_signs, find_arms, find_feet

__all__ = ["TEMPO_RANGE", "ArmSigns", "Frame", "ResolvedFrame", "Score"]

TEMPO_RANGE = (1.0, 250.0)
"""Slowest and fastest pulse, in beats a minute (the range of Neagle's own system, 2005)."""

LONGEST = 3600.0
"""Longest dance, s: an hour, longer than any act; a misprinted beat is far more likely."""

_START = Location(1, 1)


@dataclass(frozen=True, slots=True)
class Frame:
    """One key pose as it is written; what is None or absent holds from before.

    Attributes:
        beat: When, in pulses from the start.
        feet: A named position of the feet.
        arms: A named position of the arms.
        hands: Wrist signs, by side.
        elbows: Signs of bent elbows, by side.
        foot_signs: Ankle signs, by side.
        knees: Signs of bent knees, by side; these may stand with a named position (a plié).
        head: Orientation of the head against the body.
        body: Orientation of the body above the waist.
        pelvis: Orientation of the pelvis, below the waist.
        at: The line of its beat; takes no part in equality.
    """

    beat: Fraction
    feet: FeetPosition | None = None
    arms: ArmsPosition | None = None
    hands: Mapping[Side, Sign] = field(default_factory=dict, hash=False)
    elbows: Mapping[Side, Sign] = field(default_factory=dict, hash=False)
    foot_signs: Mapping[Side, Sign] = field(default_factory=dict, hash=False)
    knees: Mapping[Side, Sign] = field(default_factory=dict, hash=False)
    head: Orientation | None = None
    body: Orientation | None = None
    pelvis: Orientation | None = None
    at: Location = field(default=_START, compare=False)


@dataclass(frozen=True, slots=True)
class ArmSigns:
    """All that a frame means for one arm.

    Attributes:
        wrist: Where the wrist is.
        elbow: Where the elbow is, if its sign was written; it overrides the rounding
            (Neagle 2005 §4.4.3).
        rounded: Whether the ballet rule of the rounded arm applies (§4.4.2): True unless the arm is
            straight or its elbow is written.
        named: The named position that set this arm, or None if raw signs did.
    """

    wrist: Sign
    elbow: Sign | None = None
    rounded: bool = True
    named: ArmsPosition | None = None


@dataclass(frozen=True, slots=True)
class ResolvedFrame:
    """One key pose with everything filled in; each thing carries the location that set it.

    Attributes:
        beat: When, in pulses from the start.
        feet: The named position that the feet hold, or None once both feet have signs of their own.
        foot_signs: Feet that have left the named position, by side; the other foot stays as `feet`
            has it.
        knees: Bent knees, by side; a knee without a sign is straight.
        arms: Both arms.
        head: Orientation of the head.
        body: Orientation of the body.
        pelvis: Orientation of the pelvis.
        at: The line of its beat; takes no part in equality.
    """

    beat: Fraction
    feet: FeetPosition | None
    foot_signs: Mapping[Side, Sign] = field(hash=False)
    knees: Mapping[Side, Sign] = field(hash=False)
    arms: Mapping[Side, ArmSigns] = field(hash=False)
    head: Orientation
    body: Orientation
    pelvis: Orientation
    at: Location = field(compare=False)


@dataclass(frozen=True, slots=True)
class Score:
    """A dance as it is written.

    Attributes:
        title: Its name.
        method: The school whose rules apply, such as "Cecchetti".
        metre: Pulses in a bar, and the note value of the pulse (4, 4).
        tempo: Pulses a minute.
        frames: Key poses in order of their beats; the first is at beat 0.
        source: File or shipped name that it was read from; takes no part in equality.
        version: Version of the format.
    """

    title: str
    method: str
    metre: tuple[int, int]
    tempo: float
    frames: tuple[Frame, ...]
    source: str | None = field(default=None, compare=False)
    version: int = 1

    def seconds(self, beat: Fraction | float, tempo: float | None = None) -> float:
        """The time of a beat, in seconds from the start.

        Args:
            beat: Pulses from the start.
            tempo: Pulses a minute; the score's own if None.

        Returns:
            ``60 beat / tempo``.

        Raises:
            ScoreError: The tempo is not within :data:`TEMPO_RANGE`.
        """
        pulse = self.tempo if tempo is None else tempo
        slowest, fastest = TEMPO_RANGE
        if not (math.isfinite(pulse) and slowest <= pulse <= fastest):
            raise ScoreError(
                f"a tempo of {pulse:g} can't be danced; "
                f"use {slowest:g} to {fastest:g} beats a minute",
                1,
                1,
                self.source,
            )
        return float(beat) * 60.0 / pulse

    def duration(self, tempo: float | None = None) -> float:
        """The time of the last frame, in seconds from the start; see :meth:`seconds`.

        Raises:
            ScoreError: It is longer than :data:`LONGEST`, or the tempo can't be danced.
        """
        length = self.seconds(self.frames[-1].beat if self.frames else 0, tempo)
        if length > LONGEST:
            at = self.frames[-1].at
            raise ScoreError(
                f"this dance would last {length:.0f} s, more than {LONGEST:.0f}; "
                "look at the last beats or the tempo",
                at.line,
                at.column,
                self.source,
            )
        return length

    def resolved(self) -> tuple[ResolvedFrame, ...]:
        """Fills in what each frame leaves unwritten.

        Whatever was written last holds, arm by arm and foot by foot: a named position of the arms
        replaces earlier hand and elbow signs, and a hand sign takes its arm out of the named
        position. A new sign (or name) for a hand or foot ends the bend of its elbow or knee unless
        the bend is written again. Head, body and pelvis start erect.

        Returns:
            One resolved frame for each frame.

        Raises:
            ScoreError: The first frame doesn't give both feet and both arms, or a position is
                unknown.
        """
        frames: list[ResolvedFrame] = []
        feet: FeetPosition | None = None
        foot_signs: dict[Side, Sign] = {}
        knees: dict[Side, Sign] = {}
        arms: dict[Side, ArmSigns] = {}
        head = body = pelvis = Orientation()
        for frame in self.frames:
            if frame.feet is not None:
                self._check_feet(frame.feet, frame)
                feet, foot_signs, knees = frame.feet, {}, {}
            for side, sign in frame.foot_signs.items():
                foot_signs[side] = sign
                knees.pop(side, None)
            knees.update(frame.knees)
            if len(foot_signs) == len(Side):
                feet = None
            if frame.arms is not None:
                arms = self._expand_arms(frame.arms, frame)
            for side, sign in frame.hands.items():
                arms[side] = ArmSigns(sign, None, not sign.straight, None)
            for side, sign in frame.elbows.items():
                if side in arms:
                    arms[side] = ArmSigns(arms[side].wrist, sign, False, None)
            if len(arms) < len(Side) or (feet is None and len(foot_signs) < len(Side)):
                raise ScoreError(
                    "the first frame must give both feet and both arms, such as "
                    "'feet: fifth right front' and 'arms: fifth en bas'",
                    frame.at.line,
                    frame.at.column,
                    self.source,
                )
            head = frame.head or head
            body = frame.body or body
            pelvis = frame.pelvis or pelvis
            frames.append(
                ResolvedFrame(
                    frame.beat,
                    feet,
                    dict(foot_signs),
                    dict(knees),
                    {side: arms[side] for side in Side},
                    head,
                    body,
                    pelvis,
                    frame.at,
                )
            )
        return tuple(frames)

    def _expand_arms(self, position: ArmsPosition, frame: Frame) -> dict[Side, ArmSigns]:
        entry = find_arms(position.name)
        if entry is None or (entry.needs_leading and position.leading is None):
            problem = "is not in the vocabulary" if entry is None else "must say which arm leads"
            raise self._unknown(f"arms: {position.name}", problem, position.at or frame.at)
        return {
            side: ArmSigns(sign, None, not sign.straight, position)
            for side, sign in arm_signs(position).items()
        }

    def _check_feet(self, position: FeetPosition, frame: Frame) -> None:
        entry = find_feet(position.name)
        if entry is None or (entry.crossed and position.front is None):
            problem = (
                "is not in the vocabulary" if entry is None else "must say which foot is in front"
            )
            raise self._unknown(f"feet: {position.name}", problem, position.at or frame.at)

    def _unknown(self, what: str, problem: str, at: Location) -> ScoreError:
        return ScoreError(f"'{what}' {problem}", at.line, at.column, self.source)
