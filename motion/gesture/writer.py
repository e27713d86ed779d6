"""Writing a gesture file while the gesture goes on."""

from __future__ import annotations

import os
from collections.abc import Sequence
from contextlib import suppress
from pathlib import Path
from types import TracebackType
from typing import Self

import numpy as np
from numpy.typing import ArrayLike, NDArray

from enpointe.errors import FormatError, MotionError
from enpointe.motion.gesture.chunks import head_of
from enpointe.motion.gesture.encoding import Encoding
from enpointe.motion.gesture.scene import Unit

__all__ = ["GestureWriter"]

Array = NDArray[np.float64]
_PIECE = 2**20


class GestureWriter:
    """A GST file that grows, and is a whole file after every flush.

    At a flush the sizes in the head are first raised to what the file is going to hold, then the
    frames are written. So whatever stops the process, and whenever, the file says at least as much
    as it has, which is the case of a file that was cut: `GestureReader` gives back every whole
    frame. Frames that a flush has returned for are with the operating system and outlive the
    process; with `durable` they are on the disk and outlive a power cut.

    All units are in every frame. Where some are slower than the file, hand their last sample again
    until the next: a reader takes each sample once (see `holding`).

    Attributes:
        rate: Frames per second, the highest rate of the units.
        width: Numbers in a frame.
        most: Frames that the file has room for.

    Example:
        >>> with GestureWriter("stick.gst", [unit], name="stick") as writer:
        ...     for position in device:
        ...         writer.append(position)
    """

    def __init__(
        self,
        path: str | Path,
        units: Sequence[Unit],
        *,
        name: str = "",
        encoding: Encoding | None = None,
        flush_seconds: float = 0.1,
        durable: bool = False,
        counts: Sequence[int] | None = None,
    ) -> None:
        """Make the file, with a head and no frames.

        Args:
            path: Where to; nothing may be there, as a recording never replaces another.
            units: Who moves.
            name: The scene's.
            encoding: How numbers are stored; float64 where None.
            flush_seconds: Frames are flushed when this much of the gesture waits; 0 flushes each.
            durable: Whether a flush waits until the disk has the frames.
            counts: Samples of each unit, where they are known and do not follow from the frames.

        Raises:
            MotionError: Units that no file can hold.
            FormatError: The file can't be made there, or one is there already.
        """
        self._path = Path(path)
        self._encoding = encoding or Encoding()
        self._head = head_of(name, units, self._encoding, counts)
        self.rate = max(unit.rate for unit in units)
        self.width = sum(unit.width for unit in units)
        self.most = self._head.most
        self._durable = durable
        most_waiting = max(_PIECE // self._head.frame_bytes, 1)
        self._patience = int(min(max(flush_seconds * self.rate, 1), most_waiting))
        self._waiting: list[bytes] = []
        self._waiting_frames = 0
        self._written = 0
        self._closed = False
        try:
            self._file = self._path.open("xb", buffering=0)
        except FileExistsError:
            raise FormatError("there is a file already; name another", path) from None
        except (OSError, ValueError) as error:
            raise FormatError(f"can't be written ({error})", path) from None
        self._put(self._head.encoded(0))

    @property
    def frames(self) -> int:
        """How many were appended so far."""
        return self._written + self._waiting_frames

    @property
    def flushed(self) -> int:
        """How many of them the file gives back if the process ends now."""
        return self._written

    def append(self, frames: ArrayLike) -> None:
        """Add one frame (width,) or several (n, width), in the units' measures.

        Raises:
            MotionError: Another shape, a value that the encoding can't hold, a closed file, or a
                file that would pass 4 GiB, the most that its sizes can say. The file stays as it
                was.
            FormatError: The file can't be written (no space left).
        """
        rows = np.asarray(frames, dtype=np.float64)
        rows = rows[np.newaxis] if rows.ndim == 1 else rows
        if rows.ndim != 2 or rows.shape[1] != self.width:
            raise MotionError(f"frames must have shape (n, {self.width}), got {rows.shape}")
        if self._closed:
            raise MotionError(f"{self._path} is closed; nothing can be added")
        if self.frames + len(rows) > self.most:
            raise MotionError(
                f"{self._path} would pass 4 GiB; close it after {self.frames} frames and go on in "
                "another"
            )
        step = self._patience
        encoded = [
            self._encoding.encoded(rows[first : first + step]).tobytes()
            for first in range(0, len(rows), step)
        ]
        for piece in encoded:
            self._waiting.append(piece)
            self._waiting_frames += len(piece) // self._head.frame_bytes
            if self._waiting_frames >= self._patience:
                self.flush()

    def flush(self) -> None:
        """Hand all frames to the operating system, and to the disk with `durable`.

        Raises:
            FormatError: The file can't be written; it then holds the frames flushed before.
        """
        if not self._waiting:
            return
        data = b"".join(self._waiting)
        total = self.frames
        try:
            self._put(self._head.encoded(total))
            self._put(data, self._head.size + self._written * self._head.frame_bytes)
            self._settle()
        except FormatError:
            self._take_back()
            raise
        self._waiting, self._waiting_frames, self._written = [], 0, total

    def close(self) -> None:
        """Flush, fill the last block, and close; a second time does nothing.

        Raises:
            FormatError: The file can't be written.
        """
        if self._closed:
            return
        try:
            self.flush()
            tail = self._head.tail(self._written)
            if tail:
                self._put(self._head.encoded(self._written, len(tail)))
                self._put(tail, self._head.size + self._written * self._head.frame_bytes)
                self._settle()
        finally:
            self._closed = True
            self._file.close()

    def __enter__(self) -> Self:
        """The writer itself."""
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        """Close; what was appended before an error is kept."""
        self.close()

    def _put(self, data: bytes, position: int = 0) -> None:
        try:
            self._file.seek(position)
            left = memoryview(data)
            while left:
                left = left[self._file.write(left) :]
        except (OSError, ValueError) as error:
            raise FormatError(f"can't be written ({error})", self._path) from None

    def _settle(self) -> None:
        if not self._durable:
            return
        try:
            os.fsync(self._file.fileno())
        except OSError as error:
            raise FormatError(f"can't be written ({error})", self._path) from None

    def _take_back(self) -> None:
        """Say again what is whole: a head with the frames of before, and no part of a frame."""
        self._waiting, self._waiting_frames = [], 0
        with suppress(OSError, FormatError):
            self._file.truncate(self._head.size + self._written * self._head.frame_bytes)
            self._put(self._head.encoded(self._written))
