"""From the stave to points in space: equations 4.1 to 4.7 of Neagle 2005."""

from __future__ import annotations

from math import cos, pi, radians, sqrt

import mujoco
import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from enpointe.errors import ModelError, ScoreError
from enpointe.models import (
    Anthropometry,
    Figure,
    Style,
    build_dancer,
    dancer_model,
    pose_target,
)
from enpointe.models.extremities import elbow_of_rounded_arm, extremity, limb_root
from enpointe.models.target import ArmShape
from enpointe.notation import Depth, Location, Side, Sign
from enpointe.notation.vocabulary import ARMS

from .posing import at, measures, standing, written

FIGURE = Figure.of(dancer_model())
GRAZE = 1e-3
"""A point may miss the sphere by a millimetre where the sign lies just outside it."""

sides = st.sampled_from(Side)
lines = st.floats(1, 6)


@given(lines, lines, st.booleans())
def test_heights_rise_with_the_lines(one: float, other: float, leg: bool) -> None:
    low, high = sorted((one, other))
    assert FIGURE.height(low, leg=leg) <= FIGURE.height(high, leg=leg)
    if high - low > 1e-6:
        assert FIGURE.height(low, leg=leg) < FIGURE.height(high, leg=leg)


@given(st.integers(1, 5), st.floats(0, 1), st.booleans())
def test_between_two_lines_height_is_linear(line: int, share: float, leg: bool) -> None:
    """Eq. 4.1: z = z_n + p (z_{n+1} - z_n)."""
    low, high = FIGURE.height(line, leg=leg), FIGURE.height(line + 1, leg=leg)
    assert FIGURE.height(line + share, leg=leg) == pytest.approx(low + share * (high - low))


@given(lines, st.booleans())
def test_line_is_the_inverse_of_height(line: float, leg: bool) -> None:
    assert FIGURE.line(FIGURE.height(line, leg=leg), leg=leg) == pytest.approx(line, abs=1e-9)


def test_the_lines_are_where_the_thesis_puts_them(model: mujoco.MjModel, figure: Figure) -> None:
    """Floor, knee, waist (hip for legs), shoulder, top of the head, stretched arm overhead."""
    data = at(model, standing(model))
    knee, hip = data.site("left_knee").xpos[2], data.site("left_hip").xpos[2]
    shoulder, crown = data.site("left_shoulder").xpos[2], data.site("crown").xpos[2]
    overhead = shoulder + figure.straight_arm
    assert figure.lines == pytest.approx(
        (0, knee, data.body("torso").xpos[2], shoulder, crown, overhead)
    )
    assert figure.leg_lines[2] == pytest.approx(hip)
    assert figure.leg_lines[:2] == figure.lines[:2]


@given(measures())
@settings(max_examples=10)
def test_lines_scale_with_the_dancer(body: Anthropometry) -> None:
    figure = Figure.of(build_dancer(body))
    assert list(figure.lines) == sorted(figure.lines)
    assert figure.height(5) == pytest.approx(body.height)


def test_a_model_without_the_dancer_s_marks_is_refused() -> None:
    ball = mujoco.MjModel.from_xml_string(
        "<mujoco><worldbody><body><freejoint/><geom size='1'/></body></worldbody></mujoco>"
    )
    with pytest.raises(ModelError, match="not a dancer's"):
        Figure.of(ball)


def test_a_rounded_arm_has_an_elbow_of_153_degrees() -> None:
    """Eq. 4.5: l^2 = a^2 + b^2 - 2 a b cos 153 deg."""
    a, b = FIGURE.upper_arm, FIGURE.forearm
    assert FIGURE.rounded_arm == pytest.approx(sqrt(a * a + b * b - 2 * a * b * cos(radians(153))))
    assert FIGURE.arm_reach(0) == pytest.approx(FIGURE.straight_arm) == pytest.approx(a + b)
    assert FIGURE.arm_reach(pi) == pytest.approx(abs(a - b))
    assert FIGURE.rounded_arm < FIGURE.stretched_arm < FIGURE.straight_arm


@given(st.floats(0, 2.5), st.floats(0, 2.5))
def test_reach_falls_as_the_elbow_bends(one: float, other: float) -> None:
    low, high = sorted((one, other))
    assume(high - low > 1e-6)
    assert FIGURE.arm_reach(high) < FIGURE.arm_reach(low)


@given(
    sides,
    st.floats(-1, 1),
    lines,
    st.sampled_from(Depth),
    st.booleans(),
    st.floats(0.4, 1.0),
)
def test_an_extremity_lies_at_its_length_from_the_root(
    side: Side, width: float, height: float, depth: Depth, leg: bool, share: float
) -> None:
    """Where the sign says, at the limb's length; or an error where no such point is."""
    length = share * (FIGURE.straight_leg if leg else FIGURE.straight_arm)
    sign = Sign(width, height, depth, at=Location(7, 5))
    root = limb_root(FIGURE, side, leg=leg)
    origin = FIGURE.pelvis_origin if leg else FIGURE.torso_origin
    outward = 1 if side is Side.LEFT else -1
    rise = FIGURE.height(height, leg=leg) - origin[2] - root[2]
    aside = outward * width * FIGURE.full_width(leg=leg) - root[1]
    off_axis = abs(rise) if depth is Depth.LEVEL else float(np.hypot(rise, aside))
    if off_axis > length + 2 * GRAZE:
        with pytest.raises(ScoreError) as caught:
            extremity(FIGURE, side, sign, length, leg=leg, source="a.bmn")
        assert str(caught.value).startswith("a.bmn:7:5: ")
        assert "\n" not in str(caught.value)
        return
    if off_axis > length + 0.5 * GRAZE:
        return  # a sign this near the edge may go either way
    point = extremity(FIGURE, side, sign, length, leg=leg, source="a.bmn")
    tolerance = 1e-9 if off_axis <= length else 2 * GRAZE
    assert np.linalg.norm(point - root) == pytest.approx(length, abs=tolerance)
    assert point[2] - root[2] == pytest.approx(rise)
    if depth is Depth.LEVEL:
        assert point[0] == root[0]
        # Of the two places at this height, the one nearer to the written width.
        other = 2 * root[1] - point[1]
        wanted = root[1] + aside
        assert abs(point[1] - wanted) <= abs(other - wanted) + 1e-12
    else:
        assert point[1] - root[1] == pytest.approx(aside, abs=1e-12)
        ahead = point[0] - root[0]
        assert ahead >= 0 if depth is Depth.FRONT else ahead <= 0


@given(
    sides,
    st.booleans(),
    st.floats(0, 2 * pi),
    st.floats(-0.95, 0.95),
    st.floats(0.5, 0.99),
)
def test_a_point_in_reach_comes_back_from_its_own_sign(
    side: Side, leg: bool, azimuth: float, sine: float, share: float
) -> None:
    """Notate a wrist or ankle anywhere on the limb's sphere and place it again: the same point."""
    length = share * (FIGURE.straight_leg if leg else FIGURE.straight_arm)
    cosine = sqrt(1 - sine**2)
    direction = np.array([cosine * cos(azimuth), cosine * np.sin(azimuth), sine])
    assume(abs(direction[0]) > 1e-3)
    point = limb_root(FIGURE, side, leg=leg) + length * direction
    origin = FIGURE.pelvis_origin if leg else FIGURE.torso_origin
    outward = 1 if side is Side.LEFT else -1
    sign = Sign(
        width=outward * point[1] / FIGURE.full_width(leg=leg),
        height=FIGURE.line(point[2] + origin[2], leg=leg),
        depth=Depth.FRONT if direction[0] > 0 else Depth.BEHIND,
    )
    assert np.allclose(extremity(FIGURE, side, sign, length, leg=leg), point, atol=1e-6)


@given(st.floats(-1, 1), lines, st.sampled_from(Depth), st.booleans())
def test_left_and_right_signs_are_mirror_images(
    width: float, height: float, depth: Depth, leg: bool
) -> None:
    sign = Sign(width, height, depth)
    length = FIGURE.stretched_leg if leg else FIGURE.rounded_arm
    try:
        left = extremity(FIGURE, Side.LEFT, sign, length, leg=leg)
    except ScoreError:
        with pytest.raises(ScoreError):
            extremity(FIGURE, Side.RIGHT, sign, length, leg=leg)
        return
    right = extremity(FIGURE, Side.RIGHT, sign, length, leg=leg)
    assert np.allclose(left * [1, -1, 1], right, atol=1e-12)


def test_an_elbow_hangs_the_wrist_on_itself() -> None:
    """With a written elbow the forearm's length counts from there (§4.4.3)."""
    elbow = extremity(FIGURE, Side.LEFT, Sign(0.45, 4, Depth.LEVEL), FIGURE.upper_arm)
    hand = Sign(0.45, 4.5, Depth.FRONT)
    wrist = extremity(FIGURE, Side.LEFT, hand, FIGURE.forearm, root=elbow)
    assert np.linalg.norm(wrist - elbow) == pytest.approx(FIGURE.forearm)
    assert wrist[0] > elbow[0]


def test_a_crossed_level_hand_is_on_the_other_side() -> None:
    """Signs say that a negative width is crossed over the centre line."""
    sign = Sign(-0.2, 5.5, Depth.LEVEL)
    assert (
        extremity(FIGURE, Side.LEFT, sign, FIGURE.rounded_arm)[1] < FIGURE.shoulders[Side.LEFT][1]
    )


@pytest.mark.parametrize(
    ("leg", "limb", "root"), [(False, "arm", "shoulder"), (True, "leg", "hip")]
)
def test_out_of_reach_says_by_how_much_and_what_to_do(leg: bool, limb: str, root: str) -> None:
    sign = Sign(1.0, 2.0, Depth.FRONT, at=Location(3, 9))
    centre = limb_root(FIGURE, Side.LEFT, leg=leg)
    origin = FIGURE.pelvis_origin if leg else FIGURE.torso_origin
    rise = FIGURE.height(2.0, leg=leg) - origin[2] - centre[2]
    short = np.hypot(rise, FIGURE.full_width(leg=leg) - centre[1]) - 0.5
    with pytest.raises(ScoreError) as caught:
        extremity(FIGURE, Side.LEFT, sign, 0.5, leg=leg, source="test.bmn")
    assert str(caught.value).startswith(
        f"test.bmn:3:9: this sign is {100 * short:.0f} cm beyond the reach of the {limb}; bring it"
    )
    assert root in str(caught.value)
    assert str(caught.value)[-1].isalpha()
    assert not str(caught.value).endswith("'s")


wrists = st.tuples(sides, st.floats(0, 2 * pi), st.floats(-0.98, 0.98), st.floats(0.5, 0.999))


@given(wrists)
def test_the_elbow_of_a_rounded_arm(wrist: tuple[Side, float, float, float]) -> None:
    """Eqs 4.6, 4.7: bones keep their length, and the elbow leaves the line of the arm along a
    horizontal, so that it neither drops nor lifts; outward when the arm is in front."""
    side, azimuth, sine, share = wrist
    cosine = sqrt(1 - sine**2)
    u = np.array([cosine * cos(azimuth), cosine * np.sin(azimuth), sine])
    shoulder = FIGURE.shoulders[side]
    reach = share * FIGURE.straight_arm
    target = shoulder + reach * u
    elbow = elbow_of_rounded_arm(FIGURE, side, target)
    assert np.linalg.norm(elbow - shoulder) == pytest.approx(FIGURE.upper_arm)
    assert np.linalg.norm(target - elbow) == pytest.approx(FIGURE.forearm)
    offset = elbow - shoulder - ((elbow - shoulder) @ u) * u
    assert offset[2] == pytest.approx(0, abs=1e-12)
    assert np.linalg.norm(offset) > 0
    outward = 1 if side is Side.LEFT else -1
    if u[0] > 1e-6:
        assert outward * offset[1] > 0  # in front of the body: outwards
    if outward * u[1] > 1e-6:
        assert offset[0] < 0  # to its own side: the elbow is behind the hand


def test_an_arm_straight_up_or_down_still_has_an_elbow() -> None:
    for side in Side:
        for z in (1.0, -1.0):
            wrist = FIGURE.shoulders[side] + [0, 0, z * FIGURE.rounded_arm]
            elbow = elbow_of_rounded_arm(FIGURE, side, wrist)
            assert np.isfinite(elbow).all()
            assert np.linalg.norm(elbow - FIGURE.shoulders[side]) == pytest.approx(FIGURE.upper_arm)
            assert (elbow[1] - FIGURE.shoulders[side][1]) * (1 if side is Side.LEFT else -1) > 0


@pytest.mark.parametrize(("bend", "reach_share"), [(10.0, 0.996), (27.0, 0.972), (60.0, 0.866)])
def test_the_style_sets_the_bend_of_rounded_arms(bend: float, reach_share: float) -> None:
    """A teacher's own elbow: the wrist comes as near to the shoulder as eq. 4.5 says."""
    frame = written("feet: first", "arms: fifth en avant")
    arm = pose_target(frame, FIGURE, Style(elbow_deg=bend)).arms[Side.LEFT]
    reach = np.linalg.norm(arm.wrist - arm.shoulder)
    assert reach == pytest.approx(FIGURE.arm_reach(radians(bend)))
    assert reach / FIGURE.straight_arm == pytest.approx(reach_share, abs=0.001)


@given(measures())
@settings(max_examples=8)
def test_every_body_can_be_asked_for_every_named_position_of_the_arms(body: Anthropometry) -> None:
    """A name gives way to a short arm, as a written sign may not; its reach stays the arm's."""
    figure = Figure.of(build_dancer(body, flesh=False))
    for entry in ARMS:
        leads = " left leads" if entry.needs_leading else ""
        target = pose_target(written("feet: first", f"arms: {entry.name}{leads}"), figure)
        for arm in target.arms.values():
            straight = arm.shape is ArmShape.STRAIGHT
            reach = figure.stretched_arm if straight else figure.rounded_arm
            assert np.linalg.norm(arm.wrist - arm.shoulder) == pytest.approx(reach, abs=GRAZE)


def test_arms_keep_their_place_on_the_stave_when_the_body_inclines() -> None:
    """Signs are read as if written before the tilt (§4.7.2 d, e)."""
    erect = pose_target(written("feet: first", "arms: à la seconde"), FIGURE)
    bent = pose_target(written("feet: first", "arms: à la seconde", "body: tilt left 20"), FIGURE)
    for side in Side:
        assert np.array_equal(erect.arms[side].wrist, bent.arms[side].wrist)
