"""Which soles may bear weight: those that are meant to and that are on the floor."""

from __future__ import annotations

from bisect import bisect_right

import numpy as np
from numpy.typing import NDArray

from enpointe.controllers.wholebody.reference import Reference
from enpointe.controllers.wholebody.rows import repeated
from enpointe.motion.contact_schedule import ContactSchedule

__all__ = ["PlannedSoles", "Uptake"]

Array = NDArray[np.float64]
Indices = NDArray[np.int64]
_NONE: Indices = np.empty(0, dtype=np.int64)
PLANNED_DOWN = 0.001
"""A sole that the reference has lower than this, m, is on the floor: weight that is counted on
while a heel is still coming down is missing under the ball, and lets the body drop onto it."""
NEAR = 0.003
"""A sole that is measured closer to the floor than this, m, is on it: measuring errs by as much."""
TAKING_UP = 0.04
"""s over which a sole that came down takes up weight: eight relevés landed with 2.2 times the
body's weight instead of 3.1, and no heel bounced."""
PLANTED_SPEED = 0.1
"""A sole that the reference moves faster than this, m/s, slides or swings and bears nothing."""


class PlannedSoles:
    """The soles that are meant to bear at each sample of a reference.

    Args:
        reference: What is to be danced.
        contacts: Which soles it was planned to stand on; without, those that it puts on the floor,
            still.

    Attributes:
        planned: (T, S).
    """

    def __init__(self, reference: Reference, contacts: ContactSchedule | None = None) -> None:
        if contacts is None:
            level = np.linalg.norm(np.asarray(reference.point_velocity)[:, :, :2], axis=2)
            self.planned = (reference.clearance < PLANNED_DOWN) & (level < PLANTED_SPEED)
        else:
            self.planned = np.array([contacts.at(t) for t in reference.time.tolist()])
        self._times = reference.time.tolist()

    def at(self, t: float) -> NDArray[np.bool_]:
        """Soles planned to bear at `t` seconds, (S,)."""
        return np.asarray(self.planned[max(bisect_right(self._times, t) - 1, 0)])

    def split(
        self, t: float, clearance: Array, standing: Indices = _NONE
    ) -> tuple[Indices, Indices]:
        """Rows of the soles that bear at `t`: those that are meant to and are on the floor.

        Where none of them is there yet, what stood until now and is still on the floor stands on:
        a foot that lands late is waited for.

        Args:
            t: s.
            clearance: Of each sole, (S,), m.
            standing: Rows that bore until now.

        Returns:
            They, and those that are meant to bear and are off the floor.
        """
        planned, near = self.at(t), clearance < NEAR
        active = (planned & near).nonzero()[0]
        if len(active) == 0 and planned.any():
            active = standing[near[standing]]
        return active, (planned > near).nonzero()[0]


class Uptake:
    """How much weight may be put on each sole: none as it comes down, any amount soon after.

    The programme would move half the weight onto a heel in the period in which it is counted on
    first; where the heel is still a millimetre up, that half falls. What comes down alone, as from
    a jump, bears at once.

    Args:
        soles: How many.
    """

    def __init__(self, soles: int) -> None:
        self._bearing = np.full(soles, TAKING_UP)

    def reset(self, active: Indices) -> None:
        """Those that stand now bear in full."""
        self._bearing[:] = 0.0
        self._bearing[active] = TAKING_UP

    def follow(self, active: Indices, period: float) -> Array:
        """Share of the body's weight that each active sole may bear, (A,); inf for any amount."""
        bearing = self._bearing[active] + period
        self._bearing[:] = 0.0
        self._bearing[active] = bearing
        fresh = bearing < TAKING_UP
        new = np.count_nonzero(fresh)
        if new in (0, len(active)):
            return repeated(np.inf, len(active))
        return np.where(fresh, (bearing / TAKING_UP) ** 2, np.inf)
