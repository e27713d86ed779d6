"""How stiff a servo is about its goal, and how braked: what its position loop makes of it."""

from __future__ import annotations

from enpointe.hardware.rig_file import RigServo
from enpointe.hardware.units import FULL_PWM, PULSE

__all__ = ["damping", "stiffness"]


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


def damping(servo: RigServo) -> float:
    """N m s/rad that a servo is short of while it turns.

    In position mode its goal sets a voltage, of which the motor's own takes k_e v away, and with it
    the torque k_t k_e v / R. With a current limit its current is regulated, and nothing is missing.
    """
    sheet = servo.sheet
    if servo.current and sheet.current_unit is not None:
        return 0.0
    return sheet.torque_constant * sheet.back_emf / sheet.resistance
