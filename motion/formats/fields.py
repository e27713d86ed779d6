"""Fast reading of tables whose columns are parted by tabs or commas, gaps and all.

The positions of all separators in a block of bytes tell in which row and column each word stands,
so that the words are parsed together and gaps cost nothing.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from enpointe.motion.formats.numbers import Tokens, blocks, parsed, tokens

__all__ = ["Fields", "fields_table"]

Array = NDArray[np.float64]
_NEWLINE = 10
_LOWER = 32


@dataclass(frozen=True, slots=True)
class Fields:
    """What a table holds.

    Attributes:
        table: (rows, width), NaN for gaps.
        longer: Rows with words beyond the width, which are left out.
        shorter: Rows that end before the width.
    """

    table: Array
    longer: int
    shorter: int


def fields_table(data: bytes, start: int, width: int, delimiter: str, needed: int) -> Fields | None:
    r"""The rest of a file as a table, or None where a slower reader has to tell what is wrong.

    Args:
        data: The file, lines ending with \n; lines of blanks are passed over.
        start: Where the table starts.
        width: Columns.
        delimiter: Between columns, one character.
        needed: Columns at the start that every row has to have.
    """
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


def _block(words: Tokens, width: int, delimiter: int, needed: int) -> Fields | None:
    marks = words.data == delimiter
    if delimiter > _LOWER:
        words = _parted(words, marks)
    counts = words.per_line()
    rows = int(np.count_nonzero(counts))
    whole = ((counts == width) | (counts == 0)).all()
    if whole and np.count_nonzero(marks) == rows * (width - 1):
        values, bad = parsed(words)
        if bad is None:
            return Fields(values.reshape(rows, width), 0, 0)
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
