"""How far a body's directions are from the captured ones."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import mujoco
import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from enpointe.motion.motion import Motion
from enpointe.motion.retargeting.body import Body
from enpointe.motion.retargeting.plan import Plan

__all__ = ["Residual", "residuals"]

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class Residual:
    """An angle between what was captured and what was made of it, over a movement, degrees.

    Attributes:
        median: Half of the samples are better.
        p95: One in twenty is worse.
        worst: The largest.
    """

    median: float
    p95: float
    worst: float

    @classmethod
    def of(cls, angles: Array) -> Residual:
        """Of angles (T,), rad."""
        median, p95, worst = np.degrees(np.percentile(angles, [50, 95, 100]))
        return cls(float(median), float(p95), float(worst))


def residuals(plan: Plan, body: Body, motion: Motion) -> Mapping[str, Residual]:
    """Of each segment's direction and each part's frame."""
    data = mujoco.MjData(body.model)
    segments = {k: v for k, v in body.segments.items() if k in plan.directions}
    parts = [part for part in plan.frames if part in body.bodies]
    directions = np.empty((len(segments), len(motion.time), 3))
    turns = np.empty((len(parts), len(motion.time), 3, 3))
    for i, qpos in enumerate(motion.qpos):
        data.qpos[:] = qpos
        mujoco.mj_kinematics(body.model, data)
        for row, (start, end, length) in zip(directions, segments.values(), strict=True):
            row[i] = (data.site_xpos[end] - data.site_xpos[start]) / length
        for row, part in zip(turns, parts, strict=True):
            row[i] = data.xmat[body.bodies[part]].reshape(3, 3) @ body.turned[part].T
    found = {}
    for name, made in zip(segments, directions, strict=True):
        cosine = np.sum(made * plan.directions[name], axis=1)
        found[name] = Residual.of(np.arccos(np.clip(cosine, -1.0, 1.0)))
    for part, made in zip(parts, turns, strict=True):
        off = Rotation.from_matrix(np.swapaxes(plan.frames[part], 1, 2) @ made)
        found[part] = Residual.of(off.magnitude())
    return found
