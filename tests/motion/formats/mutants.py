"""Files that something happened to."""

from __future__ import annotations

import random

SCRAPS = [
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
    return raw[:start] + dice.choice(SCRAPS) + raw[stop:]


def _cut(raw: bytes, dice: random.Random) -> bytes:
    return raw[: dice.randint(0, len(raw))]


def _lines(raw: bytes, dice: random.Random) -> bytes:
    lines = raw.split(b"\n")
    place, other = dice.randrange(len(lines)), dice.randrange(len(lines))
    what = dice.randrange(4)
    if what == 0:
        del lines[place]
    elif what == 1:
        lines.insert(other, lines[place])
    elif what == 2:
        lines[place], lines[other] = lines[other], lines[place]
    else:
        del lines[min(place, other) : max(place, other)]
    return b"\n".join(lines)


def _word(raw: bytes, dice: random.Random) -> bytes:
    """A word of some line is another scrap, a word of the file, or ten times what it was."""
    lines = raw.split(b"\n")
    place = dice.randrange(len(lines))
    words = lines[place].split()
    if not words:
        return raw
    which = dice.randrange(len(words))
    others = lines[dice.randrange(len(lines))].split() or [b""]
    words[which] = dice.choice([dice.choice(SCRAPS), words[which] + b"0", dice.choice(others)])
    lines[place] = b" ".join(words)
    return b"\n".join(lines)


_ACCIDENTS = [_flip, _splice, _splice, _cut, _lines, _lines, _word, _word, _word]
