"""A bus written down: which servos, their settings, the supply, what each turns; in TOML.

baud = 1000000            # of all servos
voltage = 12.0            # V; the models' own recommended one if left out
resistance = 0.05         # ohm of supply and cables
strict = true             # take unstuffed headers for headers
latency = 0.0             # s by which the adapter holds answers back

[[servo]]
id = 1
model = "XM430-W350"
inertia = 0.002           # kg m^2 beside the rotor's
gravity = 0.3             # N m of a weight on a horizontal arm, which hangs at `hanging`
hanging = 0.0             # rad
angle = 0.1               # rad at first
firmware = 52
settings = { "Return Delay Time" = 0 }
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, fields
from pathlib import Path
from typing import Any

from enpointe.errors import FormatError, RigError
from enpointe.hardware.datasheet import datasheet
from enpointe.hardware.emulator.bus import Bus, Supply
from enpointe.hardware.emulator.fault_run import FaultRun
from enpointe.hardware.emulator.plant import Load, Loads, Plant
from enpointe.hardware.emulator.servo import FIRMWARE, Servo
from enpointe.hardware.toml_file import read_toml
from enpointe.hardware.units import BAUD_RATES

__all__ = ["BusDescription", "ServoDescription", "bus_of", "load_bus"]


@dataclass(frozen=True, slots=True)
class ServoDescription:
    """One servo of a bus, and what hangs on it.

    Attributes:
        id: 0 to 252.
        model: Its name, "XM430-W350".
        firmware: Its version.
        settings: Registers that are not as from the factory, by name.
        inertia: kg m^2 beside the rotor's.
        gravity: N m that a weight on a horizontal arm gives.
        hanging: rad, where that arm hangs down.
        angle: rad, where the horn is at first.
    """

    id: int
    model: str = "XM430-W350"
    firmware: int = FIRMWARE
    settings: Mapping[str, int] = field(default_factory=dict)
    inertia: float = 0.0
    gravity: float = 0.0
    hanging: float = 0.0
    angle: float = 0.0


@dataclass(frozen=True, slots=True)
class BusDescription:
    """A bus and its servos.

    Attributes:
        servos: In order of the plant's joints.
        baud: bit/s that all servos are set to; one of `BAUD_RATES`.
        voltage: V of the supply; that recommended for the first servo if None.
        resistance: Ohm of supply and cables.
        strict: Take an unstuffed header within a packet for a header.
        wire_time: Whether bytes and return delays take time.
        latency: s by which the host's adapter holds answers back.
    """

    servos: tuple[ServoDescription, ...]
    baud: int = 1_000_000
    voltage: float | None = None
    resistance: float = 0.0
    strict: bool = True
    wire_time: bool = True
    latency: float = 0.0

    @classmethod
    def alike(cls, count: int, model: str, **rest: Any) -> BusDescription:
        """So many servos of one model, from ID 1, with no return delay."""
        if not 1 <= count <= 252:
            raise RigError(f"a bus has 1 to 252 servos, not {count}")
        settings = {"Return Delay Time": 0}
        numbers = range(1, count + 1)
        servos = tuple(ServoDescription(i, model, settings=settings) for i in numbers)
        return cls(servos, **rest)


def bus_of(
    description: BusDescription, *, plant: Plant | None = None, faults: FaultRun | None = None
) -> Bus:
    """The bus that is described.

    Args:
        description: What it is made of.
        plant: What its servos turn, in place of the loads described.
        faults: What goes wrong.

    Raises:
        RigError: A model, a setting or a baud rate that there isn't.
    """
    if description.baud not in BAUD_RATES:
        raise RigError(f"no servo talks at {description.baud} bit/s; they do at {BAUD_RATES}")
    baud = BAUD_RATES.index(description.baud)
    servos, loads = [], []
    for each in description.servos:
        model = datasheet(each.model)
        settings = {"Baud Rate": baud, **each.settings}
        servos.append(Servo(model, each.id, firmware=each.firmware, settings=settings))
        inertia = model.armature + each.inertia
        loads.append(Load(inertia, model.friction, each.gravity, each.hanging, each.angle))
    volts = description.voltage
    if volts is None and servos:
        volts = servos[0].model.voltage
    return Bus(
        servos,
        plant if plant is not None else Loads(loads),
        baud=description.baud,
        supply=Supply(volts or 0.0, description.resistance),
        faults=faults,
        strict=description.strict,
        wire_time=description.wire_time,
        latency=description.latency,
    )


def load_bus(path: str | Path) -> BusDescription:
    """A bus description from a TOML file.

    Raises:
        FormatError: It is no such file; says which entry is wrong.
    """
    content = read_toml(path)
    try:
        rows = content.pop("servo", [])
        if not isinstance(rows, Sequence) or not rows:
            raise RigError("a bus needs at least one [[servo]]")
        servos = tuple(_entry(ServoDescription, row, f"servo {n}") for n, row in enumerate(rows, 1))
        found: BusDescription = _entry(BusDescription, {**content, "servos": servos}, "bus")
        bus_of(found)
    except RigError as error:
        raise FormatError(str(error), path) from error
    return found


_KINDS: dict[str, tuple[type, ...]] = {
    "int": (int,),
    "str": (str,),
    "bool": (bool,),
    "float": (int, float),
    "float | None": (int, float),
    "Mapping[str, int]": (dict,),
    "tuple[ServoDescription, ...]": (tuple,),
}


def _entry(kind: Any, row: object, where: str) -> Any:
    """A dataclass of a TOML table, each value of its field's type."""
    types = {each.name: str(each.type) for each in fields(kind)}
    if not isinstance(row, dict):
        raise RigError(f"{where} is no table")
    for name, value in row.items():
        if name not in types:
            raise RigError(f"{where}: no entry {name!r}; there are {', '.join(types)}")
        wrong = not isinstance(value, _KINDS[types[name]])
        if wrong or (isinstance(value, bool) and types[name] != "bool"):
            raise RigError(f"{where}: {name} can't be {value!r}")
        if isinstance(value, float) and not math.isfinite(value):
            raise RigError(f"{where}: {name} must be finite")
    numbers = row.get("settings", {})
    if any(type(number) is not int for number in numbers.values()):
        raise RigError(f"{where}: settings are whole numbers")
    if kind is ServoDescription and "id" not in row:
        raise RigError(f"{where} has no id")
    return kind(**row)
