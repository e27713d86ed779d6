"""A rig written down: which servo turns which joint, which way, how far, how fast and how hard.

name = "puppet"
body = "puppet"           # puppet or op3: whose joints these are
baud = 1000000
rate = 100.0              # Hz of the control loop
fast_read = true          # all servos answer in one packet; firmware 45 or newer

[[servo]]
id = 1
model = "XM430-W350"
joint = "waist_turn"
sign = 1                  # -1 where the servo turns the other way than the joint
offset = 0.0              # degrees: the servo's angle where the joint is at zero
limits = [-60.0, 60.0]    # degrees, of the joint
speed = 180.0             # degrees/s
current = 0.0             # mA; 0 leaves it to the servo, in plain position mode
gains = [800, 0, 0]       # P, I, D; the model's own if left out
"""

from __future__ import annotations

import math
import tomllib
from collections.abc import Sequence
from importlib.resources import files
from pathlib import Path
from typing import Annotated, Literal

from pydantic import BaseModel, ConfigDict, Field, ValidationError, field_validator, model_validator

from enpointe.errors import FormatError, RigError
from enpointe.files import write_text
from enpointe.hardware.datasheet import ServoModel, datasheet
from enpointe.hardware.units import BAUD_RATES, CENTRE, PULSE, REVOLUTION

__all__ = ["Rig", "RigServo", "first_complaint", "load_rig", "rig_text", "save_rig", "shipped_rigs"]

_FASTEST = 1000.0
_GAIN = Annotated[int, Field(ge=0, le=16_383)]


class _Strict(BaseModel):
    model_config = ConfigDict(extra="forbid", frozen=True, allow_inf_nan=False)


class RigServo(_Strict):
    """One servo of a rig, in the file's units; what computes uses the properties, which are SI.

    Attributes:
        id: On the bus.
        model: Its datasheet's name.
        joint: The joint that it turns.
        sign: 1, or -1 where it turns the other way than the joint.
        offset: Degrees that the servo has where the joint has none; 0 is the mark up, 2048 pulses.
        limits: Degrees, of the joint.
        speed: Degrees/s that no goal of ours exceeds.
        current: mA that it may draw; 0 for no limit of ours.
        gains: P, I and D as its registers have them; None for the model's own.
    """

    id: Annotated[int, Field(ge=0, le=252)]
    model: str
    joint: Annotated[str, Field(min_length=1)]
    sign: Literal[-1, 1] = 1
    offset: float = 0.0
    limits: tuple[float, float]
    speed: Annotated[float, Field(gt=0.0)]
    current: Annotated[float, Field(ge=0.0)] = 0.0
    gains: tuple[_GAIN, _GAIN, _GAIN] | None = None

    @field_validator("model")
    @classmethod
    def _known(cls, name: str) -> str:
        try:
            return datasheet(name).name
        except RigError as error:
            raise ValueError(str(error)) from None

    @model_validator(mode="after")
    def _possible(self) -> RigServo:
        low, high = self.limits
        if not low < high:
            raise ValueError(f"limits of {self.joint} must rise, not {low:g} to {high:g}")
        for pulses in self.pulse_limits:
            if not 0 <= pulses < REVOLUTION:
                raise ValueError(
                    f"limits of {self.joint} with its offset leave the servo's one turn"
                    f" (pulse {pulses} of 0 to 4095); turn the horn on its axle and set the offset"
                )
        sheet = self.sheet
        if self.current and sheet.current_unit is None:
            raise ValueError(f"a {sheet.name} can't limit its current; {self.joint} must have 0")
        if self.current and self.current_counts > (sheet.current_limit or 0):
            most = (sheet.current_limit or 0) * (sheet.current_unit or 0.0) * 1e3
            raise ValueError(f"current of {self.joint} is at most {most:.0f} mA")
        if self.current and self.current_counts == 0:
            raise ValueError(f"current of {self.joint} is less than the servo can measure")
        if self.speed > math.degrees(sheet.no_load_speed) * 1.1:
            raise ValueError(
                f"speed of {self.joint} is more than a {sheet.name} has without any load,"
                f" {math.degrees(sheet.no_load_speed):.0f} degrees/s"
            )
        return self

    @property
    def sheet(self) -> ServoModel:
        """The model's datasheet."""
        return datasheet(self.model)

    @property
    def range(self) -> tuple[float, float]:
        """Joint angles that it may have, rad."""
        return math.radians(self.limits[0]), math.radians(self.limits[1])

    @property
    def top_speed(self) -> float:
        """rad/s."""
        return math.radians(self.speed)

    @property
    def pulse_limits(self) -> tuple[int, int]:
        """Least and most Goal Position that keeps the joint within its limits."""
        ends = sorted(
            CENTRE + (self.sign * math.radians(a) + math.radians(self.offset)) / PULSE
            for a in self.limits
        )
        return math.ceil(ends[0] - 1e-9), math.floor(ends[1] + 1e-9)

    @property
    def current_counts(self) -> int:
        """Most Goal Current, counts; 0 where our current is not limited."""
        unit = self.sheet.current_unit
        return 0 if unit is None else math.floor(self.current * 1e-3 / unit + 1e-9)


class Rig(_Strict):
    """Servos on a bus that together are a body.

    Attributes:
        name: For people.
        body: Whose joints the servos turn.
        baud: bit/s.
        rate: Hz of the control loop.
        fast_read: Read all servos in one packet.
        servos: In the order of the joints.
    """

    name: Annotated[str, Field(min_length=1)]
    body: Literal["puppet", "op3"]
    baud: int
    rate: Annotated[float, Field(gt=0.0, le=_FASTEST)]
    fast_read: bool = True
    servos: Annotated[tuple[RigServo, ...], Field(alias="servo", min_length=1)]

    @field_validator("baud")
    @classmethod
    def _spoken(cls, baud: int) -> int:
        if baud not in BAUD_RATES[:-1]:
            known = ", ".join(str(rate) for rate in BAUD_RATES[:-1])
            raise ValueError(f"baud must be one of {known}")
        return baud

    @model_validator(mode="after")
    def _each_once(self) -> Rig:
        for name in ("id", "joint"):
            values = [getattr(servo, name) for servo in self.servos]
            twice = sorted({str(value) for value in values if values.count(value) > 1})
            if twice:
                raise ValueError(f"{name} {', '.join(twice)} is there twice")
        return self

    @property
    def joints(self) -> tuple[str, ...]:
        """In order."""
        return tuple(servo.joint for servo in self.servos)

    @property
    def ids(self) -> tuple[int, ...]:
        """In the joints' order."""
        return tuple(servo.id for servo in self.servos)

    @property
    def period(self) -> float:
        """s of the control loop."""
        return 1.0 / self.rate

    def at(self, baud: int | None = None, rate: float | None = None) -> Rig:
        """The same rig at another baud rate or another rate of its loop, where one is given.

        Raises:
            RigError: There is none such.
        """
        changed = {"baud": self.baud if baud is None else baud,
                   "rate": self.rate if rate is None else rate}  # fmt: skip
        try:
            return Rig.model_validate({**self.model_dump(by_alias=True), **changed})
        except ValidationError as error:
            raise RigError(first_complaint(error)) from None


def shipped_rigs() -> tuple[str, ...]:
    """Names of the rigs that come with enpointe."""
    folder = files("enpointe.hardware") / "rigs"
    return tuple(
        sorted(f.name.removesuffix(".toml") for f in folder.iterdir() if ".toml" in f.name)
    )


def load_rig(source: str | Path) -> Rig:
    """A shipped rig by name, or one from a TOML file.

    Raises:
        RigError: Neither a name nor a file.
        FormatError: The file is no rig; one line says which entry is wrong.
    """
    path = Path(source)
    if str(source) in shipped_rigs():
        text = (files("enpointe.hardware") / "rigs" / f"{source}.toml").read_text(encoding="utf-8")
    else:
        if not path.is_file():
            names = ", ".join(shipped_rigs())
            raise RigError(f"no rig {str(source)!r}: name a TOML file, or one of {names}")
        try:
            text = path.read_text(encoding="utf-8")
        except (OSError, UnicodeDecodeError) as error:
            reason = getattr(error, "strerror", None) or error
            raise FormatError(f"can't be read: {reason}", path) from error
    try:
        return Rig.model_validate(tomllib.loads(text))
    except tomllib.TOMLDecodeError as error:
        raise FormatError(f"no TOML: {error}", source) from error
    except ValidationError as error:
        raise FormatError(first_complaint(error), source) from error


def first_complaint(error: ValidationError) -> str:
    """The first complaint in one line, with the servo's number counted from 1."""
    found = error.errors(include_url=False)[0]
    place = [f"servo {part + 1}" if isinstance(part, int) else part for part in found["loc"]]
    where = ", ".join(str(part) for part in place if part != "servo")
    message = " ".join(str(found["msg"]).removeprefix("Value error, ").split())
    return f"{where}: {message}" if where else message


def rig_text(rig: Rig, comments: Sequence[str] = ()) -> str:
    """A rig as TOML, with lines of comment above."""
    lines = [f"# {comment}" for comment in comments]
    lines += [
        f"name = {_quoted(rig.name)}",
        f"body = {_quoted(rig.body)}",
        f"baud = {rig.baud}",
        f"rate = {rig.rate!r}",
        f"fast_read = {str(rig.fast_read).lower()}",
    ]
    for servo in rig.servos:
        low, high = servo.limits
        lines += [
            "",
            "[[servo]]",
            f"id = {servo.id}",
            f"model = {_quoted(servo.model)}",
            f"joint = {_quoted(servo.joint)}",
            f"sign = {servo.sign}",
            f"offset = {servo.offset!r}",
            f"limits = [{low!r}, {high!r}]",
            f"speed = {servo.speed!r}",
            f"current = {servo.current!r}",
        ]
        if servo.gains is not None:
            lines.append(f"gains = {list(servo.gains)}")
    return "\n".join(lines) + "\n"


def save_rig(rig: Rig, path: Path, comments: Sequence[str] = ()) -> None:
    """Write a rig beside and rename it, and make sure that it reads back the same.

    Raises:
        RigError: What was written is not what was meant.
    """
    write_text(path, rig_text(rig, comments))
    if load_rig(path) != rig:
        raise RigError(f"{path} does not read back as it was written; look at the disk, and again")


def _quoted(text: str) -> str:
    escaped = text.replace("\\", "\\\\").replace('"', '\\"')
    return '"' + "".join(c if c.isprintable() else f"\\U{ord(c):08x}" for c in escaped) + '"'
