"""A servo's memory: bytes at addresses, and who may read and write what when."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass

from enpointe.hardware.control_table import ControlTable, Register
from enpointe.hardware.packets import StatusError

__all__ = ["Memory", "Write"]


@dataclass(frozen=True, slots=True)
class Write:
    """One register and the value asked for it."""

    register: Register
    value: int


class Memory:
    """The control table's bytes.

    Indirect data stand for the bytes whose addresses are written in the slots' address registers;
    a slot that points at itself, as all do at first, is a byte of its own.

    Args:
        table: The model's registers; all bytes start at zero but the slots' addresses.

    Attributes:
        values: Of each register, by name; to look at only.
    """

    def __init__(self, table: ControlTable) -> None:
        self.table = table
        self._bytes = bytearray(table.size)
        self._known = bytearray(table.size)
        for register in table.registers:
            self._known[register.address : register.end] = b"\x01" * register.size
        self.values: dict[str, int] = dict.fromkeys(table, 0)
        self._slots = {data.address: address.name for address, data in table.indirect}
        for address, data in table.indirect:
            self[address.name] = data.address

    def __getitem__(self, name: str) -> int:
        return self.values[name]

    def __setitem__(self, name: str, value: int) -> None:
        register = self.table[name]
        self._bytes[register.address : register.end] = register.encode(value)
        self.values[name] = value

    def __contains__(self, name: str) -> bool:
        return name in self.values

    def read(self, address: int, length: int) -> bytes | StatusError:
        """Bytes as a Read instruction gets them; ACCESS where there is no register."""
        if length < 1 or address + length > len(self._bytes):
            return StatusError.ACCESS
        places = self._resolved(address, length)
        if not all(self._known[place] for place in places):
            return StatusError.ACCESS
        return bytes(self._bytes[place] for place in places)

    def writes(
        self, address: int, data: bytes, check: Callable[[Register, int], StatusError]
    ) -> tuple[Write, ...] | StatusError:
        """What a Write instruction would set, or why nothing of it is allowed; nothing is set.

        Args:
            address: Of the first byte.
            data: The bytes.
            check: Whether a register may have a value now.
        """
        if not data or address + len(data) > len(self._bytes):
            return StatusError.ACCESS
        found = []
        for register, content in self._registers(self._resolved(address, len(data)), data):
            if register is None:
                return StatusError.ACCESS
            if len(content) < register.size:
                return StatusError.DATA_LENGTH
            value = register.decode(content)
            if (error := check(register, value)) != StatusError.NONE:
                return error
            found.append(Write(register, value))
        return tuple(found)

    def set(self, writes: tuple[Write, ...]) -> None:
        """Set registers that were checked before."""
        for write in writes:
            self[write.register.name] = write.value

    def restore(self, names: Iterable[str], content: Mapping[str, int]) -> None:
        """Set registers from values that were kept."""
        for name in names:
            if name in content:
                self[name] = content[name]

    def _resolved(self, address: int, length: int) -> list[int]:
        """Where each byte really is, indirect data followed one step."""
        places = []
        for place in range(address, address + length):
            slot = self._slots.get(place)
            places.append(place if slot is None else self.values[slot])
        return places

    def _registers(
        self, places: list[int], data: bytes
    ) -> Iterator[tuple[Register | None, bytearray]]:
        """The registers that a row of bytes covers, each with the bytes of it that came."""
        index = 0
        while index < len(places):
            register = self.table.starting_at(places[index])
            if register is None:
                inside = self._known[places[index]]
                # A write that starts within a register brings less than the whole of it.
                yield (self._covering(places[index]) if inside else None), bytearray()
                return
            content = bytearray()
            while (
                len(content) < register.size
                and index < len(places)
                and places[index] == register.address + len(content)
            ):
                content.append(data[index])
                index += 1
            yield register, content

    def _covering(self, place: int) -> Register:
        return next(r for r in self.table.registers if r.address <= place < r.end)
