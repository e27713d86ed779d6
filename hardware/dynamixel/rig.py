"""A rig of servos as a body: the one place where goals go out and samples come in.

    with ServoRig(rig, link, layout, clock) as body:      # checks who is there
        body.start(first_pose)                            # torque on, a slow way to the first pose
        recording = perform(motion, controller, body)     # the dance
        body.finish()                                     # back to where it was found, torque off

Whatever goes wrong inside the `with`, the servos have let go, or stopped by their own watchdogs,
when it is left.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from enum import StrEnum
from types import TracebackType

import numpy as np
from numpy.typing import NDArray

from enpointe.controllers.protocol import Command, State
from enpointe.errors import RigError
from enpointe.hardware.clock import Clock
from enpointe.hardware.control_table import control_table
from enpointe.hardware.dynamixel.arming import cut_torque, hold, prepare, watch_bus
from enpointe.hardware.dynamixel.checks import check_rig
from enpointe.hardware.dynamixel.codec import Codec
from enpointe.hardware.dynamixel.frames import Frame, FrameReader
from enpointe.hardware.dynamixel.gate import CommandGate, Passed
from enpointe.hardware.dynamixel.health import Health
from enpointe.hardware.dynamixel.layout import Layout
from enpointe.hardware.dynamixel.link import Link, PortLostError
from enpointe.hardware.dynamixel.pacing import Lateness, Pacer
from enpointe.hardware.dynamixel.registers import common
from enpointe.hardware.dynamixel.stopping import StopButton
from enpointe.hardware.dynamixel.supervisor import SafetyLimits, Severity, Supervisor, Verdict
from enpointe.hardware.rig_file import Rig
from enpointe.hardware.units import PULSE

__all__ = ["Ending", "ServoRig", "Statistics"]

Array = NDArray[np.float64]
_CUT = 1.0
"""s for which letting go is tried."""
_PARKING = 20.0
"""s after which parking is given up for letting go."""


class Ending(StrEnum):
    """How the servos were left."""

    RUNNING = "running"
    OFF = "torque off"
    PARKED = "parked, torque off"
    UNCONFIRMED = "told to let go, not confirmed by all"


@dataclass(frozen=True, slots=True)
class Statistics:
    """How a rig did.

    Attributes:
        lateness: Of the loop, from the start of the dance.
        frame_loss: Share of frames of which an answer was missing.
        lost_answers: Packets waited for in vain, or damaged.
        ending: How the servos were left.
        unconfirmed: IDs of those that have not said that they have let go.
        faults: What was wrong, in the order of its coming.
    """

    lateness: Lateness
    frame_loss: float
    lost_answers: int
    ending: Ending
    unconfirmed: tuple[int, ...]
    faults: tuple[str, ...]


class ServoRig:
    """A `Body` of Dynamixel servos.

    Args:
        rig: What it is.
        link: Its bus.
        layout: Where its joints stand in the movement's arrays.
        clock: Whose time it runs on.
        limits: When enough is enough.
        stop: Pressed by whoever wants it to end.

    Attributes:
        period: s between two goals.
        fault: Why it can't go on, or None.

    Raises:
        RigError: The servos are not those of the rig; each finding is named.
    """

    def __init__(
        self,
        rig: Rig,
        link: Link,
        layout: Layout,
        clock: Clock,
        *,
        limits: SafetyLimits | None = None,
        stop: StopButton | None = None,
    ) -> None:
        self.rig, self.period = rig, rig.period
        self.fault: str | None = None
        self.clock = clock
        self.stop = stop if stop is not None else StopButton()
        self._link, self._layout = link, layout
        self._limits = limits if limits is not None else SafetyLimits()
        self._registers = common(servo.sheet.number for servo in rig.servos)
        self._refuse_findings()
        self._codec = Codec.of(rig)
        speed = np.array([servo.top_speed / PULSE for servo in rig.servos])
        self._gate = CommandGate(self._codec.low, self._codec.high, speed, self.period)
        self._reader = FrameReader(link, rig.ids, clock, fast=rig.fast_read)
        self._health = Health(link, rig.ids, self._registers, self._temperature_limits())
        names = [f"{servo.id} ({servo.joint})" for servo in rig.servos]
        self._supervisor = Supervisor(names, self._limits)
        self._pacer = Pacer(clock, self.period)
        self._frame = self._reader.read()
        self._passed = Passed(*_nothing(len(names)), refused=False)
        self._late = self._busy = self._origin = 0.0
        self._sent_at = -math.inf
        self._home: Array | None = None
        self._armed = False
        self._faults: list[str] = []
        self._lateness: Lateness | None = None
        self._loss = 0.0
        self.ending = Ending.RUNNING
        self.unconfirmed: tuple[int, ...] = ()

    # The body

    def read(self) -> State:
        """The newest sample; it was taken in the last `write`."""
        frame, layout, codec = self._frame, self._layout, self._codec
        qpos, qvel = layout.rest.copy(), np.zeros(layout.nv)
        effort, age = np.zeros(layout.nu), np.zeros(layout.nu)
        valid = np.zeros(layout.nu, dtype=bool)
        qpos[layout.qpos] = codec.angle(frame.position)
        qvel[layout.dof] = codec.velocity(frame.velocity)
        effort[layout.actuator] = codec.effort(frame.current)
        age[layout.actuator] = frame.age
        valid[layout.actuator] = frame.fresh
        return State(self.clock.now() - self._origin, qpos, qvel, effort, age, valid)

    def write(self, command: Command) -> None:
        """Send goals at the next deadline, and hear how the servos are."""
        if self.fault is None:
            self._cycle(command.position[self._layout.actuator])

    def observe(self) -> dict[str, NDArray[np.generic]]:
        """What was sent, how late, and how the servos feel."""
        health = self._health
        return {
            "goal": self._spread(self._codec.angle(self._passed.goal)),
            "limited": self._spread(self._passed.limited),
            "slowed": self._spread(self._passed.slowed),
            "current": self._spread(self._codec.current(self._frame.current)),
            "alarm": self._spread(health.status),
            "temperature": self._spread(health.temperature),
            "voltage": self._spread(health.voltage),
            "lateness": np.array(self._late),
            "busy": np.array(self._busy),
            "whole": np.array(self._frame.whole),
        }

    # Before and after

    def start(self, pose: Array) -> None:
        """Torque on where the servos stand, then a slow way to the first pose.

        Args:
            pose: (nu,) joint targets, rad.

        Raises:
            RigError: A servo did not take its settings, or something went wrong on the way.
        """
        prepare(self._link, self.rig, self._registers, self.period)
        frame = self._heard()
        goals = self._gate.start(frame.position, self.clock.now())
        self._passed = Passed(goals, *_nothing(len(goals))[1:], refused=False)
        self._armed = True
        hold(self._link, self._registers, list(zip(self.rig.ids, map(int, goals), strict=True)))
        self._home = self._codec.angle(goals)
        watch_bus(self._link, self._registers, self.rig.ids, self._limits.watchdog)
        self._pacer.start()
        self._sent_at = self.clock.now()
        if not self._go(pose[self._layout.actuator], Severity.FINE):
            why = self.fault or self.stop.why
            self.finish()
            raise RigError(f"on the way to the first pose: {why}")
        self._pacer.start()
        self._reader.frames = self._reader.lost = 0
        self._origin = self.clock.now()

    def finish(self) -> None:
        """Back to where the rig was found unless it has let go already; then torque off."""
        if self.ending is not Ending.RUNNING:
            return
        self._close_statistics()
        parked = self._home is not None and self._go(self._home, Severity.PARK)
        self._let_go()
        if parked and not self.unconfirmed:
            self.ending = Ending.PARKED

    def __enter__(self) -> ServoRig:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self._close_statistics()
        self._let_go()
        self._link.close()

    @property
    def statistics(self) -> Statistics:
        """How it did, up to now or to the end of the dance."""
        return Statistics(
            self._lateness or self._pacer.lateness(),
            self._loss if self._lateness else self._reader.loss,
            self._link.counts.failed,
            self.ending,
            self.unconfirmed,
            tuple(self._faults),
        )

    # One cycle

    def _cycle(self, wanted: Array, accept: Severity = Severity.FINE) -> Verdict:
        """Wait, send, hear, judge, and react.

        Args:
            wanted: (n,) rad.
            accept: What is no news: verdicts up to it don't stop anything.
        """
        try:
            verdict = self._exchange(wanted)
        except PortLostError as error:
            verdict = Verdict(Severity.OFF, str(error))
        verdict = max(verdict, self._wish(), key=lambda each: each.severity)
        if verdict.severity > accept:
            self._react(verdict)
        return verdict

    def _exchange(self, wanted: Array) -> Verdict:
        self._late = self._pacer.wait()
        now = self.clock.now()
        stood = now - self._sent_at
        before = self._passed.goal
        self._passed = self._gate.pass_on(self._codec.pulses(wanted), now)
        goals = [int(goal) for goal in self._passed.goal]
        self._link.sync_write(
            self._registers["Goal Position"], list(zip(self.rig.ids, goals, strict=True))
        )
        self._sent_at = now
        self._frame = self._reader.read()
        self._health.step(self._frame)
        self._busy = self.clock.now() - now
        # The answer is to the goal before: this one has not had its period yet.
        error = self._codec.angle(before) - self._codec.angle(self._frame.position)
        verdict = self._supervisor.look(self._frame, self._health, error, self.clock.now())
        if stood >= self._limits.watchdog:
            why = (
                f"the loop stood still for {stood:.2f} s and the servos have stopped by themselves"
            )
            verdict = Verdict(Severity.OFF, f"{why}; leave the computer more time")
        if self._passed.refused and verdict.severity is Severity.FINE:
            verdict = Verdict(Severity.PARK, "the controller asked for what is no number")
        return verdict

    def _wish(self) -> Verdict:
        if self.stop.presses > 1:
            return Verdict(Severity.OFF, "let go by hand")
        if self.stop.presses:
            return Verdict(Severity.PARK, self.stop.why)
        return Verdict()

    def _react(self, verdict: Verdict) -> None:
        self._faults.append(verdict.reason)
        if self.fault is None:
            self.fault = verdict.reason
        if verdict.severity is Severity.OFF:
            self._close_statistics()
            self._let_go()

    def _go(self, target: Array, accept: Severity) -> bool:
        """A smooth, slow way to a pose; whether it was reached."""
        begin = self._codec.angle(self._gate.goal)
        longest = float(np.abs(target - begin).max())
        slowest = min(
            self._limits.ramp_speed, float(min(servo.top_speed for servo in self.rig.servos))
        )
        duration = max(self._limits.ramp, longest * math.pi / 2.0 / slowest)
        start = self.clock.now()
        while self.ending is Ending.RUNNING:
            done = min((self.clock.now() - start) / duration, 1.0)
            share = (1.0 - math.cos(math.pi * done)) / 2.0
            verdict = self._cycle(begin + share * (target - begin), accept)
            if verdict.severity > accept:
                return False
            if done >= 1.0:
                return True
            if self.clock.now() - start > duration + _PARKING:
                return False
        return False

    # Parts

    def _refuse_findings(self) -> None:
        findings = check_rig(self.rig, self._link)
        if findings:
            rest = f" (and {len(findings) - 1} more)" if len(findings) > 1 else ""
            raise RigError(f"{findings[0]}{rest}")

    def _temperature_limits(self) -> Array:
        limits = []
        for servo in self.rig.servos:
            register = control_table(servo.sheet.number)["Temperature Limit"]
            value = self._link.read(servo.id, register)
            limits.append(servo.sheet.initial["Temperature Limit"] if value is None else value)
        return np.array(limits, dtype=float)

    def _heard(self) -> Frame:
        """A frame with everybody in it."""
        for _ in range(3):
            self._frame = self._reader.read()
            if self._frame.whole:
                return self._frame
        raise RigError("not all servos answer a sync read; look at cables and fast_read")

    def _let_go(self) -> None:
        """Torque off, confirmed; once is enough."""
        if self.ending is not Ending.RUNNING:
            return
        if not self._armed:
            self.ending = Ending.OFF
            return
        order = np.argsort(self._frame.age, kind="stable")
        ids: Sequence[int] = [self.rig.ids[place] for place in order]
        self.unconfirmed = cut_torque(self._link, self._registers, ids, self.clock, _CUT)
        self.ending = Ending.UNCONFIRMED if self.unconfirmed else Ending.OFF
        if self.unconfirmed:
            names = ", ".join(str(servo) for servo in self.unconfirmed)
            self._faults.append(
                f"servo {names} has not said that it let go; its watchdog stops it, cut the power"
            )

    def _close_statistics(self) -> None:
        if self._lateness is None:
            self._lateness, self._loss = self._pacer.lateness(), self._reader.loss

    def _spread(self, values: NDArray[np.generic]) -> NDArray[np.generic]:
        """Of the servos to the actuators' order; zeros where no servo is."""
        row = np.zeros(self._layout.nu, dtype=values.dtype)
        row[self._layout.actuator] = values
        return row


def _nothing(count: int) -> tuple[NDArray[np.int64], NDArray[np.bool_], NDArray[np.bool_]]:
    return np.zeros(count, np.int64), np.zeros(count, bool), np.zeros(count, bool)
