"""What the tasks are asked for at one moment."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from enpointe.controllers.wholebody.standing_place import Placement

__all__ = ["Goal"]

Array = NDArray[np.float64]


class Goal(NamedTuple):
    """The reference at one moment, laid where the measured feet are.

    Attributes:
        qpos: (nq,).
        qvel: (nv,).
        qacc: (nv,).
        root_rotation: Of the pelvis, (3, 3).
        places: Of the centre of mass and of the lowest point of each sole, (1 + S, 3), m.
        rates: Velocity (m/s) and acceleration (m/s^2) of the centre of mass, angular momentum about
            it (kg m^2/s) and its rate (N m), velocities of the points, accelerations of the points,
            (4 + 2 S, 3).
    """

    qpos: Array
    qvel: Array
    qacc: Array
    root_rotation: Array
    places: Array
    rates: Array

    @property
    def com(self) -> Array:
        """(3,), m."""
        return np.asarray(self.places[0])

    @property
    def points(self) -> Array:
        """Lowest point of each sole, (S, 3), m."""
        return np.asarray(self.places[1:])

    @property
    def com_velocity(self) -> Array:
        """(3,), m/s."""
        return np.asarray(self.rates[0])

    @property
    def com_acceleration(self) -> Array:
        """(3,), m/s^2."""
        return np.asarray(self.rates[1])

    @property
    def angular_momentum(self) -> Array:
        """About the centre of mass, (3,), kg m^2/s."""
        return np.asarray(self.rates[2])

    @property
    def angular_momentum_rate(self) -> Array:
        """(3,), N m."""
        return np.asarray(self.rates[3])

    @property
    def point_velocity(self) -> Array:
        """(S, 3), m/s."""
        return np.asarray(self.rates[4 : 3 + len(self.places)])

    @property
    def point_acceleration(self) -> Array:
        """(S, 3), m/s^2."""
        return np.asarray(self.rates[3 + len(self.places) :])

    def placed(self, place: Placement) -> Goal:
        """The same elsewhere on the floor."""
        rotation = place.rotation()
        turned = rotation.T
        offset = np.array((*place.offset, 0.0))
        qpos, qvel, qacc = self.qpos.copy(), self.qvel.copy(), self.qacc.copy()
        qpos[:3] = rotation @ qpos[:3] + offset
        half = 0.5 * place.yaw
        w, x, y, z = qpos[3:7].tolist()
        cosine, sine = math.cos(half), math.sin(half)
        qpos[3:7] = (
            cosine * w - sine * z,
            cosine * x - sine * y,
            cosine * y + sine * x,
            cosine * z + sine * w,
        )
        # Of a free joint only the linear rates are in the world's frame.
        qvel[:3], qacc[:3] = rotation @ qvel[:3], rotation @ qacc[:3]
        return Goal(
            qpos=qpos,
            qvel=qvel,
            qacc=qacc,
            root_rotation=rotation @ self.root_rotation,
            places=self.places @ turned + offset,
            rates=self.rates @ turned,
        )
