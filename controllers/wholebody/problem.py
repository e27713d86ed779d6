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
from enpointe.controllers.wholebody.goal import Goal
from enpointe.controllers.wholebody.instant import Instant
from enpointe.controllers.wholebody.programme import Programme
from enpointe.controllers.wholebody.rows import Bounds, Direct, Equality, Limits, Rows
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
    def cost(self) -> tuple[Array, Array]:
        """Hessian (n, n) and gradient (n,) at zero of half the cost."""
        n = self.instant.size
        hessian, gradient = np.zeros((n, n)), np.zeros(n)
        diagonal = hessian.reshape(-1)[:: n + 1]
        diagonal += REGULARISATION
        blocks: dict[tuple[int, int], list[Rows]] = {}
        for rows in self.rows.values():
            if isinstance(rows, Direct):
                diagonal[rows.columns] += rows.weight
                gradient[rows.columns] -= rows.weight * rows.target
            else:
                blocks.setdefault(rows.columns.indices(n)[:2], []).append(rows)
        for (first, end), block in blocks.items():
            root = np.sqrt(np.concatenate([r.weight for r in block]))
            matrix = np.concatenate([r.matrix for r in block]) * root[:, None]
            target = np.concatenate([r.target for r in block]) * root
            hessian[first:end, first:end] += matrix.T @ matrix
            gradient[first:end] -= target @ matrix
        return hessian, gradient

    @cached_property
    def programme(self) -> Programme:
        """The same as matrices."""
        return self._written(self._of(Limits))

    @cached_property
    def relaxed(self) -> Programme:
        """The programme without its two-sided rows, which seldom bind."""
        return self._written([]) if self._of(Limits) else self.programme

    def _written(self, sided: Sequence[Limits]) -> Programme:
        n, equal = self.instant.size, self._of(Equality)
        low, high = np.full(n, -np.inf), np.full(n, np.inf)
        for bounds in self._of(Bounds):
            np.maximum(low, bounds.low, out=low)
            np.minimum(high, bounds.high, out=high)
        targets = [e.target for e in equal]
        matrices = [np.empty((0, n)), *(e.matrix for e in equal), *(s.matrix for s in sided)]
        return Programme(
            *self.cost,
            np.concatenate(matrices),
            np.concatenate([low, *targets, *(s.low for s in sided)]),
            np.concatenate([high, *targets, *(s.high for s in sided)]),
            sum(len(target) for target in targets),
        )

    def _of(self, kind: type[_Kind]) -> list[_Kind]:
        return [limit for limit in self.limits.values() if isinstance(limit, kind)]

    def solve(self) -> Array | None:
        """The unknowns (n,), or None where the constraints leave no solution.

        The two-sided rows are left out at first. A solution that keeps them all the same is the
        best of a larger set and so the best of the smaller one; where it doesn't, they are put in
        and the whole is solved. What a solver returns is believed only after a look at all
        constraints.
        """
        unknowns = self.relaxed.solve()
        if unknowns is not None and any(_outside(s, unknowns) > 0.0 for s in self._of(Limits)):
            unknowns = self.programme.solve()
        if unknowns is None or self.violation(unknowns) >= TOLERANCE:
            return None
        return unknowns

    def violation(self, unknowns: Array) -> float:
        """The largest amount by which any constraint is broken: N, N m, rad/s^2."""
        return max((_outside(limit, unknowns) for limit in self.limits.values()), default=0.0)

    def errors(self, unknowns: Array) -> dict[str, Array]:
        """What each task is left with, A x - b, in its own unit."""
        return {name: rows.error(unknowns) for name, rows in self.rows.items()}


def _outside(limit: Equality | Limits | Bounds, unknowns: Array) -> float:
    """The largest amount by which one constraint is broken, 0 if by none."""
    if isinstance(limit, Equality):
        outside = np.abs(limit.matrix @ unknowns - limit.target)
    else:
        value = unknowns if isinstance(limit, Bounds) else limit.matrix @ unknowns
        outside = np.maximum(limit.low - value, value - limit.high)
    return float(outside.max(initial=0.0))
