"""What stands above a whole stretch of the stave: phrases with their quality, and endings."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from fractions import Fraction

from enpointe.notation.phrasing import Phrase
from enpointe.notation.score import Score
from enpointe.notation.stave_ink import Mark, between, text_width, words
from enpointe.notation.stave_layout import Cell

__all__ = ["BOLD", "ITALIC", "Placed", "above_marks"]

BOLD = 'font-weight="bold"'
ITALIC = 'font-style="italic"'

Placed = Sequence[tuple[Cell, float, list[Mark]]]
"""The frames of a stave, where their centre lines are, and their marks so far."""

_LINE = -2.75
_SIZE = 0.82
_SMALLEST = 0.55
_ROW = 0.95
_SLUR = 0.6
_ENDING = 0.95


def above_marks(score: Score, placed: Placed) -> Iterator[Mark]:
    """Slurs of phrases with their words, and over them the brackets of endings.

    Args:
        score: The score.
        placed: What stands on the stave.

    Yields:
        Marks with y from the top line.
    """
    base = min([_LINE, *(mark.box.top - 0.15 for *_, own in placed for mark in own)])
    highest = base
    for phrase in score.phrases:
        for mark in _phrase(phrase, placed, base):
            highest = min(highest, mark.box.top)
            yield mark
    for repeat in score.repeats:
        for number, (first, last) in enumerate(repeat.endings, 1):
            span = _span(placed, Fraction(first - 1), Fraction(last))
            if span is None:
                continue
            left, right, start = span
            name = "ending open" if number == len(repeat.endings) else "ending closed"
            y = highest - _ENDING
            yield between(name, (left - 0.45, y), (right + 0.45, y))
            if not any(first - 1 < frame.beat < start for frame in score.frames):
                yield words(f"{number}.", left - 0.2, y + 0.8, 0.85, name="ending-number")


def _span(placed: Placed, after: Fraction, until: Fraction) -> tuple[float, float, Fraction] | None:
    """Where the frames after one beat and up to another begin and end, and their first beat."""
    inside = [(x, cell.frame.beat) for cell, x, _ in placed if after < cell.frame.beat <= until]
    if not inside:
        return None
    return inside[0][0] - 0.35, inside[-1][0] + 0.35, inside[0][1]


def _phrase(phrase: Phrase, placed: Placed, y: float) -> Iterator[Mark]:
    span = _span(placed, phrase.start, phrase.end)
    if span is None:
        return
    left, right, _ = span
    yield between("phrase", (left, y), (right, y))
    y -= _SLUR + 0.22
    quality = _words(phrase.effort) if phrase.effort else None
    label = ", ".join(each for each in (phrase.name, quality) if each)
    if label:
        room = max(right - left, 3.2)
        size = min(_SIZE, max(_SMALLEST, _SIZE * room / text_width(label, _SIZE)))
        middle = max((left + right) / 2, room / 2)
        yield words(label, middle, y, size, anchor="middle", style=ITALIC, fit=room, name="quality")
        y -= _ROW
    if phrase.tempo_end is not None and phrase.tempo_end != 1.0:
        word = "rall." if phrase.tempo_end < 1.0 else "accel."
        mark = words(word, left, y, _SIZE, style=ITALIC, name="tempo-change")
        yield mark
        if right - mark.box.right > 0.5:
            yield between("gradual", (mark.box.right + 0.15, y - 0.2), (right, y - 0.2))


def _words(effort: str) -> str:
    """ "time=-3.5,weight=.4" as "time −3.5, weight .4"; words stay as they are."""
    spaced = re.sub(r"\s*=\s*", " ", re.sub(r"\s*,\s*", ", ", effort))
    return re.sub(r"(?<=\s)-(?=[\d.])", "\u2212", spaced)
