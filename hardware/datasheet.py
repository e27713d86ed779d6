"""What the datasheets say of a servo model: its motor (`Gearmotor`), limits and first values.

Source: ROBOTIS e-manual, docs/en/dxl/x/<model> (control tables).
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, fields
from functools import cache

from enpointe.errors import RigError
from enpointe.models.puppet.gearmotor import GEARMOTORS, Gearmotor

__all__ = ["ServoModel", "datasheet", "datasheet_of", "servo_models"]

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
class ServoModel(Gearmotor):
    """One model's datasheet: motor, gears and case, and what its registers can hold.

    Attributes:
        number: As Model Number(0) says.
        current_unit: A a count of Present Current; None where current is not measured.
        voltage_limits: V, what Min and Max Voltage Limit can be set to.
        current_limit: Counts, the most that Current Limit can be; None where there is none.
        velocity_range: Counts, the most that Velocity Limit can be.
        fast_read: Firmware from which fast reads and backup are answered.
        modes: Operating modes that it has.
        initial: First values of registers that are not zero.
    """

    number: int
    current_unit: float | None
    voltage_limits: tuple[float, float]
    current_limit: int | None
    velocity_range: int
    fast_read: int
    modes: frozenset[int]
    initial: Mapping[str, int] = field(repr=False)


_ALL_MODES = frozenset({0, 1, 3, 4, 5, 16})
_COARSE = 2.69e-3
_FINE = 1.0e-3


def _model(
    name: str,
    number: int,
    limits: tuple[float, float],
    *,
    unit: float | None = _COARSE,
    velocity_range: int = 1023,
    fast_read: int = 45,
    **initial: int,
) -> ServoModel:
    """One row of the table; `initial` names registers with _ for a space."""
    own = {key.replace("_", " "): value for key, value in initial.items()}
    motor = GEARMOTORS[name]
    return ServoModel(
        **{part.name: getattr(motor, part.name) for part in fields(motor)},
        number=number,
        current_unit=unit,
        voltage_limits=limits,
        current_limit=own.get("Current Limit"),
        velocity_range=velocity_range,
        fast_read=fast_read,
        modes=_ALL_MODES if unit is not None else _ALL_MODES - {0, 5},
        initial={**_COMMON, "Model Number": number, **own},
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
        _model("XL430-W250", 1060, (6.0, 14.0),
               unit=None, Temperature_Limit=72, Max_Voltage_Limit=140, Min_Voltage_Limit=60,
               Velocity_Limit=265, Velocity_I_Gain=1000, Velocity_P_Gain=100,
               Position_D_Gain=4000, Position_P_Gain=640),
        _model("XM430-W350", 1020, wide,
               Current_Limit=1193, Velocity_Limit=350, **_TWELVE),
        _model("XM430-W210", 1030, wide,
               Current_Limit=1193, Velocity_Limit=330, **_TWELVE),
        _model("XH430-W350", 1000, wide,
               Current_Limit=648, Velocity_Limit=130, **{**_TWELVE, "Position_P_Gain": 900}),
        _model("XM540-W270", 1120, wide,
               Current_Limit=2047, Velocity_Limit=128, **_TWELVE),
        _model("XH540-W270", 1100, wide,
               Current_Limit=2047, Velocity_Limit=167, **_TWELVE),
        _model("XC330-T288", 1220, (5.5, 14.0),
               unit=_FINE, velocity_range=2047, fast_read=46, Current_Limit=910,
               Temperature_Limit=70, Max_Voltage_Limit=140, Min_Voltage_Limit=55,
               Velocity_Limit=320, Velocity_I_Gain=1200, Velocity_P_Gain=40, Position_P_Gain=900),
        _model("XL330-M288", 1200, (3.1, 7.0),
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
