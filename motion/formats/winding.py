"""Angles that go on where they were: no jump where a curve of angles passes half a turn."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

__all__ = ["nearest_angles", "unwound"]

Array = NDArray[np.float64]


def nearest_angles(angles: Array, others: Array) -> Array:
    """The same rotations by the angles that are nearest to others.

    Three angles about three different axes, as (a, b, c) and as (a + pi, pi - b, c + pi), are one
    rotation, and so is either with whole turns added.

    Args:
        angles: (..., 3), rad; the first, middle and last of each product of rotations.
        others: (..., 3), rad.

    Returns:
        (..., 3), rad.
    """
    flipped = angles + np.pi
    flipped[..., 1] = np.pi - angles[..., 1]
    both = np.stack([angles, flipped])
    both += 2 * np.pi * np.round((others - both) / (2 * np.pi))
    far = np.abs(both - others).sum(axis=-1)
    nearest: Array = np.where((far[0] <= far[1])[..., None], both[0], both[1])
    return nearest


def unwound(angles: Array) -> Array:
    """The same rotations, each by the angles that are nearest to those of the frame before.

    Args:
        angles: (T, ..., 3), rad.

    Returns:
        (T, ..., 3), rad.
    """
    found = np.array(angles, dtype=float)
    for index in range(1, len(found)):
        found[index] = nearest_angles(found[index], found[index - 1])
    return found
