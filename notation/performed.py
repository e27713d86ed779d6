"""The dance as it is performed: repeats written out."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from fractions import Fraction
from typing import TYPE_CHECKING

from enpointe.notation.frame import Frame
from enpointe.notation.mirror import mirrored
from enpointe.notation.phrasing import Phrase, Repeat

if TYPE_CHECKING:
    from enpointe.notation.score import Score

__all__ = ["performed"]


@dataclass(frozen=True, slots=True)
class _Piece:
    """Written beats after `start` up to `end`, danced `later` pulses later than written."""

    start: Fraction
    end: Fraction
    later: int
    mirror: bool = False

    def holds(self, beat: Fraction) -> bool:
        return self.start < beat <= self.end


def performed(score: Score) -> Score:
    """The score without repeats that is danced alike.

    Args:
        score: A score that was read, or that :func:`~enpointe.notation.check.check_score` takes.

    Returns:
        A score whose frames are those of every time through, mirrored where a repeat says so. What
        a repeated frame leaves unwritten holds from the frame danced before it.
    """
    if not score.repeats:
        return score
    pieces = list(_pieces(score))
    frames = tuple(
        _moved(frame, piece)
        for piece in pieces
        for frame in score.frames
        if piece.holds(frame.beat)
    )
    return replace(
        score, frames=frames, repeats=(), phrases=tuple(_phrases(score.phrases, pieces))
    )


def _pieces(score: Score) -> Iterator[_Piece]:
    """What is danced, in the order of dancing."""
    written, later = Fraction(-1), 0
    for repeat in score.repeats:
        yield _Piece(written, repeat.start, later)
        body, skipped = repeat.end, 0
        if repeat.endings:
            (ending, _), (_, second) = repeat.endings
            body, skipped = Fraction(ending - 1), repeat.last - ending + 1
        for time in range(repeat.times + 1):
            mirror = repeat.other_side and time % 2 == 1
            last = time == repeat.times
            yield _Piece(repeat.start, body if last else repeat.end, later, mirror)
            if not last:
                later += repeat.last - repeat.first + 1
        written = repeat.end
        later -= skipped
    yield _Piece(written, max(written, score.frames[-1].beat), later)


def _moved(frame: Frame, piece: _Piece) -> Frame:
    jump = frame.jump
    if jump is not None:
        jump = replace(jump, off=jump.off + piece.later, on=jump.on + piece.later)
    frame = replace(frame, beat=frame.beat + piece.later, jump=jump)
    return mirrored(frame) if piece.mirror else frame


def _phrases(phrases: tuple[Phrase, ...], pieces: list[_Piece]) -> Iterator[Phrase]:
    """Phrases inside a piece go with it; those around a whole repeat last as long as it does."""
    for piece in pieces:
        for phrase in phrases:
            begins = piece.holds(phrase.start + 1)
            if begins and phrase.end <= piece.end:
                yield _shifted(phrase, piece.later, piece.later)


def _shifted(phrase: Phrase, start: int, end: int) -> Phrase:
    return replace(phrase, first=phrase.first + start, last=phrase.last + end)


def _spans(phrase: Phrase, repeat: Repeat) -> bool:
    return phrase.start <= repeat.start and phrase.end >= repeat.end
