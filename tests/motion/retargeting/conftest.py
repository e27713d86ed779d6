"""Captured bodies made from the dancer's own movement, so that what must come back is known."""

from __future__ import annotations

import mujoco
import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from enpointe.models import dancer_model
from enpointe.motion.formats import Joint, Skeleton, SkeletonMotion, Space
from enpointe.motion.formats.convert import angles_of
from enpointe.motion.motion import Motion

RATE = 60.0


@pytest.fixture(scope="session")
def model() -> mujoco.MjModel:
    return dancer_model(flesh=False)


def step_sideways(model: mujoco.MjModel, seconds: float = 3.0) -> Motion:
    """Arms, trunk and a raised leg over a foot that stands, then over the other."""
    time = np.arange(round(seconds * RATE) + 1) / RATE
    phase = 2 * np.pi * time / seconds
    qpos = np.tile(model.key("standing").qpos, (len(time), 1))

    def joint(name: str) -> int:
        return int(model.joint(name).qposadr[0])

    lift = np.clip(np.sin(phase), 0, 1) ** 2, np.clip(-np.sin(phase), 0, 1) ** 2
    for side, up in zip(("left", "right"), lift, strict=True):
        qpos[:, joint(f"{side}_hip_raise")] = 0.9 * up
        qpos[:, joint(f"{side}_knee_bend")] = 0.7 * up
        qpos[:, joint(f"{side}_ankle_point")] = 0.5 * up**2
        qpos[:, joint(f"{side}_shoulder_raise")] = 0.8 + 0.4 * np.sin(phase)
        qpos[:, joint(f"{side}_elbow_bend")] = 0.5 + 0.2 * np.cos(phase)
    qpos[:, joint("waist_turn")] = 0.2 * np.sin(phase)
    qpos[:, joint("neck_tilt")] = 0.2 * np.sin(2 * phase)
    return Motion.from_qpos(model, time, qpos)


_BODIES = {
    "Hips": ("pelvis", None),
    "Chest": ("torso", "Hips"),
    "Head": ("head", "Chest"),
    **{
        name: (f"{side}_{body}", parent)
        for side, letter in (("left", "Left"), ("right", "Right"))
        for name, body, parent in (
            (f"{letter}UpLeg", "thigh", "Hips"),
            (f"{letter}Leg", "shank", f"{letter}UpLeg"),
            (f"{letter}Foot", "foot", f"{letter}Leg"),
            (f"{letter}ToeBase", "toe", f"{letter}Foot"),
            (f"{letter}Arm", "upper_arm", "Chest"),
            (f"{letter}ForeArm", "forearm", f"{letter}Arm"),
            (f"{letter}Hand", "hand", f"{letter}ForeArm"),
        )
    },
}


def as_skeleton(
    motion: Motion, *, scale: float = 1.0, names: dict[str, str] | None = None
) -> SkeletonMotion:
    """The movement as a BVH's maker has it: centimetres, y up, bones `scale` times as long."""
    model, data = motion.model, mujoco.MjData(motion.model)
    back = Space(up="y").to_ours.T
    listed = list(_BODIES)
    places = np.empty((len(motion.time), len(listed), 3))
    turns = np.empty((len(motion.time), len(listed), 3, 3))
    for i, qpos in enumerate(motion.qpos):
        data.qpos[:] = qpos
        mujoco.mj_kinematics(model, data)
        for j, name in enumerate(listed):
            body = data.body(_BODIES[name][0])
            places[i, j] = scale * 100.0 * back @ body.xpos
            turns[i, j] = back @ np.array(body.xmat).reshape(3, 3) @ back.T
    joints, columns = [], []
    for j, name in enumerate(listed):
        over = _BODIES[name][1]
        parent = -1 if over is None else listed.index(over)
        above = turns[:, parent] if parent >= 0 else np.eye(3)
        offset = places[0, j] if parent < 0 else above[0].T @ (places[0, j] - places[0, parent])
        channels: tuple[str, ...] = ("Zrotation", "Xrotation", "Yrotation")
        angles = angles_of(Rotation.from_matrix(np.swapaxes(above, -1, -2) @ turns[:, j]), "ZXY")
        end = (0.0, -8.0, 0.0) if name.endswith("Hand") else (0.0, 0.0, 4.0)
        if parent < 0:
            channels = ("Xposition", "Yposition", "Zposition", *channels)
            columns.append(places[:, j])
        columns.append(np.degrees(angles))
        called = name if names is None else names[name]
        joints.append(Joint(called, parent, tuple(offset), channels, ends=(end,)))
    skeleton = Skeleton(tuple(joints), Space(0.01))
    return SkeletonMotion(skeleton, RATE, np.concatenate(columns, axis=1))
