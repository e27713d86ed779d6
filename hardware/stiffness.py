"""How stiff a servo is about its goal: the spring that its position loop makes of it."""

from __future__ import annotations

from enpointe.hardware.rig_file import RigServo
from enpointe.hardware.units import FULL_PWM, PULSE

__all__ = ["stiffness"]


def stiffness(servo: RigServo) -> float:
    """N m/rad of a servo at rest, between friction and the limits of its current.

    With a current limit it runs in current-based position mode, where Position P Gain / 128 counts
    of current answer each pulse of error; without, in position mode, where they are counts of PWM
    (e-manual, Position PID Gain).
    """
    sheet = servo.sheet
    gain = (servo.gains[0] if servo.gains else sheet.initial["Position P Gain"]) / 128.0 / PULSE
    if servo.current and sheet.current_unit is not None:
        return gain * sheet.current_unit * sheet.torque_constant
    return gain / FULL_PWM * sheet.voltage / sheet.resistance * sheet.torque_constant
