"""Counts and SI units, there and back, over every register that a rig uses."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from enpointe.errors import RigError
from enpointe.hardware import servo_models
from enpointe.hardware.control_table import Register, control_table
from enpointe.hardware.dynamixel.checks import settings_of
from enpointe.hardware.dynamixel.codec import Codec
from enpointe.hardware.dynamixel.frames import FRAME
from enpointe.hardware.dynamixel.registers import common
from enpointe.hardware.rig_file import load_rig
from enpointe.hardware.units import PULSE, VELOCITY

from .benches import small_rig

EVERYBODY = common(model.number for model in servo_models().values())
USED: list[Register] = [
    *EVERYBODY.values(),
    *(control_table(1020)[name] for name in settings_of(load_rig("puppet").servos[0])),
    *(control_table(1020)[name] for name in ("Present Current", "Temperature Limit")),
    *(control_table(1020)[name] for name in ("Min Voltage Limit", "Max Voltage Limit")),
]


@pytest.mark.parametrize("register", USED, ids=lambda register: register.name)
@given(data=st.data())
def test_every_register_keeps_every_value_and_its_sign(
    register: Register, data: st.DataObject
) -> None:
    value = data.draw(st.integers(register.lowest, register.highest))
    sent = register.encode(value)
    assert len(sent) == register.size
    assert register.decode(sent) == value
    beyond = data.draw(st.sampled_from([register.lowest - 1, register.highest + 1]))
    with pytest.raises(RigError, match="bytes hold"):
        register.encode(beyond)


def test_what_can_be_negative_is_signed() -> None:
    signed = {"Goal Position", "Present Position", "Present Velocity", "Goal Current",
              "Bus Watchdog", "Goal PWM", "Homing Offset", "Present Current"}  # fmt: skip
    for register in USED:
        assert register.signed == (register.name in signed), register.name


@pytest.mark.parametrize("name", servo_models())
def test_all_models_have_the_frame_in_one_place(name: str) -> None:
    table = control_table(servo_models()[name].number)
    address, size = FRAME
    first = "Present Current" if "Present Current" in table else "Present Load"
    assert (table[first].address, table[first].size) == (address, 2)
    assert (table["Present Velocity"].address, table["Present Velocity"].size) == (address + 2, 4)
    assert table["Present Position"].address == address + 6
    assert table["Present Position"].end == address + size


@given(st.lists(st.floats(-1.0, 1.0), min_size=3, max_size=3))
def test_angles_come_back_within_half_a_pulse(angles: list[float]) -> None:
    codec = Codec.of(small_rig())
    joints = np.array(angles)
    assert np.allclose(codec.angle(codec.pulses(joints)), joints, atol=1e-12)
    rounded = np.rint(codec.pulses(joints)).astype(np.int64)
    assert np.abs(codec.angle(rounded) - joints).max() <= PULSE / 2 + 1e-12


def test_signs_turn_everything_and_offsets_only_positions() -> None:
    codec = Codec.of(small_rig(2))
    zero = codec.pulses(np.zeros(2))
    assert zero == pytest.approx(2048 + np.array([10.0, 20.0]) / 360.0 * 4096)
    counts = np.array([100, 100])
    assert codec.velocity(counts) == pytest.approx([100 * VELOCITY, -100 * VELOCITY])
    assert codec.current(counts) == pytest.approx([0.269, -0.269])
    assert codec.effort(counts)[0] > 0.0 > codec.effort(counts)[1]
    assert codec.degrees(0, 2048) == pytest.approx(-10.0)


def test_the_stall_current_is_the_stall_torque_and_friction() -> None:
    rig = small_rig(1)
    codec, sheet = Codec.of(rig), rig.servos[0].sheet
    counts = np.array([round(sheet.stall_current / 2.69e-3)])
    assert codec.effort(counts)[0] == pytest.approx(sheet.stall_torque + sheet.friction, rel=2e-3)


def test_limits_are_those_of_the_file() -> None:
    rig = load_rig("puppet")
    codec = Codec.of(rig)
    for place, servo in enumerate(rig.servos):
        ends = sorted((codec.degrees(place, int(codec.low[place])),
                       codec.degrees(place, int(codec.high[place]))))  # fmt: skip
        assert ends[0] == pytest.approx(servo.limits[0], abs=math.degrees(PULSE))
        assert ends[1] == pytest.approx(servo.limits[1], abs=math.degrees(PULSE))
