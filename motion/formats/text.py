"""Reading text files that anybody may have written."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from enpointe.errors import FormatError
from enpointe.motion.formats.numbers import blocks, parsed, tokens

__all__ = [
    "CUT",
    "decoded",
    "finite_number",
    "number_block",
    "number_table",
    "read_raw",
    "read_text",
    "refuse_merge_marks",
    "whole_number",
]

CUT = "the file ends within a line: its last number may be cut short"
"""The warning about text without a line end, in which nothing else shows a cut."""

_LARGEST_COUNT = 10**9
_MERGE_MARKS = ("<<<<<<<", "=======", ">>>>>>>")


def read_raw(path: Path) -> bytes:
    """A text file's bytes as they are.

    Raises:
        FormatError: No such file, empty, or binary.
    """
    try:
        raw = path.read_bytes()
    except OSError as error:
        raise FormatError(f"can't be read ({error.strerror or error})", path) from None
    except ValueError:
        raise FormatError("can't be read (no file can have that name)", path) from None
    if not raw[:1000].strip() and not raw.strip():
        raise FormatError("the file is empty", path, line=1)
    nul = raw.find(b"\0")
    if nul >= 0:
        raise FormatError("a binary file where text was expected", path, byte=nul)
    return raw


def decoded(raw: bytes) -> str:
    r"""Text, line ends as \n, a byte order mark left out; Latin-1 where it is no UTF-8."""
    try:
        text = raw.decode("utf-8-sig")
    except UnicodeDecodeError:
        text = raw.decode("latin-1")
    return text.replace("\r\n", "\n").replace("\r", "\n")


def read_text(path: Path) -> str:
    r"""A file's text, line ends as \n, a byte order mark left out; Latin-1 where it is no UTF-8.

    Raises:
        FormatError: No such file, empty, or binary.
    """
    return decoded(read_raw(path))


def finite_number(token: str, path: Path, line: int, what: str) -> float:
    """A number out of a file.

    Raises:
        FormatError: No number, or not a finite one.
    """
    try:
        value = float(token.replace("_", "?"))
    except ValueError:
        raise FormatError(f"{what} must be a number, got {token[:40]!r}", path, line=line) from None
    if not np.isfinite(value):
        raise FormatError(f"{what} must be a finite number, got {token!r}", path, line=line)
    return value


def whole_number(token: str, path: Path, line: int, what: str) -> int:
    """A count out of a file, 0 to a thousand million.

    Raises:
        FormatError: Anything else.
    """
    value = finite_number(token, path, line, what)
    if value != int(value) or not 0 <= value <= _LARGEST_COUNT:
        raise FormatError(
            f"{what} must be a whole number from 0, got {token[:40]!r}", path, line=line
        )
    return int(value)


def number_table(
    rows: list[str], width: int, path: Path, first_line: int, what: str
) -> NDArray[np.float64]:
    """Rows of `width` numbers between blanks, fast where they are well made.

    Args:
        rows: Text of the rows; blank ones are passed over.
        width: Numbers in a row.
        path: The file, for messages.
        first_line: Line of the first row in the file, from 1.
        what: What a row is, for messages.

    Returns:
        (rows, width).

    Raises:
        FormatError: A row with more or fewer, or with something that is no finite number; with
            its line.
    """
    return number_block("\n".join(rows).encode(), width, path, first_line, what)


def number_block(
    data: bytes,
    width: int,
    path: Path,
    first_line: int,
    what: str,
    start: int = 0,
    *,
    broken: bool = False,
) -> NDArray[np.float64]:
    r"""The numbers that fill the rest of a file, `width` on each line.

    Args:
        data: The bytes; lines end with \n, lines of blanks are passed over.
        width: Numbers on a line.
        path: The file, for messages.
        first_line: Number of the line in the file that starts at `start`.
        what: What a line is, for messages.
        start: Where in `data` they start.
        broken: Whether a line may also hold fewer, so that a row goes over several lines.

    Returns:
        (rows, width).

    Raises:
        FormatError: A line with more or fewer, or with something that is no finite number; with
            the line.
    """
    # Blank lines have no numbers, and a number takes two bytes: never more room than there is text.
    rows = min(data.count(b"\n", start) + 1, (len(data) - start + 1) // (2 * width) + 1)
    table = np.empty(rows * width)
    line, filled = first_line, 0
    for block in blocks(data, start):
        words = tokens(block)
        counts = words.per_line()
        wrong = np.flatnonzero(counts > width if broken else (counts != width) & (counts != 0))
        values, bad = parsed(words)
        if bad is not None and (not len(wrong) or bad < counts[: wrong[0]].sum()):
            row = int(np.searchsorted(np.cumsum(counts), bad, side="right"))
            at = line + row
            refuse_merge_marks(words.text(int(counts[:row].sum())), path, at)
            finite_number(words.text(bad), path, at, f"each value of {what}")
        if len(wrong):
            place = int(counts[: wrong[0]].sum())
            refuse_merge_marks(words.text(place), path, line + int(wrong[0]))
            raise FormatError(
                f"{what} needs {width} numbers, got {counts[wrong[0]]}",
                path,
                line=line + int(wrong[0]),
            )
        table[filled : filled + len(values)] = values
        filled += len(values)
        line += len(counts) - 1
    if filled % width:
        raise FormatError(f"the last {what[2:]} is not whole", path, line=line)
    return table[:filled].reshape(-1, width)


def refuse_merge_marks(word: str, path: Path, line: int) -> None:
    """Says so where version control left two versions in a file.

    Raises:
        FormatError: The first word of the line is such a mark.
    """
    if word.startswith(_MERGE_MARKS):
        raise FormatError(
            f"a merge left its mark {word[:7]!r}; choose one of the two versions", path, line=line
        )
