"""Poses from what a score can write: orientations, raised legs, pliés, arabesques, elbows."""

from __future__ import annotations

from dataclasses import replace

import mujoco
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from enpointe.errors import ScoreError
from enpointe.models import Figure, KeyPoseSolver, dancer_model, pose_target
from enpointe.models.rules.stance import turn_tilt_bend
from enpointe.notation import ArmsPosition, Depth, FeetPosition, Orientation, Side, arm_signs
from enpointe.notation.vocabulary import ARMS, FEET

from .posing import (
    at,
    check_in_mujoco,
    in_frame,
    mirrored_frame,
    mirrored_qpos,
    rotation_between,
    solver_of,
    standing,
    support_margin,
    written,
)


@pytest.mark.parametrize("part", ["neck", "waist"])
@given(
    st.floats(-30, 30),
    st.floats(-25, 25),
    st.floats(-25, 25),
)
@settings(max_examples=25)
def test_turn_tilt_bend_is_the_rotation_in_mujoco(
    part: str, turn: float, tilt: float, bend: float
) -> None:
    """Eq. 4.9: q = q_turn q_tilt q_bend, + turn and tilt to the left, + bend forward."""
    model = dancer_model()
    outer, inner = ("torso", "head") if part == "neck" else ("pelvis", "torso")
    qpos = standing(model)
    for hinge, angle in (("turn", turn), ("tilt", tilt), ("bend", bend)):
        qpos[model.joint(f"{part}_{hinge}").qposadr[0]] = np.radians(angle)
    reached = rotation_between(at(model, qpos), outer, inner)
    about = [
        Rotation.from_euler(*pair, degrees=True)
        for pair in (("z", turn), ("x", -tilt), ("y", bend))
    ]
    wanted = about[0] * about[1] * about[2]
    assert (wanted.inv() * reached).magnitude() < 1e-9


@given(st.floats(-3, 3), st.floats(-3, 3), st.floats(-3, 3))
def test_the_pelvis_is_asked_for_turn_tilt_and_bend_in_that_order(
    turn: float, tilt: float, bend: float
) -> None:
    """Eq. 4.9 once more, as the pelvis' rule and its seed read it (rad)."""
    wanted = Rotation.from_euler("ZXY", [turn, -tilt, bend]).as_matrix()
    assert np.allclose(turn_tilt_bend(np.array([turn, tilt, bend])), wanted, atol=1e-12)


@given(st.floats(-35, 35), st.floats(-25, 25), st.floats(-20, 20))
@settings(max_examples=10)
def test_written_orientations_are_taken(turn: float, tilt: float, bend: float) -> None:
    """Head and body as written, in degrees, whatever the combination; the feet stay flat."""
    solver = solver_of("default")
    frame = replace(
        written("feet: second", "arms: à la seconde"),
        head=Orientation(turn, tilt, bend),
        body=Orientation(0.5 * turn, 0.5 * tilt, 0.5 * bend),
    )
    found = solver.solve(pose_target(frame, solver.figure))
    assert found.held, str(found.certificate)
    data = at(solver.model, found.qpos)
    for share, outer, inner in ((1.0, "torso", "head"), (0.5, "pelvis", "torso")):
        wanted = Rotation.from_euler(
            "ZXY", [share * turn, -share * tilt, share * bend], degrees=True
        )
        difference = (wanted.inv() * rotation_between(data, outer, inner)).magnitude()
        assert np.degrees(difference) < 1.0
    check_in_mujoco(solver.model, found)


def test_the_pelvis_is_turned_as_written(solver: KeyPoseSolver) -> None:
    lines = ("feet: second", "arms: à la seconde", "pelvis: bend forward 15")
    found = solver.solve(pose_target(written(*lines), solver.figure))
    assert found.held, str(found.certificate)
    pelvis = Rotation.from_matrix(at(solver.model, found.qpos).body("pelvis").xmat.reshape(3, 3))
    bent = Rotation.from_euler("y", 15, degrees=True)
    assert np.degrees((bent.inv() * pelvis).magnitude()) < 5


STANDING_LEG = "left foot: 0.09 wide, 1 high, level"


@pytest.mark.parametrize("height", [2.0, 2.5, 3.0])
@pytest.mark.parametrize(
    ("width", "depth"), [(0.1, Depth.FRONT), (0.3, Depth.LEVEL), (0.1, Depth.BEHIND)]
)
def test_a_raised_leg_is_where_its_sign_is_or_is_said_not_to_be(
    width: float, depth: Depth, height: float, solver: KeyPoseSolver, model: mujoco.MjModel
) -> None:
    lines = (
        STANDING_LEG,
        f"right foot: {width} wide, {height} high, {depth}",
        "arms: à la seconde",
    )
    found = solver.solve(pose_target(written(*lines), solver.figure))
    data = at(model, found.qpos)
    ankle = in_frame(data, "pelvis", data.site("right_ankle").xpos)
    off = float(np.linalg.norm(ankle - found.target.legs[Side.RIGHT].ankle))
    results = {result.rule: result for result in found.certificate.results}
    assert results["right foot on its sign"].held is (off < 2e-3) or off < 4e-3
    assert results["left flat foot"].held
    assert results["centre of mass over the support"].held
    assert support_margin(data, [Side.LEFT]) > 0.0099
    if depth is not Depth.BEHIND:  # a hip extends less than it flexes
        assert results["right foot on its sign"].held, str(found.certificate)


def hip_turnout(data: mujoco.MjData, side: Side) -> float:
    """How far the knee faces outwards about the thigh, degrees, 0 for a parallel leg.

    The zero is carried along by the shortest rotation from the hanging leg to the raised one, so
    that a leg raised from a turned-out stance keeps its turnout.
    """
    thigh = data.body("pelvis").xmat.reshape(3, 3).T @ data.body(f"{side}_thigh").xmat.reshape(3, 3)
    down, along, face = np.array([0.0, 0, -1]), -thigh[:, 2], thigh[:, 0]

    def carried(w: np.ndarray) -> np.ndarray:
        return w - (along @ w) / (1 + along @ down) * (along + down)

    outward = np.array([0.0, 1.0 if side is Side.LEFT else -1.0, 0.0])
    return float(np.degrees(np.arctan2(face @ carried(outward), face @ carried(np.eye(3)[0]))))


_TURNOUT_FAULT = pytest.mark.xfail(
    reason="turnout is measured against a direction fixed in the pelvis, and hip_turn's range does "
    "not follow the raised leg",
    strict=True,
)


@pytest.mark.parametrize(
    ("width", "depth", "height"),
    [
        pytest.param(0.3, Depth.LEVEL, 1.5, id="à la seconde 1.5"),
        pytest.param(0.3, Depth.LEVEL, 2.0, id="à la seconde 2"),
        *(
            pytest.param(0.3, Depth.LEVEL, h, id=f"à la seconde {h:g}", marks=_TURNOUT_FAULT)
            for h in (2.5, 3.0)
        ),
        *(
            pytest.param(0.1, Depth.FRONT, h, id=f"devant {h:g}", marks=_TURNOUT_FAULT)
            for h in (1.5, 2.0, 2.5, 3.0)
        ),
    ],
)
def test_a_raised_leg_stays_turned_out(
    width: float, depth: Depth, height: float, solver: KeyPoseSolver, model: mujoco.MjModel
) -> None:
    """A leg raised to any height keeps 45 degrees of turnout: its knee faces up à la seconde."""
    lines = (
        STANDING_LEG,
        f"right foot: {width} wide, {height} high, {depth}",
        "arms: à la seconde",
    )
    found = solver.solve(pose_target(written(*lines), solver.figure))
    assert found.held, str(found.certificate)
    assert hip_turnout(at(model, found.qpos), Side.RIGHT) > 45


@pytest.mark.parametrize("feet", ["first", "second", "fifth right front"])
@pytest.mark.parametrize("knee", ["0.3 wide, 2.2 high, front", "0.3 wide, 2.05 high, level"])
def test_a_plie_is_held_or_honestly_broken(
    feet: str, knee: str, solver: KeyPoseSolver, model: mujoco.MjModel
) -> None:
    """Knees bend, soles stay flat, and the certificate agrees with MuJoCo on the knees' places."""
    lines = (f"feet: {feet}", f"left knee: {knee}", f"right knee: {knee}", "arms: demi-seconde")
    found = solver.solve(pose_target(written(*lines), solver.figure))
    data = at(model, found.qpos)
    results = {result.rule: result for result in found.certificate.results}
    straight = solver.solve(
        pose_target(written(f"feet: {feet}", "arms: demi-seconde"), solver.figure)
    )
    assert found.qpos[2] < straight.qpos[2] - 0.01
    for side in Side:
        knee_place = in_frame(data, "pelvis", data.site(f"{side}_knee").xpos)
        off = 1e3 * np.abs(knee_place - found.target.legs[side].knee).max()
        result = results[f"{side} knee on its sign"]
        assert result.value == pytest.approx(off, abs=0.01)
        assert result.held is bool(off <= 30)
        assert results[f"{side} flat foot"].held
        assert found.qpos[model.joint(f"{side}_knee_bend").qposadr[0]] > np.radians(10)
    assert results["centre of mass over the support"].held


def test_an_arabesque_s_arms_are_stretched_with_the_palms_down(
    solver: KeyPoseSolver, model: mujoco.MjModel
) -> None:
    for name in ("first arabesque", "second arabesque", "third arabesque"):
        for side in Side:
            found = solver.solve(
                pose_target(written("feet: first", f"arms: {name} {side} leads"), solver.figure)
            )
            assert found.held, str(found.certificate)
            data = at(model, found.qpos)
            for arm in Side:
                bend = found.qpos[model.joint(f"{arm}_elbow_bend").qposadr[0]]
                assert np.degrees(bend) < 3
                inward = np.array([0, -1.0 if arm is Side.LEFT else 1.0, 0])
                palm = data.body(f"{arm}_hand").xmat.reshape(3, 3) @ inward
                arm_line = data.site(f"{arm}_wrist").xpos - data.site(f"{arm}_shoulder").xpos
                arm_line /= np.linalg.norm(arm_line)
                down = -np.eye(3)[2] + arm_line[2] * arm_line
                assert palm @ down / np.linalg.norm(down) > np.cos(np.radians(12))


@pytest.mark.parametrize(
    ("elbow", "hand"),
    [
        ("0.45 wide, 4 high, level", "0.45 wide, 4.5 high, front"),
        ("0.4 wide, 3.4 high, level", "0.2 wide, 3 high, front"),
        ("0.5 wide, 3.6 high, behind", "0.28 wide, 3.1 high, front"),
    ],
)
def test_a_written_elbow_is_where_its_sign_is(
    elbow: str, hand: str, solver: KeyPoseSolver, model: mujoco.MjModel
) -> None:
    lines = ["feet: first"]
    for side in Side:
        lines += [f"{side} elbow: {elbow}", f"{side} hand: {hand}"]
    found = solver.solve(pose_target(written(*lines), solver.figure))
    assert found.held, str(found.certificate)
    data = at(model, found.qpos)
    for side in Side:
        for site, place in (
            ("elbow", found.target.arms[side].elbow),
            ("wrist", found.target.arms[side].wrist),
        ):
            reached = in_frame(data, "torso", data.site(f"{side}_{site}").xpos)
            assert np.linalg.norm(reached - place) < 2.5e-3


def test_one_problem_serves_poses_of_one_structure(solver: KeyPoseSolver) -> None:
    rounded = [
        pose_target(written("feet: first", f"arms: {name}"), solver.figure)
        for name in ("first", "fifth en haut")
    ]
    arabesque = pose_target(
        written("feet: first", "arms: first arabesque left leads"), solver.figure
    )
    assert solver.problem(rounded[0]) is solver.problem(rounded[1])
    assert solver.problem(rounded[0]) is not solver.problem(arabesque)


def test_a_pose_without_a_foot_on_the_floor_is_a_score_error(figure: Figure) -> None:
    frame = written(
        "left foot: 0.3 wide, 2 high, level", "right foot: 0.3 wide, 2 high, level", "arms: first"
    )
    with pytest.raises(ScoreError, match=r"a\.bmn:7:1: no foot is on the floor"):
        pose_target(frame, figure, source="a.bmn")


def test_a_sign_out_of_reach_is_a_score_error_at_its_place(figure: Figure) -> None:
    frame = written(
        "feet: first",
        "left hand: 0.94 wide, 3.72 high, front",
        "right hand: 0.9 wide, 6 high, front",
    )
    with pytest.raises(ScoreError, match=r"a\.bmn:10:3: .*beyond the reach of the arm"):
        pose_target(frame, figure, source="a.bmn")


positions = st.sampled_from(
    [
        ArmsPosition(entry.name, side if entry.needs_leading else None)
        for entry in ARMS
        for side in Side
    ]
)
feet_positions = st.sampled_from(
    [FeetPosition(entry.name, side if entry.crossed else None) for entry in FEET for side in Side]
)


@given(positions, feet_positions)
@settings(max_examples=10)
def test_any_arms_go_with_any_feet_and_their_mirror_image(
    arms: ArmsPosition, feet: FeetPosition
) -> None:
    solver = solver_of("default")
    frame = replace(written("feet: first", "arms: first"), feet=feet)
    signs = arm_signs(arms)
    frame = replace(
        frame,
        arms={
            side: replace(
                frame.arms[side], wrist=signs[side], rounded=not signs[side].straight, named=arms
            )
            for side in Side
        },
    )
    found, image = (
        solver.solve(pose_target(f, solver.figure)) for f in (frame, mirrored_frame(frame))
    )
    assert found.held, str(found.certificate)
    assert image.held, str(image.certificate)
    assert np.allclose(image.qpos, mirrored_qpos(solver.model, found.qpos), atol=5e-3)
