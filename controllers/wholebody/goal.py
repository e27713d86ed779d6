"""What the tasks are asked for at one moment."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

__all__ = ["Goal"]

Array = NDArray[np.float64]


class Goal(NamedTuple):
    """The reference at one moment, laid where the measured feet are.

    Attributes:
        qpos: (nq,).
        qvel: (nv,).
        qacc: (nv,).
        com: (3,), m.
        com_velocity: (3,), m/s.
        com_acceleration: (3,), m/s^2.
        angular_momentum: About the CoM, (3,), kg m^2/s.
        angular_momentum_rate: (3,), N m.
        root_rotation: Of the pelvis, (3, 3).
        points: Lowest point of each sole, (S, 3), m.
        point_velocity: (S, 3), m/s.
        point_acceleration: (S, 3), m/s^2.
    """

    qpos: Array
    qvel: Array
    qacc: Array
    com: Array
    com_velocity: Array
    com_acceleration: Array
    angular_momentum: Array
    angular_momentum_rate: Array
    root_rotation: Array
    points: Array
    point_velocity: Array
    point_acceleration: Array

    def shifted(self, shift: Array) -> Goal:
        """The same, moved over the floor by `shift` (2,), m."""
        offset = np.array((*shift.tolist(), 0.0))
        qpos = self.qpos.copy()
        qpos[:3] += offset
        return self._replace(qpos=qpos, com=self.com + offset, points=self.points + offset)
