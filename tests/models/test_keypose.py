"""The key-pose solver: what it certifies is so, and what is not so it does not certify."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import mujoco
import numpy as np
import pytest

from enpointe.models import (
    Figure,
    KeyPose,
    KeyPoseSolver,
    PoseTarget,
    dancer_model,
    pose_target,
)
from enpointe.models.seed import differential_ik
from enpointe.notation import Side
from enpointe.notation.vocabulary import ARMS, FEET

from .posing import (
    DANCERS,
    SHIPPED,
    at,
    check_in_mujoco,
    contact_pairs,
    mirrored_frame,
    mirrored_qpos,
    shipped,
    solver_of,
    tangent,
    written,
)

every_shipped_pose = pytest.mark.parametrize(
    ("name", "index"), SHIPPED, ids=[f"{name} {index}" for name, index in SHIPPED]
)


@pytest.fixture(scope="module")
def pose(solver: KeyPoseSolver) -> Callable[[str, int], KeyPose]:
    """Shipped key poses, each solved once."""
    solved: dict[tuple[str, int], KeyPose] = {}

    def get(name: str, index: int) -> KeyPose:
        if (name, index) not in solved:
            target = pose_target(shipped(name, index), solver.figure)
            solved[name, index] = solver.solve(target)
        return solved[name, index]

    return get


@every_shipped_pose
def test_every_shipped_pose_is_certified_and_so_in_mujoco(
    name: str, index: int, pose: Callable[[str, int], KeyPose], model: mujoco.MjModel
) -> None:
    found = pose(name, index)
    assert found.held, str(found.certificate)
    assert found.certificate.broken == ()
    assert str(found.certificate) == f"all {len(found.certificate.results)} rules held"
    check_in_mujoco(model, found)


@every_shipped_pose
def test_no_shipped_pose_passes_through_itself(
    name: str, index: int, pose: Callable[[str, int], KeyPose], model: mujoco.MjModel
) -> None:
    """Limbs overlap by 2 mm at most."""
    data = at(model, pose(name, index).qpos)
    limbs = [pair for pair in contact_pairs(model, data) if "floor" not in pair[:2]]
    assert [pair for pair in limbs if pair[2] < -2e-3] == []


@pytest.mark.parametrize("dancer", ["tall man", "small woman"])
@every_shipped_pose
def test_other_dancers_take_every_shipped_pose(name: str, index: int, dancer: str) -> None:
    model = dancer_model(DANCERS[dancer])
    solver = solver_of(dancer)
    found = solver.solve(pose_target(shipped(name, index), solver.figure))
    assert found.held, str(found.certificate)
    check_in_mujoco(model, found)


def test_every_named_position_can_be_taken(solver: KeyPoseSolver, model: mujoco.MjModel) -> None:
    """All arms over first position, all feet under fifth en bas, either side leading."""
    feet = [
        f"feet: {entry.name}" + (f" {side} front" if entry.crossed else "")
        for entry in FEET
        for side in (Side if entry.crossed else (None,))
    ]
    arms = [
        f"arms: {entry.name}" + (f" {side} leads" if entry.needs_leading else "")
        for entry in ARMS
        for side in (Side if entry.needs_leading else (None,))
    ]
    wanted = [("feet: first", line) for line in arms] + [
        (line, "arms: fifth en bas") for line in feet
    ]
    for lines in wanted:
        found = solver.solve(pose_target(written(*lines), solver.figure))
        assert found.held, f"{lines}: {found.certificate}"
        check_in_mujoco(model, found)


@every_shipped_pose
def test_the_mirrored_score_gives_the_mirrored_pose(
    name: str,
    index: int,
    pose: Callable[[str, int], KeyPose],
    solver: KeyPoseSolver,
    model: mujoco.MjModel,
) -> None:
    found = pose(name, index)
    frame = mirrored_frame(shipped(name, index))
    image = solver.solve(pose_target(frame, solver.figure))
    assert image.held
    assert np.allclose(image.qpos, mirrored_qpos(model, found.qpos), atol=2e-3)


@every_shipped_pose
def test_a_guess_near_by_leads_to_the_same_pose(
    name: str, index: int, pose: Callable[[str, int], KeyPose], solver: KeyPoseSolver
) -> None:
    """From the solution itself, shaken by some 3 degrees in every joint."""
    cold = pose(name, index)
    rng = np.random.default_rng(index)
    shaken = np.array(cold.qpos)
    shaken[7:] += rng.normal(scale=0.05, size=len(shaken) - 7)
    for guess in (cold.qpos, shaken):
        warm = solver.solve(cold.target, guess=guess)
        assert warm.held, str(warm.certificate)
        assert np.allclose(warm.qpos, cold.qpos, atol=2e-3)


@pytest.mark.parametrize(
    ("name", "index"),
    [pytest.param(name, index, id=f"{name} {index}") for name, index in SHIPPED if index > 0],
)
def test_the_pose_before_leads_to_the_same_pose(
    name: str, index: int, pose: Callable[[str, int], KeyPose], solver: KeyPoseSolver
) -> None:
    """`solve` names the pose before as a guess: legal poses stay legal, arms keep their fold."""
    cold = pose(name, index)
    warm = solver.solve(cold.target, guess=pose(name, index - 1).qpos)
    assert warm.held, str(warm.certificate)
    assert np.allclose(warm.qpos, cold.qpos, atol=2e-3)


def test_the_same_target_gives_the_same_pose_bit_for_bit(solver: KeyPoseSolver) -> None:
    target = pose_target(shipped("third-port-de-bras", 2), solver.figure)
    again = KeyPoseSolver(solver.model)
    assert np.array_equal(solver.solve(target).qpos, again.solve(target).qpos)


def test_the_seed_stays_inside_the_joint_ranges(model: mujoco.MjModel, figure: Figure) -> None:
    low, high = model.jnt_range[1:].T
    for name, index in SHIPPED[:6]:
        seed = differential_ik(model, pose_target(shipped(name, index), figure))
        assert (seed[7:] >= low - 1e-6).all()
        assert (seed[7:] <= high + 1e-6).all()


def broken_by(
    solver: KeyPoseSolver, found: KeyPose, change: Callable[[np.ndarray], None]
) -> dict[str, tuple[float, str]]:
    """Rules that break when the pose's unknowns are changed: measure and unit by rule."""
    problem = solver.problem(found.target)
    unknowns = tangent(found.qpos)
    change(unknowns)
    certificate = problem.certify(unknowns, problem.parameters(found.target))
    assert certificate.held is (certificate.broken == ())
    return {result.rule: (result.value, result.unit) for result in certificate.broken}


@pytest.mark.parametrize(
    ("joint", "degrees", "rule", "unit", "size"),
    [
        ("neck_turn", 7.0, "head as written", "deg", 7.0),
        ("neck_bend", -4.0, "head as written", "deg", 4.0),
        ("waist_tilt", 6.0, "body as written", "deg", 6.0),
        ("left_wrist_bend", 5.0, "left line of the wrist", "deg", 5.0),
        ("right_wrist_cross", -5.0, "right line of the wrist", "deg", 5.0),
        ("right_forearm_turn", -9.0, "right palm along the curve", "deg", 9.0),
        ("left_elbow_bend", 8.0, "left rounded elbow", "deg", 8.0),
        ("left_toe_raise", 10.0, "left flat foot", "deg", 10.0),
        ("right_knee_bend", 12.0, "right straight knee", "deg", 12.0),
        ("left_ankle_turn", -6.0, "left turnout of the foot", "deg", 6.0),
        ("left_ankle_turn", -6.0, "feet turned out alike", "deg", 6.0),
    ],
)
def test_a_joint_out_of_place_breaks_its_rule_by_as_much(
    joint: str,
    degrees: float,
    rule: str,
    unit: str,
    size: float,
    pose: Callable[[str, int], KeyPose],
    solver: KeyPoseSolver,
) -> None:
    dof = solver.model.joint(joint).dofadr[0]

    def bend(unknowns: np.ndarray) -> None:
        unknowns[dof] += np.radians(degrees)

    broken = broken_by(solver, pose("first-port-de-bras", 2), bend)
    assert rule in broken
    value, found_unit = broken[rule]
    assert found_unit == unit
    assert value == pytest.approx(size, abs=0.15)


def test_a_pose_moved_aside_is_off_its_mark_and_out_of_balance(
    pose: Callable[[str, int], KeyPose], solver: KeyPoseSolver
) -> None:
    """Half a metre to the front: every mark is missed by 500 mm, and the CoM leaves the hull."""

    def move(unknowns: np.ndarray) -> None:
        unknowns[0] += 0.5

    found = pose("first-port-de-bras", 0)
    broken = broken_by(solver, found, move)
    assert set(broken) == {
        "left foot on its mark",
        "right foot on its mark",
        "centre of mass over the support",
        "weight in the middle",
    }
    assert broken["left foot on its mark"] == (pytest.approx(500, abs=0.5), "mm")
    margin, unit = broken["centre of mass over the support"]
    assert unit == "mm"
    assert margin < -300  # the hull is not much deeper than 200 mm


def test_a_pose_that_leans_is_not_flat_on_its_feet(
    pose: Callable[[str, int], KeyPose], solver: KeyPoseSolver
) -> None:
    def lean(unknowns: np.ndarray) -> None:
        unknowns[3:6] = [0.0, np.radians(8), 0.0]

    broken = broken_by(solver, pose("first-port-de-bras", 0), lean)
    assert {"left flat foot", "right flat foot", "pelvis as written"} <= set(broken)
    assert broken["pelvis as written"][0] == pytest.approx(8, abs=0.2)


def test_a_certificate_says_where_each_rule_is_written(
    pose: Callable[[str, int], KeyPose],
) -> None:
    for result in pose("first-port-de-bras", 1).certificate.results:
        assert result.source
        assert result.unit in ("mm", "deg")
        assert np.isfinite(result.value)


def test_a_broken_certificate_reads_as_one_line(solver: KeyPoseSolver) -> None:
    target = beyond_reach(pose_target(written("feet: first", "arms: first"), solver.figure))
    text = str(solver.solve(target).certificate)
    assert "left hand on its sign" in text
    assert "\n" not in text


def beyond_reach(target: PoseTarget) -> PoseTarget:
    """The same target with the left wrist twice as far from the shoulder."""
    left = target.arms[Side.LEFT]
    far = replace(left, wrist=left.shoulder + 2 * (left.wrist - left.shoulder))
    return replace(target, arms={**target.arms, Side.LEFT: far})


def out_of_balance(target: PoseTarget) -> PoseTarget:
    """The same feet, but the support said to be two metres in front of them."""
    return replace(target, support=target.support + np.array([2.0, 0.0]))


def on_feet_too_far_apart(target: PoseTarget) -> PoseTarget:
    """Feet two metres apart on straight legs."""
    legs = {}
    for side, leg in target.legs.items():
        assert leg.footprint is not None
        step = np.array([0.0, 1.0 if side is Side.LEFT else -1.0])
        legs[side] = replace(
            leg, footprint=replace(leg.footprint, ankle=leg.footprint.ankle + step)
        )
    return replace(target, legs=legs)


def owl(target: PoseTarget) -> PoseTarget:
    """The head turned round by 150 degrees."""
    return replace(target, head=np.radians([150.0, 0, 0]))


@pytest.mark.parametrize(
    ("spoil", "rules"),
    [
        (beyond_reach, ("left hand on its sign",)),
        (out_of_balance, ("centre of mass over the support", "left foot on its mark")),
        (on_feet_too_far_apart, ("left foot on its mark", "right foot on its mark")),
        (owl, ("head as written",)),
    ],
)
def test_an_impossible_pose_is_not_claimed(
    spoil: Callable[[PoseTarget], PoseTarget], rules: tuple[str, ...], solver: KeyPoseSolver
) -> None:
    """It says so and names one of the rules that can't be kept together."""
    target = pose_target(written("feet: first", "arms: à la seconde"), solver.figure)
    found = solver.solve(spoil(target))
    assert not found.held
    assert {result.rule for result in found.certificate.broken} & set(rules), found.certificate
    assert np.isfinite(found.qpos).all()
