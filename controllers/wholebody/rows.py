"""What tasks and constraints are written in: rows over the unknowns x = [qacc, lambda]."""

from __future__ import annotations

from functools import lru_cache
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

__all__ = ["Bounds", "Direct", "Equality", "Limits", "Places", "Rows", "places", "repeated"]

Array = NDArray[np.float64]
Places = slice | NDArray[np.int64]
EVERYTHING = slice(None)


class Rows(NamedTuple):
    """Rows of a least-squares problem: weight |matrix x[columns] - target|^2.

    A task speaks of accelerations or of forces, seldom of both; a problem made of blocks is far
    cheaper to multiply out than one of full rows.

    Attributes:
        matrix: (R, C).
        target: (R,).
        weight: (R,).
        columns: The C neighbouring unknowns that the rows are about.
    """

    matrix: Array
    target: Array
    weight: Array
    columns: slice = EVERYTHING

    def error(self, unknowns: Array) -> Array:
        """What is left, matrix x[columns] - target, (R,)."""
        return np.asarray(self.matrix @ unknowns[self.columns] - self.target)


class Direct(NamedTuple):
    """Wishes for unknowns themselves: weight |x[columns] - target|^2.

    Attributes:
        target: (R,).
        weight: (R,).
        columns: Which unknowns, R different ones.
    """

    target: Array
    weight: Array
    columns: Places

    def error(self, unknowns: Array) -> Array:
        """What is left, x[columns] - target, (R,)."""
        return np.asarray(unknowns[self.columns] - self.target)


class Equality(NamedTuple):
    """Rows matrix x = target.

    Attributes:
        matrix: (R, n).
        target: (R,).
    """

    matrix: Array
    target: Array


class Limits(NamedTuple):
    """Rows low <= matrix x <= high.

    Attributes:
        matrix: (R, n).
        low: (R,).
        high: (R,).
    """

    matrix: Array
    low: Array
    high: Array


class Bounds(NamedTuple):
    """Bounds low <= x[columns] <= high on unknowns.

    Attributes:
        low: (C,).
        high: (C,).
        columns: Which unknowns, C different ones.
    """

    low: Array
    high: Array
    columns: Places = EVERYTHING


@lru_cache(maxsize=256)
def repeated(value: float, count: int) -> Array:
    """`count` times the same, not to be written to: there are few such arrays, asked for often."""
    array = np.full(count, value)
    array.flags.writeable = False
    return array


def places(indices: NDArray[np.int64]) -> Places:
    """Neighbouring indices as a slice, which copies nothing; others as they are."""
    if len(indices) == 0 or (np.diff(indices) != 1).any():
        return np.array(indices)
    return slice(int(indices[0]), int(indices[-1]) + 1)
