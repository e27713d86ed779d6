"""Five positions of the feet, as soles on the floor."""

from __future__ import annotations

from math import cos, radians, sin

import mujoco
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from scipy.spatial import ConvexHull

from enpointe.errors import PoseError, ScoreError
from enpointe.models import Figure, dancer_model, pose_target
from enpointe.models.foot_positions import (
    TURNOUT_RANGE_DEG,
    Footprint,
    footprints,
    support_hull,
)
from enpointe.models.leg_target import Standing
from enpointe.models.rules.balance import centroid, half_planes
from enpointe.notation import FeetPosition, Side, feet_signs

from .posing import DANCERS, written

FIGURE = Figure.of(dancer_model())
FIGURES = [Figure.of(dancer_model(body)) for body in DANCERS.values()]
POSITIONS = [
    FeetPosition("first"),
    FeetPosition("second"),
    *(FeetPosition("fourth", side, open=True) for side in Side),
    *(FeetPosition(name, side) for name in ("third", "fourth", "fifth") for side in Side),
]
turnouts = st.floats(*TURNOUT_RANGE_DEG)
positions = st.sampled_from(POSITIONS)
figures = st.sampled_from(FIGURES)


def heel(foot: Footprint, figure: Figure) -> np.ndarray:
    """The hindmost point of the foot."""
    return foot.point(-figure.heel_back)


def gap(one: np.ndarray, other: np.ndarray) -> float:
    """Widest strip between two convex polygons; negative when they overlap (separating axes)."""
    widest = -np.inf
    for polygon in (one, other):
        edges = np.roll(polygon, -1, axis=0) - polygon
        normals = np.stack([edges[:, 1], -edges[:, 0]], axis=1)
        normals /= np.linalg.norm(normals, axis=1, keepdims=True)
        for normal in normals:
            a, b = one @ normal, other @ normal
            widest = max(widest, b.min() - a.max(), a.min() - b.max())
    return float(widest)


def outline(foot: Footprint, figure: Figure) -> np.ndarray:
    corners = foot.sole(figure)
    hull: np.ndarray = corners[ConvexHull(corners).vertices]
    return hull


@given(figures, positions, turnouts)
def test_no_foot_stands_on_the_other(
    figure: Figure, position: FeetPosition, turnout: float
) -> None:
    feet = footprints(figure, position, turnout)
    assert gap(*(outline(foot, figure) for foot in feet.values())) > 0


@given(figures, positions, turnouts)
def test_both_feet_are_turned_out_alike_about_the_middle(
    figure: Figure, position: FeetPosition, turnout: float
) -> None:
    feet = footprints(figure, position, turnout)
    assert feet[Side.LEFT].direction == pytest.approx(radians(turnout))
    assert feet[Side.RIGHT].direction == pytest.approx(-radians(turnout))
    assert np.allclose(feet[Side.LEFT].ankle + feet[Side.RIGHT].ankle, 0)


@given(figures, turnouts)
def test_heels_are_together_in_first(figure: Figure, turnout: float) -> None:
    feet = footprints(figure, FeetPosition("first"), turnout)
    assert feet[Side.LEFT].ankle[0] == pytest.approx(feet[Side.RIGHT].ankle[0])
    left, right = (outline(foot, figure) for foot in feet.values())
    assert 0 < gap(left, right) < 0.04


@given(figures, turnouts)
def test_heels_are_under_the_shoulders_in_second(figure: Figure, turnout: float) -> None:
    feet = footprints(figure, FeetPosition("second"), turnout)
    shoulders = figure.shoulders[Side.LEFT][1]
    for side, sign in ((Side.LEFT, 1), (Side.RIGHT, -1)):
        middle_of_heel = feet[side].point(-figure.heel_back + 0.026)
        assert sign * middle_of_heel[1] == pytest.approx(shoulders)


def along_the_back_foot(figure: Figure, name: str, turnout: float) -> float:
    """How far from the back of the rear foot the front heel lies, along the rear foot."""
    feet = footprints(figure, FeetPosition(name, Side.RIGHT), turnout)
    back, front = feet[Side.LEFT], feet[Side.RIGHT]
    axis = np.array([cos(back.direction), sin(back.direction)])
    middle_of_heel = front.point(-figure.heel_back + 0.026)
    return float((middle_of_heel - heel(back, figure)) @ axis)


@given(figures, turnouts)
def test_the_front_heel_is_at_the_ball_of_the_back_foot_in_fifth(
    figure: Figure, turnout: float
) -> None:
    """§4.2.2: at the joint of the big toe."""
    ball = figure.heel_back + figure.ball_forward
    assert along_the_back_foot(figure, "fifth", turnout) == pytest.approx(ball, abs=0.005)


@given(figures, turnouts)
def test_the_front_heel_is_at_the_middle_of_the_back_foot_in_third(
    figure: Figure, turnout: float
) -> None:
    middle = 0.5 * figure.foot_length
    reached = along_the_back_foot(figure, "third", turnout)
    assert middle - 0.1 * figure.foot_length < reached < middle + 0.02 * figure.foot_length


@given(figures, turnouts)
def test_fourth_is_fifth_opened_to_a_foot_s_length(figure: Figure, turnout: float) -> None:
    """§4.2.2: about one foot length, front to back, opposite the fifth."""
    fourth, fifth = (
        footprints(figure, FeetPosition(name, Side.LEFT), turnout) for name in ("fourth", "fifth")
    )
    step = fourth[Side.LEFT].ankle - fourth[Side.RIGHT].ankle
    closed = fifth[Side.LEFT].ankle - fifth[Side.RIGHT].ankle
    assert step[1] == pytest.approx(closed[1])
    assert step[0] == pytest.approx(figure.foot_length)
    assert step[0] > closed[0] + 0.05


@given(figures, turnouts, st.sampled_from(Side))
def test_open_fourth_is_a_foot_s_length_before_the_other_heel(
    figure: Figure, turnout: float, front: Side
) -> None:
    """Ouverte: opposite the first, heel before heel, where the crossed one is before the toe."""
    spread, crossed = (
        footprints(figure, FeetPosition("fourth", front, open=is_open), turnout)
        for is_open in (True, False)
    )
    step = spread[front].ankle - spread[front.other].ankle
    assert np.allclose(step, [figure.foot_length, 0.0])
    across = crossed[front].ankle - crossed[front.other].ankle
    if turnout > 50:  # feet turned out less stand side by side when their edges touch
        assert across[1] * (1 if front is Side.LEFT else -1) < 0


@given(figures, st.sampled_from(("third", "fourth", "fifth")), turnouts)
def test_the_other_foot_in_front_is_the_mirror_image(
    figure: Figure, name: str, turnout: float
) -> None:
    left = footprints(figure, FeetPosition(name, Side.LEFT), turnout)
    right = footprints(figure, FeetPosition(name, Side.RIGHT), turnout)
    for side in Side:
        assert np.allclose(left[side].ankle * [1, -1], right[side.other].ankle)
        assert left[side].direction == pytest.approx(-right[side.other].direction)
    assert left[Side.LEFT].ankle[0] > left[Side.RIGHT].ankle[0]


@given(st.floats(-180, 180).filter(lambda t: not 30 <= t <= 75))
def test_an_impossible_turnout_is_refused(turnout: float) -> None:
    with pytest.raises(PoseError, match=r"outside 30\.\.75"):
        footprints(FIGURE, FeetPosition("first"), turnout)


def test_the_sole_is_where_the_model_touches_the_floor() -> None:
    """The hull of `Footprint.sole` is that of the contact spheres' lowest points."""
    model = dancer_model()
    figure = Figure.of(model)
    foot = Footprint(np.array([0.0, figure.hips[Side.LEFT][1]]), 0.0)
    data_points = []
    data = mujoco.MjData(model)
    mujoco.mj_resetDataKeyframe(model, data, model.key("standing").id)
    mujoco.mj_kinematics(model, data)
    for part in ("heel", "ball", "tip"):
        for edge in ("outer", "inner"):
            data_points.append(data.geom(f"left_{part}_{edge}").xpos[:2])
    assert np.allclose(foot.sole(figure), np.array(data_points), atol=1e-9)


@pytest.mark.xfail(
    reason="a foot on the floor line can only be straight under the hip", strict=True
)
@pytest.mark.parametrize("position", POSITIONS[1:], ids=lambda p: f"{p.name} {p.front or ''}")
def test_the_signs_of_a_named_position_put_the_feet_near_it(position: FeetPosition) -> None:
    """`feet_signs` says what a position means on the stave; written out, it means the same."""
    lines = [
        f"{side} foot: {sign.width} wide, {sign.height} high, {sign.depth}"
        for side, sign in feet_signs(position).items()
    ]
    named = footprints(FIGURE, position)
    try:
        target = pose_target(written(*lines, "arms: first"), FIGURE)
    except ScoreError as error:
        pytest.fail(str(error))
    apart = named[Side.LEFT].ankle - named[Side.RIGHT].ankle
    left, right = (target.legs[side] for side in Side)
    assert isinstance(left, Standing)
    assert isinstance(right, Standing)
    meant = left.footprint.ankle - right.footprint.ankle
    assert np.linalg.norm(apart - meant) < 0.1


grid = st.floats(-1, 1).map(lambda v: round(v, 3))


@given(arrays(float, st.tuples(st.integers(3, 40), st.just(2)), elements=grid))
def test_the_support_hull_agrees_with_qhull(points: np.ndarray) -> None:
    spread = points - points[0]
    if np.linalg.matrix_rank(spread, tol=1e-2) < 2:
        return
    hull, theirs = support_hull(points), ConvexHull(points)
    following = np.roll(hull, -1, axis=0)
    area = 0.5 * np.sum(hull[:, 0] * following[:, 1] - hull[:, 1] * following[:, 0])
    assert area == pytest.approx(theirs.volume, abs=1e-9)  # > 0: counter-clockwise
    normals, offsets = half_planes(hull)
    assert (points @ normals.T <= offsets + 1e-9).all()
    assert {tuple(p) for p in hull} <= {tuple(p) for p in points + 0.0}


@given(st.integers(0, 2**32 - 1), st.integers(3, 12))
def test_the_centroid_is_the_mean_of_the_area(seed: int, count: int) -> None:
    rng = np.random.default_rng(seed)
    hull = support_hull(rng.uniform(-1, 1, (count, 2)))
    triangles = [(hull[0], hull[i], hull[i + 1]) for i in range(1, len(hull) - 1)]
    areas = [0.5 * abs((b - a)[0] * (c - a)[1] - (b - a)[1] * (c - a)[0]) for a, b, c in triangles]
    if sum(areas) < 1e-6:
        return
    mean = sum(w * np.mean(t, axis=0) for w, t in zip(areas, triangles, strict=True)) / sum(areas)
    assert np.allclose(centroid(hull), mean, atol=1e-6)


def test_hulls_of_one_and_two_points() -> None:
    point = np.array([[0.1, 0.2]])
    assert np.array_equal(support_hull(point), point)
    assert np.array_equal(support_hull(np.repeat(point, 5, axis=0)), point)
    pair = np.array([[0.0, 0.0], [1.0, 2.0]])
    assert np.array_equal(support_hull(pair[::-1]), pair)


def test_the_hull_of_points_in_a_row_is_its_ends() -> None:
    row = np.linspace([0, 0], [2, 1], 9)
    assert np.allclose(support_hull(row), [[0, 0], [2, 1]])
