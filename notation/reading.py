"""What every reader of parsed lines needs: tokens, places, numbers, beats, and refusing."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from fractions import Fraction
from typing import TypeVar

from lark import Token, Tree

from enpointe.errors import ScoreError
from enpointe.notation.numerals import MAX_BEAT, MAX_DENOMINATOR, beat_number, number
from enpointe.notation.signs import Location, Side
from enpointe.notation.spelling import close_to, fold
from enpointe.notation.wording import quoted

__all__ = [
    "Reader",
    "location",
    "side_of",
    "token_of",
    "tokens_of",
    "trees_of",
    "words_of",
]

Value = TypeVar("Value")


def tokens_of(node: Tree[Token]) -> list[Token]:
    """The tokens right under a node, in order."""
    return [child for child in node.children if isinstance(child, Token)]


def trees_of(node: Tree[Token]) -> Iterator[Tree[Token]]:
    """The nodes right under a node, in order."""
    return (child for child in node.children if isinstance(child, Tree))


def token_of(node: Tree[Token], kind: str) -> Token | None:
    """The first token of a kind right under a node."""
    return next((each for each in tokens_of(node) if each.type == kind), None)


def words_of(node: Tree[Token]) -> str:
    """The tokens of a node as one string."""
    return " ".join(tokens_of(node))


def side_of(token: Token) -> Side:
    """The side that a token names."""
    return Side(token.lower())


def location(token: Token) -> Location:
    """Where a token stands."""
    return Location(token.line or 1, token.column or 1)


class Reader:
    """Refuses with the place in the text.

    Args:
        source: The name to give in error messages.
    """

    def __init__(self, source: str | None) -> None:
        self.source = source

    def fail(self, message: str, at: Token | Location) -> ScoreError:
        """The error to raise."""
        return ScoreError(message, at.line or 1, at.column or 1, self.source)

    def value(self, token: Token, low: float, high: float, meaning: str) -> float:
        """A number in a range; `meaning` completes "write 1 to 6 ...".

        Raises:
            ScoreError: It is no number, or out of the range.
        """
        value = number(str(token))
        if value is None or not low <= value <= high:
            raise self.fail(
                f"'{token[:40]}' can't stand here; write {low:g} to {high:g} {meaning}", token
            )
        return value

    def count(self, token: Token, most: int = MAX_BEAT) -> int:
        """A whole number from 1.

        Raises:
            ScoreError: It is none.
        """
        text = str(token)
        if not (text.isascii() and text.isdigit() and len(text) < 10 and 1 <= int(text) <= most):
            raise self.fail(f"'{token[:40]}' is not a whole number from 1 to {most}", token)
        return int(text)

    def beat(self, token: Token) -> Fraction:
        """A beat.

        Raises:
            ScoreError: It is none.
        """
        beat = beat_number(str(token))
        if beat is None:
            raise self.fail(
                f"'{token[:40]}' is not a beat; write a count such as 2, 1+1/2 or 2+1/3, "
                f"at most {MAX_BEAT} and no finer than 1/{MAX_DENOMINATOR}",
                token,
            )
        return beat

    def choice(self, text: str, table: Mapping[str, Value], what: str, at: Token) -> Value:
        """What a word stands for in a table of folded spellings.

        Raises:
            ScoreError: The table doesn't know it.
        """
        found = table.get(fold(text))
        if found is None:
            close = close_to(text, {word: word for word in table})
            hint = f"did you mean {quoted(close)}?" if close else f"write {quoted(tuple(table))}"
            raise self.fail(f"'{text[:60]}' is not {what}; {hint}", at)
        return found
