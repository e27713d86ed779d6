"""Serial ports: opened for one program alone, with the adapter's latency known."""

from __future__ import annotations

import errno
import select
import sys
import time
from pathlib import Path
from typing import Any

import serial
from dynamixel_sdk import PortHandler

from enpointe.errors import RigError
from enpointe.hardware.dynamixel.port_users import lurkers, others_on

__all__ = ["PatientPort", "latency_timer", "open_port"]

_SYSTEM = Path("/sys")


class PatientPort(PortHandler):  # type: ignore[misc]  # the SDK ships no types
    """A `PortHandler` that sleeps until bytes come, and reckons with a clock that nobody sets.

    The SDK's own asks again and again, at the cost of a whole processor, and by the time of day.
    """

    def readPort(self, length: int) -> bytes:
        if sys.platform != "win32":  # where select knows sockets only
            left = self.packet_start_time + self.packet_timeout - self.getCurrentTime()
            select.select([self.ser.fileno()], [], [], max(left, 0.0) / 1000.0)
        return bytes(self.ser.read(length))

    def getCurrentTime(self) -> float:
        return time.monotonic() * 1000.0


def open_port(name: str, baud: int) -> Any:
    """The SDK's port handler on a serial port that nobody else has.

    Args:
        name: "/dev/ttyUSB0", "COM3".
        baud: bit/s.

    Raises:
        RigError: It can't be opened, or another program has it.
    """
    port = PatientPort(name)
    try:
        opened = port.setBaudRate(baud)
    except (serial.SerialException, OSError, ValueError) as error:
        if getattr(error, "errno", None) == errno.EBUSY:
            raise RigError(_taken(name)) from error
        raise RigError(f"{name} can't be opened: {_why(error)}") from error
    if not opened:
        raise RigError(f"the dynamixel-sdk can't talk at {baud} bit/s; choose another baud rate")
    try:
        _keep_others_out(port.ser)
    except OSError as error:
        port.closePort()
        raise RigError(_taken(name)) from error
    if (others := others_on(name)) is not None:
        port.closePort()
        raise RigError(others)
    return port


def _keep_others_out(line: Any) -> None:
    try:
        import fcntl
    except ImportError:
        return  # where there is none, the system opens a port only once anyway
    fcntl.flock(line.fileno(), fcntl.LOCK_EX | fcntl.LOCK_NB)


def _taken(name: str) -> str:
    """Who has a port that could not be had, as far as one may look."""
    if (others := others_on(name)) is not None:
        return others
    who = f"another user's program has {name}, and a bus has one owner"
    return "; ".join([who, *(lurkers() or [f"find it: sudo fuser -v {name}"])])


def _why(error: Exception) -> str:
    code = getattr(error, "errno", None)
    if code == errno.ENOENT:
        missing = "there is no such port; `enpointe doctor` lists those there are"
        return "; ".join([missing, *lurkers()])
    if code in (errno.EACCES, errno.EPERM):
        return "no leave; add yourself to the group that owns it (often dialout) and log in again"
    return " ".join(str(error).split())


def latency_timer(name: str, system: Path = _SYSTEM) -> int | None:
    """ms that a USB adapter holds bytes back; None where the system doesn't say.

    Args:
        name: Of the port; links are followed.
        system: Where the kernel's tree is.
    """
    device = Path(name).resolve().name
    file = system / "bus" / "usb-serial" / "devices" / device / "latency_timer"
    try:
        return int(file.read_text())
    except (OSError, ValueError):
        return None
