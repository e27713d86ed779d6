"""All samples are posed together: nothing jumps, and what is asked is still met."""

from __future__ import annotations

from dataclasses import replace

import mujoco
import numpy as np

from enpointe.motion.retargeting import retarget

from .conftest import as_skeleton, step_sideways


def test_a_jerked_leg_does_not_whirl(model: mujoco.MjModel) -> None:
    """A captured thigh that turns about itself between two frames is led over, not followed."""
    motion = step_sideways(model, 1.5)
    turn = int(model.joint("left_hip_turn").qposadr[0])
    motion.qpos[len(motion.time) // 2 :, turn] += np.radians(80.0)
    made = retarget(as_skeleton(motion), model)
    assert np.abs(made.motion.qvel[:, 6:]).max() < 25.0


def test_noise_is_not_danced(model: mujoco.MjModel) -> None:
    """Joints that shake by 1.5 degrees at random: a third of the acceleration is left at most."""
    motion = step_sideways(model, 1.5)
    rng = np.random.default_rng(1)
    noise = np.radians(1.5) * rng.standard_normal(motion.qpos[:, 7:].shape)
    shaken = motion.qpos.copy()
    shaken[:, 7:] += noise
    trembling = np.sqrt((np.diff(shaken[:, 7:], n=2, axis=0) ** 2).mean())
    motion.qpos[:] = shaken
    made = retarget(as_skeleton(motion), model)
    left = np.sqrt((np.diff(made.motion.qpos[:, 7:], n=2, axis=0) ** 2).mean())
    assert left < trembling / 3.0


def test_a_long_movement_is_the_same_through_its_windows(model: mujoco.MjModel) -> None:
    """Twice the same: what is solved in two windows is solved alike."""
    motion = step_sideways(model, 2.0)
    once = as_skeleton(motion)
    values = np.vstack([once.values, once.values[1:]])
    qpos = retarget(replace(once, values=values), model).motion.qpos
    count = len(once.values) - 1
    middle = slice(count // 2, count - 30)
    off = qpos[middle.start + count : middle.stop + count, 7:] - qpos[middle, 7:]
    assert np.abs(off).max() < np.radians(1.0)
