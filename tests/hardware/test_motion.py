"""What an emulated servo's motor, loop and profile do to a load."""

from __future__ import annotations

import math

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from enpointe.hardware import datasheet, servo_models
from enpointe.hardware.emulator import Fault, FaultKind, Load
from enpointe.hardware.emulator.motor import ROOM, Motor
from enpointe.hardware.emulator.profile import Profile, ProfileKind
from enpointe.hardware.units import PULSE, VELOCITY

from .rigs import Rig


@pytest.mark.parametrize("name", servo_models())
def test_full_pwm_turns_an_unloaded_horn_at_the_no_load_speed(name: str) -> None:
    rig = Rig(model=name, settings={"Operating Mode": 16})
    rig.set("Torque Enable", 1)
    rig.set("Goal PWM", 885)
    rig.wait(1.0)
    sheet = datasheet(name)
    assert rig.bus.plant.velocity()[0] == pytest.approx(sheet.no_load_speed, rel=1e-3)
    assert rig.get("Present Velocity") * VELOCITY == pytest.approx(
        sheet.no_load_speed, abs=VELOCITY
    )


@pytest.mark.parametrize("name", servo_models())
def test_a_held_horn_gives_the_stall_torque_and_draws_the_stall_current(name: str) -> None:
    rig = Rig(model=name, settings={"Operating Mode": 16}, faults=[Fault(FaultKind.STALL)])
    rig.set("Torque Enable", 1)
    rig.set("Goal PWM", -885)
    rig.wait(0.05)
    motor, sheet = rig.servos[0].motor, datasheet(name)
    assert -motor.torque - sheet.friction == pytest.approx(sheet.stall_torque)
    assert -motor.current == pytest.approx(sheet.stall_current)
    assert motor.drawn == pytest.approx(sheet.stall_current)


def test_current_mode_gives_the_current_asked_until_back_emf_forbids_it() -> None:
    rig = Rig(settings={"Operating Mode": 0}, faults=[Fault(FaultKind.STALL, duration=(0.5, 0.5))])
    rig.set("Torque Enable", 1)
    rig.set("Goal Current", 400)
    rig.wait(0.1)
    assert rig.get("Present Current") == 400
    rig.wait(2.0)
    assert 0 <= rig.get("Present Current") < 40


def test_velocity_mode_holds_a_velocity_against_a_weight() -> None:
    load = Load(0.1, 0.03, gravity=0.5)
    rig = Rig(settings={"Operating Mode": 1}, loads=[load])
    rig.set("Torque Enable", 1)
    rig.set("Goal Velocity", -60)
    rig.wait(1.0)
    for _ in range(10):
        rig.wait(0.1)
        assert rig.get("Present Velocity") == pytest.approx(-60, abs=8)


def test_a_weight_sags_by_the_stiffness_of_the_position_gain() -> None:
    """P = 800 is 6.25 counts of PWM a pulse: 12 V / 885 of it over R, times k_t."""
    sheet = datasheet("XM430-W350")
    stiffness = 800 / 128 / PULSE * (12.0 / 885) / sheet.resistance * sheet.torque_constant
    assert stiffness == pytest.approx(19.0, rel=0.02)
    weight = 1.0
    load = Load(0.05, 0.0, gravity=weight, hanging=-math.pi / 2)
    rig = Rig(loads=[load])
    rig.set("Torque Enable", 1)
    rig.wait(3.0)
    sag = -rig.bus.plant.position()[0]
    assert sag == pytest.approx(weight * math.cos(sag) / stiffness, abs=PULSE)


def test_current_based_position_never_exceeds_its_current() -> None:
    load = Load(0.05, 0.03, gravity=1.5, hanging=-math.pi / 2)
    rig = Rig(settings={"Operating Mode": 5}, loads=[load])
    rig.set("Torque Enable", 1)
    rig.set("Goal Current", 250)
    rig.set("Goal Position", 3000)
    for _ in range(100):
        rig.wait(0.01)
        assert abs(rig.get("Present Current")) <= 251


def test_a_weaker_supply_is_a_slower_servo() -> None:
    speeds = []
    for volts in (12.0, 10.0):
        rig = Rig(settings={"Operating Mode": 16}, volts=volts)
        rig.set("Torque Enable", 1)
        rig.set("Goal PWM", 885)
        rig.wait(1.0)
        assert rig.get("Present Input Voltage") == round(volts * 10)
        speeds.append(rig.bus.plant.velocity()[0])
    assert speeds[1] / speeds[0] == pytest.approx(10 / 12, abs=0.01)


def test_heat_rises_with_the_square_of_the_current_and_settles() -> None:
    motor = Motor(datasheet("XM430-W350"))
    motor.drive(0.2, 12.0, 0.0, 1.0)
    low = motor.temperature - ROOM
    motor.temperature = ROOM
    motor.drive(0.4, 12.0, 0.0, 1.0)
    assert (motor.temperature - ROOM) / low == pytest.approx(4.0)
    for _ in range(20_000):
        motor.drive(0.3, 12.0, 0.0, 1.0)
    settled = motor.temperature
    motor.drive(0.3, 12.0, 0.0, 1.0)
    assert motor.temperature == pytest.approx(settled, abs=1e-6)
    seconds, hot = 0, Motor(datasheet("XM430-W350"))
    while hot.temperature < 80.0:
        hot.drive(1.0, 12.0, 0.0, 1.0)
        seconds += 1
    assert 90 < seconds < 150


def travel(profile: Profile, period: float = 0.001) -> tuple[float, float, float]:
    """s to arrive, fastest and hardest on the way."""
    count, fastest, hardest = 0, 0.0, 0.0
    while profile.ongoing:
        before = profile.velocity
        profile.advance(period)
        count += 1
        fastest = max(fastest, abs(profile.velocity))
        if profile.ongoing:
            hardest = max(hardest, abs(profile.velocity - before) / period)
        assert count < 100_000
    return count * period, fastest, hardest


@settings(max_examples=40)
@given(
    st.floats(-3000, 3000).filter(lambda goal: abs(goal) > 50),
    st.floats(100, 3000),
    st.floats(500, 20_000),
)
def test_a_profile_arrives_within_its_speed_and_acceleration(
    goal: float, speed: float, acceleration: float
) -> None:
    profile = Profile(0.0)
    profile.aim(goal, speed, acceleration)
    distance = abs(goal)
    triangle = distance < speed**2 / acceleration
    expected = (
        2 * math.sqrt(distance / acceleration)
        if triangle
        else distance / speed + speed / acceleration
    )
    assert profile.kind == (ProfileKind.TRIANGULAR if triangle else ProfileKind.TRAPEZOIDAL)
    duration, fastest, hardest = travel(profile)
    assert profile.position == goal
    assert fastest <= speed * (1 + 1e-9)
    assert hardest <= acceleration * (1 + 1e-9)
    assert duration == pytest.approx(expected, rel=0.03, abs=0.02)


def test_a_time_based_profile_arrives_on_time() -> None:
    for rise in (0.0, 0.2, 0.9):
        profile = Profile(100.0)
        profile.aim_in(1500.0, 1.0, rise)
        duration, _, _ = travel(profile)
        assert duration == pytest.approx(1.0, abs=0.02)


def test_a_new_goal_on_the_way_is_taken_on_at_speed() -> None:
    profile = Profile(0.0)
    profile.aim(2000.0, 1000.0, 2000.0)
    for _ in range(800):
        profile.advance(0.001)
    speed = profile.velocity
    profile.aim(-500.0, 1000.0, 2000.0)
    profile.advance(0.001)
    assert profile.velocity == pytest.approx(speed - 2.0)
    travel(profile)
    assert profile.position == -500.0


def test_moving_status_tells_the_profile_and_the_arrival() -> None:
    rig = Rig()
    rig.set("Torque Enable", 1)
    assert rig.get("Moving Status") == 0x01
    rig.set("Profile Velocity", 100)
    rig.set("Profile Acceleration", 20)
    rig.set("Goal Position", 3000)
    rig.wait(0.4)
    assert rig.get("Moving Status") & 0x33 == 0x32
    assert rig.get("Moving") == 1
    assert 0 < rig.get("Velocity Trajectory") <= 100
    rig.wait(3.0)
    assert rig.get("Moving Status") & 0x0B == 0x01
    assert rig.get("Moving") == 0
    assert rig.get("Position Trajectory") == 3000
