"""Feet in their stances, and on their way between: how they turn, and where they go."""

from __future__ import annotations

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from enpointe.motion.carried_feet import carried
from enpointe.motion.foot_turns import PLAY, held_headings, turned_about

Array = NDArray[np.float64]
RATE = 100.0
FOOT = np.array([[-0.1, 0.02, 0.0], [-0.1, -0.02, 0.0], [0.08, 0.04, 0.0], [0.1, -0.03, 0.0]])


def laid(places: Array, angles: Array) -> Array:
    """The foot at places (T, 2), turned by angles (T,)."""
    points = np.tile(FOOT, (len(places), 1, 1))
    points = turned_about(points, np.zeros((len(places), 2)), angles)
    points[:, :, :2] += places[:, None]
    return points


def apart(points: Array) -> Array:
    return np.asarray(np.linalg.norm(points[:, :, None] - points[:, None], axis=3))


@settings(max_examples=25, deadline=None)
@given(turn=st.floats(-4.0, 4.0), offset=st.floats(-3.0, 3.0))
def test_a_standing_foot_stays_within_its_play_and_turns_no_more_than_it_must(
    turn: float, offset: float
) -> None:
    share = np.linspace(0.0, 1.0, 300)
    heading = offset + turn * share**2 * (3.0 - 2.0 * share)
    held = held_headings(heading, np.ones(300, dtype=bool), RATE)
    assert np.abs(held - heading).max() < PLAY + 0.02
    assert np.ptp(held) <= max(abs(turn) - 2 * PLAY, 0.0) + 0.02
    if abs(turn) < 2 * PLAY:
        assert np.ptp(held) == 0.0


def test_a_foot_in_the_air_turns_as_it_was_captured() -> None:
    heading = np.linspace(0.0, 0.6, 300)
    stands = np.zeros(300, dtype=bool)
    stands[:100] = True
    held = held_headings(heading, stands, RATE)
    np.testing.assert_array_equal(held[100:], heading[100:])
    assert np.ptp(held[:100]) == 0.0


@settings(max_examples=25, deadline=None)
@given(seed=st.integers(0, 1000))
def test_a_carried_foot_lies_where_it_is_to_stand_keeps_its_shape_and_does_not_jump(
    seed: int,
) -> None:
    rng = np.random.default_rng(seed)
    share = np.linspace(0.0, 1.0, 200)[:, None]
    captured = laid(share * rng.uniform(-0.5, 0.5, 2), share[:, 0] * rng.uniform(-1.0, 1.0))
    bears = np.ones((200, 4), dtype=bool)
    bears[60:140] = False
    bears[50:60, :2] = False
    planned = captured.copy()
    for stance in (slice(0, 60), slice(140, 200)):
        planned[stance] = laid(rng.uniform(-0.1, 0.1, (1, 2)), rng.uniform(-0.3, 0.3, 1))
    found = carried(captured, planned, bears)
    np.testing.assert_allclose(found[bears], planned[bears], atol=1e-9)
    np.testing.assert_allclose(apart(found), apart(captured), atol=1e-9)
    assert np.abs(np.diff(found, axis=0)).max() < 0.03


def test_a_foot_that_stands_where_it_was_captured_is_left_alone() -> None:
    share = np.linspace(0.0, 1.0, 200)
    captured = laid(np.stack([share, 0.2 * share], axis=1), 0.5 * share)
    bears = np.zeros((200, 4), dtype=bool)
    bears[:50], bears[150:] = True, True
    np.testing.assert_allclose(carried(captured, captured, bears), captured, atol=1e-9)
    np.testing.assert_array_equal(carried(captured, captured + 1.0, ~np.ones_like(bears)), captured)
