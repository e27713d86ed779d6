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
from enpointe.models import Figure, KeyPose, KeyPoseSolver, Style, dancer_model, pose_target
from enpointe.models.leg_target import InAir, Standing
from enpointe.models.target import turn_tilt_bend
from enpointe.notation import ArmsPosition, Depth, FeetPosition, Orientation, Side, mirrored
from enpointe.notation.vocabulary import ARMS, FEET

from .checking import check_in_mujoco, support_margin
from .posing import (
    at,
    contact_pairs,
    hinge,
    in_frame,
    mirrored_qpos,
    rotation_between,
    same_pose,
    solver_of,
    standing,
    written,
    written_score,
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
    for way, angle in (("turn", turn), ("tilt", tilt), ("bend", bend)):
        qpos[model.joint(f"{part}_{way}").qposadr[0]] = np.radians(angle)
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
    for share, outer, inner, allowed in (
        (1.0, "torso", "head", 1.0),
        (0.5, "world", "torso", 3.0),  # in the world, whatever the pelvis lends
    ):
        wanted = Rotation.from_euler(
            "ZXY", [share * turn, -share * tilt, share * bend], degrees=True
        )
        difference = (wanted.inv() * rotation_between(data, outer, inner)).magnitude()
        assert np.degrees(difference) < allowed
    check_in_mujoco(solver.model, found)


def test_the_pelvis_is_turned_as_written(solver: KeyPoseSolver) -> None:
    lines = ("feet: second", "arms: à la seconde", "pelvis: bend forward 15")
    found = solver.solve(pose_target(written(*lines), solver.figure))
    assert found.held, str(found.certificate)
    pelvis = Rotation.from_matrix(at(solver.model, found.qpos).body("pelvis").xmat.reshape(3, 3))
    bent = Rotation.from_euler("y", 15, degrees=True)
    assert np.degrees((bent.inv() * pelvis).magnitude()) < 5


def raised_leg(solver: KeyPoseSolver, width: float, height: float, depth: Depth) -> KeyPose:
    """On the left leg, the right foot where its sign has it."""
    frame = written(
        "left foot: 0.09 wide, 1 high, level",
        f"right foot: {width} wide, {height} high, {depth}",
        "arms: à la seconde",
    )
    return solver.solve(pose_target(frame, solver.figure))


@pytest.mark.parametrize("height", [2.0, 2.5, 3.0])
@pytest.mark.parametrize(
    ("width", "depth"), [(0.1, Depth.FRONT), (0.3, Depth.LEVEL), (0.1, Depth.BEHIND)]
)
def test_a_raised_leg_is_where_its_sign_is_or_is_said_not_to_be(
    width: float, depth: Depth, height: float, solver: KeyPoseSolver, model: mujoco.MjModel
) -> None:
    found = raised_leg(solver, width, height, depth)
    data = at(model, found.qpos)
    leg = found.target.legs[Side.RIGHT]
    assert isinstance(leg, InAir)
    ankle = data.site("right_ankle").xpos - data.site("right_hip").xpos
    off = float(np.linalg.norm(ankle - (leg.ankle - solver.figure.hips[Side.RIGHT])))
    results = {result.rule: result for result in found.certificate.results}
    assert results["right foot on its sign"].held is (off < 2e-3) or off < 4e-3
    assert results["left rise of the foot"].held
    assert results["left no rolling"].held
    assert results["centre of mass over the support"].held
    assert support_margin(data, found.target) > 0.0099
    if depth is not Depth.BEHIND:  # a hip extends less than it flexes
        assert found.held, str(found.certificate)


def hip_turnout(data: mujoco.MjData, side: Side) -> float:
    """How far the knee faces outwards about the thigh, degrees, 0 for a parallel leg.

    The zero is carried along by the shortest rotation from the hanging leg to the raised one, so
    that a leg raised from a turned-out stance keeps its turnout.
    """
    thigh = data.body("pelvis").xmat.reshape(3, 3).T @ data.body(f"{side}_thigh").xmat.reshape(3, 3)
    down, along, face = np.array([0.0, 0, -1]), -thigh[:, 2], thigh[:, 0]

    def carried(w: np.ndarray) -> np.ndarray:
        turned: np.ndarray = w - (along @ w) / (1 + along @ down) * (along + down)
        return turned

    outward = np.array([0.0, 1.0 if side is Side.LEFT else -1.0, 0.0])
    return float(np.degrees(np.arctan2(face @ carried(outward), face @ carried(np.eye(3)[0]))))


@pytest.mark.parametrize(
    ("width", "depth", "height"),
    [
        *(
            pytest.param(0.3, Depth.LEVEL, h, id=f"à la seconde {h:g}")
            for h in (1.5, 2.0, 2.5, 3.0)
        ),
        *(pytest.param(0.1, Depth.FRONT, h, id=f"devant {h:g}") for h in (1.5, 2.0, 2.5, 3.0)),
    ],
)
def test_a_raised_leg_stays_turned_out(
    width: float, depth: Depth, height: float, solver: KeyPoseSolver, model: mujoco.MjModel
) -> None:
    """A leg raised to any height keeps 45 degrees of turnout: its knee faces up à la seconde."""
    found = raised_leg(solver, width, height, depth)
    assert found.held, str(found.certificate)
    assert hip_turnout(at(model, found.qpos), Side.RIGHT) > 45


@pytest.mark.parametrize("feet", ["first", "second", "fifth right front"])
@pytest.mark.parametrize("knee", ["0.3 wide, 2.2 high, front", "0.3 wide, 2.05 high, level"])
def test_a_written_knee_over_a_standing_foot_is_a_demi_plie(
    feet: str, knee: str, solver: KeyPoseSolver, model: mujoco.MjModel
) -> None:
    """Where feet and bend leave the knee no choice, its sign says no more than that it bends."""
    lines = (f"feet: {feet}", f"left knee: {knee}", f"right knee: {knee}", "arms: demi-seconde")
    target = pose_target(written(*lines), solver.figure)
    found = solver.solve(target)
    assert found.certificate.legal, str(found.certificate)
    check_in_mujoco(model, found)
    straight = solver.solve(
        pose_target(written(f"feet: {feet}", "arms: demi-seconde"), solver.figure)
    )
    assert found.qpos[2] < straight.qpos[2] - 0.05
    plie = pose_target(written(f"feet: {feet}, demi-plié", "arms: demi-seconde"), solver.figure)
    for side in Side:
        leg, same = target.legs[side], plie.legs[side]
        assert isinstance(leg, Standing)
        assert isinstance(same, Standing)
        assert (leg.knee_bend, leg.rise) == (same.knee_bend, same.rise)
        assert hinge(model, found.qpos, f"{side}_knee_bend") == pytest.approx(
            Style().demi_plie_deg, abs=1
        )


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


def test_a_pose_without_a_foot_on_the_floor_is_in_the_air(
    solver: KeyPoseSolver, model: mujoco.MjModel
) -> None:
    """Legal, with the centre of mass where the target has it and no foot near the floor."""
    frame = written(
        "left foot: 0.3 wide, 1.6 high, level",
        "right foot: 0.1 wide, 1.4 high, front",
        "arms: first",
    )
    target = pose_target(frame, solver.figure)
    assert target.com is not None
    assert target.support.shape == (0, 2)
    found = solver.solve(target)
    assert found.held, str(found.certificate)
    check_in_mujoco(model, found)
    assert not [pair for pair in contact_pairs(model, at(model, found.qpos)) if "floor" in pair]


@pytest.mark.parametrize("place", [(0.4, -1.2, 1.3), (-2.0, 0.5, 1.05)])
def test_the_centre_of_mass_of_a_jump_goes_where_it_is_asked(
    place: tuple[float, float, float], solver: KeyPoseSolver, model: mujoco.MjModel
) -> None:
    frame = written("left leg: pointed derrière", "right leg: pointed devant", "arms: demi-seconde")
    target = replace(pose_target(frame, solver.figure), com=np.array(place), facing=2.5)
    found = solver.solve(target)
    assert found.held, str(found.certificate)
    check_in_mujoco(model, found)


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
    score = written_score(("feet: first", "arms: first"))
    score = replace(score, frames=(replace(score.frames[0], feet=feet, arms=arms),))
    found, image = (
        solver.solve(pose_target(s.resolved()[0], solver.figure)) for s in (score, mirrored(score))
    )
    assert found.held, str(found.certificate)
    assert image.held, str(image.certificate)
    assert same_pose(image.qpos, mirrored_qpos(solver.model, found.qpos), atol=5e-3)
