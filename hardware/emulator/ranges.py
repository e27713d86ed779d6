"""Which values a register takes: fixed ranges, and limits set in other registers.

Source: the Range columns of the e-manual's control tables. A value outside a fixed range is a Data
Range Error, one beyond a limit that another register holds a Data Limit Error (protocol 2.0,
status packet).
"""

from __future__ import annotations

from enpointe.hardware.control_table import Register
from enpointe.hardware.datasheet import ServoModel
from enpointe.hardware.emulator.memory import Memory
from enpointe.hardware.packets import StatusError
from enpointe.hardware.units import FULL_PWM, TENTH_VOLT

__all__ = ["GOALS", "allowed"]

GOALS = frozenset({"Goal PWM", "Goal Current", "Goal Velocity", "Goal Position"})
"""What a servo follows; locked after a bus watchdog error."""

_POSITION = 3
_MANY_TURNS = 1_048_575
"""Pulses either way in the multi-turn modes: 256 turns."""
_GAIN = (0, 16_383)
_RANGES: dict[str, tuple[int, int]] = {
    "ID": (0, 252),
    "Return Delay Time": (0, 254),
    "Drive Mode": (0, 15),
    "Homing Offset": (-1_044_479, 1_044_479),
    "Moving Threshold": (0, 1_023),
    "Temperature Limit": (0, 100),
    "PWM Limit": (0, FULL_PWM),
    "Max Position Limit": (0, 4_095),
    "Min Position Limit": (0, 4_095),
    "External Port Mode 1": (0, 3),
    "External Port Mode 2": (0, 3),
    "External Port Mode 3": (0, 3),
    "Startup Configuration": (0, 3),
    "PWM Slope": (1, 255),
    "Torque Enable": (0, 1),
    "LED": (0, 1),
    "Status Return Level": (0, 2),
    "Velocity I Gain": _GAIN,
    "Velocity P Gain": _GAIN,
    "Position D Gain": _GAIN,
    "Position I Gain": _GAIN,
    "Position P Gain": _GAIN,
    "Feedforward 2nd Gain": _GAIN,
    "Feedforward 1st Gain": _GAIN,
    "Bus Watchdog": (0, 127),
    "Profile Acceleration": (0, 32_767),
    "Profile Velocity": (0, 32_767),
}
_SMALL = ("XC330", "XL330")
"""Families with another processor: no 4.5 Mbps, other protocol types."""


def allowed(memory: Memory, model: ServoModel, register: Register, value: int) -> StatusError:
    """Whether a register may be set to a value now; torque and latches are not looked at."""
    if register.name in GOALS:
        inside = abs(value) <= _most(memory, register.name)
        if register.name == "Goal Position" and memory["Operating Mode"] == _POSITION:
            inside = memory["Min Position Limit"] <= value <= memory["Max Position Limit"]
        return StatusError.NONE if inside else StatusError.DATA_LIMIT
    if register.name == "Operating Mode":
        inside = value in model.modes
    else:
        low, high = _range(model, register, memory.table.size)
        inside = low <= value <= high
    return StatusError.NONE if inside else StatusError.DATA_RANGE


def _most(memory: Memory, goal: str) -> int:
    return _MANY_TURNS if goal == "Goal Position" else memory[f"{goal.removeprefix('Goal ')} Limit"]


def _range(model: ServoModel, register: Register, end: int) -> tuple[int, int]:
    small = model.name.startswith(_SMALL)
    name = register.name
    if name == "Baud Rate":
        return 0, 6 if small else 7
    if name == "Protocol Type":
        return (2, 22) if small else (1, 2)
    if name in ("Max Voltage Limit", "Min Voltage Limit"):
        low, high = model.voltage_limits
        return round(low / TENTH_VOLT), round(high / TENTH_VOLT)
    if name == "Current Limit" and model.current_limit is not None:
        return 0, model.current_limit
    if name == "Velocity Limit":
        return 0, model.velocity_range
    if name.startswith("Indirect Address"):
        return 64, end - 1
    return _RANGES.get(name, (register.lowest, register.highest))
