"""A flight is held against free fall and against the spin that nothing can change."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from enpointe.sim.ballistics import ballistics
from enpointe.sim.measures import Flight

G = 9.81


def thrown(up: float, across: float, seconds: float) -> tuple[np.ndarray, np.ndarray]:
    """Times and places of a point thrown with those speeds, a hundred times a second."""
    time = np.arange(0.0, seconds + 1e-9, 0.01)
    com = np.column_stack([across * time, 0.0 * time, 0.9 + up * time - 0.5 * G * time**2])
    return time, com


@given(st.floats(0.5, 4.0), st.floats(-3.0, 3.0), st.floats(0.1, 0.9))
def test_free_fall_is_free_fall(up: float, across: float, seconds: float) -> None:
    time, com = thrown(up, across, seconds)
    spin = np.tile([1.0, -2.0, 3.0], (len(time), 1))
    found = ballistics(Flight(0.0, time[-1], 0.0, 0.0), time, com, spin, G)
    assert found is not None
    assert found.fall == pytest.approx(G, rel=1e-6)
    assert found.off_path == pytest.approx(0.0, abs=1e-9)
    assert found.rise_free == pytest.approx(up**2 / (2 * G), rel=1e-9)
    assert found.rise <= found.rise_free + 1e-9
    assert found.momentum_change == pytest.approx(0.0, abs=1e-12)


def test_a_flight_that_hangs_in_the_air_is_told() -> None:
    time, com = thrown(2.0, 1.0, 0.4)
    com[:, 2] = 0.9 + 0.5 * (com[:, 2] - 0.9)
    found = ballistics(Flight(0.0, time[-1], 0.0, 0.0), time, com, np.zeros_like(com), G)
    assert found is not None
    assert found.fall == pytest.approx(G / 2, rel=1e-6)
    assert found.rise_ratio is not None
    assert found.rise_ratio == pytest.approx(0.5, rel=0.05)
    assert found.off_path > 0.05


def test_a_spin_that_changes_in_the_air_is_told() -> None:
    time, com = thrown(2.0, 0.0, 0.4)
    spin = np.column_stack([0 * time, 0 * time, 4.0 * time / time[-1]])
    found = ballistics(Flight(0.0, time[-1], 0.0, 0.0), time, com, spin, G)
    assert found is not None
    assert found.momentum_change == pytest.approx(2.0, rel=0.05)


def test_a_flicker_says_nothing() -> None:
    time, com = thrown(1.0, 0.0, 0.5)
    assert ballistics(Flight(0.0, 0.02, 0.0, 0.0), time, com, com, G) is None
