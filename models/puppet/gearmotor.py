"""What a servo is to a body built of it: weight, size, torque, speed, inertia, friction.

Source: ROBOTIS e-manual, _data/dxl_x_info.yml (specifications at the recommended voltage).
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType

__all__ = ["GEARMOTORS", "Gearmotor"]

_ARMATURE = 0.045
"""kg m^2 at the horn of an XM430-W350: mujoco_menagerie, robotis_op3/op3.xml."""
_SPIN_UP = _ARMATURE * (46 * 2 * math.pi / 60) / 4.1
"""s in which an unloaded XM430-W350 comes to 63 % of its speed. Datasheets give no inertia, and
torque, speed and rotor of these servos grow together; the others are taken to need the same."""
_FRICTION = 0.03 / 4.1
"""Dry friction as a share of stall torque: 0.03 N m on an XM430-W350, from the same file."""


@dataclass(frozen=True, slots=True)
class Gearmotor:
    """One model's motor, gears and case.

    Attributes:
        name: "XM430-W350".
        mass: kg.
        dimensions: Width, height and depth of the case, m.
        voltage: V, recommended; the figures below are measured at it.
        stall_torque: N m.
        stall_current: A.
        no_load_speed: rad/s.
        gear_ratio: Turns of the rotor for one of the horn.
    """

    name: str
    mass: float
    dimensions: tuple[float, float, float]
    voltage: float
    stall_torque: float
    stall_current: float
    no_load_speed: float
    gear_ratio: float

    @property
    def armature(self) -> float:
        """Inertia of the rotor as the horn feels it, kg m^2; estimated, see `_SPIN_UP`."""
        return _SPIN_UP * self.stall_torque / self.no_load_speed

    @property
    def friction(self) -> float:
        """Dry friction of the gears at the horn, N m; estimated, see `_FRICTION`."""
        return _FRICTION * self.stall_torque

    @property
    def resistance(self) -> float:
        """Ohm of the winding: the recommended voltage through it gives the stall current."""
        return self.voltage / self.stall_current

    @property
    def torque_constant(self) -> float:
        """N m/A before friction, so that the stall torque is what the horn gives."""
        return (self.stall_torque + self.friction) / self.stall_current

    @property
    def back_emf(self) -> float:
        """V s/rad, so that friction alone is left to overcome at the no-load speed."""
        idle = self.friction / self.torque_constant
        return (self.voltage - idle * self.resistance) / self.no_load_speed

    def torque_at(self, speed: float, voltage: float | None = None) -> float:
        """Most torque at the horn while it turns, N m: the torque-speed line, friction included.

        Args:
            speed: rad/s in the direction of the torque.
            voltage: V of the supply; the recommended one if None.
        """
        supply = self.voltage if voltage is None else voltage
        current = (supply - self.back_emf * speed) / self.resistance
        return self.torque_constant * current - self.friction


_SIZE_330 = (0.020, 0.034, 0.026)
_SIZE_430 = (0.0285, 0.0465, 0.034)
_SIZE_540 = (0.0335, 0.0585, 0.044)
_RPM = 2.0 * math.pi / 60.0

GEARMOTORS: Mapping[str, Gearmotor] = MappingProxyType(
    {
        motor.name: motor
        for motor in (
            Gearmotor("XL430-W250", 0.0572, _SIZE_430, 12.0, 1.5, 1.4, 61 * _RPM, 258.5),
            Gearmotor("XM430-W350", 0.082, _SIZE_430, 12.0, 4.1, 2.3, 46 * _RPM, 353.5),
            Gearmotor("XM430-W210", 0.082, _SIZE_430, 12.0, 3.0, 2.3, 77 * _RPM, 212.6),
            Gearmotor("XH430-W350", 0.082, _SIZE_430, 12.0, 3.4, 1.3, 30 * _RPM, 353.5),
            Gearmotor("XM540-W270", 0.165, _SIZE_540, 12.0, 10.6, 4.4, 30 * _RPM, 272.5),
            Gearmotor("XH540-W270", 0.165, _SIZE_540, 12.0, 9.9, 4.9, 39 * _RPM, 272.5),
            Gearmotor("XC330-T288", 0.023, _SIZE_330, 12.0, 1.0, 0.88, 71 * _RPM, 288.35),
            Gearmotor("XL330-M288", 0.018, _SIZE_330, 5.0, 0.52, 1.47, 103 * _RPM, 288.4),
        )
    }
)
"""Every motor with a datasheet here, by name."""
