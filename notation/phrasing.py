"""What stands above the stave: repeats, and phrases with their quality and their tempo.

Both are written in counts. A movement arrives *on* its count, and the upbeats before it lead into
it: "& 1" belongs to count 1. So counts 1 to 4 are everything after beat 0 up to and including beat
4, and counts 5 to 8 everything after beat 4 up to beat 8.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from fractions import Fraction
from math import log1p

from enpointe.notation.numerals import format_number, number
from enpointe.notation.signs import Location

__all__ = ["EFFORTS", "EFFORT_FACTORS", "Phrase", "Repeat", "effort_factors", "effort_text"]

EFFORTS = ("natural", "happy", "sad", "angry", "afraid")
"""Qualities by name: those that Neagle (2005 §5.5) measured."""

EFFORT_FACTORS: Mapping[str, tuple[float, float]] = {
    "time": (-4.0, -2.0),
    "weight": (0.3, 0.8),
    "space": (0.0, 1.0),
}
"""Laban's factors of effort and the ranges of their numbers (Neagle 2005 §5.4): time from sudden to
sustained, weight from heavy to light, space from indirect to direct."""


def effort_text(factors: Mapping[str, float]) -> str:
    """Factors as a phrase keeps them: "time=-3.5,weight=0.41,space=1", those left out unchanged."""
    return ",".join(
        f"{name}={format_number(factors[name])}" for name in EFFORT_FACTORS if name in factors
    )


def effort_factors(text: str) -> dict[str, float] | None:
    """The factors of an effort's text; None if it is none, or a number is out of range."""
    factors: dict[str, float] = {}
    for part in text.split(","):
        name, _, digits = part.partition("=")
        value = number(digits)
        if name in factors or name not in EFFORT_FACTORS or value is None:
            return None
        low, high = EFFORT_FACTORS[name]
        if not low <= value <= high:
            return None
        factors[name] = value
    return factors


@dataclass(frozen=True, slots=True)
class _Counts:
    first: int
    last: int

    @property
    def start(self) -> Fraction:
        """The beat after which the counts begin; a frame on this very beat is not one of them."""
        return Fraction(self.first - 1)

    @property
    def end(self) -> Fraction:
        """The beat that the counts end with, itself one of them."""
        return Fraction(self.last)


@dataclass(frozen=True, slots=True)
class Repeat(_Counts):
    """Counts that are danced again.

    Attributes:
        first: First count.
        last: Last count.
        times: How many times more; 1 is once more, twice in all.
        other_side: Each time is the mirror image of the time before.
        endings: Nothing, or two pairs of counts (first, last): the first ending closes the repeated
            counts every time but the last; then the second, which stands right after them, takes
            its place and is danced as it is written, never mirrored.
        at: Where it was written; takes no part in equality.
    """

    times: int = 1
    other_side: bool = False
    endings: tuple[tuple[int, int], ...] = ()
    at: Location | None = field(default=None, compare=False)


@dataclass(frozen=True, slots=True)
class Phrase(_Counts):
    """Counts danced in one breath.

    Attributes:
        first: First count.
        last: Last count.
        effort: The quality: one of :data:`EFFORTS`, or what :func:`effort_text` gives; None for
            that of the whole dance.
        tempo_end: The factor of the tempo reached at the end: below 1 slowing, above 1 quickening;
            None for an even tempo. After the phrase the tempo is the score's again.
        name: Words for people.
        at: Where it was written; takes no part in equality.
    """

    effort: str | None = None
    tempo_end: float | None = None
    name: str | None = None
    at: Location | None = field(default=None, compare=False)

    def extra_pulses(self, beat: Fraction | float) -> float:
        """How much longer the phrase has taken at a beat than at an even tempo, in pulses.

        The tempo goes linearly with the beat from 1 to k = `tempo_end` over the L counts of the
        phrase, so that u counts into it ``L / (k - 1) ln(1 + (k - 1) u / L)`` pulses have gone by.

        Args:
            beat: Any beat of the score; before the phrase nothing is added, after it all of it.
        """
        if self.tempo_end is None or self.tempo_end == 1.0 or beat <= self.start:
            return 0.0
        length = float(self.end - self.start)
        gone = float(min(beat, self.end) - self.start)
        change = self.tempo_end - 1.0
        return length / change * log1p(change * gone / length) - gone
