"""What stands above and below one frame: its count; facing, place, travel and turn.

Up the page is towards the audience, for the page is seen from behind the dancer; so stage left is
on the left.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from fractions import Fraction

from enpointe.notation.frame import Frame
from enpointe.notation.score import Score
from enpointe.notation.stage import StagePlace, Travel, Turn
from enpointe.notation.stave_ink import Mark, between, glyph, text_width, union, words

__all__ = ["count_marks", "stage_marks"]

STAGE = (12.0, 9.0)
"""Width and depth of the stage that the plan shows, m; a place off it is drawn on its edge."""

_PLAN = (1.4, 1.0)
_GAP = 0.4
_COUNT_SIZE = 0.95
_AMOUNT_SIZE = 0.62
_PARTS = {
    Fraction(1, 2): "half",
    Fraction(1, 4): "quarter",
    Fraction(3, 4): "three quarters",
    Fraction(1, 3): "third",
    Fraction(2, 3): "two thirds",
}
_TURNS = {Fraction(n, 8): "⅛¼⅜½⅝¾⅞"[n - 1] for n in range(1, 8)}


def count_marks(score: Score, beat: Fraction, y: float) -> tuple[Mark, ...]:
    """The count of a beat within its bar: its number, or the sign of its part.

    Args:
        score: The score, for its bars.
        beat: The beat.
        y: The baseline.
    """
    rest = beat % 1
    if rest in _PARTS:
        return (glyph(_PARTS[rest], 0.0, y),)
    if rest:
        return (words(str(rest), 0.0, y, 0.7 * _COUNT_SIZE, anchor="middle", name="count"),)
    bar = score.bar(beat)
    count = beat - score.beat_of(bar, Fraction(0)) if beat > 0 else beat
    return (words(str(count), 0.0, y, _COUNT_SIZE, anchor="middle", name="count"),)


def stage_marks(frame: Frame) -> tuple[Mark, ...]:
    """The signs below the stave that a frame writes, side by side about x = 0, y = 0."""
    items: list[list[Mark]] = []
    if frame.place is not None:
        items.append(list(_place(frame.place)))
    if frame.facing is not None:
        items.append([glyph("facing", 0.0, 0.0, frame.facing.degrees)])
    if frame.travel is not None:
        items.append(list(_travel(frame.travel)))
    if frame.turn is not None:
        items.append(list(_turn(frame.turn)))
    boxes = [union(mark.box for mark in item) for item in items]
    total = sum(box.right - box.left for box in boxes) + _GAP * max(len(items) - 1, 0)
    x, marks = -total / 2, []
    for item, box in zip(items, boxes, strict=True):
        marks += [mark.moved(x - box.left, 0.0) for mark in item]
        x += box.right - box.left + _GAP
    return tuple(marks)


def _place(place: StagePlace) -> Iterator[Mark]:
    def on_plan(metres: float, stage: float, plan: float) -> float:
        return max(-0.5, min(0.5, metres / stage)) * (plan - 0.3)

    yield glyph("stage", 0.0, 0.0)
    x = -on_plan(place.left, STAGE[0], _PLAN[0])
    yield glyph("place", x, on_plan(place.up, STAGE[1], _PLAN[1]))


def _travel(travel: Travel) -> Iterator[Mark]:
    angle = math.radians(travel.degrees)
    length = 1.3 if travel.metres else 0.5
    x, y = -length * math.sin(angle), -length * math.cos(angle)
    way = "straight" if not travel.curve else "left" if travel.curve > 0 else "right"
    mark = between(f"travel {way}", (-x / 2, -y / 2), (x / 2, y / 2))
    yield mark
    amount = f"{round(travel.metres, 2):g} m"
    beside = mark.box.right + 0.12
    yield words(amount, beside, 0.2, _AMOUNT_SIZE, name="amount")


def _turn(turn: Turn) -> Iterator[Mark]:
    mark = glyph(f"turning {turn.sense}", 0.0, 0.0)
    yield mark
    amount = _turns(turn.degrees)
    if text_width(amount, _AMOUNT_SIZE) < 0.75:
        yield words(amount, 0.0, 0.24, _AMOUNT_SIZE, anchor="middle", name="amount")
    else:
        yield words(amount, mark.box.right + 0.12, 0.2, _AMOUNT_SIZE, name="amount")


def _turns(degrees: float) -> str:
    """Turns in whole and eighths, else degrees."""
    eighths = degrees / 45.0
    if eighths != int(eighths):
        return f"{degrees:.4g}°"
    whole, rest = divmod(int(eighths), 8)
    return (str(whole) if whole else "") + _TURNS.get(Fraction(rest, 8), "") or "0"
