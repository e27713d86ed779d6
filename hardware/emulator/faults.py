"""What goes wrong on a bus: a list of faults, each with its moment, written down in TOML.

[[fault]]
kind = "drop"        # answers that the host never gets
ids = [3, 7]         # whom; all if left out
at = [1.0, 9.0]      # s; drawn between the two, or one number
duration = 2.0       # s, or two numbers; for ever if left out
probability = 0.01   # of each packet
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import MISSING, dataclass, fields
from enum import StrEnum
from pathlib import Path

from enpointe.errors import FormatError, RigError
from enpointe.hardware.toml_file import read_toml

__all__ = ["Fault", "FaultKind", "faults_from", "load_faults"]


class FaultKind(StrEnum):
    """What goes wrong."""

    DROP = "drop"
    """Packets are lost on the way."""
    CORRUPT = "corrupt"
    """One byte of a packet is another."""
    DELAY = "delay"
    """Answers come late, by `amount` s."""
    STUFFING = "stuffing"
    """A false header FF FF FD stands somewhere in an answer."""
    BROWN_OUT = "brown-out"
    """The supply has `amount` V."""
    STALL = "stall"
    """A joint is jammed."""
    OVERHEAT = "overheat"
    """The motor is at `amount` degrees Celsius at once."""
    MISSING = "missing"
    """A servo is off the bus, without power; it boots when it comes back."""
    UNPLUG = "unplug"
    """The host's adapter is gone."""


_AMOUNTS = {
    FaultKind.DELAY: (0.010, 0.0, math.inf),
    FaultKind.BROWN_OUT: (7.0, 0.0, math.inf),
    FaultKind.OVERHEAT: (95.0, 0.0, 255.0),
}
"""Usual amount, least and most, of the kinds that have one."""


@dataclass(frozen=True, slots=True)
class Fault:
    """One thing that goes wrong for a while.

    Attributes:
        kind: What.
        ids: IDs of the servos concerned; empty for all.
        at: s, when it begins: drawn evenly between the two.
        duration: s, how long it lasts: drawn likewise.
        probability: Of each packet, for drop, corrupt, delay and stuffing.
        amount: s, V or degrees Celsius, by the kind; the kind's usual one if None.
        instructions: For drop and corrupt: of the host's packets, rather than of the answers.

    Raises:
        RigError: A value that makes no sense, with its name.
    """

    kind: FaultKind
    ids: tuple[int, ...] = ()
    at: tuple[float, float] = (0.0, 0.0)
    duration: tuple[float, float] = (math.inf, math.inf)
    probability: float = 1.0
    amount: float | None = None
    instructions: bool = False

    def __post_init__(self) -> None:
        for name, (low, high) in (("at", self.at), ("duration", self.duration)):
            if not 0.0 <= low <= high:
                raise RigError(f"{name} of a {self.kind} fault must be from 0 up, in rising order")
        if not 0.0 <= self.probability <= 1.0:
            raise RigError(f"probability of a {self.kind} fault must be between 0 and 1")
        if not all(0 <= number <= 252 for number in self.ids):
            raise RigError(f"ids of a {self.kind} fault must be between 0 and 252")
        _, low, high = _AMOUNTS.get(self.kind, (0.0, 0.0, math.inf))
        if self.amount is not None and not low <= self.amount <= high:
            raise RigError(f"amount of a {self.kind} fault must be between {low:g} and {high:g}")
        if self.instructions and self.kind not in (FaultKind.DROP, FaultKind.CORRUPT):
            raise RigError(f"a {self.kind} fault can't be one of instructions")

    @property
    def size(self) -> float:
        """The amount, or the kind's usual one."""
        return _AMOUNTS.get(self.kind, (0.0,))[0] if self.amount is None else self.amount


_NAMES = {field.name for field in fields(Fault)}
_NEEDED = {field.name for field in fields(Fault) if field.default is MISSING}


def load_faults(path: str | Path) -> tuple[Fault, ...]:
    """The faults written in a TOML file, as `[[fault]]` tables.

    Raises:
        FormatError: It is no such file; says what is wrong in which fault.
    """
    content = read_toml(path)
    try:
        return faults_from(content)
    except RigError as error:
        raise FormatError(str(error), path) from error


def faults_from(content: Mapping[str, object]) -> tuple[Fault, ...]:
    """The faults of a mapping as TOML gives it.

    Raises:
        RigError: Says what is wrong in which fault.
    """
    rows = content.get("fault", [])
    if set(content) - {"fault"} or not isinstance(rows, list):
        raise RigError("a fault script holds [[fault]] tables and nothing else")
    found = []
    for number, row in enumerate(rows, start=1):
        try:
            found.append(_fault(row))
        except (RigError, TypeError, ValueError) as error:
            raise RigError(f"fault {number}: {error}") from error
    return tuple(found)


def _fault(row: object) -> Fault:
    if not isinstance(row, dict) or set(row) - _NAMES or _NEEDED - set(row):
        raise RigError(f"needs a kind, and knows only {', '.join(sorted(_NAMES))}")
    try:
        kind = FaultKind(row["kind"])
    except ValueError:
        kinds = ", ".join(FaultKind)
        raise RigError(f"{row['kind']!r} is no kind of fault; there are {kinds}") from None
    values: dict[str, object] = {**row, "kind": kind}
    for name in ("at", "duration"):
        if name in row:
            values[name] = _span(name, row[name])
    for name in ("probability", "amount"):
        if name in row:
            values[name] = _number(name, row[name])
    ids = row.get("ids", [])
    if not isinstance(ids, list) or not all(type(each) is int for each in ids):
        raise RigError("ids must be a list of whole numbers")
    if not isinstance(row.get("instructions", False), bool):
        raise RigError("instructions must be true or false")
    return Fault(**{**values, "ids": tuple(ids)})  # type: ignore[arg-type]


def _span(name: str, value: object) -> tuple[float, float]:
    if isinstance(value, Sequence) and not isinstance(value, str):
        if len(value) != 2:
            raise RigError(f"{name} must be a number or two")
        return _number(name, value[0]), _number(name, value[1])
    number = _number(name, value)
    return number, number


def _number(name: str, value: object) -> float:
    if isinstance(value, bool) or not isinstance(value, (int, float)) or math.isnan(value):
        raise RigError(f"{name} must be a number, not {value!r}")
    return float(value)
