"""Everything about a body at one state that the tasks and constraints are written in."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import mujoco
import numpy as np
from numpy.typing import NDArray

from enpointe.controllers.plant import Plant
from enpointe.controllers.wholebody.rows import Places, places, repeated
from enpointe.models.anatomy import SIDES

__all__ = ["Instant", "Observer", "skew"]

Array = NDArray[np.float64]
Indices = NDArray[np.int64]
_NONE: Indices = np.empty(0, dtype=np.int64)


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
        angular_momentum: About the CoM, (3,), kg m^2/s.
        soles: Sole geoms, (S,).
        points: Lowest point of each sole, (S, 3), m.
        velocities: Of those points, J v, (S, 3), m/s.
        jacobians: Of those points, (S, 3, nv).
        drifts: Their accelerations at qacc = 0, J' v, (S, 3), m/s^2.
        active: Rows of `soles` that may bear force, (A,).
        due: Rows of `soles` that are meant to bear force and are off the floor.
        capacity: Share of the body's weight that each active sole may bear, (A,); inf for any.
        edges: Directions of the forces' generators, (E, 3), sole by sole as in `active`.
        edge_point: Row of `soles` of each generator, (E,).
        actuated: Dofs of the actuators, nu of them.
        angles: Their places in qpos.
        in_legs: Which of them carry a sole, (nu,).
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
    angular_momentum: Array
    soles: Indices
    points: Array
    velocities: Array
    jacobians: Array
    drifts: Array
    active: Indices
    due: Indices
    capacity: Array
    edges: Array
    edge_point: Indices
    actuated: Places
    angles: Places
    in_legs: NDArray[np.bool_]
    root_rotation: Array

    @property
    def weight(self) -> float:
        """m g, N."""
        return self.mass * self.gravity

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
    def accelerations(self) -> slice:
        """Where qacc stands among the unknowns."""
        return slice(0, len(self.qvel))

    @property
    def forces(self) -> slice:
        """Where lambda stands among the unknowns."""
        return slice(len(self.qvel), len(self.qvel) + len(self.edges))

    @cached_property
    def force_matrix(self) -> Array:
        """J^T of all generators, (nv, E): generalised force of each lambda."""
        if len(self.edges) == 0:
            return np.zeros((self.nv, 0))
        edges = self.edges.reshape(len(self.active), -1, 3)
        return np.asarray((edges @ self.jacobians.take(self.active, axis=0)).reshape(-1, self.nv).T)

    @cached_property
    def dynamics(self) -> Array:
        """[M, -J^T], (nv, n): root and joints must give this times x, plus the bias."""
        matrix = np.empty((self.nv, self.size))
        matrix[:, : self.nv] = self.mass_matrix
        np.negative(self.force_matrix, out=matrix[:, self.nv :])
        return matrix

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
        self._bodies = np.array(model.geom_bodyid[self._soles])
        self._roots = np.array(model.body_rootid[self._bodies])
        self._carries = _carries(model, self._bodies)
        pyramid = [[friction, 0, 1], [-friction, 0, 1], [0, friction, 1], [0, -friction, 1]]
        self._dofs = places(self.plant.actuated_dofs)
        self._angles = places(self.plant.actuated_qpos)
        self._in_legs = np.max(self._carries, axis=(0, 1))[self.plant.actuated_dofs] > 0.0
        self._edges = np.tile(np.array(pyramid), (len(self._soles), 1))

    @property
    def soles(self) -> Indices:
        """Sole geoms, (S,)."""
        return self._soles

    @property
    def feet(self) -> tuple[Indices, Indices]:
        """Rows of `soles` under the left foot, and under the right."""
        names = [self.model.geom(int(geom)).name for geom in self._soles]
        left = np.array([name.startswith(SIDES[0]) for name in names])
        return np.flatnonzero(left), np.flatnonzero(~left)

    def place(self, qpos: Array, qvel: Array) -> None:
        """Bring the model to a state; `clearance` and `instant` then speak of it."""
        model, data = self.model, self.plant.data
        data.qpos[:], data.qvel[:] = qpos, qvel
        # Stages of mj_fwdPosition and mj_fwdVelocity; collisions cost more than all of these, and
        # the programme has its own picture of the floor.
        mujoco.mj_kinematics(model, data)
        mujoco.mj_comPos(model, data)
        mujoco.mj_makeM(model, data)
        mujoco.mj_comVel(model, data)
        mujoco.mj_passive(model, data)
        mujoco.mj_rne(model, data, 0, data.qfrc_bias)
        mujoco.mj_subtreeVel(model, data)
        # With qacc at zero, where it stays, these are the bodies' accelerations J' v.
        mujoco.mj_rnePostConstraint(model, data)

    def clearance(self) -> Array:
        """Height of each sole above the floor, (S,), m."""
        return np.asarray(self.points()[:, 2])

    def points(self) -> Array:
        """Lowest point of each sole, (S, 3), m."""
        points = self.plant.data.geom_xpos.take(self._soles, axis=0)
        points[:, 2] -= self._radius
        return np.asarray(points)

    def instant(
        self, active: Indices, capacity: Array | None = None, due: Indices = _NONE
    ) -> Instant:
        """The state placed last, with the given rows of `soles` able to bear force.

        Args:
            active: Rows of `soles`, (A,).
            capacity: Share of the body's weight that each may bear, (A,); any amount if None.
            due: Rows of `soles` that are meant to and can't yet.
        """
        model, data, nv = self.model, self.plant.data, self.model.nv
        mass_matrix = np.zeros((nv, nv))
        mujoco.mj_fullM(model, data, mass_matrix)
        points = self.points()
        jacobians, velocities, drifts = self._contact_kinematics(points)
        return Instant(
            qpos=np.array(data.qpos),
            qvel=np.array(data.qvel),
            mass_matrix=mass_matrix,
            bias=data.qfrc_bias - data.qfrc_passive,
            mass=self.plant.mass,
            gravity=self.plant.gravity,
            com=np.array(data.subtree_com[0]),
            com_velocity=np.array(data.subtree_linvel[0]),
            angular_momentum=np.array(data.subtree_angmom[0]),
            soles=self._soles,
            points=points,
            velocities=velocities,
            jacobians=jacobians,
            drifts=drifts,
            active=active,
            due=due,
            capacity=repeated(np.inf, len(active)) if capacity is None else capacity,
            edges=self._edges[: 4 * len(active)],
            edge_point=np.repeat(active, 4),
            actuated=self._dofs,
            angles=self._angles,
            in_legs=self._in_legs,
            root_rotation=np.array(data.xmat[1]).reshape(3, 3),
        )

    def _contact_kinematics(self, points: Array) -> tuple[Array, Array, Array]:
        """Jacobians (S, 3, nv) of the soles' lowest points, J v and J' v (S, 3).

        MuJoCo keeps a body's velocity as (omega, v), v that of the body's frame carried to the
        whole's centre of mass c, and accelerations and motion axes likewise. At a point c + r

            v_p = [-[r], 1] (omega, v),    a_p = [-[r], 1] (alpha, a) + omega x v_p,

        and a column of J is the first with a motion axis for (omega, v).
        """
        data, count = self.plant.data, len(points)
        arms = points - data.subtree_com.take(self._roots, axis=0)
        shift = arms @ _BESIDE_ONE + _ONE
        jacobians = (shift.reshape(-1, 6) @ data.cdof.T).reshape(count, 3, -1)
        jacobians *= self._carries
        motion = np.empty((count, 6, 2))
        motion[:, :, 0] = data.cvel.take(self._bodies, axis=0)
        motion[:, :, 1] = data.cacc.take(self._bodies, axis=0)
        carried = shift.reshape(-1, 3, 6) @ motion
        velocities = carried[:, :, 0].copy()
        # MuJoCo lets the world rise at -g instead of pulling the bodies down.
        drifts = carried[:, :, 1] + _cross(motion[:, :3, 0], velocities) + self.model.opt.gravity
        return jacobians, velocities, drifts


def _carries(model: mujoco.MjModel, bodies: Indices) -> Array:
    """1 where a dof moves a body and 0 where it doesn't, (S, 1, nv)."""
    carries = np.zeros((len(bodies), 1, model.nv))
    for row, body in enumerate(bodies):
        ancestor = int(body)
        while ancestor != 0:
            carries[row, 0, model.dof_bodyid == ancestor] = 1.0
            ancestor = int(model.body_parentid[ancestor])
    return carries


def skew(vectors: Array) -> Array:
    """[a] with [a] b = a x b, (N, 3, 3), of vectors (N, 3)."""
    return (vectors @ _SKEW).reshape(-1, 3, 3)


def _cross(a: Array, b: Array) -> Array:
    """a x b of vectors (N, 3); numpy's own takes three times as long for a few."""
    left = a.take(_NEXT, axis=1) * b.take(_LAST, axis=1)
    return np.asarray(left - a.take(_LAST, axis=1) * b.take(_NEXT, axis=1))


_NEXT, _LAST = np.array([1, 2, 0]), np.array([2, 0, 1])
_SKEW = np.zeros((3, 9))
_SKEW[[0, 1, 2, 0, 1, 2], [5, 6, 1, 7, 2, 3]] = -1.0, -1.0, -1.0, 1.0, 1.0, 1.0
"""a @ this is [a], row by row."""
_BESIDE_ONE = np.concatenate([-_SKEW.reshape(3, 3, 3), np.zeros((3, 3, 3))], axis=2).reshape(3, 18)
_ONE = np.eye(3, 6, 3).ravel()
"""a @ the first + the second is [-[a], 1], row by row."""
