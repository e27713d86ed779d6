"""The soles of a model: the spheres that meet the floor and nothing else."""

from __future__ import annotations

import mujoco
import numpy as np
from numpy.typing import NDArray

__all__ = ["sole_geoms", "sole_points"]


def sole_geoms(model: mujoco.MjModel) -> NDArray[np.int64]:
    """Geoms that meet a plane and nothing else, (S,), in the model's order."""
    planes = np.flatnonzero(model.geom_type == mujoco.mjtGeom.mjGEOM_PLANE)
    spheres = np.flatnonzero(model.geom_type == mujoco.mjtGeom.mjGEOM_SPHERE)
    floor_class = int(model.geom_contype[planes[0]]) if len(planes) else 0
    return np.array(
        [
            g
            for g in spheres
            if model.geom_contype[g] and int(model.geom_conaffinity[g]) == floor_class
        ],
        dtype=np.int64,
    )


def sole_points(
    model: mujoco.MjModel, data: mujoco.MjData, geoms: NDArray[np.int64]
) -> NDArray[np.float64]:
    """Lowest points of the soles, (S, 3), m, at the kinematics in `data`."""
    points = np.array(data.geom_xpos[geoms])
    points[:, 2] -= model.geom_size[geoms, 0]
    return points
