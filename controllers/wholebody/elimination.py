"""The accelerations eliminated: a programme of the floor's forces alone.

Tasks speak of accelerations a or of forces lambda, never of both, so that the cost is
a'Q a / 2 + q'a + lambda'L lambda / 2 + l'lambda. Where no joint is at an end of its range or of its
strength, only the equalities  A a + B lambda = b  tie the two, and setting the derivative by a to
zero gives

    a = a_0 + Q^-1 A' S^-1 (e - B lambda),    a_0 = -Q^-1 q,  S = A Q^-1 A',  e = b - A a_0,

and what is left is  min lambda'(L + B' S^-1 B) lambda / 2 + (l - B' S^-1 e)' lambda  within the
bounds on lambda: 4 unknowns a sole instead of 42 more (Schur complement; Boyd and Vandenberghe,
Convex Optimization, 2004, sections 10.4 and A.5.5).
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import lapack

from enpointe.controllers.wholebody.programme import Programme
from enpointe.controllers.wholebody.rows import Equality

__all__ = ["Cost", "eliminated"]

Array = NDArray[np.float64]


class Cost(NamedTuple):
    """x' hessian x / 2 + gradient' x.

    Attributes:
        hessian: (n, n), symmetric, positive definite.
        gradient: (n,).
    """

    hessian: Array
    gradient: Array


def eliminated(
    accelerations: Cost, forces: Cost, tie: Equality, low: Array, high: Array
) -> Array | None:
    """The best [a, lambda] (n,) with lambda within bounds, whatever else is asked of a.

    Args:
        accelerations: Q and q.
        forces: L and l.
        tie: [A, B] and b, fewer rows than accelerations.
        low: Of lambda.
        high: Of lambda.

    Returns:
        None where there is none, or where the rows are not independent.
    """
    count, rows = len(accelerations.gradient), len(tie.target)
    if rows == 0:
        return None
    on_accelerations, on_forces = tie.matrix[:, :count], tie.matrix[:, count:]
    right = np.empty((count, rows + 1), order="F")
    right[:, :rows], right[:, rows] = on_accelerations.T, -accelerations.gradient
    _, solved, indefinite = lapack.dposv(accelerations.hessian.T, right, lower=1)
    ways, free = solved[:, :rows], solved[:, rows]
    error = tie.target - on_accelerations @ free
    # dposv twice and no triangular solver: OpenBLAS gives even the smallest of those to its
    # threads, and where they have no core of their own, 0.1 ms become 10.
    right = np.concatenate([on_forces, error[:, None]], axis=1)
    _, solved, dependent = lapack.dposv(on_accelerations @ ways, right)
    if indefinite or dependent:
        return None
    spread, pull = solved[:, :-1], solved[:, -1]
    left = Cost(forces.hessian + on_forces.T @ spread, forces.gradient - pull @ on_forces)
    edges = _within(left, low, high)
    if edges is None:
        return None
    return np.concatenate([free + ways @ (pull - spread @ edges), edges])


def _within(cost: Cost, low: Array, high: Array) -> Array | None:
    """The best unknowns within bounds."""
    count = len(low)
    if count == 0:
        return np.zeros(0)
    return Programme(cost.hessian, cost.gradient, np.empty((0, count)), low, high, 0).solve()
