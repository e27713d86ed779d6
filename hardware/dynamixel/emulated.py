"""The rig of a file as an emulated bus: its servos set up as they should be, at rest at zero."""

from __future__ import annotations

import math
from collections.abc import Sequence

from enpointe.hardware.dynamixel.checks import settings_of
from enpointe.hardware.emulator.description import BusDescription, ServoDescription
from enpointe.hardware.rig_file import Rig

__all__ = ["description_of"]

_INERTIA = 5e-4
"""kg m^2 beside the rotor's: 50 g of limb at 0.1 m."""
_GRAVITY = 0.05
"""N m of the same limb held level."""


def description_of(rig: Rig, pose: Sequence[float] | None = None) -> BusDescription:
    """Servos of a rig on a bus of their own, each with a light limb that hangs at joint zero.

    Args:
        rig: What to stand in for.
        pose: Joint angles at first, rad; zero if None, brought within the limits.
    """
    angles = [0.0] * len(rig.servos) if pose is None else pose
    servos = []
    for servo, angle in zip(rig.servos, angles, strict=True):
        low, high = servo.range
        zero = math.radians(servo.offset)
        horn = servo.sign * min(max(angle, low), high) + zero
        servos.append(
            ServoDescription(
                servo.id,
                servo.model,
                settings=settings_of(servo),
                inertia=_INERTIA,
                gravity=_GRAVITY,
                hanging=zero,
                angle=horn,
            )
        )
    return BusDescription(tuple(servos), baud=rig.baud)
