"""One stave with all that stands on it, above it and below it."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from itertools import pairwise

from enpointe.notation.frame import ResolvedFrame
from enpointe.notation.movement import Limb, StepKind
from enpointe.notation.phrasing import Repeat
from enpointe.notation.score import Score
from enpointe.notation.signs import Side
from enpointe.notation.stave_above import BOLD, ITALIC, Placed, above_marks
from enpointe.notation.stave_frame import FLOOR, LINE, spot
from enpointe.notation.stave_ink import Box, Mark, between, glyph, line, union, words
from enpointe.notation.stave_layout import HELD_BARS, REPEAT, Barrier, Cell, Line, Slot
from enpointe.notation.stave_paths import locomotion_line

__all__ = ["FrameDrawing", "LineDrawing", "draw_line"]

BAR = 0.09

_ABOVE_COUNT = -3.0


@dataclass(frozen=True, slots=True)
class FrameDrawing:
    """One frame's marks on its stave.

    Attributes:
        cell: The frame.
        cover: The room it has; the target of a click.
        marks: Everything it writes.
    """

    cell: Cell
    cover: Box
    marks: tuple[Mark, ...]

    def moved(self, dx: float, dy: float) -> FrameDrawing:
        """The same elsewhere."""
        marks = tuple(mark.moved(dx, dy) for mark in self.marks)
        return FrameDrawing(self.cell, self.cover.moved(dx, dy), marks)


@dataclass(frozen=True, slots=True)
class LineDrawing:
    """A stave; x from its start, y from its top line.

    Attributes:
        marks: Lines, bar lines, and all that belongs to no one frame.
        frames: The frames.
        box: The extent of everything.
    """

    marks: tuple[Mark, ...]
    frames: tuple[FrameDrawing, ...]
    box: Box = field(repr=False)

    def moved(self, dx: float, dy: float) -> LineDrawing:
        """The same elsewhere."""
        return LineDrawing(
            tuple(mark.moved(dx, dy) for mark in self.marks),
            tuple(frame.moved(dx, dy) for frame in self.frames),
            self.box.moved(dx, dy),
        )


def draw_line(score: Score, resolved: Sequence[ResolvedFrame], stave: Line) -> LineDrawing:
    """Draws one stave.

    Args:
        score: The score.
        resolved: Its frames with all filled in.
        stave: Which frames, and where along the stave.
    """
    marks = [line("stave-line", 0.0, y, stave.width, y, LINE) for y in map(float, range(5))]
    marks += _opening(score, stave)
    for slot, left, _ in stave.slots[1:]:
        marks += _barrier(slot.before, left - slot.before.width, left)
    marks += _ending(stave)
    marks += [
        mark for slot, left, width in stave.slots if slot.held for mark in _held(slot, left, width)
    ]
    drawn = [
        (slot.cell, left + slot.centre, [*slot.cell.signs, *slot.cell.count])
        for slot, left, _ in stave.slots
        if slot.cell
    ]
    placed = [(cell, x, [mark.moved(x, 0.0) for mark in own]) for cell, x, own in drawn]
    for i, (cell, x, own) in enumerate(placed):
        own += _locomotion(resolved, stave, placed, i, cell, x)
    ink = [mark.box for *_, own in placed for mark in own]
    below = max([FLOOR + 0.55, *(box.bottom for box in ink)])
    _add_stage_row(placed, below)
    bottom = max([below, *(mark.box.bottom for *_, own in placed for mark in own)]) + 0.85
    for cell, x, own in placed:
        own.append(
            words(
                str(cell.index), x, bottom, 0.6, anchor="middle", style=ITALIC, name="frame-number"
            )
        )
    marks += above_marks(score, placed)
    box = union(mark.box for mark in [*marks, *(mark for *_, own in placed for mark in own)])
    covers = _covers(stave, Box(0.0, box.top, stave.width, box.bottom))
    frames = tuple(
        FrameDrawing(cell, cover, tuple(own))
        for (cell, _, own), cover in zip(placed, covers, strict=True)
    )
    return LineDrawing(tuple(marks), frames, box)


def _covers(stave: Line, whole: Box) -> list[Box]:
    return [
        Box(left, max(whole.top, _ABOVE_COUNT), left + width, whole.bottom)
        for slot, left, width in stave.slots
        if slot.cell
    ]


def _opening(score: Score, stave: Line) -> Iterator[Mark]:
    slot, left, _ = stave.slots[0]
    yield line("bar-line", 0.0, -LINE / 2, 0.0, FLOOR + LINE / 2, BAR)
    if stave.first:
        for number, y in zip(score.metre, (1.72, 3.72), strict=True):
            size = 2.35 if number < 10 else 2.0
            yield words(
                str(number), 1.25, y, size, anchor="middle", style=BOLD, fit=1.7, name="metre"
            )
    elif slot.bar >= 1:
        yield words(str(slot.bar), 0.0, -0.45, 0.75, style=ITALIC, name="bar-number")
    if slot.before.opens is not None:
        yield from _barrier(Barrier(slot.before.bar, None, slot.before.opens), left - REPEAT, left)


def _ending(stave: Line) -> Iterator[Mark]:
    x = stave.width
    if stave.after.closes is not None:
        at_bar = stave.after.bar or stave.last
        right = x - (0.75 if stave.last else -0.25)
        yield from _barrier(Barrier(at_bar, stave.after.closes), right - REPEAT, right)
    if stave.last:
        yield line("bar-line", x - 0.5, 0.0, x - 0.5, FLOOR, BAR)
        yield line("bar-line", x - 0.17, -LINE / 2, x - 0.17, FLOOR + LINE / 2, 0.34)
    elif stave.after.bar and stave.after.closes is None:
        yield line("bar-line", x, -LINE / 2, x, FLOOR + LINE / 2, BAR)


def _barrier(barrier: Barrier, left: float, right: float) -> Iterator[Mark]:
    """A bar line, or the signs of the repeats that close and open there."""
    if barrier.bar and barrier.closes is None and barrier.opens is None:
        x = (left + right) / 2
        yield line("bar-line", x, 0.0, x, FLOOR, BAR)
    if barrier.closes is not None:
        x = left + REPEAT - 0.6 if barrier.opens is None else left + 0.5
        yield from _repeat(barrier.closes, x, barrier.bar)
        times = f"{barrier.closes.times + 1}×"
        yield words(times, x, -0.4, 0.8, anchor="middle", style=BOLD, name="repeat-number")
    if barrier.opens is not None:
        yield from _repeat(barrier.opens, right - 0.6, barrier.bar)


def _repeat(repeat: Repeat, x: float, bar: bool) -> Iterator[Mark]:
    manner = "repeat other side" if repeat.other_side else "repeat same"
    yield glyph(manner if bar else f"{manner} within a bar", x, 0.0)


def _held(slot: Slot, left: float, width: float) -> Iterator[Mark]:
    start = left + (width - HELD_BARS) / 2 + 0.4
    yield between("held bars", (start, 2.0), (start + HELD_BARS - 0.8, 2.0))
    x = left + width / 2
    yield words(
        str(slot.held), x, -0.5, 1.1, anchor="middle", style=BOLD, fit=width - 0.4, name="bars-held"
    )


def _add_stage_row(placed: Placed, below: float) -> None:
    boxes = [mark.box for cell, *_ in placed for mark in cell.stage]
    if not boxes:
        return
    row = below + 0.35 - min(box.top for box in boxes)
    for cell, x, own in placed:
        own += [mark.moved(x, row) for mark in cell.stage]


def _locomotion(
    resolved: Sequence[ResolvedFrame],
    stave: Line,
    placed: Placed,
    i: int,
    cell: Cell,
    x: float,
) -> Iterator[Mark]:
    """Lines that arrive at a frame, and the beginnings of those that arrive on the next stave."""
    now = resolved[cell.index]
    before = resolved[cell.index - 1] if cell.index else None
    start = placed[i - 1][1] if i else None
    if now.jump is not None:
        off = _x_of(float(now.jump.off), placed, stave)
        on = _x_of(float(now.jump.on), placed, stave)
        yield locomotion_line(StepKind.JUMP, off, on, FLOOR)
    for side, step in now.locomotion.items():
        if step.kind is StepKind.JUMP and now.jump is not None:
            continue
        here = x + _foot_x(side, cell, now)
        there = (
            0.35
            if start is None or before is None
            else start + _foot_x(side, placed[i - 1][0], before)
        )
        yield locomotion_line(step.kind, there, here, FLOOR)
    following = resolved[cell.index + 1] if cell.index + 1 < len(resolved) else None
    if i + 1 == len(placed) and following is not None:
        for side, step in following.locomotion.items():
            here = x + _foot_x(side, cell, now)
            yield locomotion_line(step.kind, here, stave.width - 0.3, FLOOR)


def _foot_x(side: Side, cell: Cell, frame: ResolvedFrame) -> float:
    """How far from the centre line a foot's sign is drawn, or would be."""
    limb = Limb.of(side, "foot")
    boxes = (mark.box for mark in cell.signs if mark.limb == limb)
    drawn = next(((box.left + box.right) / 2 for box in boxes), None)
    return spot(limb, frame)[0] if drawn is None else drawn


def _x_of(beat: float, placed: Placed, stave: Line) -> float:
    """Where a beat is along a stave; its ends for beats on other staves."""
    known = [(float(cell.frame.beat), x) for cell, x, _ in placed]
    if beat < known[0][0]:
        return 0.35
    for (one, x1), (two, x2) in pairwise(known):
        if beat <= two:
            return x1 + (x2 - x1) * (beat - one) / (two - one)
    return known[-1][1] if beat <= known[-1][0] else stave.width - 0.3
