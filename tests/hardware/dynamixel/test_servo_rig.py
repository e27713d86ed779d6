"""The rig as a body: a dance from rest to rest, and what happens when it can't go on."""

from __future__ import annotations

import signal
from collections.abc import Callable
from itertools import pairwise

import numpy as np
import pytest

from enpointe.controllers.protocol import Body
from enpointe.errors import RigError
from enpointe.hardware.dynamixel import Ending, SafetyLimits, ServoRig, StopButton
from enpointe.hardware.emulator import Fault, FaultKind, Written
from enpointe.hardware.emulator import servo as emulated

from .benches import Bench, ask, bench, small_rig, swing


def danced(made: Bench, seconds: float = 0.6, **rest: object) -> ServoRig:
    with made.servo(**rest) as body:
        body.start(np.zeros(len(made.rig.servos)))
        swing(body, seconds)
        body.finish()
    return body


def test_it_is_a_body() -> None:
    with bench().servo() as body:
        assert isinstance(body, Body)
        assert body.period == 0.01


def test_a_dance_ends_parked_where_it_began_with_torque_off() -> None:
    made = bench()
    before = [servo.position for servo in made.bus.servos]
    body = danced(made)
    assert body.fault is None
    assert body.statistics.ending is Ending.PARKED
    assert made.torque() == [False, False, False]
    assert np.abs(np.subtract([s.position for s in made.bus.servos], before)).max() < 60


def test_joints_follow_in_their_own_sense() -> None:
    made = bench(small_rig(2))
    with made.servo() as body:
        body.start(np.zeros(2))
        wanted = np.array([0.4, -0.2])
        for _ in range(100):
            body.write(ask(wanted))
        state = body.read()
        assert state.qpos == pytest.approx(wanted, abs=0.03)
        assert state.valid.all()
        assert np.all(state.age < 0.02)
        horn = made.bus.plant.position()
        assert horn[0] == pytest.approx(0.4 + np.radians(10.0), abs=0.03)
        assert horn[1] == pytest.approx(0.2 + np.radians(20.0), abs=0.03)


def test_two_runs_are_the_same_bit_for_bit() -> None:
    def run() -> list[bytes]:
        made = bench(faults=[Fault(FaultKind.DROP, probability=0.03)], seed=5)
        seen = []
        with made.servo() as body:
            body.start(np.zeros(3))
            for k in range(60):
                body.write(ask(np.full(3, 0.3 * np.sin(0.1 * k))))
                state = body.read()
                seen.append(state.qpos.tobytes() + state.age.tobytes() + state.effort.tobytes())
        return seen

    assert run() == run()


def test_what_is_observed_has_the_same_keys_and_shapes_each_time() -> None:
    with bench().servo() as body:
        body.start(np.zeros(3))
        shapes = []
        for _ in range(10):
            body.write(ask(np.zeros(3)))
            shapes.append({name: value.shape for name, value in body.observe().items()})
    assert all(shape == shapes[0] for shape in shapes)
    assert {"goal", "limited", "slowed", "temperature", "voltage", "alarm"} <= set(shapes[0])


def test_nothing_moves_faster_than_the_ramp_before_the_dance() -> None:
    made = bench()
    goals: list[Written] = []
    made.bus.watch(lambda each: goals.append(each) if each.register == "Goal Position" else None)
    with made.servo(limits=SafetyLimits(ramp=0.2, ramp_speed=0.5)) as body:
        body.start(np.full(3, 0.5))
        own = [each for each in goals if each.servo == 1]
        steps = [
            abs(b.value - a.value) / (b.time - a.time) for a, b in pairwise(own) if b.time > a.time
        ]
        assert max(steps) <= (0.5 / 0.00153398 + 1.0 / 0.01) * 1.01
        assert body.read().qpos == pytest.approx(np.full(3, 0.5), abs=0.03)


def test_a_greedy_controller_is_held_within_limits_and_it_is_seen() -> None:
    made = bench()
    with made.servo() as body:
        body.start(np.zeros(3))
        for _ in range(100):
            body.write(ask(np.array([9.0, -9.0, 0.0])))
        seen = body.observe()
        assert seen["limited"].tolist() == [True, True, False]
        limit = np.radians(60.0)
        assert np.abs(body.read().qpos).max() < limit + 0.03


def test_ctrl_c_parks_and_a_second_one_lets_go_at_once() -> None:
    made, stop = bench(), StopButton()
    with made.servo(stop=stop) as body:
        body.start(np.zeros(3))
        stop.press()
        swing(body, 0.5)
        assert body.fault == "stopped by hand"
        assert all(made.torque())
        body.finish()
        assert body.statistics.ending is Ending.PARKED
    twice, stop = bench(), StopButton()
    with twice.servo(stop=stop) as body:
        body.start(np.zeros(3))
        stop.press()
        swing(body, 0.5)
        stop.press()
        begun = twice.clock.now()
        body.finish()
        assert twice.clock.now() - begun < 0.1
        assert body.statistics.ending is Ending.OFF
    assert not any(twice.torque())


def test_signals_press_the_button() -> None:
    stop = StopButton()
    before = signal.getsignal(signal.SIGINT)
    with stop.on_signals():
        signal.raise_signal(signal.SIGINT)
        assert stop.presses == 1
        signal.raise_signal(signal.SIGTERM)
        assert stop.presses == 2
    assert signal.getsignal(signal.SIGINT) is before


def test_an_exception_on_the_way_lets_go() -> None:
    made = bench()

    def failing() -> None:
        with made.servo() as body:
            body.start(np.zeros(3))
            raise ZeroDivisionError

    with pytest.raises(ZeroDivisionError):
        failing()
    assert not any(made.torque())


AT = (1.0, 1.0)
GRAVE = [
    (Fault(FaultKind.OVERHEAT, (2,), AT), "joint_2"),
    (Fault(FaultKind.MISSING, (3,), AT), "joint_3"),
    (Fault(FaultKind.BROWN_OUT, (), AT, amount=7.0), "supply"),
    (Fault(FaultKind.DROP, (1,), AT), "joint_1"),
]


@pytest.mark.parametrize(("fault", "who"), GRAVE, ids=lambda each: getattr(each, "kind", each))
def test_a_grave_fault_lets_go_in_time_and_says_who(fault: Fault, who: str) -> None:
    made = bench(faults=[fault])
    off: dict[int, float] = {}

    def see(written: Written) -> None:
        if written.register == "Torque Enable" and not written.value:
            off.setdefault(written.servo, written.time)

    with made.servo() as body:
        body.start(np.zeros(3))
        assert made.clock.now() < 1.0
        made.bus.watch(see)
        swing(body, 3.0)
        assert body.fault is not None
        assert who in body.fault
    for servo in made.bus.servos:
        unpowered = fault.kind is FaultKind.MISSING and servo.id in fault.ids
        shut = servo.protection.shut
        assert unpowered or shut or 1.0 < off[servo.id] <= 1.2


@pytest.mark.parametrize("fast", [True, False])
def test_a_cable_that_lost_contact_for_a_moment_is_noticed(
    fast: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The servo boots quicker than the rig bears silence, and would hang loose in the dance."""
    monkeypatch.setattr(emulated, "BOOT_SECONDS", 0.02)
    contact = Fault(FaultKind.MISSING, (2,), AT, duration=(0.02, 0.02))
    made = bench(small_rig(fast_read=fast), faults=[contact])
    with made.servo() as body:
        body.start(np.zeros(3))
        swing(body, 3.0)
        assert body.fault is not None
        assert "joint_2" in body.fault
        assert "has let go" in body.fault
    assert made.clock.now() < AT[0] + 0.2
    assert not any(made.torque())


def test_unplugged_servos_are_stopped_by_their_own_watchdogs_and_it_is_said() -> None:
    made = bench(faults=[Fault(FaultKind.UNPLUG, at=AT)])
    body = danced(made, 3.0)
    assert body.fault is not None
    assert "gone" in body.fault
    assert body.statistics.ending is Ending.UNCONFIRMED
    assert body.statistics.unconfirmed == (1, 2, 3)
    made.bus.run_until(1.2)
    assert all(servo.memory["Bus Watchdog"] == -1 for servo in made.bus.servos)


def test_a_jammed_joint_lets_go() -> None:
    made = bench(faults=[Fault(FaultKind.STALL, (2,), AT)])
    with made.servo() as body:
        body.start(np.zeros(3))
        for _ in range(200):
            if body.fault is None:
                away = 0.9 if made.clock.now() > AT[0] else 0.0
                body.write(ask(np.full(3, away)))
        assert body.fault is not None
        assert "joint_2" in body.fault
    assert not any(made.torque())


def test_one_lost_packet_in_a_hundred_does_not_stop_a_dance() -> None:
    for fast in (True, False):
        rig = small_rig(fast_read=fast)
        made = bench(rig, [Fault(FaultKind.DROP, probability=0.01)], seed=1)
        body = danced(made, 5.0)
        assert body.fault is None
        assert body.statistics.frame_loss > 0.0
        assert body.statistics.ending is Ending.PARKED


def test_a_loop_that_stood_still_lets_go() -> None:
    """Its servos have stopped by themselves and take no goal any more."""
    made = bench()
    with made.servo() as body:
        body.start(np.zeros(3))
        made.clock.sleep_until(made.clock.now() + 0.3)
        body.write(ask(np.zeros(3)))
        assert body.fault is not None
        assert "stood still" in body.fault
    assert not any(made.torque())


@pytest.mark.parametrize("nonsense", [np.nan, np.inf])
def test_a_controller_gone_mad_parks(nonsense: float) -> None:
    made = bench()
    with made.servo() as body:
        body.start(np.zeros(3))
        body.write(ask(np.array([nonsense, 0.0, 0.0])))
        assert body.fault is not None
        assert "no number" in body.fault
        body.finish()
        assert body.statistics.ending is Ending.PARKED


def trip(made: Bench) -> None:
    for servo in made.bus.servos:
        servo.memory["Bus Watchdog"] = -1


def leave_on(made: Bench) -> None:
    for servo in made.bus.servos:
        assert made.link.write(servo.id, servo.memory.table["Torque Enable"], 1) == 0


@pytest.mark.parametrize("before", [trip, leave_on])
def test_what_another_program_left_behind_is_no_hindrance(before: Callable[[Bench], None]) -> None:
    made = bench()
    before(made)
    assert danced(made).statistics.ending is Ending.PARKED


def test_a_fault_on_the_way_to_the_first_pose_is_a_refusal_in_a_line() -> None:
    made = bench(faults=[Fault(FaultKind.OVERHEAT, (2,), (0.3, 0.3))])
    with pytest.raises(RigError, match=r"first pose.*joint_2"), made.servo() as body:
        body.start(np.full(3, 0.9))
    assert not any(made.torque())
