"""Torques that a motion needs, with the floor carrying what no muscle can: the root.

Inverse dynamics gives the generalised force of the motion, b = M qacc + h. Its first six rows must
come from the floor alone,

    sum_i J_i,root^T f_i = b_root,    f_i in the friction pyramid,

and the joints give the rest,  tau = b_joints - sum_i J_i,joints^T f_i. The forces are the smallest
that do it (non-negative least squares over the pyramid's edges, lightly regularised).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import nnls

from enpointe.controllers.plant import Plant
from enpointe.motion import Motion
from enpointe.motion.contact_schedule import ContactSchedule

__all__ = ["FeedForward", "floor_forces"]

Array = NDArray[np.float64]
RATE = 50.0
"""Samples a second at which torques are computed; they are interpolated in between."""
FRICTION = 0.7
"""Planned below the floor's friction of 1, as a dancer does not count on the last of it. The whole
body counts on less, because it slid at this where weight goes from foot to foot."""
_REGULARISATION = 3e-3
SHIFT = 0.4
"""s before a sole is lifted in which its weight goes to the others, and after it came down."""
_LEAST = 0.03


@dataclass(frozen=True)
class FeedForward:
    """Torques along a motion.

    Attributes:
        time: (N,), s.
        torque: (N, nu), N m.
        shortfall: (N,), what of the root's force and moment the floor could not give, N (moments
            over 1 m); a motion with a large shortfall can't be danced as it is.
    """

    time: Array
    torque: Array
    shortfall: Array

    @classmethod
    def along(cls, motion: Motion, contacts: ContactSchedule | None = None) -> FeedForward:
        """Compute the torques of a whole motion.

        Args:
            motion: What is to be danced.
            contacts: Which soles bear, and when: their weight is shifted before they are lifted.
                Without, whatever is near the floor bears, a foot that just brushes it too.
        """
        plant = Plant(motion.model)
        shares = None if contacts is None else np.maximum(contacts.shares(SHIFT), _LEAST)
        time = np.arange(0.0, motion.duration + 1.0 / RATE, 1.0 / RATE)
        torque = np.empty((len(time), motion.model.nu))
        shortfall = np.empty(len(time))
        for i, t in enumerate(time):
            qpos, qvel, qacc = motion.sample(float(t))
            plant.place(qpos, qvel)
            bearing = None
            if contacts is not None and shares is not None:
                k = contacts.index(float(t))
                bearing = contacts.soles[contacts.bears[k]], shares[k, contacts.bears[k]]
            torque[i], shortfall[i] = _torques(plant, qacc, bearing)
        return cls(time, torque, shortfall)

    def at(self, t: float) -> Array:
        """Torques (nu,) at `t` seconds, linear between samples."""
        i = min(max(int(t * RATE), 0), len(self.time) - 2)
        w = min(max(t * RATE - i, 0.0), 1.0)
        return np.asarray((1 - w) * self.torque[i] + w * self.torque[i + 1])


def floor_forces(
    plant: Plant, wrench: Array, bearing: tuple[NDArray[np.int64], Array] | None = None
) -> tuple[Array, Array]:
    """Forces at the soles on the floor that give the root `wrench`.

    Args:
        plant: Placed at a pose.
        wrench: (6,), the root's rows of inverse dynamics.
        bearing: The soles that bear, (A,), and how readily, (A,): a force on one of half the share
            counts as twice as large. All that are near the floor, alike, if None.

    Returns:
        Their generalised force on the whole body (nv,), and the part of `wrench` left over (6,).
    """
    geoms, shares = (plant.soles_on_floor(), None) if bearing is None else bearing
    if len(geoms) == 0:
        return np.zeros(plant.model.nv), wrench
    edges = np.array([[FRICTION, 0, 1], [-FRICTION, 0, 1], [0, FRICTION, 1], [0, -FRICTION, 1]])
    jacobians = plant.contact_jacobians(geoms)
    if shares is not None:
        jacobians *= shares[:, None, None]
    spread = np.einsum("ec,scv->sev", edges, jacobians).reshape(-1, plant.model.nv)
    matrix = np.vstack([spread[:, :6].T, _REGULARISATION * np.eye(len(spread))])
    forces, _ = nnls(matrix, np.concatenate([wrench, np.zeros(len(spread))]))
    given = forces @ spread
    return given, wrench - given[:6]


def _torques(
    plant: Plant, qacc: Array, bearing: tuple[NDArray[np.int64], Array] | None
) -> tuple[Array, float]:
    needed = plant.inverse_dynamics(qacc)
    given, missing = floor_forces(plant, needed[:6], bearing)
    torque = (needed - given)[plant.actuated_dofs]
    return np.clip(torque, -plant.torque_limit, plant.torque_limit), float(np.linalg.norm(missing))
