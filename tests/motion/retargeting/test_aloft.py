"""Whoever nothing bears falls; whoever does not fall is borne."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray

from enpointe.motion.retargeting.aloft import flying, thrown

RATE = 120.0
Array = NDArray[np.float64]


def hop(seconds: float, gravity: float = 9.81) -> tuple[Array, Array, NDArray[np.bool_]]:
    """Times, heights and where no foot is near the floor: at rest, a hop, at rest."""
    count = round(seconds * RATE)
    time = np.arange(3 * count) / RATE
    t = time[:count]
    height = np.full(3 * count, 0.9)
    height[count : 2 * count] += 0.5 * gravity * t * (seconds - t)
    aloft = np.zeros(3 * count, dtype=bool)
    aloft[count : 2 * count] = True
    return time, height, aloft


@pytest.mark.parametrize("seconds", [0.2, 0.5])
def test_a_hop_is_a_flight_whole(seconds: float) -> None:
    time, height, aloft = hop(seconds)
    flies = flying(time, height, aloft)
    assert not np.any(flies & ~aloft)
    assert np.count_nonzero(flies) >= np.count_nonzero(aloft) - 2


def test_a_turn_on_a_foot_that_was_not_seen_is_none() -> None:
    time, _, aloft = hop(0.5)
    rising = 0.9 + 0.1 * np.sin(2.0 * time)
    assert not flying(time, rising, aloft).any()


def test_a_flicker_and_a_body_that_hangs_are_none() -> None:
    time, height, aloft = hop(0.05)
    assert not flying(time, height, aloft).any()
    assert not flying(*hop(0.5, gravity=4.0)).any()


@pytest.mark.parametrize("scale", [0.8, 1.0, 1.25])
@pytest.mark.parametrize(("gravity", "fall"), [(9.81, 9.81), (8.5, 9.81), (13.5, 13.5)])
def test_the_weight_is_thrown(scale: float, gravity: float, fall: float) -> None:
    """Falls that a capture can't tell from free fall are free; others are as captured."""
    time, height, aloft = hop(0.4, gravity)
    noise = 0.002 * np.sin(2 * np.pi * 15.0 * time)
    com = np.column_stack([scale * 1.5 * time, 0.0 * time, scale * (height + noise)])
    places = thrown(time, com, aloft, scale)
    # A sample at an end may be off, since there the noise decides.
    assert set(places) <= set(np.flatnonzero(aloft).tolist())
    assert len(places) >= np.count_nonzero(aloft) - 2
    path = np.array([places[i] for i in sorted(places)])
    falls = -np.diff(path[:, 2], n=2) * RATE**2
    assert np.ptp(falls) < 1e-6
    assert falls[0] == pytest.approx(fall, rel=0.05)
    np.testing.assert_allclose(np.diff(path[:, 0]), scale * 1.5 / RATE, atol=1e-9)
