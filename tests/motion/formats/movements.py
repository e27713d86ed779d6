"""Motions of the dancer to convert: no dance, but every hinge at every angle."""

from __future__ import annotations

import mujoco
import numpy as np
from scipy.spatial.transform import Rotation

from enpointe.models import dancer_model
from enpointe.motion import Motion
from enpointe.motion.motion import Event


def writhing(seed: int = 0, frames: int = 61, rate: float = 100.0) -> Motion:
    """Smooth in all hinges, over their poles and over whole turns of the root."""
    model = dancer_model(flesh=False)
    rng = np.random.default_rng(seed)
    time = np.arange(frames) / rate
    phase = rng.uniform(0, 2 * np.pi, (3, model.nq))
    waves = sum(np.sin((k + 1) * 3 * time[:, None] + phase[k]) / (k + 1) for k in range(3))
    qpos = 1.2 * np.asarray(waves)
    turn = np.column_stack([0 * time, 0 * time, 9 * time]) + 0.3 * qpos[:, 3:6]
    qpos[:, 3:7] = Rotation.from_rotvec(turn).as_quat(scalar_first=True)
    event = Event(0.1, "key pose", "somewhere", 1.0)
    return Motion.from_qpos(model, time, qpos, events=[event], name="writhing")


def body_places(motion: Motion) -> np.ndarray:
    """(T, B, 3), m: where MuJoCo has each body but the world."""
    data = mujoco.MjData(motion.model)
    places = np.empty((len(motion.time), motion.model.nbody - 1, 3))
    for place, qpos in zip(places, motion.qpos, strict=True):
        data.qpos[:] = qpos
        mujoco.mj_kinematics(motion.model, data)
        place[:] = data.xpos[1:]
    return places
