"""The way of a wrist: it ends where it should, and strays as Laban's space says."""

from __future__ import annotations

import itertools
from math import pi, radians

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from enpointe.models import Style
from enpointe.models.target import ArmTarget, rounded_arm
from enpointe.motion.arm_path import LET_OUT_ELBOW_DEG, ArmPath
from enpointe.notation import Side

from .dancing import solved, solver

REACH = solver().figure.arm_reach(radians(Style().elbow_deg))
few = settings(max_examples=30)
shares = st.floats(0.0, 1.0)
spaces = st.floats(0.0, 1.0)


def arm(side: Side, direction: np.ndarray, reach: float = REACH) -> ArmTarget:
    figure = solver().figure
    wrist = figure.shoulders[side] + reach * direction / np.linalg.norm(direction)
    return rounded_arm(wrist, side, figure, Style(), bend=radians(14.0))


@st.composite
def front_arm(draw: st.DrawFn, side: Side = Side.LEFT) -> ArmTarget:
    """Low or high, narrow, in front: where fifth en bas, en avant and en haut are."""
    outward = 1.0 if side is Side.LEFT else -1.0
    figure = solver().figure
    aside = outward * draw(st.floats(0.06, 0.28)) - figure.shoulders[side][1]
    slope = draw(st.floats(-1.3, 1.3))
    forward = np.sqrt(REACH**2 - aside**2)
    return arm(side, np.array([forward * np.cos(slope), aside, forward * np.sin(slope)]))


@st.composite
def any_arm(draw: st.DrawFn, side: Side = Side.LEFT) -> ArmTarget:
    turn, rise = draw(st.floats(-0.3, 1.9)), draw(st.floats(-1.4, 1.4))
    outward = 1.0 if side is Side.LEFT else -1.0
    direction = np.array(
        [np.cos(rise) * np.cos(turn), outward * np.cos(rise) * np.sin(turn), np.sin(rise)]
    )
    return arm(side, direction, REACH * draw(st.floats(0.96, 1.0)))


def path(start: ArmTarget, end: ArmTarget, space: float, side: Side = Side.LEFT) -> ArmPath:
    return ArmPath(solver().figure, side, start, end, space)


def reach_at(way: ArmPath, k: float) -> float:
    return float(np.linalg.norm(way.wrist(k) - way.start.shoulder))


def rounded_reach(way: ArmPath, k: float) -> float:
    first, last = (float(np.linalg.norm(a.wrist - a.shoulder)) for a in (way.start, way.end))
    return (1 - k) * first + k * last


@few
@given(any_arm(), any_arm(), spaces)
def test_it_leads_from_place_to_place(start: ArmTarget, end: ArmTarget, space: float) -> None:
    way = path(start, end, space)
    np.testing.assert_allclose(way.wrist(0.0), start.wrist, atol=1e-9)
    np.testing.assert_allclose(way.wrist(1.0), end.wrist, atol=1e-9)


@few
@given(any_arm(), any_arm(), shares)
def test_a_direct_path_keeps_the_reach(start: ArmTarget, end: ArmTarget, k: float) -> None:
    way = path(start, end, 1.0)
    assume(not way.waits)
    assert reach_at(way, k) == pytest.approx(rounded_reach(way, k), abs=1e-9)


@few
@given(front_arm(), front_arm(), spaces, shares)
def test_upwards_in_front_it_is_drawn_in_by_a_tenth_at_most(
    start: ArmTarget, end: ArmTarget, space: float, k: float
) -> None:
    way = path(start, end, space)
    assume(not way.waits and end.wrist[2] > start.wrist[2])
    drawn = 1 - reach_at(way, k) / rounded_reach(way, k)
    assert drawn == pytest.approx((1 - space) * 0.1 * np.sin(pi * k), abs=1e-9)


@few
@given(any_arm(), any_arm(), spaces, shares)
def test_elsewhere_it_is_let_out_but_never_straight(
    start: ArmTarget, end: ArmTarget, space: float, k: float
) -> None:
    way = path(start, end, space)
    assume(not way.waits and not way.drawn_in)
    straightest = solver().figure.arm_reach(radians(LET_OUT_ELBOW_DEG))
    rounded, reach = rounded_reach(way, k), reach_at(way, k)
    assert rounded - 1e-9 <= reach <= max(straightest, rounded) + 1e-9
    assert straightest < solver().figure.straight_arm
    share = (reach - rounded) / (straightest - rounded)
    assert share == pytest.approx((1 - space) * np.sin(pi * k), abs=1e-6)


@few
@given(any_arm(), any_arm(), spaces, st.integers(3, 20))
def test_equal_shares_are_equal_lengths(
    start: ArmTarget, end: ArmTarget, space: float, parts: int
) -> None:
    way = path(start, end, space)
    assume(way.length > 0.05)

    def walked(low: float, high: float) -> float:
        steps = np.array([way.wrist(k) for k in np.linspace(low, high, 60)])
        return float(np.linalg.norm(np.diff(steps, axis=0), axis=1).sum())

    marks = [way.at_share(i / parts) for i in range(parts + 1)]
    lengths = [walked(a, b) for a, b in itertools.pairwise(marks)]
    assert marks[0] == 0.0
    assert marks[-1] == 1.0
    np.testing.assert_allclose(lengths, way.length / parts, rtol=0.01)


@few
@given(front_arm(), front_arm(), spaces)
def test_through_the_front_the_hands_keep_their_distance(
    start: ArmTarget, end: ArmTarget, space: float
) -> None:
    """The wrists stay a face's width apart; the shortest rotation parts them (§5.6.2)."""
    way = path(start, end, space)
    assume(not way.waits)
    gap = np.array([2 * way.wrist(k)[1] for k in np.linspace(0, 1, 41)])
    direction = np.sign(gap[-1] - gap[0])
    assert np.all(np.diff(gap) * direction >= -1e-9)
    assert gap.min() >= 2 * 0.06 - 1e-9


@few
@given(any_arm(), any_arm(), shares)
def test_elsewhere_a_direct_path_is_the_shortest(
    start: ArmTarget, end: ArmTarget, k: float
) -> None:
    way = path(start, end, 1.0)
    assume(not way.waits and not way.through_front)
    u, v, w = (p - start.shoulder for p in (start.wrist, way.wrist(k), end.wrist))
    angles = [
        np.arccos(np.clip(a @ b / np.linalg.norm(a) / np.linalg.norm(b), -1, 1))
        for a, b in ((u, v), (v, w), (u, w))
    ]
    assert angles[0] + angles[1] == pytest.approx(angles[2], abs=1e-6)
    assert angles[0] == pytest.approx(k * angles[2], abs=1e-6)


@few
@given(front_arm(), front_arm(), spaces, shares)
def test_both_arms_do_the_same(start: ArmTarget, end: ArmTarget, space: float, k: float) -> None:
    across = np.array([1.0, -1.0, 1.0])
    figure = solver().figure
    first, last = (
        rounded_arm(a.wrist * across, Side.RIGHT, figure, Style(), a.wrist_bend)
        for a in (start, end)
    )
    left, right = path(start, end, space), path(first, last, space, Side.RIGHT)
    np.testing.assert_allclose(left.wrist(k) * across, right.wrist(k), atol=1e-9)
    assert left.at_share(k) == pytest.approx(right.at_share(k), abs=1e-9)


@few
@given(any_arm(), any_arm(), spaces, st.floats(0.05, 0.95))
def test_the_heading_points_along_the_path(
    start: ArmTarget, end: ArmTarget, space: float, k: float
) -> None:
    way = path(start, end, space)
    assume(way.length > 0.1)
    heading, step = way.heading(k), way.wrist(k + 1e-4) - way.wrist(k - 1e-4)
    assert np.linalg.norm(heading) == pytest.approx(1.0)
    assert heading @ step / np.linalg.norm(step) > 0.98


@few
@given(any_arm(), shares)
def test_an_arm_that_waits_goes_nowhere(start: ArmTarget, k: float) -> None:
    way = path(start, start, 0.0)
    assert way.waits
    assert way.length < 1e-12
    np.testing.assert_array_equal(way.heading(k), np.zeros(3))
    np.testing.assert_allclose(way.wrist(way.at_share(k)), start.wrist, atol=1e-12)


def test_which_ways_of_a_port_de_bras_go_through_the_front() -> None:
    """Third port de bras: bas to haut is upwards in front; haut to seconde to bas is not."""
    poses = [pose.target.arms for pose in solved("third-port-de-bras").key_poses]
    for side in Side:
        up, out, down = (path(poses[i][side], poses[i + 1][side], 0.0, side) for i in (0, 2, 3))
        assert up.through_front
        assert up.drawn_in
        assert not out.through_front
        assert not down.drawn_in
