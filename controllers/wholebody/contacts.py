"""Which soles may bear weight: those that are meant to and that are on the floor."""

from __future__ import annotations

import math
from bisect import bisect_right

import numpy as np
from numpy.typing import NDArray

from enpointe.controllers.wholebody.reference import Reference

__all__ = ["ContactSchedule", "FootShift"]

Array = NDArray[np.float64]
NEAR = 0.003
"""A sole closer to the floor than this, m, is on it: contact gives way by less than 1 mm."""
PLANTED_SPEED = 0.1
"""A sole that the reference moves faster than this, m/s, slides or swings and bears nothing."""


class ContactSchedule:
    """The soles that the reference puts on the floor, still, at each of its samples.

    Args:
        reference: What is to be danced.

    Attributes:
        planned: (T, S).
    """

    def __init__(self, reference: Reference) -> None:
        level = np.linalg.norm(np.asarray(reference.point_velocity)[:, :, :2], axis=2)
        self.planned = (reference.clearance < NEAR) & (level < PLANTED_SPEED)
        self._times = reference.time.tolist()

    def at(self, t: float) -> NDArray[np.bool_]:
        """Soles planned to bear at `t` seconds, (S,)."""
        return np.asarray(self.planned[max(bisect_right(self._times, t) - 1, 0)])

    def active(self, t: float, clearance: Array) -> NDArray[np.int64]:
        """Rows of the soles that are planned to bear at `t` and measured on the floor, (A,)."""
        return (self.at(t) & (clearance < NEAR)).nonzero()[0]


class FootShift:
    """How far the measured feet stand from the reference's, smoothed.

    The reference is laid over the feet as they stand, so that a foot that slid or came down
    elsewhere carries the weight where it is.

    Args:
        settling: Time constant, s.
    """

    def __init__(self, settling: float = 0.05) -> None:
        self._settling = settling
        self.value = np.zeros(2)

    def reset(self, points: Array, wanted: Array, active: NDArray[np.int64]) -> None:
        """Take the shift as it is now."""
        self.value = _apart(points, wanted, active) if len(active) else np.zeros(2)

    def follow(
        self, points: Array, wanted: Array, active: NDArray[np.int64], period: float
    ) -> Array:
        """The shift (2,), m, after `period` seconds with the soles at `points` (S, 3)."""
        if len(active):
            share = 1.0 - math.exp(-period / self._settling)
            self.value = self.value + share * (_apart(points, wanted, active) - self.value)
        return self.value


def _apart(points: Array, wanted: Array, active: NDArray[np.int64]) -> Array:
    apart = (points - wanted).take(active, axis=0)
    return np.asarray(np.add.reduce(apart[:, :2]) / len(active))
