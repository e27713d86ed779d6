"""Files that something happened to."""

from __future__ import annotations

import random
import re
from collections.abc import Callable

_Way = Callable[[bytes, random.Random], bytes]
_SCRAPS = [
    *(b"nan inf -inf 1e999 1e-999 -0 0x10 1_0 .5 5. + - . e 1e 99999999999999999999".split()),
    *(b"{ } ( ) [ ] [x] : = # ; < <<<<<<< ======= \" ' , \t \n \r \r\n".split(b" ")),
    *(b"HIERARCHY|MOTION|ROOT a|JOINT b|End Site|OFFSET 0 0 0|Frames:|begin|end".split(b"|")),
    *("é".encode(), b"\xff", b"\x00", b"\x1a", b"\xc2\xa0", b"", b" ", b"1", b"1000000000"),
]


def mutant(raw: bytes, dice: random.Random) -> bytes:
    """One to three accidents: bytes, lines, words or counts changed, or the end cut off."""
    for _ in range(dice.choice([1, 1, 1, 2, 3])):
        raw = dice.choice(_ACCIDENTS)(raw, dice)
    return raw


def _flip(raw: bytes, dice: random.Random) -> bytes:
    if not raw:
        return raw
    place = dice.randrange(len(raw))
    return raw[:place] + bytes([dice.randrange(256)]) + raw[place + 1 :]


def _splice(raw: bytes, dice: random.Random) -> bytes:
    start = dice.randint(0, len(raw))
    stop = min(len(raw), start + dice.choice([0, 0, 1, 2, 8, 60]))
    return raw[:start] + dice.choice(_SCRAPS) + raw[stop:]


def _cut(raw: bytes, dice: random.Random) -> bytes:
    return raw[: dice.randint(0, len(raw))]


def _lines(raw: bytes, dice: random.Random) -> bytes:
    lines = raw.split(b"\n")
    place, other = dice.randrange(len(lines)), dice.randrange(len(lines))
    if not _moved(lines, place, other, dice.randrange(4)):
        del lines[min(place, other) : max(place, other)]
    return b"\n".join(lines)


def _moved(lines: list[bytes], place: int, other: int, way: int) -> bool:
    """Whether a line was left out, doubled or exchanged with another; the last way does nothing."""
    if way == 0:
        del lines[place]
    elif way == 1:
        lines.insert(other, lines[place])
    elif way == 2:
        lines[place], lines[other] = lines[other], lines[place]
    return way < 3


def _word(raw: bytes, dice: random.Random) -> bytes:
    """A word of some line is another scrap, a word of the file, or ten times what it was."""
    lines = raw.split(b"\n")
    place = dice.randrange(len(lines))
    words = lines[place].split()
    if not words:
        return raw
    which = dice.randrange(len(words))
    others = lines[dice.randrange(len(lines))].split() or [b""]
    words[which] = dice.choice([dice.choice(_SCRAPS), words[which] + b"0", dice.choice(others)])
    lines[place] = b" ".join(words)
    return b"\n".join(lines)


_ACCIDENTS: tuple[_Way, ...] = (
    *(_flip, _splice, _splice, _cut),
    *(_lines, _lines, _word, _word, _word),
)


_COLUMN_SCRAPS = (
    *("nan", "inf", "-inf", "1e999", "-1", "0", "1e-400", "99999999999", "2147483648", "1_0"),
    *("", " ", "\t", "\t\t", "x", "0x10", "1,5", "1.2.3", "12-3", "\u0663", "--", "\x0b", "\x85"),
    *('"', "#", "$", "{", "[" * 40, "DROPOUT", "P", "Q", "<", "&a;", "\0", "\ufeff", "65535"),
)
_NUMBER = re.compile(rb"-?\d[\d.eE+-]*")


def text_mutant(raw: bytes, dice: random.Random) -> bytes:
    """A text file with some of its lines, numbers or bytes spoiled."""
    for _ in range(dice.randint(1, 4)):
        raw = dice.choice(_TEXT_WAYS)(raw, dice)
    return raw


def binary_mutant(raw: bytes, dice: random.Random) -> bytes:
    """A binary file with some of its bytes or counts spoiled, most of them in its first part."""
    for _ in range(dice.randint(1, 4)):
        raw = dice.choice(_BINARY_WAYS)(raw, dice)
    return raw


def _remove(raw: bytes, dice: random.Random) -> bytes:
    at = dice.randint(0, len(raw))
    return raw[:at] + raw[at + dice.choice([1, 2, 4, 20, 512]) :]


def _double(raw: bytes, dice: random.Random) -> bytes:
    at = dice.randint(0, len(raw))
    return raw[:at] + raw[at : at + dice.choice([1, 4, 100, 512])] + raw[at:]


def _rows(raw: bytes, dice: random.Random) -> bytes:
    lines = raw.split(b"\n")
    one, other = dice.randrange(len(lines)), dice.randrange(len(lines))
    if not _moved(lines, one, other, dice.randrange(4)):
        lines[one] = b"\t".join(lines[one].split()[: dice.randint(0, 9)])
    return b"\n".join(lines)


def _number(raw: bytes, dice: random.Random) -> bytes:
    # The counts stand in the first lines, so these are spoiled more often.
    head = raw[: dice.choice([200, 600, len(raw)])]
    found = list(_NUMBER.finditer(head))
    if not found:
        return raw
    place = dice.choice(found)
    scrap = dice.choice(_COLUMN_SCRAPS).encode()
    return raw[: place.start()] + scrap + raw[place.end() :]


def _insert(raw: bytes, dice: random.Random) -> bytes:
    at = dice.randint(0, len(raw))
    return raw[:at] + dice.choice(_COLUMN_SCRAPS).encode() + raw[at:]


def _bits(raw: bytes, dice: random.Random) -> bytes:
    if len(raw) < 4:
        return raw
    at = dice.randrange(min(len(raw) - 3, dice.choice([24, 512, 2048, 1 << 20])))
    word = dice.choice([b"\xff\xff", b"\0\0", b"\x01\0", b"\xff\x7f", b"\0\x80", b"\0\0\x80\x7f"])
    return raw[:at] + word + raw[at + len(word) :]


_TEXT_WAYS: tuple[_Way, ...] = (
    _flip,
    _cut,
    _remove,
    _double,
    _rows,
    _rows,
    _number,
    _number,
    _insert,
)
_BINARY_WAYS: tuple[_Way, ...] = (_flip, _flip, _cut, _remove, _double, _bits, _bits, _bits)
