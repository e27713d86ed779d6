"""One emulated servo: its memory, its motor, and what writing to a register sets off."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping

from enpointe.errors import RigError
from enpointe.hardware.control_table import Register, control_table
from enpointe.hardware.datasheet import ServoModel
from enpointe.hardware.emulator.horn import Horn
from enpointe.hardware.emulator.memory import Memory, Write
from enpointe.hardware.emulator.motor import Motor
from enpointe.hardware.emulator.protection import Protection
from enpointe.hardware.emulator.ranges import GOALS, allowed
from enpointe.hardware.emulator.regulator import Mode, Regulator
from enpointe.hardware.emulator.reporting import moving, report
from enpointe.hardware.packets import StatusError
from enpointe.hardware.units import BAUD_RATES, PULSE, RETURN_DELAY, WATCHDOG

__all__ = ["BOOT_SECONDS", "FIRMWARE", "Servo"]

FIRMWARE = 52
"""Version that an emulated servo has unless told otherwise."""
BOOT_SECONDS = 0.1
"""Ours: how long a servo is deaf after a reboot, or after its power came."""

_TORQUE_ON_BY_GOAL = 0x08
_TORQUE_AT_START, _RAM_AT_START = 0x01, 0x02
_TRIPPED = -1
_BROWN_OUT = 0.5
"""Ours: share of the lowest voltage setting below which the processor stops."""
_KEPT_RAM = (
    "Velocity I Gain",
    "Velocity P Gain",
    "Position D Gain",
    "Position I Gain",
    "Position P Gain",
    "Feedforward 2nd Gain",
    "Feedforward 1st Gain",
    "Profile Acceleration",
    "Profile Velocity",
)


class Servo:
    """A servo on an emulated bus.

    Args:
        model: Its datasheet.
        number: Its ID.
        firmware: Its version.
        settings: Registers below 64 that are not as from the factory, by name.

    Raises:
        RigError: A setting's name is no register, or its value does not fit.
    """

    def __init__(
        self,
        model: ServoModel,
        number: int,
        *,
        firmware: int = FIRMWARE,
        settings: Mapping[str, int] | None = None,
    ) -> None:
        self.model = model
        self.firmware = firmware
        self.motor = Motor(model)
        self.memory = Memory(control_table(model.number, firmware))
        self.horn = Horn(self.memory)
        self.protection = Protection(self.memory, self.motor)
        self.regulator = Regulator(self.memory, self.motor)
        self.on_write: Callable[[float, int, str, int], None] | None = None
        self._backup: dict[str, int] = {}
        self._registered: tuple[Write, ...] | None = None
        self._now = self._heard = 0.0
        self._deaf_until = -math.inf
        self._supply = model.voltage
        self._starved = False
        self._factory({})
        self._preset({"ID": number, **(settings or {})})
        self._boot()

    @property
    def id(self) -> int:
        """Its ID now."""
        return self.memory["ID"]

    @property
    def torque_on(self) -> bool:
        """Whether its motor is driven."""
        return self.memory.values["Torque Enable"] == 1

    @property
    def powered(self) -> bool:
        """Whether its supply is enough for its processor."""
        return not self._starved

    @property
    def return_delay(self) -> float:
        """s before it answers."""
        return self.memory["Return Delay Time"] * RETURN_DELAY

    def hears(self, baud: int, time: float) -> bool:
        """Whether it is awake and listens at this baud rate, to protocol 2.0."""
        awake = not self._starved and time >= self._deaf_until
        ours = BAUD_RATES[self.memory["Baud Rate"]] == baud
        return awake and ours and self.memory["Protocol Type"] == 2

    def heard(self, time: float) -> None:
        """An instruction was on the bus: the watchdog starts again."""
        self._heard = time

    # Mechanics

    def place(self, angle: float) -> None:
        """Where the horn is when power comes, rad; counted within one turn from there."""
        self.horn.move(angle, 0.0)
        self._boot()

    def tick(
        self,
        time: float,
        period: float,
        supply: float,
        angle: float,
        speed: float,
        rotor: float | None = None,
    ) -> float:
        """One turn of the inner loop.

        Args:
            time: s.
            period: s since the last.
            supply: V at its terminals.
            angle: Of the horn, rad.
            speed: Of the horn, rad/s.
            rotor: Of the motor's side of the gears, rad/s; as the horn if None.

        Returns:
            Torque of the motor at the horn, N m.
        """
        self._now, self._supply = time, supply
        self.horn.move(angle, speed)
        if self._lost_power(supply):
            self.motor.rest(period)
            return 0.0
        if self.protection.watch(supply, period):
            self.memory["Torque Enable"] = 0
        self._watch_bus()
        if not self.torque_on:
            self.motor.rest(period)
            return 0.0
        horn = self.horn
        turning = speed if rotor is None else rotor
        duty = self.regulator.duty(
            horn.position, horn.rate, supply, period, rotor=horn.sense * turning / PULSE
        )
        self.motor.drive(horn.sense * duty, supply, turning, period)
        return self.motor.torque

    @property
    def position(self) -> int:
        """Present Position, pulses."""
        return self.horn.position

    def _lost_power(self, supply: float) -> bool:
        """Whether the processor is without power; when it comes back, it boots."""
        starved = supply < _BROWN_OUT * self.model.voltage_limits[0]
        if self._starved and not starved:
            self.reboot()
        self._starved = starved
        return starved

    def _watch_bus(self) -> None:
        limit = self.memory.values["Bus Watchdog"]
        if limit > 0 and self.torque_on and self._now - self._heard > limit * WATCHDOG:
            self.memory["Bus Watchdog"] = _TRIPPED
            self.regulator.stop(self.position)

    # Instructions

    def read(self, address: int, length: int) -> bytes | StatusError:
        """What a Read gets."""
        report(self.memory, self.motor, self.horn, self.regulator, self._now, self._supply)
        return self.memory.read(address, length)

    def write(self, address: int, data: bytes, *, ram_only: bool = False) -> StatusError:
        """What a Write does; all of it or nothing.

        Args:
            address: Of the first byte.
            data: The bytes.
            ram_only: As a packet for the secondary ID may.
        """
        found = self._checked(address, data)
        if isinstance(found, StatusError):
            return found
        if ram_only and any(write.register.eeprom for write in found):
            return StatusError.ACCESS
        self._apply(found)
        return StatusError.NONE

    def register(self, address: int, data: bytes) -> StatusError:
        """What a Reg Write does: keep a write for Action."""
        found = self._checked(address, data)
        if isinstance(found, StatusError):
            return found
        self._registered = found
        self.memory["Registered Instruction"] = 1
        return StatusError.NONE

    def act(self) -> StatusError:
        """What an Action does."""
        if self._registered is None:
            return StatusError.INSTRUCTION
        found, self._registered = self._registered, None
        self.memory["Registered Instruction"] = 0
        for write in found:
            if (error := self._check(write.register, write.value)) != StatusError.NONE:
                return error
        self._apply(found)
        return StatusError.NONE

    def reboot(self) -> None:
        """Start anew: RAM as at power-up, torque off, turns forgotten, shutdown ended."""
        self._boot()
        self._deaf_until = self._now + BOOT_SECONDS

    def factory_reset(self, *, keep_id: bool, keep_baud: bool) -> None:
        """All registers as from the factory, and a reboot."""
        kept = {"ID": self.id} if keep_id else {}
        if keep_baud:
            kept["Baud Rate"] = self.memory["Baud Rate"]
        self._factory(kept)
        self.reboot()

    def clear_turns(self) -> StatusError:
        """Count from within one turn again; refused in motion."""
        if moving(self.memory, self.horn):
            return StatusError.RESULT_FAIL
        self.horn.within_one_turn()
        self.regulator.start(self.position)
        self.memory["Goal Position"] = self.position
        return StatusError.NONE

    def back_up(self) -> StatusError:
        """Keep settings; refused while torque is on."""
        if self.torque_on:
            return StatusError.RESULT_FAIL
        table = self.memory.table
        names = [name for name, each in table.items() if each.eeprom and each.writable]
        names += [*_KEPT_RAM, *(address.name for address, _ in table.indirect)]
        self._backup = {name: self.memory[name] for name in names}
        self.memory["Backup Ready"] = 1
        return StatusError.NONE

    def restore(self) -> StatusError:
        """EEPROM as it was kept, and a reboot; refused while torque is on or nothing was kept."""
        if self.torque_on or not self._backup:
            return StatusError.RESULT_FAIL
        table = self.memory.table
        self.memory.restore((name for name in table if table[name].eeprom), self._backup)
        self.reboot()
        return StatusError.NONE

    # Registers

    def _checked(self, address: int, data: bytes) -> tuple[Write, ...] | StatusError:
        return self.memory.writes(address, data, self._check)

    def _check(self, register: Register, value: int) -> StatusError:
        if not register.writable or (register.eeprom and self.torque_on):
            return StatusError.ACCESS
        if register.name in GOALS and self.memory["Bus Watchdog"] == _TRIPPED:
            return StatusError.DATA_RANGE
        if register.name == "Torque Enable" and value == 1 and self.protection.shut:
            return StatusError.RESULT_FAIL
        return allowed(self.memory, self.model, register, value)

    def _apply(self, writes: tuple[Write, ...]) -> None:
        for write in writes:
            name, before = write.register.name, self.memory[write.register.name]
            by_goal = self.memory["Drive Mode"] & _TORQUE_ON_BY_GOAL
            if name in GOALS and by_goal and not self.torque_on and not self.protection.shut:
                self._torque_on()
            self.memory[name] = write.value
            self._set_off(name, before)
            if self.on_write is not None:
                self.on_write(self._now, self.id, name, write.value)

    def _set_off(self, name: str, before: int) -> None:
        """What follows from a register's new value."""
        if name in GOALS and self.torque_on:
            self.regulator.new_goal(name)
        elif name == "Torque Enable" and self.torque_on and not before:
            self._torque_on()
        elif name == "Operating Mode":
            self._new_mode()
        elif name in ("Drive Mode", "Homing Offset"):
            self.horn.settings_changed()
        elif name == "Bus Watchdog":
            self._heard = self._now

    def _torque_on(self) -> None:
        """Stay: goals left from before are forgotten."""
        mode = Mode(self.memory["Operating Mode"])
        if mode == Mode.POSITION:
            self.horn.within_one_turn()
        self._still(mode)
        self.memory["Torque Enable"] = 1
        self._heard = self._now
        self.regulator.start(self.position)

    def _new_mode(self) -> None:
        """Gains, profile and limits start again."""
        memory, initial = self.memory, self.model.initial
        for name in _KEPT_RAM:
            memory[name] = initial.get(name, 0)
        mode = Mode(memory["Operating Mode"])
        self.horn.settings_changed()
        if mode == Mode.POSITION:
            self.horn.within_one_turn()
        memory["Goal PWM"] = memory["PWM Limit"]
        if "Goal Current" in memory:
            memory["Goal Current"] = memory["Current Limit"]
        self._still(mode)

    def _still(self, mode: Mode) -> None:
        """The goal of a mode that keeps the horn where it is."""
        memory = self.memory
        memory["Goal Position"] = self.position
        memory["Goal Velocity"] = 0
        if mode == Mode.CURRENT:
            memory["Goal Current"] = 0
        elif mode == Mode.PWM:
            memory["Goal PWM"] = 0

    def _factory(self, settings: Mapping[str, int]) -> None:
        memory = self.memory
        initial = {**self.model.initial, "Firmware Version": self.firmware, **settings}
        for name, register in memory.table.items():
            if register.eeprom:
                memory[name] = initial.get(name, 0)

    def _preset(self, settings: Mapping[str, int]) -> None:
        for name, value in settings.items():
            register = self.memory.table[name]
            if not (register.eeprom and register.writable):
                raise RigError(f"{name} can't be set before power comes; it is no setting")
            if allowed(self.memory, self.model, register, value) != StatusError.NONE:
                raise RigError(f"a {self.model.name} can't have {value} as {name}")
            self.memory[name] = value

    def _boot(self) -> None:
        memory = self.memory
        for name, register in memory.table.items():
            if not register.eeprom and not name.startswith("Indirect"):
                memory[name] = self.model.initial.get(name, 0)
        for address, data in memory.table.indirect:
            memory[address.name], memory[data.name] = data.address, 0
        self._registered = None
        self.protection.reset()
        self.horn.settings_changed()
        self.horn.within_one_turn()
        self._new_mode()
        memory["Backup Ready"] = int(bool(self._backup))
        if memory["Startup Configuration"] & _RAM_AT_START:
            ram = [name for name in self._backup if not memory.table[name].eeprom]
            memory.restore(tuple(ram), self._backup)
        if memory["Startup Configuration"] & _TORQUE_AT_START:
            self._torque_on()
