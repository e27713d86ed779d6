"""How a servo protects itself: Hardware Error Status(70) and the shutdown that only a reboot ends.

Source: e-manual, Shutdown(63), Min/Max Voltage Limit, Temperature Limit. What the manual leaves
open is ours: how long a load must last (2 s), how high it is (80 % of the stall current), and when
power is "insufficient to operate the motor" (80 % of Min Voltage Limit with torque on). Errors are
kept until a reboot, those that Shutdown does not name as well.
"""

from __future__ import annotations

from enpointe.hardware.emulator.memory import Memory
from enpointe.hardware.emulator.motor import Motor
from enpointe.hardware.hardware_error import HardwareError
from enpointe.hardware.units import TENTH_VOLT

__all__ = ["OVERLOAD_SECONDS", "OVERLOAD_SHARE", "HardwareError", "Protection"]

OVERLOAD_SECONDS = 2.0
"""A load beyond `OVERLOAD_SHARE` for so long is an overload."""
OVERLOAD_SHARE = 0.8
"""Of the stall current."""
_STARVED = 0.8
"""Share of Min Voltage Limit below which a motor can't be run."""


class Protection:
    """Watches one servo.

    Attributes:
        shut: Whether a masked error has taken the torque away until a reboot.
    """

    def __init__(self, memory: Memory, motor: Motor) -> None:
        self._memory = memory
        self._motor = motor
        self._loaded = 0.0
        self.shut = False

    def reset(self) -> None:
        """Forget everything, as a reboot does."""
        self._loaded = 0.0
        self.shut = False

    def watch(self, supply: float, period: float) -> bool:
        """Look at one period; true if torque must go now.

        Args:
            supply: V.
            period: s.
        """
        memory = self._memory
        found = self._found(supply, period)
        if not found:
            return False
        if found & ~memory["Hardware Error Status"]:
            memory["Hardware Error Status"] |= found
        if self.shut or not found & memory["Shutdown"]:
            return False
        self.shut = True
        return True

    def _found(self, supply: float, period: float) -> int:
        memory, motor = self._memory.values, self._motor
        low, high = memory["Min Voltage Limit"], memory["Max Voltage Limit"]
        found = 0
        tenths = round(supply / TENTH_VOLT)
        if not low <= tenths <= high:
            found |= HardwareError.INPUT_VOLTAGE
        if memory["Torque Enable"] and tenths < _STARVED * low:
            found |= HardwareError.ELECTRICAL_SHOCK
        if motor.temperature > memory["Temperature Limit"]:
            found |= HardwareError.OVERHEATING
        loaded = abs(motor.current) >= OVERLOAD_SHARE * motor.model.stall_current
        self._loaded = self._loaded + period if loaded else 0.0
        if self._loaded >= OVERLOAD_SECONDS:
            found |= HardwareError.OVERLOAD
        return found
