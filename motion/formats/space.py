"""Units and axes of a file, and the way from them to ours."""

from __future__ import annotations

from dataclasses import dataclass
from math import pi
from typing import Literal

import numpy as np
from numpy.typing import NDArray

__all__ = ["DEGREES", "Space"]

Array = NDArray[np.float64]
DEGREES = pi / 180
_TO_OURS = {
    "z": np.eye(3),
    "y": np.array([[0.0, 0.0, 1.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]),
    "x": np.array([[0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [1.0, 0.0, 0.0]]),
}


@dataclass(frozen=True, slots=True)
class Space:
    """How a file measures.

    Attributes:
        metres_per_unit: Length of its unit of length; a file that names none is guessed by its
            reader, which warns.
        up: Its upward axis. A file with y up has its figure face z, as BVH's makers do; our x.
        radians_per_unit: Size of its unit of angle.
    """

    metres_per_unit: float = 1.0
    up: Literal["x", "y", "z"] = "y"
    radians_per_unit: float = DEGREES

    @property
    def to_ours(self) -> Array:
        """(3, 3), a rotation: directions of the file to z up, x forward, y left."""
        return _TO_OURS[self.up].copy()

    def points(self, positions: Array) -> Array:
        """Positions (..., 3) of the file in metres, z up."""
        ours: Array = positions @ (self.to_ours.T * self.metres_per_unit)
        return ours
