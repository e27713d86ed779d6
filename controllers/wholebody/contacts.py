"""Which soles may bear weight: those that are meant to and that are on the floor."""

from __future__ import annotations

from bisect import bisect_right

import numpy as np
from numpy.typing import NDArray

from enpointe.controllers.wholebody.reference import Reference

__all__ = ["ContactSchedule"]

Array = NDArray[np.float64]
PLANNED_DOWN = 0.001
"""A sole that the reference has lower than this, m, is on the floor: weight that is counted on
while a heel is still coming down is missing under the ball, and lets the body drop onto it."""
NEAR = 0.003
"""A sole that is measured closer to the floor than this, m, is on it: measuring errs by as much."""
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
        self.planned = (reference.clearance < PLANNED_DOWN) & (level < PLANTED_SPEED)
        self._times = reference.time.tolist()

    def at(self, t: float) -> NDArray[np.bool_]:
        """Soles planned to bear at `t` seconds, (S,)."""
        return np.asarray(self.planned[max(bisect_right(self._times, t) - 1, 0)])

    def active(self, t: float, clearance: Array) -> NDArray[np.int64]:
        """Rows of the soles that are planned to bear at `t` and measured on the floor, (A,)."""
        return (self.at(t) & (clearance < NEAR)).nonzero()[0]
