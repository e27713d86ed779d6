"""From a motion as composed to one that a body can dance: the same movement over moved weight.

The contacts and the centre of mass are planned (`contact_schedule`, `plan_weight`); then every
sample is posed again by differential inverse kinematics (mink), from the pose as composed:

- soles near the floor keep their places in the world, so that feet neither skate nor sink;
- the centre of mass follows the plan;
- trunk and pelvis keep their directions, and joints their angles, as far as that allows.

Beats are kept: no sample is moved in time. Where the floor cannot give what a motion needs,
`WeightPlan.outside` says when and by how much.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import mink
import mujoco
import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import distance_transform_edt

from enpointe.motion.averaging import averaged_qpos
from enpointe.motion.carried_feet import carried
from enpointe.motion.clearance import LIFTING, lifted
from enpointe.motion.contact_schedule import ContactSchedule, contact_schedule, trace_soles
from enpointe.motion.motion import Motion
from enpointe.motion.weight_plan import WeightPlan, plan_weight
from enpointe.notation import Side

__all__ = ["Danceable", "make_danceable"]

Array = NDArray[np.float64]

_DT = 1.0
"""Nominal step of the differential IK: with unit gain a step closes the whole linear error."""
_STEPS = 2
"""Steps a sample: neighbours are so near that two close the error."""
_GROUND = 0.03
"""m: at this height above the floor a sole holds to its place in the world half as much."""
_SOLE, _WEIGHT, _TRUNK, _PELVIS = 40.0, 10.0, 1.0, 0.6
"""Costs of places (1/m) and directions (1/rad)."""
_HEIGHTS = (5.0, 10.0)
"""Costs of the height (1/m), round by round: straight legs reach no higher than they are long, so
that it is asked for gently first, and then planned again from what was reached."""
_POSTURE, _BEARING_LEG, _ARMS = 0.3, 0.05, 1.0
"""Costs of joint angles (1/rad): of what moves freely, of a leg that stands, whose hip and ankle
must give way for the weight to move, and of arms, which are seen and are not there to be thrown up
where the weight should be higher."""
_BRUSH = 0.006
"""m: a foot that slides without weight is carried so high over the floor; a sole that drags is
pushed off its way by friction that nobody planned."""
_MUSCLE = 0.24
"""s: the corners at key poses are rounded over this window, wider than the movement's own since
legs throw more weight about than arms do; the feet that it moves are put back."""
_KINKS = (0.06, 0.032)
"""s: what is left of kinks where soles come and go, averaged away over these widths one after the
other; the feet, which that moves by a millimetre or two, are put back in between."""
_CLEAR, _APART = 0.003, 0.0003
"""m: a leg in the air is kept so far from the other, and goes apart by so much a step where it is
nearer: what is averaged cuts the corner that a foot goes round a shank."""
_STEADY = 0.2
"""Cost of leaving the neighbour's correction, 1/rad: a straight leg can turn between hip and ankle
with nothing else moved, and would do so at a whim from sample to sample."""
_STRAIGHT = 0.3
"""rad: a standing knee bent this much gives way too; one that is straight stays straight."""


@dataclass(frozen=True)
class Danceable:
    """A motion that can be danced, and what it was made with.

    Attributes:
        motion: The same samples in time, posed again.
        contacts: Its planned contacts.
        weight: Its planned centre of mass.
    """

    motion: Motion
    contacts: ContactSchedule
    weight: WeightPlan


def make_danceable(
    motion: Motion,
    *,
    contacts: ContactSchedule | None = None,
    progress: Callable[[int, int], None] | None = None,
) -> Danceable:
    """Make a motion that gravity and the floor allow.

    Args:
        motion: As composed.
        contacts: What stands and when, where somebody knows; read from the motion otherwise.
        progress: Called with (done, all) now and then.
    """
    known = contacts is not None
    contacts = contact_schedule(motion) if contacts is None else contacts
    rate = 1.0 / float(np.median(np.diff(motion.time)))
    soft = Motion.from_qpos(
        motion.model, motion.time, averaged_qpos(motion.qpos, _MUSCLE, rate), name=motion.name
    )
    posed = soft
    for height_cost in _HEIGHTS:
        weight = plan_weight(soft, contacts, posed)
        posed = soft
        for width in _KINKS:
            qpos = _Poser(posed, contacts, weight, height_cost, carry=known).pose_all(progress)
            posed = Motion.from_qpos(
                motion.model,
                motion.time,
                averaged_qpos(qpos, width, rate),
                events=motion.events,
                name=motion.name,
            )
    return Danceable(posed, contacts, weight)


class _Poser:
    """Every sample of a motion posed again over the planned weight."""

    def __init__(
        self,
        motion: Motion,
        contacts: ContactSchedule,
        weight: WeightPlan,
        height_cost: float,
        *,
        carry: bool,
    ) -> None:
        self._motion, self._contacts, self._weight = motion, contacts, weight
        model = motion.model
        self._configuration = mink.Configuration(model, q=motion.qpos[0])
        self._data = mujoco.MjData(model)
        names = [model.geom(int(g)).name for g in contacts.soles]
        self._soles = [
            mink.FrameTask(name, "geom", position_cost=_SOLE, orientation_cost=0.0)
            for name in names
        ]
        self._com = mink.ComTask(cost=[_WEIGHT, _WEIGHT, height_cost])
        self._trunk = mink.FrameTask("torso", "body", position_cost=0.0, orientation_cost=_TRUNK)
        self._pelvis = mink.FrameTask("pelvis", "body", position_cost=0.0, orientation_cost=_PELVIS)
        self._posture = mink.PostureTask(model, cost=np.full(model.nv, _POSTURE))
        steady = mink.DampingTask(model, cost=np.full(model.nv, _STEADY))
        self._tasks = [*self._soles, self._com, self._trunk, self._pelvis, self._posture, steady]
        self._range = mink.ConfigurationLimit(model, gain=1.0)
        self._clear = _clear(model)
        self._legs = _legs(model, contacts.soles)
        self._arms = _arms(model)
        self._freedom = _freedom(contacts)
        feet = [leg.soles for leg in self._legs]
        self._moving = trace_soles(motion, contacts.soles)
        self._lift = _lift(self._moving[:, :, 2], self._freedom, feet, contacts.time)
        for soles in feet if carry else ():
            self._moving[:, soles] = carried(
                self._moving[:, soles], contacts.points[:, soles], contacts.bears[:, soles]
            )

    def pose_all(self, progress: Callable[[int, int], None] | None) -> Array:
        model, motion = self._motion.model, self._motion
        qpos = np.empty_like(motion.qpos)
        moved = np.zeros(model.nv)
        for i, asked in enumerate(motion.qpos):
            start = asked.copy()
            mujoco.mj_integratePos(model, start, moved, 1.0)
            qpos[i] = self._pose(i, start)
            mujoco.mj_differentiatePos(model, moved, 1.0, asked, qpos[i])
            if progress is not None and i % 50 == 0:
                progress(i, len(qpos))
        return qpos

    def _pose(self, i: int, start: Array) -> Array:
        self._ask(i)
        self._configuration.update(start)
        aloft = not all(self._contacts.bears[i, leg.soles].any() for leg in self._legs)
        limits = [self._range, self._clear] if aloft else [self._range]
        for _ in range(_STEPS):
            step = mink.solve_ik(self._configuration, self._tasks, _DT, "daqp", 1e-6, limits=limits)
            self._configuration.integrate_inplace(step, _DT)
        return np.array(self._configuration.q)

    def _ask(self, i: int) -> None:
        model, data = self._motion.model, self._data
        data.qpos[:] = self._motion.qpos[i]
        mujoco.mj_kinematics(model, data)
        radii = model.geom_size[self._contacts.soles, 0]
        free = self._freedom[i][:, None]
        points = free * self._moving[i] + (1.0 - free) * self._contacts.points[i]
        points[:, 2] += self._lift[i]
        for task, point, radius in zip(self._soles, points, radii, strict=True):
            task.set_position_cost(_SOLE / (1.0 + (point[2] / _GROUND) ** 2))
            task.set_target(mink.SE3.from_translation(point + np.array([0.0, 0.0, radius])))
        self._com.set_target(self._weight.at(float(self._motion.time[i]))[0])
        for task, body in ((self._trunk, "torso"), (self._pelvis, "pelvis")):
            task.set_target(mink.SE3.from_rotation(mink.SO3(data.body(body).xquat)))
        self._posture.cost = self._posture_cost(i)
        self._posture.set_target(self._motion.qpos[i])

    def _posture_cost(self, i: int) -> Array:
        model = self._motion.model
        cost = np.full(model.nv, _POSTURE)
        cost[:6] = 0.0
        cost[self._arms] = _ARMS
        for leg in self._legs:
            if self._contacts.bears[i, leg.soles].any():
                cost[leg.dofs] = _BEARING_LEG
                bend = self._motion.qpos[i, model.jnt_qposadr[model.dof_jntid[leg.knee]]]
                cost[leg.knee] += _POSTURE * np.exp(-((bend / _STRAIGHT) ** 2))
        return cost


def _lift(heights: Array, freedom: Array, feet: list[NDArray[np.int64]], time: Array) -> Array:
    """What each sole is lifted by, (T, S), m: smooth, a whole foot alike, none that bears."""
    rate = 1.0 / float(np.median(np.diff(time)))
    lift = np.zeros_like(heights)
    for soles in feet:
        short = np.maximum(_BRUSH * freedom[:, soles] - heights[:, soles], 0.0).max(axis=1)
        lift[:, soles] = lifted(short, rate)[:, None] * freedom[:, soles]
    return lift


def _freedom(contacts: ContactSchedule) -> Array:
    """How free of the floor each sole is, (T, S): 0 while it bears, 1 from `LIFTING` away."""
    rate = 1.0 / float(np.median(np.diff(contacts.time)))
    away = [
        distance_transform_edt(~bears) if bears.any() else np.full(len(bears), np.inf)
        for bears in contacts.bears.T
    ]
    share = np.clip(np.stack(away, axis=1) / (rate * LIFTING), 0.0, 1.0)
    return np.asarray(share**2 * (3.0 - 2.0 * share))


@dataclass(frozen=True)
class _Leg:
    """A leg's DoFs, its knee's, and its rows among the soles."""

    dofs: NDArray[np.int64]
    knee: int
    soles: NDArray[np.int64]


def _clear(model: mujoco.MjModel) -> mink.Limit:
    """Legs that do not go through each other."""
    left, right = ([f"{side}_{part}_limb" for part in ("thigh", "shank", "foot")] for side in Side)
    return mink.CollisionAvoidanceLimit(
        model,
        [(left, right)],
        gain=1.0,
        minimum_distance_from_collisions=_CLEAR,
        collision_detection_distance=0.02,
        bound_relaxation=-_APART,
    )


def _arms(model: mujoco.MjModel) -> NDArray[np.int64]:
    """DoFs of shoulders, elbows and wrists."""
    parts = ("upper_arm", "forearm", "hand")
    chain = [model.body(f"{side}_{part}").id for side in Side for part in parts]
    return np.flatnonzero(np.isin(model.dof_bodyid, chain))


def _legs(model: mujoco.MjModel, soles: NDArray[np.int64]) -> tuple[_Leg, ...]:
    bodies = model.geom_bodyid[soles]
    legs = []
    for side in Side:
        foot, toe = model.body(f"{side}_foot").id, model.body(f"{side}_toe").id
        chain = [foot]
        while model.body_parentid[model.body_parentid[chain[-1]]] != 0:
            chain.append(int(model.body_parentid[chain[-1]]))
        legs.append(
            _Leg(
                dofs=np.flatnonzero(np.isin(model.dof_bodyid, chain)),
                knee=int(model.body_dofadr[model.body(f"{side}_shank").id]),
                soles=np.flatnonzero(np.isin(bodies, (foot, toe))),
            )
        )
    return tuple(legs)
