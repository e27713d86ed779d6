"""A score: frames at beats, and what stands above them.

Benesh notation writes only what changes: what a frame leaves out stays as it was. A
:class:`~enpointe.notation.frame.Frame` keeps exactly what is written; :meth:`Score.resolved` fills
in the rest.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from fractions import Fraction

from enpointe.errors import ScoreError
from enpointe.notation.frame import Frame, ResolvedFrame
from enpointe.notation.performed import performed
from enpointe.notation.phrasing import Phrase, Repeat
from enpointe.notation.resolving import resolve

__all__ = ["LONGEST", "TEMPO_RANGE", "Score"]

LONGEST = 3600.0
"""Longest dance, s: an hour, longer than any act; a misprinted beat is far more likely."""
TEMPO_RANGE = (1.0, 250.0)
"""Slowest and fastest pulse, in beats a minute (the range of Neagle's own system, 2005)."""


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
        tempo_word: The word that the tempo was given by, such as "Allegretto"; None for a number.
        pickup: Pulses of the unfinished bar before the first bar line.
        repeats: Counts danced again, in order, none within another.
        phrases: Counts with a quality or a change of tempo, in order, none over another.
    """

    title: str
    method: str
    metre: tuple[int, int]
    tempo: float
    frames: tuple[Frame, ...]
    source: str | None = field(default=None, compare=False)
    version: int = 1
    tempo_word: str | None = None
    pickup: Fraction = Fraction(0)
    repeats: tuple[Repeat, ...] = ()
    phrases: tuple[Phrase, ...] = ()

    def bar(self, beat: Fraction) -> int:
        """The bar of a beat, from 1.

        Beat 0 is the pose to start from and stands before the first bar, as count-in bars do; so
        does a pickup, whose pulses are beats 1 to `pickup`. Both are in bar 0 or before. Bar n of a
        metre with m pulses holds the beats from ``pickup + (n - 1) m + 1`` up to the next bar.
        """
        return math.floor((beat - 1 - self.pickup) / self.metre[0]) + 1

    def beat_of(self, bar: int, count: Fraction) -> Fraction:
        """The beat of a count within a bar; the first count of a bar is 1."""
        return self.pickup + (bar - 1) * self.metre[0] + count

    def seconds(self, beat: Fraction | float, tempo: float | None = None) -> float:
        """The time of a beat, in seconds from the start.

        Args:
            beat: Pulses from the start, as written: repeats are not counted (see
                :meth:`performed`).
            tempo: Pulses a minute; the score's own if None. Phrases slow it and quicken it.

        Returns:
            ``60 / tempo`` times the pulses that have gone by: `beat`, and what slowing and
            quickening phrases add (:meth:`Phrase.extra_pulses`). It grows with the beat.

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
        pulses = float(beat) + sum(phrase.extra_pulses(beat) for phrase in self.phrases)
        return pulses * 60.0 / pulse

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

    def performed(self) -> Score:
        """The score with its repeats written out, which is what a body dances.

        Every time through has its own frames, mirrored where the repeat goes to the other side.
        Bars, seconds and phrases of the result are those of the dance.
        """
        return performed(self)

    def resolved(self) -> tuple[ResolvedFrame, ...]:
        """Fills in what each frame leaves unwritten.

        Whatever was written last holds, limb by limb: a named position of the arms replaces earlier
        hand and elbow signs, and a hand sign takes its arm out of the named position; likewise for
        feet and legs. A new sign (or name) for a hand or foot ends the bend of its elbow or knee
        unless the bend is written again, and a new place for a foot stands it flat and straight. A
        named pose is read first, the rest of the frame over it. Head, body and pelvis start erect,
        the dancer at the centre of the stage facing the audience.

        Returns:
            One resolved frame for each frame, as written; see :meth:`performed` for repeats.

        Raises:
            ScoreError: The first frame doesn't give both feet and both arms, or a position is
                unknown.
        """
        return resolve(self)
