"""Limbs that keep clear of each other: the rule's distances are those of MuJoCo's collision."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import casadi as ca
import mujoco
import numpy as np
import pytest

from enpointe.errors import ModelError
from enpointe.models import KeyPoseSolver, PoseTarget, dancer_model
from enpointe.models.kinematics import Capsule, SymbolicBody
from enpointe.models.leg_target import LEG_JOINTS, Passing
from enpointe.models.rules.clearance import ArmsClearOfLegs, ArmsClearOfTheBody, LegsApart, gap
from enpointe.notation import Side

from .posing import overlaps, random_qpos, solved, standing

MM = 1e-3
RULES = (LegsApart(), ArmsClearOfLegs(tuple(Side)), ArmsClearOfTheBody())
PAIRS = tuple(pair for rule in RULES for pair in rule.pairs)


@cache
def gaps() -> ca.Function:
    model = dancer_model(flesh=False)
    qpos = ca.SX.sym("qpos", model.nq)
    body = SymbolicBody(model, qpos)
    return ca.Function(
        "gaps", [qpos], [ca.vertcat(*(gap(body.capsule(a), body.capsule(b)) for a, b in PAIRS))]
    )


def in_mujoco(model: mujoco.MjModel, qpos: np.ndarray) -> np.ndarray:
    data = mujoco.MjData(model)
    data.qpos[:] = qpos
    mujoco.mj_kinematics(model, data)
    ids = [(model.geom(a).id, model.geom(b).id) for a, b in PAIRS]
    return np.array([mujoco.mj_geomDistance(model, data, a, b, 5.0, None) for a, b in ids])


def test_gaps_are_mujoco_s_distances(rng: np.random.Generator) -> None:
    """Never too short; too long by what rounding the ends costs, a millimetre in a thousand."""
    model = dancer_model(flesh=False)
    errors = []
    for _ in range(150):
        qpos = standing(model)
        qpos[7:] = rng.uniform() * random_qpos(model, rng)[7:]
        errors.append(np.asarray(gaps()(qpos)).ravel() - in_mujoco(model, qpos))
    assert np.min(errors) > -1e-6
    assert np.percentile(errors, 99.5) < 0.2 * MM
    assert np.max(errors) < 1.5 * MM


@pytest.mark.parametrize("angle", [0.0, 1e-4, 1e-2, np.pi / 2, np.pi])
@pytest.mark.parametrize("shift", [-0.6, -0.1, 0.0, 0.2, 0.5])
def test_parallel_and_crossing_axes_have_a_distance(angle: float, shift: float) -> None:
    """Two rods of 0.4 m, 0.1 m apart, one turned and slid along the other: sampled densely."""
    u = np.array([0.4, 0.0, 0.0])
    v = 0.4 * np.array([np.cos(angle), np.sin(angle), 0.0])
    base = np.array([shift, 0.0, 0.1])
    x = ca.SX.sym("x", 3)
    found = gap(Capsule(ca.SX.zeros(3), ca.SX(u), 0.0), Capsule(x, x + ca.SX(v), 0.0))
    shares = np.linspace(0, 1, 801)
    points = shares[:, None] * u, base + shares[:, None] * v
    exact = np.linalg.norm(points[0][:, None] - points[1][None], axis=2).min()
    value = float(ca.Function("g", [x], [found])(base))
    assert -1e-5 < value - exact < 0.5 * MM
    assert np.isfinite(np.asarray(ca.Function("h", [x], [ca.hessian(found, x)[0]])(base))).all()


def test_a_clearance_s_jacobian_holds_at_contact(rng: np.random.Generator) -> None:
    """Where limbs overlap, touch or lie along each other the slope is finite and right."""
    function = gaps()
    model = dancer_model(flesh=False)
    qpos = ca.SX.sym("qpos", model.nq)
    slope = ca.Function("J", [qpos], [ca.jacobian(function(qpos), qpos)])
    for scale in (0.0, 0.05, 0.3):
        point = standing(model)
        point[7:] += rng.normal(scale=scale, size=len(point) - 7)
        exact = np.asarray(slope(point))
        step = 1e-6
        for i in range(7, len(point)):
            ahead, behind = point.copy(), point.copy()
            ahead[i] += step
            behind[i] -= step
            numeric = np.asarray(function(ahead) - function(behind)).ravel() / (2 * step)
            assert np.allclose(exact[:, i], numeric, atol=2e-5)


def test_only_capsules_have_a_gap() -> None:
    model = dancer_model(flesh=False)
    body = SymbolicBody(model, ca.SX.sym("qpos", model.nq))
    with pytest.raises(ModelError, match="no capsule"):
        body.capsule("left_heel_inner")
    with pytest.raises(ModelError, match="no sphere"):
        body.lowest("left_foot_limb")


def crossed_in_passing(cross: float) -> PoseTarget:
    """A bent leg on its way through the thigh of the standing one, its hip crossed by `cross`."""
    target = solved("leg raised seconde 45").target
    passing = Passing(np.array([0.0, cross, 0.87, 0.6, 0.7, 0.0, 0.0, 0.0]))
    return replace(target, legs={**target.legs, Side.RIGHT: passing}, name="crossing")


@pytest.mark.parametrize("cross", [0.15, 0.2, 0.25])
def test_a_passing_leg_goes_round_the_other(cross: float, solver: KeyPoseSolver) -> None:
    """Its way leads through the standing leg; the pose stops at the skin, from either guess."""
    target = crossed_in_passing(cross)
    straight_through = solved("leg raised seconde 45").qpos.copy()
    passing = target.legs[Side.RIGHT]
    assert isinstance(passing, Passing)
    for name, angle in zip(LEG_JOINTS, passing.angles, strict=True):
        straight_through[solver.model.joint(f"right_{name}").qposadr[0]] = angle
    assert frozenset({"left_thigh", "right_thigh"}) in overlaps(solver.model, straight_through)
    for guess in (None, solved("leg raised seconde 45").qpos):
        found = solver.solve(target, guess)
        assert found.certificate.legal, str(found.certificate)
        assert overlaps(solver.model, found.qpos) == {}


def test_a_hand_written_into_the_thigh_is_not_certified(solver: KeyPoseSolver) -> None:
    """The certificate measures what is there: arms swung into the head break their rule."""
    found = solved("arms fifth en haut")
    problem = solver.problem(found.target)
    unknowns = np.concatenate([found.qpos[:3], np.zeros(3), found.qpos[7:]])
    for side in Side:
        dof = solver.model.joint(f"{side}_elbow_bend").dofadr[0]
        unknowns[dof] = np.radians(140)
    rules = {r.rule: r for r in problem.certify(unknowns, problem.parameters(found.target)).results}
    clear = rules["arms clear of the body"]
    assert not clear.held
    assert clear.value < -2
    assert (clear.unit, clear.at_least) == ("mm", True)
