"""What a movement asks of each joint and of the floor, split by what happens when it is slowed.

Inverse dynamics gives the generalised force b = M qacc + h(q, v) of a movement. Danced at a share s
of its speed it is  b = g(q) + s^2 d,  g the weight's and d all else (Hollerbach 1984), and the
floor's forces f at the soles that bear, which must give the root its six rows, are shared so that
they are split alike:

    f = f_static + s^2 f_dynamic,    f_. = A b_.[root],    torque_. = b_.[joints] - J^T f_.

with A the same for both: the least forces, each sole counted by the weight that it bears at rest.
What the floor can't give of them is told apart, as inequalities (`ground`).
"""

from __future__ import annotations

from dataclasses import dataclass

import mujoco
import numpy as np
from numpy.typing import NDArray
from scipy.optimize import nnls

from enpointe.controllers.plant import Plant
from enpointe.errors import MotionError
from enpointe.models.foot_positions import support_hull
from enpointe.models.soles import sole_points
from enpointe.motion import Motion
from enpointe.motion.contact_schedule import ContactSchedule, contact_schedule

__all__ = ["JointLoads", "Overlap", "joint_loads"]

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]
_UNLOADED = 0.01
"""Of the weight: what a sole counts that bears none at rest."""
_EVEN = 3e-3
"""Of two ways to bear the same weight, the more even one."""
_RANK = 1e-6


@dataclass(frozen=True, slots=True)
class Overlap:
    """Two bodies of the model in one another.

    Attributes:
        first: Name of a body.
        second: Name of the other.
        depth: (T,), m; 0 where they are apart.
    """

    first: str
    second: str
    depth: Array


@dataclass(frozen=True)
class JointLoads:
    """Loads along a movement of T samples on a body of J hinges.

    Attributes:
        time: (T,), s.
        joints: Names of the hinges, in the model's order.
        position: (T, J), rad.
        velocity: (T, J), rad/s.
        acceleration: (T, J), rad/s^2.
        static: (T, J), N m to hold still.
        dynamic: (T, J), N m beside that to move so.
        force: (T, 2, 3), N that the floor must give the body, static and dynamic.
        moment: (T, 2, 2), N m about the level axes through the centre of mass, static and dynamic.
        com: (T, 3), m.
        supports: Hulls of the soles that bear, each (H, 2), m; empty in the air.
        friction: Of the soles on the floor.
        weight: N.
        overlaps: Bodies that are in one another at some moment.
    """

    time: Array
    joints: tuple[str, ...]
    position: Array
    velocity: Array
    acceleration: Array
    static: Array
    dynamic: Array
    force: Array
    moment: Array
    com: Array
    supports: tuple[Array, ...]
    friction: float
    weight: float
    overlaps: tuple[Overlap, ...]

    @property
    def aloft(self) -> Mask:
        """(T,), where nothing bears."""
        return np.array([len(hull) == 0 for hull in self.supports])


def joint_loads(
    motion: Motion, contacts: ContactSchedule | None = None, *, stand: bool = False
) -> JointLoads:
    """Go through a movement.

    Args:
        motion: Of a body with a free root and hinges.
        contacts: Which soles bear and when; read from the movement if None.
        stand: Hang the root on a stand that gives all that it needs, in place of the floor.

    Raises:
        MotionError: A body with other joints than a root and hinges.
    """
    model = motion.model
    hinges = np.flatnonzero(model.jnt_type == mujoco.mjtJoint.mjJNT_HINGE)
    if len(hinges) != model.njnt - 1 or model.jnt_type[0] != mujoco.mjtJoint.mjJNT_FREE:
        raise MotionError("loads are of a body with a free root and hinges")
    walk = _Walk(motion, None if stand else contacts or contact_schedule(motion))
    static, dynamic = walk.loads[:, 0], walk.loads[:, 1]
    dofs, angles = model.jnt_dofadr[hinges], model.jnt_qposadr[hinges]
    return JointLoads(
        time=motion.time,
        joints=tuple(model.joint(int(joint)).name for joint in hinges),
        position=motion.qpos[:, angles],
        velocity=motion.qvel[:, dofs],
        acceleration=motion.qacc[:, dofs],
        static=static[:, dofs],
        dynamic=dynamic[:, dofs],
        force=walk.force,
        moment=walk.moment,
        com=walk.com,
        supports=walk.supports,
        friction=walk.friction,
        weight=walk.plant.mass * walk.plant.gravity,
        overlaps=walk.overlaps(),
    )


class _Walk:
    """The movement sample by sample; loads (T, 2, nv) are what the joints must give."""

    def __init__(self, motion: Motion, contacts: ContactSchedule | None) -> None:
        self.plant = Plant(motion.model)
        model, samples = motion.model, len(motion.time)
        self.loads = np.empty((samples, 2, model.nv))
        self.force, self.moment = np.zeros((samples, 2, 3)), np.zeros((samples, 2, 2))
        self.com = np.empty((samples, 3))
        self.supports: tuple[Array, ...] = ()
        self._depths: dict[tuple[int, int], Array] = {}
        soles = self.plant.sole_geoms
        self.friction = float(model.geom_friction[soles, 0].min(initial=np.inf))
        supports = []
        for i in range(samples):
            wrenches = self._wrenches(motion, i)
            self._note(i, wrenches)
            bearing = soles[contacts.bears[i]] if contacts is not None else soles[:0]
            if contacts is not None:
                wrenches = self._carried(wrenches, bearing)
            self.loads[i] = wrenches
            supports.append(support_hull(sole_points(model, self.plant.data, bearing)[:, :2]))
            self._meet(i, samples)
        self.supports = tuple(supports)

    def _wrenches(self, motion: Motion, i: int) -> Array:
        """b, static and dynamic, (2, nv); leaves the plant at the pose, at rest."""
        plant = self.plant
        plant.place(motion.qpos[i], motion.qvel[i])
        whole = plant.inverse_dynamics(motion.qacc[i]) + plant.data.qfrc_damper
        plant.place(motion.qpos[i])
        held = plant.inverse_dynamics(np.zeros(motion.model.nv))
        return np.stack([held, whole - held])

    def _note(self, i: int, wrenches: Array) -> None:
        """Force on the body, and its level moment about the centre of mass."""
        data, com = self.plant.data, self.plant.com
        self.com[i] = com
        # The root's rows are a force in the world's axes and a moment about the root in its own.
        turned = data.xmat[self.plant.model.jnt_bodyid[0]].reshape(3, 3)
        force = wrenches[:, :3]
        about_root = wrenches[:, 3:6] @ turned.T
        arm = np.array(data.qpos[:3]) - com
        self.force[i] = force
        self.moment[i] = (about_root + np.cross(arm, force))[:, :2]

    def _carried(self, wrenches: Array, bearing: NDArray[np.int64]) -> Array:
        """What is left for the joints when the floor has given the root its share."""
        plant = self.plant
        if len(bearing) == 0:
            return wrenches
        jacobians = plant.contact_jacobians(bearing).reshape(-1, plant.model.nv)
        shares = np.repeat(self._shares(bearing), 3)
        onto_root = jacobians[:, :6].T * shares
        solve = shares[:, None] * np.linalg.pinv(onto_root, rcond=_RANK)
        return np.asarray(wrenches - (wrenches[:, :6] @ solve.T) @ jacobians)

    def _shares(self, bearing: NDArray[np.int64]) -> Array:
        """(S,), root of the share of the weight that each sole bears at rest."""
        plant = self.plant
        away = sole_points(plant.model, plant.data, bearing)[:, :2] - plant.com[:2]
        away /= max(float(np.abs(away).max()), 1e-9)
        level = np.vstack([np.ones(len(bearing)), away.T, _EVEN * np.eye(len(bearing))])
        borne, _ = nnls(level, np.concatenate([[1.0, 0.0, 0.0], np.zeros(len(bearing))]))
        return np.asarray(np.sqrt(borne + _UNLOADED / len(bearing)))

    def _meet(self, i: int, samples: int) -> None:
        """Note which bodies are in one another."""
        model, contact = self.plant.model, self.plant.data.contact
        for (first, second), gap in zip(contact.geom.tolist(), contact.dist.tolist(), strict=True):
            geoms = (first, second)
            if gap >= 0.0 or any(model.geom_type[g] == mujoco.mjtGeom.mjGEOM_PLANE for g in geoms):
                continue
            low, high = sorted(int(model.geom_bodyid[g]) for g in geoms)
            depth = self._depths.setdefault((low, high), np.zeros(samples))
            depth[i] = max(depth[i], -gap)

    def overlaps(self) -> tuple[Overlap, ...]:
        """Deepest first."""
        name = self.plant.model.body
        found = [Overlap(name(a).name, name(b).name, d) for (a, b), d in self._depths.items()]
        return tuple(sorted(found, key=lambda overlap: -float(overlap.depth.max())))
