"""The registers that a rig uses, and that they are the same for all its servos.

A sync packet has one address for all, so that a bus of several models needs them to agree.
"""

from __future__ import annotations

from collections.abc import Iterable

from enpointe.errors import RigError
from enpointe.hardware.control_table import Register, control_table

__all__ = ["CURRENT_BASED", "POSITION", "common"]

POSITION, CURRENT_BASED = 3, 5
"""Operating modes that a rig uses."""
_NAMES = (
    "Torque Enable",
    "Status Return Level",
    "Hardware Error Status",
    "Position D Gain",
    "Position I Gain",
    "Position P Gain",
    "Feedforward 2nd Gain",
    "Feedforward 1st Gain",
    "Bus Watchdog",
    "Goal PWM",
    "Profile Acceleration",
    "Profile Velocity",
    "Goal Position",
    "Present Velocity",
    "Present Position",
    "Present Input Voltage",
    "Present Temperature",
)


def common(numbers: Iterable[int]) -> dict[str, Register]:
    """The registers that a rig talks to in sync packets, which must be alike in all its models.

    Args:
        numbers: Model numbers.

    Raises:
        RigError: Two models keep one of them in different places.
    """
    found: dict[str, Register] = {}
    for number in sorted(set(numbers)):
        own = control_table(number)
        for name in _NAMES:
            register = found.setdefault(name, own[name])
            if (own[name].address, own[name].size) != (register.address, register.size):
                raise RigError(
                    f"servo model {number} has {name} at {own[name].address}, others at"
                    f" {register.address}; they can't share a bus with one rig"
                )
        if "Goal Current" in own:
            found.setdefault("Goal Current", own["Goal Current"])
    return found
