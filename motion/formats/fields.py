"""Fast reading of tables whose columns are parted by tabs or commas, gaps and all.

The positions of all separators in a block of bytes tell in which row and column each word stands,
so that the words are parsed together and gaps cost nothing.
"""

from __future__ import annotations

import io
import warnings
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from enpointe.motion.formats.numbers import Tokens, blocks, parsed, tokens

__all__ = ["Fields", "even_table", "fields_table", "loaded_table"]

Array = NDArray[np.float64]
_NEWLINE = 10
_ZERO = 48
_LOWER = 32


@dataclass(frozen=True, slots=True)
class Fields:
    """What a table holds.

    Attributes:
        table: (rows, width), NaN for gaps.
        longer: Rows with words beyond the width, which are left out.
        shorter: Rows that end before the width.
        warnings: What is doubtful about the end of the file.
    """

    table: Array
    longer: int
    shorter: int
    warnings: tuple[str, ...] = ()


def fields_table(data: bytes, start: int, width: int, delimiter: str, needed: int) -> Fields | None:
    r"""The rest of a file as a table, or None where a slower reader has to tell what is wrong.

    Args:
        data: The file, lines ending with \n; lines of blanks are passed over.
        start: Where the table starts.
        width: Columns.
        delimiter: Between columns, one character.
        needed: Columns at the start that every row has to have.
    """
    even = even_table(data, start, width, delimiter)
    if even is not None:
        return None if np.isnan(even[:, :needed]).any() else Fields(even, 0, 0)
    parts = []
    for block in blocks(data, start):
        part = _block(tokens(block), width, ord(delimiter), needed)
        if part is None:
            return None
        parts.append(part)
    if not parts:
        return Fields(np.empty((0, width)), 0, 0)
    return Fields(
        np.concatenate([part.table for part in parts]),
        sum(part.longer for part in parts),
        sum(part.shorter for part in parts),
    )


def even_table(data: bytes, start: int, width: int, delimiter: str | None) -> Array | None:
    r"""The rest of a file whose lines all have every column, or None where it is no such file.

    Args:
        data: The file, lines ending with \n.
        start: Where the table starts.
        width: Columns.
        delimiter: Between columns, with nothing between two of them for a gap; None for any
            blanks, which leave no gaps.

    Returns:
        (rows, width), NaN for gaps.
    """
    file = io.BytesIO(data)
    file.seek(start)
    table = loaded_table(file, width, delimiter)
    if table is None and delimiter is not None:
        table = _filled(data, start, width, delimiter)
    return None if table is None or np.isinf(table).any() else table


def _filled(data: bytes, start: int, width: int, delimiter: str) -> Array | None:
    """Lines with nothing between some separators, read with zeros there, block by block."""
    parts = []
    for block in blocks(data, start):
        codes = np.frombuffer(block.strip(b"\n") + b"\n", np.uint8)
        ends = np.flatnonzero((codes == _NEWLINE) | (codes == ord(delimiter)))
        gaps = np.diff(ends, prepend=-1) == 1
        filled = np.insert(codes, ends[gaps], _ZERO)
        part = loaded_table(io.BytesIO(filled.tobytes()), width, delimiter)
        if part is None or part.size != len(gaps):
            return None
        part.ravel()[gaps] = np.nan
        parts.append(part)
    return np.concatenate(parts) if parts else None


def loaded_table(file: io.BytesIO, width: int, delimiter: str | None) -> Array | None:
    """Lines of `width` numbers, nan and infinities too; None where they are not that."""
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            table: Array = np.loadtxt(
                file, delimiter=delimiter, comments=None, ndmin=2, encoding="latin-1"
            )
    except (ValueError, OverflowError, UserWarning):
        return None
    return table if table.shape[1] == width else None


def _block(words: Tokens, width: int, delimiter: int, needed: int) -> Fields | None:
    marks = words.data == delimiter
    if delimiter > _LOWER:
        words = _parted(words, marks)
    counts = words.per_line()
    return _with_gaps(words, marks, counts, width, needed)


def _parted(words: Tokens, marks: NDArray[np.bool_]) -> Tokens:
    """Words of a block in which the separators are blanks as well."""
    data = words.data.copy()
    data[marks] = _LOWER
    return tokens(data[8:-8].tobytes())


def _with_gaps(
    words: Tokens,
    marks: NDArray[np.bool_],
    counts: NDArray[np.intp],
    width: int,
    needed: int,
) -> Fields | None:
    before = np.cumsum(marks, dtype=np.int32)
    ends = np.append(np.flatnonzero(words.data == _NEWLINE), len(marks) - 1)
    upto = before[ends]
    from_start = np.append(0, upto[:-1])
    column = before[words.starts] - np.repeat(from_start, counts)
    row = np.repeat(np.cumsum(counts > 0) - 1, counts)
    place = row * np.int64(width) + column
    inside = column < width
    beyond = np.unique(row[~inside])
    if (np.diff(place[inside]) == 0).any():
        return None
    chosen = inside & ~_not_numbers(words)
    values, bad = parsed(words, chosen)
    if bad is not None:
        return None
    table = np.full((int(np.count_nonzero(counts)), width), np.nan)
    table.ravel()[place[chosen]] = values
    if np.isnan(table[:, :needed]).any():
        return None
    short = (upto - from_start < width - 1) & (counts > 0)
    return Fields(table, len(beyond), int(np.count_nonzero(short)))


def _not_numbers(words: Tokens) -> NDArray[np.bool_]:
    """Which words are nan, however spelt."""
    starts = words.starts
    found: NDArray[np.bool_] = words.ends - starts == 3
    for offset, letter in enumerate(b"nan"):
        found &= words.data[starts + offset] | _LOWER == letter
    return found
