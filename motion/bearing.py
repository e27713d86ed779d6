"""Which coordinates carry the body: the root and the legs."""

from __future__ import annotations

import mujoco
import numpy as np
from numpy.typing import NDArray

__all__ = ["bearing_columns"]

_LEG_JOINTS = ("hip", "knee", "ankle", "toe")


def bearing_columns(model: mujoco.MjModel) -> NDArray[np.int64]:
    """Columns of qpos of the root and the legs' hinges, in order."""
    columns: list[int] = []
    for j in range(model.njnt):
        start, name = int(model.jnt_qposadr[j]), model.joint(j).name
        if model.jnt_type[j] == mujoco.mjtJoint.mjJNT_FREE:
            columns += range(start, start + 7)
        elif any(part in name for part in _LEG_JOINTS):
            columns.append(start)
    return np.array(columns)
