"""The emulated bus as a port of the dynamixel-sdk, in memory and in virtual time.

The SDK's own packet handlers and groups run on it unchanged, timeouts included; it waits by moving
the clock, so that ten seconds of dance take as long as their arithmetic.
"""

from __future__ import annotations

import serial
from dynamixel_sdk import PortHandler

from enpointe.hardware.clock import VirtualClock
from enpointe.hardware.emulator.bus import Bus

__all__ = ["EmulatedPort"]

_PAST = 1e-6
"""s beyond a timeout that the clock goes to when nothing comes."""


class EmulatedPort(PortHandler):  # type: ignore[misc]  # the SDK ships no types
    """A `PortHandler` whose wires are an emulated bus.

    Args:
        bus: Whose time the clock's is.
        clock: Moved on whenever the host waits for bytes.
        name: What getPortName says.
    """

    def __init__(self, bus: Bus, clock: VirtualClock, name: str = "emulated") -> None:
        super().__init__(name)
        self.bus = bus
        self.clock = clock

    def closePort(self) -> None:
        self.is_open = False

    def clearPort(self) -> None:
        self._plugged()
        self.bus.run_until(self.clock.now())
        self.bus.line.take_answered(self.clock.now())

    def setupPort(self, cflag_baud: int) -> bool:
        self._plugged()
        self.is_open = True
        self.bus.line.baud = self.baudrate
        self.clearPort()
        self.tx_time_per_byte = 1000.0 / self.baudrate * 10.0
        return True

    def getBytesAvailable(self) -> int:
        self._plugged()
        self.bus.run_until(self.clock.now())
        return self.bus.line.available(self.clock.now())

    def readPort(self, length: int) -> bytes:
        """Bytes that have come; waits, as the SDK's loop does, for as many as asked or too long."""
        self._plugged()
        deadline = (self.packet_start_time + self.packet_timeout) / 1000.0 + _PAST
        while (now := self.clock.now()) < deadline:
            self.bus.run_until(now)
            if self.bus.line.available(now) >= length:
                break
            self.clock.sleep_until(min(self._next(length), deadline))
        self.bus.run_until(self.clock.now())
        return self.bus.line.take_answered(self.clock.now(), length)

    def writePort(self, packet: list[int] | bytes) -> int:
        self._plugged()
        data = bytes(packet)
        self.bus.send(data, self.clock.now())
        return len(data)

    def getCurrentTime(self) -> float:
        return self.clock.now() * 1000.0

    def _next(self, length: int) -> float:
        """When there is a reason to look again."""
        moments = (self.bus.line.next_sent(), self.bus.line.next_answered(max(length, 1)))
        return min((moment for moment in moments if moment is not None), default=float("inf"))

    def _plugged(self) -> None:
        now = self.clock.now()
        if self.bus.faults is not None and self.bus.faults.unplugged(now):
            raise serial.SerialException(f"{self.port_name}: the adapter has been unplugged")
