"""What is known of a servo's loop beforehand."""

from __future__ import annotations

import pytest

from enpointe.hardware.rig_file import load_rig
from enpointe.hardware.stiffness import damping, stiffness


def test_a_motor_without_current_control_is_braked_by_its_own_voltage() -> None:
    """At the speed without load all the supply is gone: d v is then the stall torque, friction
    and all."""
    servo = load_rig("op3").servos[0]
    sheet = servo.sheet
    gone = damping(servo) * sheet.no_load_speed + sheet.friction
    assert gone == pytest.approx(sheet.stall_torque + sheet.friction, rel=0.02)
    assert stiffness(servo) > 0.0


def test_one_whose_current_is_regulated_is_not() -> None:
    assert all(damping(servo) == 0.0 for servo in load_rig("puppet").servos if servo.current)
