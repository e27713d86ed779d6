"""The baseline turns every joint by the shortest way at constant speed, and does nothing else."""

from __future__ import annotations

import mujoco
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation, Slerp

from enpointe.motion.slerp import joint_chains, slerp_poses

from .dancing import solver

Array = NDArray[np.float64]
MODEL = solver().model
seeds = st.integers(0, 2**32 - 1)
few = settings(max_examples=25)


def random_pose(rng: np.random.Generator) -> Array:
    """Any configuration within the joints' ranges, short of the singular middle of a chain."""
    low, high = MODEL.jnt_range[1:].T
    root = np.concatenate([rng.uniform(-1, 1, 3), rng.normal(size=4)])
    root[3:] /= np.linalg.norm(root[3:])
    return np.concatenate([root, rng.uniform(np.clip(low, -1.4, 0), np.clip(high, 0, 1.4))])


def turned(qpos: Array) -> Array:
    """Rotation of every body against its parent, (nbody, 3, 3), as MuJoCo's kinematics has it."""
    data = mujoco.MjData(MODEL)
    data.qpos[:] = qpos
    mujoco.mj_kinematics(MODEL, data)
    world = data.xmat.reshape(-1, 3, 3)
    local: Array = np.einsum("bji,bjk->bik", world[MODEL.body_parentid], world)
    return local


@few
@given(seeds)
def test_every_joint_turns_as_scipy_slerps_its_whole_rotation(seed: int) -> None:
    rng = np.random.default_rng(seed)
    start, end, share = random_pose(rng), random_pose(rng), rng.uniform(0, 1, 3)
    ends = np.stack([turned(start), turned(end)])
    for s, pose in zip(share, slerp_poses(MODEL, start, end, share), strict=True):
        now = turned(pose)
        for body in range(1, MODEL.nbody):
            if MODEL.body_jntnum[body] == 2:
                continue
            wanted = Slerp([0, 1], Rotation.from_matrix(ends[:, body]))(s).as_matrix()
            np.testing.assert_allclose(now[body], wanted, atol=1e-9)


@few
@given(seeds)
def test_it_begins_and_ends_in_the_poses(seed: int) -> None:
    rng = np.random.default_rng(seed)
    start, end = random_pose(rng), random_pose(rng)
    first, last = slerp_poses(MODEL, start, end, np.array([0.0, 1.0]))
    for pose, wanted in ((first, start), (last, end)):
        np.testing.assert_allclose(turned(pose), turned(wanted), atol=1e-9)
        np.testing.assert_allclose(pose[:3], wanted[:3], atol=1e-12)


@few
@given(seeds)
def test_angular_speed_is_constant(seed: int) -> None:
    rng = np.random.default_rng(seed)
    start, end = random_pose(rng), random_pose(rng)
    rotations = np.stack([turned(p) for p in slerp_poses(MODEL, start, end, np.linspace(0, 1, 7))])
    for body in range(1, MODEL.nbody):
        if MODEL.body_jntnum[body] == 2:
            continue
        row = Rotation.from_matrix(rotations[:, body])
        angles = (row[:-1].inv() * row[1:]).magnitude()
        np.testing.assert_allclose(angles, angles.mean(), atol=1e-8)


@few
@given(seeds)
def test_a_single_hinge_and_the_root_travel_in_a_straight_line(seed: int) -> None:
    rng = np.random.default_rng(seed)
    start, end, share = random_pose(rng), random_pose(rng), rng.uniform(0, 1, 4)
    poses = slerp_poses(MODEL, start, end, share)
    single = [int(a[0]) for a, _ in joint_chains(MODEL) if len(a) == 1]
    straight = [0, 1, 2, *single]
    line = start[straight] + share[:, None] * (end - start)[straight]
    np.testing.assert_allclose(poses[:, straight], line, atol=1e-12)


def test_small_steps_of_a_dance_stay_small() -> None:
    """No jump between equal rotations with different angles."""
    rng = np.random.default_rng(7)
    start, end = random_pose(rng), random_pose(rng)
    poses = slerp_poses(MODEL, start, end, np.linspace(0, 1, 400))
    assert np.abs(np.diff(poses, axis=0)).max() < 0.1


def test_chains_cover_every_hinge_once() -> None:
    addresses = np.concatenate([a for a, _ in joint_chains(MODEL)])
    assert sorted(addresses) == list(range(7, MODEL.nq))
    assert {len(a) for a, _ in joint_chains(MODEL)} <= {1, 2, 3}


@pytest.mark.parametrize("joint", ["left_shoulder", "right_shoulder", "left_hip", "right_hip"])
def test_ball_joints_are_chains_of_three(joint: str) -> None:
    chain = [a for a, _ in joint_chains(MODEL) if len(a) == 3]
    body = {"shoulder": "upper_arm", "hip": "thigh"}[joint.split("_")[1]]
    first = MODEL.body_jntadr[MODEL.body(f"{joint.split('_')[0]}_{body}").id]
    assert any(MODEL.jnt_qposadr[first] == addresses[0] for addresses in chain)
