"""The programme written in blocks is the plain dense one, and so is its solution."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar

import mujoco
import numpy as np
import pytest
import qpsolvers
from numpy.typing import NDArray

from enpointe.controllers.wholebody.constraints import TorqueLimits
from enpointe.controllers.wholebody.controller import DEFAULT_TASKS
from enpointe.controllers.wholebody.goal import Goal
from enpointe.controllers.wholebody.instant import Instant
from enpointe.controllers.wholebody.problem import REGULARISATION, WholeBodyProblem
from enpointe.controllers.wholebody.rows import Bounds, Direct, Equality, Limits, Rows

from .wholebody_cases import FIRST, MODEL, RETIRE, RETIRE_DEMI, driver, observed, shaken, state

Array = NDArray[np.float64]
WEAK = TorqueLimits(0.15 * MODEL.actuator_forcerange[:, 1])


@dataclass(frozen=True)
class Mixed:
    """A wish for accelerations and forces at once, which no block holds."""

    name: ClassVar[str] = "mixed"

    def rows(self, instant: Instant, goal: Goal) -> Rows:
        mixing = np.random.default_rng(7).normal(size=(4, instant.size))
        return Rows(mixing, np.arange(4.0), np.array([0.1, 0.2, 0.3, 0.4]))


def full(rows: Rows | Direct, size: int) -> tuple[Array, Array, Array]:
    """A task's rows over all unknowns, their targets and weights."""
    if isinstance(rows, Direct):
        return np.eye(size)[rows.columns], rows.target, rows.weight
    matrix = np.zeros((len(rows.target), size))
    if len(matrix):
        matrix[:, rows.columns] = rows.matrix
    return matrix, rows.target, rows.weight


def plain(problem: WholeBodyProblem) -> qpsolvers.Problem:
    """Every row of every task and constraint, stacked as they are."""
    n = problem.instant.size
    tasks = [full(rows, n) for rows in problem.rows.values()]
    matrix, target, weight = (np.concatenate(part) for part in zip(*tasks, strict=True))
    hessian = matrix.T @ np.diag(weight) @ matrix + REGULARISATION * np.eye(n)
    low, high = np.full(n, -np.inf), np.full(n, np.inf)
    above, most, equal, exact = [], [], [], []
    for limit in problem.limits.values():
        match limit:
            case Bounds():
                here = limit.columns
                low[here] = np.maximum(low[here], limit.low)
                high[here] = np.minimum(high[here], limit.high)
            case Limits():
                above += [limit.matrix, -limit.matrix]
                most += [limit.high, -limit.low]
            case Equality():
                equal.append(limit.matrix)
                exact.append(limit.target)
    gradient = -matrix.T @ (weight * target)
    rows = (np.vstack(above), np.concatenate(most), np.vstack(equal), np.concatenate(exact))
    return qpsolvers.Problem(hessian, gradient, *rows, low, high)


def problem_at(
    pose: str, seed: int, *, speed: float = 0.1, lift: float = 0.0, weak: bool = False
) -> WholeBodyProblem:
    controller = driver(pose)
    if weak:
        controller.constraints = tuple(
            WEAK if isinstance(c, TorqueLimits) else c for c in controller.constraints
        )
    qpos, qvel = shaken(pose, seed, angle=0.003, speed=speed)
    qpos[2] += lift
    controller.reset(state(qpos, qvel))
    return controller.build(0.0, state(qpos, qvel))


CASES: dict[str, dict[str, Any]] = {
    "two feet": {"pose": FIRST, "seed": 3},
    "one foot": {"pose": RETIRE, "seed": 4},
    "demi-pointe": {"pose": RETIRE_DEMI, "seed": 5},
    "in the air": {"pose": FIRST, "seed": 6, "lift": 0.3},
    "fast": {"pose": RETIRE, "seed": 8, "speed": 1.5},
    "weak": {"pose": RETIRE, "seed": 9, "weak": True},
}
every_case = pytest.mark.parametrize("name", CASES)


@every_case
def test_the_cost_is_that_of_the_stacked_rows(name: str) -> None:
    problem = problem_at(**CASES[name])
    dense = plain(problem)
    scale = np.abs(dense.P).max()
    np.testing.assert_allclose(problem.programme.hessian, dense.P, atol=1e-13 * scale)
    size = np.abs(dense.q).max()
    np.testing.assert_allclose(problem.programme.gradient, dense.q, atol=1e-13 * size)


@every_case
def test_the_solution_is_that_of_the_plain_programme(name: str) -> None:
    """To what a solver leaves of its own: 1e-6 of the largest acceleration and force."""
    problem = problem_at(**CASES[name])
    dense = plain(problem)
    solution = qpsolvers.solve_problem(dense, "daqp")
    unknowns = problem.solve()
    assert solution.found
    assert solution.x is not None
    assert unknowns is not None
    for part in (problem.instant.accelerations, problem.instant.forces):
        tolerance = 1e-6 * max(1.0, np.abs(solution.x[part]).max(initial=0.0))
        np.testing.assert_allclose(unknowns[part], solution.x[part], atol=tolerance)


def test_the_cases_meet_limits_and_do_without() -> None:
    """What is left out at first really binds in some of the cases above, and not in others."""

    def binds(problem: WholeBodyProblem) -> bool:
        unknowns = problem.solve()
        assert unknowns is not None
        torque = problem.limits["torque limits"]
        assert isinstance(torque, Limits)
        given, nv = torque.matrix @ unknowns, problem.instant.nv
        low, high, _ = problem.bounds
        slack = min(
            np.min([given - torque.low, torque.high - given]),
            np.min([unknowns[:nv] - low[:nv], high[:nv] - unknowns[:nv]]),
        )
        return bool(slack < 1e-5)

    assert binds(problem_at(**CASES["fast"]))
    assert binds(problem_at(**CASES["weak"]))
    assert not binds(problem_at(**CASES["one foot"]))


def test_a_task_over_all_unknowns_is_solved_as_it_is() -> None:
    controller = driver(RETIRE)
    controller.tasks = (*DEFAULT_TASKS, Mixed())
    qpos, qvel = shaken(RETIRE, 1, angle=0.002, speed=0.05)
    controller.reset(state(qpos, qvel))
    problem = controller.build(0.0, state(qpos, qvel))
    assert problem.separate is None
    unknowns, solution = problem.solve(), qpsolvers.solve_problem(plain(problem), "daqp")
    assert solution.found
    assert solution.x is not None
    assert unknowns is not None
    np.testing.assert_allclose(unknowns, solution.x, atol=1e-6 * np.abs(solution.x).max())


@pytest.mark.parametrize("seed", range(3))
def test_a_state_is_placed_as_mujoco_places_it(seed: int) -> None:
    """The stages that are called one by one are those of mj_forward, without its collisions."""
    qpos, qvel = shaken(FIRST, seed, angle=0.2, speed=1.0)
    instant = observed(qpos, qvel).instant(np.arange(12))
    data = mujoco.MjData(MODEL)
    data.qpos[:], data.qvel[:] = qpos, qvel
    mujoco.mj_forward(MODEL, data)
    mass_matrix = np.zeros((MODEL.nv, MODEL.nv))
    mujoco.mj_fullM(MODEL, data, mass_matrix)
    np.testing.assert_allclose(instant.mass_matrix, mass_matrix, atol=1e-12)
    np.testing.assert_allclose(instant.bias, data.qfrc_bias - data.qfrc_passive, atol=1e-12)
    momentum = np.zeros((3, MODEL.nv))
    mujoco.mj_angmomMat(MODEL, data, momentum, 0)
    np.testing.assert_allclose(instant.angular_momentum, momentum @ qvel, atol=1e-12)
    np.testing.assert_allclose(instant.velocities, instant.jacobians @ qvel, atol=1e-12)
    spread = (instant.edges[:, None, :] @ instant.jacobians[instant.edge_point])[:, 0]
    np.testing.assert_allclose(instant.force_matrix.T, spread, atol=1e-12)
