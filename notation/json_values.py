"""Single values of the JSON form, each checked and each with its path."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from enum import StrEnum
from fractions import Fraction
from typing import Any, TypeVar

from enpointe.errors import ScoreError
from enpointe.notation.numerals import beat_number
from enpointe.notation.signs import Side
from enpointe.notation.wording import quoted

__all__ = ["Node"]

Value = TypeVar("Value")
Word = TypeVar("Word", bound=StrEnum)


class Node:
    """A value of a JSON document and the path to it, such as "$.frames[2].hands.left".

    Args:
        value: What `json` read.
        path: Where it stands.
        source: The name to give in error messages.
    """

    def __init__(self, value: Any, path: str = "$", source: str | None = None) -> None:
        self._value = value
        self._path = path
        self._source = source
        self._taken: set[str] = set()

    def fail(self, message: str) -> ScoreError:
        """The error to raise."""
        return ScoreError(f"{self._path}: {message}", 1, 1, self._source)

    def get(self, key: str) -> Node | None:
        """The value of a key; None if it is absent."""
        self._taken.add(key)
        value = self._object()
        if key not in value:
            return None
        return Node(value[key], f"{self._path}.{key}", self._source)

    def need(self, key: str) -> Node:
        """The value of a key that must be there."""
        node = self.get(key)
        if node is None:
            raise self.fail(f"'{key}' is missing")
        return node

    def done(self) -> None:
        """Refuses keys that nobody asked for."""
        for key in self._object():
            if key not in self._taken:
                known = quoted(sorted(self._taken))
                raise self.fail(f"'{str(key)[:40]}' has no meaning here; known are {known}")

    def items(self, most: int) -> Iterator[Node]:
        """The items of a list."""
        if not isinstance(self._value, list):
            raise self.fail("a list is needed")
        if len(self._value) > most:
            raise self.fail(f"too long; at most {most} are read")
        for index, value in enumerate(self._value):
            yield Node(value, f"{self._path}[{index}]", self._source)

    def sides(self, read: Callable[[Node], Value]) -> dict[Side, Value]:
        """An object with "left", "right" or both."""
        found = {side: self.get(side.value) for side in Side}
        self.done()
        return {side: read(node) for side, node in found.items() if node is not None}

    def text(self, most: int) -> str:
        """A string of at most so many characters."""
        if not isinstance(self._value, str) or len(self._value) > most:
            raise self.fail(f"a string of at most {most} characters is needed")
        return self._value

    def flag(self) -> bool:
        """True or false."""
        if not isinstance(self._value, bool):
            raise self.fail("true or false is needed")
        return self._value

    def number(self, low: float, high: float) -> float:
        """A number in a range."""
        if isinstance(self._value, (int, float)) and not isinstance(self._value, bool):
            value = float(self._value) if abs(self._value) < 1e12 else math.inf
            if low <= value <= high:
                return value
        raise self.fail(f"a number from {low:g} to {high:g} is needed")

    def whole(self, low: int, high: int) -> int:
        """A whole number in a range."""
        value = self._value
        if isinstance(value, int) and not isinstance(value, bool) and low <= value <= high:
            return value
        raise self.fail(f"a whole number from {low} to {high} is needed")

    def beat(self) -> Fraction:
        """A whole number, or a string such as "1+1/2"."""
        value = self._value
        text = value if isinstance(value, str) else ""
        if isinstance(value, int) and not isinstance(value, bool) and 0 <= value < 10**6:
            text = str(value)
        beat = beat_number(text) if len(text) < 40 else None
        if beat is None:
            raise self.fail('a beat is needed, such as 2, "1+1/2" or "2+1/3"')
        return beat

    def word(self, words: type[Word]) -> Word:
        """One of the words of the notation."""
        if isinstance(self._value, str) and self._value in {word.value for word in words}:
            return words(self._value)
        raise self.fail(f"{quoted([word.value for word in words])} is needed")

    def _object(self) -> dict[str, Any]:
        if not isinstance(self._value, dict):
            raise self.fail("an object is needed")
        return self._value
