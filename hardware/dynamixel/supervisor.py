"""What is wrong with the rig, and how far to go about it: a ladder of reactions.

    FINE    go on
    PARK    stop dancing, go slowly to where the rig was found, let go there
    OFF     let go at once

The gate (`gate.py`) has the rungs below: it clamps and slows what can be danced in spite of it.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from enum import IntEnum

import numpy as np
from numpy.typing import NDArray

from enpointe.hardware.dynamixel.frames import Frame
from enpointe.hardware.dynamixel.health import Health
from enpointe.hardware.hardware_error import HardwareError

__all__ = ["SafetyLimits", "Severity", "Supervisor", "Verdict"]

Array = NDArray[np.float64]


class Severity(IntEnum):
    """How far to go."""

    FINE = 0
    PARK = 1
    OFF = 2


@dataclass(frozen=True, slots=True)
class Verdict:
    """What to do, and why, in one line for people.

    Attributes:
        severity: How far to go.
        reason: Empty if all is well.
    """

    severity: Severity = Severity.FINE
    reason: str = ""


@dataclass(frozen=True, slots=True)
class SafetyLimits:
    """When enough is enough. All are ours; none of them is a datasheet's.

    Attributes:
        silence: s that a servo may be silent before all let go.
        loss: Share of answers lost, over `loss_window` frames, at which the rig parks.
        loss_window: Frames.
        error: rad that a joint may be away from its goal ...
        error_time: ... for so many s, before all let go: something or somebody is in the way.
        heat_margin: Degrees Celsius below a servo's own limit at which the rig parks.
        watchdog: s after which a servo that hears nothing stops by itself; in steps of 20 ms.
        ramp: s at least for the way to the first pose and the way back.
        ramp_speed: rad/s, the most on it.
    """

    silence: float = 0.1
    loss: float = 0.25
    loss_window: int = 100
    error: float = 0.6
    error_time: float = 0.25
    heat_margin: float = 5.0
    watchdog: float = 0.1
    ramp: float = 2.0
    ramp_speed: float = 0.5


_WORDS = {
    HardwareError.INPUT_VOLTAGE: "its supply is out of range",
    HardwareError.OVERHEATING: "it is too hot",
    HardwareError.ENCODER: "its encoder fails",
    HardwareError.ELECTRICAL_SHOCK: "its supply can't drive the motor",
    HardwareError.OVERLOAD: "it is overloaded",
}
_HARMLESS = HardwareError.INPUT_VOLTAGE
"""The servo goes on by itself: time to park."""


class Supervisor:
    """Looks at each frame.

    Args:
        names: Of each servo, for people: "7 (left_elbow_bend)".
        limits: When enough is enough.
    """

    def __init__(self, names: Sequence[str], limits: SafetyLimits) -> None:
        self._names = tuple(names)
        self._limits = limits
        self._losses: deque[float] = deque(maxlen=limits.loss_window)
        self._strained = np.full(len(names), np.inf)
        self._alarmed = np.full(len(names), np.inf)

    def look(self, frame: Frame, health: Health, error: Array, now: float) -> Verdict:
        """The gravest of all that is wrong.

        Args:
            frame: The newest.
            health: What is known of alarms, heat and supply.
            error: (n,) rad between where the goal was and where the joint is.
            now: s.
        """
        self._losses.append(1.0 - float(frame.fresh.mean()))
        found = [
            *self._alarms(frame, health, now),
            *self._silence(frame),
            *self._loose(health),
            *self._strain(frame, error, now),
            *self._loss(),
            *self._heat(health),
        ]
        return max(found, key=lambda verdict: verdict.severity, default=Verdict())

    def _alarms(self, frame: Frame, health: Health, now: float) -> Iterator[Verdict]:
        self._alarmed[~frame.alert] = np.inf
        self._alarmed[frame.alert] = np.minimum(self._alarmed[frame.alert], now)
        for place in np.flatnonzero(frame.alert | (health.status > 0)):
            errors = health.errors(int(place))
            if errors is None:
                if now - self._alarmed[place] > self._limits.silence:
                    why = "has an alarm and does not say which; look at it, and reboot it"
                    yield Verdict(Severity.OFF, f"servo {self._names[place]} {why}")
                continue
            words = ", ".join(text for bit, text in _WORDS.items() if errors & bit)
            grave = bool(errors & ~_HARMLESS)
            what = f"servo {self._names[place]} has an alarm: {words or f'error {int(errors)}'}"
            todo = (
                "let it cool, free what holds it, and reboot it" if grave else "charge or mend it"
            )
            yield Verdict(Severity.OFF if grave else Severity.PARK, f"{what}; {todo}")

    def _silence(self, frame: Frame) -> Iterator[Verdict]:
        silent = np.flatnonzero(frame.age > self._limits.silence)
        if len(silent):
            who = ", ".join(self._names[place] for place in silent[:4])
            more = f" and {len(silent) - 4} more" if len(silent) > 4 else ""
            yield Verdict(
                Severity.OFF,
                f"no answer for {self._limits.silence:g} s from servo {who}{more}; look at cables"
                " and power",
            )

    def _loose(self, health: Health) -> Iterator[Verdict]:
        for place in np.flatnonzero(health.loose):
            yield Verdict(
                Severity.OFF,
                f"servo {self._names[place]} was silent, and has let go; look at its cable",
            )

    def _strain(self, frame: Frame, error: Array, now: float) -> Iterator[Verdict]:
        far = np.abs(error) > self._limits.error
        known = frame.fresh
        self._strained[known & ~far] = np.inf
        self._strained[known & far] = np.minimum(self._strained[known & far], now)
        for place in np.flatnonzero(now - self._strained >= self._limits.error_time):
            yield Verdict(
                Severity.OFF,
                f"servo {self._names[place]} is {np.degrees(abs(error[place])):.0f} degrees from"
                " its goal; free what holds it, or dance slower",
            )

    def _loss(self) -> Iterator[Verdict]:
        losses = self._losses
        if (
            len(losses) == losses.maxlen
            and (share := sum(losses) / len(losses)) > self._limits.loss
        ):
            yield Verdict(
                Severity.PARK,
                f"{share:.0%} of the answers are lost; look at cables, or choose a lower baud rate",
            )

    def _heat(self, health: Health) -> Iterator[Verdict]:
        margin = health.temperature_limit - health.temperature
        for place in np.flatnonzero(margin < self._limits.heat_margin):
            yield Verdict(
                Severity.PARK,
                f"servo {self._names[place]} is at {health.temperature[place]:.0f} C; let it cool",
            )
