"""Forward kinematics in CasADi, walked from a compiled `MjModel`.

The walk follows MuJoCo's own recursion (manual, "Computation", kinematics): a body starts at its
parent's frame moved by `body_pos` and `body_quat`, then each of its joints turns or slides it.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property

import casadi as ca
import mujoco
import numpy as np
from numpy.typing import NDArray

from enpointe.errors import ModelError

__all__ = [
    "Capsule",
    "Frame3",
    "Kinematics",
    "SymbolicBody",
    "angle_over_sine",
    "qpos_from_tangent",
    "rotation_of",
]


@dataclass(frozen=True, slots=True)
class Frame3:
    """A symbolic frame in the world: position (3, 1) in metres and rotation matrix (3, 3)."""

    position: ca.SX
    rotation: ca.SX

    def point(self, local: NDArray[np.float64] | ca.SX | list[float]) -> ca.SX:
        """A point given in this frame, in the world."""
        return self.position + self.rotation @ ca.SX(local)

    def to_local(self, point: ca.SX) -> ca.SX:
        """A point of the world, in this frame."""
        return self.rotation.T @ (point - self.position)


@dataclass(frozen=True, slots=True)
class Capsule:
    """A symbolic capsule in the world: the ends of its axis, (3, 1), and its radius, m."""

    start: ca.SX
    end: ca.SX
    radius: float


class SymbolicBody:
    """All body frames of a model as functions of one symbolic configuration.

    Args:
        model: Any model of free, ball, hinge and slide joints.
        qpos: Symbolic configuration, (nq, 1).
    """

    def __init__(self, model: mujoco.MjModel, qpos: ca.SX) -> None:
        self.model = model
        self.qpos = qpos
        self._frames = _walk(model, qpos)

    def frame(self, body: str) -> Frame3:
        """The frame of `body`. Raises `ModelError` for an unknown name."""
        return self._frames[_lookup(self.model, mujoco.mjtObj.mjOBJ_BODY, body)]

    def site(self, name: str) -> ca.SX:
        """World position (3, 1) of the site `name`, m."""
        index = _lookup(self.model, mujoco.mjtObj.mjOBJ_SITE, name)
        frame = self._frames[self.model.site_bodyid[index]]
        return frame.point(self.model.site_pos[index])

    def capsule(self, geom: str) -> Capsule:
        """The capsule geom of this name. Raises `ModelError` for no such geom or another shape."""
        index = _lookup(self.model, mujoco.mjtObj.mjOBJ_GEOM, geom)
        if self.model.geom_type[index] != mujoco.mjtGeom.mjGEOM_CAPSULE:
            raise ModelError(f"the geom {geom!r} is no capsule")
        frame = self._frames[int(self.model.geom_bodyid[index])]
        radius, half, _ = self.model.geom_size[index]
        matrix = np.zeros(9)
        mujoco.mju_quat2Mat(matrix, self.model.geom_quat[index])
        reach = half * matrix.reshape(3, 3)[:, 2]
        centre = self.model.geom_pos[index]
        return Capsule(frame.point(centre - reach), frame.point(centre + reach), float(radius))

    def has_geom(self, name: str) -> bool:
        """Whether the model has a geom of this name: not every dancer wears pointe shoes."""
        return bool(mujoco.mj_name2id(self.model, mujoco.mjtObj.mjOBJ_GEOM, name) >= 0)

    def lowest(self, geom: str) -> ca.SX:
        """Height of the lowest point of a sphere geom, m. Raises `ModelError` as `capsule`."""
        index = _lookup(self.model, mujoco.mjtObj.mjOBJ_GEOM, geom)
        if self.model.geom_type[index] != mujoco.mjtGeom.mjGEOM_SPHERE:
            raise ModelError(f"the geom {geom!r} is no sphere")
        frame = self._frames[int(self.model.geom_bodyid[index])]
        return frame.point(self.model.geom_pos[index])[2] - float(self.model.geom_size[index, 0])

    def joint(self, name: str) -> ca.SX:
        """The scalar coordinate of the hinge or slide `name`, rad or m."""
        index = _lookup(self.model, mujoco.mjtObj.mjOBJ_JOINT, name)
        return self.qpos[int(self.model.jnt_qposadr[index])]

    @cached_property
    def com(self) -> ca.SX:
        """Centre of mass of the whole model, (3, 1), m."""
        total = ca.SX.zeros(3)
        for i in range(1, self.model.nbody):
            total += self.model.body_mass[i] * self._frames[i].point(self.model.body_ipos[i])
        return total / float(self.model.body_mass[1:].sum())


class Kinematics:
    """The same, as compiled numeric functions of a numeric configuration."""

    def __init__(self, model: mujoco.MjModel) -> None:
        self.model = model
        qpos = ca.SX.sym("qpos", model.nq)
        body = SymbolicBody(model, qpos)
        names = [model.body(i).name for i in range(1, model.nbody)]
        frames = [body.frame(name) for name in names]
        self.bodies = tuple(names)
        self._poses = ca.Function(
            "poses",
            [qpos],
            [
                ca.horzcat(*(f.position for f in frames)),
                ca.horzcat(*(f.rotation for f in frames)),
                body.com,
            ],
            ["qpos"],
            ["positions", "rotations", "com"],
        )

    def poses(
        self, qpos: NDArray[np.float64]
    ) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]:
        """Positions (nbody - 1, 3), rotations (nbody - 1, 3, 3) and CoM (3,) at `qpos` (nq,)."""
        positions, rotations, com = self._poses(qpos)
        stacked = np.asarray(rotations).T.reshape(-1, 3, 3).transpose(0, 2, 1)
        return np.asarray(positions).T, stacked, np.asarray(com).ravel()


def qpos_from_tangent(model: mujoco.MjModel, tangent: ca.SX, facing: ca.SX | float = 0.0) -> ca.SX:
    """A configuration (nq, 1) from root position, root rotation vector and hinge angles (nv, 1).

    The rotation vector is about the upright that faces `facing` (rad), so that it stays small
    wherever the dancer faces.

    A rotation vector needs no unit-norm constraint, which would be active together with its
    bounds at the identity and stall an interior-point solver.

    Raises:
        ModelError: The model is not one free root followed by hinges and slides.
    """
    kinds = [int(k) for k in model.jnt_type]
    scalar = (int(mujoco.mjtJoint.mjJNT_HINGE), int(mujoco.mjtJoint.mjJNT_SLIDE))
    if (
        not kinds
        or kinds[0] != int(mujoco.mjtJoint.mjJNT_FREE)
        or any(k not in scalar for k in kinds[1:])
    ):
        raise ModelError(
            "the key-pose solver needs a model with one free root and hinges or slides"
        )
    vector = tangent[3:6]
    angle = ca.sqrt(ca.sumsqr(vector) + 1e-20)
    w, (x, y, z) = ca.cos(angle / 2), ca.vertsplit(ca.sin(angle / 2) / angle * vector)
    c, s = ca.cos(facing / 2), ca.sin(facing / 2)
    quaternion = ca.vertcat(c * w - s * z, c * x - s * y, c * y + s * x, c * z + s * w)
    return ca.vertcat(tangent[:3], quaternion, tangent[6:])


def angle_over_sine(square_of_sine: ca.SX, cosine: ca.SX) -> ca.SX:
    """a / sin a for an angle a in [0, pi), 1 at 0: what makes a cross product a rotation vector.

    The sine's square is padded by 1e-6, so that derivatives stay exact at 0.
    """
    sine = ca.sqrt(square_of_sine + 1e-6)
    return ca.atan2(sine, cosine) / sine


def rotation_of(quaternion: ca.SX) -> ca.SX:
    """Rotation matrix of a quaternion (w, x, y, z), normalised on the way as MuJoCo does."""
    q = quaternion / ca.sqrt(ca.sumsqr(quaternion))
    w, x, y, z = q[0], q[1], q[2], q[3]
    return ca.vertcat(
        ca.horzcat(1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)),
        ca.horzcat(2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)),
        ca.horzcat(2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)),
    )


def _walk(model: mujoco.MjModel, qpos: ca.SX) -> Mapping[int, Frame3]:
    frames = {0: Frame3(ca.SX.zeros(3), ca.SX.eye(3))}
    for body in range(1, model.nbody):
        parent = frames[int(model.body_parentid[body])]
        position = parent.point(model.body_pos[body])
        rotation = parent.rotation @ _constant_rotation(model.body_quat[body])
        first = int(model.body_jntadr[body])
        for joint in range(first, first + int(model.body_jntnum[body])):
            position, rotation = _apply_joint(model, joint, qpos, position, rotation)
        frames[body] = Frame3(position, rotation)
    return frames


def _apply_joint(
    model: mujoco.MjModel, joint: int, qpos: ca.SX, position: ca.SX, rotation: ca.SX
) -> tuple[ca.SX, ca.SX]:
    kind = int(model.jnt_type[joint])
    start = int(model.jnt_qposadr[joint])
    if kind == int(mujoco.mjtJoint.mjJNT_FREE):
        return qpos[start : start + 3], rotation_of(qpos[start + 3 : start + 7])
    anchor = model.jnt_pos[joint]
    axis = model.jnt_axis[joint]
    if kind == int(mujoco.mjtJoint.mjJNT_SLIDE):
        displacement = qpos[start] - model.qpos0[start]
        return position + rotation @ ca.SX(axis) * displacement, rotation
    pivot = position + rotation @ ca.SX(anchor)
    if kind == int(mujoco.mjtJoint.mjJNT_BALL):
        turned = rotation @ rotation_of(qpos[start : start + 4])
    else:
        turned = rotation @ _axis_rotation(axis, qpos[start] - model.qpos0[start])
    return pivot - turned @ ca.SX(anchor), turned


def _axis_rotation(axis: NDArray[np.float64], angle: ca.SX) -> ca.SX:
    """Rodrigues' formula with a constant axis: exact zeros keep the expression small."""
    x, y, z = (float(v) for v in axis)
    skew = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    sine, versine = ca.sin(angle), 1 - ca.cos(angle)
    return (
        ca.SX.eye(3) + sine * ca.sparsify(ca.DM(skew)) + versine * ca.sparsify(ca.DM(skew @ skew))
    )


def _constant_rotation(quaternion: NDArray[np.float64]) -> ca.DM:
    matrix = np.zeros(9)
    mujoco.mju_quat2Mat(matrix, quaternion)
    return ca.sparsify(ca.DM(matrix.reshape(3, 3)))


def _lookup(model: mujoco.MjModel, kind: mujoco.mjtObj, name: str) -> int:
    index = mujoco.mj_name2id(model, kind, name)
    if index < 0:
        what = kind.name.removeprefix("mjOBJ_").lower()
        raise ModelError(f"the model has no {what} called {name!r}")
    return int(index)
