"""Limbs of a body kept out of one another while it is posed."""

from __future__ import annotations

import mink
import mujoco
import numpy as np
from numpy.typing import NDArray

__all__ = ["LimbsApart"]

Array = NDArray[np.float64]
_APART = 0.005
"""m: nearer than this, limbs push each other away. What else is asked makes up for some of it."""


class LimbsApart(mink.Task):
    """max(0, apart - d) of every pair of limbs that would meet in the engine, d their distance.

    Pairs are those that collide by the model's own masks, parents and exclusions; soles and floors
    are none of them, as where feet stand is planned elsewhere. A cost and not a constraint: a pose
    that begins with limbs in one another still comes apart, and a body that can't part them is
    posed all the same.

    Args:
        model: The body.
        cost: 1/m.
    """

    def __init__(self, model: mujoco.MjModel, cost: float) -> None:
        self._pairs = _meeting(model)
        super().__init__(cost=np.full(max(len(self._pairs), 1), cost))
        self._reach = model.geom_rbound[self._pairs].sum(axis=1) + _APART
        self._bodies = model.geom_bodyid[self._pairs]

    def compute_error(self, configuration: mink.Configuration) -> Array:
        return self._near(configuration, None)

    def compute_jacobian(self, configuration: mink.Configuration) -> Array:
        rows = np.zeros((len(self.cost), configuration.model.nv))
        self._near(configuration, rows)
        return rows

    def _near(self, configuration: mink.Configuration, rows: Array | None) -> Array:
        """How much is missing of each pair; `rows` are given its Jacobian."""
        model, data = configuration.model, configuration.data
        missing = np.zeros(len(self.cost))
        ends, one, other = np.empty(6), np.empty((3, model.nv)), np.empty((3, model.nv))
        places = data.geom_xpos[self._pairs]
        away = np.linalg.norm(places[:, 0] - places[:, 1], axis=1)
        for k in np.flatnonzero(away < self._reach).tolist():
            first, second = self._pairs[k].tolist()
            distance = mujoco.mj_geomDistance(model, data, first, second, _APART, ends)
            if distance >= _APART:
                continue
            missing[k] = _APART - distance
            if rows is None:
                continue
            way = (ends[3:] - ends[:3]) / (distance or 1.0)
            mujoco.mj_jac(model, data, one, None, ends[:3], int(self._bodies[k, 0]))
            mujoco.mj_jac(model, data, other, None, ends[3:], int(self._bodies[k, 1]))
            rows[k] = -way @ (other - one)
        return missing


def _meeting(model: mujoco.MjModel) -> NDArray[np.int64]:
    """Pairs of geoms (P, 2) that the engine lets collide."""
    limbs = [
        g
        for g in range(model.ngeom)
        if model.geom_contype[g] & model.geom_conaffinity[g]
        and model.geom_type[g] != mujoco.mjtGeom.mjGEOM_PLANE
    ]
    weld = model.body_weldid
    parent = weld[model.body_parentid[weld]]
    excluded = set(model.exclude_signature.tolist())
    pairs = []
    for k, first in enumerate(limbs):
        for second in limbs[k + 1 :]:
            low, high = sorted(model.geom_bodyid[[first, second]].tolist())
            a, b = int(weld[low]), int(weld[high])
            related = a == b or parent[a] == b or parent[b] == a
            if not related and (low << 16) + high not in excluded:
                pairs.append((first, second))
    return np.array(pairs, dtype=np.int64).reshape(-1, 2)
