"""What stands in a chunk, field by field, and what there is to say about it."""

from __future__ import annotations

import struct
from pathlib import Path

import numpy as np

from enpointe.errors import FormatError

__all__ = ["Fields", "Notes"]

_MOST_NOTES = 50
_LONGEST_GUESS = 0xFFFF // 2


class Notes:
    """Warnings and losses in order, the first fifty of each kind and how many more there were."""

    def __init__(self) -> None:
        self._warnings: list[str] = []
        self._lost: list[str] = []
        self._more = 0

    def warn(self, line: str) -> None:
        """Something doubtful and how it was taken."""
        if len(self._warnings) < _MOST_NOTES:
            self._warnings.append(line)
        else:
            self._more += 1

    def lose(self, what: str) -> None:
        """Something of the file that is left out, which is a warning too."""
        if len(self._lost) < _MOST_NOTES:
            self._lost.append(what)
        self.warn(f"left out: {what}")

    @property
    def warnings(self) -> tuple[str, ...]:
        """One line each."""
        more = (f"and {self._more} more warnings",) if self._more else ()
        return (*self._warnings, *more)

    @property
    def lost(self) -> tuple[str, ...]:
        """One line each."""
        return tuple(self._lost)


class Fields:
    """A chunk's bytes, read from front to back.

    Attributes:
        position: Byte in the file of what comes next.
    """

    def __init__(self, data: bytes, position: int, mark: str, path: Path, notes: Notes) -> None:
        self.position = position
        self._data = data
        self._end = position + len(data)
        self._mark = mark
        self._path = path
        self._notes = notes

    def short(self, what: str) -> int:
        """A USHORT.

        Raises:
            FormatError: The chunk ends before it.
        """
        return int(struct.unpack(self._mark + "H", self._next(2, what))[0])

    def long(self, what: str) -> int:
        """A ULONG.

        Raises:
            FormatError: The chunk ends before it.
        """
        return int(struct.unpack(self._mark + "I", self._next(4, what))[0])

    def real(self, what: str) -> float:
        """A FLOAT64.

        Raises:
            FormatError: The chunk ends before it.
        """
        return float(struct.unpack(self._mark + "d", self._next(8, what))[0])

    def positive(self, what: str) -> float:
        """A FLOAT64 that is finite and above 0.

        Raises:
            FormatError: The chunk ends before it, or it is not.
        """
        at, value = self.position, self.real(what)
        if not np.isfinite(value) or value <= 0:
            raise FormatError(f"{what} must be above 0, got {value}", self._path, byte=at)
        return value

    def text(self, what: str) -> str:
        """A length and as many bytes: UTF-8, or Latin-1 with a warning; a closing NUL is left out.

        Raises:
            FormatError: The chunk ends before the text does.
        """
        length = self.short(f"the length of {what}")
        raw = self._next(length, what)
        whole, _, rest = raw.partition(b"\0")
        if rest.strip(b"\0"):
            self._notes.warn(f"{what} at byte {self.position - length} was cut at its first NUL")
        try:
            return whole.decode("utf-8")
        except UnicodeDecodeError:
            self._notes.warn(f"{what} at byte {self.position - length} was taken for Latin-1")
            return whole[:_LONGEST_GUESS].decode("latin-1")

    def finish(self) -> None:
        """Say where there is more than the zero byte that makes a chunk even."""
        left = self._end - self.position
        if left > 1 or (left == 1 and self._data[-1] != 0):
            self._notes.lose(f"{left} bytes at byte {self.position}, not of version 0.1")

    def _next(self, count: int, what: str) -> bytes:
        if self._end - self.position < count:
            raise FormatError(
                f"the chunk ends within {what}: {count} bytes wanted, {self._end - self.position} "
                "left",
                self._path,
                byte=self.position,
            )
        first = len(self._data) - (self._end - self.position)
        self.position += count
        return self._data[first : first + count]
