"""Directions of points from one another."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

__all__ = ["unit"]

Array = NDArray[np.float64]
_NOWHERE = 1e-9
"""m: vectors shorter than this have no direction, and stay as short."""


def unit(vectors: Array) -> Array:
    """Vectors (..., 3) of length 1."""
    length = np.linalg.norm(vectors, axis=-1, keepdims=True)
    return np.asarray(vectors / np.maximum(length, _NOWHERE))
