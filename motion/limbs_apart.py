"""Limbs of a body kept out of one another while it is posed."""

from __future__ import annotations

import mink
import mujoco
import numpy as np
from numpy.typing import NDArray

__all__ = ["RECOVERY", "LimbsApart"]

Array = NDArray[np.float64]
RECOVERY = 0.004
"""m a step: so fast something leaves where it must not be."""
_APART = 0.003
"""m between limbs: kinks are averaged away afterwards, which may bring them nearer."""
_SEEN = 0.03
"""m at which a limb takes notice of another."""
_GAIN = 0.8
"""Share of the room between two limbs that one step may take: distances curve."""


class LimbsApart(mink.Limit):
    """No two limbs that would meet in the engine come nearer than 3 mm; those that are, part.

    Pairs are those that collide by the model's own masks, parents and exclusions; soles and floors
    are none of them. Unlike mink's own limit, limbs that begin in one another come apart again.

    Args:
        model: The body.
    """

    def __init__(self, model: mujoco.MjModel) -> None:
        self._pairs = _meeting(model)
        self._reach = model.geom_rbound[self._pairs].sum(axis=1) + _SEEN
        self._bodies = model.geom_bodyid[self._pairs]

    def compute_qp_inequalities(
        self, configuration: mink.Configuration, dt: float
    ) -> mink.Constraint:
        """n (J_1 - J_2) dq <= gain (d - apart), n from the first limb to the second."""
        model, data = configuration.model, configuration.data
        rows: list[Array] = []
        room: list[float] = []
        ends, one, other = np.empty(6), np.empty((3, model.nv)), np.empty((3, model.nv))
        places = data.geom_xpos[self._pairs]
        away = np.linalg.norm(places[:, 0] - places[:, 1], axis=1)
        for k in np.flatnonzero(away < self._reach).tolist():
            first, second = self._pairs[k].tolist()
            distance = mujoco.mj_geomDistance(model, data, first, second, _SEEN, ends)
            if distance >= _SEEN:
                continue
            way = (ends[3:] - ends[:3]) / (distance or 1.0)
            mujoco.mj_jac(model, data, one, None, ends[:3], int(self._bodies[k, 0]))
            mujoco.mj_jac(model, data, other, None, ends[3:], int(self._bodies[k, 1]))
            rows.append(way @ (one - other))
            room.append(max(_GAIN * (distance - _APART), -RECOVERY))
        return mink.Constraint(np.array(rows), np.array(room)) if rows else mink.Constraint()


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
