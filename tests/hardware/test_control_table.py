"""Registers of the SDK's tables, and their codec."""

from __future__ import annotations

import re
from itertools import pairwise

import pytest
from hypothesis import given
from hypothesis import strategies as st

from enpointe.errors import RigError
from enpointe.hardware import (
    ControlTable,
    Register,
    control_table,
    datasheet,
    datasheet_of,
    servo_models,
)
from enpointe.hardware.control_table import known_models

X_SERIES = sorted(n for n, name in known_models().items() if name[0] == "x" and name != "xl320")
EVERY_REGISTER = sorted(
    {register for number in X_SERIES for register in control_table(number).registers},
    key=lambda register: (register.address, register.name),
)


@given(st.sampled_from(EVERY_REGISTER), st.data())
def test_every_register_of_every_model_keeps_every_value(
    register: Register, data: st.DataObject
) -> None:
    value = data.draw(st.integers(register.lowest, register.highest))
    wire = register.encode(value)
    assert len(wire) == register.size
    assert register.decode(wire) == value
    unsigned = int.from_bytes(wire, "little")
    assert unsigned == value % (1 << 8 * register.size)


@given(st.sampled_from(EVERY_REGISTER), st.integers(1, 2**33))
def test_a_value_that_does_not_fit_is_refused(register: Register, beyond: int) -> None:
    for value in (register.lowest - beyond, register.highest + beyond):
        with pytest.raises(RigError, match=re.escape(register.name)):
            register.encode(value)
    with pytest.raises(RigError, match="bytes"):
        register.decode(bytes(register.size + 1))


@pytest.mark.parametrize("number", X_SERIES)
def test_no_two_registers_share_a_byte(number: int) -> None:
    registers = control_table(number).registers
    for register, following in pairwise(registers):
        assert register.end <= following.address


def test_goals_and_present_values_have_signs_and_only_goals_are_written() -> None:
    table = control_table(1020)
    for name in ("Goal Position", "Goal Velocity", "Goal Current", "Goal PWM"):
        assert table[name].signed
        assert table[name].writable
        assert table[name.replace("Goal", "Present")].signed
        assert not table[name.replace("Goal", "Present")].writable
    assert not table["Profile Velocity"].signed


def slots(table: ControlTable) -> list[tuple[int, int]]:
    return [(address.address, data.address) for address, data in table.indirect]


def test_indirect_registers_stand_where_the_manual_has_them() -> None:
    large, small = slots(control_table(1020)), slots(control_table(1220, 52))
    assert (large[0], large[27], large[28], large[55]) == (
        (168, 224),
        (222, 251),
        (578, 634),
        (632, 661),
    )
    assert (small[0], small[19], len(small)) == ((168, 208), (206, 227), 20)
    assert slots(control_table(1220, 51))[0] == (168, 224)


@pytest.mark.parametrize("number", [0, 350, 2000, 9999])
def test_other_models_are_refused(number: int) -> None:
    with pytest.raises(RigError, match=str(number)):
        control_table(number)


@pytest.mark.parametrize("name", servo_models())
def test_a_datasheet_and_its_registers_agree(name: str) -> None:
    sheet = datasheet(name)
    assert datasheet_of(sheet.number) is sheet
    table = control_table(sheet.number)
    assert ("Current Limit" in table) == (sheet.current_unit is not None) == (0 in sheet.modes)
    in_table = {register for register in sheet.initial if register in table}
    rest = set(sheet.initial) - in_table
    assert all(each.startswith(("External Port", "PWM Slope")) for each in rest)
    assert all(
        table[each].lowest <= sheet.initial[each] <= table[each].highest for each in in_table
    )


@pytest.mark.parametrize("name", servo_models())
def test_the_motor_constants_give_back_the_datasheet(name: str) -> None:
    sheet = datasheet(name)
    assert sheet.torque_at(0.0) == pytest.approx(sheet.stall_torque, rel=1e-12)
    assert sheet.torque_at(sheet.no_load_speed) == pytest.approx(
        0.0, abs=1e-12 * sheet.stall_torque
    )
    assert sheet.torque_at(0.5 * sheet.no_load_speed) == pytest.approx(0.5 * sheet.stall_torque)


def test_an_unknown_servo_is_refused_with_those_there_are() -> None:
    with pytest.raises(RigError, match="XM430-W350"):
        datasheet("AX-12")
    with pytest.raises(RigError, match="1020"):
        datasheet_of(12)
