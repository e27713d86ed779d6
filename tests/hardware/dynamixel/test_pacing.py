"""Deadlines on a grid: punctual, late, and given up, on a clock that is moved by hand."""

from __future__ import annotations

import pytest

from enpointe.hardware.clock import VirtualClock
from enpointe.hardware.dynamixel import Pacer


def busy(clock: VirtualClock, seconds: float) -> None:
    clock.sleep_until(clock.now() + seconds)


def test_a_punctual_loop_drifts_by_nothing() -> None:
    clock = VirtualClock()
    pacer = Pacer(clock, 0.01)
    pacer.start()
    for k in range(500):
        assert pacer.wait() == pytest.approx(0.0, abs=1e-9)
        assert clock.now() == pytest.approx(k * 0.01, abs=1e-9)
        busy(clock, 0.007)
    found = pacer.lateness()
    assert found.achieved == pytest.approx(100.0)
    assert found.misses == 0


def test_a_little_late_is_late_once_and_catches_up() -> None:
    clock = VirtualClock()
    pacer = Pacer(clock, 0.01)
    pacer.start()
    pacer.wait()
    busy(clock, 0.013)
    assert pacer.wait() == pytest.approx(0.003)
    busy(clock, 0.001)
    assert pacer.wait() == pytest.approx(0.0, abs=1e-9)
    assert clock.now() == pytest.approx(0.02)
    assert pacer.lateness().misses == 1


def test_lost_deadlines_are_given_up_and_not_made_up_for() -> None:
    clock = VirtualClock()
    pacer = Pacer(clock, 0.01)
    pacer.start()
    pacer.wait()
    busy(clock, 0.038)
    moments = []
    for _ in range(3):
        pacer.wait()
        moments.append(clock.now())
        busy(clock, 0.001)
    assert moments == pytest.approx([0.04, 0.05, 0.06])
    assert pacer.lateness().misses == 3
    assert pacer.lateness().worst == pytest.approx(0.0, abs=1e-9)


def test_a_loop_that_is_always_too_slow_says_so() -> None:
    clock = VirtualClock()
    pacer = Pacer(clock, 0.01)
    pacer.start()
    for _ in range(200):
        pacer.wait()
        busy(clock, 0.0125)
    assert pacer.lateness().achieved < 81.0
    assert pacer.lateness().misses > 150
