"""The calibration wizard: which way and how far each horn was put on, measured, written, verified.

Torque is off all the while: joints are moved by hand. What is measured goes into the rig's file and
not into the servos (whose homing offset is silently ignored beyond a quarter turn), so that one
file says everything; the servos get the settings that every rig needs, and the limits.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from pathlib import Path

import numpy as np
from pydantic import ValidationError

from enpointe.errors import RigError
from enpointe.hardware.control_table import control_table
from enpointe.hardware.dynamixel.checks import Finding, check_rig, settings_of
from enpointe.hardware.dynamixel.link import Link
from enpointe.hardware.packets import StatusError
from enpointe.hardware.rig_file import Rig, RigServo, first_complaint, save_rig
from enpointe.hardware.units import CENTRE, PULSE, REVOLUTION

__all__ = ["Calibration"]

_READINGS = 5
_SHAKE = 12
"""Pulses (1 degree) that a joint held still may seem to move."""
_MOVED = 57
"""Pulses (5 degrees) by which a joint must be moved to show its sense."""
_TRUE = math.radians(3.0)
"""How far from zero a joint may read after it was put there again, by hand."""
_FIRST = ("Operating Mode", "Drive Mode", "Homing Offset")
"""Settings that change what a position reads, set before any is read."""


class Calibration:
    """One rig on one bus.

    Args:
        rig: As it is believed to be.
        link: The bus.
        ask: Shows a line and returns when the person has done what it says.
        tell: Shows a line.
    """

    def __init__(
        self,
        rig: Rig,
        link: Link,
        ask: Callable[[str], None],
        tell: Callable[[str], None],
    ) -> None:
        self.rig = rig
        self._link = link
        self._ask, self._tell = ask, tell

    def let_go(self) -> None:
        """Find everybody and take the torque away, read back.

        Raises:
            RigError: A servo is not there, is another model, or does not let go.
        """
        for servo in self.rig.servos:
            number = self._link.ping(servo.id)
            if number != servo.sheet.number:
                what = "does not answer" if number is None else f"is a model {number}"
                raise RigError(
                    f"servo {servo.id} ({servo.joint}) {what}; the file says a {servo.model} at"
                    f" {self.rig.baud} bit/s: look at cable, power, ID and baud rate"
                )
        for servo in self.rig.servos:
            self._set(servo, "Torque Enable", 0)

    def set_up(self, names: Sequence[str] | None = None) -> int:
        """Write the settings that a rig needs to all servos, where they are others.

        Args:
            names: Registers; all if None.

        Returns:
            How many were written.

        Raises:
            RigError: A servo refuses.
        """
        written = 0
        for servo in self.rig.servos:
            table = control_table(servo.sheet.number)
            for name, value in settings_of(servo).items():
                if names is not None and name not in names:
                    continue
                if self._link.read(servo.id, table[name]) != value:
                    self._set(servo, name, value)
                    written += 1
        return written

    def measure(self, *, signs: bool = True) -> Rig:
        """Ask for the zero pose, and if wanted for a push of each joint; the rig as it is.

        Raises:
            RigError: A joint was moved while it was read, or not moved enough, or its limits leave
                the servo's one turn.
        """
        self._ask("put every joint at its zero (standing straight, arms down) and hold it")
        zeros = [self._steady(servo) for servo in self.rig.servos]
        servos = []
        for servo, zero in zip(self.rig.servos, zeros, strict=True):
            sign = self._sign(servo, zero) if signs else servo.sign
            offset = math.degrees((zero - CENTRE) * PULSE)
            servos.append(self._with(servo, sign, round(offset, 2)))
        self.rig = self.rig.model_copy(update={"servos": tuple(servos)})
        return self.rig

    def verify(self) -> None:
        """Ask for the zero pose again; every joint must read as there.

        Raises:
            RigError: One reads otherwise.
        """
        self._ask("move the joints about, put all at zero again and hold them")
        for servo in self.rig.servos:
            pulses = self._steady(servo)
            angle = servo.sign * ((pulses - CENTRE) * PULSE - math.radians(servo.offset))
            if abs(angle) > _TRUE:
                raise RigError(
                    f"servo {servo.id} ({servo.joint}) reads {math.degrees(angle):.1f} degrees at"
                    " zero; look whether its horn slips, and calibrate again"
                )

    def save(self, path: Path) -> list[Finding]:
        """Write limits to the servos and the rig to its file; what still keeps it from moving."""
        self.set_up()
        save_rig(self.rig, path, ["Written by `enpointe calibrate`."])
        return check_rig(self.rig, self._link)

    def _sign(self, servo: RigServo, zero: int) -> int:
        self._ask(
            f"move {servo.joint} ({servo.id}) its positive way, 10 to 30 degrees, and hold it"
        )
        moved = self._steady(servo) - zero
        if not _MOVED <= abs(moved) < REVOLUTION // 2:
            raise RigError(
                f"{servo.joint} moved {moved * PULSE * 180 / math.pi:.0f} degrees; move it by 10 to"
                " 30, and only it"
            )
        sign = 1 if moved > 0 else -1
        self._tell(f"{servo.joint}: sign {sign:+d}")
        return sign

    def _with(self, servo: RigServo, sign: int, offset: float) -> RigServo:
        try:
            return RigServo.model_validate({**servo.model_dump(), "sign": sign, "offset": offset})
        except ValidationError as error:
            raise RigError(f"servo {servo.id}: {first_complaint(error)}") from None

    def _steady(self, servo: RigServo) -> int:
        """Where a joint is held, pulses."""
        register = control_table(servo.sheet.number)["Present Position"]
        found = [self._link.read(servo.id, register) for _ in range(_READINGS)]
        values = [value for value in found if value is not None]
        if len(values) < _READINGS:
            raise RigError(f"servo {servo.id} ({servo.joint}) does not answer; look at its cable")
        if max(values) - min(values) > _SHAKE:
            raise RigError(f"{servo.joint} was moved while it was read; hold it still, begin again")
        return round(float(np.median(values)))

    def _set(self, servo: RigServo, name: str, value: int) -> None:
        register = control_table(servo.sheet.number)[name]
        error = self._link.write(servo.id, register, value)
        if error is None or error is not StatusError.NONE:
            why = "no answer" if error is None else error.name.lower().replace("_", " ")
            raise RigError(f"servo {servo.id} ({servo.joint}) does not take {name} {value}: {why}")
        if self._link.read(servo.id, register) != value:
            raise RigError(f"servo {servo.id} ({servo.joint}) has forgotten {name}; set it again")

    def prepare(self) -> None:
        """Let go, and set what changes the reading of positions."""
        self.let_go()
        self.set_up(_FIRST)
