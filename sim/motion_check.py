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
from enpointe.motion.averaging import averaged_qpos
from enpointe.motion.contact_schedule import ContactSchedule, contact_schedule
from enpointe.sim import balance
from enpointe.sim.ballistics import Ballistics, ballistics
from enpointe.sim.feet import SIDES, FootState, foot_states
from enpointe.sim.impossible import Help, spans_of_help
from enpointe.sim.measures import Flight, find_flights, heading

__all__ = ["FootContact", "JointSpeed", "LimitBreach", "MotionCheck", "Turn", "check_motion"]

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
MEANT_DOWN, MEANT_STILL = 0.005, 0.10
"""m and m/s: a sole nearer to the floor and slower than this is meant to stand, and slides. What is
made to be danced keeps its feet better than that; what was drawn or captured may not."""
HELP_MAX = 0.05
"""Of body weight: what is missing below this is the noise of what was measured or drawn; with more,
rms, a movement is not one that can be danced."""


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


@dataclass(frozen=True, slots=True)
class JointSpeed:
    """How fast a joint is at its fastest.

    Attributes:
        joint: Its name.
        time: s.
        speed: rad/s.
    """

    joint: str
    time: float
    speed: float


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
        ballistics: Each flight that is long enough beside free fall, in order.
        turns: In order.
        breaches: The joints beyond their ranges, worst first.
        speeds: Every joint at its fastest, fastest first.
        root_wrench_time: (N,), s.
        root_wrench: (N,), what of the force and moment on the root the floor could not give, N
            (moments over 1 m), 50 times a second.
        help: When that is more than a twentieth of body weight, and why.
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
    ballistics: tuple[Ballistics, ...]
    turns: tuple[Turn, ...]
    breaches: tuple[LimitBreach, ...]
    speeds: tuple[JointSpeed, ...]
    root_wrench_time: Array
    root_wrench: Array
    help: tuple[Help, ...]

    @property
    def weight(self) -> float:
        """Body weight, N."""
        model = self.motion.model
        return float(model.body_mass.sum() * -model.opt.gravity[2])

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

    @property
    def needs_help(self) -> bool:
        """Whether that is more than `HELP_MAX`: then the movement can't be danced."""
        return self.root_wrench_rms > HELP_MAX * self.weight


def check_motion(
    motion: Motion, contacts: ContactSchedule | None = None, *, averaged_over: float = 0.0
) -> MotionCheck:
    """Look at a movement of the dancer.

    Args:
        motion: Evenly sampled.
        contacts: What stands and when, where somebody knows; read from the movement otherwise.
        averaged_over: s; forces and momentum are those of the movement averaged over this window,
            since two differences of what was measured are mostly noise (Winter 2009).
    """
    if contacts is None:
        contacts = contact_schedule(motion, on_floor=MEANT_DOWN, at_rest=MEANT_STILL)
    steady = _averaged(motion, averaged_over) if averaged_over > 0.0 else motion
    body = _Movement.of(motion, steady)
    # Every sole that stands counts alike: the movement does not say how it shares the weight.
    forces = np.zeros((*contacts.bears.shape, 3))
    forces[:, :, 2] = np.where(contacts.bears, body.weight, 0.0)
    hulls = balance.supports(contacts.points, forces)
    aloft = np.asarray(~contacts.bears.any(axis=1))
    zmp = _margins(hulls, body.zmp)
    zmp[aloft] = np.nan
    flights = find_flights(motion.time, motion.qpos, body.com, aloft)
    gravity = float(-motion.model.opt.gravity[2])
    free = (ballistics(f, motion.time, body.com, body.momentum, gravity) for f in flights)
    wanted = FeedForward.along(steady)
    return MotionCheck(
        motion=motion,
        com_margin=_margins(hulls, body.com[:, :2]),
        zmp_margin=zmp,
        stability_margin=_margins(hulls, body.xcom),
        contacts=_foot_contacts(motion, contacts, forces),
        slip_max=float(balance.slip(contacts.points, forces).max(initial=0.0)),
        penetration_max=body.penetration,
        overlap_max=body.overlap,
        flights=flights,
        ballistics=tuple(flight for flight in free if flight is not None),
        turns=_turns(motion),
        breaches=_breaches(motion),
        speeds=_speeds(motion),
        root_wrench_time=wanted.time,
        root_wrench=wanted.shortfall,
        help=spans_of_help(
            wanted.time, wanted.shortfall, HELP_MAX * body.weight, motion.time, aloft, zmp
        ),
    )


def _averaged(motion: Motion, window: float) -> Motion:
    rate = 1.0 / float(np.median(np.diff(motion.time)))
    return Motion.from_qpos(motion.model, motion.time, averaged_qpos(motion.qpos, window, rate))


@dataclass(frozen=True)
class _Movement:
    """The body's masses along a motion, (T, ...), and how deep it is in the floor and in itself."""

    com: Array
    momentum: Array
    xcom: Array
    zmp: Array
    weight: float
    penetration: float
    overlap: float

    @classmethod
    def of(cls, motion: Motion, steady: Motion) -> _Movement:
        """Depths of the motion itself, masses of what it is averaged to."""
        plant = Plant(motion.model)
        data = plant.data
        com, velocity, momentum = np.empty((3, len(motion.time), 3))
        depths = np.zeros(2)
        for i, qpos in enumerate(motion.qpos):
            plant.place(qpos, motion.qvel[i])
            np.maximum(depths, _depths(plant), out=depths)
            if steady is not motion:
                plant.place(steady.qpos[i], steady.qvel[i])
            mujoco.mj_subtreeVel(plant.model, data)
            com[i], velocity[i] = data.subtree_com[0], data.subtree_linvel[0]
            momentum[i] = data.subtree_angmom[0]
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
        deep, within = float(depths[0]), float(depths[1])
        return cls(com, momentum, np.array(xcom), np.array(zmp), weight, deep, within)


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


def _speeds(motion: Motion) -> tuple[JointSpeed, ...]:
    model = motion.model
    fastest = []
    for joint in np.flatnonzero(model.jnt_type == mujoco.mjtJoint.mjJNT_HINGE):
        speed = np.abs(motion.qvel[:, model.jnt_dofadr[joint]])
        worst = int(np.argmax(speed))
        name = model.joint(int(joint)).name
        fastest.append(JointSpeed(name, float(motion.time[worst]), float(speed[worst])))
    return tuple(sorted(fastest, key=lambda each: -each.speed))
