"""The emulated bus: servos, wires and mechanics, gone through event by event.

No input, no output, no clock of its own: bytes and times come in, bytes and times go out.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

from enpointe.errors import RigError
from enpointe.hardware.emulator.answering import answers
from enpointe.hardware.emulator.fault_run import FaultRun
from enpointe.hardware.emulator.line import Line
from enpointe.hardware.emulator.plant import GearedPlant, Load, Loads, Plant
from enpointe.hardware.emulator.servo import Servo
from enpointe.hardware.packets import Packet, PacketReader

__all__ = ["PERIOD", "Bus", "Supply", "Written"]

PERIOD = 0.001
"""s of the servos' inner loop and of the mechanics."""
_GAP = 0.010
"""Ours: s of silence after which a servo drops a packet that was begun."""


@dataclass(frozen=True, slots=True)
class Supply:
    """What feeds the servos.

    Attributes:
        voltage: V without load.
        resistance: Ohm of supply and cables, shared by all.
    """

    voltage: float = 12.0
    resistance: float = 0.0


@dataclass(frozen=True, slots=True)
class Written:
    """A register that the host has set.

    Attributes:
        time: s.
        servo: Its ID.
        register: Its name.
        value: With its sign.
    """

    time: float
    servo: int
    register: str
    value: int


class Bus:
    """Servos on one pair of wires.

    Args:
        servos: In the plant's order.
        plant: What they turn; bare servos, each by itself, if None.
        baud: bit/s of the host at first.
        supply: What feeds them.
        faults: What goes wrong, if anything.
        strict: Take an unstuffed header within a packet for a header (see `PacketReader`).
        wire_time: Whether bytes and return delays take time.
        latency: s by which the host's adapter holds answers back.

    Raises:
        RigError: No servos, or the plant has another number of joints.
    """

    def __init__(
        self,
        servos: Sequence[Servo],
        plant: Plant | None = None,
        *,
        baud: int = 1_000_000,
        supply: Supply | None = None,
        faults: FaultRun | None = None,
        strict: bool = True,
        wire_time: bool = True,
        latency: float = 0.0,
    ) -> None:
        self.servos = tuple(servos)
        self.plant = plant if plant is not None else Loads([Load.of(s.model) for s in servos])
        if not servos or len(self.plant.position()) != len(servos):
            raise RigError(
                f"a bus of {len(servos)} servos turns a plant of {len(self.plant.position())}"
                " joints; give each servo a joint"
            )
        self._rotors = self.plant.velocity
        if isinstance(self.plant, GearedPlant):
            self._rotors = self.plant.rotor_velocity
        self.supply = supply if supply is not None else Supply()
        self.faults = faults
        self.line = Line(baud, instant=not wire_time, latency=latency)
        self._reader = PacketReader(strict=strict)
        self._heard_until = 0.0
        self._ticks = 0
        self._time = 0.0
        self._watchers: list[Callable[[Written], None]] = []
        for servo, angle in zip(self.servos, self.plant.position(), strict=True):
            servo.place(float(angle))
            servo.on_write = self._told

    @property
    def time(self) -> float:
        """s up to which everything has happened."""
        return self._time

    def watch(self, watcher: Callable[[Written], None]) -> None:
        """Be told of every register that the host sets, when it is set."""
        self._watchers.append(watcher)

    def send(self, data: bytes, at: float) -> None:
        """The host writes bytes at a time not before the bus's own."""
        self.run_until(at)
        self.line.send(data, at)

    def next_event(self) -> float | None:
        """When the host's next packet is whole, or a byte for it comes; None if neither."""
        moments = (self.line.next_sent(), self.line.next_answered())
        return min((moment for moment in moments if moment is not None), default=None)

    def run_until(self, time: float) -> None:
        """Let everything happen up to a time."""
        while True:
            tick = (self._ticks + 1) * PERIOD
            sent = self.line.next_sent()
            if sent is not None and sent <= min(tick, time):
                self._time = max(self._time, sent)
                self._hear(sent)
            elif tick <= time:
                self._time = max(self._time, tick)
                self._tick(tick)
            else:
                break
        self._time = max(self._time, time)

    def _told(self, time: float, servo: int, register: str, value: int) -> None:
        for watcher in self._watchers:
            watcher(Written(self._time, servo, register, value))

    def _tick(self, now: float) -> None:
        """All motors, then all joints, for one period."""
        self._ticks += 1
        drawn = sum(servo.motor.drawn for servo in self.servos)
        volts = self.supply.voltage - self.supply.resistance * drawn
        torques = []
        plant = self.plant
        places = zip(plant.position(), plant.velocity(), self._rotors(), strict=True)
        for joint, (servo, (angle, speed, rotor)) in enumerate(
            zip(self.servos, places, strict=True)
        ):
            supply = volts if self.faults is None else self._disturbed(joint, servo, now, volts)
            torques.append(servo.tick(now, PERIOD, supply, angle, speed, rotor))
        self.plant.advance(torques, PERIOD)

    def _disturbed(self, joint: int, servo: Servo, now: float, volts: float) -> float:
        """What the faults leave of a servo's supply, its joint jammed or heated on the way."""
        assert self.faults is not None
        number = servo.id
        if joint == 0:
            for fault in self.faults.heated(now):
                for each in self.servos:
                    if not fault.ids or each.id in fault.ids:
                        each.motor.temperature = fault.size
        self.plant.jam(joint, self.faults.jammed(number, now))
        if self.faults.missing(number, now):
            return 0.0
        return self.faults.supply(number, now, volts)

    def _hear(self, now: float) -> None:
        """A packet of the host is whole: do it and talk."""
        began, data = self.line.take_sent()
        if began - self._heard_until > _GAP:
            self._reader.forget()
        self._heard_until = now
        if self.faults is not None:
            data = self.faults.instruction(data, now)
        for packet in self._reader.feed(data):
            self._do(packet, now)

    def _do(self, packet: Packet, now: float) -> None:
        baud = self.line.baud
        listening = [servo for servo in self.servos if servo.hears(baud, now)]
        if self.faults is not None:
            listening = [each for each in listening if not self.faults.missing(each.id, now)]
        if packet.sound:
            for servo in listening:
                servo.heard(now)
        at = now
        for answer in answers(packet, listening):
            at += self.line.pause(answer.delay)
            at = self._talk(answer.servo, answer.data, at)

    def _talk(self, servo: int, data: bytes, at: float) -> float:
        if self.faults is None:
            return self.line.answer(data, at)
        heard, late = self.faults.answer(servo, data, at)
        if heard is None:
            return at + late + len(data) * self.line.byte_time
        return self.line.answer(heard, at + late)
