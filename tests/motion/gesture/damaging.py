"""Files with something wrong, made from files with nothing wrong."""

from __future__ import annotations

import struct

import numpy as np

CHUNKS = (b"FORM", b"GST ", b"VERS", b"SCEN", b"UNIT", b"CHAN", b"FRAM", b"MEAS", b"RATE", b"    ")
NASTY = (0, 1, 2, 3, 7, 8, 9, 0x7F, 0xFF, 0xFFFF, 0x7FFFFFFF, 0x80000000, 0xFFFFFFFE, 0xFFFFFFFF)


def chunks_of(data: bytes, mark: str = ">") -> list[bytes]:
    """The chunks in a well-made form, each whole."""
    found, at = [], 12
    while at < len(data):
        (size,) = struct.unpack_from(mark + "I", data, at + 4)
        found.append(data[at : at + 8 + size])
        at += 8 + size
    return found


def form_of(chunks: list[bytes], mark: str = ">") -> bytes:
    """A form of these chunks."""
    content = b"GST " + b"".join(chunks)
    return b"FORM" + struct.pack(mark + "I", len(content)) + content


def mutated(data: bytes, rng: np.random.Generator) -> bytes:
    """One to four things changed, anywhere but mostly where the structure is."""
    broken = bytearray(data)
    head = data.find(b"FRAM") + 9
    for _ in range(rng.integers(1, 5)):
        reach = min(head, len(broken)) if rng.random() < 0.8 else len(broken)
        at = int(rng.integers(0, max(reach, 1)))
        _damage(broken, at, rng)
    return bytes(broken)


def _damage(broken: bytearray, at: int, rng: np.random.Generator) -> None:
    length = int(rng.integers(1, 9))
    match int(rng.integers(0, 9)):
        case 0:
            broken[at : at + 1] = bytes([int(rng.integers(0, 256))])
        case 1:
            broken[at : at + 4] = struct.pack(">I", NASTY[rng.integers(0, len(NASTY))])
        case 2:
            broken[at : at + 2] = struct.pack("<H", NASTY[rng.integers(0, 10)])
        case 3:
            broken[at : at + 8] = rng.bytes(8)
        case 4:
            del broken[at : at + length]
        case 5:
            broken[at:at] = rng.bytes(length)
        case 6:
            del broken[at:]
        case 7:
            broken[at : at + 4] = CHUNKS[rng.integers(0, len(CHUNKS))]
        case _:
            start = int(rng.integers(0, max(len(broken), 1)))
            broken[at:at] = broken[start : start + 4 * length]
