"""The chunks of a GST file of version 0.1, as bytes (ENACTIVE D.RD3.3.1 §4.5.4).

A file is one IFF form: FORM with the type "GST ", then VERS, SCEN, for each unit a UNIT and its
CHANs, and the frames. What the document leaves open or misprints is resolved so:

- The frame chunk's id is printed 'FRAME', five letters in a field of four. It is written FRAM, the
  four that fit; a file that has all five is read too.
- "A chunk cannot have an odd number of data bytes": where a name's length makes it odd, a zero byte
  is added to the chunk and counted in its size, so that readers with and without IFF's rule of an
  uncounted pad byte step to the same place. The name's own length stays as it is.
- A name is as many bytes as its length says, UTF-8 without a closing zero.
- "The dimension of every channel" that adds up to a frame is its number of tracks, not its code.
- §4.5.1 lists a 2Dzy, §4.5.4 a 2Dzx in its place; the second is the one with a code.

Version 0.1 has no place for units of measure, for variables but position and force, for three
angles, nor for a second rate. Two chunks of our own, which other readers leave aside as §4.5.2 asks
them to, hold these where a scene has them (see `own_chunks`). In CHAN such a channel is the nearest
that 0.1 has: extensive variables are positions, three angles are three axes.
"""

from __future__ import annotations

import struct
from collections.abc import Sequence
from dataclasses import dataclass

from enpointe.errors import MotionError
from enpointe.motion.gesture.encoding import Encoding
from enpointe.motion.gesture.own_chunks import measures, rates
from enpointe.motion.gesture.scene import Channel, Dimension, Unit, Variable

__all__ = [
    "DIMENSIONS",
    "FILLER",
    "LARGEST",
    "MOST_CHUNKS",
    "VARIABLES",
    "Head",
    "filler",
    "head_of",
]

LARGEST = 2**32 - 1
"""What a ULONG holds; no file is longer."""
MOST_CHUNKS = 65_536
"""In a file: what a reader goes through before it takes a file for nonsense."""
_OTHER_CHUNKS = 16
FILLER = b"    "
DIMENSIONS = {
    1: Dimension.SCALAR,
    2: Dimension.X,
    3: Dimension.Y,
    4: Dimension.Z,
    5: Dimension.XY,
    6: Dimension.YZ,
    7: Dimension.ZX,
    8: Dimension.XYZ,
}
VARIABLES = {0: Variable.POSITION, 1: Variable.FORCE}
_DIMENSION_CODES = {dimension: code for code, dimension in DIMENSIONS.items()} | {Dimension.RQF: 8}


@dataclass(frozen=True, slots=True)
class Head:
    """Everything before the frames, for any number of them.

    Attributes:
        frame_bytes: Of one frame.
        most: Frames that a file has room for.
        before: The bytes, of no frames.
        frame_count_at: Where the scene chunk counts them.
        mark: Byte order.
        block: What the end of the file is aligned to.
    """

    frame_bytes: int
    most: int
    before: bytes
    frame_count_at: int
    mark: str
    block: int

    @property
    def size(self) -> int:
        """Bytes before the first frame."""
        return len(self.before)

    def tail(self, frames: int) -> bytes:
        """What follows the frames to fill the last block; b"" where nothing need be filled."""
        return filler(self.size + frames * self.frame_bytes, self.block, self.mark)

    def encoded(self, frames: int, tail: int = 0) -> bytes:
        """The bytes, where `frames` frames and `tail` more bytes follow."""
        sized = bytearray(self.before)
        data = frames * self.frame_bytes
        ulong = self.mark + "I"
        struct.pack_into(ulong, sized, 4, self.size - 8 + data + tail)
        struct.pack_into(ulong, sized, self.frame_count_at, frames)
        struct.pack_into(ulong, sized, self.size - 4, data)
        return bytes(sized)


def head_of(
    name: str,
    units: Sequence[Unit],
    encoding: Encoding,
    counts: Sequence[int] | None = None,
) -> Head:
    """The head of a file.

    Args:
        name: The scene's.
        units: In the order of their tracks in a frame.
        encoding: How numbers are stored.
        counts: Samples of each unit, where they do not follow from the number of frames.

    Raises:
        MotionError: No units, or more of them than fit into a file.
    """
    if not units:
        raise MotionError("a gesture file needs one unit at least")
    described = len(units) + sum(len(unit.channels) for unit in units)
    if described > MOST_CHUNKS - _OTHER_CHUNKS:
        raise MotionError(f"{described} units and channels; a file holds 65520 together")
    mark = encoding.mark
    frame_bytes = sum(unit.width for unit in units) * encoding.size
    block = min(encoding.block_size or frame_bytes, LARGEST)
    version = _chunk(b"VERS", struct.pack(mark + "HH", 0, 1), mark)
    frequency = max(unit.rate for unit in units)
    scene = _text(name, mark) + struct.pack(
        mark + "IdHdI", 0, frequency, encoding.code, encoding.scale, block
    )
    parts = [b"FORM\0\0\0\0GST ", version, _chunk(b"SCEN", scene, mark)]
    for unit in units:
        parts.append(_chunk(b"UNIT", _text(unit.name, mark), mark))
        parts += [_chunk(b"CHAN", _channel(channel, mark), mark) for channel in unit.channels]
    texts, paces = measures(units), rates(units, frequency, counts, mark)
    if texts:
        parts.append(_chunk(b"MEAS", b"".join(_text(text, mark) for text in texts), mark))
    if paces:
        parts.append(_chunk(b"RATE", paces, mark))
    before = b"".join(parts)
    aligned = encoding.block_size or 1
    before += filler(len(before) + 8, aligned, mark) + b"FRAM\0\0\0\0"
    room = LARGEST - len(before) - 2 * aligned - 8
    if room < 0 or frame_bytes > LARGEST:
        raise MotionError("the units and channels leave no room for frames in a file of 4 GiB")
    counted_at = 12 + len(version) + 10 + len(name.encode("utf-8"))
    return Head(frame_bytes, room // frame_bytes, before, counted_at, mark, aligned)


def filler(position: int, block: int, mark: str) -> bytes:
    """A filler chunk to be put at `position` so that what follows begins at a multiple of `block`.

    Of an even number of bytes, as all chunks are: with an odd block that may be the one after next.
    `position` is even.
    """
    missing = -position % block
    if missing == 0:
        return b""
    while missing < 8 or missing % 2:
        missing += block
    return FILLER + struct.pack(mark + "I", missing - 8) + bytes(missing - 8)


def _channel(channel: Channel, mark: str) -> bytes:
    variable = 0 if channel.variable.extensive else 1
    codes = struct.pack(mark + "HH", _DIMENSION_CODES[channel.dimension], variable)
    return _text(channel.name, mark) + codes


def _text(text: str, mark: str) -> bytes:
    data = text.encode("utf-8")
    if len(data) > 0xFFFF:
        raise MotionError(f"a text of {len(data)} bytes; a file holds 65535: {text[:40]!r}")
    return struct.pack(mark + "H", len(data)) + data


def _chunk(name: bytes, data: bytes, mark: str) -> bytes:
    if len(data) > LARGEST - 1:
        raise MotionError("the units and channels leave no room for frames in a file of 4 GiB")
    even = data + bytes(len(data) % 2)
    return name + struct.pack(mark + "I", len(even)) + even
