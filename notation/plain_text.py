"""From what a file holds to its parse tree, or a ScoreError in a dancer's words."""

from __future__ import annotations

import functools
import re
import unicodedata
from importlib import resources
from typing import Literal

from lark import Lark, Token, Tree
from lark.exceptions import UnexpectedCharacters, UnexpectedInput, UnexpectedToken

from enpointe.errors import ScoreError
from enpointe.notation.wording import describe_end, either, phrase, suggest

__all__ = ["MAX_BYTES", "decode", "parse_tree"]

MAX_BYTES = 200_000
"""Largest score that is read; a whole ballet of key poses is smaller."""

MAX_LINE = 1000


@functools.cache
def _grammar() -> Lark:
    text = resources.files("enpointe.notation").joinpath("grammar.lark").read_text("utf-8")
    return Lark(
        text,
        parser="lalr",
        lexer="contextual",
        maybe_placeholders=False,
        start=["start", "vocabulary"],
    )


def parse_tree(
    text: str | bytes, source: str | None, start: Literal["start", "vocabulary"]
) -> Tree[Token]:
    """The parse tree of a score or of a vocabulary file.

    Raises:
        ScoreError: It is no text, too large, or not in the grammar.
    """
    clean = decode(text, source)
    try:
        return _grammar().parse(clean, start=start)
    except UnexpectedInput as error:
        raise _syntax_error(error, clean, source) from None


def decode(text: str | bytes, source: str | None) -> str:
    """Text with plain line ends and nothing in it that is not text."""

    def refuse(message: str, before: str) -> ScoreError:
        lines = before.replace("\r\n", "\n").replace("\r", "\n").split("\n")
        return ScoreError(message, len(lines), len(lines[-1]) + 1, source)

    if len(text) > MAX_BYTES:
        raise ScoreError(f"too large for a score: more than {MAX_BYTES} characters", 1, 1, source)
    if isinstance(text, bytes):
        data = text.removeprefix(b"\xef\xbb\xbf")
        nul = data.find(b"\0")
        if nul >= 0:
            before = data[:nul].decode("utf-8", "replace")
            raise refuse("this is a binary file, not a score; a score is plain text", before)
        try:
            text = data.decode("utf-8")
        except UnicodeDecodeError as error:
            before = data[: error.start].decode("utf-8")
            raise refuse(
                f"byte 0x{data[error.start]:02x} is not UTF-8 text; save the score as UTF-8", before
            ) from None
    text = text.removeprefix("\ufeff")
    for match in re.finditer(r"[^\t\n\r\x20-\x7e]", text):
        if unicodedata.category(match[0]) in ("Cc", "Cs"):
            raise refuse(
                f"character U+{ord(match[0]):04X} has no place in a score; a score is plain text",
                text[: match.start()],
            )
    clean = text.replace("\r\n", "\n").replace("\r", "\n")
    if not clean.strip():
        raise ScoreError("the score is empty; start it with the line 'benesh 1'", 1, 1, source)
    for index, line in enumerate(clean.split("\n"), 1):
        if len(line) > MAX_LINE:
            raise ScoreError(
                f"the line is too long; a line has at most {MAX_LINE} characters",
                index,
                MAX_LINE + 1,
                source,
            )
    return clean if clean.endswith("\n") else clean + "\n"


def _syntax_error(error: UnexpectedInput, text: str, source: str | None) -> ScoreError:
    """What the grammar expected, in a dancer's words."""
    lines = text.split("\n")
    if isinstance(error, UnexpectedCharacters):
        expected, line, column = set(error.allowed or ()), error.line, error.column
    elif isinstance(error, UnexpectedToken) and error.token.type != "$END":
        expected, line, column = set(error.expected), error.line, error.column
    else:
        expected = set(error.expected) if isinstance(error, UnexpectedToken) else {"$END"}
        line, column = max(1, len(lines) - 1), 1
    rest = lines[line - 1][column - 1 :] if line <= len(lines) else ""
    skipped = len(rest) - len(rest.lstrip(" \t\u00a0"))
    if rest[skipped:] and not rest[skipped:].startswith("#"):
        rest, column = rest[skipped:], column + skipped
    else:
        rest = ""
    if "_BENESH" in expected:
        return ScoreError("a score starts with the line 'benesh 1'", line, column, source)
    word = re.match(r"[^\s,:#]+|.", rest)
    found = f"'{word[0][:40]}'" if word else describe_end(line >= len(lines))
    message = f"expected {either(phrase(expected))}, but found {found}"
    hint = suggest(word[0], expected) if word else None
    return ScoreError(message + (f"; did you mean '{hint}'?" if hint else ""), line, column, source)
