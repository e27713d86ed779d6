"""Which soles a motion puts on the floor, when, and where they stand meanwhile."""

from __future__ import annotations

from dataclasses import dataclass

import mujoco
import numpy as np
from numpy.typing import NDArray

from enpointe.models.foot_positions import support_hull
from enpointe.motion.motion import Motion

__all__ = ["ContactPlan", "plan_contacts", "sole_geoms", "steps"]

Array = NDArray[np.float64]
NEAR = 0.006
"""A sole nearer to the floor than this, m, is on it."""
SLOW = 0.08
"""A sole faster over the floor than this, m/s, slides and bears nothing."""
SHORTEST = 0.06
"""A touch or a gap shorter than this, s, is an accident of interpolation."""

BRIDGED = 0.4
"""Without any sole on the floor for less than this, s, and none higher above it than `LOW`, she
rolls or turns on a foot and does not jump."""
LOW = 0.03
"""m."""


@dataclass(frozen=True)
class ContactPlan:
    """The soles on the floor over a phrase.

    Attributes:
        time: (T,), s.
        soles: Geoms, (S,).
        planted: (T, S).
        places: Where each sole stands or will next stand or last stood, (T, S, 2), m.
    """

    time: Array
    soles: NDArray[np.int64]
    planted: NDArray[np.bool_]
    places: Array

    def support(self, k: int) -> Array:
        """Hull of the soles on the floor at sample `k`, counter-clockwise, (H, 2), m."""
        return support_hull(self.places[k, self.planted[k]])


def sole_geoms(model: mujoco.MjModel) -> NDArray[np.int64]:
    """The spheres that meet a plane and nothing else, (S,)."""
    planes = np.flatnonzero(model.geom_type == mujoco.mjtGeom.mjGEOM_PLANE)
    floor = int(model.geom_contype[planes[0]]) if len(planes) else 0
    spheres = model.geom_type == mujoco.mjtGeom.mjGEOM_SPHERE
    return np.flatnonzero(spheres & (model.geom_contype > 0) & (model.geom_conaffinity == floor))


def plan_contacts(motion: Motion) -> ContactPlan:
    """Read the contacts off a motion: soles near the floor and still."""
    model, soles = motion.model, sole_geoms(motion.model)
    data = mujoco.MjData(model)
    points = np.empty((len(motion.time), len(soles), 3))
    for i, qpos in enumerate(motion.qpos):
        data.qpos[:] = qpos
        mujoco.mj_kinematics(model, data)
        points[i] = data.geom_xpos[soles]
    points[:, :, 2] -= model.geom_size[soles, 0]
    speed = np.linalg.norm(np.gradient(points[:, :, :2], motion.time, axis=0), axis=2)
    planted = (points[:, :, 2] < NEAR) & (speed < SLOW)
    shortest = round(SHORTEST / float(motion.time[1] - motion.time[0]))
    places = np.array(points[:, :, :2])
    for s in range(len(soles)):
        planted[:, s] = _without_blips(planted[:, s], shortest)
    longest = round(BRIDGED / float(motion.time[1] - motion.time[0]))
    _bridge(planted, points[:, :, 2].min(axis=1) < LOW, longest)
    for s in range(len(soles)):
        places[:, s] = _held(planted[:, s], points[:, s, :2])
    return ContactPlan(motion.time, soles, planted, places)


def steps(motion: Motion) -> bool:
    """Whether any sole leaves the floor or comes to it."""
    planted = plan_contacts(motion).planted
    return bool((planted != planted[0]).any())


def _bridge(planted: NDArray[np.bool_], low: NDArray[np.bool_], longest: int) -> None:
    """Keep the soles before a low and short gap to its middle, and those after it from there."""
    for start, end in _runs(np.asarray(~planted.any(axis=1))):
        inside = start > 0 and end < len(planted)
        if inside and end - start < longest and low[start:end].all():
            middle = (start + end) // 2
            planted[start:middle], planted[middle:end] = planted[start - 1], planted[end]


def _runs(mask: NDArray[np.bool_]) -> list[tuple[int, int]]:
    edges = np.flatnonzero(np.diff(np.concatenate([[False], mask, [False]]).astype(int)))
    return [(int(a), int(b)) for a, b in zip(edges[::2], edges[1::2], strict=True)]


def _without_blips(mask: NDArray[np.bool_], shortest: int) -> NDArray[np.bool_]:
    clean = mask.copy()
    for value in (False, True):
        for start, end in _runs(clean == value):
            inside = start > 0 and end < len(mask)
            if inside and end - start < shortest:
                clean[start:end] = not value
    return clean


def _held(mask: NDArray[np.bool_], points: Array) -> Array:
    """The median place of each run, and between two runs the nearer one's."""
    runs = _runs(mask)
    places = points.copy()
    if not runs:
        return places
    medians = [np.median(points[a:b], axis=0) for a, b in runs]
    places[: runs[0][1]] = medians[0]
    places[runs[-1][0] :] = medians[-1]
    for (i, first), second in zip(enumerate(runs[:-1]), runs[1:], strict=True):
        middle = (first[1] + second[0]) // 2
        places[first[0] : middle] = medians[i]
        places[middle : second[1]] = medians[i + 1]
    return places
