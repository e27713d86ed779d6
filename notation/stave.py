"""Draws a score as an SVG stave.

Five lines, read from left to right; frames that are written, and in them only what is written (what
is not stays as it was), named positions expanded to their signs. Seen from behind the dancer.

Beat 0 is the pose to start from and stands before the first bar, as count-in bars do; bar n of a
metre with m pulses holds the beats from (n - 1) m + 1 up to the next bar.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from fractions import Fraction
from html import escape

from enpointe.notation.glyphs import FEET_APART, GLYPHS, crossed, extremity, joint, orientation
from enpointe.notation.score import Frame, Score
from enpointe.notation.signs import FeetPosition, Side, Sign
from enpointe.notation.vocabulary import arm_signs, feet_signs
from enpointe.notation.writer import format_beat, frame_lines

__all__ = ["stave_svg"]

SPACE = 18.0
"""Distance between two stave lines, in pixels."""

FRAMES_PER_STAVE = 12

_FRAME_WIDTH = 5.0
_REACH = 2.0
_LEFT = 3.0
_RIGHT = 1.2
_LAST = 0.5
_TOP = 4.4
_ABOVE = 3.4
_BELOW = 2.4
_LINE = 0.055
_BAR = 0.085
_INK = "#111"
_SERIF = "Georgia, 'Times New Roman', 'DejaVu Serif', serif"
_NOT_XML = re.compile("[^\t\n\r\x20-\ud7ff\ue000-\ufffd\U00010000-\U0010ffff]")
_PARTS_OF_A_BEAT = {
    Fraction(1, 2): "&",
    Fraction(1, 4): "¼",
    Fraction(3, 4): "¾",
    Fraction(1, 3): "⅓",
    Fraction(2, 3): "⅔",
}


def stave_svg(score: Score) -> str:
    """Draws a score.

    Args:
        score: The score, as parsed (its positions are in the vocabulary).

    Returns:
        A self-contained SVG document. Each frame is ``<g class="frame" id="frame-N"
        data-beat="...">``, N from 0, with a transparent rectangle over its whole cell to be clicked
        on.
    """
    staves = _wrap(score)
    columns = max((len(stave) for stave in staves), default=1)
    width = _LEFT + _RIGHT + _FRAME_WIDTH * max(columns, 3)
    height = _TOP + len(staves) * (_ABOVE + 4.0 + _BELOW)
    parts = [
        f'<svg xmlns="http://www.w3.org/2000/svg" class="stave" role="img" width="{_px(width)}" '
        f'height="{_px(height)}" viewBox="0 0 {_px(width)} {_px(height)}" font-family="{_SERIF}" '
        f'fill="{_INK}">',
        f"<title>{_text(score.title)}</title>",
        f'<rect width="{_px(width)}" height="{_px(height)}" fill="#fff"/>',
        *_heading(score, width),
    ]
    for row, stave in enumerate(staves):
        top = _TOP + row * (_ABOVE + 4.0 + _BELOW) + _ABOVE
        parts += _stave(score, stave, top, last=row == len(staves) - 1)
    parts.append("</svg>")
    return "\n".join(parts) + "\n"


def _bar(score: Score, beat: Fraction) -> int:
    return (beat - 1) // score.metre[0]


def _wrap(score: Score) -> list[list[tuple[int, Frame]]]:
    """Frames by stave, broken at a bar line where the bars are short enough."""
    bars: list[list[tuple[int, Frame]]] = []
    for index, frame in enumerate(score.frames):
        new = not bars or _bar(score, frame.beat) != _bar(score, bars[-1][-1][1].beat)
        if new or len(bars[-1]) == FRAMES_PER_STAVE:
            bars.append([])
        bars[-1].append((index, frame))
    staves: list[list[tuple[int, Frame]]] = []
    for bar in bars:
        if not staves or len(staves[-1]) + len(bar) > FRAMES_PER_STAVE:
            staves.append([])
        staves[-1] += bar
    return staves


def _heading(score: Score, width: float) -> Iterator[str]:
    size = min(1.55, 1.8 * width / max(len(score.title), 1))
    yield _label(score.title, width / 2, 2.1, size, anchor="middle")
    yield _label(score.method, width - _RIGHT, 3.6, 0.85, anchor="end", style="italic")
    yield from _tempo(score)


def _tempo(score: Score) -> Iterator[str]:
    """The metronome mark, its note drawn so that no music font is needed."""
    x, y = 0.62 + 0.6, _TOP + 0.42
    number = f"= {score.tempo:g}"
    unit = score.metre[1]
    if unit not in (2, 4, 8):
        yield _label(f"pulse {number}", x - 0.3, y, 0.9)
        return
    head = f'cx="{_px(x)}" cy="{_px(y - 0.22)}" rx="{_px(0.27)}" ry="{_px(0.19)}"'
    turned = f'transform="rotate(-22 {_px(x)} {_px(y - 0.22)})"'
    paint = (
        f'fill="none" stroke="{_INK}" stroke-width="{_px(0.08)}"' if unit == 2 else f'fill="{_INK}"'
    )
    yield f'<g class="tempo"><ellipse {head} {turned} {paint}/>'
    yield _stroke(x + 0.23, y - 0.3, x + 0.23, y - 1.35, 0.07)
    if unit == 8:
        yield _stroke(x + 0.21, y - 1.32, x + 0.52, y - 0.85, 0.09)
    yield f"{_label(number, x + 0.75, y, 0.9)}</g>"


def _stave(
    score: Score, frames: Sequence[tuple[int, Frame]], top: float, last: bool
) -> Iterator[str]:
    end = _LEFT + _FRAME_WIDTH * len(frames) + (_LAST if last else 0.0)
    start = 0.6
    for line in range(5):
        yield _stroke(start, top + line, end, top + line, _LINE)
    yield _stroke(start, top, start, top + 4, _BAR)
    middle = (start + _LEFT) / 2
    if frames[0][0] == 0:
        yield _label(str(score.metre[0]), middle, top + 1.78, 1.7, anchor="middle", weight="bold")
        yield _label(str(score.metre[1]), middle, top + 3.38, 1.7, anchor="middle", weight="bold")
    for column, (index, frame) in enumerate(frames):
        left = _LEFT + column * _FRAME_WIDTH
        if column and _bar(score, frame.beat) != _bar(score, frames[column - 1][1].beat):
            yield _stroke(left, top, left, top + 4, _BAR)
        yield from _frame(index, frame, left, top)
    if last:
        yield _stroke(end - 0.42, top, end - 0.42, top + 4, _BAR)
        yield _stroke(end - 0.12, top, end - 0.12, top + 4, 0.24)
    else:
        yield _stroke(end, top, end, top + 4, _BAR)


def _frame(index: int, frame: Frame, left: float, top: float) -> Iterator[str]:
    centre = left + _FRAME_WIDTH / 2
    beat = format_beat(frame.beat)
    yield f'<g class="frame" id="frame-{index}" data-beat="{_text(beat)}">'
    yield f"<title>{_text('; '.join((f'beat {beat}', *frame_lines(frame))))}</title>"
    yield (
        f'<rect x="{_px(left)}" y="{_px(top - 2.8)}" width="{_px(_FRAME_WIDTH)}" '
        f'height="{_px(8.4)}" fill="none" pointer-events="all"/>'
    )
    yield _label(_count(frame.beat), centre, top - 1.75, 0.95, anchor="middle")
    hands = arm_signs(frame.arms) if frame.arms else dict(frame.hands)
    for side, sign in hands.items():
        yield from _limb(extremity(sign.depth), side, sign, centre, top)
    for side, sign in (*frame.elbows.items(), *frame.knees.items()):
        yield from _limb(joint(sign.depth), side, sign, centre, top)
    if frame.feet:
        yield from _feet(frame.feet, centre, top)
    for side, sign in frame.foot_signs.items():
        yield from _limb(extremity(sign.depth), side, sign, centre, top)
    for space, part in enumerate((frame.head, frame.body, frame.pelvis)):
        for name, dx, dy in orientation(part) if part else ():
            yield _glyph(name, centre + dx, top + space + 0.5 + dy)
    yield "</g>"


def _limb(name: str, side: Side, sign: Sign, centre: float, top: float) -> Iterator[str]:
    outward = 1.0 if side is Side.RIGHT else -1.0
    x = centre + outward * sign.width * _REACH
    y = top + 5.0 - sign.height
    if sign.height == 1.0:
        y += _below_floor(name)
    yield _glyph(name, x, y)
    if crossed(sign):
        yield _glyph("crossed", x, y)


def _feet(position: FeetPosition, centre: float, top: float) -> Iterator[str]:
    for side, sign in feet_signs(position).items():
        name = extremity(sign.depth)
        outward = 1.0 if side is Side.RIGHT else -1.0
        x = centre + outward * FEET_APART[position.name]
        yield _glyph(name, x, top + 4.0 + _below_floor(name))


def _below_floor(name: str) -> float:
    """How far a flat foot's sign stands under the floor line, so that it hangs from it."""
    glyph = GLYPHS[name]
    reach = max([glyph.radius, *(max(abs(y1), abs(y2)) for _, y1, _, y2 in glyph.strokes)])
    return max(reach, glyph.weight / 2) + _LINE / 2


def _glyph(name: str, x: float, y: float) -> str:
    glyph = GLYPHS[name]
    kind = f'class="sign {name.replace(" ", "-")}"'
    if glyph.radius:
        return f'<circle {kind} cx="{_px(x)}" cy="{_px(y)}" r="{_px(glyph.radius)}"/>'
    path = "".join(
        f"M{_px(x + x1)} {_px(y + y1)}L{_px(x + x2)} {_px(y + y2)}"
        for x1, y1, x2, y2 in glyph.strokes
    )
    return (
        f'<path {kind} d="{path}" stroke="{_INK}" stroke-width="{_px(glyph.weight)}" fill="none"/>'
    )


def _count(beat: Fraction) -> str:
    """What is counted: whole beats by number, a half by "&", other parts by their fraction."""
    rest = beat % 1
    if not rest:
        return str(beat)
    return _PARTS_OF_A_BEAT.get(rest, str(rest))


def _stroke(x1: float, y1: float, x2: float, y2: float, weight: float) -> str:
    return (
        f'<path d="M{_px(x1)} {_px(y1)}L{_px(x2)} {_px(y2)}" stroke="{_INK}" '
        f'stroke-width="{_px(weight)}" fill="none"/>'
    )


def _label(
    text: str,
    x: float,
    y: float,
    size: float,
    anchor: str = "start",
    style: str = "normal",
    weight: str = "normal",
) -> str:
    return (
        f'<text x="{_px(x)}" y="{_px(y)}" font-size="{_px(size)}" text-anchor="{anchor}" '
        f'font-style="{style}" font-weight="{weight}">{_text(text)}</text>'
    )


def _text(value: str) -> str:
    """Escaped for XML, and without the characters that XML can't hold."""
    return escape(_NOT_XML.sub("\ufffd", value))


def _px(spaces: float) -> str:
    return f"{spaces * SPACE:.2f}".rstrip("0").rstrip(".")
