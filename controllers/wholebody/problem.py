"""The quadratic programme of one moment, built before it is solved.

    minimise    sum_i w_i |A_i x - b_i|^2 + small regularisation
    subject to  the constraints' rows and bounds

in x = [qacc, lambda]. It can be looked at: `rows` and `limits` keep each task and constraint under
its name, and `errors` says how far a solution is from every wish.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

from enpointe.controllers.wholebody.constraints import Constraint
from enpointe.controllers.wholebody.elimination import Cost, eliminated
from enpointe.controllers.wholebody.goal import Goal
from enpointe.controllers.wholebody.instant import Instant
from enpointe.controllers.wholebody.programme import Programme
from enpointe.controllers.wholebody.rows import Bounds, Direct, Equality, Limits, Rows, repeated
from enpointe.controllers.wholebody.tasks import Task

__all__ = ["WholeBodyProblem"]

Array = NDArray[np.float64]
_Kind = TypeVar("_Kind", Equality, Limits, Bounds)
REGULARISATION = 1e-6
"""Cost of each squared unknown, in rad/s^2 and N: it settles how redundant soles share a force."""
TOLERANCE = 1e-3
"""How far a solution may be outside a constraint, N, N m or rad/s^2: rounding, no more."""


@dataclass(frozen=True)
class WholeBodyProblem:
    """One moment's problem.

    Attributes:
        instant: The state it is about.
        rows: Each task's rows, by name.
        limits: Each constraint's rows or bounds, by name.
    """

    instant: Instant
    rows: Mapping[str, Rows | Direct]
    limits: Mapping[str, Equality | Limits | Bounds]

    @classmethod
    def build(
        cls,
        instant: Instant,
        goal: Goal,
        tasks: Sequence[Task],
        constraints: Sequence[Constraint],
    ) -> WholeBodyProblem:
        """Write the problem down without solving it."""
        return cls(
            instant,
            {task.name: task.rows(instant, goal) for task in tasks},
            {constraint.name: constraint.limits(instant) for constraint in constraints},
        )

    @cached_property
    def cost(self) -> Cost:
        """Half of what is minimised, less its value at zero."""
        return self._quadratic(0, self.instant.size)

    @cached_property
    def separate(self) -> tuple[Cost, Cost] | None:
        """The cost of accelerations and that of forces; None if a task speaks of both at once."""
        nv, n = self.instant.nv, self.instant.size
        if any(first < nv < end for first, end in self._blocks):
            return None
        return self._quadratic(0, nv), self._quadratic(nv, n)

    @cached_property
    def bounds(self) -> Bounds:
        """All bounds on the unknowns together."""
        n = self.instant.size
        low, high = repeated(-np.inf, n).copy(), repeated(np.inf, n).copy()
        for bounds in self._of(Bounds):
            here = bounds.columns
            low[here] = np.maximum(low[here], bounds.low)
            high[here] = np.minimum(high[here], bounds.high)
        return Bounds(low, high)

    @cached_property
    def equality(self) -> Equality:
        """All rows that must be met."""
        equal = self._of(Equality)
        if len(equal) == 1:
            return equal[0]
        matrices = [np.empty((0, self.instant.size)), *(e.matrix for e in equal)]
        return Equality(np.concatenate(matrices), np.concatenate([[], *(e.target for e in equal)]))

    @cached_property
    def programme(self) -> Programme:
        """The whole as matrices."""
        (low, high, _), equal, sided = self.bounds, self.equality, self._of(Limits)
        return Programme(
            *self.cost,
            np.concatenate([equal.matrix, *(s.matrix for s in sided)]),
            np.concatenate([low, equal.target, *(s.low for s in sided)]),
            np.concatenate([high, equal.target, *(s.high for s in sided)]),
            len(equal.target),
        )

    @cached_property
    def _blocks(self) -> dict[tuple[int, int], list[Rows]]:
        """Tasks by the range of unknowns that they speak of."""
        blocks: dict[tuple[int, int], list[Rows]] = {}
        for rows in self.rows.values():
            if isinstance(rows, Rows) and len(rows.target):
                first, end, _ = rows.columns.indices(self.instant.size)
                blocks.setdefault((first, end), []).append(rows)
        return blocks

    @cached_property
    def _direct(self) -> tuple[Array, Array]:
        """What wishes for unknowns themselves add to the diagonal and to the gradient, (n,)."""
        n = self.instant.size
        diagonal, gradient = repeated(REGULARISATION, n).copy(), np.zeros(n)
        for rows in self.rows.values():
            if isinstance(rows, Direct):
                diagonal[rows.columns] += rows.weight
                gradient[rows.columns] -= rows.weight * rows.target
        return diagonal, gradient

    def _quadratic(self, start: int, stop: int) -> Cost:
        """The cost of the unknowns from `start` to `stop`, of tasks that speak of no others."""
        n = stop - start
        diagonal, slope = self._direct
        hessian, gradient = np.zeros((n, n)), slope[start:stop].copy()
        hessian.reshape(-1)[:: n + 1] = diagonal[start:stop]
        for (first, end), block in self._blocks.items():
            if start <= first and end <= stop:
                here = slice(first - start, end - start)
                matrix = _joined([r.matrix for r in block])
                weighted = matrix * _joined([r.weight for r in block])[:, None]
                hessian[here, here] += weighted.T @ matrix
                gradient[here] -= _joined([r.target for r in block]) @ weighted
        return Cost(hessian, gradient)

    def _of(self, kind: type[_Kind]) -> list[_Kind]:
        return [limit for limit in self.limits.values() if isinstance(limit, kind)]

    def solve(self) -> Array | None:
        """The unknowns (n,), or None where the constraints leave no solution.

        Limits on accelerations and torques are left out at first. A solution that keeps them all
        the same is the best of a larger set and so the best of the smaller one; where it doesn't,
        the whole is solved. What a solver returns is believed only after a look at all constraints.
        """
        unknowns = self._eased()
        if unknowns is None:
            unknowns = self.programme.solve()
            if unknowns is not None and self.violation(unknowns) >= TOLERANCE:
                return None
        return unknowns

    def _eased(self) -> Array | None:
        """The solution if no acceleration and no torque is at its limit."""
        if self.separate is None:
            return None
        nv, (low, high, _) = self.instant.nv, self.bounds
        unknowns = eliminated(*self.separate, self.equality, low[nv:], high[nv:])
        if unknowns is None:
            return None
        outside = np.maximum(low - unknowns, unknowns - high)
        kept = bool(outside[:nv].max() <= 0.0 and outside[nv:].max(initial=0.0) <= TOLERANCE)
        kept = kept and _outside(self.equality, unknowns) < TOLERANCE
        kept = kept and all(_outside(sided, unknowns) == 0.0 for sided in self._of(Limits))
        return unknowns if kept else None

    def violation(self, unknowns: Array) -> float:
        """The largest amount by which any constraint is broken: N, N m, rad/s^2."""
        return max((_outside(limit, unknowns) for limit in self.limits.values()), default=0.0)

    def errors(self, unknowns: Array) -> dict[str, Array]:
        """What each task is left with, A x - b, in its own unit."""
        return {name: rows.error(unknowns) for name, rows in self.rows.items()}


def _joined(parts: Sequence[Array]) -> Array:
    return parts[0] if len(parts) == 1 else np.concatenate(parts)


def _outside(limit: Equality | Limits | Bounds, unknowns: Array) -> float:
    """The largest amount by which one constraint is broken, 0 if by none."""
    match limit:
        case Equality():
            outside = np.abs(limit.matrix @ unknowns - limit.target)
        case Limits():
            value = limit.matrix @ unknowns
            outside = np.maximum(limit.low - value, value - limit.high)
        case Bounds():
            value = unknowns[limit.columns]
            outside = np.maximum(limit.low - value, value - limit.high)
    return float(outside.max(initial=0.0))
