"""Draws a score as SVG: one tall drawing, or pages to print.

Five lines, read from left to right, seen from behind the dancer; only what is written is drawn, and
named positions by the signs that they stand for. Beat 0 is the pose to start from and stands before
the first bar, as count-in bars do.

The drawing goes through four hands: :mod:`~enpointe.notation.stave_frame` puts the signs of one
frame together, :mod:`~enpointe.notation.stave_layout` spaces frames and breaks staves,
:mod:`~enpointe.notation.stave_line` draws a stave with all about it, and this module puts staves on
the page. The shapes themselves are in :mod:`~enpointe.notation.glyphs`.
"""

from __future__ import annotations

import textwrap
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from enpointe.notation.score import Score
from enpointe.notation.stave_above import BOLD, ITALIC
from enpointe.notation.stave_ink import (
    INK,
    SERIF,
    Mark,
    glyph,
    px,
    svg,
    text,
    text_width,
    union,
    words,
)
from enpointe.notation.stave_layout import LEAST_STAVE, break_lines
from enpointe.notation.stave_line import FrameDrawing, LineDrawing, draw_line
from enpointe.notation.writer import format_beat, frame_lines

__all__ = ["A4", "Page", "stave_pages", "stave_svg"]

_TITLE = 2.1
_SMALLER_TITLE = 1.35
_TITLE_LINES = 3
_GAP = 1.9
_EDGE = 1.8
_WIDEST_GAP = 3.2
_FOOT = 1.6
_NOTES = (1, 2, 4, 8, 16)


@dataclass(frozen=True, slots=True)
class Page:
    """A sheet of paper, upright or on its side; all in millimetres.

    Attributes:
        width: Of the sheet.
        height: Of the sheet.
        margin: Free on all sides.
        space: Distance between two stave lines.
    """

    width: float = 210.0
    height: float = 297.0
    margin: float = 16.0
    space: float = 2.4

    def __post_init__(self) -> None:
        if self.measure < LEAST_STAVE or (self.height - 2 * self.margin) / self.space < 40.0:
            raise ValueError(
                f"a page of {self.width:g} mm by {self.height:g} mm with margins of "
                f"{self.margin:g} mm has no room for a stave whose lines are {self.space:g} mm "
                f"apart; it needs {LEAST_STAVE:g} times that in width and 40 times in height"
            )

    @property
    def measure(self) -> float:
        """Length of a full stave, in stave spaces."""
        return (self.width - 2 * self.margin) / self.space


A4 = Page()


def stave_svg(score: Score, page: Page = A4) -> str:
    """Draws a score in one piece, as wide as a page and as tall as need be.

    Args:
        score: The score, as parsed (its positions are in the vocabulary).
        page: Its width, margins and the distance of the lines; a score that fills less than one
            stave makes a narrower drawing.

    Returns:
        A self-contained SVG document. Each frame is ``<g class="frame" id="frame-N"
        data-beat="...">``, N from 0, with a transparent rectangle over its whole room to be clicked
        on, and its words as a title.
    """
    lines = _lines(score, page)
    edge = _EDGE
    right = max(line.box.right for line in lines) if lines else 0.0
    measure = page.measure if len(lines) > 1 else min(page.measure, max(right, LEAST_STAVE))
    y = 0.0
    header = list(_header(score, measure, y))
    y = union(mark.box for mark in header).bottom
    placed = []
    for line in lines:
        y += _GAP - line.box.top
        placed.append(line.moved(0.0, y))
        y += line.box.bottom
    size = (measure + 2 * edge, y + edge)
    return _document(score, header, placed, size, edge, (px(size[0]), px(size[1])))


def stave_pages(score: Score, page: Page = A4) -> tuple[str, ...]:
    """Draws a score on pages to print, A4 upright unless another page is given.

    Args:
        score: The score, as parsed.
        page: The sheet.

    Returns:
        One SVG document a page, in millimetres, with frames as in :func:`stave_svg`; their ids are
        those of the whole score.
    """
    edge, height = page.margin / page.space, page.height / page.space
    sheets: list[tuple[list[Mark], list[LineDrawing]]] = [
        (list(_header(score, page.measure, edge)), [])
    ]
    foot = height - edge - _FOOT
    room = foot - union(mark.box for mark in sheets[0][0]).bottom
    for line in _lines(score, page):
        tall = line.box.bottom - line.box.top + _GAP
        if tall > room and sheets[-1][1]:
            sheets.append((list(_running_header(score, page.measure, edge)), []))
            room = foot - union(mark.box for mark in sheets[-1][0]).bottom
        sheets[-1][1].append(line)
        room -= tall
    return tuple(
        _document(
            score,
            [*header, *_footer(number, len(sheets), page.measure, height - edge)],
            _down(lines, union(mark.box for mark in header).bottom, foot, full),
            (page.width / page.space, height),
            edge,
            (f"{page.width:g}mm", f"{page.height:g}mm"),
        )
        for number, (header, lines) in enumerate(sheets, 1)
        for full in (number < len(sheets),)
    )


def _lines(score: Score, page: Page) -> list[LineDrawing]:
    resolved = score.resolved()
    return [draw_line(score, resolved, line) for line in break_lines(score, page.measure)]


def _down(lines: Sequence[LineDrawing], top: float, bottom: float, full: bool) -> list[LineDrawing]:
    """Staves one under another; on a page that others follow, spread down to its foot."""
    ink = sum(line.box.bottom - line.box.top for line in lines)
    gap = _GAP
    if full:
        gap = min(max(gap, (bottom - top - ink) / len(lines)), _WIDEST_GAP)
    placed, y = [], top
    for line in lines:
        y += gap - line.box.top
        placed.append(line.moved(0.0, y))
        y += line.box.bottom
    return placed


def _header(score: Score, measure: float, top: float) -> Iterator[Mark]:
    """Title in the middle, tempo at the left, the school at the right."""
    title = score.title.strip()
    size = _TITLE if text_width(title, _TITLE) < measure else _SMALLER_TITLE
    rows = [title]
    if text_width(title, size) > measure:
        letters = max(int(measure / (0.6 * size)), 8)
        rows = textwrap.wrap(title, letters, max_lines=_TITLE_LINES, placeholder=" …") or rows
    y = top
    for row in rows:
        y += 1.15 * size
        yield words(row, measure / 2, y, size, anchor="middle", fit=measure, name="title")
    y += 2.5
    yield words(
        score.method, measure, y, 0.95, anchor="end", style=ITALIC, fit=measure / 2, name="method"
    )
    yield from _tempo(score, y, measure / 2 - 1.0)


def _tempo(score: Score, y: float, room: float) -> Iterator[Mark]:
    """The tempo as music has it: its word, and how many notes of what value go to a minute."""
    x = 0.0
    if score.tempo_word:
        word = score.tempo_word[:1].upper() + score.tempo_word[1:]
        mark = words(word, x, y, 1.0, style=BOLD, fit=room - 6.0, name="tempo-word")
        x = mark.box.right + 0.45
        yield mark
    unit = score.metre[1]
    number = f"= {score.tempo:.5g}"
    if unit in _NOTES:
        note = glyph(f"note {unit}", x + 0.4, y - 0.22)
        yield note
        x = note.box.right + 0.3
    else:
        number = f"pulse {number}"
    yield words(number, x, y, 1.0, name="tempo")


def _running_header(score: Score, measure: float, top: float) -> Iterator[Mark]:
    title = textwrap.shorten(score.title, 80, placeholder=" …") or score.title.strip()[:80]
    yield words(
        title, measure / 2, top + 0.8, 0.9, anchor="middle", style=ITALIC, fit=measure, name="title"
    )


def _footer(number: int, of: int, measure: float, bottom: float) -> Iterator[Mark]:
    if of > 1:
        yield words(str(number), measure / 2, bottom, 0.9, anchor="middle", name="page-number")


def _document(
    score: Score,
    marks: Sequence[Mark],
    lines: Sequence[LineDrawing],
    size: tuple[float, float],
    edge: float,
    printed: tuple[str, str],
) -> str:
    width, height = px(size[0]), px(size[1])
    title = text(score.title)
    parts = [
        f'<svg xmlns="http://www.w3.org/2000/svg" class="stave" role="img" aria-label="{title}" '
        f'width="{printed[0]}" height="{printed[1]}" viewBox="0 0 {width} {height}" '
        f'font-family="{SERIF}" fill="{INK}">',
        f"<title>{title}</title>",
        f'<rect class="paper" width="{width}" height="{height}" fill="#fff"/>',
        *svg(mark.moved(edge, 0.0) for mark in marks),
    ]
    for line in lines:
        moved = line.moved(edge, 0.0)
        parts += ['<g class="line">', *svg(moved.marks)]
        for frame in moved.frames:
            parts += _frame(score, frame)
        parts.append("</g>")
    parts.append("</svg>")
    return "\n".join(parts) + "\n"


def _frame(score: Score, drawing: FrameDrawing) -> Iterator[str]:
    frame, box = drawing.cell.frame, drawing.cover
    beat = format_beat(frame.beat)
    where = f"Frame {drawing.cell.index}, beat {beat}"
    bar = score.bar(frame.beat)
    if bar >= 1:
        where += f", bar {bar}"
    says = "; ".join(frame_lines(frame)) or "as before"
    yield (
        f'<g class="frame" id="frame-{drawing.cell.index}" data-beat="{text(beat)}" tabindex="0">'
    )
    yield f"<title>{text(f'{where}: {says}')}</title>"
    yield (
        f'<rect x="{px(box.left)}" y="{px(box.top)}" width="{px(box.right - box.left)}" '
        f'height="{px(box.bottom - box.top)}" fill="none" pointer-events="all"/>'
    )
    yield from svg(drawing.marks)
    yield "</g>"
