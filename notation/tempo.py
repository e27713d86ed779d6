"""Tempo marks in words, with the metronome number that they stand for."""

from __future__ import annotations

import re
from collections.abc import Mapping

from enpointe.notation.spelling import fold

__all__ = ["MAX_TEMPO_WORD", "TEMPO_WORDS", "is_tempo_word", "tempo_of"]

TEMPO_WORDS: Mapping[str, float] = {
    "Grave": 42.0,
    "Largo": 50.0,
    "Lento": 54.0,
    "Larghetto": 63.0,
    "Adagio": 70.0,
    "Andante": 92.0,
    "Andantino": 96.0,
    "Moderato": 112.0,
    "Allegretto": 116.0,
    "Allegro": 138.0,
    "Vivace": 164.0,
    "Presto": 184.0,
    "Prestissimo": 208.0,
    "slow": 54.0,
    "moderate": 96.0,
    "fast": 144.0,
}
"""Pulses a minute that a word alone means: about the middle of the range that metronomes print for
the Italian words; what is meant by the instructions, with which scores are written too (Neagle 2005
§4.2.1), is ours. A number after the word says otherwise."""

MAX_TEMPO_WORD = 60

_BY_NAME = {fold(word): number for word, number in TEMPO_WORDS.items()}
_WORD = re.compile(r"[^\W\d_][\w.,'\u2019()\-]*(?: [\w.,'\u2019()\-]+)*")


def tempo_of(word: str) -> float | None:
    """Pulses a minute that the word alone stands for; None if it needs a number."""
    return _BY_NAME.get(fold(word))


def is_tempo_word(word: str) -> bool:
    """Whether it can stand in a tempo mark: words from a letter on, a blank between them."""
    return len(word) <= MAX_TEMPO_WORD and _WORD.fullmatch(word) is not None
