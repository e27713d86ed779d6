"""Protocol 2.0 on the wire: header, length, byte stuffing, CRC-16.

Source: ROBOTIS e-manual, docs/en/dxl/protocol2 and docs/en/dxl/crc. Two of the manual's printed
examples carry a wrong CRC: the request of Fast Bulk Read repeats that of Fast Sync Read, and the
request that restores a backup says 92 F5 where the polynomial gives 9E F5. The SDK agrees with us.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from enum import IntEnum

__all__ = [
    "ALERT",
    "BROADCAST",
    "HEADER",
    "Instruction",
    "Packet",
    "PacketReader",
    "StatusError",
    "crc16",
    "instruction_packet",
    "status_packet",
    "stuffed",
    "unstuffed",
]

HEADER = b"\xff\xff\xfd\x00"
"""Three bytes that start a packet, and the reserved one."""
BROADCAST = 0xFE
ALERT = 0x80
"""Bit of a status packet's error: Hardware Error Status(70) is not zero."""

_MARK = b"\xff\xff\xfd"
_STUFFED = b"\xff\xff\xfd\xfd"
_BODY = 7
"""Bytes before the instruction: header, reserved, id, length."""
_LONGEST = 1024
"""Bytes of a packet that the SDK's buffers hold; a longer length is noise."""


class Instruction(IntEnum):
    """What a packet asks for."""

    PING = 0x01
    READ = 0x02
    WRITE = 0x03
    REG_WRITE = 0x04
    ACTION = 0x05
    FACTORY_RESET = 0x06
    REBOOT = 0x08
    CLEAR = 0x10
    BACKUP = 0x20
    STATUS = 0x55
    SYNC_READ = 0x82
    SYNC_WRITE = 0x83
    FAST_SYNC_READ = 0x8A
    BULK_READ = 0x92
    BULK_WRITE = 0x93
    FAST_BULK_READ = 0x9A


class StatusError(IntEnum):
    """Number in a status packet's error byte; NONE where all went well."""

    NONE = 0
    RESULT_FAIL = 1
    INSTRUCTION = 2
    CRC = 3
    DATA_RANGE = 4
    DATA_LENGTH = 5
    DATA_LIMIT = 6
    ACCESS = 7


@dataclass(frozen=True, slots=True)
class Packet:
    """One packet taken off the wire, its stuffing removed.

    Attributes:
        id: Whom it is for, or from.
        instruction: Its raw number, which need not be a known `Instruction`.
        parameters: What follows the instruction, up to the CRC.
        sound: Whether its CRC was right; otherwise nothing else can be trusted.
    """

    id: int
    instruction: int
    parameters: bytes
    sound: bool = True


def _table() -> tuple[int, ...]:
    entries = []
    for high in range(256):
        value = high << 8
        for _ in range(8):
            value = (value << 1) ^ 0x8005 if value & 0x8000 else value << 1
        entries.append(value & 0xFFFF)
    return tuple(entries)


_TABLE = _table()


def crc16(data: bytes, start: int = 0) -> int:
    """CRC-16/BUYPASS of bytes: polynomial 0x8005, nothing reflected or inverted.

    Args:
        data: Everything from the header to the last parameter, stuffing included.
        start: The CRC so far, to go on with.
    """
    crc = start
    for byte in data:
        crc = ((crc << 8) & 0xFFFF) ^ _TABLE[(crc >> 8) ^ byte]
    return crc


def stuffed(body: bytes) -> bytes:
    """Instruction and parameters with FD put after every FF FF FD."""
    return body.replace(_MARK, _STUFFED)


def unstuffed(body: bytes) -> bytes:
    """Instruction and parameters as they were before `stuffed`."""
    return body.replace(_STUFFED, _MARK)


def instruction_packet(servo: int, instruction: int, parameters: bytes = b"") -> bytes:
    """A packet as it goes on the wire."""
    body = stuffed(bytes([instruction]) + parameters)
    head = HEADER + bytes([servo]) + (len(body) + 2).to_bytes(2, "little")
    return head + body + crc16(head + body).to_bytes(2, "little")


def status_packet(servo: int, error: int, parameters: bytes = b"") -> bytes:
    """A servo's answer as it goes on the wire."""
    return instruction_packet(servo, Instruction.STATUS, bytes([error]) + parameters)


class PacketReader:
    """Takes packets out of a stream of bytes, and finds its feet again after noise.

    Args:
        strict: Take an unstuffed FF FF FD within a packet for the header of another one, as the
            manual's order of reception says; otherwise trust the length.
    """

    def __init__(self, *, strict: bool = True) -> None:
        self._strict = strict
        self._buffer = bytearray()

    def forget(self) -> None:
        """Drop a packet that was begun and never ended."""
        self._buffer.clear()

    def feed(self, data: bytes) -> Iterator[Packet]:
        """The packets that these bytes complete; one with a wrong CRC is not `sound`."""
        self._buffer += data
        while (packet := self._next()) is not None:
            yield packet

    def _next(self) -> Packet | None:
        buffer = self._buffer
        while True:
            start = buffer.find(_MARK)
            if start < 0:
                del buffer[: max(0, len(buffer) - 2)]
                return None
            del buffer[:start]
            if len(buffer) < _BODY:
                return None
            length = int.from_bytes(buffer[5:7], "little")
            if buffer[3] != 0 or not 3 <= length <= _LONGEST:
                del buffer[:3]
                continue
            if (other := self._other_header(length)) is not None:
                del buffer[:other]
                continue
            if len(buffer) < _BODY + length:
                return None
            return self._take(_BODY + length)

    def _other_header(self, length: int) -> int | None:
        """Where an unstuffed header stands within the packet, as far as it has come."""
        if not self._strict:
            return None
        end = _BODY + length - 2
        place = self._buffer.find(_MARK, _BODY, end)
        while place >= 0:
            after = place + 3
            if after >= end:
                # Its last parameter, or the byte that tells has not come yet.
                return None if len(self._buffer) < _BODY + length else place
            if after < len(self._buffer) and self._buffer[after] != 0xFD:
                return place
            place = self._buffer.find(_MARK, after, end)
        return None

    def _take(self, size: int) -> Packet:
        raw = bytes(self._buffer[:size])
        sound = crc16(raw[:-2]) == int.from_bytes(raw[-2:], "little")
        # After a wrong CRC the true packet may begin within what was taken for this one.
        del self._buffer[: size if sound else 3]
        body = unstuffed(raw[_BODY:-2])
        return Packet(raw[4], body[0], body[1:], sound)
