"""Where the joints of a dancer are at one moment: what every way of reading a pose starts from.

Nothing here depends on our own dancer. Motion capture gives the same points, so that whatever reads
a `Joints` reads a captured dancer too.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from math import degrees

import mujoco
import numpy as np
from numpy.typing import ArrayLike, NDArray

from enpointe.errors import ModelError, PoseError

__all__ = ["JOINTS", "Joints", "angle_between"]

Vector = NDArray[np.float64]
JOINTS = (
    "shoulder",
    "elbow",
    "wrist",
    "hip",
    "knee",
    "ankle",
    "heel",
    "ball",
    "toe_tip",
)
"""The points of each side; heel, ball and tip of the toes are those of the sole."""


@dataclass(frozen=True)
class Joints:
    """The points and frames of one dancer in the world, z up, the floor at 0.

    Attributes:
        points: By name, such as "left_wrist", each (3,), m; all of `JOINTS` on both sides.
        pelvis: Rotation of the pelvis, (3, 3), the identity where she stands erect facing x.
        torso: The same of the trunk above the waist.
        head: The same of the head.
        com: Centre of mass, (3,), m.
    """

    points: Mapping[str, Vector]
    pelvis: Vector
    torso: Vector
    head: Vector
    com: Vector

    @classmethod
    def of(cls, model: mujoco.MjModel, qpos: ArrayLike) -> Joints:
        """Measure one configuration of a dancer.

        Args:
            model: The dancer.
            qpos: (nq,).

        Raises:
            PoseError: A configuration of another size, or one that is not finite.
            ModelError: The model lacks one of the dancer's sites or bodies.
        """
        values = np.asarray(qpos, dtype=float)
        if values.shape != (model.nq,):
            raise PoseError(
                f"a configuration of this dancer has shape ({model.nq},), not {values.shape}"
            )
        if not np.all(np.isfinite(values)):
            raise PoseError("the configuration has values that are not numbers")
        data = mujoco.MjData(model)
        data.qpos[:] = values
        mujoco.mj_kinematics(model, data)
        mujoco.mj_comPos(model, data)
        names = [f"{side}_{joint}" for side in ("left", "right") for joint in JOINTS]
        try:
            return cls(
                points={name: np.array(data.site(name).xpos) for name in names},
                pelvis=np.array(data.body("pelvis").xmat).reshape(3, 3),
                torso=np.array(data.body("torso").xmat).reshape(3, 3),
                head=np.array(data.body("head").xmat).reshape(3, 3),
                com=np.array(data.subtree_com[0]),
            )
        except KeyError as error:
            raise ModelError(f"this model is not a dancer's: {error}") from None

    def __getitem__(self, name: str) -> Vector:
        return self.points[name]

    def between(self, start: str, end: str) -> Vector:
        """Unit vector from one point to another, (3,)."""
        along = self.points[end] - self.points[start]
        return np.asarray(along / max(float(np.linalg.norm(along)), 1e-9))


def angle_between(one: Vector, other: Vector) -> float:
    """Angle between two unit vectors, degrees."""
    return degrees(float(np.arccos(np.clip(one @ other, -1.0, 1.0))))
