"""Where frames stand along the page: spacing by duration, bars, and breaks into staves.

A frame's slot is as wide as its signs need at least. Beyond that it grows with the time until the
next frame, but less than in proportion, as notes are spaced in engraved music.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from fractions import Fraction

from enpointe.notation.frame import Frame
from enpointe.notation.phrasing import Repeat
from enpointe.notation.score import Score
from enpointe.notation.stave_frame import frame_marks, written
from enpointe.notation.stave_ink import Mark, union
from enpointe.notation.stave_margins import count_marks, stage_marks

__all__ = [
    "COUNT_LINE",
    "HELD_BARS",
    "REPEAT",
    "Barrier",
    "Cell",
    "Line",
    "Slot",
    "break_lines",
    "slots",
]

COUNT_LINE = -1.72
"""Baseline of the counts, from the top line of the stave."""

HELD_BARS = 4.6
"""Width of the sign for bars in which nothing is written."""

REPEAT = 1.1
"""Width of a repeat sign with the room about it."""

LEAST_STAVE = 30.0
"""Length of a stave that stands alone, at least: room for a title."""

_PAD = 0.42
_STAGE_PAD = 0.25
_LEAST_HALF = 0.95
_PULSE = 4.1
_POWER = 0.6
_LONGEST = 13.0
_OPENING = 0.75
_METRE = 2.3
_BREAK_IN_BAR = 60.0
_FULL = 0.72


@dataclass(frozen=True, slots=True)
class Cell:
    """A frame with its signs; x is from its centre line.

    Attributes:
        index: Number of the frame, from 0.
        frame: The frame.
        signs: What stands in the stave, y from the top line.
        count: What stands above it, likewise.
        stage: What stands below, y from the middle of that row.
        left: How far its ink goes to the left of the centre line; positive.
        right: And to the right.
    """

    index: int
    frame: Frame
    signs: tuple[Mark, ...]
    count: tuple[Mark, ...]
    stage: tuple[Mark, ...]
    left: float
    right: float


@dataclass(frozen=True, slots=True)
class Barrier:
    """What stands between two slots.

    Attributes:
        bar: Whether a bar begins there.
        closes: A repeat that ends there.
        opens: A repeat that begins there.
    """

    bar: bool = False
    closes: Repeat | None = None
    opens: Repeat | None = None

    @property
    def width(self) -> float:
        """Its breadth along the stave, in spaces."""
        signs = (self.closes is not None) + (self.opens is not None)
        return REPEAT * signs if signs else 0.3 * self.bar

    def __bool__(self) -> bool:
        return self.bar or self.closes is not None or self.opens is not None


@dataclass(frozen=True, slots=True)
class Slot:
    """Room for a frame, or for bars in which nothing is written.

    Attributes:
        before: What stands before it.
        bar: The bar that it is in.
        cell: The frame; None for bars held.
        held: How many bars nothing is written in.
        least: Width that the signs need.
        natural: Width at which it looks right.
    """

    before: Barrier
    bar: int
    cell: Cell | None
    held: int
    least: float
    natural: float

    @property
    def centre(self) -> float:
        """Where the frame's centre line is, from the slot's left edge."""
        return self.cell.left + _PAD if self.cell else 0.0


@dataclass(frozen=True, slots=True)
class Line:
    """A stave's worth of slots.

    Attributes:
        slots: The slots with their left edges and widths, in spaces from the start of the stave.
        width: Length of the stave.
        first: Whether it is the first stave.
        last: Whether it is the last.
        after: What stands at its end.
    """

    slots: tuple[tuple[Slot, float, float], ...]
    width: float
    first: bool
    last: bool
    after: Barrier


def slots(score: Score) -> tuple[list[Slot], Barrier]:
    """All frames of a score in their slots, and what stands after the last."""
    cells = list(_cells(score))
    found: list[Slot] = []
    for i, cell in enumerate(cells):
        beat = cell.frame.beat
        bar = score.bar(beat)
        previous = cells[i - 1].frame.beat if i else None
        empty = bar - score.bar(previous) - 1 if previous is not None else 0
        barrier = _barrier(score, previous, beat)
        if empty > 0:
            found.append(Slot(barrier, bar - empty, None, empty, HELD_BARS, HELD_BARS))
            barrier = Barrier(bar=True)
        until = cells[i + 1].frame.beat if i + 1 < len(cells) else beat + 1
        until = min(until, max(score.beat_of(bar + 1, Fraction(1)), beat + Fraction(1, 2)))
        least = cell.left + cell.right + 2 * _PAD
        spring = min(_PULSE * float(until - beat) ** _POWER, _LONGEST)
        found.append(Slot(barrier, bar, cell, 0, least, max(least, spring)))
    last = cells[-1].frame.beat if cells else None
    return found, _barrier(score, last, None)


def _cells(score: Score) -> Iterator[Cell]:
    before = None
    for index, (frame, resolved) in enumerate(zip(score.frames, score.resolved(), strict=True)):
        writes = written(frame)
        signs = frame_marks(writes, resolved, before)
        count = count_marks(score, frame.beat, COUNT_LINE)
        stage = stage_marks(writes)
        box = union(mark.box for mark in (*signs, *count))
        left, right = max(-box.left, _LEAST_HALF), max(box.right, _LEAST_HALF)
        if stage:
            row = union(mark.box for mark in stage)
            left, right = max(left, _STAGE_PAD - row.left), max(right, _STAGE_PAD + row.right)
        yield Cell(index, frame, signs, count, stage, left, right)
        before = resolved


def _barrier(score: Score, previous: Fraction | None, beat: Fraction | None) -> Barrier:
    """What stands between two beats that follow each other; None is before the first, after the
    last."""
    bar = previous is not None and beat is not None and score.bar(beat) > score.bar(previous)

    def here(at: Fraction) -> bool:
        return (previous is None or previous <= at) and (beat is None or at < beat)

    # Of two repeats without a frame between them only the first closes here and the last opens.
    closes = next((each for each in score.repeats if here(each.end)), None)
    opens = [each for each in score.repeats if here(each.start)]
    return Barrier(bar, closes, opens[-1] if opens and beat is not None else None)


def break_lines(score: Score, width: float) -> list[Line]:
    """The score in staves of at most `width` spaces, broken so that they are evenly full.

    Bars are kept whole where they can be. All staves but the last are spread to the full width;
    the last too if it is nearly full.
    """
    found, after = slots(score)
    breaks = _best_breaks(found, width)
    lines = []
    for number, (start, end) in enumerate(breaks):
        ending = after if end == len(found) else found[end].before
        only, last = len(breaks) == 1, end == len(found)
        lines.append(_line(found[start:end], width, number == 0, last, only, ending))
    return lines


def _opening(first: bool, slot: Slot) -> float:
    opens = REPEAT if slot.before.opens is not None else 0.0
    return (_METRE if first else 0.0) + max(_OPENING, opens)


def _closing(after: Barrier, last: bool) -> float:
    closes = REPEAT if after.closes is not None else 0.0
    return closes + (0.75 if last else 0.15)


def _best_breaks(found: Sequence[Slot], width: float) -> list[tuple[int, int]]:
    """Starts and ends of the staves with the least cost in all (Knuth and Plass's way)."""
    best: list[tuple[float, int]] = [(0.0, 0)]
    for end in range(1, len(found) + 1):
        last = end == len(found)
        choice = (float("inf"), end - 1)
        natural = least = 0.0
        for start in range(end - 1, -1, -1):
            slot = found[start]
            natural += slot.natural
            least += slot.least
            fixed = _opening(start == 0, slot)
            if least + fixed > width and start < end - 1:
                break
            cost = best[start][0] + _cost(natural, least, width - fixed, last)
            if not last and not found[end].before:
                cost += _BREAK_IN_BAR
            choice = min(choice, (cost, start))
            inner = slot.before.width
            natural += inner
            least += inner
        best.append(choice)
    breaks: list[tuple[int, int]] = []
    end = len(found)
    while end > 0:
        start = best[end][1]
        breaks.append((start, end))
        end = start
    return breaks[::-1]


def _cost(natural: float, least: float, room: float, last: bool) -> float:
    if natural > room:
        slack = natural - least
        return 1.0 + 40.0 * ((natural - room) / slack) ** 3 if slack > 0 else 1e6
    if last:
        return 1.0
    return 1.0 + 100.0 * ((room - natural) / room) ** 2


def _line(
    found: Sequence[Slot], width: float, first: bool, last: bool, only: bool, after: Barrier
) -> Line:
    opening, closing = _opening(first, found[0]), _closing(after, last)
    fixed = opening + sum(slot.before.width for slot in found[1:]) + closing
    natural = sum(slot.natural for slot in found)
    least = sum(slot.least for slot in found)
    room = width - fixed
    # Spread to the full width unless it is a last stave that is short.
    full = not last or (not only and natural > _FULL * room)
    wanted = room if full else max(natural, min(room, LEAST_STAVE - fixed) if only else 0.0)
    widths = [slot.natural for slot in found]
    if natural > room:
        squeeze = min((natural - room) / (natural - least), 1.0) if natural > least else 0.0
        widths = [slot.natural - squeeze * (slot.natural - slot.least) for slot in found]
    elif wanted > natural:
        spread = [slot.natural if slot.cell else 0.0 for slot in found]
        share = (wanted - natural) / (sum(spread) or 1.0)
        widths = [slot.natural + share * part for slot, part in zip(found, spread, strict=True)]
    placed, x = [], opening
    for i, (slot, wide) in enumerate(zip(found, widths, strict=True)):
        x += slot.before.width if i else 0.0
        placed.append((slot, x, wide))
        x += wide
    return Line(tuple(placed), x + closing, first, last, after)
