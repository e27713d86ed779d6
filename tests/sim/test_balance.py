"""Balance against geometry done by hand and by brute force."""

from __future__ import annotations

from math import inf, sqrt

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st
from numpy.typing import NDArray

from enpointe.models.foot_positions import support_hull
from enpointe.sim.balance import (
    LOADED,
    area,
    centre_of_pressure,
    extrapolated_com,
    margin,
    margin_of_stability,
    penetration,
    room,
    slip,
    support,
    zero_moment_point,
)

Array = NDArray[np.float64]
SQUARE = np.array([[0.0, 0], [1, 0], [1, 1], [0, 1]])
coordinates = st.floats(-0.5, 0.5)
points = st.tuples(coordinates, coordinates)


@pytest.mark.parametrize(
    ("point", "expected"),
    [
        ((0.5, 0.5), 0.5),
        ((0.5, 0.1), 0.1),
        ((0.9, 0.4), 0.1),
        ((1.0, 0.5), 0.0),
        ((1.25, 0.5), -0.25),
        ((-3.0, -4.0), -5.0),
        ((2.0, 2.0), -sqrt(2)),
    ],
)
def test_the_margin_of_a_square(point: tuple[float, float], expected: float) -> None:
    assert margin(SQUARE, np.array(point)) == pytest.approx(expected, abs=1e-12)


def test_a_line_and_a_point_have_no_inside() -> None:
    line = np.array([[0.0, 0], [1, 0]])
    assert margin(line, np.array([0.5, 0])) == pytest.approx(0.0)
    assert margin(line, np.array([0.5, -0.2])) == pytest.approx(-0.2)
    assert margin(line, np.array([4.0, 4.0])) == pytest.approx(-5.0)
    assert margin(line[:1], np.array([0.3, 0.4])) == pytest.approx(-0.5)


def test_nothing_supports_nobody() -> None:
    assert margin(support(np.zeros((0, 3)), np.zeros((0, 3))), np.zeros(2)) == -inf
    assert margin(support(np.ones((4, 3)), np.zeros((4, 3))), np.zeros(2)) == -inf


def brute_force(corners: Array, point: Array) -> float:
    """Signed distance by walking the outline, and inside by the angles of all corners seen."""
    hull = support_hull(corners)
    share = np.linspace(0, 1, 4001)[:, None]
    outline = np.vstack(
        [(1 - share) * a + share * b for a, b in zip(hull, np.roll(hull, -1, 0), strict=True)]
    )
    gap = float(np.linalg.norm(outline - point, axis=1).min())
    seen = np.sort(np.arctan2(*(corners - point).T[::-1]))
    widest = np.diff(np.r_[seen, seen[0] + 2 * np.pi]).max()
    return gap if widest < np.pi else -gap


@given(st.lists(points, min_size=3, max_size=12, unique=True), points)
def test_the_margin_against_brute_force(
    corners: list[tuple[float, float]], at: tuple[float, float]
) -> None:
    cloud, point = np.round(np.array(corners), 3), np.round(np.array(at), 3)
    hull = support_hull(cloud)
    assume(len(hull) > 2)
    assert margin(hull, point) == pytest.approx(brute_force(cloud, point), abs=3e-4)


@given(st.lists(points, min_size=3, max_size=8, unique=True), points, st.floats(-3, 3), points)
def test_it_does_not_matter_where_and_which_way_one_stands(
    corners: list[tuple[float, float]],
    at: tuple[float, float],
    turn: float,
    step: tuple[float, float],
) -> None:
    cloud = np.round(np.array(corners), 3)
    assume(len(support_hull(cloud)) > 2)
    c, s = np.cos(turn), np.sin(turn)
    rotation = np.array([[c, -s], [s, c]])
    moved = margin(support_hull(cloud @ rotation.T + step), rotation @ at + step)
    assert moved == pytest.approx(margin(support_hull(cloud), np.array(at)), abs=1e-6)


@st.composite
def loaded_soles(draw: st.DrawFn) -> tuple[Array, Array]:
    n = draw(st.integers(1, 12))
    seed = draw(st.integers(0, 2**32 - 1))
    rng = np.random.default_rng(seed)
    places = np.column_stack([rng.uniform(-0.3, 0.3, (n, 2)), rng.uniform(-0.002, 0.0, n)])
    forces = np.column_stack([rng.normal(size=(n, 2)), rng.uniform(0, 200, n)])
    forces[rng.random(n) < 0.3] = 0.0
    return places, forces


@given(loaded_soles())
def test_the_centre_of_pressure_lies_within_the_support(soles: tuple[Array, Array]) -> None:
    places, forces = soles
    bearing = forces[:, 2] > 0
    assume(forces[:, 2].sum() > LOADED)
    cop = centre_of_pressure(places, forces)
    hull = support_hull(places[bearing, :2])
    assert margin(hull, cop) >= -1e-9
    moment = np.cross(places, np.column_stack([0 * forces[:, :2], forces[:, 2]])).sum(0)
    total = forces[:, 2].sum()
    np.testing.assert_allclose([-moment[1] / total, moment[0] / total], cop, atol=1e-9)


@given(loaded_soles())
def test_only_soles_that_bear_weight_support(soles: tuple[Array, Array]) -> None:
    places, forces = soles
    hull = support(places, forces)
    bearing = places[forces[:, 2] > LOADED, :2]
    assert {tuple(p) for p in hull} <= {tuple(p) for p in bearing}
    for p in bearing:
        assert margin(hull, p) >= -1e-9


def test_in_the_air_there_is_no_pressure() -> None:
    assert np.isnan(centre_of_pressure(np.ones((3, 3)), np.zeros((3, 3)))).all()


def test_slip_is_counted_from_where_the_sole_took_weight() -> None:
    x = np.array([0.0, 0.0, 0.01, 0.03, 0.5, 0.5, 0.52])
    bears = np.array([1, 1, 1, 1, 0, 1, 1])
    places = np.zeros((7, 2, 3))
    places[:, 0, 0] = x
    forces = np.zeros((7, 2, 3))
    forces[:, 0, 2] = 100.0 * bears
    slid = slip(places, forces)
    np.testing.assert_allclose(slid[:, 0], [0, 0, 0.01, 0.03, 0, 0, 0.02], atol=1e-12)
    assert not slid[:, 1].any()


def test_bobbing_is_not_slipping() -> None:
    places, forces = np.zeros((5, 1, 3)), np.full((5, 1, 3), 100.0)
    places[:, 0, 2] = [0, 0.001, -0.001, 0.002, 0]
    assert not slip(places, forces).any()


@given(st.lists(points, min_size=3, max_size=12, unique=True), points)
def test_margin_and_area_against_shapely(
    corners: list[tuple[float, float]], at: tuple[float, float]
) -> None:
    geometry = pytest.importorskip("shapely.geometry")
    cloud, point = np.round(np.array(corners), 3), np.round(np.array(at), 3)
    hull = support_hull(cloud)
    assume(len(hull) > 2)
    shape = geometry.MultiPoint(cloud).convex_hull
    gap = shape.exterior.distance(geometry.Point(point))
    inside = shape.covers(geometry.Point(point))
    assert margin(hull, point) == pytest.approx(gap if inside else -gap, abs=1e-9)
    assert area(hull) == pytest.approx(shape.area, abs=1e-9)


@given(st.floats(0, 2 * np.pi), st.tuples(st.floats(0.1, 0.9), st.floats(0.1, 0.9)))
def test_room_ends_at_the_edge(angle: float, at: tuple[float, float]) -> None:
    direction = np.array([np.cos(angle), np.sin(angle)])
    far = room(SQUARE, np.array(at), direction)
    assert margin(SQUARE, np.array(at) + far * direction) == pytest.approx(0.0, abs=1e-9)
    assert far >= margin(SQUARE, np.array(at)) - 1e-9


def test_areas_by_hand() -> None:
    assert area(SQUARE) == pytest.approx(1.0)
    assert area(0.5 * SQUARE + 3.0) == pytest.approx(0.25)
    assert area(SQUARE[:2]) == area(SQUARE[:0]) == 0.0


def test_at_rest_the_zero_moment_point_is_below_the_weight() -> None:
    com, still = np.array([0.1, -0.2, 0.9]), np.zeros(3)
    np.testing.assert_allclose(zero_moment_point(com, still, still, 54.0, 9.81), com[:2])


@given(
    st.lists(st.floats(-3, 3), min_size=3, max_size=3),
    st.lists(st.floats(-20, 20), min_size=3, max_size=3),
)
def test_a_force_at_the_zero_moment_point_turns_the_body_as_it_turns(
    acceleration: list[float], rate: list[float]
) -> None:
    """(p - c) x F gives L' about the level axes: the definition itself."""
    com, mass = np.array([0.3, -0.1, 0.95]), 54.0
    force = mass * (np.array(acceleration) + np.array([0, 0, 9.81]))
    point = zero_moment_point(com, np.array(acceleration), np.array(rate), mass, 9.81)
    moment = np.cross(np.array([*point, 0.0]) - com, force)
    np.testing.assert_allclose(moment[:2], rate[:2], atol=1e-9)


def test_in_free_fall_there_is_no_zero_moment_point() -> None:
    fall = np.array([0.0, 0.0, -9.81])
    assert np.isnan(zero_moment_point(np.ones(3), fall, np.zeros(3), 54.0, 9.81)).all()


def test_the_extrapolated_centre_of_mass_is_ahead_by_speed_over_frequency() -> None:
    com, velocity = np.array([0.5, 0.5, 9.81 / 9]), np.array([0.3, -0.6, 5.0])
    np.testing.assert_allclose(extrapolated_com(com, velocity, 9.81), [0.6, 0.3])
    assert margin_of_stability(SQUARE, com, velocity, 9.81) == pytest.approx(0.3)
    assert margin_of_stability(SQUARE, com, 10 * velocity, 9.81) < 0
    assert margin_of_stability(SQUARE[:0], com, velocity, 9.81) == -inf


def test_the_deepest_sole_counts() -> None:
    assert penetration(np.array([0.0, 3e-4, 1e-4])) == 3e-4
    assert penetration(np.zeros(0)) == 0.0
