"""A motion as the tasks need it: with its centre of mass, momentum and soles."""

from __future__ import annotations

from bisect import bisect_right

import mujoco
import numpy as np
from numpy.typing import NDArray

from enpointe.controllers.wholebody.goal import Goal
from enpointe.controllers.wholebody.instant import Observer
from enpointe.motion import Motion
from enpointe.motion.averaging import averaged

__all__ = ["Reference"]

Array = NDArray[np.float64]
_WHOLE = 0.2
"""s: rates of the body as a whole are averaged over this window. Where a foot leaves, a corner of a
millimetre in the poses is several m/s^2 and hundreds of N m, which no floor gives."""


class Reference:
    """The motion's own centre of mass, angular momentum and soles at every sample.

    Rates are central differences of the samples; those of the centre of mass and of the angular
    momentum are averaged.

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
        # One array, so that one interpolation a period serves all of it; what stands still at
        # both ends last.
        moved, turned = self._whole_rate(com_velocity), self._whole_rate(momentum)
        parts = (
            motion.qpos,
            np.concatenate([com[:, None], self.points], axis=1),
            motion.qvel,
            motion.qacc,
            np.stack([com_velocity, moved, momentum, turned], axis=1),
            self.point_velocity,
            self._rate(self.point_velocity),
        )
        flat = [part.reshape(count, -1) for part in parts]
        self._table = np.concatenate(flat, axis=1)
        ends = np.cumsum([part.shape[1] for part in flat]).tolist()
        self._qpos, self._places, self._qvel, self._qacc = map(slice, [0, *ends[:3]], ends[:4])
        self._rates = slice(ends[3], ends[-1])
        self._times = self.time.tolist()

    def _rate(self, values: Array) -> Array:
        return np.asarray(np.gradient(values, self.time, axis=0), dtype=np.float64)

    def _whole_rate(self, values: Array) -> Array:
        return averaged(self._rate(values), _WHOLE, 1.0 / float(np.median(np.diff(self.time))))

    def at(self, t: float) -> Goal:
        """The goal at `t` seconds; still at both ends."""
        times = self._times
        i = min(max(bisect_right(times, t) - 1, 0), len(times) - 2)
        w = min(max((t - times[i]) / (times[i + 1] - times[i]), 0.0), 1.0)
        row = (1 - w) * self._table[i] + w * self._table[i + 1]
        if not 0.0 <= t < times[-1]:
            row[self._qvel.start :] = 0.0
        qpos = row[self._qpos]
        mujoco.mj_normalizeQuat(self.motion.model, qpos)
        return Goal(
            qpos=qpos,
            qvel=row[self._qvel],
            qacc=row[self._qacc],
            root_rotation=_rotation(qpos[3:7]),
            places=row[self._places].reshape(-1, 3),
            rates=row[self._rates].reshape(-1, 3),
        )


def _rotation(quaternion: Array) -> Array:
    """The matrix (3, 3) of a unit quaternion (w, x, y, z)."""
    w, x, y, z = quaternion.tolist()
    return np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
            [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
            [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
        ]
    )
