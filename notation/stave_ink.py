"""Ink: marks with their place and size, before and while they become SVG.

Everything is reckoned in stave spaces (the distance between two lines); only :func:`svg` and
:func:`px` know of pixels.
"""

from __future__ import annotations

import math
import re
import unicodedata
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, replace
from functools import cache
from html import escape
from itertools import pairwise

from enpointe.notation.glyphs import GLYPHS

__all__ = [
    "INK",
    "SERIF",
    "SPACE",
    "Box",
    "Mark",
    "between",
    "glyph",
    "line",
    "pieces",
    "px",
    "svg",
    "text",
    "text_width",
    "union",
    "words",
]

SPACE = 18.0
"""Distance between two stave lines, in pixels of the view box."""

INK = "#000"
SERIF = "'Times New Roman', 'Liberation Serif', Times, serif"

Point = tuple[float, float]
Path = tuple[tuple[str, tuple[Point, ...]], ...]

_TOKEN = re.compile(r"([MLQCZ])|(-?(?:\d+\.?\d*|\.\d+)(?:e-?\d+)?)")
_NOT_XML = re.compile("[^\t\n\r\x20-\ud7ff\ue000-\ufffd\U00010000-\U0010ffff]")
_NARROW = frozenset("iljtfrI.,:;!|'()[]{}/\\-` ")
_BROAD = frozenset("mwMW@%&—…")


@dataclass(frozen=True, slots=True)
class Box:
    """The extent of a mark, in stave spaces; y down."""

    left: float
    top: float
    right: float
    bottom: float

    def touches(self, other: Box, aside: float = 0.0, above: float = 0.0) -> bool:
        """Whether they overlap, or stand less than that much aside and above each other."""
        return (
            self.left < other.right + aside
            and other.left < self.right + aside
            and self.top < other.bottom + above
            and other.top < self.bottom + above
        )

    def moved(self, dx: float, dy: float) -> Box:
        """The same extent elsewhere."""
        return Box(self.left + dx, self.top + dy, self.right + dx, self.bottom + dy)


@dataclass(frozen=True, slots=True)
class Mark:
    """Something drawn: strokes, filled outlines, or letters.

    Attributes:
        name: Its name in the table of glyphs, or what else it is; the class of the element.
        box: Its extent.
        stroke: Centre lines, drawn `weight` thick.
        fill: Filled outlines.
        weight: Thickness of the strokes.
        letters: Words or figures, on the baseline at `at`.
        at: Where the letters start, are centred or end, as `anchor` says.
        size: Size of the letters.
        style: Further attributes of the letters.
        anchor: "start", "middle" or "end".
        limb: What it is the sign of, such as "right foot"; empty for all that is no limb's.
        fit: Width that the letters are squeezed into; None leaves them as they are.
    """

    name: str
    box: Box
    stroke: Path = ()
    fill: Path = ()
    weight: float = 0.0
    letters: str = ""
    at: Point = (0.0, 0.0)
    size: float = 0.0
    style: str = ""
    anchor: str = "start"
    fit: float | None = None
    limb: str = ""

    def moved(self, dx: float, dy: float) -> Mark:
        """The same mark elsewhere."""

        def shift(point: Point) -> Point:
            return point[0] + dx, point[1] + dy

        return replace(
            self,
            box=self.box.moved(dx, dy),
            stroke=_mapped(self.stroke, shift),
            fill=_mapped(self.fill, shift),
            at=shift(self.at),
        )


def union(boxes: Iterable[Box]) -> Box:
    """The extent of all of them together.

    Raises:
        ValueError: There are none.
    """
    lefts, tops, rights, bottoms = zip(
        *((box.left, box.top, box.right, box.bottom) for box in boxes), strict=True
    )
    return Box(min(lefts), min(tops), max(rights), max(bottoms))


@cache
def _path(data: str) -> Path:
    """Path data with absolute commands, taken apart."""
    commands: list[tuple[str, list[float]]] = []
    for command, value in _TOKEN.findall(data):
        if command:
            commands.append((command, []))
        else:
            commands[-1][1].append(float(value))
    return tuple(
        (command, tuple(zip(values[::2], values[1::2], strict=True)))
        for command, values in commands
    )


def _mapped(path: Path, move: Callable[[Point], Point]) -> Path:
    return tuple((command, tuple(move(point) for point in points)) for command, points in path)


def _extent(stroke: Path, fill: Path, weight: float) -> Box:
    """A box around all control points, hence around the ink."""
    inked = [(point, weight / 2) for _, points in stroke for point in points]
    inked += [(point, 0.0) for _, points in fill for point in points]
    return Box(
        min(x - edge for (x, _), edge in inked),
        min(y - edge for (_, y), edge in inked),
        max(x + edge for (x, _), edge in inked),
        max(y + edge for (_, y), edge in inked),
    )


def glyph(name: str, x: float, y: float, angle: float = 0.0, limb: str = "") -> Mark:
    """A sign of the table with its origin at (x, y), turned to the left by `angle` degrees."""
    entry = GLYPHS[name]
    if entry.text:
        return words(entry.text, x, y, entry.size, anchor="middle", name=name)
    c, s = math.cos(math.radians(angle)), math.sin(math.radians(angle))

    def put(point: Point) -> Point:
        return x + c * point[0] + s * point[1], y - s * point[0] + c * point[1]

    mark = _drawn(name, _mapped(_path(entry.stroke), put), _mapped(_path(entry.fill), put))
    return replace(mark, limb=limb)


def between(name: str, start: Point, end: Point, flip: bool = False) -> Mark:
    """A line of the table, fitted to its two ends; `flip` mirrors its bulge."""
    entry = GLYPHS[name]
    dx, dy = end[0] - start[0], end[1] - start[1]
    length = math.hypot(dx, dy) or 1e-9
    ux, uy = dx / length, dy / length
    breadth = (length if entry.along == "whole" else 1.0) * (-1.0 if flip else 1.0)

    def put(point: Point) -> Point:
        along, aside = point[0] * length, point[1] * breadth
        return start[0] + along * ux - aside * uy, start[1] + along * uy + aside * ux

    return _drawn(name, _mapped(_path(entry.stroke), put), _mapped(_path(entry.fill), put))


def _drawn(name: str, stroke: Path, fill: Path) -> Mark:
    weight = GLYPHS[name].weight
    return Mark(name, _extent(stroke, fill, weight), stroke, fill, weight)


def pieces(mark: Mark, count: int = 8) -> Iterator[Box]:
    """Small boxes along the strokes of a mark, for signs that keep clear of a curve."""
    edge = mark.weight / 2
    start = (0.0, 0.0)
    for command, points in mark.stroke:
        if command in "LC":
            for step in range(count + 1):
                x, y = _along(start, points, step / count)
                yield Box(x - edge, y - edge, x + edge, y + edge)
        start = points[-1] if points else start


def _along(start: Point, points: tuple[Point, ...], t: float) -> Point:
    """The point of a Bézier curve at t, from 0 to 1."""
    row = [start, *points]
    while len(row) > 1:
        row = [(x1 + (x2 - x1) * t, y1 + (y2 - y1) * t) for (x1, y1), (x2, y2) in pairwise(row)]
    return row[0]


def line(name: str, x1: float, y1: float, x2: float, y2: float, weight: float) -> Mark:
    """A straight line that is not a sign: of the stave, of a bar, or leading to a sign."""
    stroke: Path = (("M", ((x1, y1),)), ("L", ((x2, y2),)))
    return Mark(name, _extent(stroke, (), weight), stroke, (), weight)


def text_width(letters: str, size: float) -> float:
    """About how wide the letters are, rather too wide than too narrow."""
    return size * 1.08 * sum(_advance(letter) for letter in letters)


def _advance(letter: str) -> float:
    if unicodedata.combining(letter):
        return 0.0
    if letter in _NARROW:
        return 0.34
    if letter in _BROAD:
        return 0.92
    if letter.isascii():
        return 0.7 if letter.isupper() else 0.5
    return 1.0 if unicodedata.east_asian_width(letter) in "FWA" or not letter.isalpha() else 0.62


def words(
    letters: str,
    x: float,
    y: float,
    size: float,
    *,
    anchor: str = "start",
    style: str = "",
    fit: float | None = None,
    name: str = "words",
) -> Mark:
    """Letters with their baseline at y, squeezed into the width `fit` if they are wider."""
    width = text_width(letters, size)
    squeezed = fit if fit is not None and width > fit else None
    width = squeezed or width
    left = x - {"start": 0.0, "middle": width / 2, "end": width}[anchor]
    box = Box(left, y - 0.74 * size, left + width, y + 0.22 * size)
    return Mark(
        name, box, letters=letters, at=(x, y), size=size, style=style, anchor=anchor, fit=squeezed
    )


def svg(marks: Iterable[Mark]) -> Iterator[str]:
    """The elements of the marks."""
    for mark in marks:
        kind = f'class="{"sign " if mark.name in GLYPHS else ""}{mark.name.replace(" ", "-")}"'
        if mark.limb:
            kind += f' data-limb="{mark.limb}"'
        if mark.letters:
            fit = (
                f' textLength="{px(mark.fit)}" lengthAdjust="spacingAndGlyphs"' if mark.fit else ""
            )
            style = f" {mark.style}" if mark.style else ""
            at = f'x="{px(mark.at[0])}" y="{px(mark.at[1])}"'
            yield (
                f'<text {kind} {at} font-size="{px(mark.size)}" '
                f'text-anchor="{mark.anchor}"{style}{fit}>{text(mark.letters)}</text>'
            )
            continue
        if mark.fill and mark.stroke:
            yield f"<g {kind}>"
            kind = 'class="ink"'
        if mark.fill:
            yield f'<path {kind} d="{_data(mark.fill)}"/>'
        if mark.stroke:
            yield (
                f'<path {kind} d="{_data(mark.stroke)}" fill="none" stroke="{INK}" '
                f'stroke-width="{px(mark.weight)}"/>'
            )
        if mark.fill and mark.stroke:
            yield "</g>"


def _data(path: Path) -> str:
    return "".join(
        command + " ".join(f"{px(x)} {px(y)}" for x, y in points) for command, points in path
    )


def text(value: str) -> str:
    """Escaped for XML, and without the characters that XML can't hold."""
    return escape(_NOT_XML.sub("\ufffd", value))


def px(spaces: float) -> str:
    """A length in pixels."""
    digits = f"{spaces * SPACE:.2f}".rstrip("0").rstrip(".")
    return "0" if digits in ("-0", "") else digits
