"""What a servo says of itself: the registers that it alone writes, brought up to date."""

from __future__ import annotations

from enpointe.hardware.emulator.horn import Horn
from enpointe.hardware.emulator.memory import Memory
from enpointe.hardware.emulator.motor import Motor
from enpointe.hardware.emulator.regulator import Mode, Regulator
from enpointe.hardware.units import FULL_PWM, PULSE, TENTH_VOLT, VELOCITY

__all__ = ["moving", "report"]

_IN_POSITION = 10
_LAGGING = 100
"""Ours: pulses within which a servo has arrived, and beyond which it lags its profile."""


def moving(memory: Memory, horn: Horn) -> bool:
    """Whether it turns faster than Moving Threshold(24)."""
    return abs(round(horn.speed / VELOCITY)) > memory["Moving Threshold"]


def report(
    memory: Memory, motor: Motor, horn: Horn, regulator: Regulator, time: float, supply: float
) -> None:
    """Write the present values.

    Args:
        memory: Where to.
        motor: PWM, current and temperature.
        horn: Position and velocity.
        regulator: The trajectory followed.
        time: s.
        supply: V.
    """
    profile, position = regulator.profile, horn.position
    memory["Realtime Tick"] = int(time * 1000.0) % 32_768
    memory["Moving"] = int(moving(memory, horn))
    memory["Moving Status"] = _moving_status(memory, regulator, position)
    memory["Present PWM"] = round(horn.sense * motor.duty * FULL_PWM)
    if "Present Load" in memory:
        memory["Present Load"] = round(horn.sense * motor.duty * 1000.0)
    elif motor.model.current_unit is not None:
        memory["Present Current"] = round(horn.sense * motor.current / motor.model.current_unit)
    memory["Present Velocity"] = round(horn.sense * horn.speed / VELOCITY)
    memory["Present Position"] = position
    memory["Velocity Trajectory"] = round(profile.velocity * PULSE / VELOCITY)
    memory["Position Trajectory"] = round(profile.position)
    memory["Present Input Voltage"] = round(supply / TENTH_VOLT)
    memory["Present Temperature"] = min(max(round(motor.temperature), 0), 255)


def _moving_status(memory: Memory, regulator: Regulator, position: int) -> int:
    if not Mode(memory["Operating Mode"]).follows_position:
        return 0
    profile = regulator.profile
    arrived = not profile.ongoing and abs(profile.goal - position) <= _IN_POSITION
    lags = memory["Torque Enable"] == 1 and abs(profile.position - position) > _LAGGING
    return int(profile.kind) | (lags << 3) | (profile.ongoing << 1) | int(arrived)
