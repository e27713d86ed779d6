"""The header and the parameters of a C3D file.

After the C3D User Guide of Motion Lab Systems (c3d.org): blocks of 512 bytes; the first is the
header, and a section of groups and parameters follows, in the number format of one of three
processors: Intel, DEC (VAX floats) or SGI (big-endian).
"""

from __future__ import annotations

import struct
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from math import prod
from pathlib import Path
from typing import Literal

import numpy as np
from numpy.typing import NDArray

__all__ = ["BLOCK", "Encoding", "Header", "Parameters", "Value", "read_header", "read_parameters"]

BLOCK = 512
KEY = 0x50
LARGEST_INTEGER = 32767
_EVENTS, _LABELS_KEPT = 18, 12345
_PROCESSORS = {84: "Intel", 85: "DEC", 86: "SGI"}
_TYPES: dict[int, Literal["text", "byte", "integer", "real"]] = {
    -1: "text",
    1: "byte",
    2: "integer",
    4: "real",
}
Value = tuple[str, ...] | NDArray[np.generic]
"""Strings in the file's order, or numbers with the last index going fastest."""


@dataclass(frozen=True, slots=True)
class Encoding:
    """How a processor writes numbers.

    Attributes:
        name: "Intel", "DEC" or "SGI".
    """

    name: str

    @property
    def order(self) -> Literal["<", ">"]:
        """Byte order, as numpy and struct have it; DEC's is that of its 16-bit words."""
        return ">" if self.name == "SGI" else "<"

    def words(self, raw: bytes | memoryview) -> NDArray[np.int16]:
        """Signed 16-bit integers."""
        return np.frombuffer(raw, dtype=f"{self.order}i2")

    def reals(self, raw: bytes | memoryview) -> NDArray[np.float32]:
        """32-bit floats; a DEC float is an IEEE float times four with its halves exchanged."""
        if self.name != "DEC":
            return np.frombuffer(raw, dtype=f"{self.order}f4")
        halves = np.frombuffer(raw, dtype="<u4")
        ieee = ((halves << np.uint32(16)) | (halves >> np.uint32(16))).view("<f4")
        with np.errstate(all="ignore"):
            quarter: NDArray[np.float32] = ieee * np.float32(0.25)
        return quarter


@dataclass(frozen=True, slots=True)
class Header:
    """The first block.

    Attributes:
        points: Points in a frame.
        analog: Analog numbers in a frame.
        first: Number of the first frame.
        last: Number of the last frame.
        gap: Frames over which points were interpolated.
        scale: Size of an integer coordinate's step; negative where coordinates are floats.
        data_block: First block of the frames, from 1.
        per_frame: Analog samples in a frame.
        rate: Frames per second.
        events: Time (s) and label of each.
        parameter_block: First block of the parameters, from 1.
    """

    points: int
    analog: int
    first: int
    last: int
    gap: int
    scale: float
    data_block: int
    per_frame: int
    rate: float
    events: tuple[tuple[float, str], ...]
    parameter_block: int


@dataclass(frozen=True, slots=True)
class Parameters:
    """All parameters by "GROUP:NAME", what was doubtful, and how many have a description."""

    values: Mapping[str, Value]
    warnings: tuple[str, ...]
    described: int

    def whole(self, name: str) -> int | None:
        """An unsigned number, of 32 bits where two words make it; None where there is none."""
        value = self.values.get(name)
        if value is None or isinstance(value, tuple) or not value.size:
            return None
        flat = value.ravel()
        if flat.dtype.kind == "f":
            number = float(flat[0])
            return int(number) if abs(number) < 2**31 else None
        words = [int(word) & 0xFFFF for word in flat[:2]]
        return words[0] if len(words) < 2 else words[0] + (words[1] << 16)

    def real(self, name: str) -> float | None:
        """A finite number, or None."""
        value = self.values.get(name)
        if value is None or isinstance(value, tuple) or not value.size:
            return None
        number = float(np.asarray(value, dtype=float).ravel()[0])
        return number if np.isfinite(number) else None

    def reals(self, name: str) -> NDArray[np.float64]:
        """All numbers of a parameter in one row; none where there is no such."""
        value = self.values.get(name)
        if value is None or isinstance(value, tuple):
            return np.empty(0)
        return np.asarray(value, dtype=float).ravel()

    def strings(self, name: str) -> tuple[str, ...]:
        """All strings of a parameter, continued in NAME2, NAME3 ... where it has more than 255."""
        found: tuple[str, ...] = ()
        for suffix in ("", *map(str, range(2, 10))):
            value = self.values.get(name + suffix)
            if not isinstance(value, tuple):
                break
            found += value
        return found


def read_header(block: bytes, path: Path, encoding: Encoding) -> Header:
    """The first block.

    Args:
        block: 512 bytes.
        path: The file, for messages.
        encoding: Of its numbers.
    """
    order = encoding.order
    points, analog, first, last, gap = struct.unpack_from(f"{order}5H", block, 2)
    data_block, per_frame = struct.unpack_from(f"{order}2H", block, 16)
    scale, rate = (float(encoding.reals(block[at : at + 4])[0]) for at in (12, 20))
    return Header(
        points,
        analog,
        first,
        last,
        gap,
        scale,
        data_block,
        per_frame,
        rate,
        tuple(_header_events(block, encoding)),
        block[0],
    )


def _header_events(block: bytes, encoding: Encoding) -> Iterator[tuple[float, str]]:
    """Up to 18, where word 150 says that they have labels of four letters."""
    key, count = struct.unpack_from(f"{encoding.order}2H", block, 298)
    if key != _LABELS_KEPT or count > _EVENTS:
        return
    times = encoding.reals(block[304 : 304 + 4 * count])
    for index, time in enumerate(times.tolist()):
        label = _text(block[396 + 4 * index : 400 + 4 * index])
        if np.isfinite(time) and label:
            yield time, label


def read_parameters(section: bytes, start: int, path: Path, encoding: Encoding) -> Parameters:
    """The parameters.

    A broken one ends the reading with a warning, since nothing tells where the next one stands.

    Args:
        section: The parameter blocks.
        start: Where they stand in the file, bytes.
        path: The file, for messages.
        encoding: Of their numbers.
    """
    groups: dict[int, str] = {}
    found: list[tuple[int, str, Value]] = []
    warnings: list[str] = []
    described = 0
    at = 4
    while at + 2 <= len(section):
        length, group = struct.unpack_from("2b", section, at)
        length = abs(length)
        if not length or not group:
            break
        pointer = at + 2 + length
        if pointer + 2 > len(section):
            warnings.append(f"the parameters break off at byte {start + at}")
            break
        name = _text(section[at + 2 : pointer]).upper()
        step = struct.unpack_from(f"{encoding.order}H", section, pointer)[0]
        body = section[pointer + 2 : pointer + step if step else len(section)]
        described += _is_described(body, group)
        if group < 0:
            groups.setdefault(-group, name)
        else:
            value = _value(body, encoding)
            if value is None:
                warnings.append(f"the parameter {name!r} at byte {start + at} can't be read")
            else:
                found.append((group, name, value))
        if not step:
            break
        at = pointer + max(step, 2)
    values: dict[str, Value] = {}
    for group, name, value in found:
        values.setdefault(f"{groups.get(group, f'GROUP{group}')}:{name}", value)
    return Parameters(values, tuple(warnings), described)


def _is_described(body: bytes, group: int) -> bool:
    """Whether words stand behind a group's name or a parameter's data."""
    at = 0
    if group > 0 and len(body) > 1:
        dimensions = body[2 : 2 + body[1]]
        size = abs(struct.unpack_from("b", body)[0]) * prod(dimensions)
        at = 2 + body[1] + size
    return at < len(body) and bool(_text(body[at + 1 : at + 1 + body[at]]))


def _value(body: bytes, encoding: Encoding) -> Value | None:
    if len(body) < 2:
        return None
    kind, count = _TYPES.get(struct.unpack_from("b", body)[0]), body[1]
    dimensions = tuple(body[2 : 2 + count])
    if kind is None or len(dimensions) < count or count > 7:
        return None
    size = prod(dimensions) * {"text": 1, "byte": 1, "integer": 2, "real": 4}[kind]
    raw = body[2 + count : 2 + count + size]
    if len(raw) < size:
        return None
    if kind == "text":
        width = dimensions[0] if dimensions else 1
        return tuple(_text(raw[i : i + width]) for i in range(0, size, max(width, 1)))
    shape = dimensions[::-1]
    if kind == "byte":
        return np.frombuffer(raw, dtype=np.uint8).reshape(shape)
    numbers = encoding.words(raw) if kind == "integer" else encoding.reals(raw)
    return numbers.reshape(shape)


def _text(raw: bytes) -> str:
    try:
        text = raw.decode("utf-8")
    except UnicodeDecodeError:
        text = raw.decode("latin-1")
    return text.replace("\0", " ").strip()


def processor(code: int) -> Encoding | None:
    """The encoding that byte 4 of the parameters names."""
    name = _PROCESSORS.get(code)
    return Encoding(name) if name else None
