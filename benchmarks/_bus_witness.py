"""Looks at an emulated bus while faults happen, and knows nothing of the driver's judgement."""

from __future__ import annotations

import math
from dataclasses import dataclass, field

from enpointe.hardware.dynamixel import SafetyLimits
from enpointe.hardware.emulator import Bus, FaultKind, FaultRun, Written
from enpointe.hardware.rig_file import Rig
from enpointe.hardware.units import PULSE

GRACE = 0.2
"""s from an unrecoverable fault to rest."""
LIMITS = SafetyLimits(ramp=0.15, ramp_speed=3.0)
"""As usual, but quick on the way in and out, which is not what is looked at."""
_TRIPPED = -1


@dataclass
class Witness:
    """Looks at the bus, and at the servos behind it.

    Attributes:
        violations: What was written that must not be.
        lost_at: When, if ever, the fault could no longer be danced away.
    """

    rig: Rig
    bus: Bus
    faults: FaultRun
    violations: list[str] = field(default_factory=list)
    lost_at: float = math.inf
    at_grace: list[str] | None = None
    _ahead: dict[int, tuple[float, float]] = field(default_factory=dict)
    _far: dict[int, float] = field(default_factory=dict)

    def __post_init__(self) -> None:
        self._servos = {servo.id: servo for servo in self.rig.servos}
        self.bus.watch(self.see)

    def see(self, written: Written) -> None:
        servo = self._servos[written.servo]
        if written.register == "Goal Position":
            low, high = servo.pulse_limits
            if not low <= written.value <= high:
                self.violations.append(f"{written} outside {low} to {high}")
            self._speed(written, servo.top_speed / PULSE)
        elif written.register == "Goal Current" and servo.current:
            if abs(written.value) > servo.current_counts:
                self.violations.append(f"{written} above {servo.current_counts}")
        elif written.register == "Torque Enable" and written.value:
            # A new start, where the joint is by then.
            self._ahead.pop(written.servo, None)

    def _speed(self, written: Written, speed: float) -> None:
        """For all goals before: |goal - earlier| <= speed (t - earlier) + 1."""
        low, high = self._ahead.get(written.servo, (math.inf, -math.inf))
        way = speed * written.time
        if written.value - way > low + 1.0 + 1e-6 or written.value + way < high - 1.0 - 1e-6:
            self.violations.append(f"{written} faster than {speed:.0f} pulses/s")
        self._ahead[written.servo] = (
            min(low, written.value - way),
            max(high, written.value + way),
        )

    def look(self, now: float) -> None:
        """Once a cycle and after: has it happened, and is all at rest in time?"""
        if self.lost_at == math.inf and any(
            self._shut_or_held(place, now) for place in range(len(self.bus.servos))
        ):
            self.lost_at = now
        self.lost_at = min(self.lost_at, self._scripted(now))
        if self.at_grace is None and now >= self.lost_at + GRACE:
            self.at_grace = self.driven(now)

    def _scripted(self, now: float) -> float:
        """When somebody fell silent for longer than the rig bears."""
        for moment in self.faults.moments:
            fault = moment.fault
            silent = fault.kind is FaultKind.UNPLUG
            silent |= fault.kind is FaultKind.MISSING
            whole = fault.probability >= 1.0 and moment.end - moment.begin > LIMITS.silence
            silent |= whole and fault.kind in (FaultKind.DROP, FaultKind.CORRUPT)
            if silent and moment.begin <= now:
                return moment.begin
        return math.inf

    def _shut_or_held(self, place: int, now: float) -> bool:
        servo, described = self.bus.servos[place], self.rig.servos[place]
        if servo.protection.shut:
            return True
        memory = servo.memory
        away = abs(memory["Goal Position"] - servo.position) * PULSE > LIMITS.error
        if not (away and servo.torque_on):
            self._far.pop(described.id, None)
            return False
        # The driver looks once a period, and at the goal before.
        seen = LIMITS.error_time + 2.0 * self.rig.period
        return now - self._far.setdefault(described.id, now) >= seen

    def driven(self, now: float) -> list[str]:
        """Servos that still follow goals."""
        found = []
        for servo in self.bus.servos:
            powered = servo.powered and not self.faults.missing(servo.id, now)
            stopped = servo.memory["Bus Watchdog"] == _TRIPPED
            if servo.torque_on and powered and not stopped:
                found.append(f"servo {servo.id}")
        return found
