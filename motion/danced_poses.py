"""What a dancer does, as a body with other limbs can follow it: directions, frames and points."""

from __future__ import annotations

import mujoco
import numpy as np
from numpy.typing import NDArray

from enpointe.models.anatomy import SIDES
from enpointe.motion.retargeting.body import Body
from enpointe.motion.retargeting.landmarks import sided

__all__ = ["THIGHS", "DancedPoses"]

Array = NDArray[np.float64]
THIGHS = ("left_thigh", "right_thigh")


class DancedPoses:
    """What is read off the dancer at every sample.

    Args:
        dancer: Her body.
        qpos: (N, nq).

    Attributes:
        count: N.
        directions: Of each segment, (N, 3) of length 1.
        frames: Of each of her parts, (N, 3, 3), axes in columns.
        thighs: Of each thigh, (N, 3, 3).
        points: Of hips, ankles and balls of the feet, (N, 3) m.
        pelvis: (N, 3) m.
        angles: Of each hinge, (N,) rad.
    """

    def __init__(self, dancer: Body, qpos: Array) -> None:
        model = dancer.model
        data = mujoco.MjData(model)
        self.count = len(qpos)
        segments = dancer.segments
        self.directions = {name: np.empty((len(qpos), 3)) for name in segments}
        self.frames = {part: np.empty((len(qpos), 3, 3)) for part in dancer.bodies}
        self.thighs = {thigh: np.empty((len(qpos), 3, 3)) for thigh in THIGHS}
        sites = sided("hip", "ankle", "ball")
        self.points = {name: np.empty((len(qpos), 3)) for name in sites}
        self.pelvis = np.empty((len(qpos), 3))
        self.angles: dict[str, Array] = {}
        for joint in range(1, model.njnt):
            self.angles[model.joint(joint).name] = qpos[:, model.jnt_qposadr[joint]]
        for i, row in enumerate(qpos):
            data.qpos[:] = row
            mujoco.mj_kinematics(model, data)
            for name, (start, end, length) in segments.items():
                self.directions[name][i] = (data.site_xpos[end] - data.site_xpos[start]) / length
            for part, frames in self.frames.items():
                frames[i] = data.xmat[dancer.bodies[part]].reshape(3, 3)
            for thigh, frames in self.thighs.items():
                frames[i] = data.body(thigh).xmat.reshape(3, 3)
            for name, points in self.points.items():
                points[i] = data.site(name).xpos
            self.pelvis[i] = data.xpos[dancer.bodies["pelvis"]]

    @property
    def feet(self) -> dict[str, tuple[Array, Array, Array, Array]]:
        """Of each side what `footings` asks for: ball, toe, foot and ankle."""
        return {
            side: (
                self.points[f"{side}_ball"],
                self.frames[f"{side}_toe"],
                self.frames[f"{side}_foot"],
                self.points[f"{side}_ankle"],
            )
            for side in SIDES
        }
