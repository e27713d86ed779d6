"""Feet in the air kept over the floor while a body is posed."""

from __future__ import annotations

import mink
import mujoco
import numpy as np
from numpy.typing import NDArray

from enpointe.models.soles import sole_geoms, sole_points
from enpointe.motion.limbs_apart import RECOVERY

__all__ = ["FeetOverFloor"]

Array = NDArray[np.float64]


class FeetOverFloor(mink.Limit):
    """No sole comes lower than its clearance; one that is lower rises by `RECOVERY` a step.

    Args:
        model: The body.

    Attributes:
        soles: (S,), its sole geoms.
        clearance: (S,), m, the least height of each; minus infinity asks nothing.
    """

    def __init__(self, model: mujoco.MjModel) -> None:
        self.soles = sole_geoms(model)
        self.clearance = np.full(len(self.soles), -np.inf)

    def compute_qp_inequalities(
        self, configuration: mink.Configuration, dt: float
    ) -> mink.Constraint:
        """-J_z dq <= z - clearance."""
        model, data = configuration.model, configuration.data
        asked = np.flatnonzero(np.isfinite(self.clearance))
        if not len(asked):
            return mink.Constraint()
        points = sole_points(model, data, self.soles)
        rows = np.zeros((len(asked), model.nv))
        moved = np.empty((3, model.nv))
        for row, k in zip(rows, asked.tolist(), strict=True):
            mujoco.mj_jac(model, data, moved, None, points[k], model.geom_bodyid[self.soles[k]])
            row[:] = -moved[2]
        return mink.Constraint(
            rows, np.maximum(points[asked, 2] - self.clearance[asked], -RECOVERY)
        )
