"""Time as a rig sees it: real, or, on an emulated bus, as fast as it can be computed."""

from __future__ import annotations

import time
from typing import Protocol, runtime_checkable

__all__ = ["Clock", "VirtualClock", "WallClock"]


@runtime_checkable
class Clock(Protocol):
    """Seconds that only go forward."""

    def now(self) -> float:
        """s since the clock's start."""

    def sleep_until(self, moment: float) -> None:
        """Return when that moment has come; at once if it is past."""


class VirtualClock:
    """A clock that stands still until somebody waits: two runs see the same times."""

    def __init__(self) -> None:
        self._now = 0.0

    def now(self) -> float:
        return self._now

    def sleep_until(self, moment: float) -> None:
        self._now = max(self._now, moment)


class WallClock:
    """Real time, from when it was made."""

    def __init__(self) -> None:
        self._start = time.monotonic()

    def now(self) -> float:
        return time.monotonic() - self._start

    def sleep_until(self, moment: float) -> None:
        if (left := moment - self.now()) > 0.0:
            time.sleep(left)
