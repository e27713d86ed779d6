"""Joints and frames of a body that wears markers."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from enpointe.errors import MotionError
from enpointe.models.anatomy import SIDES, side_sign
from enpointe.motion.formats.markers import MarkerMotion
from enpointe.motion.retargeting.joint_map import JointMap
from enpointe.motion.retargeting.landmarks import NEEDED

__all__ = ["marker_body"]

Array = NDArray[np.float64]
_HIP = np.array([-0.19, 0.36, -0.30])
"""Hip joint from the middle of the front spines, in shares of their distance, forward, to its own
side and up: Bell, Pedersen & Brand, J. Biomech. 23(6), 1990, p. 617 (14 % in from the spine)."""
_TILT = np.radians(12.0)
"""How far the plane of the iliac spines slopes down to the front in a person who stands."""
_KNEE, _ANKLE, _SHOULDER = 0.055, 0.038, 0.04
"""m: half the breadth of knee and ankle with half a marker, and a shoulder joint below its marker:
where only the outer side wears one."""
_LONGEST_GAP = 0.25
"""A marker unseen for longer than this, s, is worth a warning."""


def marker_body(
    motion: MarkerMotion, mapping: JointMap
) -> tuple[dict[str, Array], dict[str, Array], tuple[str, ...]]:
    """Landmarks (T, 3), m, frames (T, 3, 3), and warnings.

    Raises:
        MotionError: A needed marker is never seen.
    """
    seen = _Markers(motion)
    points = {}
    for landmark, names in mapping.points.items():
        found = [place for place in map(seen.place, names) if place is not None]
        if found:
            points[landmark] = np.mean(found, axis=0)
        elif landmark in NEEDED or landmark.endswith(("front_hip", "back_hip")):
            raise MotionError(f"marker {', '.join(names)} ({landmark}) is never seen")
    frames: dict[str, Array] = {}
    pelvis = _pelvis(points)
    if pelvis is not None:
        frames["pelvis"], hips = pelvis
        points = {**hips, **points}
        points["pelvis"] = 0.5 * (points["left_hip"] + points["right_hip"])
    _add_trunk(points, frames)
    for side in SIDES:
        _inwards(points, mapping, side)
        frames[f"{side}_foot"] = _foot(points, side)
    return points, frames, seen.warnings()


class _Markers:
    """Markers in our space, with what was not seen filled in."""

    def __init__(self, motion: MarkerMotion) -> None:
        self._motion = motion
        self._places = motion.space.points(motion.positions)
        self._gaps: list[str] = []

    def place(self, name: str) -> Array | None:
        """(T, 3), m, straight over gaps; None where it is never seen."""
        index = self._motion.names.index(name)
        place = self._places[:, index].copy()
        seen = self._motion.seen[:, index]
        if not seen.any():
            return None
        if not seen.all():
            frames = np.arange(len(place))
            for axis in range(3):
                place[~seen, axis] = np.interp(frames[~seen], frames[seen], place[seen, axis])
            longest = int(np.diff(np.flatnonzero(np.concatenate([[True], seen, [True]]))).max()) - 1
            if longest > _LONGEST_GAP * self._motion.rate:
                self._gaps.append(f"{name} ({longest} frames)")
        return place

    def warnings(self) -> tuple[str, ...]:
        if not self._gaps:
            return ()
        return (f"unseen for long, and led straight over: {', '.join(self._gaps)}",)


def _pelvis(points: Mapping[str, Array]) -> tuple[Array, dict[str, Array]] | None:
    """The pelvis' frame and the hip joints, from the iliac spines."""
    if "left_front_hip" not in points or "right_front_hip" not in points:
        return None
    front = 0.5 * (points["left_front_hip"] + points["right_front_hip"])
    if "sacrum" in points:
        back = points["sacrum"]
    else:
        back = 0.5 * (points["left_back_hip"] + points["right_back_hip"])
    across = points["left_front_hip"] - points["right_front_hip"]
    sloping = _axes(forward=front - back, left=across)
    width = float(np.median(np.linalg.norm(across, axis=1)))
    hips = {}
    for side in SIDES:
        place = _HIP * [1.0, side_sign(side), 1.0] * width
        hips[f"{side}_hip"] = front + sloping @ place
    c, s = np.cos(_TILT), np.sin(_TILT)
    level = np.array([[c, 0.0, -s], [0.0, 1.0, 0.0], [s, 0.0, c]])
    return sloping @ level, hips


def _add_trunk(points: dict[str, Array], frames: dict[str, Array]) -> None:
    top = [points[name] for name in ("chest_front", "chest_back") if name in points]
    low = [points[name] for name in ("sternum", "back") if name in points]
    hips = 0.5 * (points["left_hip"] + points["right_hip"])
    if top and "left_shoulder" in points and "right_shoulder" in points:
        neck = np.mean(top, axis=0)
        points["neck"] = neck
        below = np.mean(low, axis=0) if len(low) == 2 == len(top) else hips
        across = points["left_shoulder"] - points["right_shoulder"]
        frames["torso"] = _axes(up=neck - below, left=across)
        for side in SIDES:
            points[f"{side}_shoulder"] = points[f"{side}_shoulder"] - (
                _SHOULDER * frames["torso"][:, :, 2]
            )
    heads = [f"{side}_{end}_head" for side in SIDES for end in ("front", "back")]
    if all(name in points for name in heads):
        left_front, left_back, right_front, right_back = (points[name] for name in heads)
        forward = left_front + right_front - left_back - right_back
        across = left_front + left_back - right_front - right_back
        frames["head"] = _axes(forward=forward, left=across)
        points["head"] = 0.25 * (left_front + left_back + right_front + right_back)


def _inwards(points: dict[str, Array], mapping: JointMap, side: str) -> None:
    """Knee and ankle from markers on their outer sides alone.

    Both hinges lie across the plane of shank and foot, turned out or not.
    """
    knee, ankle, toe = (points[f"{side}_{name}"] for name in ("knee", "ankle", "toe"))
    across = np.cross(knee - ankle, toe - ankle)
    across /= np.maximum(np.linalg.norm(across, axis=1, keepdims=True), 1e-9)
    for name, half in (("knee", _KNEE), ("ankle", _ANKLE)):
        landmark = f"{side}_{name}"
        if len(mapping.points.get(landmark, ())) == 1:
            points[landmark] = points[landmark] - side_sign(side) * half * across


def _foot(points: Mapping[str, Array], side: str) -> Array:
    """Flat where heel and toe joint are at one height, or, without a heel, at its lowest."""
    knee, ankle, toe = (points[f"{side}_{name}"] for name in ("knee", "ankle", "toe"))
    along = toe - points.get(f"{side}_heel", ankle)
    return _axes(forward=along, left=np.cross(knee - ankle, along))


def _axes(*, left: Array, forward: Array | None = None, up: Array | None = None) -> Array:
    """(T, 3, 3) with columns forward, left and up: the one given kept, left made square to it."""
    main = forward if forward is not None else up
    assert main is not None
    main = main / np.linalg.norm(main, axis=1, keepdims=True)
    across = left - np.sum(left * main, axis=1, keepdims=True) * main
    across /= np.maximum(np.linalg.norm(across, axis=1, keepdims=True), 1e-9)
    if forward is not None:
        return np.stack([main, across, np.cross(main, across)], axis=2)
    return np.stack([np.cross(across, main), across, main], axis=2)
