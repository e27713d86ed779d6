"""Skeletons to test with: any that there can be, and the files of the document's chapter."""

from __future__ import annotations

import random
from pathlib import Path
from typing import Literal

import numpy as np
from scipy.spatial.transform import Rotation

from enpointe.motion.formats import Joint, Skeleton, SkeletonMotion, Space, write

AXES = "XYZ"


def made(seed: int, frames: int = 4, joints: int = 7) -> SkeletonMotion:
    """Joints that hang anyhow, with any channels, orders, axes and frames at rest."""
    dice = random.Random(seed)
    replaces = dice.random() < 0.5
    chain = [_joint(dice, index, replaces) for index in range(dice.randint(1, joints))]
    up: Literal["x", "y", "z"] = dice.choice(["x", "y", "z"])
    unit = dice.choice([1.0, 0.01, 0.0254, 0.0254 / 0.45, 0.3])
    radians = dice.choice([1.0, np.pi / 180])
    space = Space(unit, up, radians)
    skeleton = Skeleton(tuple(chain), space, positions_replace_offset=replaces)
    values = np.random.default_rng(seed).normal(size=(frames, skeleton.width)) * 90
    return SkeletonMotion(skeleton, dice.choice([30.0, 120.0, 59.94]), values)


def _joint(dice: random.Random, index: int, replaces: bool) -> Joint:
    parent = dice.randint(-1 if dice.random() < 0.1 else 0, index - 1) if index else -1
    places = dice.sample(AXES, dice.choice([0, 0, 3]) if index else 3)
    turns = dice.sample(AXES, dice.choice([0, 1, 2, 3, 3, 3]))
    channels = [f"{axis}position" for axis in places] + [f"{axis}rotation" for axis in turns]
    dice.shuffle(channels)
    order = "".join(dice.sample(turns, len(turns))) if dice.random() < 0.5 else ""
    return Joint(
        f"joint{index}",
        parent,
        _vector(dice),
        tuple(channels),
        order,
        _quaternion(dice),
        _quaternion(dice),
        tuple(_vector(dice) for _ in range(dice.choice([0, 0, 1, 2]))),
    )


def _vector(dice: random.Random) -> tuple[float, float, float]:
    if dice.random() < 0.2:
        return (0.0, 0.0, 0.0)
    return dice.uniform(-3, 3), dice.uniform(-3, 3), dice.uniform(-3, 3)


def _quaternion(dice: random.Random) -> tuple[float, float, float, float]:
    if dice.random() < 0.5:
        return (1.0, 0.0, 0.0, 0.0)
    turn = Rotation.from_rotvec([dice.uniform(-2, 2) for _ in AXES])
    w, x, y, z = turn.as_quat(scalar_first=True)
    return float(w), float(x), float(y), float(z)


def small(folder: Path) -> dict[str, Path]:
    """One small file of each format, by its suffix, written by us."""
    folder.mkdir(parents=True, exist_ok=True)
    files = {}
    for suffix in (".bvh", ".ask", ".amc", ".bva", ".htr", ".gtr"):
        files[suffix] = folder / f"small{suffix}"
        write(made(3, frames=3, joints=5), files[suffix])
    files[".asf"] = folder / "small.asf"
    return files


BVA_DOCUMENT = """
Segment: Hips
Frames: 2
Frame Time: 0.033333
XTRAN YTRAN ZTRAN XROT YROT ZROT XSCALE YSCALE ZSCALE
INCCHES INCCHES INCCHES DEGREES DEGREES DEGREES INCCHES INCCHES INCCHES
 8.03 35.01 88.36 14.78 -164.35 -3.41 5.21 5.21 5.21
 7.81 35.10 86.47 12.94 -166.97 -3.78 5.21 5.21 5.21
Segment: Chest
Frames: 2
Frame Time: 0.033333
XTRAN YTRAN ZTRAN XROT YROT ZROT XSCALE YSCALE ZSCALE
INCCHES INCCHES INCCHES DEGREES DEGREES DEGREES INCCHES INCCHES INCCHES
 8.33 40.04 89.69 -27.24 175.94 -2.88 18.65 18.65 18.65
 8.15 40.16 87.63 -31.12 175.58 -4.08 18.65 18.65 18.65
"""
"""ENACTIVE D.RD3.3.1 section 2.2.2, as printed."""

BVH_DOCUMENT = """HIERARCHY
ROOT Hips
{
  OFFSET 0.00 0.00 0.00
  CHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation Yrotation
  JOINT Chest
  {
    OFFSET 0.00 5.21 0.00
    CHANNELS 3 Zrotation Xrotation Yrotation
    JOINT Neck
    {
      OFFSET 0.00 18.65 0.00
      End Site
      {
        OFFSET 0.00 5.45 0.00
      }
    }
  }
}
MOTION
Frames: 2
Frame Time: 0.033333
8.03 35.01 88.36 -3.41 14.78 -164.35 13.09 40.30 -24.60
7.81 35.10 86.47 -3.78 12.94 -166.97 12.64 42.57 -22.34
"""
"""The beginning of section 2.2.5, with the brace in its place."""

HTR_DOCUMENT = """[Header] # Header keywords are followed by a single value
FileType htr # single word string
DataType HTRS # Hierarchical translations followed by rotations and Scale
FileVersion      1          # integer
NumSegments     3         # integer
NumFrames       2          # integer
DataFrameRate   30         # integer
EulerRotationOrder ZYX      # one word string
CalibrationUnits mm        # one word string
RotationUnits   Degrees    # one word string
GlobalAxisofGravity Y        # character, X or Y or Z
BoneLengthAxis Y

[SegmentNames&Hierarchy]
#CHILD PARENT
LOWERTORSO    GLOBAL
UPPERTORSO    LOWERTORSO
RTHIGH         LOWERTORSO
[BasePosition]
#SegmentName Tx, Ty, Tz, Rx, Ry, Rz, BoneLength
LOWERTORSO   0.00   0.00   0.00   0.00   0.00   0.00   200.00
UPPERTORSO   0.00 200.00   0.00  -1.38   0.00   0.35   286.95
RTHIGH         -96.49 -31.41  26.89  -6.15   0.00  176.17  379.17
[LOWERTORSO]
 1 263.72   816.20 -2874.77  18.03  -7.70  -10.34   1.00
 2 264.42   812.41 -2740.34  19.81  -13.46  -11.93   1.00
[UPPERTORSO]
 1 0.00     0.00   0.00   8.33  -17.38   8.59   1.00
 2 0.00     0.00   0.00   8.71  -6.14   8.64   1.00
[RTHIGH]
 1 0.00     0.00   0.00   0.00  0.00   0.00   1.00
 2 0.00     0.00   0.00   0.00  0.00   0.00   1.00
[EndOfFile]
"""
"""Section 2.8.2, three of its eighteen segments."""
