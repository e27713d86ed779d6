"""Where on the floor the measured feet put the reference: moved, and turned about the vertical."""

from __future__ import annotations

import cmath
import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

__all__ = ["Placement", "StandingPlace"]

Array = NDArray[np.float64]
_MOVING, _TURNING = 0.05, 0.2
"""s: time constants. A turn goes through the whole body, a shift only through where it stands."""
_BASE = 1e-4
"""m^2: soles that lie together within this mean square say nothing of a turn."""


class Placement(NamedTuple):
    """x -> R(yaw) x + offset, over the floor.

    Attributes:
        yaw: rad.
        offset: Ahead and to the left, m.
    """

    yaw: float
    offset: tuple[float, float]

    def rotation(self) -> Array:
        """R(yaw), (3, 3)."""
        cosine, sine = math.cos(self.yaw), math.sin(self.yaw)
        return np.array([[cosine, -sine, 0.0], [sine, cosine, 0.0], [0.0, 0.0, 1.0]])


class StandingPlace:
    """The placement that lays the reference's soles over the measured ones, smoothed.

    A foot that slid, that pivoted on its ball, or that came down elsewhere carries the weight
    where it stands: on one foot a turn unseen puts the heel, when it comes down, centimetres from
    where the weight is led. The turn is the least-squares one about the centroid of the soles that
    bear (Kabsch 1976, in the plane).

    Attributes:
        value: The placement now.
    """

    def __init__(self) -> None:
        self.value = Placement(0.0, (0.0, 0.0))

    def reset(self, points: Array, wanted: Array, active: NDArray[np.int64]) -> None:
        """Take the placement as it is now."""
        self.value = Placement(0.0, (0.0, 0.0))
        if len(active):
            self.value = self._towards(points, wanted, active, 1.0, 1.0)

    def follow(
        self, points: Array, wanted: Array, active: NDArray[np.int64], period: float
    ) -> Placement:
        """The placement after `period` seconds with the soles at `points` (S, 3)."""
        if len(active):
            moving, turning = (1.0 - math.exp(-period / tau) for tau in (_MOVING, _TURNING))
            self.value = self._towards(points, wanted, active, moving, turning)
        return self.value

    def _towards(
        self,
        points: Array,
        wanted: Array,
        active: NDArray[np.int64],
        moving: float,
        turning: float,
    ) -> Placement:
        there, asked = _over_the_floor(points, active), _over_the_floor(wanted, active)
        centre, middle = sum(there) / len(there), sum(asked) / len(asked)
        yaw, offset = self.value.yaw, complex(*self.value.offset)
        now = cmath.rect(1.0, yaw) * middle + offset
        spread = [a - middle for a in asked]
        if sum(abs(s) ** 2 for s in spread) >= _BASE * len(spread):
            turn = sum(t * s.conjugate() for t, s in zip(there, spread, strict=True))
            yaw += turning * _angle(cmath.phase(turn) - yaw)
        offset = now + moving * (centre - now) - cmath.rect(1.0, yaw) * middle
        return Placement(yaw, (offset.real, offset.imag))


def _over_the_floor(points: Array, rows: NDArray[np.int64]) -> list[complex]:
    """x + iy of some of the points (S, 3): of a dozen numbers quicker than arrays."""
    return [complex(x, y) for x, y, _ in points.take(rows, axis=0).tolist()]


def _angle(turn: float) -> float:
    """The same turn within half a revolution."""
    return math.remainder(turn, 2 * math.pi)
