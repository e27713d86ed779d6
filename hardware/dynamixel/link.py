"""The bus and its one owner: the dynamixel-sdk's calls, with what they leave to their caller.

The SDK's port is a try-lock and not a queue, stays "busy" for ever after an exception, reckons with
an adapter of 16 ms latency, forgets byte stuffing when it sends, and returns numbers where a person
needs words (docs/emulator.md, last section; DynamixelSDK issues 247 and 288). All of it ends here.
"""

from __future__ import annotations

import contextlib
import threading
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any

import dynamixel_sdk
import serial
from dynamixel_sdk import port_handler

from enpointe.errors import RigError
from enpointe.hardware.control_table import Register
from enpointe.hardware.packets import ALERT, HEADER, StatusError

__all__ = ["PATIENCE", "Link", "LinkCounts", "PortLostError"]

PATIENCE = 1.0
"""ms that an adapter holds bytes back, as the SDK's timeouts are told: its latency timer. What a
timeout comes to is the packet's own time and twice this and 2 ms."""
_TRIES = 3
_MARK = HEADER[:3]
_ID, _ERROR, _STATUS = 4, 8, 11
"""Places in a status packet, and its bytes beside its data."""
_GONE = "the serial port is gone: cut the servos' power, plug the adapter in and begin again"


class PortLostError(RigError):
    """The adapter is gone: what drives the rig catches it and reacts."""


@dataclass(slots=True)
class LinkCounts:
    """How the bus has done.

    Attributes:
        asked: Answers waited for.
        failed: Those that did not come, or came damaged.
        retried: Of the calls that are repeated, the repeats.
    """

    asked: int = 0
    failed: int = 0
    retried: int = 0


class Link:
    """A port with the SDK on it, used by the thread that made it and no other.

    Args:
        port: A `PortHandler`, opened at the rig's baud rate.
        patience: ms; see `PATIENCE`.
    """

    def __init__(self, port: Any, patience: float = PATIENCE) -> None:
        self.port = port
        self.handler = dynamixel_sdk.PacketHandler(2.0)
        self.counts = LinkCounts()
        self.lost = False
        self._owner = threading.get_ident()
        self._patience = patience

    @contextlib.contextmanager
    def _mine(self) -> Iterator[None]:
        """The port for the length of one call."""
        if threading.get_ident() != self._owner:
            raise RigError("the bus has one owner: call it from the thread that opened it")
        if self.lost:
            raise PortLostError(_GONE)
        # A module's constant is how the SDK is told; other ports of this process keep theirs.
        others = port_handler.LATENCY_TIMER
        port_handler.LATENCY_TIMER = self._patience
        try:
            yield
        except (serial.SerialException, OSError) as error:
            self.lost = True
            raise PortLostError(f"{_GONE} ({' '.join(str(error).split())})") from error
        finally:
            port_handler.LATENCY_TIMER = others
            self.port.is_using = False

    def close(self) -> None:
        """Give the port back."""
        with contextlib.suppress(serial.SerialException, OSError, AttributeError):
            self.port.closePort()

    # One servo

    def ping(self, servo: int) -> int | None:
        """A servo's model number, or None if it doesn't answer."""
        for attempt in range(_TRIES):
            with self._mine():
                number, result, _ = self.handler.ping(self.port, servo)
            if self._came(result == dynamixel_sdk.COMM_SUCCESS, attempt):
                return int(number)
        return None

    def everybody(self) -> dict[int, int]:
        """Model numbers by ID of all that answer a broadcast ping. Takes the best part of 1 s."""
        with self._mine():
            found, _ = self.handler.broadcastPing(self.port)
        return {int(servo): int(number) for servo, (number, _) in found.items()}

    def read(self, servo: int, register: Register, *, tries: int = _TRIES) -> int | None:
        """A register's value, with its sign; None if no answer came."""
        data = self.read_bytes(servo, register.address, register.size, tries=tries)
        return None if data is None else register.decode(data)

    def read_bytes(
        self, servo: int, address: int, size: int, *, tries: int = _TRIES
    ) -> bytes | None:
        """Neighbouring registers as bytes; None if no answer came."""
        for attempt in range(tries):
            found: dict[int, tuple[int, bytes]] = {}
            with self._mine():
                result = self.handler.readTx(self.port, servo, address, size)
                if result == dynamixel_sdk.COMM_SUCCESS:
                    # The SDK's own takes the first bytes of any answer, also of a late, longer one.
                    self._collect({servo}, size, found)
            if self._came(servo in found, attempt):
                return found[servo][1]
        return None

    def write(
        self, servo: int, register: Register, value: int, *, tries: int = _TRIES
    ) -> StatusError | None:
        """Set a register; what the servo says of it, or None if no answer came."""
        data = register.encode(value)
        self._refuse_mark(data)
        for attempt in range(tries):
            with self._mine():
                result, error = self.handler.writeTxRx(
                    self.port, servo, register.address, register.size, list(data)
                )
            if self._came(result == dynamixel_sdk.COMM_SUCCESS, attempt):
                return _status(int(error) & ~ALERT)
        return None

    def reboot(self, servo: int) -> bool:
        """Start a servo anew: the only way out of its shutdown. Whether it answered."""
        with self._mine():
            result, _ = self.handler.reboot(self.port, servo)
        return bool(result == dynamixel_sdk.COMM_SUCCESS)

    # Everybody

    def sync_write(self, register: Register, values: Sequence[tuple[int, int]]) -> None:
        """Set one register of many servos; nobody answers.

        Args:
            register: Which.
            values: Pairs of a servo's ID and its value.
        """
        parameters = bytearray()
        for servo, value in values:
            parameters.append(servo)
            parameters += register.encode(value)
        self._refuse_mark(parameters)
        with self._mine():
            self.handler.syncWriteTxOnly(
                self.port, register.address, register.size, list(parameters), len(parameters)
            )

    def sync_read(
        self, ids: Sequence[int], address: int, size: int
    ) -> dict[int, tuple[int, bytes]]:
        """Read the same registers of many servos, one answer each.

        The SDK's own group throws everything away when one answer is missing, and all error bytes
        always; this keeps what comes, in whatever order, until the SDK's patience is over.

        Returns:
            Error byte and data by ID, of those that answered well.
        """
        found: dict[int, tuple[int, bytes]] = {}
        self.counts.asked += len(ids)
        with self._mine():
            sent = self.handler.syncReadTx(self.port, address, size, list(ids), len(ids), False)
            if sent == dynamixel_sdk.COMM_SUCCESS:
                self._collect(set(ids), size, found)
        self.counts.failed += len(ids) - len(found)
        return found

    def _collect(self, ids: set[int], size: int, found: dict[int, tuple[int, bytes]]) -> None:
        while len(found) < len(ids):
            packet, result = self.handler.rxPacket(self.port, False)
            if result == dynamixel_sdk.COMM_SUCCESS and len(packet) == _STATUS + size:
                if packet[_ID] in ids:
                    found[packet[_ID]] = int(packet[_ERROR]), bytes(packet[_ERROR + 1 : -2])
            elif result == dynamixel_sdk.COMM_RX_TIMEOUT:
                break

    def fast_sync_read(
        self, ids: Sequence[int], address: int, size: int
    ) -> dict[int, tuple[int, bytes]]:
        """The same in one answer of all together, which comes whole or not at all."""
        self.counts.asked += 1
        step = size + 4
        data: Sequence[int] = ()
        with self._mine():
            result = self.handler.syncReadTx(self.port, address, size, list(ids), len(ids), True)
            if result == dynamixel_sdk.COMM_SUCCESS:
                data, result, _ = self.handler.fastSyncReadRx(
                    self.port, dynamixel_sdk.BROADCAST_ID, step * len(ids)
                )
        parts = [bytes(data[at : at + step]) for at in range(0, len(data), step)]
        # A late answer of one servo alone can come in its place: the SDK's group fails on it.
        whole = [part[1] for part in parts if len(part) >= step - 2] == list(ids)
        if result != dynamixel_sdk.COMM_SUCCESS or not whole:
            self.counts.failed += 1
            return {}
        return {part[1]: (part[0], part[2 : 2 + size]) for part in parts}

    def _came(self, good: bool, attempt: int) -> bool:
        self.counts.asked += 1
        self.counts.retried += attempt > 0
        self.counts.failed += not good
        return bool(good)

    @staticmethod
    def _refuse_mark(data: bytes | bytearray) -> None:
        if _MARK in data:
            raise RigError(
                "bytes to be written hold FF FF FD, which the dynamixel-sdk would send bare and"
                " servos take for a header; write one register at a time"
            )


def _status(code: int) -> StatusError:
    try:
        return StatusError(code)
    except ValueError:
        return StatusError.RESULT_FAIL
