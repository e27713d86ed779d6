"""The key-pose solver: rules as one constrained problem, seeded, polished and certified.

The problem is built before it is solved, once for each structure of a pose (which feet stand, how
the arms are shaped), with the numbers of the target as parameters:

    minimise    sum_i w_i |r_i(q, p)|^2            over the rules that a dancer prefers to keep
    subject to  r_j(q, p) = 0                      over the rules that a dancer must keep
                r_k(q, p) >= bound_k
                q_min <= q <= q_max

in the root's position and rotation vector and the hinge angles (nv unknowns).
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from time import perf_counter
from typing import Any

import casadi as ca
import mujoco
import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from enpointe.errors import PoseError
from enpointe.models.certificate import Certificate, RuleResult
from enpointe.models.cheats import cheats_of
from enpointe.models.figure import Figure
from enpointe.models.kinematics import SymbolicBody, qpos_from_tangent
from enpointe.models.rules import Kind, Rule, Symbols, rules_for
from enpointe.models.seed import differential_ik
from enpointe.models.target import PoseTarget

__all__ = ["KeyPose", "KeyPoseSolver", "PoseProblem"]

_RANGE_MARGIN = np.radians(0.5)
_POSTURE_WEIGHT = 1e-3
_CONTINUITY = 0.1
"""What a pose costs more for each rad^2 that its hinges are from the guess. Another fold of the
limbs, a few rad away in some joints, has to be better by about what 10 degrees of pelvis cost."""
_NEAR = 0.6
"""A pose none of whose hinges is farther from the guess than this is on the same fold, rad."""
_IPOPT: dict[str, Any] = {
    "ipopt.print_level": 0,
    "ipopt.sb": "yes",
    "ipopt.max_iter": 200,
    "ipopt.tol": 1e-7,
    "ipopt.constr_viol_tol": 1e-8,
    "ipopt.mu_init": 1e-3,
    "ipopt.bound_push": 1e-6,
    "ipopt.bound_frac": 1e-6,
    "print_time": False,
    "error_on_fail": False,
}


@dataclass(frozen=True, slots=True)
class KeyPose:
    """One solved pose.

    Attributes:
        name: Of the target.
        qpos: (nq,), the dancer facing x.
        certificate: Each rule, held or broken.
        target: What was asked.
        iterations: Of the interior-point method.
        solve_ms: Wall time of seed and solution, of every attempt.
    """

    name: str
    qpos: NDArray[np.float64]
    certificate: Certificate
    target: PoseTarget
    iterations: int
    solve_ms: float = 0.0

    @property
    def held(self) -> bool:
        """Whether every rule holds."""
        return self.certificate.held


class PoseProblem:
    """The nonlinear programme of one structure of poses, to be looked at or solved.

    Attributes:
        rules: In the order of the certificate.
        unknowns: Symbols of root position, root rotation vector and hinge angles, (nv, 1).
        cost: Scalar expression.
        equalities: (ne, 1), zero at a solution.
        margins: (ni, 1), at least `margin_bounds` at a solution.
    """

    def __init__(self, model: mujoco.MjModel, rules: tuple[Rule, ...]) -> None:
        self.rules = rules
        self.symbols = Symbols()
        self.unknowns = ca.SX.sym("x", model.nv)
        facing = self.symbols("facing")
        body = SymbolicBody(model, qpos_from_tangent(model, self.unknowns, facing))
        residuals = {rule.label: rule.residual(body, self.symbols) for rule in rules}
        self.cost = _POSTURE_WEIGHT * ca.sumsqr(self.unknowns[6:])
        equalities: list[ca.SX] = []
        margins: list[ca.SX] = []
        bounds: list[float] = []
        for rule in rules:
            residual = residuals[rule.label]
            if rule.kind is Kind.EQUAL:
                equalities.append(residual)
            elif rule.kind is Kind.AT_LEAST:
                margins.append(residual)
                bounds += [rule.bound / rule.per_unit] * residual.numel()
            elif rule.kind is Kind.PREFER:
                self.cost += rule.weight * ca.sumsqr(residual)
        self.equalities = ca.vertcat(*equalities)
        self.margins = ca.vertcat(*margins)
        self.margin_bounds = np.array(bounds)
        parameters = self.symbols.vector
        self._measure = ca.Function(
            "rules", [self.unknowns, parameters], [ca.vertcat(*residuals.values())]
        )
        self._cost = ca.Function("cost", [self.unknowns, parameters], [self.cost])
        self._slices = _slices([r.numel() for r in residuals.values()])
        problem: dict[str, ca.SX] = {
            "x": self.unknowns,
            "p": parameters,
            "f": self.cost,
            "g": ca.vertcat(self.equalities, self.margins),
        }
        self._solver = ca.nlpsol("key_pose", "ipopt", problem, _IPOPT)

    def parameters(self, target: PoseTarget) -> NDArray[np.float64]:
        """The numbers of `target` in the problem's order, (P,)."""
        values: dict[str, NDArray[np.float64]] = {"facing": np.array(target.facing)}
        for rule in self.rules:
            values |= rule.values(target)
        return self.symbols.fill(values)

    def solve(
        self,
        guess: NDArray[np.float64],
        parameters: NDArray[np.float64],
        lower: NDArray[np.float64],
        upper: NDArray[np.float64],
    ) -> tuple[NDArray[np.float64], int]:
        """Polish a guess (nv,); returns the unknowns (nv,) and the number of iterations."""
        zeros = np.zeros(self.equalities.numel())
        solution = self._solver(
            x0=np.clip(guess, lower, upper),
            p=parameters,
            lbx=lower,
            ubx=upper,
            lbg=np.concatenate([zeros, self.margin_bounds]),
            ubg=np.concatenate([zeros, np.full(self.margins.numel(), np.inf)]),
        )
        return np.asarray(solution["x"]).ravel(), int(self._solver.stats()["iter_count"])

    def cost_at(self, unknowns: NDArray[np.float64], parameters: NDArray[np.float64]) -> float:
        """What the rules that she prefers to keep cost at a solution."""
        return float(self._cost(unknowns, parameters))

    def certify(
        self, unknowns: NDArray[np.float64], parameters: NDArray[np.float64]
    ) -> Certificate:
        """Measure every rule at a solution, whatever the solver said of itself."""
        residual = np.asarray(self._measure(unknowns, parameters)).ravel()
        results = [
            _result(rule, residual[part])
            for rule, part in zip(self.rules, self._slices, strict=True)
        ]
        return Certificate(tuple(results))

    def certify_each(
        self, unknowns: NDArray[np.float64], parameters: NDArray[np.float64]
    ) -> list[Certificate]:
        """Measure every rule at many poses at once: unknowns (N, nv) and parameters (N, P)."""
        residuals = np.asarray(self._measure(unknowns.T, parameters.T)).T
        parts = list(zip(self.rules, self._slices, strict=True))
        return [
            Certificate(tuple(_result(rule, residual[part]) for rule, part in parts))
            for residual in residuals
        ]


class KeyPoseSolver:
    """Solves poses of one dancer; compiled problems are kept for poses of the same structure.

    Example:
        >>> from enpointe.models import KeyPoseSolver, dancer_model, pose_target
        >>> from enpointe.notation import load_score
        >>> solver = KeyPoseSolver(dancer_model())
        >>> frame = load_score("first-port-de-bras").resolved()[0]
        >>> solver.solve(pose_target(frame, solver.figure)).held
        True
    """

    def __init__(self, model: mujoco.MjModel) -> None:
        self.model = model
        self.figure = Figure.of(model)
        self._problems: dict[object, PoseProblem] = {}
        self._lower, self._upper = _bounds(model)

    def problem(self, target: PoseTarget) -> PoseProblem:
        """The problem that a target of this structure poses."""
        key = target.structure
        if key not in self._problems:
            self._problems[key] = PoseProblem(self.model, rules_for(target))
        return self._problems[key]

    def solve(self, target: PoseTarget, guess: NDArray[np.float64] | None = None) -> KeyPose:
        """Solve one pose.

        Args:
            target: What the score asks.
            guess: A configuration (nq,) nearby, such as the pose before. Without one differential
                IK leads there from standing. Where the pose found from a guess is
                illegal, or breaks a rule far away from it, differential IK from the guess and from
                standing are tried as well, and of the legal poses the one is taken that is cheapest
                and nearest to the guess.

        Returns:
            The pose and its certificate, which says itself whether the rules hold.

        Raises:
            PoseError: The solver produced no finite pose.
        """
        self.problem(target)
        start = perf_counter()
        found = self._found(target, guess)
        return replace(found, solve_ms=1e3 * (perf_counter() - start))

    def _found(self, target: PoseTarget, guess: NDArray[np.float64] | None) -> KeyPose:
        if guess is None:
            return self._solve_from(target, differential_ik(self.model, target))
        tried: list[KeyPose] = []
        for seed in self._seeds(target, guess):
            found = self._solve_from(target, seed)
            tried.append(found)
            near = float(np.abs(found.qpos[7:] - guess[7:]).max()) < _NEAR
            if found.held or (near and found.certificate.legal):
                break
        return min(tried, key=lambda pose: self._merit(pose, guess))

    def _seeds(
        self, target: PoseTarget, guess: NDArray[np.float64]
    ) -> Iterator[NDArray[np.float64]]:
        """The guess, where differential IK leads from it, and where it leads from standing."""
        yield guess
        yield differential_ik(self.model, target, start=guess)
        yield differential_ik(self.model, target)

    def _merit(self, pose: KeyPose, guess: NDArray[np.float64]) -> tuple[bool, float]:
        """Less is better: legal before illegal, then cheap and near the guess."""
        problem = self.problem(pose.target)
        unknowns = _tangent(pose.qpos, pose.target.facing)
        away = float(np.sum((pose.qpos[7:] - guess[7:]) ** 2))
        cost = problem.cost_at(unknowns, problem.parameters(pose.target))
        return not pose.certificate.legal, cost + _CONTINUITY * away

    def certify(
        self, targets: Sequence[PoseTarget], qpos: NDArray[np.float64]
    ) -> tuple[Certificate, ...]:
        """Measure the rules at configurations (N, nq), each against its own target."""
        found: dict[int, Certificate] = {}
        alike: dict[object, list[int]] = {}
        for index, target in enumerate(targets):
            alike.setdefault(target.structure, []).append(index)
        for indices in alike.values():
            problem = self.problem(targets[indices[0]])
            unknowns = np.array([_tangent(qpos[i], targets[i].facing) for i in indices])
            parameters = np.array([problem.parameters(targets[i]) for i in indices])
            certificates = problem.certify_each(unknowns, parameters)
            found |= dict(zip(indices, certificates, strict=True))
        return tuple(found[i] for i in range(len(targets)))

    def _solve_from(self, target: PoseTarget, seed: NDArray[np.float64]) -> KeyPose:
        problem = self.problem(target)
        parameters = problem.parameters(target)
        unknowns, iterations = problem.solve(
            _tangent(seed, target.facing), parameters, self._lower, self._upper
        )
        if not np.all(np.isfinite(unknowns)):
            raise PoseError(
                f"{target.name}: no pose was found; the signs may contradict each other"
            )
        qpos = _qpos(unknowns, target.facing)
        certificate = problem.certify(unknowns, parameters)
        if target.real:
            certificate = replace(certificate, cheats=cheats_of(self.model, qpos, target))
        return KeyPose(
            name=target.name,
            qpos=qpos,
            certificate=certificate,
            target=target,
            iterations=iterations,
        )


def _bounds(model: mujoco.MjModel) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    ranges = model.jnt_range[1:]
    lower = np.concatenate([[-20.0, -20.0, 0.0], np.full(3, -np.pi), ranges[:, 0] + _RANGE_MARGIN])
    upper = np.concatenate([[20.0, 20.0, 4.0], np.full(3, np.pi), ranges[:, 1] - _RANGE_MARGIN])
    return lower, upper


def _tangent(qpos: NDArray[np.float64], facing: float) -> NDArray[np.float64]:
    upright = Rotation.from_euler("z", facing)
    rotation = (upright.inv() * Rotation.from_quat(qpos[3:7], scalar_first=True)).as_rotvec()
    return np.concatenate([qpos[:3], rotation, qpos[7:]])


def _qpos(unknowns: NDArray[np.float64], facing: float) -> NDArray[np.float64]:
    rotation = Rotation.from_euler("z", facing) * Rotation.from_rotvec(unknowns[3:6])
    quaternion = rotation.as_quat(canonical=True, scalar_first=True)
    return np.concatenate([unknowns[:3], quaternion, unknowns[6:]])


def _slices(lengths: list[int]) -> list[slice]:
    ends = np.cumsum(lengths)
    return [slice(int(end) - n, int(end)) for end, n in zip(ends, lengths, strict=True)]


def _result(rule: Rule, residual: NDArray[np.float64]) -> RuleResult:
    scaled = residual * rule.per_unit
    if rule.kind.is_margin:
        value = float(scaled.min())
        held = value >= rule.bound - 1e-3
    else:
        value = float(np.abs(scaled).max())
        held = value <= rule.bound
    return RuleResult(
        rule.label,
        value,
        rule.unit,
        rule.bound,
        bool(held),
        rule.source,
        at_least=rule.kind.is_margin,
        must=rule.kind.is_constraint,
    )
