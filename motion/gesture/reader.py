"""Reading a gesture file, whole or in blocks."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from types import TracebackType
from typing import Self

import numpy as np
from numpy.typing import NDArray

from enpointe.errors import FormatError
from enpointe.motion.gesture.holding import Holding
from enpointe.motion.gesture.parsing import parse_head
from enpointe.motion.gesture.scene import Scene

__all__ = ["GestureReader"]

Array = NDArray[np.float64]
_BLOCK_BYTES = 2**20


class GestureReader:
    """A GST file, open for reading.

    Attributes:
        head: What the file says before its frames.
        warnings: What was doubtful and how it was taken, one line each.
        lost: What the file holds and a scene does not, one line each.

    Example:
        >>> with GestureReader("stick.gst") as reader:
        ...     for block in reader.blocks(4000):
        ...         loudest = abs(block).max(axis=0)
    """

    def __init__(self, path: str | Path, *, unsigned: bool = False) -> None:
        """Open a file and read its head.

        Args:
            path: The file.
            unsigned: Whether its integers, if it has any, are unsigned.

        Raises:
            FormatError: No such file, or none that can be understood, with the byte.
        """
        self._path = Path(path)
        self._unsigned = unsigned
        try:
            if self._path.exists() and not self._path.is_file():
                raise OSError("it is no ordinary file")
            self._file = self._path.open("rb")
        except (OSError, ValueError) as error:
            raise FormatError(f"can't be read ({error})", path) from None
        try:
            self.head, notes = parse_head(self._file, self._path)
        except OSError as error:
            self._file.close()
            raise FormatError(f"can't be read ({error})", path) from None
        except FormatError:
            self._file.close()
            raise
        self.warnings = notes.warnings
        self.lost = notes.lost

    def __enter__(self) -> Self:
        """The reader itself."""
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        """Close the file."""
        self.close()

    def close(self) -> None:
        """Close the file."""
        self._file.close()

    def blocks(self, frames: int | None = None) -> Iterator[Array]:
        """The frames in order, without more than one block in memory.

        Slower units' samples are repeated, as the file has them; `scene` gives each once.

        Args:
            frames: In a block; what a megabyte holds where None. The last block may have fewer.

        Yields:
            (n, head.width), in the units' measures.

        Raises:
            FormatError: The file became shorter since it was opened, or can't be read.
        """
        head = self.head
        size = frames or max(_BLOCK_BYTES // head.frame_bytes, 1)
        dtype = head.encoding.dtype(unsigned=self._unsigned)
        for first in range(0, head.frames, size):
            count = min(size, head.frames - first)
            at = head.start + first * head.frame_bytes
            stored = np.frombuffer(self._bytes(at, count * head.frame_bytes), dtype)
            yield head.encoding.decoded(stored.reshape(count, head.width))

    def scene(self) -> Scene:
        """All of it, each unit at its own rate.

        Raises:
            FormatError: The file became shorter since it was opened, or can't be read.
        """
        head = self.head
        pairs = zip(head.units, head.counts, strict=True)
        signals = tuple(np.empty((count, unit.width)) for unit, count in pairs)
        holdings = [Holding.of(head.rate, unit.rate) for unit in head.units]
        first = 0
        for block in self.blocks():
            column = 0
            for unit, holding, signal in zip(head.units, holdings, signals, strict=True):
                columns = slice(column, column + unit.width)
                _take(signal, holding, block[:, columns], first)
                column += unit.width
            first += len(block)
        return Scene(head.name, head.units, signals)

    def _bytes(self, at: int, count: int) -> bytes:
        try:
            self._file.seek(at)
            data = self._file.read(count)
        except (OSError, ValueError) as error:
            raise FormatError(f"can't be read ({error})", self._path, byte=at) from None
        if len(data) < count:
            raise FormatError(
                "the file became shorter while it was read", self._path, byte=at + len(data)
            )
        return data


def _take(signal: Array, holding: Holding, held: Array, first: int) -> None:
    """Copy the samples that first stand in `held`, which begins at frame `first`."""
    start = min(holding.samples_before(first), len(signal))
    stop = min(holding.samples_before(first + len(held)), len(signal))
    if holding.frames == holding.samples:
        signal[start:stop] = held[start - first : stop - first]
    else:
        signal[start:stop] = held[holding.first_frames(start, stop) - first]
