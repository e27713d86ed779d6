"""Marker movements for the tests: made by hand, by hypothesis, and mutants of their files."""

from __future__ import annotations

import random
import re
from collections.abc import Callable

import numpy as np
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp

from enpointe.motion.formats import Analog, Label, MarkerMotion, Space

NAMES = ("C7", "L.Heel", "head top", "RTOE")


def marker_motion(frames: int = 7, *, gaps: bool = False, rich: bool = False) -> MarkerMotion:
    """A figure of four markers, about 1.7 m tall, in millimetres with z up."""
    rng = np.random.default_rng(3)
    heights = np.array([1450.0, 30.0, 1720.0, 20.0])
    positions = rng.normal(0.0, 90.0, (frames, len(NAMES), 3)).astype(np.float32).astype(float)
    positions[..., 2] = (heights + rng.normal(0.0, 2.0, (frames, 4))).astype(np.float32)
    if gaps:
        positions[1, 2] = positions[2, :2] = positions[-1, -1] = np.nan
    seen = np.isfinite(positions).all(axis=2)
    shape = positions.shape[:2]
    residuals = rng.integers(0, 255, shape).astype(np.float32) * np.float32(0.125)
    analog = Analog(
        ("Fz", "EMG"), ("N", "V"), 300.0, rng.normal(size=(3 * frames, 2)).astype(np.float32)
    )
    return MarkerMotion(
        NAMES,
        100.0,
        positions,
        Space(0.001, "z"),
        start=11,
        residuals=np.where(seen, residuals, np.nan).astype(np.float32) if rich else None,
        cameras=np.where(seen, rng.integers(0, 128, shape), 0).astype(np.uint8) if rich else None,
        analog=analog if rich else None,
        labels=(Label(0.25, "Foot Strike", "anna", "Left"), Label(61.5, "Foot Off", "", "Right"))
        if rich
        else (),
        notes={"SUBJECTS:NAMES": '["anna", "bo"]', "SUBJECTS:AGES": "[7, 8]"} if rich else {},
    )


@st.composite
def marker_motions(draw: st.DrawFn) -> MarkerMotion:
    """Any movement of up to four markers and five frames, any finite numbers, some gaps."""
    frames, markers = draw(st.integers(1, 5)), draw(st.integers(1, 4))
    finite = st.floats(-1e6, 1e6, width=64)
    positions = draw(hnp.arrays(float, (frames, markers, 3), elements=finite))
    gaps = draw(hnp.arrays(bool, (frames, markers)))
    positions[gaps] = np.nan
    words = st.text("abcXYZ019_.-:é", min_size=1, max_size=8)
    names = draw(st.lists(words, min_size=markers, max_size=markers))
    space = Space(draw(st.sampled_from([0.001, 0.01, 1.0, 0.0254])), draw(st.sampled_from("xyz")))
    rate = draw(st.sampled_from([25.0, 30.0, 119.88, 120.0, 1000.0, 59.94]))
    return MarkerMotion(tuple(names), rate, positions, space, start=draw(st.integers(0, 70000)))


SCRAPS = (
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


def _flip(raw: bytes, dice: random.Random) -> bytes:
    if not raw:
        return raw
    at = dice.randrange(len(raw))
    return raw[:at] + bytes([dice.randrange(256)]) + raw[at + 1 :]


def _cut(raw: bytes, dice: random.Random) -> bytes:
    return raw[: dice.randint(0, len(raw))]


def _remove(raw: bytes, dice: random.Random) -> bytes:
    at = dice.randint(0, len(raw))
    return raw[:at] + raw[at + dice.choice([1, 2, 4, 20, 512]) :]


def _double(raw: bytes, dice: random.Random) -> bytes:
    at = dice.randint(0, len(raw))
    return raw[:at] + raw[at : at + dice.choice([1, 4, 100, 512])] + raw[at:]


def _lines(raw: bytes, dice: random.Random) -> bytes:
    lines = raw.split(b"\n")
    one, other = dice.randrange(len(lines)), dice.randrange(len(lines))
    way = dice.randrange(4)
    if way == 0:
        del lines[one]
    elif way == 1:
        lines.insert(other, lines[one])
    elif way == 2:
        lines[one], lines[other] = lines[other], lines[one]
    else:
        lines[one] = b"\t".join(lines[one].split()[: dice.randint(0, 9)])
    return b"\n".join(lines)


def _number(raw: bytes, dice: random.Random) -> bytes:
    # The counts stand in the first lines, so these are spoiled more often.
    head = raw[: dice.choice([200, 600, len(raw)])]
    found = list(_NUMBER.finditer(head))
    if not found:
        return raw
    place = dice.choice(found)
    scrap = dice.choice(SCRAPS).encode()
    return raw[: place.start()] + scrap + raw[place.end() :]


def _insert(raw: bytes, dice: random.Random) -> bytes:
    at = dice.randint(0, len(raw))
    return raw[:at] + dice.choice(SCRAPS).encode() + raw[at:]


def _word(raw: bytes, dice: random.Random) -> bytes:
    if len(raw) < 4:
        return raw
    at = dice.randrange(min(len(raw) - 3, dice.choice([24, 512, 2048, 1 << 20])))
    word = dice.choice([b"\xff\xff", b"\0\0", b"\x01\0", b"\xff\x7f", b"\0\x80", b"\0\0\x80\x7f"])
    return raw[:at] + word + raw[at + len(word) :]


_Way = Callable[[bytes, random.Random], bytes]
_TEXT_WAYS: tuple[_Way, ...] = (
    _flip,
    _cut,
    _remove,
    _double,
    _lines,
    _lines,
    _number,
    _number,
    _insert,
)
_BINARY_WAYS: tuple[_Way, ...] = (_flip, _flip, _cut, _remove, _double, _word, _word, _word)
