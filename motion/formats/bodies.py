"""Where the bodies of a motion are, each in its parent: what hierarchies and scenes are made of."""

from __future__ import annotations

import mujoco
import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from enpointe.motion.motion import Motion

__all__ = ["relative"]

Array = NDArray[np.float64]


def relative(motion: Motion) -> tuple[Array, Array]:
    """Every body in its parent.

    Returns:
        Translations (T, B, 3), m, and quaternions x y z w (T, B, 4), each on the side of the one
        before it, so that a linear way between two is the short one.
    """
    model, data = motion.model, mujoco.MjData(motion.model)
    parents = np.asarray(model.body_parentid)
    translations = np.empty((len(motion.time), model.nbody, 3))
    rotations = np.empty((len(motion.time), model.nbody, 4))
    for index, qpos in enumerate(motion.qpos):
        data.qpos[:] = qpos
        mujoco.mj_kinematics(model, data)
        turns = Rotation.from_quat(data.xquat, scalar_first=True)
        above = turns[parents].inv()
        translations[index] = above.apply(data.xpos - data.xpos[parents])
        rotations[index] = (above * turns).as_quat()
    side = np.sign((rotations[1:] * rotations[:-1]).sum(axis=2))
    side = np.cumprod(np.where(side == 0, 1, side), axis=0)
    rotations[1:] *= side[..., None]
    return translations, rotations
