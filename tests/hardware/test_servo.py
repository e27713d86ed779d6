"""What an emulated servo takes, refuses and does, register by register."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from dynamixel_sdk import COMM_RX_TIMEOUT

from enpointe.errors import RigError
from enpointe.hardware import datasheet
from enpointe.hardware.emulator import Fault, FaultKind, Load, Servo, Written

from .rigs import TABLE, Rig

DONE = (0, 0)
FAIL, RANGE, LENGTH, LIMIT, ACCESS = 1, 4, 5, 6, 7
ALERT = 0x80
TURN = 2 * np.pi


def test_settings_are_locked_while_torque_is_on() -> None:
    rig = Rig()
    rig.set("Max Position Limit", 3000)
    rig.set("Torque Enable", 1)
    assert rig.write("Max Position Limit", 2000) == (0, ACCESS)
    assert rig.get("Max Position Limit") == 3000
    rig.set("Torque Enable", 0)
    rig.set("Max Position Limit", 2000)


@pytest.mark.parametrize("name", ["Present Position", "Model Number", "Moving", "Realtime Tick"])
def test_what_the_servo_writes_nobody_else_does(name: str) -> None:
    assert Rig().write(name, 1) == (0, ACCESS)


@pytest.mark.parametrize(
    ("name", "value", "error"),
    [
        ("Max Position Limit", 4096, RANGE),
        ("Baud Rate", 8, RANGE),
        ("Operating Mode", 2, RANGE),
        ("Torque Enable", 2, RANGE),
        ("Position P Gain", 16384, RANGE),
        ("Bus Watchdog", -1, RANGE),
        ("Current Limit", 1194, RANGE),
        ("Min Voltage Limit", 94, RANGE),
        ("Indirect Address 1", 63, RANGE),
        ("Goal PWM", 886, LIMIT),
        ("Goal Current", -1194, LIMIT),
        ("Goal Velocity", 351, LIMIT),
        ("Goal Position", 4096, LIMIT),
        ("Goal Position", -1, LIMIT),
    ],
)
def test_values_out_of_range_and_beyond_limits_are_told_apart(
    name: str, value: int, error: int
) -> None:
    rig = Rig()
    before = rig.get(name)
    assert rig.write(name, value) == (0, error)
    assert rig.get(name) == before


def test_limits_are_those_that_were_set() -> None:
    rig = Rig(settings={"Min Position Limit": 1000, "Max Position Limit": 3000})
    assert rig.write("Goal Position", 999) == (0, LIMIT)
    assert rig.write("Goal Position", 3001) == (0, LIMIT)
    assert rig.write("Goal Position", 3000) == DONE


def test_half_a_register_can_be_read_but_not_written() -> None:
    rig = Rig()
    register = TABLE["Goal Position"]
    for address in (register.address, register.address + 2):
        written = rig.packets.writeTxRx(rig.port, 1, address, 2, [0, 0])
        assert written == (0, LENGTH)
    assert rig.packets.readTxRx(rig.port, 1, register.address + 1, 2)[1:] == DONE


def test_where_there_is_no_register_there_is_no_access() -> None:
    rig = Rig()
    assert rig.packets.readTxRx(rig.port, 1, 14, 2)[2] == ACCESS
    assert rig.packets.writeTxRx(rig.port, 1, 14, 1, [1]) == (0, ACCESS)
    assert rig.packets.readTxRx(rig.port, 1, 700, 4)[2] == ACCESS


def test_a_write_of_several_registers_is_done_whole_or_not_at_all() -> None:
    rig = Rig()
    first, second = TABLE["Profile Acceleration"], TABLE["Profile Velocity"]
    data = [*first.encode(50), *second.encode(100)]
    assert rig.packets.writeTxRx(rig.port, 1, first.address, 8, data) == DONE
    assert (rig.get(first.name), rig.get(second.name)) == (50, 100)
    bad = [*first.encode(60), *second.encode(40000)]
    assert rig.packets.writeTxRx(rig.port, 1, first.address, 8, bad) == (0, RANGE)
    assert rig.get(first.name) == 50


def test_indirect_data_are_the_registers_they_point_at() -> None:
    rig = Rig()
    places = [TABLE["Present Position"].address + i for i in range(4)] + [TABLE["LED"].address]
    for slot, place in enumerate(places, start=1):
        rig.set(f"Indirect Address {slot}", place)
    start = TABLE["Indirect Data 1"].address
    data, result, error = rig.packets.readTxRx(rig.port, 1, start, 5)
    assert (result, error) == DONE
    assert int.from_bytes(bytes(data[:4]), "little") == rig.get("Present Position") == 2048
    assert rig.packets.write1ByteTxRx(rig.port, 1, start + 4, 1) == DONE
    assert rig.get("LED") == 1
    assert rig.packets.write1ByteTxRx(rig.port, 1, start, 1) == (0, LENGTH)


def test_a_group_hears_its_secondary_id_and_stays_silent() -> None:
    rig = Rig(3, settings={"Secondary(Shadow) ID": 100})
    assert rig.write("LED", 1, 100)[0] == COMM_RX_TIMEOUT
    rig.write("Return Delay Time", 9, 100)
    assert [rig.get("LED", number) for number in rig.ids] == [1, 1, 1]
    assert [rig.get("Return Delay Time", number) for number in rig.ids] == [0, 0, 0]


def test_reboot_forgets_ram_and_keeps_settings() -> None:
    rig = Rig()
    rig.set("Max Position Limit", 3000)
    rig.set("Position P Gain", 100)
    rig.set("Torque Enable", 1)
    assert rig.packets.reboot(rig.port, 1) == DONE
    assert rig.packets.ping(rig.port, 1)[1] == COMM_RX_TIMEOUT
    rig.wait(0.2)
    assert rig.get("Torque Enable") == 0
    assert rig.get("Position P Gain") == 800
    assert rig.get("Max Position Limit") == 3000


@pytest.mark.parametrize(("option", "kept"), [(0x01, {"ID"}), (0x02, {"ID", "Baud Rate"})])
def test_factory_reset_keeps_what_it_is_told_to(option: int, kept: set[str]) -> None:
    rig = Rig(settings={"ID": 9, "Baud Rate": 3, "Max Position Limit": 3000})
    servo = rig.servos[0]
    assert rig.packets.factoryReset(rig.port, 9, option)[0] == 0
    assert servo.memory["ID"] == (9 if "ID" in kept else 1)
    assert servo.memory["Baud Rate"] == (3 if "Baud Rate" in kept else 1)
    assert servo.memory["Max Position Limit"] == 4095


def backup(rig: Rig, kind: int) -> int:
    packet = [0] * 15
    packet[4:13] = [1, 8, 0, 0x20, kind, 0x43, 0x54, 0x52, 0x4C]
    _, result, error = rig.packets.txRxPacket(rig.port, packet)
    assert result == 0
    return int(error)


def test_a_backup_brings_settings_back() -> None:
    rig = Rig()
    assert backup(rig, 2) == FAIL
    rig.set("Max Position Limit", 3000)
    rig.set("Torque Enable", 1)
    assert backup(rig, 1) == FAIL
    rig.set("Torque Enable", 0)
    assert backup(rig, 1) == 0
    assert rig.get("Backup Ready") == 1
    rig.set("Max Position Limit", 2000)
    assert backup(rig, 2) == 0
    rig.wait(0.2)
    assert rig.get("Max Position Limit") == 3000


def test_the_bus_watchdog_stops_a_servo_that_nobody_talks_to() -> None:
    rig = Rig(settings={"Operating Mode": 1})
    rig.set("Torque Enable", 1)
    rig.set("Goal Velocity", 100)
    rig.set("Bus Watchdog", 5)
    for _ in range(5):
        rig.wait(0.09)
        assert rig.get("Bus Watchdog") == 5
    assert rig.get("Present Velocity") > 80
    rig.wait(1.0)
    assert rig.get("Bus Watchdog") == -1
    assert abs(rig.get("Present Velocity")) <= 1
    assert rig.write("Goal Velocity", 150) == (0, RANGE)
    rig.set("Bus Watchdog", 0)
    rig.set("Goal Velocity", 150)
    rig.wait(0.5)
    assert rig.get("Present Velocity") > 120


def test_the_watchdog_sleeps_while_torque_is_off() -> None:
    rig = Rig()
    rig.set("Bus Watchdog", 1)
    rig.wait(1.0)
    assert rig.get("Bus Watchdog") == 1


@pytest.mark.parametrize(
    ("fault", "bit"),
    [
        (Fault(FaultKind.OVERHEAT, at=(0.1, 0.1)), 0x04),
        (Fault(FaultKind.BROWN_OUT, at=(0.1, 0.1), amount=7.0), 0x10),
    ],
)
def test_shutdown_lasts_until_a_reboot(fault: Fault, bit: int) -> None:
    rig = Rig(faults=[replace(fault, duration=(0.5, 0.5))])
    rig.set("Torque Enable", 1)
    rig.wait(1.0)
    assert rig.servos[0].memory["Hardware Error Status"] & bit
    result, error = rig.write("LED", 1)
    assert (result, error) == (0, ALERT)
    assert rig.get("Torque Enable") == 0
    assert rig.write("Torque Enable", 1) == (0, ALERT | FAIL)
    assert rig.get("Torque Enable") == 0
    rig.servos[0].motor.temperature = 30.0
    assert rig.packets.reboot(rig.port, 1)[0] == 0
    rig.wait(0.2)
    rig.set("Torque Enable", 1)


def test_an_unmasked_error_is_told_and_torque_stays() -> None:
    rig = Rig(settings={"Shutdown": 0}, volts=17.0)
    rig.wait(0.01)
    assert rig.write("Torque Enable", 1) == (0, ALERT)
    rig.wait(0.1)
    assert rig.get("Torque Enable") == 1
    assert rig.get("Hardware Error Status") == 0x01


def test_a_stalled_motor_trips_the_overload_and_a_current_limit_saves_it() -> None:
    for mode, tripped in ((3, True), (5, False)):
        rig = Rig(settings={"Operating Mode": mode}, faults=[Fault(FaultKind.STALL)])
        rig.set("Torque Enable", 1)
        if mode == 5:
            rig.set("Goal Current", 300)
        rig.set("Goal Position", 3000)
        rig.wait(3.0)
        assert bool(rig.servos[0].memory["Hardware Error Status"] & 0x20) is tripped
        assert rig.servos[0].torque_on is not tripped


def test_a_deep_brown_out_reboots_and_forgets_the_turns() -> None:
    load = Load.of(datasheet("XM430-W350"), start=1.5 * TURN)
    fault = Fault(FaultKind.BROWN_OUT, at=(2.0, 2.0), duration=(0.2, 0.2), amount=3.0)
    rig = Rig(settings={"Operating Mode": 4}, loads=[load], faults=[fault])
    at_power_up = rig.get("Present Position")
    assert 0 <= at_power_up < 4096
    rig.set("Torque Enable", 1)
    rig.set("Goal Position", at_power_up + 4096)
    rig.wait(1.9)
    assert rig.get("Present Position") == pytest.approx(at_power_up + 4096, abs=10)
    rig.wait(0.2)
    assert rig.packets.ping(rig.port, 1)[1] == COMM_RX_TIMEOUT
    rig.wait(0.5)
    assert rig.get("Torque Enable") == 0
    assert 0 <= rig.get("Present Position") < 4096


def test_homing_offset_and_reverse() -> None:
    quarter = Load.of(datasheet("XM430-W350"), start=TURN / 8)
    assert Rig(loads=[quarter]).get("Present Position") == 2048 + 512
    shifted = Rig(loads=[quarter], settings={"Homing Offset": -500})
    assert shifted.get("Present Position") == 2048 + 512 - 500
    ignored = Rig(loads=[quarter], settings={"Homing Offset": 1025})
    assert ignored.get("Present Position") == 2048 + 512
    turned = Rig(loads=[quarter], settings={"Drive Mode": 1, "Homing Offset": -500})
    assert turned.get("Present Position") in (2048 - 512 - 500, 2048 - 512 - 501)


def test_reverse_turns_the_horn_the_other_way() -> None:
    angles = []
    for drive in (0, 1):
        rig = Rig(settings={"Drive Mode": drive})
        rig.set("Torque Enable", 1)
        rig.set("Goal Position", 2500)
        rig.wait(1.0)
        assert rig.get("Present Position") == pytest.approx(2500, abs=5)
        angles.append(rig.bus.plant.position()[0])
    assert angles[0] == pytest.approx(-angles[1], abs=0.01)
    assert angles[0] > 0.6


def test_torque_on_stays_where_it_is() -> None:
    """A goal left from before is forgotten."""
    rig = Rig()
    rig.set("Goal Position", 3000)
    rig.set("Torque Enable", 1)
    rig.wait(0.5)
    assert rig.get("Present Position") == 2048


def test_torque_on_by_goal_update() -> None:
    rig = Rig(settings={"Drive Mode": 8})
    rig.set("Goal Position", 2300)
    rig.wait(1.0)
    assert rig.get("Torque Enable") == 1
    assert rig.get("Present Position") == pytest.approx(2300, abs=5)


def test_clear_forgets_turns_and_is_refused_in_motion() -> None:
    rig = Rig(settings={"Operating Mode": 4})
    rig.set("Torque Enable", 1)
    rig.set("Goal Position", 2048 + 3 * 4096)
    rig.wait(0.5)
    assert rig.packets.clearMultiTurn(rig.port, 1) == (0, FAIL)
    rig.wait(5.0)
    assert rig.get("Present Position") > 3 * 4096
    assert rig.packets.clearMultiTurn(rig.port, 1) == DONE
    assert 0 <= rig.get("Present Position") < 4096


def test_switching_modes_starts_gains_profile_and_goals_again() -> None:
    rig = Rig()
    for name, value in (("Position P Gain", 100), ("Profile Velocity", 50), ("Goal PWM", 10)):
        rig.set(name, value)
    rig.set("Operating Mode", 5)
    assert rig.get("Position P Gain") == 800
    assert rig.get("Profile Velocity") == 0
    assert rig.get("Goal PWM") == rig.get("PWM Limit")
    assert rig.get("Goal Current") == rig.get("Current Limit")


def test_a_servo_without_a_current_sensor_has_no_current_modes() -> None:
    rig = Rig(model="XL430-W250")
    for mode, error in ((0, RANGE), (5, RANGE), (1, 0), (3, 0), (4, 0), (16, 0)):
        assert rig.write("Operating Mode", mode) == (0, error)


def test_every_write_is_told_to_whoever_watches() -> None:
    rig = Rig(2)
    told: list[Written] = []
    rig.bus.watch(told.append)
    rig.set("Torque Enable", 1)
    rig.writer([2100, 1900]).txPacket()
    rig.write("Goal Position", 9999, 2)
    rig.wait(0.01)
    assert [(each.servo, each.register, each.value) for each in told] == [
        (1, "Torque Enable", 1),
        (1, "Goal Position", 2100),
        (2, "Goal Position", 1900),
    ]
    assert all(0 < each.time < rig.clock.now() for each in told)


@pytest.mark.parametrize(
    "settings", [{"Torque Enable": 1}, {"Return Delay Time": 255}, {"Nonsense": 1}]
)
def test_settings_that_are_none_are_refused(settings: dict[str, int]) -> None:
    with pytest.raises(RigError, match=next(iter(settings))):
        Servo(datasheet("XM430-W350"), 1, settings=settings)
