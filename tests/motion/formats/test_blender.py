"""What Blender makes of a BVH that we wrote; skipped where its package (bpy) is not installed."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from enpointe.motion.formats import write
from enpointe.motion.formats.of_dancer import skeleton_of_motion

from .movements import body_places, writhing

bpy = pytest.importorskip("bpy")

# Blender turns y up and z forward to z up and -y forward; ours is z up and x forward.
_TO_OURS = np.array([[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]])


def test_blender_has_the_joints_where_mujoco_has_the_bodies(tmp_path: Path) -> None:
    """At ten frames, every joint within a millimetre."""
    motion = writhing(frames=200)
    path = tmp_path / "writhing.bvh"
    write(skeleton_of_motion(motion)[0], path)
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.ops.import_anim.bvh(filepath=str(path), update_scene_fps=True, update_scene_duration=True)
    scene, armature = bpy.context.scene, bpy.context.object
    assert scene.render.fps / scene.render.fps_base == pytest.approx(100)
    places = body_places(motion)
    worst = 0.0
    for frame in np.linspace(0, len(motion.time) - 1, 10).astype(int):
        scene.frame_set(int(frame) + 1)
        for body in range(1, motion.model.nbody):
            bone = armature.pose.bones[motion.model.body(body).name]
            there = _TO_OURS @ np.array(armature.matrix_world @ bone.head)
            worst = max(worst, float(np.linalg.norm(there - places[frame, body - 1])))
    print(f"farthest: {1000 * worst:.6f} mm")
    assert worst < 1e-3
