"""The head of a GST file that anybody may have written, or that was cut.

Nothing is taken at its word: a size is held against the file before anything of that size is read.
What disagrees is repaired with a warning where there is one reading that makes sense, and refused
with its byte where there is none.

- A frame chunk that goes on beyond the end of the file was cut, or its writer was stopped: the
  whole frames that are there are taken.
- Where the scene and a frame chunk that is whole count frames differently, the chunk is right.
- The size of the FORM is used to tell what lies after the form, and for nothing else.
"""

from __future__ import annotations

import struct
from dataclasses import dataclass, replace
from itertools import islice
from pathlib import Path
from typing import BinaryIO

from enpointe.errors import FormatError, MotionError
from enpointe.motion.gesture.chunks import DIMENSIONS, FILLER, MOST_CHUNKS, VARIABLES
from enpointe.motion.gesture.encoding import CODES, Encoding, Order
from enpointe.motion.gesture.fields import Fields, Notes
from enpointe.motion.gesture.holding import Holding
from enpointe.motion.gesture.own_chunks import AS_MANY_AS_FIT, measured, paced
from enpointe.motion.gesture.scene import Channel, Unit, Variable

__all__ = ["GestureHead", "parse_head"]

_KNOWN = (b"VERS", b"SCEN", b"UNIT", b"CHAN", b"FRAM", b"MEAS", b"RATE", FILLER)
_LATER = "stands after the frames, which must have their channels before them"


@dataclass(frozen=True, slots=True)
class GestureHead:
    """What a GST file says before its frames, and where they are.

    Attributes:
        name: The scene's.
        units: In the order of their tracks in a frame, each with its own rate.
        counts: Samples of each unit.
        rate: Frames per second.
        frames: How many are whole.
        encoding: How the numbers are stored.
        start: Byte of the first frame.
        version: Version and subversion.
    """

    name: str
    units: tuple[Unit, ...]
    counts: tuple[int, ...]
    rate: float
    frames: int
    encoding: Encoding
    start: int
    version: tuple[int, int]

    @property
    def width(self) -> int:
        """Numbers in a frame."""
        return sum(unit.width for unit in self.units)

    @property
    def frame_bytes(self) -> int:
        """Bytes of a frame."""
        return self.width * self.encoding.size


@dataclass(frozen=True, slots=True)
class _Chunk:
    name: bytes
    at: int
    size: int

    @property
    def data(self) -> int:
        return self.at + 8

    @property
    def end(self) -> int:
        return self.at + 8 + self.size


@dataclass(frozen=True, slots=True)
class _SceneChunk:
    name: str
    frames: int
    rate: float
    encoding: Encoding
    block: int


@dataclass(frozen=True, slots=True)
class _Frames:
    start: int
    count: int
    end: int
    cut: bool


def parse_head(file: BinaryIO, path: Path) -> tuple[GestureHead, Notes]:
    """Read all but the frames.

    Args:
        file: Open for reading, seekable.
        path: Its name, for messages.

    Raises:
        FormatError: No GST file, or one that can't be understood, with the byte.
    """
    return _HeadParser(file, path).parsed()


class _HeadParser:
    def __init__(self, file: BinaryIO, path: Path) -> None:
        self._file = file
        self._path = path
        self._size = file.seek(0, 2)
        self._notes = Notes()
        form_size = self._form()
        self._order, version = self._order_and_version()
        self._mark = ">" if self._order == "big" else "<"
        self._version = version
        self._form_end = 8 + int(struct.unpack(self._mark + "I", form_size)[0])
        self._scene: _SceneChunk | None = None
        self._units: list[tuple[str, list[Channel]]] = []
        self._own: dict[bytes, Fields] = {}
        self._frames: _Frames | None = None

    def parsed(self) -> tuple[GestureHead, Notes]:
        position, seen = 12, 0
        while not self._at_end(position):
            seen += 1
            if seen > MOST_CHUNKS:
                raise self._error(f"more than {MOST_CHUNKS} chunks", position)
            position = self._take(self._chunk_at(position, self._mark))
        if self._frames is None or self._scene is None:
            raise self._error("the file ends before its frames", self._size)
        self._compare_form(position)
        return self._head(self._scene, self._frames), self._notes

    def _form(self) -> bytes:
        begin = self._bytes(0, 12)
        if begin[:4] != b"FORM"[: len(begin)]:
            raise self._error("no GST file: it must begin with FORM", 0)
        if len(begin) < 12:
            raise self._error("the file ends before its type", len(begin))
        if begin[8:] == b"GMS ":
            raise self._error("a GMS file, which came after GST and differs; only GST is read", 8)
        if begin[8:] != b"GST ":
            raise self._error(f"an IFF file of type {begin[8:]!r}; GST has b'GST '", 8)
        return begin[4:8]

    def _order_and_version(self) -> tuple[Order, tuple[int, int]]:
        orders: tuple[tuple[Order, str], ...] = (("big", ">"), ("little", "<"))
        for order, mark in orders:
            chunk = self._first_version(mark)
            if chunk is None:
                continue
            if order == "little":
                self._notes.warn("numbers have the low byte first; read so, though IFF has not")
            version, sub = struct.unpack(mark + "HH", self._bytes(chunk.data, 4))
            if version != 0:
                raise self._error(f"version {version}.{sub}; 0.1 is read", chunk.data)
            if sub != 1:
                self._notes.warn(f"version 0.{sub} was read as 0.1")
            return order, (version, sub)
        raise self._error("no version chunk (VERS of 4 bytes) that is whole", min(12, self._size))

    def _first_version(self, mark: str) -> _Chunk | None:
        position = 12
        for _ in range(MOST_CHUNKS):
            if position + 8 > self._size:
                return None
            chunk = self._chunk_at(position, mark)
            if chunk.end > self._size:
                return None
            if chunk.name == b"VERS":
                return chunk if 4 <= chunk.size <= 0xFFFF else None
            position = self._after(chunk, quiet=True)
        return None

    def _at_end(self, position: int) -> bool:
        if self._frames is None:
            return position >= self._size
        if position + 8 > self._size:
            if position < self._form_end <= self._size:
                self._notes.warn(f"{self._size - position} bytes after the last chunk left out")
            return True
        return position >= self._form_end

    def _take(self, chunk: _Chunk) -> int:
        if chunk.name == b"FRAM":
            return self._take_frames(chunk)
        if chunk.end > self._size:
            if self._frames is None:
                has = self._size - chunk.data
                raise self._error(
                    f"{self._named(chunk)} says {chunk.size} bytes, the file has {has}",
                    chunk.at + 4,
                )
            if chunk.name != FILLER:
                self._notes.lose(f"{self._named(chunk)} at byte {chunk.at}, which is cut")
            return self._size
        if chunk.name in (b"SCEN", b"UNIT", b"CHAN"):
            if self._frames is not None:
                raise self._error(f"{self._named(chunk)} {_LATER}", chunk.at)
            self._describe(chunk)
        elif chunk.name in (b"MEAS", b"RATE") and self._frames is None:
            self._own[chunk.name] = self._fields(chunk)
        elif chunk.name not in (b"VERS", FILLER):
            self._notes.lose(f"{self._named(chunk)} of {chunk.size} bytes at byte {chunk.at}")
        return self._after(chunk)

    def _describe(self, chunk: _Chunk) -> None:
        fields = self._fields(chunk)
        if chunk.name == b"SCEN":
            if self._scene is not None:
                raise self._error("a second scene; a file has one", chunk.at)
            self._scene = self._scene_in(fields)
        elif chunk.name == b"UNIT":
            self._units.append((fields.text("the unit's name"), []))
        elif not self._units:
            raise self._error("a channel before any unit", chunk.at)
        else:
            self._units[-1][1].append(self._channel_in(fields))
        fields.finish()

    def _channel_in(self, fields: Fields) -> Channel:
        name = fields.text("the channel's name")
        at, code = fields.position, fields.short("the dimension")
        if code not in DIMENSIONS:
            raise self._error(f"dimension {code} of channel {name!r}; there are 1 to 8", at)
        kind = fields.short("the type of variable")
        if kind not in VARIABLES:
            self._notes.warn(f"type {kind} of channel {name!r} was taken for 0, a position")
        return Channel(name, VARIABLES.get(kind, Variable.POSITION), DIMENSIONS[code])

    def _scene_in(self, fields: Fields) -> _SceneChunk:
        name = fields.text("the scene's name")
        frames = fields.long("the number of frames")
        rate = fields.positive("the frequency")
        at = fields.position
        code = fields.short("the type of data")
        if code not in CODES:
            raise self._error(f"type of data {code}; there are 1, 2 and 3", at)
        at = fields.position
        scale = fields.real("the scale")
        if code != 3 and scale != 1.0:
            self._notes.warn(f"scale {scale:g} left out: {CODES[code]} has 1")
            scale = 1.0
        block = fields.long("the block size")
        try:
            encoding = Encoding(CODES[code], scale, self._order)
        except MotionError as error:
            raise self._error(str(error), at) from None
        return _SceneChunk(name, frames, rate, encoding, block)

    def _take_frames(self, chunk: _Chunk) -> int:
        if self._frames is not None:
            raise self._error("a second frame chunk; a file has one", chunk.at)
        if self._scene is None:
            raise self._error("frames before their scene chunk", chunk.at)
        width = sum(channel.width for _, channels in self._units for channel in channels)
        if width == 0:
            raise self._error("frames before any channel", chunk.at)
        frame = width * self._scene.encoding.size
        start, size = self._five_letters(chunk, frame * self._scene.frames)
        self._frames = self._counted(start, size, frame, self._scene.frames)
        if self._frames.cut:
            return self._size
        return self._after(_Chunk(chunk.name, start - 8, size))

    def _five_letters(self, chunk: _Chunk, expected: int) -> tuple[int, int]:
        """Start and size of the frames; the id may have the five letters of the print."""
        more = self._bytes(chunk.at + 4, 5)
        if chunk.size != expected and len(more) == 5 and more[:1] == b"E":
            size = struct.unpack(self._mark + "I", more[1:])[0]
            if size == expected:
                self._notes.warn("the frame chunk's id has five letters, as the document prints it")
                return chunk.at + 9, size
        return chunk.data, chunk.size

    def _counted(self, start: int, size: int, frame: int, said: int) -> _Frames:
        present = self._size - start
        if size <= present:
            count = size // frame
            if count * frame != size or count != said:
                self._notes.warn(
                    f"the scene counts {said} frames, the frame chunk has {size} bytes; its "
                    f"{count} whole frames are taken"
                )
            return _Frames(start, count, start + size, cut=False)
        count = said if 0 < said * frame <= present else present // frame
        self._notes.warn(
            f"the file ends {size - present} bytes before its frames do (cut, or its writer was "
            f"stopped); {count} whole frames of {size // frame} are there"
        )
        return _Frames(start, count, self._size, cut=True)

    def _compare_form(self, position: int) -> None:
        if self._form_end > self._size and not (self._frames and self._frames.cut):
            missing = self._form_end - self._size
            self._notes.warn(f"the file ends {missing} bytes before its FORM says")
        elif self._form_end < min(position, self._size):
            self._notes.warn("the FORM ends before its chunks do; they are taken whole")
        elif self._form_end < self._size:
            self._notes.lose(f"{self._size - self._form_end} bytes after the end of the FORM")

    def _head(self, scene: _SceneChunk, frames: _Frames) -> GestureHead:
        flat = [channel for _, channels in self._units for channel in channels]
        described = iter(measured(flat, self._own.get(b"MEAS"), self._notes))
        paces = paced(len(self._units), scene.rate, self._own.get(b"RATE"), self._notes)
        units, counts = [], []
        for (name, channels), (rate, samples) in zip(self._units, paces, strict=True):
            if not channels:
                self._notes.lose(f"unit {name!r}, which has no channels")
                continue
            units.append(Unit(name, tuple(islice(described, len(channels))), rate))
            fitting = Holding.of(scene.rate, rate).samples_before(frames.count)
            if AS_MANY_AS_FIT > samples > fitting and not frames.cut:
                self._notes.warn(f"unit {name!r} says {samples} samples, the frames hold {fitting}")
            counts.append(min(samples, fitting))
        width = sum(unit.width for unit in units)
        return GestureHead(
            scene.name,
            tuple(units),
            tuple(counts),
            scene.rate,
            frames.count,
            self._encoding(scene, width * scene.encoding.size, frames.start),
            frames.start,
            self._version,
        )

    def _encoding(self, scene: _SceneChunk, frame: int, start: int) -> Encoding:
        if scene.block in (0, frame):
            return scene.encoding
        if start % scene.block:
            self._notes.warn(
                f"the frames begin at byte {start}, which is no multiple of the block size "
                f"{scene.block}"
            )
            return scene.encoding
        try:
            return replace(scene.encoding, block_size=scene.block)
        except MotionError:
            self._notes.warn(f"block size {scene.block} left out: larger than any in use")
            return scene.encoding

    def _fields(self, chunk: _Chunk) -> Fields:
        data = self._bytes(chunk.data, chunk.size)
        return Fields(data, chunk.data, self._mark, self._path, self._notes)

    def _chunk_at(self, position: int, mark: str) -> _Chunk:
        head = self._bytes(position, 8)
        if len(head) < 8:
            raise self._error("the file ends within a chunk's id and size", position + len(head))
        return _Chunk(head[:4], position, struct.unpack(mark + "I", head[4:])[0])

    def _after(self, chunk: _Chunk, *, quiet: bool = False) -> int:
        """Where the next chunk begins: chunks are even, and odd ones of IFF have a byte more."""
        if chunk.size % 2 == 0:
            return chunk.end
        near = self._bytes(chunk.end, 5)
        padded = near[1:5] in _KNOWN or near[:4] not in _KNOWN
        if not quiet:
            self._notes.warn(
                f"{self._named(chunk)} at byte {chunk.at} has an odd size, "
                + ("with a byte after it" if padded else "and no byte after it")
            )
        return chunk.end + padded

    def _bytes(self, position: int, count: int) -> bytes:
        """As many of `count` bytes as the file has there."""
        self._file.seek(position)
        return self._file.read(min(count, max(self._size - position, 0)))

    def _named(self, chunk: _Chunk) -> str:
        return f"chunk {chunk.name.decode('latin-1')!r}"

    def _error(self, message: str, byte: int) -> FormatError:
        return FormatError(message, self._path, byte=byte)
