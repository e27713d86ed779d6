"""Connect checks: each thing that is wrong is one line with the servo, the joint and what to do."""

from __future__ import annotations

import math
from dataclasses import replace

import pytest

from enpointe.errors import RigError
from enpointe.hardware.dynamixel import Layout, Link, ServoRig, check_rig, description_of
from enpointe.hardware.emulator import EmulatedPort, Loads, VirtualClock, bus_of
from enpointe.hardware.rig_file import load_rig

from .benches import bench, small_rig


@pytest.mark.parametrize("name", ["puppet", "op3"])
def test_a_rig_as_it_should_be_has_no_findings(name: str) -> None:
    assert check_rig(load_rig(name), bench(load_rig(name)).link) == []


WRONG = [
    ({"Return Delay Time": 250}, "250 x 2 us", "--set-up"),
    ({"Drive Mode": 1}, "drive mode is 1", "--set-up"),
    ({"Operating Mode": 3}, "operating mode is 3", "--set-up"),
    ({"Homing Offset": 500}, "homing offset of 500", "--set-up"),
    ({"Shutdown": 0}, "unprotected", "--set-up"),
    ({"Current Limit": 100}, "current limit of 100", "--set-up"),
    ({"Max Position Limit": 2100}, "Max Position Limit is 2100", "--set-up"),
    ({"Status Return Level": 0}, "answers a ping and not a read", "68"),
    ({"Min Voltage Limit": 130}, "12.0 V", "supply"),
]


@pytest.mark.parametrize(("settings", "what", "todo"), WRONG)
def test_a_wrong_setting_is_told_and_what_to_do(
    settings: dict[str, int], what: str, todo: str
) -> None:
    if "Status Return Level" in settings:
        made = bench()
        made.bus.servos[0].memory["Status Return Level"] = 0
    else:
        made = bench(settings=settings)
    found = [finding for finding in check_rig(made.rig, made.link) if what in finding.what]
    assert len(found) == 1
    line = str(found[0])
    assert "servo 1 (joint_1)" in line
    assert todo in line
    assert "\n" not in line


def test_what_set_up_would_write_mends_it() -> None:
    made = bench(settings={"Return Delay Time": 250, "Drive Mode": 1})
    findings = check_rig(made.rig, made.link)
    mends = {finding.setting for finding in findings if finding.setting is not None}
    assert ("Return Delay Time", 0) in mends
    for name, value in mends:
        servo = made.bus.servos[0]
        servo.memory[name] = value
        servo.horn.settings_changed()
    assert check_rig(made.rig, made.link) == []


def test_a_missing_servo_another_model_and_old_firmware() -> None:
    rig = small_rig()
    described = description_of(rig)
    servos = list(described.servos)
    other = replace(servos[1], model="XM430-W210")
    old = replace(servos[2], firmware=40)
    bus, clock = bus_of(replace(described, servos=(other, old))), VirtualClock()
    port = EmulatedPort(bus, clock)
    assert port.setBaudRate(rig.baud)
    lines = [str(finding) for finding in check_rig(rig, Link(port))]
    assert len(lines) == 3
    assert "no answer at 1000000 bit/s" in lines[0]
    assert "it is a XM430-W210, not a XM430-W350" in lines[1]
    assert "fast_read = false" in lines[2]


@pytest.mark.parametrize(("degrees", "what"), [(75.0, "stands at 75"), (-70.0, "stands at -70")])
def test_a_joint_outside_its_limits_is_told_where_it_stands(degrees: float, what: str) -> None:
    rig = small_rig()
    described = description_of(rig)
    servo = rig.servos[0]
    horn = math.radians(servo.sign * degrees + servo.offset)
    first = replace(described.servos[0], angle=horn)
    bus = bus_of(replace(described, servos=(first, *described.servos[1:])))
    port = EmulatedPort(bus, VirtualClock())
    assert port.setBaudRate(rig.baud)
    found = check_rig(rig, Link(port))
    assert len(found) == 1
    assert what in found[0].what


def test_counted_turns_are_told() -> None:
    """Position is counted on in the multi-turn modes, and lost without power."""
    made = bench()
    assert isinstance(made.bus.plant, Loads)
    made.bus.plant.turn_by_hand(0, 2.0 * math.pi + 0.2)
    made.clock.sleep_until(0.01)
    found = check_rig(made.rig, made.link)
    assert len(found) == 1
    assert "turns" in found[0].what


def test_an_alarm_and_heat_are_told() -> None:
    made = bench()
    made.bus.servos[2].motor.temperature = 78.0
    made.clock.sleep_until(0.01)
    lines = [str(finding) for finding in check_rig(made.rig, made.link)]
    assert len(lines) == 1
    assert "78 C" in lines[0]
    made.bus.servos[2].motor.temperature = 90.0
    made.clock.sleep_until(made.clock.now() + 0.01)
    lines = [str(finding) for finding in check_rig(made.rig, made.link)]
    assert any("overheating" in line for line in lines)


def test_a_rig_with_a_finding_does_not_begin_and_nothing_was_switched_on() -> None:
    made = bench(settings={"Homing Offset": 300})
    with pytest.raises(RigError, match="homing offset"):
        ServoRig(made.rig, made.link, Layout.bare(made.rig), made.clock)
    assert made.torque() == [False, False, False]
