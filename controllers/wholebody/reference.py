"""A motion as the tasks need it: with its centre of mass, momentum and soles."""

from __future__ import annotations

import mujoco
import numpy as np
from numpy.typing import NDArray

from enpointe.controllers.wholebody.goal import Goal
from enpointe.controllers.wholebody.instant import Observer
from enpointe.motion import Motion

__all__ = ["Reference"]

Array = NDArray[np.float64]


class Reference:
    """The motion's own centre of mass, angular momentum and soles at every sample.

    Rates are central differences of the samples.

    Args:
        motion: What is to be danced.
        observer: Of the controller's model.

    Attributes:
        time: (T,), s.
        clearance: Height of each sole above the floor, (T, S), m.
        points: Lowest point of each sole, (T, S, 3), m.
        point_velocity: (T, S, 3), m/s.
    """

    def __init__(self, motion: Motion, observer: Observer) -> None:
        self.motion = motion
        self.time = motion.time
        count, soles = len(motion.time), len(observer.soles)
        com, com_velocity, momentum = np.empty((3, count, 3))
        self.clearance = np.empty((count, soles))
        self.points = np.empty((count, soles, 3))
        data = observer.plant.data
        for i in range(count):
            observer.place(motion.qpos[i], motion.qvel[i])
            com[i] = data.subtree_com[0]
            com_velocity[i] = data.subtree_linvel[0]
            momentum[i] = data.subtree_angmom[0]
            self.clearance[i] = observer.clearance()
            self.points[i] = observer.points()
        self.point_velocity = self._rate(self.points)
        places = [com, self.points]
        rates = [
            com_velocity,
            self._rate(com_velocity),
            momentum,
            self._rate(momentum),
            self.point_velocity,
            self._rate(self.point_velocity),
        ]
        # One array, so that one interpolation a period serves all of it.
        self._table = np.hstack([each.reshape(count, -1) for each in (*places, *rates)])
        self._moves = 3 + 3 * soles

    def _rate(self, values: Array) -> Array:
        return np.asarray(np.gradient(values, self.time, axis=0), dtype=np.float64)

    def at(self, t: float) -> Goal:
        """The goal at `t` seconds; still at both ends."""
        qpos, qvel, qacc = self.motion.sample(t)
        i = min(max(int(np.searchsorted(self.time, t, side="right")) - 1, 0), len(self.time) - 2)
        w = min(max((t - self.time[i]) / (self.time[i + 1] - self.time[i]), 0.0), 1.0)
        row = (1 - w) * self._table[i] + w * self._table[i + 1]
        if not 0.0 <= t < self.time[-1]:
            row[self._moves :] = 0.0
        rotation = np.zeros(9)
        mujoco.mju_quat2Mat(rotation, qpos[3:7])
        points, rates = row[3 : self._moves], row[self._moves :]
        velocities, accelerations = np.split(rates[12:], 2)
        return Goal(
            qpos=qpos,
            qvel=qvel,
            qacc=qacc,
            com=row[:3],
            com_velocity=rates[:3],
            com_acceleration=rates[3:6],
            angular_momentum=rates[6:9],
            angular_momentum_rate=rates[9:12],
            root_rotation=rotation.reshape(3, 3),
            points=points.reshape(-1, 3),
            point_velocity=velocities.reshape(-1, 3),
            point_acceleration=accelerations.reshape(-1, 3),
        )
