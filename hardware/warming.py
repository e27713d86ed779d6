"""How warm servos get over a dance that is repeated, and whether too much load shuts them down."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from enpointe.hardware.datasheet import ServoModel
from enpointe.hardware.emulator.protection import OVERLOAD_SECONDS, OVERLOAD_SHARE
from enpointe.hardware.heat import ROOM, HeatLump

__all__ = ["Warmth", "longest_overload", "warmth"]

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Warmth:
    """Temperatures of J servos over repeats of a dance, one right after the other.

    Attributes:
        rise: (T, J), K above room in a dance that began at room temperature.
        kept: (T, J), share of the warmth at the start that is left.
        limit: (J,), K above room at which the servo shuts down.
        room: Degrees Celsius.
    """

    rise: Array
    kept: Array
    limit: Array
    room: float = ROOM

    def after(self, repeats: float) -> Array:
        """(J,), the most in the last of so many dances, degrees Celsius; `inf` for ever."""
        kept = self.kept[-1]
        before = self.rise[-1] * (1.0 - kept ** (repeats - 1)) / (1.0 - kept)
        return np.asarray(self.room + (self.rise + before * self.kept).max(axis=0))

    def used(self, repeats: float) -> Array:
        """(J,), share of the rise that is allowed."""
        return np.asarray((self.after(repeats) - self.room) / self.limit)

    def repeats(self) -> tuple[int | None, ...]:
        """How many dances in a row each servo stands; None for any number."""
        for_ever = self.used(np.inf)
        return tuple(
            None if for_ever[joint] <= 1.0 else self._repeats(joint)
            for joint in range(len(self.limit))
        )

    def _repeats(self, joint: int) -> int:
        good, bad = 0, 1
        while self.used(bad)[joint] <= 1.0:
            good, bad = bad, 2 * bad
        while bad - good > 1:
            middle = (good + bad) // 2
            good, bad = (middle, bad) if self.used(middle)[joint] <= 1.0 else (good, middle)
        return good


def warmth(time: Array, current: Array, models: Sequence[ServoModel]) -> Warmth:
    """Go through one dance with the lump that the emulated motors have (`HeatLump`).

    Args:
        time: (T,), s.
        current: (T, J), A.
        models: J datasheets.
    """
    lumps = [HeatLump.of(model) for model in models]
    loss, capacity = (np.array([getattr(x, n) for x in lumps]) for n in ("loss", "capacity"))
    power = np.array([model.resistance for model in models]) * current**2
    steady = 0.5 * (power[1:] + power[:-1]) / loss
    fading = np.exp(-np.diff(time)[:, None] * loss / capacity)
    rise = np.zeros_like(current)
    for i, kept in enumerate(fading):
        rise[i + 1] = rise[i] * kept + steady[i] * (1.0 - kept)
    kept = np.exp(-(time - time[0])[:, None] * loss / capacity)
    hottest = np.array([model.initial["Temperature Limit"] - ROOM for model in models])
    return Warmth(rise, kept, hottest)


def longest_overload(time: Array, current: Array, models: Sequence[ServoModel]) -> Array:
    """(J,), the longest that each servo is overloaded without a pause, as a share of what trips it.

    An overload is more than `OVERLOAD_SHARE` of the stall current for `OVERLOAD_SECONDS`, as the
    emulated servos have it.
    """
    stall = np.array([model.stall_current for model in models])
    over = np.abs(current) >= OVERLOAD_SHARE * stall
    longest = running = np.zeros(len(models))
    for step, loaded in zip(np.diff(time), over[1:] & over[:-1], strict=True):
        running = np.where(loaded, running + step, 0.0)
        longest = np.maximum(longest, running)
    return np.asarray(longest / OVERLOAD_SECONDS)
