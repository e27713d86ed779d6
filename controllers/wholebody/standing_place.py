"""Where on the floor the measured feet put the reference: moved, and turned about the vertical."""

from __future__ import annotations

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
        offset: (2,), m.
    """

    yaw: float
    offset: Array

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
        self.value = Placement(0.0, np.zeros(2))

    def reset(self, points: Array, wanted: Array, active: NDArray[np.int64]) -> None:
        """Take the placement as it is now."""
        self.value = Placement(0.0, np.zeros(2))
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
        there, asked = points[active, :2], wanted[active, :2]
        centre, middle = (np.add.reduce(each) / len(active) for each in (there, asked))
        now = self.value.rotation()[:2, :2] @ middle + self.value.offset
        yaw = self.value.yaw
        yaw += turning * _angle(_turn(there - centre, asked - middle, yaw) - yaw)
        place = now + moving * (centre - now)
        turned = Placement(yaw, self.value.offset).rotation()[:2, :2] @ middle
        return Placement(yaw, place - turned)


def _turn(there: Array, asked: Array, otherwise: float) -> float:
    """The turn from `asked` to `there`, (A, 2) about their centroids, rad."""
    if np.vdot(asked, asked) < _BASE * len(asked):
        return otherwise
    cross = asked[:, 0] @ there[:, 1] - asked[:, 1] @ there[:, 0]
    return math.atan2(cross, np.vdot(asked, there))


def _angle(turn: float) -> float:
    """The same turn within half a revolution."""
    return math.remainder(turn, 2 * math.pi)
