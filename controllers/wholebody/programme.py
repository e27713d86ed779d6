"""A quadratic programme as its solver takes it."""

from __future__ import annotations

from dataclasses import dataclass

import daqp
import numpy as np
from numpy.typing import NDArray

__all__ = ["Programme"]

Array = NDArray[np.float64]
_EQUAL = 5
"""daqp's mark of a row that holds with equality, and is never left."""


@dataclass(frozen=True, slots=True)
class Programme:
    """min x' hessian x / 2 + gradient' x  subject to  low <= [x; matrix x] <= high.

    Attributes:
        hessian: (n, n), symmetric, positive definite.
        gradient: (n,).
        matrix: (R, n), rows that are kept equal first.
        low: (n + R,).
        high: (n + R,).
        equalities: How many of the rows are equalities.
    """

    hessian: Array
    gradient: Array
    matrix: Array
    low: Array
    high: Array
    equalities: int

    def solve(self) -> Array | None:
        """The one solution (n,), or None where there is none.

        By daqp's dual active set (Arnstrom et al. 2022, IEEE TAC 67(8)), which is exact but for
        rounding, and called without a layer between: for a programme this small the checks and
        copies of one cost more than a third of the solution.
        """
        count = len(self.gradient)
        sense = np.zeros(len(self.low), dtype=np.intc)
        sense[count : count + self.equalities] = _EQUAL
        unknowns, _, flag, _ = daqp.solve(
            self.hessian, self.gradient, self.matrix, self.high, self.low, sense
        )
        if flag <= 0 or not np.isfinite(unknowns).all():
            return None
        return np.asarray(unknowns)
