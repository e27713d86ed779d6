"""Balance and foot contact of a movement as it is drawn, without dancing it.

What stands is read from the movement (`contact_schedule`): a sole is stood on while it is on the
floor and at rest. Where weight is, and what the floor must give, follow from the body's masses.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from itertools import pairwise

import mujoco
import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import binary_closing

from enpointe.controllers import FeedForward
from enpointe.controllers.plant import Plant
from enpointe.models.soles import sole_points
from enpointe.motion import Motion
from enpointe.motion.contact_schedule import ContactSchedule, contact_schedule
from enpointe.sim import balance
from enpointe.sim.feet import SIDES, FootState, foot_states
from enpointe.sim.measures import Flight, find_flights, heading

__all__ = ["FootContact", "LimitBreach", "MotionCheck", "Turn", "check_motion"]

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]
TURNING = np.radians(20.0)
"""A pelvis that turns faster than this, rad/s, is turning; a turn of the trunk is slower or
shorter."""
TURN_PAUSE = 0.1
"""s: two turns the same way with less between them are one."""
SHORTEST_TURN = 0.125
"""Revolutions: less is a change of facing."""
BEYOND = np.radians(0.1)
"""A joint this far beyond its range, rad, is there by more than rounding."""


@dataclass(frozen=True, slots=True)
class FootContact:
    """A foot that stands in one way for a time.

    Attributes:
        start: s.
        end: s.
        on: What of the foot.
    """

    start: float
    end: float
    on: FootState


@dataclass(frozen=True, slots=True)
class Turn:
    """A turn of the pelvis about the vertical.

    Attributes:
        start: s.
        end: s.
        revolutions: Positive to the dancer's left, counter-clockwise from above.
    """

    start: float
    end: float
    revolutions: float


@dataclass(frozen=True, slots=True)
class LimitBreach:
    """A joint beyond its range.

    Attributes:
        joint: Its name.
        time: s, when it is worst.
        beyond_deg: By how much then.
    """

    joint: str
    time: float
    beyond_deg: float


@dataclass(frozen=True)
class MotionCheck:
    """What was found; T samples, S soles.

    Attributes:
        motion: What was looked at.
        com_margin: (T,), CoM to the edge of the support, m, positive inside, minus infinity in the
            air.
        zmp_margin: (T,), the zero-moment point likewise; not-a-number in the air and where the
            floor need not push up.
        stability_margin: (T,), the extrapolated centre of mass likewise (Hof et al. 2005).
        contacts: By foot, in order.
        slip_max: Farthest that a sole slides while it is stood on, m.
        penetration_max: Deepest that anything is in the floor, m.
        overlap_max: Deepest that limbs are in one another, m.
        flights: In order.
        turns: In order.
        breaches: The joints beyond their ranges, worst first.
        root_wrench: (N,), what of the force and moment on the root the floor could not give, N
            (moments over 1 m), 50 times a second.
    """

    motion: Motion
    com_margin: Array
    zmp_margin: Array
    stability_margin: Array
    contacts: Mapping[str, tuple[FootContact, ...]]
    slip_max: float
    penetration_max: float
    overlap_max: float
    flights: tuple[Flight, ...]
    turns: tuple[Turn, ...]
    breaches: tuple[LimitBreach, ...]
    root_wrench: Array

    @property
    def support_margin_min(self) -> float | None:
        """Least margin of the centre of mass while anything stands, m; None if nothing ever does.

        A movement may pass through places where it is negative; a pose that is held may not.
        """
        standing = self.com_margin[np.isfinite(self.com_margin)]
        return float(standing.min()) if len(standing) else None

    @property
    def zmp_outside_fraction(self) -> float | None:
        """Share of the samples in contact whose zero-moment point is outside the support."""
        known = self.zmp_margin[np.isfinite(self.zmp_margin)]
        return float(np.mean(known < 0.0)) if len(known) else None

    @property
    def root_wrench_rms(self) -> float:
        """The invisible hand that the movement needs, N (moments over 1 m)."""
        return float(np.sqrt(np.mean(self.root_wrench**2)))


def check_motion(motion: Motion) -> MotionCheck:
    """Look at a movement of the dancer.

    Args:
        motion: Evenly sampled.
    """
    contacts = contact_schedule(motion)
    body = _Movement.of(motion)
    # Every sole that stands counts alike: the movement does not say how it shares the weight.
    forces = np.zeros((*contacts.bears.shape, 3))
    forces[:, :, 2] = np.where(contacts.bears, body.weight, 0.0)
    hulls = balance.supports(contacts.points, forces)
    aloft = np.asarray(~contacts.bears.any(axis=1))
    zmp = _margins(hulls, body.zmp)
    zmp[aloft] = np.nan
    return MotionCheck(
        motion=motion,
        com_margin=_margins(hulls, body.com[:, :2]),
        zmp_margin=zmp,
        stability_margin=_margins(hulls, body.xcom),
        contacts=_foot_contacts(motion, contacts, forces),
        slip_max=float(balance.slip(contacts.points, forces).max(initial=0.0)),
        penetration_max=body.penetration,
        overlap_max=body.overlap,
        flights=find_flights(motion.time, motion.qpos, body.com, aloft),
        turns=_turns(motion),
        breaches=_breaches(motion),
        root_wrench=FeedForward.along(motion).shortfall,
    )


@dataclass(frozen=True)
class _Movement:
    """The body's masses along a motion, (T, ...), and how deep it is in the floor and in itself."""

    com: Array
    xcom: Array
    zmp: Array
    weight: float
    penetration: float
    overlap: float

    @classmethod
    def of(cls, motion: Motion) -> _Movement:
        plant = Plant(motion.model)
        data = plant.data
        com, velocity, momentum = np.empty((3, len(motion.time), 3))
        depths = np.zeros(2)
        for i, (qpos, qvel) in enumerate(zip(motion.qpos, motion.qvel, strict=True)):
            plant.place(qpos, qvel)
            mujoco.mj_subtreeVel(plant.model, data)
            com[i], velocity[i] = data.subtree_com[0], data.subtree_linvel[0]
            momentum[i] = data.subtree_angmom[0]
            np.maximum(depths, _depths(plant), out=depths)
        acceleration, rate = (np.gradient(v, motion.time, axis=0) for v in (velocity, momentum))
        zmp = [
            balance.zero_moment_point(c, a, r, plant.mass, plant.gravity)
            for c, a, r in zip(com, acceleration, rate, strict=True)
        ]
        xcom = [
            balance.extrapolated_com(c, v, plant.gravity)
            for c, v in zip(com, velocity, strict=True)
        ]
        weight = plant.mass * plant.gravity
        return cls(com, np.array(xcom), np.array(zmp), weight, float(depths[0]), float(depths[1]))


def _depths(plant: Plant) -> tuple[float, float]:
    """Deepest into the floor, and deepest of limbs in one another, m."""
    model, data = plant.model, plant.data
    floor = model.geom_type[data.contact.geom] == mujoco.mjtGeom.mjGEOM_PLANE
    grounded = np.any(floor, axis=1)
    soles = -sole_points(model, data, plant.sole_geoms)[:, 2]
    into = np.concatenate([soles, -data.contact.dist[grounded]])
    return float(into.max(initial=0.0)), float((-data.contact.dist[~grounded]).max(initial=0.0))


def _margins(hulls: list[Array], points: Array) -> Array:
    known = np.isfinite(points).all(axis=1)
    return np.where(known, balance.margins(hulls, points), np.nan)


def _foot_contacts(
    motion: Motion, contacts: ContactSchedule, forces: Array
) -> dict[str, tuple[FootContact, ...]]:
    # Samples with the same soles down are alike, and there are few different ones.
    patterns, which = np.unique(contacts.bears, axis=0, return_inverse=True)
    firsts = [int(np.argmax(which == i)) for i in range(len(patterns))]
    states = [foot_states(motion.model, forces[first]) for first in firsts]
    found = {}
    for side in SIDES:
        on = [states[i][side] for i in which.ravel()]
        edges = [0, *(i for i in range(1, len(on)) if on[i] != on[i - 1]), len(on)]
        found[side] = tuple(
            FootContact(float(motion.time[a]), float(motion.time[b - 1]), on[a])
            for a, b in pairwise(edges)
            if on[a] != FootState.AIR
        )
    return found


def _turns(motion: Motion) -> tuple[Turn, ...]:
    facing = heading(motion.qpos)
    rate = np.gradient(facing, motion.time)
    width = 2 * int(0.5 * TURN_PAUSE / float(np.median(np.diff(motion.time)))) + 1
    turns = []
    for sign in (1.0, -1.0):
        padded = np.pad(sign * rate > TURNING, width)
        turning = binary_closing(padded, np.ones(width, dtype=bool))[width:-width]
        edges = np.flatnonzero(np.diff(np.concatenate([[False], turning, [False]]).astype(int)))
        for start, end in zip(edges[::2], edges[1::2] - 1, strict=True):
            revolutions = float(facing[end] - facing[start]) / (2 * np.pi)
            if abs(revolutions) >= SHORTEST_TURN:
                turns.append(Turn(float(motion.time[start]), float(motion.time[end]), revolutions))
    return tuple(sorted(turns, key=lambda turn: turn.start))


def _breaches(motion: Motion) -> tuple[LimitBreach, ...]:
    model = motion.model
    breaches = []
    for joint in np.flatnonzero(model.jnt_limited):
        angles = motion.qpos[:, model.jnt_qposadr[joint]]
        low, high = model.jnt_range[joint]
        beyond = np.maximum(low - angles, angles - high)
        worst = int(np.argmax(beyond))
        if beyond[worst] > BEYOND:
            name, degrees = model.joint(int(joint)).name, float(np.degrees(beyond[worst]))
            breaches.append(LimitBreach(name, float(motion.time[worst]), degrees))
    return tuple(sorted(breaches, key=lambda breach: -breach.beyond_deg))
