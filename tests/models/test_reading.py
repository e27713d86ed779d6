"""Reading a configuration as signs is the inverse of solving signs."""

from __future__ import annotations

import mujoco
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from enpointe.errors import PoseError
from enpointe.models import Figure, Style, dancer_model, pose_target
from enpointe.models.extremities import extremity
from enpointe.models.joints import Joints
from enpointe.models.limbs import orientation
from enpointe.models.reading import LEVEL, read_signs
from enpointe.models.target import turn_tilt_bend
from enpointe.notation import Bend, Depth, FloorContact, Side, Support

from .posing import at as data_at
from .posing import in_frame, mirrored_qpos, random_qpos, solver_of, standing, written
from .vocabulary import ALL, frame_of, solved

MODEL = dancer_model(flesh=False)
FIGURE = Figure.of(MODEL)
SAMPLE = (
    "feet fifth",
    "feet fourth open",
    "arms à la seconde",
    "arms third arabesque",
    "leg raised devant 90",
    "leg tendu seconde",
    "pose attitude derrière",
    "pose épaulé",
)
TOUCHING_THE_LEG = ("retiré", "cou-de-pied")
GRAZING = "leg dégagé seconde"
"""At its 35 degrees the toe is within millimetres of the floor, where a tendu has it."""


def check_read_back(name: str, side: Side, real: bool) -> None:
    """All that the frame says, within 0.1 stave units, 2 degrees and the same words."""
    wanted = frame_of(name, side)
    found = read_signs(solver_of("default").model, solved(name, side, real).qpos)
    for each in Side:
        arm, hand = wanted.arms[each], found.hands[each]
        assert hand.width == pytest.approx(arm.wrist.width, abs=0.1)
        assert hand.height == pytest.approx(arm.wrist.height, abs=0.1)
        assert hand.depth is arm.wrist.depth
        assert hand.straight is not arm.rounded
        assert each not in found.elbows
        leg, read = wanted.legs[each], found.legs[each]
        grazes = name == GRAZING and each is side
        assert read.support == (Support(FloorContact.TOUCH) if grazes else leg.support)
        defined_by_touch = leg.named is not None and leg.named.name in TOUCHING_THE_LEG
        if leg.foot is not None and read.support is None and not defined_by_touch:
            # A real dancer whose hip or body gives way is read as she is, and that is close.
            assert read.foot.width == pytest.approx(leg.foot.width, abs=0.1)
            assert read.foot.height == pytest.approx(leg.foot.height, abs=0.1)
            assert read.foot.depth is leg.foot.depth
            assert (read.knee is None) == (leg.knee is None)
    for part in ("head", "body", "pelvis"):
        one, other = getattr(found, part), getattr(wanted, part)
        # The body is read against a pelvis that a real dancer lends to the leg.
        slack = 4.0 if real else 2.0
        for rotation in ("turn", "tilt", "bend"):
            assert getattr(one, rotation) == pytest.approx(getattr(other, rotation), abs=slack)
    assert found.facing_degrees == pytest.approx(wanted.facing_degrees, abs=4.0)
    if wanted.feet is not None and all(leg.position for leg in wanted.legs.values()):
        assert found.feet is not None
        assert found.feet.position == wanted.feet
        assert found.feet.metres < 0.02


@pytest.mark.parametrize("name", SAMPLE)
def test_what_was_written_is_read(name: str) -> None:
    check_read_back(name, Side.RIGHT, real=False)


@pytest.mark.slow
@pytest.mark.parametrize(("name", "side", "real"), ALL)
def test_all_that_was_written_is_read(name: str, side: Side, real: bool) -> None:
    if solved(name, side, real).held:
        check_read_back(name, side, real)


@pytest.mark.parametrize("style", [Style(), Style(real=True)], ids=["perfect", "real"])
def test_a_written_bend_over_a_leg_behind_is_read(style: Style) -> None:
    """Only what the back gives way to the leg is not written."""
    frame = written(
        "left leg: straight",
        "right leg: raised derrière 90",
        "body: bend forward 15",
        "arms: à la seconde",
    )
    solver = solver_of("default")
    pose = solver.solve(pose_target(frame, solver.figure, style))
    assert pose.held
    assert read_signs(solver.model, pose.qpos).body.bend == pytest.approx(15.0, abs=4.0)


@pytest.mark.parametrize(
    ("lines", "floor", "bend"),
    [
        (("feet: first",), FloorContact.FLAT, Bend.STRAIGHT),
        (("feet: first, demi-plié",), FloorContact.FLAT, Bend.DEMI_PLIE),
        (("feet: second, grand plié",), FloorContact.FLAT, Bend.GRAND_PLIE),
        (("feet: first, grand plié",), FloorContact.FLAT, Bend.GRAND_PLIE),
        (("feet: fifth right front, demi-pointe",), FloorContact.DEMI_POINTE, Bend.STRAIGHT),
        (("feet: fifth right front, pointe",), FloorContact.POINTE, Bend.STRAIGHT),
    ],
)
def test_how_feet_meet_the_floor_is_read(
    lines: tuple[str, ...], floor: FloorContact, bend: Bend
) -> None:
    frame = written(*lines, "arms: fifth en bas")
    solver = solver_of("default")
    found = read_signs(solver.model, solver.solve(pose_target(frame, solver.figure)).qpos)
    for side in Side:
        support = found.legs[side].support
        assert support is not None
        assert (support.floor, support.bend) == (floor, bend)
    assert found.feet is not None
    assert found.feet.position == frame.feet


def test_a_dancer_in_the_air_stands_on_nothing() -> None:
    qpos = standing(MODEL)
    qpos[2] += 0.3
    found = read_signs(MODEL, qpos)
    assert found.feet is None
    assert all(leg.support is None for leg in found.legs.values())


@given(st.integers(0, 2**32 - 1))
def test_a_read_sign_is_the_place_it_was_read_from(seed: int) -> None:
    """Any arm whatever: its signs, measured on the dancer, put elbow and wrist where they were."""
    qpos = random_qpos(MODEL, np.random.default_rng(seed))
    data = data_at(MODEL, qpos)
    found = read_signs(MODEL, qpos, FIGURE)
    for side in Side:
        shoulder, elbow, wrist = (
            in_frame(data, "torso", data.site(f"{side}_{joint}").xpos)
            for joint in ("shoulder", "elbow", "wrist")
        )
        signs = [(found.hands[side], shoulder, wrist)]
        if side in found.elbows:
            signs = [(found.elbows[side], shoulder, elbow), (found.hands[side], elbow, wrist)]
        for sign, root, place in signs:
            if not 1.0 < sign.height < 6.0:
                continue
            length = float(np.linalg.norm(place - root))
            again = extremity(FIGURE, side, sign, length, root=root)
            assert again[2] == pytest.approx(place[2], abs=1e-6)
            if sign.depth is Depth.LEVEL:
                assert abs(place[0] - again[0]) <= LEVEL * length + 1e-6
            else:
                assert again == pytest.approx(place, abs=1e-6)


@given(st.integers(0, 2**32 - 1))
def test_the_mirror_image_reads_as_the_mirror_image(seed: int) -> None:
    qpos = random_qpos(MODEL, np.random.default_rng(seed))
    one, other = (read_signs(MODEL, q, FIGURE) for q in (qpos, mirrored_qpos(MODEL, qpos)))
    for side in Side:
        a, b = one.hands[side], other.hands[side.other]
        assert a.width == pytest.approx(b.width, abs=1e-6)
        assert a.height == pytest.approx(b.height, abs=1e-6)
        assert (a.depth, a.straight) == (b.depth, b.straight)
    assert one.head.tilt == pytest.approx(-other.head.tilt, abs=1e-6)
    assert one.head.bend == pytest.approx(other.head.bend, abs=1e-6)


@given(st.floats(-180, 180), st.sampled_from(SAMPLE))
def test_turning_the_dancer_turns_nothing_but_her_facing(degrees: float, name: str) -> None:
    qpos = solved(name).qpos
    turn = Rotation.from_euler("z", degrees, degrees=True)
    turned = np.array(qpos)
    turned[:3] = turn.apply(qpos[:3])
    whole = turn * Rotation.from_quat(qpos[3:7], scalar_first=True)
    turned[3:7] = whole.as_quat(scalar_first=True)
    model = solver_of("default").model
    one, other = read_signs(model, qpos), read_signs(model, turned)
    gone = (other.facing_degrees - one.facing_degrees - degrees + 180) % 360 - 180
    assert gone == pytest.approx(0, abs=1e-6)
    for side in Side:
        assert one.legs[side].foot.height == pytest.approx(other.legs[side].foot.height, abs=1e-6)
        assert one.legs[side].support == other.legs[side].support
        assert one.hands[side].depth is other.hands[side].depth


@given(st.floats(-170, 170), st.floats(-80, 80), st.floats(-170, 170))
def test_turn_tilt_and_bend_are_taken_apart_in_their_order(
    turn: float, tilt: float, bend: float
) -> None:
    found = orientation(turn_tilt_bend(np.radians([turn, tilt, bend])))
    assert (found.turn, found.tilt, found.bend) == pytest.approx((turn, tilt, bend), abs=1e-6)


def test_depth_is_seen_from_the_joint_before() -> None:
    """The hand of a bent arm is before or behind its elbow, as a score means it."""
    frame = written(
        "feet: first",
        "left hand: 0.3 wide, 2.99 high, level",
        "left elbow: 0.57 wide, 3.57 high, level",
        "right hand: 0.28 wide, 2.64 high, front",
    )
    solver = solver_of("default")
    found = read_signs(solver.model, solver.solve(pose_target(frame, solver.figure)).qpos)
    assert found.hands[Side.LEFT].depth is Depth.LEVEL
    assert found.elbows[Side.LEFT].width == pytest.approx(0.57, abs=0.1)
    assert Side.RIGHT not in found.elbows


@pytest.mark.parametrize("qpos", [np.zeros(5), np.full(MODEL.nq, np.nan)])
def test_what_is_no_configuration_is_refused(qpos: np.ndarray) -> None:
    with pytest.raises(PoseError):
        read_signs(MODEL, qpos)


def test_joints_need_a_dancer() -> None:
    from enpointe.errors import ModelError

    ball = mujoco.MjModel.from_xml_string(
        "<mujoco><worldbody><body><freejoint/><geom size='.1'/></body></worldbody></mujoco>"
    )
    with pytest.raises(ModelError):
        Joints.of(ball, np.array([0.0, 0, 1, 1, 0, 0, 0]))
