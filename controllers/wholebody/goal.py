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

    def placed(self, place: Placement) -> Goal:
        """The same elsewhere on the floor."""
        rotation = place.rotation()
        turned = rotation.T
        offset = np.array((*place.offset.tolist(), 0.0))
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
            com=rotation @ self.com + offset,
            com_velocity=rotation @ self.com_velocity,
            com_acceleration=rotation @ self.com_acceleration,
            angular_momentum=rotation @ self.angular_momentum,
            angular_momentum_rate=rotation @ self.angular_momentum_rate,
            root_rotation=rotation @ self.root_rotation,
            points=self.points @ turned + offset,
            point_velocity=self.point_velocity @ turned,
            point_acceleration=self.point_acceleration @ turned,
        )
