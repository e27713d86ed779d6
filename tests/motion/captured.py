"""A captured dancer's joints from ASF and AMC files: as much of the format as the tests need.

A bone turns by its angles about axes of its own (`axis`), from its parent's turn on, and ends at
its length along its direction so turned. Angles are in degrees, the turns of an XYZ order about x
first; lengths are inches over `length`; y is up, z forward and x to the left.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from enpointe.models.joints import Joints

Vector = NDArray[np.float64]
TO_OURS = np.array([[0.0, 0.0, 1.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]])
RATE = 120.0
"""Frames a second of CMU's captures, which their files do not say."""
INCH = 0.0254
_ENDS = {
    "hip": "hipjoint",
    "knee": "femur",
    "ankle": "tibia",
    "ball": "foot",
    "toe_tip": "toes",
    "shoulder": "clavicle",
    "elbow": "humerus",
    "wrist": "radius",
}
_ANGLES = {"rx": 0, "ry": 1, "rz": 2}


@dataclass(frozen=True)
class Bone:
    offset: Vector
    axis: Rotation
    angles: tuple[int, ...]


@dataclass(frozen=True)
class Skeleton:
    bones: Mapping[str, Bone]
    parents: Mapping[str, str]

    @classmethod
    def read(cls, path: Path) -> Skeleton:
        words = [line.split() for line in path.read_text().splitlines() if line.strip()]
        unit = next(float(w[1]) for w in words if w[0] == "length")
        bones: dict[str, Bone] = {}
        parents: dict[str, str] = {}
        name, direction, length = "", np.zeros(3), 0.0
        section = ""
        for word in words:
            if word[0].startswith(":"):
                section = word[0]
            elif section == ":hierarchy" and len(word) > 1:
                parents |= dict.fromkeys(word[1:], word[0])
            elif section == ":bonedata" and word[0] == "name":
                name = word[1]
            elif section == ":bonedata" and word[0] == "direction":
                direction = np.array(word[1:4], dtype=float)
            elif section == ":bonedata" and word[0] == "length":
                length = float(word[1]) * INCH / unit
            elif section == ":bonedata" and word[0] == "axis":
                axis = Rotation.from_euler("xyz", [float(w) for w in word[1:4]], degrees=True)
                bones[name] = Bone(length * direction, axis, ())
            elif section == ":bonedata" and word[0] == "dof":
                angles = tuple(_ANGLES[w] for w in word[1:])
                bones[name] = Bone(bones[name].offset, bones[name].axis, angles)
        return cls(bones, parents)

    def joints(self, frame: Mapping[str, list[float]], unit: float, leg: float) -> Joints:
        """The joints of one frame, scaled so that her legs are as long as `leg`, m."""
        root = frame["root"]
        turns = {"root": Rotation.from_euler("xyz", root[3:], degrees=True)}
        ends = {"root": np.array(root[:3]) * INCH / unit}
        for name, parent in self.parents.items():
            bone = self.bones[name]
            angles = np.zeros(3)
            angles[list(bone.angles)] = frame.get(name, [0.0] * len(bone.angles))
            turn = Rotation.from_euler("xyz", angles, degrees=True)
            turns[name] = turns[parent] * bone.axis * turn * bone.axis.inv()
            ends[name] = ends[parent] + turns[name].apply(bone.offset)
        points: dict[str, Vector] = {}
        for side, s in (("left", "l"), ("right", "r")):
            points |= {f"{side}_{joint}": ends[s + bone] for joint, bone in _ENDS.items()}
            # The sole is as far below the ankle as the ball of the foot at rest.
            forward = self.bones[f"{s}foot"].offset
            heel = forward * [-0.3, 1.0, -0.3]
            points[f"{side}_heel"] = ends[f"{s}tibia"] + turns[f"{s}foot"].apply(heel)
        own = np.linalg.norm(self.bones["lfemur"].offset) + np.linalg.norm(
            self.bones["ltibia"].offset
        )
        scale = leg / own

        def ours(name: str) -> Vector:
            turned: Vector = TO_OURS @ turns[name].as_matrix() @ TO_OURS.T
            return turned

        return Joints(
            points={name: scale * (TO_OURS @ point) for name, point in points.items()},
            pelvis=ours("root"),
            torso=ours("thorax"),
            head=ours("head"),
            com=scale * TO_OURS @ (0.7 * ends["root"] + 0.3 * ends["thorax"]),
        )


def read_frames(path: Path) -> list[dict[str, list[float]]]:
    """What each bone's angles are, frame by frame."""
    frames: list[dict[str, list[float]]] = []
    for line in path.read_text().splitlines():
        word = line.split()
        if len(word) == 1 and word[0].isdigit():
            frames.append({})
        elif frames and word:
            frames[-1][word[0]] = [float(w) for w in word[1:]]
    return frames


def captured(folder: Path, take: str, leg: float, every: int = 12) -> dict[float, Joints]:
    """The joints of a take by time, s, one frame of `every`; its lowest toe is on the floor."""
    skeleton = Skeleton.read(folder / "05.asf")
    frames = read_frames(folder / f"{take}.amc")
    poses = {i / RATE: skeleton.joints(frames[i], 0.45, leg) for i in range(0, len(frames), every)}
    floor = min(float(np.quantile(_lows(poses), 0.05)), 10.0)
    return {time: _lowered(pose, floor) for time, pose in poses.items()}


def _lows(poses: Mapping[float, Joints]) -> list[float]:
    return [
        min(pose[f"{side}_{part}"][2] for side in ("left", "right") for part in ("ball", "toe_tip"))
        for pose in poses.values()
    ]


def _lowered(pose: Joints, floor: float) -> Joints:
    down = np.array([0.0, 0.0, floor])
    points = {name: point - down for name, point in pose.points.items()}
    return Joints(points, pose.pelvis, pose.torso, pose.head, pose.com - down)
