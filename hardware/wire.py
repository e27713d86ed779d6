"""How long packets take on the wire, and so how fast a bus can go.

Eight data bits, a start and a stop bit: ten bits a byte. Lengths count header to CRC and no byte
stuffing, which a packet of positions within one turn never needs.
"""

from __future__ import annotations

from dataclasses import dataclass

__all__ = [
    "BITS_PER_BYTE",
    "BusCycle",
    "fast_reply_length",
    "status_length",
    "sync_read_length",
    "sync_write_length",
    "wire_time",
]

BITS_PER_BYTE = 10
_FRAME = 14
"""Bytes of a sync packet beside its list: header 4, id, length 2, instruction, address 2, length 2,
CRC 2."""


def wire_time(count: int, baud: int) -> float:
    """s that so many bytes take."""
    return count * BITS_PER_BYTE / baud


def sync_write_length(servos: int, size: int) -> int:
    """Bytes of a sync write of `size` bytes to each servo."""
    return _FRAME + servos * (1 + size)


def sync_read_length(servos: int) -> int:
    """Bytes of the request of a sync read or a fast sync read."""
    return _FRAME + servos


def status_length(size: int) -> int:
    """Bytes of one servo's answer that carries `size` bytes."""
    return 11 + size


def fast_reply_length(servos: int, size: int) -> int:
    """Bytes of the one answer that all servos give together to a fast sync read."""
    return 8 + servos * (4 + size)


@dataclass(frozen=True, slots=True)
class BusCycle:
    """One control cycle on the bus: a sync write, then a read of everybody.

    Attributes:
        servos: How many.
        written: Bytes written to each.
        read: Bytes read from each.
        fast: Fast sync read, one answer for all, in place of one answer each.
        return_delay: s that a servo waits before it answers.
    """

    servos: int
    written: int = 4
    read: int = 10
    fast: bool = True
    return_delay: float = 0.0

    @property
    def length(self) -> int:
        """Bytes on the wire in one cycle."""
        asked = sync_write_length(self.servos, self.written) + sync_read_length(self.servos)
        if self.fast:
            return asked + fast_reply_length(self.servos, self.read)
        return asked + self.servos * status_length(self.read)

    def duration(self, baud: int) -> float:
        """s that one cycle takes, adapters and computers left out."""
        waits = 1 if self.fast else self.servos
        return wire_time(self.length, baud) + waits * self.return_delay

    def ceiling(self, baud: int) -> float:
        """Hz that nobody can exceed on this bus."""
        return 1.0 / self.duration(baud)
