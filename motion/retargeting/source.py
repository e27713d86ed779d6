"""A captured body as landmarks and frames in metres, z up, whatever it was captured as."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from enpointe.errors import MotionError
from enpointe.models.anatomy import SIDES
from enpointe.motion.formats.content import Payload
from enpointe.motion.formats.markers import MarkerMotion
from enpointe.motion.formats.skeleton import SkeletonMotion
from enpointe.motion.retargeting.directions import unit
from enpointe.motion.retargeting.joint_map import END, JointMap
from enpointe.motion.retargeting.marker_body import marker_body

__all__ = ["Source", "source_of"]

Array = NDArray[np.float64]
_UP = np.array([0.0, 0.0, 1.0])
_UPRIGHT = np.cos(np.radians(35.0))
"""A rest pose whose trunk and legs are nearer to the vertical than this says what upright is."""
_LOW, _STILL = 10.0, 0.2
"""Per cent of the samples in which an ankle is lowest, and a speed, m/s: a foot is flat there."""
_BENT = np.radians(12.0)
"""A trunk that is bent by more than this against its pelvis at most times is not: the frame is."""
_FLAT_FOOT = 0.3
"""A foot whose toes are ahead of its ankle by this share of its length at rest is flat there."""


@dataclass(frozen=True)
class Source:
    """A body in motion.

    Attributes:
        time: (T,), s.
        points: Landmarks, each (T, 3), m, z up.
        frames: Pelvis, torso, head and feet, each (T, 3, 3): the identity is upright, facing x.
        warnings: What was doubtful and how it was taken.
    """

    time: Array
    points: Mapping[str, Array]
    frames: Mapping[str, Array]
    warnings: tuple[str, ...] = ()

    @property
    def rate(self) -> float:
        """Samples per second."""
        return 1.0 / float(self.time[1])


def source_of(motion: Payload, mapping: JointMap) -> Source:
    """Landmarks and frames of a movement.

    Raises:
        MotionError: Fewer than two frames, a landmark that is never seen, a gesture scene.
    """
    if not isinstance(motion, SkeletonMotion | MarkerMotion):
        raise MotionError("a gesture scene has no skeleton and no markers to retarget")
    if motion.frames < 2:
        raise MotionError(f"a movement needs two frames at least, and this has {motion.frames}")
    if isinstance(motion, MarkerMotion):
        points, frames, warnings = marker_body(motion, mapping)
    else:
        points, frames, warnings = _skeleton_body(motion, mapping)
    frames, righted = _pelvis_righted(frames)
    time = np.arange(motion.frames) / motion.rate
    return Source(time, points, frames, (*warnings, *righted))


def _pelvis_righted(frames: dict[str, Array]) -> tuple[dict[str, Array], tuple[str, ...]]:
    """The pelvis set upright under the trunk, where it would be bent against it all the time.

    In skeletons fitted to markers the pelvis at rest is not that of anybody who stands: CMU's tips
    forward by 20 to 30 degrees when its dancer stands upright.
    """
    if "pelvis" not in frames or "torso" not in frames:
        return frames, ()
    pelvis = frames["pelvis"]
    above = np.median(np.einsum("tji,tj->ti", pelvis, frames["torso"][:, :, 2]), axis=0)
    bend = float(np.arctan2(above[0], above[2]))
    if abs(bend) < _BENT:
        return frames, ()
    upright = pelvis @ Rotation.from_euler("y", bend).as_matrix()
    line = f"the pelvis was {np.degrees(bend):+.0f} degrees off the trunk throughout; set upright"
    return {**frames, "pelvis": upright}, (line,)


def _skeleton_body(
    motion: SkeletonMotion, mapping: JointMap
) -> tuple[dict[str, Array], dict[str, Array], tuple[str, ...]]:
    moving = _Joints(motion)
    points = {
        landmark: np.mean([moving.point(name) for name in names], axis=0)
        for landmark, names in mapping.points.items()
    }
    resting = _Joints(_at_rest(motion))
    rest = {
        landmark: np.mean([resting.point(name)[0] for name in names], axis=0)
        for landmark, names in mapping.points.items()
    }
    upright = _is_upright(rest)
    warnings = () if upright else ("its rest pose does not stand; upright is guessed from it",)
    frames = {}
    for part, joint in mapping.frames.items():
        turn = moving.turn(joint)
        own = _upright_axes(part, rest) if upright else None
        if own is not None:
            local = resting.turn(joint)[0].T @ own
        else:
            local = _guessed_axes(part, turn, points, motion.rate)
        frames[part] = turn @ local
    return points, frames, warnings


class _Joints:
    """Joints of a movement in our space."""

    def __init__(self, motion: SkeletonMotion) -> None:
        places, turns = motion.world()
        self._skeleton = motion.skeleton
        self._places = motion.skeleton.space.points(places)
        self._turns = turns

    def point(self, name: str) -> Array:
        """(T, 3), m."""
        joint = self._skeleton.names.index(name.removesuffix(END))
        place = self._places[:, joint]
        if not name.endswith(END):
            return np.asarray(place)
        end = np.array(self._skeleton.joints[joint].ends[0])
        away = Rotation.from_quat(self._turns[:, joint], scalar_first=True).apply(end)
        return np.asarray(place + self._skeleton.space.points(away))

    def turn(self, name: str) -> Array:
        """(T, 3, 3), from the joint's frame to our world."""
        joint = self._skeleton.names.index(name)
        turn = Rotation.from_quat(self._turns[:, joint], scalar_first=True).as_matrix()
        return np.asarray(self._skeleton.space.to_ours @ turn)


def _at_rest(motion: SkeletonMotion) -> SkeletonMotion:
    """One frame in which all channels say nothing."""
    row = [
        joint.offset["XYZ".index(channel[0])]
        if channel.endswith("position") and motion.skeleton.positions_replace_offset
        else 0.0
        for joint in motion.skeleton.joints
        for channel in joint.channels
    ]
    return replace(motion, values=np.array([row]))


def _is_upright(rest: Mapping[str, Array]) -> bool:
    hips = 0.5 * (rest["left_hip"] + rest["right_hip"])
    above = next((rest[name] for name in ("head", "neck", "chest") if name in rest), None)
    lines = [] if above is None else [above - hips]
    for side in SIDES:
        leg = rest[f"{side}_hip"] - rest[f"{side}_ankle"]
        # Legs astride are upright too.
        lines.append(leg * [1.0, 0.0, 1.0])
    across = rest["left_hip"] - rest["right_hip"]
    level = abs(across[2]) < 0.5 * float(np.linalg.norm(across))
    return level and all(line[2] > _UPRIGHT * float(np.linalg.norm(line)) for line in lines)


def _upright_axes(part: str, rest: Mapping[str, Array]) -> Array | None:
    """Forward, left and up of a part at rest, as columns; None where a foot is not flat there."""
    across = rest["left_hip"] - rest["right_hip"]
    forward = np.cross(across, _UP)
    if part.endswith("_foot"):
        side = part.removesuffix("_foot")
        foot = rest[f"{side}_toe"] - rest[f"{side}_ankle"]
        if np.hypot(*foot[:2]) < _FLAT_FOOT * np.linalg.norm(foot) or foot[2] > 0:
            return None
        forward = foot * [1.0, 1.0, 0.0]
    forward /= np.linalg.norm(forward)
    return np.stack([forward, np.cross(_UP, forward), _UP], axis=1)


def _guessed_axes(part: str, turn: Array, points: Mapping[str, Array], rate: float) -> Array:
    """The same from the movement: on average a trunk is straight, and a low, still foot flat."""

    def local(vectors: Array) -> Array:
        return np.asarray(np.median(np.einsum("tji,tj->ti", turn, vectors), axis=0))

    hips = 0.5 * (points["left_hip"] + points["right_hip"])
    if part.endswith("_foot"):
        ankle = points[f"{part.removesuffix('_foot')}_ankle"]
        flat = flat_samples(ankle, rate)
        up = np.median(np.einsum("tji,j->ti", turn[flat], _UP), axis=0)
        forward = local(points[part.replace("foot", "toe")] - ankle)
        left = np.cross(up, forward)
    else:
        top = next((points[name] for name in ("neck", "chest", "head") if name in points), None)
        if top is None:
            top = 0.5 * (points["left_shoulder"] + points["right_shoulder"])
        up = local(unit(top - hips))
        pair = "hip" if part == "pelvis" or "left_shoulder" not in points else "shoulder"
        left = local(points[f"left_{pair}"] - points[f"right_{pair}"])
    up = up / np.linalg.norm(up)
    left = left - (left @ up) * up
    left /= np.linalg.norm(left)
    return np.stack([np.cross(left, up), left, up], axis=1)


def flat_samples(ankle: Array, rate: float) -> NDArray[np.bool_]:
    """(T,), when an ankle is low and at rest."""
    speed = np.linalg.norm(np.gradient(ankle, 1.0 / rate, axis=0), axis=1)
    low = ankle[:, 2] <= np.percentile(ankle[:, 2], _LOW)
    still = low & (speed < _STILL)
    return still if still.any() else low
