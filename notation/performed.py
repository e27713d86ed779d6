"""The dance as it is performed: repeats written out."""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from typing import TYPE_CHECKING

from enpointe.notation.frame import Frame
from enpointe.notation.mirror import mirrored
from enpointe.notation.phrasing import Repeat

if TYPE_CHECKING:
    from enpointe.notation.score import Score

__all__ = ["Piece", "performed", "pieces"]


@dataclass(frozen=True, slots=True)
class Piece:
    """Written beats that are danced in one go.

    Attributes:
        start: They come after this beat; the first piece has the starting pose too.
        end: Last beat; None for the end of the score.
        later: How many pulses later they are danced than written.
        mirror: Whether they are danced to the other side.
    """

    start: Fraction
    end: Fraction | None
    later: int
    mirror: bool = False

    def part(self, beats: Sequence[Fraction]) -> slice:
        """Which of these written beats, in order, are in it."""
        stop = len(beats) if self.end is None else bisect_right(beats, self.end)
        return slice(bisect_right(beats, self.start), stop)


def performed(score: Score) -> Score:
    """See :meth:`~enpointe.notation.score.Score.performed`."""
    if not score.repeats:
        return score
    danced = pieces(score.repeats)
    beats = [frame.beat for frame in score.frames]
    ends = [phrase.end for phrase in score.phrases]
    return replace(
        score,
        frames=tuple(
            _moved(frame, piece) for piece in danced for frame in score.frames[piece.part(beats)]
        ),
        repeats=(),
        phrases=tuple(
            replace(phrase, first=phrase.first + piece.later, last=phrase.last + piece.later)
            for piece in danced
            for phrase in score.phrases[piece.part(ends)]
        ),
    )


def pieces(repeats: Sequence[Repeat]) -> tuple[Piece, ...]:
    """What is danced, in the order of dancing."""
    return tuple(_pieces(repeats))


def _pieces(repeats: Sequence[Repeat]) -> Iterator[Piece]:
    after, later = Fraction(-1), 0
    for repeat in repeats:
        yield Piece(after, repeat.start, later)
        body = repeat.last
        if repeat.endings:
            body = repeat.endings[0][0] - 1
        for time in range(repeat.times + 1):
            mirror = repeat.other_side and time % 2 == 1
            last = time == repeat.times
            yield Piece(repeat.start, Fraction(body) if last else repeat.end, later, mirror)
            if not last:
                later += repeat.last - repeat.first + 1
        later -= repeat.last - body
        after = repeat.end
    yield Piece(after, None, later)


def _moved(frame: Frame, piece: Piece) -> Frame:
    jump = frame.jump
    if jump is not None:
        jump = replace(jump, off=jump.off + piece.later, on=jump.on + piece.later)
    frame = replace(frame, beat=frame.beat + piece.later, jump=jump)
    return mirrored(frame) if piece.mirror else frame
