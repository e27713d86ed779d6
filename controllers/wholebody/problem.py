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
import qpsolvers
from numpy.typing import NDArray

from enpointe.controllers.wholebody.constraints import Bounds, Constraint, Equality, Limits
from enpointe.controllers.wholebody.goal import Goal
from enpointe.controllers.wholebody.instant import Instant
from enpointe.controllers.wholebody.tasks import Rows, Task

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
    rows: Mapping[str, Rows]
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
    def programme(self) -> qpsolvers.Problem:
        """The same as matrices P, q, G, h, A, b, lb, ub of  min x'Px/2 + q'x."""
        n = self.instant.size
        matrix = np.vstack([r.matrix for r in self.rows.values()])
        target = np.concatenate([r.target for r in self.rows.values()])
        weighted = matrix * np.concatenate([r.weight for r in self.rows.values()])[:, None]
        hessian = weighted.T @ matrix
        hessian[np.arange(n), np.arange(n)] += REGULARISATION
        low, high = np.full(n, -np.inf), np.full(n, np.inf)
        for bounds in self._of(Bounds):
            np.maximum(low, bounds.low, out=low)
            np.minimum(high, bounds.high, out=high)
        sided, equal = self._of(Limits), self._of(Equality)
        return qpsolvers.Problem(
            hessian,
            -(target @ weighted),
            np.vstack([np.vstack([s.matrix, -s.matrix]) for s in sided]) if sided else None,
            np.concatenate([np.concatenate([s.high, -s.low]) for s in sided]) if sided else None,
            np.vstack([e.matrix for e in equal]) if equal else None,
            np.concatenate([e.target for e in equal]) if equal else None,
            low,
            high,
        )

    def _of(self, kind: type[_Kind]) -> list[_Kind]:
        return [limit for limit in self.limits.values() if isinstance(limit, kind)]

    def solve(self, solver: str = "daqp") -> Array | None:
        """The unknowns (n,), or None where the constraints leave no solution.

        What a solver returns is believed only after a look at its constraints.
        """
        solution = qpsolvers.solve_problem(self.programme, solver)
        if not solution.found or solution.x is None or not np.all(np.isfinite(solution.x)):
            return None
        unknowns = np.asarray(solution.x)
        return unknowns if self.violation(unknowns) < TOLERANCE else None

    def violation(self, unknowns: Array) -> float:
        """The largest amount by which any constraint is broken: N, N m, rad/s^2."""
        worst = 0.0
        for limit in self.limits.values():
            if isinstance(limit, Bounds):
                low, high, value = limit.low, limit.high, unknowns
            else:
                value = limit.matrix @ unknowns
                low, high = (
                    (limit.target, limit.target)
                    if isinstance(limit, Equality)
                    else (limit.low, limit.high)
                )
            outside = np.maximum(low - value, value - high)
            worst = max(worst, float(outside.max(initial=0.0)))
        return worst

    def errors(self, unknowns: Array) -> dict[str, Array]:
        """What each task is left with, A x - b, in its own unit."""
        return {name: r.matrix @ unknowns - r.target for name, r in self.rows.items()}
