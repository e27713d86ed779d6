"""Whether a flight is one that gravity allows: its parabola, and the spin that nothing can change.

In the air a body's centre of mass falls freely and its angular momentum about it is constant,
whatever the limbs do (Newton's and Euler's laws with no force but gravity). A movement that was
drawn, or a capture that was cleaned, need not know it.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from enpointe.sim.measures import Flight

__all__ = ["Ballistics", "ballistics"]

Array = NDArray[np.float64]
FEWEST = 4
"""Samples in the air below which a parabola says nothing."""


@dataclass(frozen=True, slots=True)
class Ballistics:
    """One flight beside the one that gravity gives between the same two ends.

    Attributes:
        start: s, of the flight.
        end: s.
        rise: How high the centre of mass rises above where it left, m.
        rise_free: What it would rise in free fall, in that time and between those heights, m.
        fall: Acceleration of the parabola that fits best, m/s^2, downwards positive.
        off_path: Farthest of the centre of mass from the free path between its ends, m.
        momentum: Mean angular momentum about the centre of mass, (3,), kg m^2/s.
        momentum_change: Farthest from that mean, kg m^2/s.
    """

    start: float
    end: float
    rise: float
    rise_free: float
    fall: float
    off_path: float
    momentum: Array
    momentum_change: float

    @property
    def rise_ratio(self) -> float | None:
        """Rise over that of free fall; None where that is under a centimetre."""
        return self.rise / self.rise_free if self.rise_free > 0.01 else None


def ballistics(
    flight: Flight, time: Array, com: Array, momentum: Array, gravity: float
) -> Ballistics | None:
    """Hold one flight against free fall.

    With T the flight's time and z its heights, free fall between the ends leaves at
    v = (z(T) - z(0)) / T + g T / 2 and rises by v^2 / 2g.

    Args:
        flight: Its start and end.
        time: (N,), s.
        com: (N, 3), m.
        momentum: (N, 3), about the centre of mass, kg m^2/s.
        gravity: m/s^2, positive.

    Returns:
        None for a flight of fewer than four samples.
    """
    inside = (time >= flight.start) & (time <= flight.end)
    if np.count_nonzero(inside) < FEWEST:
        return None
    t, path, spin = time[inside] - flight.start, com[inside], momentum[inside]
    whole = float(t[-1])
    level = (path[-1] - path[0]) / whole
    free = path[0] + t[:, None] * level
    free[:, 2] += 0.5 * gravity * t * (whole - t)
    leaving = max(level[2] + 0.5 * gravity * whole, 0.0)
    mean = spin.mean(axis=0)
    return Ballistics(
        start=flight.start,
        end=flight.end,
        rise=float(path[:, 2].max() - path[0, 2]),
        rise_free=float(leaving**2 / (2.0 * gravity)),
        fall=float(-2.0 * np.polyfit(t, path[:, 2], 2)[0]),
        off_path=float(np.linalg.norm(path - free, axis=1).max()),
        momentum=mean,
        momentum_change=float(np.linalg.norm(spin - mean, axis=1).max()),
    )
