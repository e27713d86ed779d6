"""Alarms, heat and supply: slow registers read one a cycle, alarms first.

Sync reads carry one bit that says "an alarm"; what it is stands in Hardware Error Status(70), read
here, of one servo a cycle. Between alarms the cycles go round all servos, each in turn for its
errors and for its heat and supply, so that an alarm whose bit were lost would show as well. Before
all that a servo that was silent for some frames is asked whether its torque is on: one whose cable
lost contact for a moment has booted since, and hangs loose among the others.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from enpointe.hardware.control_table import Register
from enpointe.hardware.dynamixel.frames import Frame
from enpointe.hardware.dynamixel.link import Link
from enpointe.hardware.hardware_error import HardwareError
from enpointe.hardware.units import TENTH_VOLT

__all__ = ["Health"]

Array = NDArray[np.float64]
_UNKNOWN = -1
_SILENT = 2
"""Frames missed in a row by one who may have lost power: a boot takes longer."""


class Health:
    """What is known of each servo's well-being.

    Args:
        link: The bus.
        ids: In the rig's order.
        registers: `common` of the rig.
        temperature_limit: (n,) degrees Celsius, as the servos have it.

    Attributes:
        temperature: (n,) degrees Celsius, as last read.
        voltage: (n,) V.
        temperature_limit: (n,) degrees Celsius.
        loose: (n,) whose torque was found to be off.
    """

    def __init__(
        self,
        link: Link,
        ids: Sequence[int],
        registers: dict[str, Register],
        temperature_limit: Array,
    ) -> None:
        self.temperature = np.full(len(ids), np.nan)
        self.voltage = np.full(len(ids), np.nan)
        self.temperature_limit = temperature_limit
        self._link = link
        self._ids = tuple(ids)
        self._status = registers["Hardware Error Status"]
        self._volts, self._heat = (
            registers["Present Input Voltage"],
            registers["Present Temperature"],
        )
        self._torque = registers["Torque Enable"]
        self._errors = np.full(len(ids), _UNKNOWN)
        self.loose = np.zeros(len(ids), dtype=bool)
        self._missed = np.zeros(len(ids), dtype=np.int64)
        self._turn = 0
        self._alarm = 0

    @property
    def status(self) -> NDArray[np.int64]:
        """(n,) Hardware Error Status as last read; -1 before."""
        return self._errors.copy()

    def errors(self, place: int) -> HardwareError | None:
        """A servo's errors; None if it has said nothing of any yet."""
        found = int(self._errors[place])
        return HardwareError(found) if found > 0 else None

    def step(self, frame: Frame) -> None:
        """Read one register of one servo.

        Args:
            frame: The newest: who was silent, and whose answer says that he has an alarm.

        Raises:
            PortLostError: The port is gone.
        """
        doubtful = self._missed >= _SILENT
        self._missed[~doubtful & frame.fresh] = 0
        self._missed[~frame.fresh] += 1
        returned = np.flatnonzero(doubtful & frame.fresh)
        if len(returned):
            self._read_torque(int(returned[0]))
            return
        alarmed = np.flatnonzero(frame.alert)
        if len(alarmed):
            unnamed = [place for place in alarmed if self._errors[place] <= 0]
            candidates = unnamed or list(alarmed)
            self._alarm += 1
            self._read_errors(int(candidates[self._alarm % len(candidates)]))
            return
        self._turn += 1
        place = self._turn // 2 % len(self._ids)
        if self._turn % 2:
            self._read_errors(place)
        else:
            self._read_heat(place)

    def _read_torque(self, place: int) -> None:
        value = self._link.read(self._ids[place], self._torque, tries=1)
        if value is not None:
            self.loose[place] = value == 0
            self._missed[place] = 0

    def _read_errors(self, place: int) -> None:
        value = self._link.read(self._ids[place], self._status, tries=1)
        if value is not None:
            self._errors[place] = value

    def _read_heat(self, place: int) -> None:
        size = self._heat.end - self._volts.address
        data = self._link.read_bytes(self._ids[place], self._volts.address, size, tries=1)
        if data is not None:
            self.voltage[place] = int.from_bytes(data[:2], "little") * TENTH_VOLT
            self.temperature[place] = data[-1]
