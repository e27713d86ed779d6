"""Where a foot in the air should land if the weight is not where it should be.

The extrapolated centre of mass xi = c + c' / omega runs away from the floor's pressure p by
xi' = omega (xi - p). An error e of it, of which the standing foot can hold the part m by moving its
pressure, is at the landing in T seconds

    e_T = (e - m e/|e|) exp(omega T)    for |e| > m,   0 otherwise,

and is no error any more if the foot lands by as much elsewhere (Hof 2008, Hum. Mov. Sci. 27;
Englsberger et al. 2015, IEEE T-RO 31; Khadiv et al. 2020, IEEE T-RO 36). The reference is then laid
over the feet as they are (`StandingPlace`).
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from enpointe.controllers.wholebody.contacts import PlannedSoles
from enpointe.controllers.wholebody.goal import Goal
from enpointe.controllers.wholebody.instant import Instant

__all__ = ["StepAdjustment"]

Array = NDArray[np.float64]
_HELD = 0.01
"""m: an error of the extrapolated centre of mass that the standing foot puts right."""
_FARTHEST, _INWARD = 0.12, 0.03
"""m: no step lands farther from where it was planned, nor farther towards the other foot."""
_AHEAD = 0.5
"""s: landings farther ahead are not thought of yet."""
_SMOOTH = 0.03
"""s: time constant with which the place of landing is moved."""


class StepAdjustment:
    """How far each foot in the air is moved over the floor.

    Args:
        schedule: Which soles are planned to bear, and when.
        times: Of its samples, (T,), s.
        feet: Rows of the soles of each of two feet.
    """

    def __init__(
        self, schedule: PlannedSoles, times: Array, feet: Sequence[NDArray[np.int64]]
    ) -> None:
        self._times, self._feet = times, tuple(feet)
        self._lands = [_next(times, schedule.planned[:, foot].any(axis=1)) for foot in feet]
        self._moved = np.zeros((len(self._feet), 2))

    def reset(self) -> None:
        """Nothing is moved."""
        self._moved[:] = 0.0

    def follow(self, t: float, instant: Instant, goal: Goal, period: float) -> Goal:
        """The goal with the places of feet in the air moved."""
        bearing = np.zeros(len(instant.soles), dtype=bool)
        bearing[instant.active] = True
        row = min(int(np.searchsorted(self._times, t, side="right")), len(self._times)) - 1
        places = goal.places
        for k, foot in enumerate(self._feet):
            left = self._lands[k][max(row, 0)] - t
            other = self._feet[1 - k]
            if bearing[foot].any() or not bearing[other].any() or not 0.0 < left < _AHEAD:
                self._moved[k] = 0.0
                continue
            aside = goal.points[foot].mean(axis=0) - goal.points[other].mean(axis=0)
            wanted = landing_shift(instant, goal, left, aside[:2])
            self._moved[k] += (1.0 - math.exp(-period / _SMOOTH)) * (wanted - self._moved[k])
            places = places.copy() if places is goal.places else places
            places[1 + foot, :2] += self._moved[k]
        return goal if places is goal.places else goal._replace(places=places)


def landing_shift(instant: Instant, goal: Goal, left: float, aside: Array) -> Array:
    """How far a foot lands from its place seen from the centre of mass, (2,), m.

    Args:
        instant: The body.
        goal: What it should do.
        left: s until the landing.
        aside: From the other foot to this one, (2,), m.
    """
    omega = math.sqrt(instant.gravity / max(float(instant.com[2]), 0.1))
    place = (instant.com - goal.com)[:2]
    error = place + (instant.com_velocity - goal.com_velocity)[:2] / omega
    size = float(np.linalg.norm(error))
    if size <= _HELD:
        return np.zeros(2)
    shift = error * (1.0 - _HELD / size) * math.exp(omega * left)
    shift *= min(1.0, _FARTHEST / float(np.linalg.norm(shift)))
    out = aside / max(float(np.linalg.norm(aside)), 1e-6)
    inward = -float(shift @ out)
    shift += max(inward - _INWARD, 0.0) * out
    return np.asarray(shift - place)


def _next(times: Array, down: NDArray[np.bool_]) -> Array:
    """When a foot stands next, at each sample (T,), s; infinite after its last stance."""
    rows = np.flatnonzero(down)
    if len(rows) == 0:
        return np.full(len(times), np.inf)
    after = np.searchsorted(rows, np.arange(len(times)))
    found = np.where(after < len(rows), times[rows[np.minimum(after, len(rows) - 1)]], np.inf)
    return np.asarray(found)
