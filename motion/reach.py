"""Where wrists are from their shoulders, in arm lengths: what bodies of any size have in common."""

from __future__ import annotations

import mujoco
import numpy as np
from numpy.typing import NDArray

from enpointe.motion.motion import Motion
from enpointe.notation import Side

__all__ = ["has_reach", "reaches"]

Array = NDArray[np.float64]
_POINTS = ("shoulder", "elbow", "wrist")


def has_reach(model: mujoco.MjModel) -> bool:
    """Whether a body has a torso, and the shoulders, elbows and wrists of a dancer."""
    sites = {model.site(i).name for i in range(model.nsite)}
    bodies = {model.body(i).name for i in range(model.nbody)}
    return "torso" in bodies and all(f"{s}_{p}" in sites for s in Side for p in _POINTS)


def reaches(motion: Motion, time: Array) -> dict[Side, Array]:
    """Wrists in the torso's frame, from the shoulder, over the length of upper arm and forearm.

    Args:
        motion: Of a body that has reach (`has_reach`).
        time: (T,), s.

    Returns:
        Of each side (T, 3): 1 in length where the arm is straight.
    """
    model = motion.model
    data = mujoco.MjData(model)
    torso = model.body("torso").id
    sites = {side: [model.site(f"{side}_{point}").id for point in _POINTS] for side in Side}
    found = {side: np.empty((len(time), 3)) for side in Side}
    for i, t in enumerate(time):
        data.qpos[:] = motion.sample(float(t))[0]
        mujoco.mj_kinematics(model, data)
        rotation = data.xmat[torso].reshape(3, 3)
        for side, places in sites.items():
            shoulder, elbow, wrist = data.site_xpos[places]
            length = np.linalg.norm(elbow - shoulder) + np.linalg.norm(wrist - elbow)
            found[side][i] = rotation.T @ (wrist - shoulder) / length
    return found
