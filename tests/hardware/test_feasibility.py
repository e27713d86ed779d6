"""What servos can dance, against cases whose answer is known and against the emulated motors."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from enpointe.errors import RigError
from enpointe.hardware import datasheet
from enpointe.hardware.demand import Collision, Demand, GroundRows
from enpointe.hardware.emulator.motor import ROOM, Motor
from enpointe.hardware.feasibility import Assessment, assess
from enpointe.hardware.limits import JointLimit, currents
from enpointe.hardware.time_scale import SLOWEST, Rows, allowed_speeds
from enpointe.hardware.warming import warmth

Array = NDArray[np.float64]
XM430 = datasheet("XM430-W350")
TIME = np.linspace(0.0, 1.0, 201)
FREE = JointLimit("knee", XM430, -3.0, 3.0, reserve=0.0)


def swing(
    amplitude: float, *, weight: float = 0.0, inertia: float = XM430.armature, hz: float = 1.0
) -> Demand:
    """One joint to and fro, with a weight on a horizontal arm (N m)."""
    w = 2.0 * np.pi * hz
    angle = amplitude * np.sin(w * TIME)
    speed, rise = amplitude * w * np.cos(w * TIME), -amplitude * w**2 * np.sin(w * TIME)
    arrays = (angle, speed, rise, np.full_like(TIME, weight), inertia * rise)
    return demand_of(arrays)


def demand_of(arrays: tuple[Array, ...], time: Array = TIME) -> Demand:
    """What one joint is asked: its position, velocity, acceleration, static and dynamic torque."""
    position, velocity, acceleration, static, dynamic = (array[:, None] for array in arrays)
    return Demand(("knee",), time, position, velocity, acceleration, static, dynamic)


def looked_at(demand: Demand, limit: JointLimit = FREE, **rest: int) -> Assessment:
    return assess(demand, [limit], **rest)


def test_what_is_easy_is_feasible_as_it_is_written() -> None:
    found = looked_at(swing(0.3))
    assert (found.feasible, found.time_scale, found.limiting_joints) == (True, 1.0, ())
    assert found.nearest[0].joint == "knee"
    assert found.nearest[0].used < 1.0


def test_a_speed_twice_the_motors_own_takes_twice_the_time() -> None:
    # 276 deg/s without load: a swing without weight or inertia that goes twice as fast.
    amplitude = 2.0 * XM430.no_load_speed / (2.0 * np.pi)
    found = looked_at(swing(amplitude, inertia=0.0))
    assert not found.feasible
    assert found.time_scale == pytest.approx(2.0, rel=2e-3)
    assert found.limiting_joints == ("knee",)
    worst = {excess.kind: excess for excess in found.excesses}
    assert worst["speed"].time in (0.0, 0.5, 1.0)
    assert worst["speed"].needed == pytest.approx(2.0 * XM430.no_load_speed, rel=1e-6)
    assert worst["speed"].allowed == pytest.approx(XM430.no_load_speed, rel=2e-3)


def test_the_rigs_own_limit_is_kept_before_the_motors() -> None:
    found = looked_at(swing(0.5), replace(FREE, speed=1.0))
    assert found.time_scale == pytest.approx(0.5 * 2.0 * np.pi, rel=1e-4)
    assert found.decisive is not None
    assert (found.decisive.joint, found.decisive.kind) == ("knee", "speed")


@pytest.mark.parametrize("turned", [1.0, -1.0])
@pytest.mark.parametrize("share", [0.2, 0.6, 0.9])
def test_torque_at_speed_is_the_datasheets_line(share: float, turned: float) -> None:
    speed = share * XM430.no_load_speed
    line = XM430.torque_at(speed)
    for torque, feasible in ((0.99 * line, True), (1.01 * line, False)):
        arrays = (
            0 * TIME,
            0 * TIME + turned * speed,
            0 * TIME,
            turned * torque + 0 * TIME,
            0 * TIME,
        )
        demand = demand_of(arrays)
        assert looked_at(demand).feasible is feasible


def test_a_weight_too_heavy_is_not_mended_by_time() -> None:
    found = looked_at(swing(0.3, weight=1.05 * XM430.stall_torque))
    assert found.time_scale is None
    assert {excess.kind for excess in found.hopeless} >= {"torque", "current"}


def test_beyond_the_joints_range_is_not_mended_by_time() -> None:
    found = looked_at(swing(0.5), replace(FREE, upper=0.4))
    assert found.time_scale is None
    (hopeless,) = found.hopeless
    assert (hopeless.kind, hopeless.allowed) == ("position", 0.4)
    assert hopeless.needed == pytest.approx(0.5, abs=1e-3)
    ((low, high),) = hopeless.spans
    assert low < 0.25 < high


def test_less_current_takes_more_time() -> None:
    demand = swing(0.6, hz=1.5)
    free = looked_at(demand)
    scarce = looked_at(demand, replace(FREE, current=0.5 * np.abs(currents(demand, [FREE])).max()))
    assert free.time_scale is not None
    assert scarce.time_scale is not None
    assert scarce.time_scale > free.time_scale
    assert {excess.kind for excess in scarce.excesses} >= {"current"}


def test_a_weak_supply_takes_more_time() -> None:
    demand = swing(0.7)
    full, weak = (looked_at(demand, replace(FREE, voltage=v)).time_scale for v in (12.0, 9.5))
    assert full is not None
    assert weak is not None
    assert weak > 1.1 * full


def test_a_throw_that_only_speed_makes_possible_is_not_slowed() -> None:
    # Held by the swing of the limb, not by the motor: in twice the time the motor can't hold it.
    lift = -1.5 * XM430.stall_torque
    arrays = (0 * TIME, 0 * TIME, 0 * TIME, 0 * TIME - lift, 0 * TIME + lift)
    demand = demand_of(arrays)
    assert looked_at(demand).feasible
    assert looked_at(demand.scaled(2.0)).time_scale is None


movements = st.builds(
    swing,
    st.floats(0.05, 2.5),
    weight=st.floats(-3.0, 3.0),
    inertia=st.floats(0.045, 0.3),
    hz=st.floats(0.2, 4.0),
)


@settings(max_examples=60, deadline=None)
@given(movements, st.floats(1.0, 8.0))
def test_the_scale_is_enough_and_two_per_cent_less_is_not(demand: Demand, speed: float) -> None:
    limit = replace(FREE, speed=speed)
    found = looked_at(demand, limit)
    if found.time_scale is None:
        assert found.hopeless
        return
    assert looked_at(demand.scaled(found.time_scale), limit).feasible
    if not found.feasible:
        assert not looked_at(demand.scaled(max(found.time_scale / 1.02, 1.0)), limit).feasible


@settings(max_examples=60, deadline=None)
@given(st.lists(st.tuples(*[st.floats(-3.0, 3.0)] * 3), min_size=1, max_size=6))
def test_allowed_speeds_are_those_that_no_row_forbids(terms: list[tuple[float, ...]]) -> None:
    square, linear, constant = np.array(terms).T
    nobody = np.zeros(len(terms), dtype=np.int64)
    rows = Rows("torque", nobody, nobody, square, linear, constant)
    allowed = allowed_speeds([rows])
    for speed in np.linspace(1.0 / SLOWEST, 1.0, 400):
        worst = float(rows.used(speed).max()) - 1.0
        inside = any(low <= speed <= high for low, high in allowed)
        if abs(worst) > 1e-6:
            assert inside == (worst < 0.0)


@pytest.mark.parametrize("share", [0.0, 0.3, 0.5])
def test_heat_is_what_the_emulated_motor_gets(share: float) -> None:
    motor, seconds = Motor(XM430), 40.0
    period = 1e-3
    time = np.arange(0.0, seconds + 0.5 * period, period)
    duty = share * (1.0 + np.sin(time))
    current = duty * XM430.voltage / XM430.resistance
    for each in duty[:-1]:
        motor.drive(float(each), XM430.voltage, 0.0, period)
    found = warmth(time, current[:, None], [XM430])
    assert float(found.rise[-1, 0]) == pytest.approx(motor.temperature - ROOM, rel=2e-3, abs=1e-9)


def test_repeats_end_where_the_servo_is_too_hot() -> None:
    current = np.full((41, 1), 1.4)
    found = warmth(np.linspace(0.0, 40.0, 41), current, [XM430])
    (repeats,) = found.repeats()
    assert repeats is not None
    assert repeats >= 2
    limit = XM430.initial["Temperature Limit"]
    assert found.after(repeats)[0] <= limit < found.after(repeats + 1)[0]
    # And by hand: one long dance of as many repeats is as warm as that.
    whole = np.linspace(0.0, 40.0 * repeats, 40 * repeats + 1)
    long = warmth(whole, np.full((len(whole), 1), 1.4), [XM430])
    assert long.after(1)[0] == pytest.approx(found.after(repeats)[0], rel=1e-6)


def test_a_dance_repeated_until_it_is_too_hot_is_infeasible() -> None:
    demand = swing(0.05, weight=2.4)
    assert looked_at(demand).feasible
    found = looked_at(demand, repeats=500)
    assert not found.feasible
    assert {excess.kind for excess in found.excesses} == {"heat"}


def test_a_load_that_shuts_the_servo_down_is_infeasible() -> None:
    arrays = (0 * TIME, 0 * TIME, 0 * TIME, 0 * TIME + 0.9 * XM430.stall_torque, 0 * TIME)
    demand = demand_of(arrays, 3.0 * TIME)
    found = looked_at(demand)
    assert found.time_scale is None
    assert {excess.kind for excess in found.hopeless} == {"overload"}


def test_what_the_floor_cannot_give_is_named() -> None:
    # Thrown off its feet by its own movement: (c + d s^2) beyond the edge, at rest 1 cm inside.
    row = GroundRows("balance", "m", np.array([100]), np.array([-0.01]), np.array([0.04]))
    found = looked_at(replace(swing(0.1), ground=(row,)))
    assert found.time_scale == pytest.approx(2.0, rel=1e-5)
    assert found.limiting_joints == ()
    (excess,) = found.excesses
    assert (excess.kind, excess.time, excess.unit) == ("balance", 0.5, "m")
    assert excess.needed == pytest.approx(0.03)


def test_a_body_in_its_own_way_is_not_mended_by_time() -> None:
    hit = Collision("left hand", "head", 0.4, 0.6, 0.5, 0.01)
    found = looked_at(replace(swing(0.1), collisions=(hit,)))
    assert (found.feasible, found.time_scale) == (False, None)
    assert found.summary()["collisions"]


def test_the_summary_is_json() -> None:
    import json

    figures = json.loads(json.dumps(looked_at(swing(2.5)).summary()))
    assert figures["feasible"] is False
    assert figures["time_scale"] > 1.0
    assert {entry["joint"] for entry in figures["limiting_joints"]} == {"knee"}


@pytest.mark.parametrize("joints", [("hip",), ("knee", "hip")])
def test_limits_of_other_joints_are_refused(joints: tuple[str, ...]) -> None:
    with pytest.raises(RigError):
        assess(swing(0.1), [replace(FREE, joint=joint) for joint in joints])
