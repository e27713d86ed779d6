"""Shortest rotations from pose to pose at constant speed: what Cal3D did, and our baseline.

Each joint turns by spherical linear interpolation of its whole rotation (Shoemake 1985), a chain of
hinges at one point counting as one joint. The root travels in a straight line.
"""

from __future__ import annotations

from functools import lru_cache

import mujoco
import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation, Slerp

__all__ = ["joint_chains", "slerp_poses"]

Array = NDArray[np.float64]


def slerp_poses(model: mujoco.MjModel, start: Array, end: Array, share: Array) -> Array:
    """Poses between two configurations.

    Args:
        model: Free root and hinges.
        start: (nq,).
        end: (nq,).
        share: (S,) in [0, 1].

    Returns:
        (S, nq).
    """
    share = np.asarray(share, dtype=float)
    poses = (1 - share)[:, None] * start + share[:, None] * end
    root = Rotation.from_quat(np.array([start[3:7], end[3:7]]), scalar_first=True)
    poses[:, 3:7] = Slerp([0.0, 1.0], root)(share).as_quat(scalar_first=True)
    for addresses, axes in joint_chains(model):
        if len(addresses) == 3:
            poses[:, addresses] = _slerp_chain(axes, start[addresses], end[addresses], share)
    return poses


def _slerp_chain(axes: Array, start: Array, end: Array, share: Array) -> Array:
    ends = Rotation.from_davenport(axes, "intrinsic", np.array([start, end]))
    turned = Slerp([0.0, 1.0], ends)(share)
    angles: Array = np.asarray(turned.as_davenport(axes, "intrinsic"))
    # The decomposition knows angles up to full turns; keep near the straight line between ends.
    line = (1 - share)[:, None] * start + share[:, None] * end
    return np.asarray(angles + 2 * np.pi * np.round((line - angles) / (2 * np.pi)))


@lru_cache(maxsize=4)
def joint_chains(model: mujoco.MjModel) -> tuple[tuple[Array, Array], ...]:
    """Hinges that share a body: their qpos addresses (n,) and axes (n, 3), outermost first."""
    chains = []
    for body in range(1, model.nbody):
        first, count = int(model.body_jntadr[body]), int(model.body_jntnum[body])
        joints = [
            j
            for j in range(first, first + count)
            if model.jnt_type[j] == mujoco.mjtJoint.mjJNT_HINGE
        ]
        if joints:
            chains.append((np.array(model.jnt_qposadr[joints]), np.array(model.jnt_axis[joints])))
    return tuple(chains)
