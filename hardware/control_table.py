"""Registers of a servo model, from the tables that the dynamixel-sdk package ships.

The tables name address and size. What they leave out is added here from the ROBOTIS e-manual
(docs/en/dxl/x): which registers are signed, which can be written, every slot of the indirect
registers, and two registers of newer firmware (Startup Configuration, Backup Ready).
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cache
from importlib.resources import files
from importlib.resources.abc import Traversable

from enpointe.errors import RigError

__all__ = ["EEPROM_END", "ControlTable", "Register", "control_table", "known_models"]

EEPROM_END = 64
"""Registers below this address are kept without power and locked while torque is on."""

_SIGNED = frozenset(
    {
        "Homing Offset",
        "Bus Watchdog",
        "Goal PWM",
        "Goal Current",
        "Goal Velocity",
        "Goal Position",
        "Present PWM",
        "Present Current",
        "Present Load",
        "Present Velocity",
        "Present Position",
        "Velocity Trajectory",
        "Position Trajectory",
    }
)
_READ_ONLY = frozenset(
    {
        "Model Number",
        "Model Information",
        "Firmware Version",
        "Registered Instruction",
        "Hardware Error Status",
        "Realtime Tick",
        "Moving",
        "Moving Status",
        "Velocity Trajectory",
        "Position Trajectory",
        "Backup Ready",
    }
)
_OF_NEWER_FIRMWARE = (("Startup Configuration", 60, 1), ("Backup Ready", 147, 1))
_BANKS = (
    ("Indirect Address Write", "Indirect Data Write"),
    ("Indirect Address Read", "Indirect Data Read"),
)
_MOVED = 52
"""Firmware from which the small X330 servos have their indirect data elsewhere."""


@dataclass(frozen=True, slots=True)
class Register:
    """One value in a servo's memory, least significant byte first.

    Attributes:
        name: As the SDK and the e-manual name it, "Goal Position".
        address: Of its first byte.
        size: Bytes: 1, 2 or 4.
        signed: Two's complement.
        writable: False if the servo alone writes it.
    """

    name: str
    address: int
    size: int
    signed: bool
    writable: bool

    @property
    def lowest(self) -> int:
        """The smallest value that its bytes can hold."""
        return -(1 << (8 * self.size - 1)) if self.signed else 0

    @property
    def highest(self) -> int:
        """The largest value that its bytes can hold."""
        return (1 << (8 * self.size - self.signed)) - 1

    @property
    def end(self) -> int:
        """Address after its last byte."""
        return self.address + self.size

    @property
    def eeprom(self) -> bool:
        """Whether it is kept without power, and locked while torque is on."""
        return self.address < EEPROM_END

    def encode(self, value: int) -> bytes:
        """The register's bytes.

        Raises:
            RigError: The bytes can't hold the value.
        """
        if not self.lowest <= value <= self.highest:
            raise RigError(
                f"{self.name} can't be {value}: its {self.size} bytes hold {self.lowest} to"
                f" {self.highest}"
            )
        return value.to_bytes(self.size, "little", signed=self.signed)

    def decode(self, data: bytes | bytearray) -> int:
        """The value of the register's bytes, with its sign.

        Raises:
            RigError: Not as many bytes as the register has.
        """
        if len(data) != self.size:
            raise RigError(f"{self.name} has {self.size} bytes and {len(data)} came: read it again")
        return int.from_bytes(data, "little", signed=self.signed)


class ControlTable(Mapping[str, Register]):
    """The registers of one model, by name.

    Attributes:
        model_number: As Model Number(0) says.
        registers: By rising address.
        indirect: For each slot, its address register and its data register.
    """

    def __init__(self, model_number: int, found: Mapping[str, tuple[int, int]]) -> None:
        self.model_number = model_number
        named = {name: place for name, place in found.items() if not name.startswith("Indirect")}
        for name, address, size in _OF_NEWER_FIRMWARE:
            named.setdefault(name, (address, size))
        registers = [
            Register(name, address, size, name in _SIGNED, _writable(name))
            for name, (address, size) in named.items()
        ]
        self.indirect = tuple(_slots(found))
        registers += [register for slot in self.indirect for register in slot]
        self.registers = tuple(sorted(registers, key=lambda register: register.address))
        self._by_name = {register.name: register for register in self.registers}
        self._by_address = {register.address: register for register in self.registers}

    def __getitem__(self, name: str) -> Register:
        try:
            return self._by_name[name]
        except KeyError:
            raise RigError(f"servo model {self.model_number} has no register {name!r}") from None

    def __contains__(self, name: object) -> bool:
        return name in self._by_name

    def __iter__(self) -> Iterator[str]:
        return iter(self._by_name)

    def __len__(self) -> int:
        return len(self._by_name)

    def starting_at(self, address: int) -> Register | None:
        """The register whose first byte is there, or None."""
        return self._by_address.get(address)

    @property
    def size(self) -> int:
        """Bytes from address 0 to the end of the last register."""
        return max(register.end for register in self.registers)


def _writable(name: str) -> bool:
    return name not in _READ_ONLY and not name.startswith("Present")


def _slots(found: Mapping[str, tuple[int, int]]) -> Iterator[tuple[Register, Register]]:
    """Each bank's addresses run up to its first data byte or the other bank, two bytes each."""
    number = 0
    starts = sorted(found[name][0] for bank in _BANKS for name in bank if name in found)
    for addresses, data in _BANKS:
        if addresses not in found or data not in found:
            continue
        first, store = found[addresses][0], found[data][0]
        end = min(start for start in starts if start > first)
        for slot in range((end - first) // 2):
            number += 1
            yield (
                Register(f"Indirect Address {number}", first + 2 * slot, 2, False, True),
                Register(f"Indirect Data {number}", store + slot, 1, False, True),
            )


def _folder() -> Traversable:
    return files("dynamixel_easy_sdk") / "control_table"


@cache
def known_models() -> Mapping[int, str]:
    """Model number to the name of its table, of every model that the SDK knows."""
    lines = (_folder() / "dynamixel.model").read_text(encoding="utf-8").splitlines()
    pairs = (line.split("\t") for line in lines[1:] if line.strip())
    return {int(number): name.removesuffix(".model") for number, name in pairs}


@cache
def control_table(model_number: int, firmware: int = _MOVED) -> ControlTable:
    """The registers of a servo model of the X series.

    Args:
        model_number: As the servo answers to a ping.
        firmware: Its version: X330 servos moved their indirect registers with 52, which the SDK's
            own lookup by number misses.

    Raises:
        RigError: The SDK has no such model, or it is no X-series model.
    """
    name = known_models().get(model_number)
    if name is None or not name.startswith(("x", "2x")) or name == "xl320":
        raise RigError(
            f"{model_number} is the number of no X-series servo that the dynamixel-sdk knows;"
            " check the model, or upgrade dynamixel-sdk"
        )
    newer = _folder() / f"{name}_fw{_MOVED}.model"
    file = newer if firmware >= _MOVED and newer.is_file() else _folder() / f"{name}.model"
    text = file.read_text(encoding="utf-8").split("[control table]")[1]
    rows = [line.split("\t") for line in text.splitlines() if line.strip()]
    return ControlTable(
        model_number, {row[2].strip(): (int(row[0]), int(row[1])) for row in rows[1:]}
    )
