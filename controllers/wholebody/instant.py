"""Everything about a body at one state that the tasks and constraints are written in."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import mujoco
import numpy as np
from numpy.typing import NDArray

from enpointe.controllers.plant import Plant

__all__ = ["Instant", "Observer", "skew"]

Array = NDArray[np.float64]
Indices = NDArray[np.int64]


@dataclass(frozen=True)
class Instant:
    """A model placed at one state.

    Unknowns of the problem are stacked x = [qacc (nv), lambda (E)], E the edges of all friction
    pyramids: the force at active sole i is the sum of its edges times their lambdas.

    Attributes:
        qpos: (nq,).
        qvel: (nv,).
        mass_matrix: M, (nv, nv), kg and kg m^2.
        bias: h = Coriolis, gravity less passive forces, (nv,), so that M qacc + h = tau + J^T f.
        mass: kg.
        gravity: m/s^2, positive.
        com: c, (3,), m.
        com_velocity: (3,), m/s.
        momentum_matrix: (3, nv), angular momentum about the CoM is this times qvel.
        soles: Sole geoms, (S,).
        points: Lowest point of each sole, (S, 3), m.
        jacobians: Of those points, (S, 3, nv).
        drifts: Their accelerations at qacc = 0, J' v, (S, 3), m/s^2.
        active: Rows of `soles` that may bear force, (A,).
        edges: Directions of the forces' generators, (E, 3).
        edge_point: Row of `soles` of each generator, (E,).
        actuated: Dofs of the actuators, (nu,).
        root_rotation: Of the pelvis, (3, 3).
    """

    qpos: Array
    qvel: Array
    mass_matrix: Array
    bias: Array
    mass: float
    gravity: float
    com: Array
    com_velocity: Array
    momentum_matrix: Array
    soles: Indices
    points: Array
    jacobians: Array
    drifts: Array
    active: Indices
    edges: Array
    edge_point: Indices
    actuated: Indices
    root_rotation: Array

    @property
    def nv(self) -> int:
        """Number of accelerations."""
        return len(self.qvel)

    @property
    def size(self) -> int:
        """Number of unknowns."""
        return len(self.qvel) + len(self.edges)

    @cached_property
    def resting(self) -> Indices:
        """Rows of `soles` that bear nothing, (S - A,)."""
        rest = np.ones(len(self.soles), dtype=bool)
        rest[self.active] = False
        return np.flatnonzero(rest)

    @property
    def angular_momentum(self) -> Array:
        """About the CoM, (3,), kg m^2/s."""
        return np.asarray(self.momentum_matrix @ self.qvel)

    @cached_property
    def force_matrix(self) -> Array:
        """J^T of all generators, (nv, E): generalised force of each lambda."""
        spread = np.matmul(self.edges[:, None, :], self.jacobians[self.edge_point])
        return np.ascontiguousarray(spread[:, 0, :].T)

    def sole_forces(self, unknowns: Array) -> Array:
        """Forces on each sole at a solution, (S, 3), N."""
        forces = np.zeros((len(self.soles), 3))
        np.add.at(forces, self.edge_point, unknowns[self.nv :, None] * self.edges)
        return forces


class Observer:
    """Places a model of its own at measured states.

    Args:
        model: The controller's model, which may differ from the body's.
        friction: Coefficient that the pyramids are planned with. Their four edges touch the cone
            of this coefficient from within the floor's.
    """

    def __init__(self, model: mujoco.MjModel, friction: float) -> None:
        self.plant = Plant(model)
        self.model = model
        self._soles = self.plant.sole_geoms
        self._radius = np.array(model.geom_size[self._soles, 0])
        self._bodies = np.unique(model.geom_bodyid[self._soles])
        self._body_row = np.searchsorted(self._bodies, model.geom_bodyid[self._soles])
        self._pyramid = np.array(
            [[friction, 0, 1], [-friction, 0, 1], [0, friction, 1], [0, -friction, 1]]
        )
        nv, count = model.nv, len(self._bodies)
        self._linear, self._angular = np.zeros((count, 3, nv)), np.zeros((count, 3, nv))
        self._linear_rate, self._angular_rate = np.zeros((count, 3, nv)), np.zeros((count, 3, nv))

    @property
    def soles(self) -> Indices:
        """Sole geoms, (S,)."""
        return self._soles

    def place(self, qpos: Array, qvel: Array) -> None:
        """Bring the model to a state; `clearance` and `instant` then speak of it."""
        self.plant.place(qpos, qvel)
        mujoco.mj_subtreeVel(self.model, self.plant.data)

    def clearance(self) -> Array:
        """Height of each sole above the floor, (S,), m."""
        heights = self.plant.data.geom_xpos[self._soles, 2] - self._radius
        return np.asarray(heights)

    def points(self) -> Array:
        """Lowest point of each sole, (S, 3), m."""
        points = np.array(self.plant.data.geom_xpos[self._soles])
        points[:, 2] -= self._radius
        return points

    def instant(self, active: Indices) -> Instant:
        """The state placed last, with the given rows of `soles` able to bear force."""
        model, data, nv = self.model, self.plant.data, self.model.nv
        mass_matrix = np.zeros((nv, nv))
        mujoco.mj_fullM(model, data, mass_matrix)
        momentum = np.zeros((3, nv))
        mujoco.mj_angmomMat(model, data, momentum, 0)
        points = self.points()
        jacobians, drifts = self._contact_kinematics(points)
        return Instant(
            qpos=np.array(data.qpos),
            qvel=np.array(data.qvel),
            mass_matrix=mass_matrix,
            bias=data.qfrc_bias - data.qfrc_passive,
            mass=self.plant.mass,
            gravity=self.plant.gravity,
            com=np.array(data.subtree_com[0]),
            com_velocity=np.array(data.subtree_linvel[0]),
            momentum_matrix=momentum,
            soles=self._soles,
            points=points,
            jacobians=jacobians,
            drifts=drifts,
            active=active,
            edges=np.tile(self._pyramid, (len(active), 1)),
            edge_point=np.repeat(active, 4),
            actuated=self.plant.actuated_dofs,
            root_rotation=np.array(data.xmat[1]).reshape(3, 3),
        )

    def _contact_kinematics(self, points: Array) -> tuple[Array, Array]:
        """Jacobians (S, 3, nv) of the soles' lowest points and their J' v (S, 3).

        A point r from its body's origin:  J = J_o - [r] J_r,
        a = a_o + alpha x r + omega x (omega x r).
        """
        model, data = self.model, self.plant.data
        for i, body in enumerate(self._bodies):
            origin = data.xpos[body]
            mujoco.mj_jac(model, data, self._linear[i], self._angular[i], origin, body)
            mujoco.mj_jacDot(model, data, self._linear_rate[i], self._angular_rate[i], origin, body)
        row = self._body_row
        arm = points - data.xpos[self._bodies][row]
        linear, angular = self._linear[row], self._angular[row]
        jacobians = linear - skew(arm) @ angular
        velocity = data.qvel
        spin = (self._angular @ velocity)[row]
        linear_drift = (self._linear_rate @ velocity)[row]
        angular_drift = (self._angular_rate @ velocity)[row]
        turning = skew(angular_drift) + skew(spin) @ skew(spin)
        return jacobians, linear_drift + (turning @ arm[:, :, None])[:, :, 0]


def skew(vectors: Array) -> Array:
    """[a] with [a] b = a x b, (N, 3, 3), of vectors (N, 3)."""
    matrices = np.zeros((len(vectors), 3, 3))
    x, y, z = vectors.T
    matrices[:, 0, 1], matrices[:, 0, 2], matrices[:, 1, 2] = -z, y, -x
    matrices[:, 1, 0], matrices[:, 2, 0], matrices[:, 2, 1] = z, -y, x
    return matrices
