"""What is looked at before a servo may move: is the rig the one that the file describes?

Every finding is one line that says what is wrong with which servo, and what to do.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from enpointe.errors import RigError
from enpointe.hardware.control_table import ControlTable, control_table
from enpointe.hardware.datasheet import servo_models
from enpointe.hardware.dynamixel.codec import Codec
from enpointe.hardware.dynamixel.link import Link
from enpointe.hardware.dynamixel.registers import CURRENT_BASED, POSITION
from enpointe.hardware.hardware_error import HardwareError
from enpointe.hardware.rig_file import Rig, RigServo
from enpointe.hardware.units import BAUD_RATES, CENTRE, REVOLUTION, TENTH_VOLT

__all__ = ["DRIVE_MODE", "Finding", "check_rig", "settings_of"]

DRIVE_MODE = 0x04
"""Profiles by time: a goal is reached at the end of the period in which it comes, at an even speed.
Not reversed, for the file's sign does that; torque not switched on by a goal."""
_STRAY = 40
"""Pulses (3.5 degrees) that a joint may stand beyond its limits, as one that rests on its stop."""
_MARGIN = 10
"""Degrees Celsius below its own limit that a servo must be to begin."""
_SHUTDOWN = HardwareError.OVERHEATING | HardwareError.ELECTRICAL_SHOCK | HardwareError.OVERLOAD


@dataclass(frozen=True, slots=True)
class Finding:
    """Something that keeps the rig from moving.

    Attributes:
        servo: Its ID.
        joint: That it turns.
        what: Is wrong.
        todo: To mend it.
        setting: Register and value that would mend it, for `set_up`; None if it takes a person.
    """

    servo: int
    joint: str
    what: str
    todo: str
    setting: tuple[str, int] | None = None

    def __str__(self) -> str:
        return f"servo {self.servo} ({self.joint}): {self.what}; {self.todo}"


def settings_of(servo: RigServo) -> dict[str, int]:
    """What a servo's EEPROM must hold for its place in a rig, by register."""
    low, high = servo.pulse_limits
    settings = {
        "Return Delay Time": 0,
        "Drive Mode": DRIVE_MODE,
        "Operating Mode": CURRENT_BASED if servo.current else POSITION,
        "Homing Offset": 0,
        "Min Position Limit": low,
        "Max Position Limit": high,
        "Shutdown": int(servo.sheet.initial["Shutdown"]),
    }
    if servo.current:
        settings["Current Limit"] = int(servo.sheet.current_limit or 0)
    return settings


_WHY = {
    "Return Delay Time": "it waits {found} x 2 us before each answer",
    "Drive Mode": "its drive mode is {found} and the rig needs {wanted} (profiles by time)",
    "Operating Mode": "its operating mode is {found} and the rig file asks for {wanted}",
    "Homing Offset": "it has a homing offset of {found} pulses, and the file's offset is all",
    "Shutdown": "its shutdown register is {found} and leaves it unprotected; {wanted} is usual",
    "Current Limit": "its current limit of {found} is below the {needed} that the file allows",
}
_SET_UP = "run `enpointe calibrate --set-up`"


def check_rig(rig: Rig, link: Link) -> list[Finding]:
    """All that keeps a rig from moving, in the order of its servos.

    Args:
        rig: What it should be.
        link: The bus that it is on.

    Raises:
        PortLostError: The port is gone.
    """
    found: list[Finding] = []
    for servo in rig.servos:
        number = link.ping(servo.id)
        if number is None:
            baud = f"{rig.baud} bit/s"
            todo = f"look at its cable, power, ID and baud rate ({BAUD_RATES.index(rig.baud)})"
            found.append(Finding(servo.id, servo.joint, f"no answer at {baud}", todo))
        elif number != servo.sheet.number:
            names = {model.number: model.name for model in servo_models().values()}
            what = f"it is a {names.get(number, f'model {number}')}, not a {servo.model}"
            found.append(Finding(servo.id, servo.joint, what, "change the file, or the servo"))
        else:
            try:
                found += _One(rig, servo, link).findings()
            except _SilentError:
                what = "it answers a ping and not a read"
                todo = "look at the cable, and at Status Return Level(68), which must be 1 or 2"
                found.append(Finding(servo.id, servo.joint, what, todo))
    return found


class _SilentError(RigError):
    """No answer to a read."""


class _One:
    """The checks of one servo that is there."""

    def __init__(self, rig: Rig, servo: RigServo, link: Link) -> None:
        self._rig, self._servo, self._link = rig, servo, link
        self._table: ControlTable = control_table(servo.sheet.number)

    def findings(self) -> Iterator[Finding]:
        yield from self._firmware()
        yield from self._settings()
        yield from self._position()
        yield from self._state()

    def _read(self, name: str) -> int:
        value = self._link.read(self._servo.id, self._table[name])
        if value is None:
            raise _SilentError(name)
        return value

    def _finding(self, what: str, todo: str, setting: tuple[str, int] | None = None) -> Finding:
        return Finding(self._servo.id, self._servo.joint, what, todo, setting)

    def _firmware(self) -> Iterator[Finding]:
        firmware, needed = self._read("Firmware Version"), self._servo.sheet.fast_read
        if self._rig.fast_read and firmware < needed:
            yield self._finding(
                f"firmware {firmware} knows no fast read",
                f"put `fast_read = false` in the rig file, or update it to {needed} or newer",
            )

    def _settings(self) -> Iterator[Finding]:
        for name, wanted in settings_of(self._servo).items():
            found = self._read(name)
            if (wrong := self._wrong(name, found, wanted)) is not None:
                yield self._finding(wrong, _SET_UP, (name, wanted))

    def _wrong(self, name: str, found: int, wanted: int) -> str | None:
        """What is wrong with a setting, or None. Some may be other than they would be set to."""
        match name:
            case "Shutdown":
                fine = not _SHUTDOWN & ~found
            case "Current Limit":
                fine = found >= self._servo.current_counts
            case "Min Position Limit" | "Max Position Limit":
                tight = found > wanted if name.startswith("Min") else found < wanted
                what = "and goals of the rig beyond it would be ignored"
                return f"its {name} is {found}, {what} ({wanted})" if tight else None
            case _:
                fine = found == wanted
        if fine:
            return None
        needed = self._servo.current_counts
        return _WHY[name].format(found=found, wanted=wanted, needed=needed)

    def _position(self) -> Iterator[Finding]:
        """Turns that are lost at power-off would show as a joint where it can't be."""
        pulses = self._read("Present Position")
        low, high = self._servo.pulse_limits
        if not 0 <= pulses < REVOLUTION:
            turns = (pulses - CENTRE) / REVOLUTION
            yield self._finding(
                f"it counts {turns:+.1f} turns from its middle",
                "turn power off and on with the joint inside its range",
            )
        elif not low - _STRAY <= pulses <= high + _STRAY:
            codec = Codec.of(self._rig)
            place = self._rig.servos.index(self._servo)
            degrees = codec.degrees(place, pulses)
            limits = "{:g} to {:g}".format(*self._servo.limits)
            yield self._finding(
                f"the joint stands at {degrees:.0f} degrees, outside {limits}",
                "move it inside by hand, or run `enpointe calibrate` if the figure is wrong",
            )

    def _state(self) -> Iterator[Finding]:
        if errors := self._read("Hardware Error Status"):
            names = ", ".join(
                bit.name.lower() for bit in HardwareError if errors & bit and bit.name
            )
            yield self._finding(
                f"it has an alarm ({names or errors})", "find out why, then turn power off and on"
            )
        heat, most = self._read("Present Temperature"), self._read("Temperature Limit")
        if heat > most - _MARGIN:
            yield self._finding(f"it is at {heat} C and shuts down at {most}", "let it cool")
        volts = self._read("Present Input Voltage")
        least, top = self._read("Min Voltage Limit"), self._read("Max Voltage Limit")
        if not least <= volts <= top:
            yield self._finding(
                f"it has {volts * TENTH_VOLT:.1f} V and works from {least * TENTH_VOLT:.1f} to"
                f" {top * TENTH_VOLT:.1f} V",
                "look at the supply",
            )
