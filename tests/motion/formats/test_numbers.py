"""Numbers in blocks are what `float` makes of each."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from enpointe.errors import FormatError
from enpointe.motion.formats.numbers import BLOCK, blocks, parsed, tokens
from enpointe.motion.formats.text import number_block

DIGITS = st.text("0123456789", max_size=10)
SHORT = st.builds(
    lambda sign, whole, point, part: sign + (whole + point + part or "0"),
    st.sampled_from(["", "-", "+"]),
    DIGITS,
    st.sampled_from(["", "."]),
    DIGITS,
).filter(lambda word: any(letter.isdigit() for letter in word))
NUMBERS = SHORT | st.floats(allow_nan=False, allow_infinity=False).map(repr)
BLANKS = st.sampled_from([" ", "  ", "\t", "\n", "\r\n", " \n "])


@given(st.lists(st.tuples(NUMBERS, BLANKS), min_size=1, max_size=40))
def test_as_float_reads_them(pairs: list[tuple[str, str]]) -> None:
    """Every digit, the sign of zero, exponents and numbers longer than a word."""
    block = "".join(word + blank for word, blank in pairs).encode()
    values, bad = parsed(tokens(block))
    expected = np.array([float(word) for word, _ in pairs])
    assert bad is None
    assert np.array_equal(values, expected)
    assert np.array_equal(np.signbit(values), np.signbit(expected))


@given(
    st.lists(NUMBERS, max_size=8),
    st.sampled_from(["nan", "inf", "1_0", "abc", "1e999", "--1", ".", "-", "1.2.3", "0x1", "1e"]),
    st.lists(NUMBERS, max_size=8),
)
def test_the_first_that_is_none_is_told(before: list[str], wrong: str, after: list[str]) -> None:
    """Its place among the words."""
    _, bad = parsed(tokens(" ".join([*before, wrong, *after]).encode()))
    assert bad == len(before)


@given(st.binary(max_size=60))
def test_noise_is_never_a_number(noise: bytes) -> None:
    """Words are numbers only where `float` says so too."""
    words = tokens(noise)
    values, bad = parsed(words)
    for index in range(len(words.starts) if bad is None else bad):
        assert float(words.text(index)) == values[index]


def test_blocks_are_cut_behind_line_ends() -> None:
    """Together they are the whole, and none ends within a line."""
    data = b"".join(b"%d %d\n" % (i, i * i) for i in range(60_000)) + b"1 2"
    pieces = list(blocks(data))
    assert b"".join(pieces) == data
    assert len(pieces) > 2
    assert all(piece.endswith(b"\n") for piece in pieces[:-1])
    assert all(len(piece) < BLOCK + 100 for piece in pieces)


@pytest.mark.parametrize("line", [1, 20_000, 59_999, 60_000])
@pytest.mark.parametrize("wrong", [b"1 2", b"1 2 3 4", b"1 nan 3", b"1 2 x"])
def test_a_wrong_row_is_told_by_its_line(line: int, wrong: bytes) -> None:
    """Also in the blocks behind the first, whatever the line ends."""
    rows = [b"%d 0.5 -3" % i for i in range(60_000)]
    rows[line - 1] = wrong
    with pytest.raises(FormatError) as refusal:
        number_block(b"\r\n".join(rows), 3, Path("a"), 1, "a frame")
    assert refusal.value.line == line


def test_merge_marks_are_named() -> None:
    """Version control's marks are worth a sentence of their own."""
    with pytest.raises(FormatError, match="merge") as refusal:
        number_block(b"1 2\n<<<<<<< HEAD\n3 4\n", 2, Path("a"), 7, "a frame")
    assert refusal.value.line == 8
