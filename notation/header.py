"""Reads what stands before the first frame: the header, repeats and phrases."""

from __future__ import annotations

import json
import re
import unicodedata
from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction

from lark import Token, Tree

from enpointe.notation.amounts import MAX_TIMES, TEMPO_FACTORS
from enpointe.notation.numerals import beat_number, number
from enpointe.notation.phrasing import EFFORT_FACTORS, EFFORTS, Phrase, Repeat, effort_text
from enpointe.notation.reading import (
    Reader,
    location,
    tokens_of,
    trees_of,
)
from enpointe.notation.score import TEMPO_RANGE
from enpointe.notation.signs import Location
from enpointe.notation.tempo import TEMPO_WORDS, is_tempo_word, tempo_of

__all__ = ["MAX_TEXT", "Header", "is_plain", "metre_of", "read_phrase", "read_repeat"]

MAX_TEXT = 200
"""Longest title, method or name of a phrase."""

_EXAMPLES = {
    "title": "title: Third port de bras",
    "method": "method: Cecchetti",
    "metre": "metre: 4/4",
    "tempo": "tempo: 60",
}
_METRE = re.compile(r"([0-9]{1,2})[ \t]*/[ \t]*([0-9]{1,2})")


def is_plain(text: str) -> bool:
    """Whether a text holds nothing but text."""
    return not any(unicodedata.category(char) in ("Cc", "Cs") for char in text)


def metre_of(pulses: int, unit: int) -> tuple[int, int] | None:
    """The metre, or None if there is no such."""
    return (pulses, unit) if 1 <= pulses <= 32 and unit in (1, 2, 4, 8, 16) else None


@dataclass
class Header:
    """The fields given so far.

    Attributes:
        reader: Refuses what is wrong.
        fields: The value of each field, by its name.
    """

    reader: Reader
    fields: dict[str, Token]

    def add(self, node: Tree[Token]) -> None:
        """Takes one field.

        Raises:
            ScoreError: It is given already.
        """
        key, value = tokens_of(node)
        name = "metre" if key.lower() == "meter" else str(key.lower())
        if name in self.fields:
            raise self.reader.fail(
                f"'{name}' is already given on line {self.fields[name].line}; keep one", key
            )
        self.fields[name] = value

    def require(self, at: Token | Location) -> None:
        """Refuses a header that lacks a field; `at` is where the header ends."""
        for name, example in _EXAMPLES.items():
            if name not in self.fields:
                raise self.reader.fail(
                    f"the header lacks its {name}; "
                    f"add a line such as '{example}' before the first beat",
                    at,
                )

    def text(self, name: str) -> str:
        """The title or the method."""
        return _text(self.reader, self.fields[name])

    def metre(self) -> tuple[int, int]:
        """Pulses of a bar, and the value of a pulse."""
        token = self.fields["metre"]
        match = _METRE.fullmatch(token.strip())
        metre = metre_of(int(match[1]), int(match[2])) if match else None
        if metre is None:
            raise self.reader.fail(
                f"'{token.strip()[:20]}' is not a metre; "
                "write the beats of a bar over 1, 2, 4, 8 or 16, such as 3/4 or 4/4",
                token,
            )
        return metre

    def tempo(self) -> tuple[float, str | None]:
        """Pulses a minute, and the word that gives them if one does."""
        token = self.fields["tempo"]
        words = token.split()
        last = number(words[-1])
        word = " ".join(words[:-1] if last is not None else words) or None
        value = last if last is not None or word is None else tempo_of(word)
        slowest, fastest = TEMPO_RANGE
        if (
            value is None
            or not slowest <= value <= fastest
            or not (word is None or is_tempo_word(word))
        ):
            raise self.reader.fail(
                f"'{token.strip()[:30]}' is not a tempo; write beats a minute, {slowest:g} to "
                f"{fastest:g}, a word ({', '.join(TEMPO_WORDS)}), or any word and its number",
                token,
            )
        return value, word

    def pickup(self, metre: tuple[int, int]) -> Fraction:
        """Pulses before the first bar line."""
        token = self.fields.get("pickup")
        if token is None:
            return Fraction(0)
        pulses = beat_number(token.strip())
        if pulses is None or pulses >= metre[0]:
            raise self.reader.fail(
                f"'{token.strip()[:20]}' is not a pickup; write the beats before the first bar "
                f"line, fewer than the {metre[0]} of a bar",
                token,
            )
        return pulses


def read_repeat(reader: Reader, node: Tree[Token]) -> Repeat:
    """Takes a line such as "repeat 1 to 4: once more, other side".

    Raises:
        ScoreError: It is wrong in itself.
    """
    keyword, first, last, *flags = tokens_of(node)
    times: int | None = None
    endings: dict[str, tuple[int, int]] = {}
    if len(flags) > 1:
        raise reader.fail("'other side' is written twice; keep one", flags[1])
    for item in trees_of(node):
        token, *counts = tokens_of(item)
        if item.data == "times":
            if times is not None:
                raise reader.fail("how often is written twice; keep one", token)
            words = {"once": 1, "twice": 2}
            times = words.get(token.lower()) or reader.count(token, MAX_TIMES)
            continue
        which = str(token.lower())
        if which in endings:
            raise reader.fail(f"the {which} ending is written twice; keep one", token)
        endings[which] = (reader.count(counts[0]), reader.count(counts[1]))
    if len(endings) == 1:
        missing = "second" if "first" in endings else "first"
        raise reader.fail(f"the {missing} ending is missing; write both or none", keyword)
    return Repeat(
        reader.count(first),
        reader.count(last),
        times or 1,
        bool(flags),
        (endings["first"], endings["second"]) if endings else (),
        location(keyword),
    )


def read_phrase(reader: Reader, node: Tree[Token]) -> Phrase:
    """Takes a line such as "phrase 1 to 4: sad, slowing to 0.8".

    Raises:
        ScoreError: It is wrong in itself.
    """
    keyword, first, last, *words = tokens_of(node)
    efforts = [token for token in words if token.type == "WORD"]
    quotes = [token for token in words if token.type == "QUOTED"]
    changes = [item for item in trees_of(node) if item.data == "tempo_change"]
    factors = [item for item in trees_of(node) if item.data == "factor"]
    extra = [*quotes[1:2], *efforts[1:2], *(tokens_of(item)[0] for item in changes[1:2])]
    if efforts and factors:
        extra.append(max(efforts[0], tokens_of(factors[0])[0], key=_place))
    if extra:
        raise reader.fail(
            f"'{min(extra, key=_place)[:40]}' contradicts what stands before it; keep one",
            min(extra, key=_place),
        )
    return Phrase(
        reader.count(first),
        reader.count(last),
        _effort(reader, efforts, factors),
        _change(reader, changes[0]) if changes else None,
        _text(reader, quotes[0]) if quotes else None,
        location(keyword),
    )


def _effort(reader: Reader, words: Sequence[Token], factors: Sequence[Tree[Token]]) -> str | None:
    if words:
        return reader.choice(words[0], {word: word for word in EFFORTS}, "a quality", words[0])
    values: dict[str, float] = {}
    for item in factors:
        token, amount = tokens_of(item)
        name = str(token.lower())
        if name in values:
            raise reader.fail(f"'{name}' is written twice; keep one", token)
        low, high = EFFORT_FACTORS[name]
        values[name] = reader.value(amount, low, high, f"for the {name} of an effort")
    return effort_text(values) if values else None


def _change(reader: Reader, node: Tree[Token]) -> float:
    word, amount = tokens_of(node)
    low, high = TEMPO_FACTORS
    factor = reader.value(amount, low, high, "times the tempo")
    slower = word.lower() == "slowing"
    if factor == 1.0 or (factor < 1.0) is not slower:
        raise reader.fail(
            f"'{word}' needs a factor {'below' if slower else 'above'} 1, "
            f"such as {'0.8' if slower else '1.2'}",
            amount,
        )
    return factor


def _place(token: Token) -> tuple[int, int]:
    return token.line or 1, token.column or 1


def _text(reader: Reader, token: Token) -> str:
    value = str(token).strip()
    if value.startswith('"'):
        try:
            value = json.loads(value)
        except ValueError:
            raise reader.fail('after a backslash in quotes write only \\" or \\\\', token) from None
    if not is_plain(value):
        raise reader.fail("a control character has no place in a title or method", token)
    if not value.strip():
        raise reader.fail("a name is missing between the quotes", token)
    if len(value) > MAX_TEXT:
        raise reader.fail(f"too long; use at most {MAX_TEXT} characters", token)
    return value
