"""The body that is to move: where a model has the landmarks, and how long its limbs are."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import mujoco
import numpy as np
from numpy.typing import NDArray

from enpointe.errors import ModelError
from enpointe.models.anatomy import SIDES
from enpointe.models.soles import sole_geoms, sole_points
from enpointe.motion.retargeting.landmarks import SEGMENTS, sided

__all__ = ["BALL", "DANCER", "HEEL", "NONE", "TIP", "Body", "Foot"]

Array = NDArray[np.float64]
DANCER: Mapping[str, str] = {
    "pelvis": "pelvis",
    "torso": "torso",
    "head": "head",
    **{name: name for name in sided("hip", "knee", "ankle", "shoulder", "elbow", "wrist")},
    **{f"{side}_hand": f"{side}_fingertips" for side in SIDES},
    **{name: name for name in sided("foot", "toe")},
}
"""What the dancer calls the landmarks (sites) and the parts that turn whole (bodies)."""
NONE, BALL, HEEL, TIP = 0, 1, 2, 3
"""What of a foot is on the floor: nothing; its ball, heel up or down; its heel alone; its tip."""
_NEAR = 0.02
"""Soles this near to heel, ball or tip, m, are of it."""
_BODIES = ("pelvis", "torso", "head", *sided("foot", "toe"))


@dataclass(frozen=True)
class Foot:
    """One foot of a body, its points in the foot's upright frame at rest, from the ankle, m.

    Attributes:
        soles: Geoms under it, those that touch a floor that it lies flat on.
        along: (S,), how far each is in front of the ankle.
        ball: The middle of the sole under the toe joint.
        heel: The hindmost of the sole.
        tip: The foremost.
    """

    soles: NDArray[np.int64]
    along: Array
    ball: Array
    heel: Array
    tip: Array

    @property
    def span(self) -> float:
        """Heel to ball."""
        return float(self.ball[0] - self.heel[0])

    @property
    def toes(self) -> float:
        """Ball to tip."""
        return float(self.tip[0] - self.ball[0])


class Body:
    """A model with landmarks.

    Args:
        model: Any MJCF body on a free root, upright and facing x at its first keyframe, or at
            `qpos0` where it has none, with soles that meet a plane and nothing else.
        names: Its sites of the landmarks and its bodies of the parts; the dancer's without. Hips,
            knees, ankles, pelvis and feet are needed; a toe body only where toes bend.

    Raises:
        ModelError: A name that the model lacks, a part that is needed, no free root, no soles.
    """

    def __init__(self, model: mujoco.MjModel, names: Mapping[str, str] | None = None) -> None:
        self.model = model
        self.names = dict(DANCER if names is None else names)
        needed = ("pelvis", *sided("hip", "knee", "ankle", "foot"))
        missing = [name for name in needed if name not in self.names]
        if missing:
            raise ModelError(f"this body has no {', '.join(missing)} to retarget to")
        if not model.njnt or model.jnt_type[0] != mujoco.mjtJoint.mjJNT_FREE:
            raise ModelError("a body to retarget to stands on a free root joint")
        try:
            self.sites = {k: int(model.site(v).id) for k, v in self._named(bodies=False)}
            self.bodies = {k: int(model.body(v).id) for k, v in self._named(bodies=True)}
        except KeyError as error:
            raise ModelError(f"this model is not as its landmarks say: {error}") from None
        self.rest = np.array(model.key_qpos[0] if model.nkey else model.qpos0)
        data = mujoco.MjData(model)
        data.qpos[:] = self.rest
        mujoco.mj_kinematics(model, data)
        self.at_rest = {k: np.array(data.site_xpos[v]) for k, v in self.sites.items()}
        self.turned = {k: np.array(data.xmat[v]).reshape(3, 3) for k, v in self.bodies.items()}
        self.pelvis = np.array(data.xpos[self.bodies["pelvis"]])
        self.feet = {side: self._foot(data, side) for side in SIDES}

    def _named(self, *, bodies: bool) -> list[tuple[str, str]]:
        return [(k, v) for k, v in self.names.items() if (k in _BODIES) == bodies]

    def _foot(self, data: mujoco.MjData, side: str) -> Foot:
        model = self.model
        mine = {
            self.bodies[f"{side}_{part}"]
            for part in ("foot", "toe")
            if f"{side}_{part}" in self.bodies
        }
        geoms = sole_geoms(model)
        soles = geoms[np.isin(model.geom_bodyid[geoms], list(mine))]
        if len(soles) < 2:
            raise ModelError(f"the {side} foot of this body has no soles on the floor")
        points = sole_points(model, data, soles) - self.at_rest[f"{side}_ankle"]
        level = float(points[:, 2].min())
        low = points[:, 2] < level + 1e-3
        flat = points[low]
        middle = float(flat[:, 1].mean())
        heel = np.array([flat[:, 0].min(), middle, level])
        tip = np.array([flat[:, 0].max(), middle, level])
        toe = self.bodies.get(f"{side}_toe")
        ball = tip.copy()
        if toe is not None:
            ball[0] = data.xpos[toe][0] - self.at_rest[f"{side}_ankle"][0]
        return Foot(soles[low], flat[:, 0], ball, heel, tip)

    @property
    def segments(self) -> dict[str, tuple[int, int, float]]:
        """Sites at both ends of the segments that it has, and their lengths, m."""
        found = {}
        for segment, (start, end) in SEGMENTS.items():
            if start in self.sites and end in self.sites:
                length = float(np.linalg.norm(self.at_rest[end] - self.at_rest[start]))
                found[segment] = (self.sites[start], self.sites[end], length)
        return found

    @property
    def leg(self) -> float:
        """Hip to ankle along the bones, m."""
        segments = self.segments
        return segments["left_thigh"][2] + segments["left_shank"][2]

    def soles_of(self, side: str) -> dict[int, NDArray[np.int64]]:
        """Soles of a foot under its ball, its heel and its tip (`BALL`, `HEEL`, `TIP`)."""
        foot = self.feet[side]
        return {
            BALL: foot.soles[np.abs(foot.along - foot.ball[0]) < _NEAR],
            HEEL: foot.soles[foot.along < foot.heel[0] + _NEAR],
            TIP: foot.soles[foot.along > foot.tip[0] - _NEAR],
        }

    def hip(self, side: str) -> Array:
        """A hip joint from the pelvis' place, in the upright frame, (3,), m."""
        return np.asarray(self.at_rest[f"{side}_hip"] - self.pelvis)
