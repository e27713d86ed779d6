"""The gate: nothing asked, however wild and however late, gets past limits of range and speed."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from enpointe.errors import RigError
from enpointe.hardware.dynamixel import CommandGate

LOW, HIGH, SPEED, PERIOD = 1000, 3000, 2345.0, 0.01
wild = st.floats(allow_nan=True, allow_infinity=True, width=32) | st.floats(-5000, 9000)
waits = st.floats(0.0, 0.2)


def gate() -> CommandGate:
    found = CommandGate(np.array([LOW]), np.array([HIGH]), np.array([SPEED]), PERIOD)
    found.start(np.array([2048]), 0.0)
    return found


@given(st.lists(st.tuples(wild, waits), min_size=1, max_size=40))
def test_any_two_goals_keep_the_limits(asked: list[tuple[float, float]]) -> None:
    tested, now = gate(), 0.0
    sent = [(0.0, 2048)]
    for wanted, wait in asked:
        now += wait
        sent.append((now, int(tested.pass_on(np.array([wanted]), now).goal[0])))
    for place, (late, goal) in enumerate(sent):
        assert LOW <= goal <= HIGH
        for early, before in sent[:place]:
            assert abs(goal - before) <= SPEED * (late - early) + 1.0 + 1e-6


@given(st.lists(st.tuples(st.floats(-5000, 9000), waits), min_size=1, max_size=20))
def test_no_goal_is_further_than_one_period_of_way(asked: list[tuple[float, float]]) -> None:
    tested, now, before = gate(), 0.0, 2048
    for wanted, wait in asked:
        now += wait
        goal = int(tested.pass_on(np.array([wanted]), now).goal[0])
        assert abs(goal - before) <= SPEED * PERIOD + 1.0
        before = goal


@given(st.floats(LOW, HIGH))
def test_what_is_allowed_is_reached(wanted: float) -> None:
    tested = gate()
    for k in range(1, 200):
        passed = tested.pass_on(np.array([wanted]), k * PERIOD)
    assert abs(passed.goal[0] - wanted) <= 0.5
    assert not passed.limited.any()
    assert not passed.slowed.any()


def test_it_says_what_it_changed() -> None:
    tested = gate()
    far = tested.pass_on(np.array([9000.0]), PERIOD)
    assert far.limited.all()
    assert far.slowed.all()
    near = tested.pass_on(far.goal.astype(float) + 1.0, 2 * PERIOD)
    assert not near.limited.any()
    assert not near.slowed.any()


@pytest.mark.parametrize("nonsense", [np.nan, np.inf, -np.inf])
def test_what_is_no_number_is_refused_and_the_goal_stays(nonsense: float) -> None:
    tested = gate()
    before = tested.pass_on(np.array([2050.0]), PERIOD).goal
    refused = tested.pass_on(np.array([nonsense]), 2 * PERIOD)
    assert refused.refused
    assert refused.goal == before


def test_a_slow_joint_still_moves() -> None:
    """Less than a pulse a period must add up."""
    tested = CommandGate(np.array([0]), np.array([4095]), np.array([30.0]), 0.005)
    tested.start(np.array([2000]), 0.0)
    for k in range(1, 201):
        goal = tested.pass_on(np.array([4000.0]), k * 0.005).goal[0]
    assert goal == pytest.approx(2030, abs=1)


def test_it_begins_within_limits_wherever_the_servo_is() -> None:
    tested = gate()
    assert tested.start(np.array([3040]), 0.0) == HIGH


def test_it_must_be_started_and_asked_for_as_many_as_there_are() -> None:
    fresh = CommandGate(np.array([LOW]), np.array([HIGH]), np.array([SPEED]), PERIOD)
    with pytest.raises(RigError, match="not started"):
        fresh.pass_on(np.array([2000.0]), 0.0)
    with pytest.raises(RigError, match="1 goals"):
        gate().pass_on(np.zeros(2), 0.0)
    with pytest.raises(RigError, match="must rise"):
        CommandGate(np.array([HIGH]), np.array([LOW]), np.array([SPEED]), PERIOD)
