"""Frames: what is fresh, how old the rest is, who has an alarm, and who is missing."""

from __future__ import annotations

import numpy as np
import pytest

from enpointe.hardware.dynamixel.frames import FrameReader
from enpointe.hardware.emulator import Fault, FaultKind
from enpointe.hardware.units import PULSE

from .benches import Bench, bench, small_rig


def reader(made: Bench, *, fast: bool = True) -> FrameReader:
    return FrameReader(made.link, made.rig.ids, made.clock, fast=fast)


def wait(made: Bench, seconds: float = 0.01) -> None:
    made.clock.sleep_until(made.clock.now() + seconds)


@pytest.mark.parametrize("fast", [True, False])
def test_a_whole_frame_is_fresh_and_says_where_everybody_is(fast: bool) -> None:
    made = bench()
    frame = reader(made, fast=fast).read()
    assert frame.whole
    assert np.all(frame.age == 0.0)
    assert frame.position.tolist() == [servo.position for servo in made.bus.servos]
    zero = [2048 + np.radians(servo.offset) / PULSE for servo in made.rig.servos]
    assert np.allclose(frame.position, zero, atol=1.0)


def test_negative_currents_and_velocities_have_their_sign() -> None:
    made = bench()
    made.bus.servos[1].motor.current = -0.5
    frame = reader(made).read()
    assert frame.current[1] == round(-0.5 / 2.69e-3)


def test_a_lost_frame_keeps_the_last_values_and_ages() -> None:
    made = bench(faults=[Fault(FaultKind.DROP, at=(0.005, 0.005), duration=(0.1, 0.1))])
    tested = reader(made)
    first = tested.read()
    wait(made)
    begun = made.clock.now()
    lost = tested.read()
    assert not lost.fresh.any()
    assert np.array_equal(lost.position, first.position)
    assert np.all(lost.age >= made.clock.now() - begun)
    assert tested.loss == 0.5


def test_who_never_answered_is_infinitely_old() -> None:
    made = bench(faults=[Fault(FaultKind.DROP)])
    assert np.all(np.isinf(reader(made).read().age))


@pytest.mark.parametrize("fast", [True, False])
@pytest.mark.parametrize("gone", [(1,), (2,), (3,), (4,), (1, 3)])
def test_missing_servos_silence_the_others_only_for_a_few_frames(
    gone: tuple[int, ...], fast: bool
) -> None:
    made = bench(small_rig(4), [Fault(FaultKind.MISSING, gone, at=(0.01, 0.01))])
    tested = reader(made, fast=fast)
    assert tested.read().whole
    for _ in range(5):
        wait(made)
        frame = tested.read()
    others = np.array([servo not in gone for servo in made.rig.ids])
    assert frame.fresh.tolist() == others.tolist()


def test_one_lost_answer_of_many_loses_no_other() -> None:
    """The SDK's own group throws the rest away."""
    made = bench(small_rig(4), [Fault(FaultKind.DROP, (2,))])
    frame = reader(made, fast=False).read()
    assert frame.fresh.tolist() == [True, False, True, True]


def test_it_is_fast_again_when_all_answer_for_a_while() -> None:
    made = bench(faults=[Fault(FaultKind.DROP, at=(0.01, 0.01), duration=(0.1, 0.1))])
    tested = reader(made)
    for _ in range(100):
        tested.read()
        wait(made)
    asked = made.link.counts.asked
    tested.read()
    assert made.link.counts.asked == asked + 1


@pytest.mark.parametrize("fast", [True, False])
def test_the_alarm_bit_is_not_thrown_away(fast: bool) -> None:
    made = bench()
    made.bus.servos[1].motor.temperature = 95.0
    wait(made)
    assert reader(made, fast=fast).read().alert.tolist() == [False, True, False]


def test_a_late_answer_of_one_servo_is_not_taken_for_that_of_all() -> None:
    made = bench(faults=[Fault(FaultKind.DELAY, (1,), duration=(0.02, 0.02), amount=0.03)])
    made.link.ping(1)
    tested = reader(made)
    for _ in range(5):
        tested.read()
        wait(made)
    assert tested.read().whole
