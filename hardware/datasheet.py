"""What the datasheets say of a servo model: torque, speed, current, weight, limits, first values.

Source: ROBOTIS e-manual, docs/en/dxl/x/<model> (control tables) and _data/dxl_x_info.yml
(specifications at the recommended voltage).
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cache

from enpointe.errors import RigError

__all__ = ["ServoModel", "datasheet", "datasheet_of", "servo_models"]

_ARMATURE = 0.045
"""kg m^2 at the horn of an XM430-W350: mujoco_menagerie, robotis_op3/op3.xml."""
_SPIN_UP = _ARMATURE * (46 * 2 * math.pi / 60) / 4.1
"""s in which an unloaded XM430-W350 comes to 63 % of its speed. Datasheets give no inertia, and
torque, speed and rotor of these servos grow together; the others are taken to need the same."""
_FRICTION = 0.03 / 4.1
"""Dry friction as a share of stall torque: 0.03 N m on an XM430-W350, from the same file."""

_COMMON = {
    "ID": 1,
    "Baud Rate": 1,
    "Return Delay Time": 250,
    "Operating Mode": 3,
    "Secondary(Shadow) ID": 255,
    "Protocol Type": 2,
    "Moving Threshold": 10,
    "PWM Limit": 885,
    "Max Position Limit": 4095,
    "Shutdown": 52,
    "Status Return Level": 2,
    "External Port Mode 1": 3,
    "External Port Mode 2": 3,
    "External Port Mode 3": 3,
    "PWM Slope": 255,
}


@dataclass(frozen=True, slots=True)
class ServoModel:
    """One model's datasheet.

    Attributes:
        name: "XM430-W350".
        number: As Model Number(0) says.
        mass: kg.
        dimensions: Width, height and depth of the case, m.
        voltage: V, recommended; the figures below are measured at it.
        stall_torque: N m.
        stall_current: A.
        no_load_speed: rad/s.
        gear_ratio: Turns of the rotor for one of the horn.
        current_unit: A a count of Present Current; None where current is not measured.
        voltage_limits: V, what Min and Max Voltage Limit can be set to.
        current_limit: Counts, the most that Current Limit can be; None where there is none.
        velocity_range: Counts, the most that Velocity Limit can be.
        fast_read: Firmware from which fast reads and backup are answered.
        modes: Operating modes that it has.
        initial: First values of registers that are not zero.
    """

    name: str
    number: int
    mass: float
    dimensions: tuple[float, float, float]
    voltage: float
    stall_torque: float
    stall_current: float
    no_load_speed: float
    gear_ratio: float
    current_unit: float | None
    voltage_limits: tuple[float, float]
    current_limit: int | None
    velocity_range: int
    fast_read: int
    modes: frozenset[int]
    initial: Mapping[str, int] = field(repr=False)

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
_ALL_MODES = frozenset({0, 1, 3, 4, 5, 16})
_COARSE = 2.69e-3
_FINE = 1.0e-3


def _model(
    name: str,
    number: int,
    mass: float,
    dimensions: tuple[float, float, float],
    voltage: float,
    torque: float,
    current: float,
    rpm: float,
    gear_ratio: float,
    limits: tuple[float, float],
    *,
    unit: float | None = _COARSE,
    velocity_range: int = 1023,
    fast_read: int = 45,
    **initial: int,
) -> ServoModel:
    """One row of the table; `initial` names registers with _ for a space."""
    own = {key.replace("_", " "): value for key, value in initial.items()}
    return ServoModel(
        name,
        number,
        mass,
        dimensions,
        voltage,
        torque,
        current,
        rpm * 2.0 * math.pi / 60.0,
        gear_ratio,
        unit,
        limits,
        own.get("Current Limit"),
        velocity_range,
        fast_read,
        _ALL_MODES if unit is not None else _ALL_MODES - {0, 5},
        {**_COMMON, "Model Number": number, **own},
    )


_TWELVE = {
    "Temperature_Limit": 80,
    "Max_Voltage_Limit": 160,
    "Min_Voltage_Limit": 95,
    "Velocity_I_Gain": 1920,
    "Velocity_P_Gain": 100,
    "Position_P_Gain": 800,
}


@cache
def servo_models() -> Mapping[str, ServoModel]:
    """Every model with a datasheet here, by name."""
    wide = (9.5, 16.0)
    models = (
        _model("XL430-W250", 1060, 0.0572, _SIZE_430, 12.0, 1.5, 1.4, 61, 258.5, (6.0, 14.0),
               unit=None, Temperature_Limit=72, Max_Voltage_Limit=140, Min_Voltage_Limit=60,
               Velocity_Limit=265, Velocity_I_Gain=1000, Velocity_P_Gain=100,
               Position_D_Gain=4000, Position_P_Gain=640),
        _model("XM430-W350", 1020, 0.082, _SIZE_430, 12.0, 4.1, 2.3, 46, 353.5, wide,
               Current_Limit=1193, Velocity_Limit=350, **_TWELVE),
        _model("XM430-W210", 1030, 0.082, _SIZE_430, 12.0, 3.0, 2.3, 77, 212.6, wide,
               Current_Limit=1193, Velocity_Limit=330, **_TWELVE),
        _model("XH430-W350", 1000, 0.082, _SIZE_430, 12.0, 3.4, 1.3, 30, 353.5, wide,
               Current_Limit=648, Velocity_Limit=130, **{**_TWELVE, "Position_P_Gain": 900}),
        _model("XM540-W270", 1120, 0.165, _SIZE_540, 12.0, 10.6, 4.4, 30, 272.5, wide,
               Current_Limit=2047, Velocity_Limit=128, **_TWELVE),
        _model("XH540-W270", 1100, 0.165, _SIZE_540, 12.0, 9.9, 4.9, 39, 272.5, wide,
               Current_Limit=2047, Velocity_Limit=167, **_TWELVE),
        _model("XC330-T288", 1220, 0.023, _SIZE_330, 12.0, 1.0, 0.88, 71, 288.35, (5.5, 14.0),
               unit=_FINE, velocity_range=2047, fast_read=46, Current_Limit=910,
               Temperature_Limit=70, Max_Voltage_Limit=140, Min_Voltage_Limit=55,
               Velocity_Limit=320, Velocity_I_Gain=1200, Velocity_P_Gain=40, Position_P_Gain=900),
        _model("XL330-M288", 1200, 0.018, _SIZE_330, 5.0, 0.52, 1.47, 103, 288.4, (3.1, 7.0),
               unit=_FINE, velocity_range=2047, fast_read=46, Current_Limit=1750,
               Temperature_Limit=70, Max_Voltage_Limit=70, Min_Voltage_Limit=35,
               Velocity_Limit=445, Velocity_I_Gain=1600, Velocity_P_Gain=180, Position_P_Gain=400,
               PWM_Slope=140, Shutdown=53),
    )  # fmt: skip
    return {model.name: model for model in models}


def datasheet(name: str) -> ServoModel:
    """The datasheet of a model by name, in either case.

    Raises:
        RigError: No such model here.
    """
    models = servo_models()
    if (model := models.get(name.strip().upper())) is None:
        raise RigError(f"no datasheet of a servo {name!r}; there are {', '.join(models)}")
    return model


def datasheet_of(number: int) -> ServoModel:
    """The datasheet of a model by the number that it answers to a ping.

    Raises:
        RigError: No such model here.
    """
    for model in servo_models().values():
        if model.number == number:
            return model
    known = ", ".join(f"{model.number} ({model.name})" for model in servo_models().values())
    raise RigError(f"no datasheet of a servo with the model number {number}; there are {known}")
