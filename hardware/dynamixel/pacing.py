"""Absolute deadlines: each on a grid from the start, so that lateness never adds up.

After an overrun the missed points of the grid are skipped and not made up for in a burst: servos
that have missed a goal are told the next one, not two at once.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from enpointe.hardware.clock import Clock

__all__ = ["Lateness", "Pacer"]

_ROUNDING = 1e-9


@dataclass(frozen=True, slots=True)
class Lateness:
    """How punctual a loop was.

    Attributes:
        cycles: Deadlines kept, in time or late.
        misses: Deadlines at which the cycle before was not done; those given up are among them.
        achieved: Hz; cycles over the time from the first deadline to the last.
        median: s after the deadline.
        p99: s; one in a hundred was later.
        worst: s.
    """

    cycles: int
    misses: int
    achieved: float
    median: float
    p99: float
    worst: float


class Pacer:
    """Wakes a loop at start, start + period, start + 2 periods …

    Args:
        clock: Whose time it is.
        period: s.
    """

    def __init__(self, clock: Clock, period: float) -> None:
        self.clock = clock
        self.period = period
        self.misses = 0
        self._late: list[float] = []
        self._start = clock.now()
        self._next = 0
        self._first = self._last = 0.0

    def start(self) -> None:
        """The grid begins now, and the statistics with it."""
        self._start = self.clock.now()
        self._next = 0
        self.misses = 0
        self._late = []

    @property
    def left(self) -> float:
        """s to the next deadline; negative after it."""
        return self._start + self._next * self.period - self.clock.now()

    def wait(self) -> float:
        """Sleep to the next deadline.

        Returns:
            s by which it is past.
        """
        behind = (self.clock.now() - self._start) / self.period - self._next
        if behind > _ROUNDING:
            # Less than a period late is late; a whole period is given up.
            skipped = math.floor(behind + _ROUNDING)
            self._next += skipped + (skipped > 0)
            self.misses += 1 + skipped
        deadline = self._start + self._next * self.period
        self.clock.sleep_until(deadline)
        late = max(self.clock.now() - deadline, 0.0)
        if not self._late:
            self._first = deadline
        self._last = deadline
        self._late.append(late)
        self._next += 1
        return late

    def lateness(self) -> Lateness:
        """Figures since the start."""
        late = np.array(self._late) if self._late else np.zeros(1)
        span = self._last - self._first
        cycles = len(self._late)
        return Lateness(
            cycles,
            self.misses,
            (cycles - 1) / span if span > 0.0 else 0.0,
            float(np.median(late)),
            float(np.percentile(late, 99)),
            float(late.max()),
        )
