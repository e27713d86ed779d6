"""How the numbers of a gesture file are stored.

ENACTIVE D.RD3.3.1 §4.5.4 leaves three things open, which are resolved so:

Byte order: big-endian. The document takes the IFF standard (its [MOR85]), whose numbers have the
high byte first, and nowhere speaks of another order. Files in the other order are read too: the
size of the version chunk, which is 4, tells which is which.

Integers: two's complement. The document's third type is printed ULONG, a 4-byte unsigned integer,
with a scale and no offset; positions and forces have signs, and its chapter 11 lists the same
coding as "Integer 32 with scaling factor". Below 2^31 both readings have the same bytes. Whoever
meant unsigned numbers reads the file with `unsigned=True`.

Block size: the frames begin at a multiple of it, counted from the start of the file, and the file
ends at one. The frame chunk holds nothing but frames, by the formula of its size, so what is needed
before and after is filled with IFF's filler chunks, whose name is four blanks. The default block is
a frame, as printed, and asks for no filling.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from enpointe.errors import MotionError

__all__ = ["CODES", "Encoding", "Numbers", "Order"]

Array = NDArray[np.float64]
Numbers = Literal["float32", "float64", "int32"]
Order = Literal["big", "little"]
CODES: dict[int, Numbers] = {1: "float32", 2: "float64", 3: "int32"}
"""The document's `dataType`."""
_LARGEST = 2**31 - 1
_LARGEST_BLOCK = 2**24
_SMALLEST_SCALE = 1e-290
_LARGEST_SCALE = 1e290


@dataclass(frozen=True, slots=True)
class Encoding:
    """How numbers are stored.

    Attributes:
        numbers: "float32", "float64" or scaled "int32".
        scale: What an integer is multiplied with; 1 for the others.
        order: Byte order of every number in the file.
        block_size: Bytes that the frames are aligned to; None for a frame's own size.
    """

    numbers: Numbers = "float64"
    scale: float = 1.0
    order: Order = "big"
    block_size: int | None = None

    def __post_init__(self) -> None:
        """Check the values.

        Raises:
            MotionError: An unknown kind of number or order, a scale or a block that can't be.
        """
        if self.numbers not in CODES.values() or self.order not in ("big", "little"):
            raise MotionError(f"no such numbers or order: {self.numbers!r}, {self.order!r}")
        if self.numbers != "int32" and self.scale != 1.0:
            raise MotionError(f"only integers are scaled; {self.numbers} has scale 1")
        if not _SMALLEST_SCALE <= abs(self.scale) <= _LARGEST_SCALE:
            raise MotionError(f"a scale of {self.scale} loses the signal")
        if self.block_size is not None and not 0 < self.block_size <= _LARGEST_BLOCK:
            raise MotionError(f"a block must have 1 byte to 16 MiB, got {self.block_size}")

    @classmethod
    def integers(cls, largest: float, order: Order = "big") -> Encoding:
        """Integers whose scale just holds values up to ±`largest`.

        Raises:
            MotionError: `largest` is no number or has no scale.
        """
        if not np.isfinite(largest):
            raise MotionError(f"integers hold finite values alone, not {largest}")
        return cls("int32", abs(largest) / _LARGEST if largest else 1.0, order)

    @property
    def size(self) -> int:
        """Bytes of a number."""
        return 8 if self.numbers == "float64" else 4

    @property
    def code(self) -> int:
        """The document's `dataType`."""
        return next(code for code, numbers in CODES.items() if numbers == self.numbers)

    @property
    def mark(self) -> Literal[">", "<"]:
        """The byte order as struct and numpy write it."""
        return ">" if self.order == "big" else "<"

    def dtype(self, *, unsigned: bool = False) -> np.dtype[np.generic]:
        """A number as numpy sees it; `unsigned` takes integers for what the document prints."""
        kind = ("u" if unsigned else "i") if self.numbers == "int32" else "f"
        return np.dtype(f"{self.mark}{kind}{self.size}")

    def encoded(self, values: Array) -> NDArray[np.generic]:
        """Values as they are stored, of the same shape.

        Raises:
            MotionError: A value that this encoding can't hold.
        """
        if self.numbers == "float64":
            return values.astype(self.dtype(), copy=False)
        if self.numbers == "float32":
            with np.errstate(over="ignore", invalid="ignore"):
                stored = values.astype(self.dtype())
            self._refuse(values, np.isinf(stored) & np.isfinite(values))
            return stored
        with np.errstate(over="ignore", invalid="ignore"):
            counted = np.rint(values / self.scale)
        self._refuse(values, ~((counted >= -_LARGEST - 1) & (counted <= _LARGEST)))
        return counted.astype(self.dtype())

    def decoded(self, stored: NDArray[np.generic]) -> Array:
        """Stored numbers as values, of the same shape."""
        with np.errstate(invalid="ignore"):
            values = stored.astype(np.float64)
        if self.numbers == "int32" and self.scale != 1.0:
            values *= self.scale
        return values

    def _refuse(self, values: Array, beyond: NDArray[np.bool_]) -> None:
        if beyond.any():
            first = values[beyond][0]
            scaled = f" scaled by {self.scale:g}" if self.numbers == "int32" else ""
            raise MotionError(f"{self.numbers}{scaled} can't hold {first:g}; choose float64")
