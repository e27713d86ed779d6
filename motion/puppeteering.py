"""A dancer's movement on a body of servos: other limbs, fewer joints, feet that do not bend.

Directions are carried over, not angles: of upper arms and forearms, thighs and shanks, pelvis,
trunk and head. What stands on the floor keeps standing, on a mark of the body's own size; where two
feet would be in each other's way there, the one that comes later stands beside the other. Heels
rise as far as the foot has a second sole to stand on (`Sole.rise`), and not at all if it has none.
Every sample is posed by differential inverse kinematics (mink) within the joints' ranges, limbs out
of one another and feet in the air over the floor. Where legs are so thick that feet can't come to
their marks, the marks go apart (`Puppeteered.opened`). Joints that both bodies have by one name
follow the dancer's angles where nothing else asks. Then the weight is planned (`plan_weight`), for
the tempo and for all that are slower, since a body of servos often needs more time, and every
sample posed again with its centre of mass there.

What is lost: joints that the body has not, of the puppet waist tilt, forearm, wrist, ankle turn and
toe; of OP3 also the waist, a shoulder and neck axis each, and demi-pointe.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import mink
import mujoco
import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from enpointe.models.anatomy import SIDES
from enpointe.models.soles import sole_geoms, sole_points
from enpointe.motion.averaging import averaged_qpos
from enpointe.motion.contact_schedule import ContactSchedule, contact_schedule
from enpointe.motion.danced_poses import THIGHS, DancedPoses
from enpointe.motion.feet_over_floor import FeetOverFloor
from enpointe.motion.footprints import Footing, footings
from enpointe.motion.limbs_apart import LimbsApart
from enpointe.motion.motion import Motion
from enpointe.motion.retargeting.body import Body
from enpointe.motion.retargeting.holding import runs
from enpointe.motion.retargeting.posing import Directions
from enpointe.motion.weight_plan import WeightPlan, plan_weight

__all__ = ["Puppeteered", "puppeteer"]

Array = NDArray[np.float64]
RATE = 100.0
"""Samples a second: servos are asked no oftener than 200 times."""
_DT = 1.0
_FIRST, _EACH, _ANEW = 60, 3, 8
_PELVIS, _TORSO, _HEAD = 2.0, 1.5, 0.7
_TURNOUT = 0.3
_ROOT = 4.0
_ROOT_BALANCED = (0.2, 0.2, 4.0)
_WEIGHT = (20.0, 20.0, 0.0)
_PLANTED, _FREE = 60.0, 1.5
_LAID, _LOOSE = 6.0, 0.25
_BRUSH = 0.006
"""m that a foot in the air keeps over the floor."""
_KNEE = 0.8
"""Cost of a knee that is not bent as the dancer's, 1/rad: legs straight where hers are, though
feet farther apart pull them askew."""
_SHARED, _POSTURE = 0.12, 0.02
_STEADY = 0.12
_TOUCHES = 0.002
"""m above the floor at which a sole of a standing foot bears."""
_ON_MARK = 5e-4
"""m that a foot may stand beside its mark, before the mark goes to where it can stand."""
_OPENINGS, _SPARSE = 6, 6
_KINKS = 0.12
"""s: kinks where feet come and go are averaged away over this width."""


@dataclass(frozen=True)
class Puppeteered:
    """A dancer's movement on a body of servos.

    Attributes:
        motion: On that body.
        contacts: Which soles bear, and when.
        weight: Where its centre of mass was planned to be; None if it was not.
        scale: Length of its legs over the dancer's.
        opened: m, how much farther from each other its feet stand than the dancer's on its scale,
            at most: its feet or legs are too thick for the position.
    """

    motion: Motion
    contacts: ContactSchedule
    weight: WeightPlan | None
    scale: float
    opened: float


def puppeteer(
    motion: Motion,
    model: mujoco.MjModel,
    *,
    balanced: bool = True,
    progress: Callable[[int, int], None] | None = None,
) -> Puppeteered:
    """Put a dancer's movement on a body of servos.

    Args:
        motion: Of the dancer.
        model: Such as `enpointe.models.puppet.puppet_model()`: parts and points have the dancer's
            names.
        balanced: Bring its weight over its feet; without, it moves as the dancer did, who weighs
            otherwise.
        progress: Called with (done, all) now and then.

    Raises:
        ModelError: A body without a dancer's parts.
    """
    dancer, body = Body(motion.model), Body(model)
    scale = body.leg / dancer.leg
    time = np.arange(0.0, motion.duration + 0.5 / RATE, 1.0 / RATE)
    danced = np.array([motion.sample(float(t))[0] for t in time])
    source = DancedPoses(dancer, danced)
    planned = contact_schedule(motion)
    bears = np.array([planned.bears[planned.index(float(t))] for t in time])
    owner = motion.model.geom_bodyid[planned.soles]
    standing = {}
    for side in SIDES:
        mine = np.isin(owner, [dancer.bodies[f"{side}_{part}"] for part in ("foot", "toe")])
        standing[side] = np.asarray(bears[:, mine].any(axis=1), dtype=bool)
    aside = {side: np.zeros((len(time), 2)) for side in SIDES}
    feet = footings(source.feet, standing, body, scale, RATE)
    poser = _Poser(source, body, scale, feet)

    def pose(weight: WeightPlan | None) -> tuple[Motion, ContactSchedule]:
        qpos = averaged_qpos(poser.pose_all(weight, progress), _KINKS, RATE)
        made = Motion.from_qpos(model, time, qpos, events=motion.events, name=motion.name)
        return made, _contacts(made, body, feet)

    for _ in range(_OPENINGS):
        if not _opened(aside, poser.pose_all(None, None, every=_SPARSE), body, feet):
            break
        feet = footings(source.feet, standing, body, scale, RATE, aside)
        poser = _Poser(source, body, scale, feet)
    weight = None
    made, contacts = pose(None)
    if balanced:
        weight = plan_weight(made, contacts, made, slower=True)
        made, contacts = pose(weight)
    return Puppeteered(made, contacts, weight, scale, _opening(feet))


def _opened(aside: dict[str, Array], posed: Array, body: Body, feet: dict[str, Footing]) -> bool:
    """Move marks, in place, to where feet can stand; whether any had to be moved.

    Args:
        aside: What marks were moved by so far, moved on.
        posed: (N, nq), every `_SPARSE`th sample.
        body: Whose.
        feet: As they were asked to stand.
    """
    model = body.model
    data = mujoco.MjData(model)
    off = {side: np.zeros_like(moved) for side, moved in aside.items()}
    for i, qpos in zip(range(0, len(off["left"]), _SPARSE), posed, strict=True):
        data.qpos[:] = qpos
        mujoco.mj_kinematics(model, data)
        for side in SIDES:
            if feet[side].standing[i]:
                off[side][i] = (data.site(f"{side}_ankle").xpos - feet[side].ankle[i])[:2]
    far = False
    for side in SIDES:
        for run in runs(feet[side].standing):
            away = np.linalg.norm(off[side][run], axis=1)
            if away.max() > _ON_MARK:
                aside[side][run] += off[side][run][away.argmax()]
                far = True
    return far


def _opening(feet: dict[str, Footing]) -> float:
    both = feet["left"].standing & feet["right"].standing
    apart = feet["left"].moved - feet["right"].moved
    return float(np.linalg.norm(apart[both], axis=1).max(initial=0.0))


class _Poser:
    """Sample by sample, the pose that comes nearest."""

    def __init__(
        self, source: DancedPoses, body: Body, scale: float, feet: dict[str, Footing]
    ) -> None:
        self._source, self._body, self._scale, self._feet = source, body, scale, feet
        model = body.model
        names = [name for name in body.segments if not name.endswith("_hand")]
        self._directions = Directions(body, names)
        self._wanted = np.stack([source.directions[name] for name in names], axis=1)
        self._turned = {
            part: mink.FrameTask(part, "body", 0.0, cost)
            for part, cost in (("pelvis", _PELVIS), ("torso", _TORSO), ("head", _HEAD))
        }
        self._turned |= {thigh: mink.FrameTask(thigh, "body", 0.0, _TURNOUT) for thigh in THIGHS}
        self._pelvis = self._turned["pelvis"]
        self._soles = {s: mink.FrameTask(f"{s}_foot", "body", _FREE, _LOOSE) for s in SIDES}
        self._like_hers = _like_hers(model, source.angles)
        self._posture = mink.PostureTask(model, cost=self._posture_cost())
        self._com = mink.ComTask(_WEIGHT)
        self._floor = FeetOverFloor(model)
        steady = mink.DampingTask(model, cost=np.full(model.nv, _STEADY))
        self._tasks = [
            self._directions, *self._turned.values(), *self._soles.values(), self._posture, steady,
        ]  # fmt: skip
        self._pose = body.rest.copy()
        data = mujoco.MjData(model)
        data.qpos[:] = body.rest
        mujoco.mj_kinematics(model, data)
        owners = model.geom_bodyid[self._floor.soles]
        self._of = {
            side: np.isin(owners, [body.bodies[f"{side}_{part}"] for part in ("foot", "toe")])
            for side in SIDES
        }
        self._foot_from_ankle = {
            s: data.xpos[body.bodies[f"{s}_foot"]] - data.site(f"{s}_ankle").xpos for s in SIDES
        }

    def pose_all(
        self,
        weight: WeightPlan | None,
        progress: Callable[[int, int], None] | None,
        *,
        every: int = 1,
    ) -> Array:
        model = self._body.model
        self._pelvis.set_position_cost(_ROOT if weight is None else _ROOT_BALANCED)
        tasks = self._tasks if weight is None else [*self._tasks, self._com]
        configuration = mink.Configuration(model, q=self._body.rest)
        ranges: list[mink.Limit] = [mink.ConfigurationLimit(model, gain=1.0)]
        limits = [*ranges, LimbsApart(model), self._floor]
        samples = range(0, self._source.count, every)
        qpos = np.empty((len(samples), model.nq))
        for k, (i, row) in enumerate(zip(samples, qpos, strict=True)):
            self._ask(i)
            if weight is not None:
                self._com.set_target(weight.at(i / RATE)[0])
            if i == 0:
                configuration.update(self._pose)
            for _ in range(min(_EACH * every, _ANEW) if i else _FIRST):
                step = _step(configuration, tasks, limits, ranges)
                configuration.integrate_inplace(step, _DT)
            row[:] = configuration.q
            if k and row[3:7] @ qpos[k - 1, 3:7] < 0:
                row[3:7] *= -1.0
            if progress is not None and k % 50 == 0:
                progress(k, len(qpos))
        return qpos

    def _ask(self, i: int) -> None:
        source = self._source
        self._directions.target = self._wanted[i]
        for part in ("torso", "head"):
            rotation = mink.SO3.from_matrix(source.frames[part][i])
            self._turned[part].set_target(mink.SE3.from_rotation(rotation))
        for part in THIGHS:
            rotation = mink.SO3.from_matrix(source.thighs[part][i])
            self._turned[part].set_target(mink.SE3.from_rotation(rotation))
        turn = source.frames["pelvis"][i]
        ankles, shares = {}, {}
        for side in SIDES:
            reach = source.points[f"{side}_ankle"][i] - source.points[f"{side}_hip"][i]
            ankles[side] = turn @ self._body.hip(side) + self._scale * reach
            shares[side] = self._feet[side].laid[i] + 1e-3
        total = sum(shares.values())
        place = sum(shares[s] * (self._feet[s].ankle[i] - ankles[s]) for s in SIDES) / total
        self._pose[:3] = place
        quat = mink.SO3.from_matrix(turn)
        self._pose[3:7] = quat.wxyz
        self._pelvis.set_target(mink.SE3.from_rotation_and_translation(quat, place))
        for side, task in self._soles.items():
            foot = self._feet[side]
            laid = float(foot.laid[i])
            ankle = laid * foot.ankle[i] + (1.0 - laid) * (place + ankles[side])
            rotation = foot.turn[i]
            if laid < 1.0:
                free = Rotation.from_matrix(source.frames[f"{side}_foot"][i])
                way = (free.inv() * Rotation.from_matrix(rotation)).as_rotvec()
                rotation = (free * Rotation.from_rotvec(laid * way)).as_matrix()
            origin = ankle + rotation @ self._foot_from_ankle[side]
            level = _FREE + laid**4 * (_PLANTED - _FREE)
            task.set_position_cost(level)
            self._floor.clearance[self._of[side]] = (1.0 - laid) * _BRUSH if laid < 1.0 else -np.inf
            task.set_orientation_cost(_LOOSE + laid**4 * (_LAID - _LOOSE))
            task.set_target(
                mink.SE3.from_rotation_and_translation(mink.SO3.from_matrix(rotation), origin)
            )
        self._posture.set_target(self._like(i))

    def _like(self, i: int) -> Array:
        """The dancer's own angles, in the joints that both have."""
        model, pose = self._body.model, self._pose
        for joint, (name, sign, _) in self._like_hers.items():
            angle = sign * self._source.angles[name][i]
            pose[model.jnt_qposadr[joint]] = np.clip(angle, *model.jnt_range[joint])
        return pose

    def _posture_cost(self) -> Array:
        model = self._body.model
        cost = np.full(model.nv, _POSTURE)
        cost[:6] = 0.0
        for joint, (_, _, own) in self._like_hers.items():
            cost[model.jnt_dofadr[joint]] = own
        return cost


def _step(
    configuration: mink.Configuration,
    tasks: list[mink.Task],
    limits: list[mink.Limit],
    ranges: list[mink.Limit],
) -> Array:
    """A step of the inverse kinematics; within the joints' ranges alone where all limits can't be
    kept at once."""
    try:
        return np.asarray(mink.solve_ik(configuration, tasks, _DT, "daqp", 1e-6, limits=limits))
    except mink.NoSolutionFound:
        return np.asarray(mink.solve_ik(configuration, tasks, _DT, "daqp", 1e-6, limits=ranges))


def _like_hers(
    model: mujoco.MjModel, angles: dict[str, Array]
) -> dict[int, tuple[str, float, float]]:
    """Joints that the dancer has as well: by which name, sign and cost. Knees whatever their name:
    they bend to where there is more room."""
    found = {
        joint: (name, 1.0, _SHARED)
        for joint in range(1, model.njnt)
        if (name := model.joint(joint).name) in angles
    }
    for side in SIDES:
        joint = int(model.body_jntadr[model.body(f"{side}_shank").id])
        sign = 1.0 if model.jnt_range[joint].sum() > 0.0 else -1.0
        found[joint] = (f"{side}_knee_bend", sign, _KNEE)
    return found


def _contacts(motion: Motion, body: Body, feet: dict[str, Footing]) -> ContactSchedule:
    model = motion.model
    soles = sole_geoms(model)
    data = mujoco.MjData(model)
    points = np.empty((len(motion.time), len(soles), 3))
    for row, qpos in zip(points, motion.qpos, strict=True):
        data.qpos[:] = qpos
        mujoco.mj_kinematics(model, data)
        row[:] = sole_points(model, data, soles)
    bears = points[:, :, 2] < _TOUCHES
    for side in SIDES:
        mine = np.isin(
            model.geom_bodyid[soles], [body.bodies[f"{side}_{p}"] for p in ("foot", "toe")]
        )
        bears[:, mine] &= feet[side].standing[:, None]
    points[:, :, 2][bears] = 0.0
    return ContactSchedule(motion.time, soles, points, bears)
