"""Tables of numbers in text, with gaps where something was not seen."""

from __future__ import annotations

import warnings
from collections.abc import Iterable, Iterator
from dataclasses import replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from enpointe.errors import FormatError
from enpointe.motion.formats.fields import Fields, fields_table
from enpointe.motion.formats.numbers import blocks
from enpointe.motion.formats.text import CUT, decoded

__all__ = [
    "MISSING",
    "MOST_MARKERS",
    "column_table",
    "delimited_rows",
    "line_blocks",
    "lines_table",
    "number_text",
    "plain_lines",
    "settle_gaps",
]

Array = NDArray[np.float64]
MOST_MARKERS = 100_000
"""More than any system follows: a file that has more is no file of markers."""
MISSING = frozenset({"", "nan", "-nan", "+nan", "n/a", "dropout"})


def line_blocks(data: bytes, start: int, first_line: int) -> Iterator[tuple[int, list[str]]]:
    r"""The lines of a file some at a time, since a list of all is several times as large.

    Args:
        data: The file, lines ending with \n.
        start: Where to start.
        first_line: Number in the file of the line there, from 1.

    Yields:
        The number of the first of some lines, and those; one more, which is empty, at their end.
    """
    for block in blocks(data, start):
        lines = decoded(block).split("\n")
        yield first_line, lines
        first_line += len(lines) - 1


def column_table(
    data: bytes,
    width: int,
    path: Path,
    first_line: int,
    what: str,
    *,
    start: int = 0,
    needed: int = 0,
) -> Array:
    r"""The rest of a file, `width` columns on a line, as `lines_table` takes them.

    Args:
        data: The file, lines ending with \n.
        width: Columns in a line.
        path: The file, for messages.
        first_line: Line of the first in the file, from 1.
        what: What a line is, for messages.
        start: Where to start.
        needed: Columns at the start that have to be there.

    Raises:
        FormatError: With the line.
    """
    return np.concatenate(
        [
            np.empty((0, width)),
            *(
                lines_table(lines, width, path, line, what, needed=needed)
                for line, lines in line_blocks(data, start, first_line)
            ),
        ]
    )


def lines_table(
    lines: list[str],
    width: int,
    path: Path,
    first_line: int,
    what: str,
    *,
    delimiter: str | None = None,
    needed: int = 0,
) -> Array:
    """Lines of `width` columns as numbers; a gap becomes NaN.

    A line that ends early has gaps at its end, unless columns are parted by blanks, where a gap
    can't be told from the next column: there every line needs all of them. More columns than
    `width` are an error; so are blanks in the first `needed`, and infinities.

    Args:
        lines: The text; blank lines are passed over.
        width: Columns in a line.
        path: The file, for messages.
        first_line: Line of the first in the file, from 1.
        what: What a line is, for messages.
        delimiter: Between columns; None for any blanks.
        needed: Columns at the start that have to be there.

    Returns:
        (lines that are not blank, width).

    Raises:
        FormatError: With the line.
    """
    filled = lines if delimiter is None else _filled(lines, width, delimiter)
    table = _fast_table(filled, width, delimiter) if any(lines) else np.empty((0, width))
    if table is not None and not np.isinf(table).any() and not np.isnan(table[:, :needed]).any():
        return table
    return _slow_table(lines, width, path, first_line, what, delimiter, needed)


def delimited_rows(
    data: bytes,
    skipped: int,
    width: int,
    delimiter: str | None,
    path: Path,
    what: str,
    *,
    needed: int,
) -> Fields:
    """The rows below a head, quickly where they are well made.

    Words beyond the width are left out and counted where a character parts the columns.

    Args:
        data: The file, as `plain_lines` gives it.
        skipped: Lines of the head.
        width: Columns.
        delimiter: Between columns; None for any blanks.
        path: The file, for messages.
        what: What a row is, for messages.
        needed: Columns at the start that every row has to have.

    Raises:
        FormatError: With the line.
    """
    data, warnings = _whole_lines(data, width, delimiter)
    start = 0
    for _ in range(skipped):
        newline = data.find(b"\n", start)
        start = newline + 1 if newline >= 0 else len(data)
    if delimiter is not None:
        found = fields_table(data, start, width, delimiter, needed)
        if found is not None:
            return replace(found, warnings=warnings)
    longer = shorter = 0
    tables = [np.empty((0, width))]
    for number, lines in line_blocks(data, start, skipped + 1):
        if delimiter is not None:
            longer += _shortened(lines, width, delimiter)
            shorter += sum(line.count(delimiter) < width - 1 for line in lines if line.strip())
        tables.append(
            lines_table(lines, width, path, number, what, delimiter=delimiter, needed=needed)
        )
    return Fields(np.concatenate(tables), longer, shorter, warnings)


def _shortened(lines: list[str], width: int, delimiter: str) -> int:
    """Takes what stands beyond the width out of the lines, and counts those that had some."""
    longer = 0
    for index, line in enumerate(lines):
        if line.count(delimiter) >= width:
            parts = line.split(delimiter, width)
            lines[index] = delimiter.join(parts[:-1])
            longer += bool(parts[-1].strip())
    return longer


def _whole_lines(data: bytes, width: int, delimiter: str | None) -> tuple[bytes, tuple[str, ...]]:
    """The file without a last line that breaks off, and what is doubtful about its end."""
    if data.endswith(b"\n") or not data.rstrip():
        return data, ()
    last = data.rfind(b"\n") + 1
    line = data[last:].strip(b" ")
    columns = line.count(delimiter.encode()) + 1 if delimiter else len(line.split())
    if not line or columns >= width:
        return data, (CUT,) if line else ()
    return data[:last], ("the last row is cut short and left out",)


def plain_lines(raw: bytes) -> bytes:
    r"""Bytes of a text file with \n at the end of each line and no byte order mark."""
    raw = raw.removeprefix(b"\xef\xbb\xbf")
    return raw.replace(b"\r\n", b"\n").replace(b"\r", b"\n") if b"\r" in raw else raw


def settle_gaps(points: Array, shorter: int = 0) -> list[str]:
    """Makes points that lack a coordinate unseen, and says what is doubtful about gaps.

    Args:
        points: (T, M, 3), as read; changed in place.
        shorter: Rows that end early.
    """
    found = []
    if shorter:
        found.append(f"{shorter} rows end early; what they lack is taken as not seen")
    known = np.isfinite(points)
    if known.all():
        return found
    lacking = ~known.all(axis=2)
    partly = int((known.any(axis=2) & lacking).sum())
    if partly:
        found.append(f"{partly} points lack a coordinate and are taken as not seen")
    points[lacking] = np.nan
    return found


def number_text(value: float) -> str:
    """The shortest text that reads back as the same number; "" for NaN."""
    if value != value:  # only NaN differs from itself
        return ""
    text = repr(float(value))
    return text[:-2] if text.endswith(".0") else text


def _filled(lines: list[str], width: int, delimiter: str) -> Iterator[str]:
    """The lines with nan where nothing stands, so that the fast reader can take them."""
    double, gap = delimiter * 2, f"{delimiter}nan"
    for line in lines:
        kept = line.rstrip()
        if not kept:
            continue
        if double in kept:
            kept = kept.replace(double, f"{gap}{delimiter}").replace(double, f"{gap}{delimiter}")
        missing = width - 1 - kept.count(delimiter)
        yield kept + gap * missing if missing else kept


def _fast_table(lines: Iterable[str], width: int, delimiter: str | None) -> Array | None:
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            table: Array = np.loadtxt(lines, delimiter=delimiter, comments=None, ndmin=2)
    except (ValueError, OverflowError, UserWarning):
        return None
    return table if table.shape[1] == width else None


def _slow_table(
    lines: list[str],
    width: int,
    path: Path,
    first_line: int,
    what: str,
    delimiter: str | None,
    needed: int,
) -> Array:
    rows = []
    for number, line in enumerate(lines, start=first_line):
        if not line.strip():
            continue
        fields = line.rstrip().split(delimiter)
        if len(fields) > width or (delimiter is None and len(fields) < width):
            raise FormatError(f"{what} needs {width} columns, got {len(fields)}", path, line=number)
        row = np.full(width, np.nan)
        for column, field in enumerate(fields):
            row[column] = _number(field.strip(), path, number, what, column)
        if np.isnan(row[:needed]).any():
            raise FormatError(f"{what} lacks one of its first {needed} numbers", path, line=number)
        rows.append(row)
    return np.array(rows).reshape(-1, width)


def _number(field: str, path: Path, line: int, what: str, column: int) -> float:
    if field.lower() in MISSING:
        return float("nan")
    try:
        value = float(field)
    except ValueError:
        value = float("inf")
    if not np.isfinite(value):
        raise FormatError(
            f"column {column + 1} of {what} must be a number, got {field[:40]!r}", path, line=line
        )
    return value
