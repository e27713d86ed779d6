"""Who answers an instruction, with what, and how long after the one before.

Source: e-manual, protocol 2.0, instruction details. Read the order of answers so: in a sync or bulk
read each servo waits for the answer of the one named before it, so that a missing servo silences
those after it (seen by users: ROBOTIS-GIT/DynamixelSDK#331).
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass

from enpointe.hardware.emulator.servo import Servo
from enpointe.hardware.packets import (
    ALERT,
    BROADCAST,
    HEADER,
    Instruction,
    Packet,
    StatusError,
    crc16,
    status_packet,
)

__all__ = ["Answer", "answers"]

_CLEAR_TURNS = b"\x01\x44\x58\x4c\x22"
_BACK_UP = b"\x01CTRL"
_RESTORE = b"\x02CTRL"
_RESET_ALL, _KEEP_ID, _KEEP_ID_AND_BAUD = 0xFF, 0x01, 0x02
_SHADOWLESS = 253
"""A Secondary ID from here on is none."""
_ALL, _READS = 2, 1
"""Status Return Levels."""
_FAST = (Instruction.FAST_SYNC_READ, Instruction.FAST_BULK_READ)
_LISTS = (
    Instruction.SYNC_READ,
    Instruction.SYNC_WRITE,
    Instruction.BULK_READ,
    Instruction.BULK_WRITE,
    *_FAST,
)


@dataclass(frozen=True, slots=True)
class Answer:
    """What one servo puts on the wire.

    Attributes:
        servo: Its ID.
        data: The bytes.
        delay: s between the end of what was on the wire before and these.
    """

    servo: int
    data: bytes
    delay: float


@dataclass(frozen=True, slots=True)
class _Asked:
    """One servo's part of a packet that lists several."""

    servo: int
    address: int
    length: int
    data: bytes = b""


def answers(packet: Packet, servos: Sequence[Servo]) -> list[Answer]:
    """Do what a packet says, and give the answers in the order of the wire.

    Args:
        packet: Off the wire.
        servos: Those that hear it.
    """
    if packet.instruction == Instruction.STATUS:
        return []
    if not packet.sound:
        named = [servo for servo in servos if servo.id == packet.id]
        return _together(_status(servo, StatusError.CRC) for servo in named)
    if packet.instruction in _LISTS:
        return _listed(packet, servos) if packet.id == BROADCAST else []
    if packet.id == BROADCAST:
        return _broadcast(packet, servos)
    for servo in servos:
        shadow = servo.memory["Secondary(Shadow) ID"]
        if shadow == packet.id and shadow < _SHADOWLESS and servo.id != packet.id:
            _shadowed(packet, servo)
    named = [servo for servo in servos if servo.id == packet.id]
    return _together(answer for servo in named if (answer := _one(packet, servo)) is not None)


def _status(servo: Servo, error: int, data: bytes = b"") -> Answer:
    alert = ALERT if servo.memory["Hardware Error Status"] else 0
    return Answer(servo.id, status_packet(servo.id, error | alert, data), servo.return_delay)


def _together(found: Iterable[Answer]) -> list[Answer]:
    """Servos that share an ID talk at once, and a zero wins on the wire."""
    each = list(found)
    if len(each) < 2:
        return each
    longest = max(len(answer.data) for answer in each)
    lines = [answer.data.ljust(longest, b"\xff") for answer in each]
    mixed = bytes(_all_of(row) for row in zip(*lines, strict=True))
    return [Answer(each[0].servo, mixed, min(answer.delay for answer in each))]


def _all_of(row: tuple[int, ...]) -> int:
    value = 0xFF
    for byte in row:
        value &= byte
    return value


def _ping(servo: Servo) -> Answer:
    number = servo.model.number.to_bytes(2, "little")
    return _status(servo, StatusError.NONE, number + bytes([servo.firmware]))


def _broadcast(packet: Packet, servos: Sequence[Servo]) -> list[Answer]:
    if packet.instruction == Instruction.PING:
        return [_ping(servo) for servo in sorted(servos, key=lambda servo: servo.id)]
    resets_all = packet.parameters == bytes([_RESET_ALL])
    if packet.instruction == Instruction.FACTORY_RESET and resets_all:
        return []
    for servo in servos:
        _one(packet, servo)
    return []


def _shadowed(packet: Packet, servo: Servo) -> None:
    if packet.instruction == Instruction.WRITE and len(packet.parameters) > 2:
        address = int.from_bytes(packet.parameters[:2], "little")
        servo.write(address, packet.parameters[2:], ram_only=True)


def _one(packet: Packet, servo: Servo) -> Answer | None:
    """Do it, and answer as far as Status Return Level lets."""
    level = servo.memory["Status Return Level"]
    if packet.instruction == Instruction.PING:
        return _ping(servo)
    if packet.instruction == Instruction.READ:
        answer = _read(packet.parameters, servo)
        return answer if level >= _READS else None
    # Answered with the settings from before, which the instruction may change.
    delay, number = servo.return_delay, servo.id
    error = _do(packet, servo)
    if level < _ALL:
        return None
    alert = ALERT if servo.memory["Hardware Error Status"] else 0
    return Answer(number, status_packet(number, error | alert), delay)


def _read(parameters: bytes, servo: Servo) -> Answer:
    if len(parameters) != 4:
        return _status(servo, StatusError.DATA_LENGTH)
    found = servo.read(_word(parameters, 0), _word(parameters, 2))
    if isinstance(found, StatusError):
        return _status(servo, found)
    return _status(servo, StatusError.NONE, found)


def _do(packet: Packet, servo: Servo) -> StatusError:
    """An instruction that has no data to give back."""
    parameters = packet.parameters
    match packet.instruction:
        case Instruction.WRITE | Instruction.REG_WRITE:
            if len(parameters) < 3:
                return StatusError.DATA_LENGTH
            into = servo.write if packet.instruction == Instruction.WRITE else servo.register
            return into(_word(parameters, 0), parameters[2:])
        case Instruction.ACTION:
            return servo.act()
        case Instruction.REBOOT:
            servo.reboot()
            return StatusError.NONE
        case Instruction.FACTORY_RESET:
            return _factory_reset(parameters, servo)
        case Instruction.CLEAR if parameters == _CLEAR_TURNS:
            return servo.clear_turns()
        case Instruction.BACKUP if servo.firmware < servo.model.fast_read:
            return StatusError.INSTRUCTION
        case Instruction.BACKUP if parameters == _BACK_UP:
            return servo.back_up()
        case Instruction.BACKUP if parameters == _RESTORE:
            return servo.restore()
        case Instruction.CLEAR | Instruction.BACKUP:
            return StatusError.DATA_RANGE
    return StatusError.INSTRUCTION


def _factory_reset(parameters: bytes, servo: Servo) -> StatusError:
    if len(parameters) != 1 or parameters[0] not in (_RESET_ALL, _KEEP_ID, _KEEP_ID_AND_BAUD):
        return StatusError.DATA_RANGE
    option = parameters[0]
    servo.factory_reset(keep_id=option != _RESET_ALL, keep_baud=option == _KEEP_ID_AND_BAUD)
    return StatusError.NONE


def _listed(packet: Packet, servos: Sequence[Servo]) -> list[Answer]:
    by_id = {servo.id: servo for servo in servos}
    match packet.instruction:
        case Instruction.SYNC_WRITE | Instruction.BULK_WRITE:
            for asked in _parts(packet):
                if (servo := by_id.get(asked.servo)) is not None and asked.length:
                    servo.write(asked.address, asked.data)
            return []
        case Instruction.SYNC_READ | Instruction.BULK_READ:
            return list(_in_turn(_parts(packet), by_id))
    return list(_as_one(list(_parts(packet)), by_id))


def _in_turn(asked: Iterable[_Asked], by_id: dict[int, Servo]) -> Iterator[Answer]:
    for each in asked:
        servo = by_id.get(each.servo)
        if servo is None or servo.memory["Status Return Level"] < _READS:
            return
        found = servo.read(each.address, each.length)
        if isinstance(found, StatusError):
            yield _status(servo, found)
        else:
            yield _status(servo, StatusError.NONE, found)


def _as_one(asked: list[_Asked], by_id: dict[int, Servo]) -> Iterator[Answer]:
    """The one packet that all make together; each part's CRC is over everything before it."""
    length = 1 + sum(4 + each.length for each in asked)
    so_far = HEADER + bytes([BROADCAST]) + length.to_bytes(2, "little")
    part = so_far + bytes([Instruction.STATUS])
    crc, delay = 0, None
    for each in asked:
        servo = by_id.get(each.servo)
        if servo is None or servo.firmware < servo.model.fast_read:
            return
        if servo.memory["Status Return Level"] < _READS:
            return
        found = servo.read(each.address, each.length)
        failed = isinstance(found, StatusError)
        error = (int(found) if failed else 0) | (
            ALERT if servo.memory["Hardware Error Status"] else 0
        )
        content = bytes(each.length) if isinstance(found, StatusError) else found
        part += bytes([error, servo.id]) + content
        crc = crc16(part, crc)
        ending = crc.to_bytes(2, "little")
        crc = crc16(ending, crc)
        yield Answer(servo.id, part + ending, servo.return_delay if delay is None else 0.0)
        part, delay = b"", 0.0


def _parts(packet: Packet) -> Iterator[_Asked]:
    """The list of a sync or bulk packet; what is cut short at its end is left out."""
    data = packet.parameters
    match packet.instruction:
        case Instruction.BULK_READ | Instruction.FAST_BULK_READ:
            for place in range(0, len(data) - 4, 5):
                yield _Asked(data[place], _word(data, place + 1), _word(data, place + 3))
            return
        case Instruction.BULK_WRITE:
            yield from _bulk_writes(data)
            return
    if len(data) < 4:
        return
    address, length, rest = _word(data, 0), _word(data, 2), data[4:]
    if packet.instruction == Instruction.SYNC_WRITE:
        for place in range(0, len(rest) - length, 1 + length):
            yield _Asked(rest[place], address, length, rest[place + 1 : place + 1 + length])
        return
    for number in rest:
        yield _Asked(number, address, length)


def _bulk_writes(data: bytes) -> Iterator[_Asked]:
    place = 0
    while place + 5 <= len(data):
        length = _word(data, place + 3)
        end = place + 5 + length
        if end > len(data):
            return
        yield _Asked(data[place], _word(data, place + 1), length, data[place + 5 : end])
        place = end


def _word(data: bytes, place: int) -> int:
    return int.from_bytes(data[place : place + 2], "little")
