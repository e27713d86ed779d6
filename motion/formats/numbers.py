"""Decimal numbers out of bytes, many at once and rounded as `float` rounds them.

Numbers of motion files are short decimals: a sign, at most eight digits, a point, at most eight
more. Such a number is one or two words of eight characters, which become integers in a few
multiplications (D. Lemire, "Number parsing at a gigabyte per second", Software: Practice and
Experience 51(8), 2021, section 3), and their quotient by a power of ten is rounded once, hence
right (W. D. Clinger, "How to read floating point numbers accurately", PLDI 1990). numpy does that
for a block of numbers together. What is no such number, an exponent say, goes through `float`.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

__all__ = ["BLOCK", "Spelled", "Tokens", "blocks", "parsed", "tokens"]

BLOCK = 1 << 16
"""Bytes looked at together: what comes of them still fits a processor's cache."""

_WORD = 8
_PAD = b" " * _WORD
_BLANK, _NEWLINE, _MINUS, _POINT = 32, 10, 45, 46
_ZEROS = np.uint64(0x3030303030303030)
_SIXES = np.uint64(0x0606060606060606)
_HIGH = np.uint64(0xF0F0F0F0F0F0F0F0)
_PAIRS = np.uint64(0x000000FF000000FF)
_HUNDREDS = np.uint64(0x000F424000000064)
_UNITS = np.uint64(0x0000271000000001)
_ONES = np.uint64(0x0101010101010101)
_TOPS = np.uint64(0x8080808080808080)
_POINTS = _ONES * np.uint64(_POINT) ^ _ZEROS
# Times 256 to the power of k, the highest three bits are 7 - k: the bytes behind byte k.
_BEHIND = np.uint64(sum((7 - k) << (61 - 8 * k) for k in range(8)))
_ONE, _SEVEN, _EIGHT, _TEN, _SIXTEEN = map(np.uint64, (1, 7, 8, 10, 16))
_THIRTY_TWO, _SIXTY_ONE, _SIXTY_THREE = map(np.uint64, (32, 61, 63))
# The last n characters of a word, for n of 0 to 8.
_LAST = np.array([0, *(~((1 << (64 - 8 * n)) - 1) & (2**64 - 1) for n in range(1, 9))], np.uint64)
_TENS = 10.0 ** np.arange(_WORD + 1)
_EXACT = 2.0**53


@dataclass(frozen=True)
class Tokens:
    """Where the words between blanks stand in a block of bytes.

    Attributes:
        data: The block, eight blanks before and behind it.
        starts: Where each word starts in `data`.
        ends: Where each ends, the first byte after it.
    """

    data: NDArray[np.uint8]
    starts: NDArray[np.intp]
    ends: NDArray[np.intp]

    def per_line(self) -> NDArray[np.intp]:
        """How many words stand on each line of the block."""
        newlines = np.flatnonzero(self.data == _NEWLINE)
        before = np.searchsorted(self.starts, np.append(newlines, len(self.data)))
        before[1:] -= before[:-1].copy()
        return before

    def text(self, index: int) -> str:
        """One word."""
        return self.data[self.starts[index] : self.ends[index]].tobytes().decode("ascii", "replace")

    def are(self, chosen: NDArray[np.intp], words: Spelled, which: NDArray[np.intp]) -> bool:
        """Whether each chosen word is spelled like the one of `words` that `which` names."""
        starts = self.starts[chosen]
        if not np.array_equal(self.ends[chosen] - starts, words.lengths[which]):
            return False
        at_each = _words_at(self.data)
        for part in range(words.letters.shape[1]):
            here = np.minimum(starts + _WORD * part, len(at_each) - 1)
            same = at_each[here] & words.masks[which, part] == words.letters[which, part]
            if not same.all():
                return False
        return True


@dataclass(frozen=True)
class Spelled:
    """Words as numbers of eight letters each, to be compared many at once.

    Attributes:
        lengths: (N,), letters of each word.
        letters: (N, parts), eight of a word's letters each, the rest 0.
        masks: (N, parts), which of the eight are the word's.
    """

    lengths: NDArray[np.intp]
    letters: NDArray[np.uint64]
    masks: NDArray[np.uint64]

    @classmethod
    def of(cls, words: list[bytes]) -> Spelled:
        """Spells words."""
        parts = 1 + max(map(len, words), default=0) // _WORD
        padded = [word.ljust(parts * _WORD, b"\0") for word in words]
        masks = [(b"\xff" * len(word)).ljust(parts * _WORD, b"\0") for word in words]
        return cls(
            np.array([len(word) for word in words], np.intp),
            np.frombuffer(b"".join(padded), "<u8").reshape(-1, parts),
            np.frombuffer(b"".join(masks), "<u8").reshape(-1, parts),
        )


def blocks(data: bytes, start: int = 0) -> Iterator[bytes]:
    """Cuts bytes behind line ends into pieces of about `BLOCK`, smaller ones of a small file."""
    size = min(BLOCK, max(len(data) // 16, 1 << 14))
    while start < len(data):
        end = len(data)
        if end - start > size:
            newline = data.find(b"\n", start + size)
            end = newline + 1 if newline >= 0 else end
        yield data[start:end]
        start = end


def tokens(block: bytes) -> Tokens:
    """The words of a block; blanks are all bytes up to the space."""
    data = np.frombuffer(_PAD + block + _PAD, np.uint8)
    blank = data <= _BLANK
    edges = np.flatnonzero(blank[1:] != blank[:-1]) + 1
    return Tokens(data, edges[0::2], edges[1::2])


def parsed(
    words: Tokens, chosen: NDArray[np.intp] | NDArray[np.bool_] | slice = slice(None)
) -> tuple[NDArray[np.float64], int | None]:
    """The numbers that some words are.

    Args:
        words: A block's words.
        chosen: Which of them.

    Returns:
        The numbers, and the place among the chosen of the first that is no finite number, or None.
    """
    starts, ends = words.starts[chosen], words.ends[chosen]
    negative = words.data[starts] == _MINUS
    lengths = ends - starts - negative
    short = lengths <= _WORD
    brief = np.count_nonzero(short)
    if 2 * brief > len(starts):
        if brief < len(starts):
            lengths *= short
        values, done = _short(words.data, ends, lengths)
        left = np.flatnonzero(~done)
    else:
        values, left = np.empty(len(starts)), np.arange(len(starts))
    if len(left):
        first = starts[left] + negative[left]
        values[left], done = _long(words.data, first, ends[left])
        left = left[~done]
    # The sign is the highest bit, of a zero too.
    values.view(np.uint64)[...] ^= negative.astype(np.uint64) << _SIXTY_THREE
    if not len(left):
        return values, None
    values[left], bad = _one_by_one(words.data.tobytes(), starts[left], ends[left])
    return values, None if bad is None else int(left[bad])


def _short(
    data: NDArray[np.uint8], ends: NDArray[np.intp], lengths: NDArray[np.intp]
) -> tuple[NDArray[np.float64], NDArray[np.bool_]]:
    """Numbers of at most eight characters with a point, and where they are such numbers."""
    word = _last_characters(data, ends, lengths)
    # The lowest bit that is set stands in the first byte that is a point.
    found = word ^ _POINTS
    below = found - _ONES
    np.invert(found, out=found)
    found &= below
    found &= _TOPS
    np.negative(found, out=below)
    found &= below
    after = found << _ONE
    after -= _ONE
    np.invert(after, out=after)
    after &= word
    found >>= _SEVEN
    word &= found - _ONE
    word <<= _EIGHT
    word |= after
    whole, good = _integers(word)
    good &= found != 0
    good &= lengths > 1
    found *= _BEHIND
    found >>= _SIXTY_ONE
    whole /= _TENS[found.view(np.int64)]
    return whole, good


def _long(
    data: NDArray[np.uint8], starts: NDArray[np.intp], ends: NDArray[np.intp]
) -> tuple[NDArray[np.float64], NDArray[np.bool_]]:
    """Numbers of at most eight digits on each side of a point, or with none; and where they are."""
    points = _points(data, starts, ends)
    whole = points - starts
    part = np.maximum(ends - points - 1, 0)
    fits = (whole <= _WORD) & (part <= _WORD) & (whole + part > 0)
    if not fits.all():
        whole, part = np.where(fits, whole, 0), np.where(fits, part, 0)
    upper, upper_good = _digits(data, points, whole)
    lower, lower_good = _digits(data, ends, part)
    power = _TENS[part]
    values = upper * power
    values += lower
    fits &= upper_good & lower_good & (values < _EXACT)
    values /= power
    return values, fits


def _one_by_one(
    data: bytes, starts: NDArray[np.intp], ends: NDArray[np.intp]
) -> tuple[NDArray[np.float64], int | None]:
    """Words through `float`, and the place of the first that is no finite number."""
    words = [data[start:end] for start, end in zip(starts.tolist(), ends.tolist(), strict=True)]
    values = np.full(len(words), np.nan)
    try:
        values[:] = list(map(float, words))
    except ValueError:
        for index, word in enumerate(words):
            try:
                values[index] = float(word)
            except ValueError:
                break
    if b"_" in data:
        values[[b"_" in word for word in words]] = np.nan
    bad = np.flatnonzero(~np.isfinite(values))
    return values, int(bad[0]) if len(bad) else None


def _points(
    data: NDArray[np.uint8], starts: NDArray[np.intp], ends: NDArray[np.intp]
) -> NDArray[np.intp]:
    """Where each word has its first point; its end where it has none."""
    points = np.flatnonzero(data == _POINT)
    if len(points) == len(starts) and ((points >= starts) & (points < ends)).all():
        return points
    if not len(points):
        return ends
    following = points[np.minimum(np.searchsorted(points, starts), len(points) - 1)]
    return np.where((following >= starts) & (following < ends), following, ends)


def _words_at(data: NDArray[np.uint8]) -> NDArray[np.uint64]:
    """The eight bytes from each byte on, as one number, without a copy."""
    return np.lib.stride_tricks.as_strided(
        data[:_WORD].view("<u8"), (len(data) - _WORD + 1,), (1,), writeable=False
    )


def _digits(
    data: NDArray[np.uint8], ends: NDArray[np.intp], count: NDArray[np.intp]
) -> tuple[NDArray[np.float64], NDArray[np.bool_]]:
    """The integers that the `count` characters before `ends` are, and where they are digits."""
    return _integers(_last_characters(data, ends, count))


def _last_characters(
    data: NDArray[np.uint8], ends: NDArray[np.intp], count: NDArray[np.intp]
) -> NDArray[np.uint64]:
    """The `count` characters before `ends` less the digit 0, behind zeros."""
    word: NDArray[np.uint64] = _words_at(data)[ends - _WORD]
    word ^= _ZEROS
    word &= _LAST[count]
    return word


def _integers(word: NDArray[np.uint64]) -> tuple[NDArray[np.float64], NDArray[np.bool_]]:
    """What eight digits are, and where all of them are digits; each is less the digit 0."""
    high = word + _SIXES
    high |= word
    high &= _HIGH
    good = high == 0
    np.right_shift(word, _EIGHT, out=high)
    pairs = word * _TEN
    pairs += high
    np.bitwise_and(pairs, _PAIRS, out=high)
    high *= _HUNDREDS
    pairs >>= _SIXTEEN
    pairs &= _PAIRS
    pairs *= _UNITS
    pairs += high
    pairs >>= _THIRTY_TWO
    return pairs.view(np.int64).astype(np.float64), good
