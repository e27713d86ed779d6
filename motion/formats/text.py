"""Reading text files that anybody may have written."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from enpointe.errors import FormatError

__all__ = ["finite_number", "number_table", "read_text", "whole_number"]

_LARGEST_COUNT = 10**9


def read_text(path: Path) -> str:
    r"""A file's text, line ends as \n, a byte order mark left out; Latin-1 where it is no UTF-8.

    Raises:
        FormatError: No such file, empty, or binary.
    """
    try:
        raw = path.read_bytes()
    except OSError as error:
        raise FormatError(f"can't be read ({error.strerror or error})", path) from None
    if not raw.strip():
        raise FormatError("the file is empty", path, line=1)
    nul = raw.find(b"\0")
    if nul >= 0:
        raise FormatError("a binary file where text was expected", path, byte=nul)
    try:
        text = raw.decode("utf-8-sig")
    except UnicodeDecodeError:
        text = raw.decode("latin-1")
    return text.replace("\r\n", "\n").replace("\r", "\n")


def finite_number(token: str, path: Path, line: int, what: str) -> float:
    """A number out of a file.

    Raises:
        FormatError: No number, or not a finite one.
    """
    try:
        value = float(token)
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
    try:
        table = np.fromstring(" ".join(rows), sep=" ")
        counted = [len(row.split()) for row in rows]
    except (ValueError, DeprecationWarning):
        table, counted = np.empty(0), []
    whole = bool(counted) and all(n in (0, width) for n in counted)
    if whole and table.size == sum(counted) and np.isfinite(table).all():
        return table.reshape(-1, width)
    return _slow_table(rows, width, path, first_line, what)


def _slow_table(
    rows: list[str], width: int, path: Path, first_line: int, what: str
) -> NDArray[np.float64]:
    kept = []
    for line, row in enumerate(rows, start=first_line):
        tokens = row.split()
        if not tokens:
            continue
        if len(tokens) != width:
            raise FormatError(f"{what} needs {width} numbers, got {len(tokens)}", path, line=line)
        kept.append([finite_number(token, path, line, what) for token in tokens])
    return np.array(kept, dtype=float).reshape(-1, width)
