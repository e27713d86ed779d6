"""The last thing that a goal passes before the bus: no limit, no speed and no nonsense gets by.

Whatever a controller asks, and however late, what leaves the gate satisfies for any two goals of a
servo, at times s < t and in pulses,

    low <= goal <= high        and        |goal(t) - goal(s)| <= speed (t - s) + 1,

the 1 being the resolution of the register.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from enpointe.errors import RigError

__all__ = ["CommandGate", "Passed"]

Array = NDArray[np.float64]
Counts = NDArray[np.int64]


@dataclass(frozen=True, slots=True)
class Passed:
    """What left the gate.

    Attributes:
        goal: (n,) pulses to send.
        limited: (n,) whether a limit of range changed what was asked.
        slowed: (n,) whether the limit of speed did.
        refused: Whether what was asked was no number, and the goals before it stay.
    """

    goal: Counts
    limited: NDArray[np.bool_]
    slowed: NDArray[np.bool_]
    refused: bool


class CommandGate:
    """Holds every goal within range and speed.

    Args:
        low: (n,) least goal, pulses.
        high: (n,) greatest.
        speed: (n,) pulses/s.
        period: s between two goals. A late goal may still go no further than one on time: the servo
            makes its way in one period, whatever the wait before it was.

    Raises:
        RigError: Limits that don't rise, or a speed that isn't positive.
    """

    def __init__(self, low: Counts, high: Counts, speed: Array, period: float) -> None:
        if not (np.all(low < high) and np.all(speed > 0.0) and period > 0.0):
            raise RigError("limits of goals must rise, speeds and the period be positive")
        self._low, self._high = low, high
        self._speed = speed
        self._period = period
        self._exact: Array | None = None
        self._goal = low
        self._time = 0.0

    @property
    def goal(self) -> Counts:
        """(n,) the last goals, pulses."""
        return self._goal.copy()

    def start(self, present: Counts, time: float) -> Counts:
        """Begin where the servos are; their positions, brought within limits, are the goals."""
        self._goal = np.clip(present, self._low, self._high)
        self._exact = self._goal.astype(float)
        self._time = time
        return self.goal

    def pass_on(self, wanted: Array, time: float) -> Passed:
        """What may be sent of what is wanted, at a time.

        Args:
            wanted: (n,) pulses, not rounded.
            time: s, of the sending; not before the last one.

        Raises:
            RigError: It was not started, or the number of goals is another.
        """
        if self._exact is None:
            raise RigError("the gate was not started: say where the servos are first")
        if wanted.shape != self._exact.shape:
            raise RigError(f"{len(self._exact)} goals are needed, and {wanted.shape} came")
        none = np.zeros(len(wanted), dtype=bool)
        if not np.all(np.isfinite(wanted)):
            self._time = time
            return Passed(self.goal, none, none, refused=True)
        inside = np.clip(wanted, self._low, self._high)
        step = self._speed * min(max(time - self._time, 0.0), self._period)
        slow = np.clip(inside, self._exact - step, self._exact + step)
        self._exact, self._time = slow, time
        self._goal = self._rounded(slow)
        return Passed(self.goal, inside != wanted, np.abs(slow - inside) > 0.5, refused=False)

    def _rounded(self, exact: Array) -> Counts:
        """Whole pulses, within half of one; limits are whole, so that rounding keeps them."""
        return np.asarray(np.rint(exact), dtype=np.int64)
