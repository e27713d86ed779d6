"""Reads a score: text to :class:`~enpointe.notation.score.Score`, or a ScoreError with its place.

The grammar (grammar.lark) knows what may follow what. What it lexes loosely on purpose, numbers,
beats, names and header values, is judged here, where an error can say what a dancer should write
instead.
"""

from __future__ import annotations

import functools
import json
import re
import unicodedata
from fractions import Fraction
from importlib import resources

from lark import Lark, Token, Tree
from lark.exceptions import UnexpectedCharacters, UnexpectedInput, UnexpectedToken

from enpointe.errors import ScoreError
from enpointe.notation.frame_builder import FrameBuilder, number
from enpointe.notation.frame import Frame
from enpointe.notation.score import TEMPO_RANGE, Score
from enpointe.notation.signs import Location
from enpointe.notation.wording import describe_end, either, phrase, suggest

__all__ = ["MAX_BYTES", "VERSION", "parse_score"]

VERSION = 1
"""The version of the format that this reads and writes."""

MAX_BYTES = 200_000
"""Largest score that is read; a whole ballet of key poses is smaller."""

MAX_LINE = 1000
MAX_TEXT = 200
MAX_BEAT = 100_000
MAX_DENOMINATOR = 96

_FIELDS = ("title", "method", "metre", "tempo")
_EXAMPLES = {
    "title": "title: Third port de bras",
    "method": "method: Cecchetti",
    "metre": "metre: 4/4",
    "tempo": "tempo: 60",
}
_METRE = re.compile(r"([0-9]{1,2})[ \t]*/[ \t]*([0-9]{1,2})")
_WHOLE = re.compile(r"[0-9]{1,6}(\.[0-9]{1,6})?")
_RATIO = re.compile(r"[0-9]{1,6}/[0-9]{1,6}")


@functools.cache
def _grammar() -> Lark:
    text = resources.files("enpointe.notation").joinpath("grammar.lark").read_text("utf-8")
    return Lark(text, parser="lalr", lexer="contextual", maybe_placeholders=False)


def parse_score(text: str | bytes, source: str | None = None) -> Score:
    """Reads a score from its text.

    Args:
        text: The score; bytes are UTF-8, with or without a byte-order mark. Line ends may be of any
            kind.
        source: The name to give in error messages, such as the file's.

    Returns:
        The score, with the place of everything in the text.

    Raises:
        ScoreError: Anything is wrong with it; nothing else is ever raised.
    """
    clean = _decode(text, source)
    try:
        tree = _grammar().parse(clean)
    except UnexpectedInput as error:
        raise _syntax_error(error, clean, source) from None
    return _Reader(source).score(tree)


def _decode(text: str | bytes, source: str | None) -> str:
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


class _Reader:
    """Walks the parse tree of one score."""

    def __init__(self, source: str | None) -> None:
        self.source = source

    def fail(self, message: str, at: Token | Location) -> ScoreError:
        line, column = at.line or 1, at.column or 1
        return ScoreError(message, line, column, self.source)

    def score(self, tree: Tree[Token]) -> Score:
        nodes = [node for node in tree.children if isinstance(node, Tree)]
        version = self._version(nodes[0])
        fields: dict[str, Token] = {}
        frames: list[Frame] = []
        for node in nodes[1:]:
            if node.data == "field":
                self._field(node, fields)
                continue
            if not frames:
                self._require(fields, _first_token(node))
            frames.append(self._frame(node, frames[-1] if frames else None))
        if not frames:
            last = _first_token(nodes[-1])
            end = Location(last.line or 1, last.column or 1)
            self._require(fields, end)
            raise self.fail(
                "the score has no frames; after the header write 'beat 0:' and its signs", end
            )
        score = Score(
            title=self._text(fields["title"]),
            method=self._text(fields["method"]),
            metre=self._metre(fields["metre"]),
            tempo=self._tempo(fields["tempo"]),
            frames=tuple(frames),
            source=self.source,
            version=version,
        )
        score.resolved()
        return score

    def _version(self, node: Tree[Token]) -> int:
        token = _first_token(node)
        if token != str(VERSION):
            raise self.fail(
                f"version '{token[:20]}' of the format is not known; this reads 'benesh {VERSION}'",
                token,
            )
        return VERSION

    def _field(self, node: Tree[Token], fields: dict[str, Token]) -> None:
        key, value = (token for token in node.children if isinstance(token, Token))
        name = "metre" if key.lower() == "meter" else str(key.lower())
        if name in fields:
            raise self.fail(f"'{name}' is already given on line {fields[name].line}; keep one", key)
        fields[name] = value

    def _require(self, fields: dict[str, Token], at: Token | Location) -> None:
        for name in _FIELDS:
            if name not in fields:
                raise self.fail(
                    f"the header lacks its {name}; "
                    f"add a line such as '{_EXAMPLES[name]}' before the first beat",
                    at,
                )

    def _text(self, token: Token) -> str:
        value = str(token).strip()
        if value.startswith('"'):
            try:
                value = json.loads(value)
            except ValueError:
                raise self.fail(
                    'after a backslash in quotes write only \\" or \\\\', token
                ) from None
        if any(unicodedata.category(char) in ("Cc", "Cs") for char in value):
            raise self.fail("a control character has no place in a title or method", token)
        if not value.strip():
            raise self.fail("a name is missing between the quotes", token)
        if len(value) > MAX_TEXT:
            raise self.fail(f"too long; use at most {MAX_TEXT} characters", token)
        return value

    def _metre(self, token: Token) -> tuple[int, int]:
        match = _METRE.fullmatch(token.strip())
        if match:
            pulses, unit = int(match[1]), int(match[2])
            if 1 <= pulses <= 32 and unit in (1, 2, 4, 8, 16):
                return pulses, unit
        raise self.fail(
            f"'{token.strip()[:20]}' is not a metre; "
            "write the beats of a bar over 1, 2, 4, 8 or 16, such as 3/4 or 4/4",
            token,
        )

    def _tempo(self, token: Token) -> float:
        slowest, fastest = TEMPO_RANGE
        value = number(token.strip())
        if value is None or not slowest <= value <= fastest:
            raise self.fail(
                f"'{token.strip()[:20]}' is not a tempo; "
                f"write beats a minute, {slowest:g} to {fastest:g}",
                token,
            )
        return value

    def _frame(self, node: Tree[Token], before: Frame | None) -> Frame:
        tokens = node.children
        keyword, when = tokens[0], tokens[1]
        assert isinstance(keyword, Token)
        assert isinstance(when, Token)
        beat = self._beat(when)
        if before is None and beat != 0:
            raise self.fail("the first frame stands at beat 0, the pose to start from", when)
        if before is not None and beat == before.beat:
            raise self.fail(f"beat {when} was already written on line {before.at.line}", when)
        if before is not None and beat < before.beat:
            raise self.fail(
                f"beat {when} comes after a later one on line {before.at.line}; beats go forward",
                when,
            )
        builder = FrameBuilder(self.source)
        for line in tokens[2:]:
            assert isinstance(line, Tree)
            builder.add(line)
        return builder.frame(beat, Location(keyword.line or 1, keyword.column or 1))

    def _beat(self, token: Token) -> Fraction:
        beat = _fraction(str(token))
        if beat is None or beat > MAX_BEAT or beat.denominator > MAX_DENOMINATOR:
            raise self.fail(
                f"'{token[:40]}' is not a beat; write a count such as 2, 1+1/2 or 2+1/3, "
                f"at most {MAX_BEAT} and no finer than 1/{MAX_DENOMINATOR}",
                token,
            )
        return beat


def _fraction(text: str) -> Fraction | None:
    total = Fraction(0)
    for part in text.replace("\t", " ").split("+"):
        part = part.strip()
        whole = _WHOLE.fullmatch(part)
        ratio = _RATIO.fullmatch(part) and int(part.split("/")[1]) > 0
        if not (whole or ratio):
            return None
        total += Fraction(part)
    return total


def _first_token(node: Tree[Token]) -> Token:
    return next(child for child in node.children if isinstance(child, Token))
