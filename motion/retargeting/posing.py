"""The body posed after its plan, sample by sample, by differential inverse kinematics (mink)."""

from __future__ import annotations

from collections.abc import Callable

import mink
import mujoco
import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from enpointe.models.anatomy import SIDES
from enpointe.motion.retargeting.body import NONE, Body
from enpointe.motion.retargeting.holding import ramped
from enpointe.motion.retargeting.landmarks import sided
from enpointe.motion.retargeting.plan import Plan

__all__ = ["Asking", "Directions", "posed"]

Array = NDArray[np.float64]
_DT = 1.0
"""Nominal step of the differential IK: with unit gain a step closes the whole linear error."""
_FIRST, _EACH = 30, 2
"""Steps for the first sample, and for each that starts from its neighbour."""
_DIRECTION = 1.0
"""Cost of a segment that points elsewhere, 1/rad."""
_HAND = 0.3
_PELVIS, _TORSO, _HEAD = 2.3, 1.0, 0.5
_ROOT, _ROOT_ALOFT = 1.5, 12.0
"""Costs of the pelvis' place, 1/m: over feet it gives way to legs of other lengths, and in the air
to nothing."""
_ALOFT = 0.15
"""s: it goes from the one to the other in so long."""
_NEARS = 0.1
"""s: a foot comes to the floor, and leaves it, over so long before and after."""
_PLANTED, _FREE = 30.0, 0.5
"""Costs of an ankle's place, 1/m, on the floor and in the air."""
_LAID, _LOOSE = 1.0, 0.15
"""Costs of a foot's direction, 1/rad, on the floor and in the air."""
_POSTURE = 0.05
"""Cost of joint angles, 1/rad: what nothing asks for hangs as at rest."""
_STEADY, _STEADY_FOOT = 0.15, 0.35
"""Costs of moving, 1/rad. The second is of what turns limbs about themselves, which a straight one
would at a whim, and of feet, which in the air are captured so badly that it averages them."""
_TWIST = 0.9
"""A hinge turns a limb about itself if the cosine between them is above this."""


_DOUBTED = 0.3
"""A segment farther off than this, as a chord, is believed half, the cost of the square halved."""
_LOST, _BETTER = 0.45, 0.6
"""A segment farther off than this, as a chord of the unit circle, may be lost on the wrong side of
a joint's range: the pose is sought anew, and kept if it leaves less than this share of the cost."""


class Directions(mink.Task):
    """Segments that point where they should: (b - a) / length to a unit vector."""

    def __init__(self, body: Body, names: list[str]) -> None:
        segments = body.segments
        self._ends = [segments[name] for name in names]
        cost = [_HAND if name.endswith("_hand") else _DIRECTION for name in names]
        super().__init__(cost=np.repeat(cost, 3))
        self.target = np.zeros((len(names), 3))

    def compute_qp_residual(self, configuration: mink.Configuration) -> tuple[Array, Array, float]:
        """Each segment's believed the less the farther it is off: nobody's may be lost."""
        jacobian, error, damping = super().compute_qp_residual(configuration)
        off = np.linalg.norm(self.compute_error(configuration).reshape(-1, 3), axis=1)
        belief = np.repeat(1.0 / np.sqrt(1.0 + (off / _DOUBTED) ** 2), 3)
        return belief[:, None] * jacobian, belief * error, damping

    def compute_error(self, configuration: mink.Configuration) -> Array:
        places = configuration.data.site_xpos
        found = [(places[end] - places[start]) / length for start, end, length in self._ends]
        return np.asarray((np.array(found) - self.target).ravel())

    def compute_jacobian(self, configuration: mink.Configuration) -> Array:
        model, data = configuration.model, configuration.data
        rows = np.empty((len(self._ends), 3, model.nv))
        found: dict[int, Array] = {}
        for row, (start, end, length) in zip(rows, self._ends, strict=True):
            for site in (start, end):
                if site not in found:
                    found[site] = np.empty((3, model.nv))
                    mujoco.mj_jacSite(model, data, found[site], None, site)
            row[:] = (found[end] - found[start]) / length
        return rows.reshape(-1, model.nv)


def posed(plan: Plan, body: Body, progress: Callable[[int, int], None] | None = None) -> Array:
    """Configurations (T, nq) that follow a plan.

    Args:
        plan: What is asked.
        body: Who is asked.
        progress: Called with (done, all) now and then.
    """
    asking = Asking(plan, body)
    model = body.model
    configuration = mink.Configuration(model, q=asking.upright(0))
    limits = [mink.ConfigurationLimit(model, gain=1.0)]

    def approach(steps: int) -> Array:
        for _ in range(steps):
            step = mink.solve_ik(configuration, asking.tasks, _DT, "daqp", 1e-6, limits=limits)
            configuration.integrate_inplace(step, _DT)
        return np.array(configuration.q)

    qpos = np.empty((len(plan.time), model.nq))
    for i, row in enumerate(qpos):
        asking.ask(i)
        row[:] = approach(_EACH if i else _FIRST)
        if asking.farthest(configuration) > _LOST:
            cost = asking.cost(configuration)
            configuration.update(asking.upright(i))
            anew = approach(_FIRST)
            if asking.cost(configuration) < _BETTER * cost:
                row[:] = anew
            else:
                configuration.update(row)
        if i and row[3:7] @ qpos[i - 1, 3:7] < 0:
            row[3:7] *= -1.0
        if progress is not None and i % 50 == 0:
            progress(i, len(qpos))
    return qpos


class Asking:
    """A plan as tasks of the inverse kinematics."""

    def __init__(self, plan: Plan, body: Body) -> None:
        model = body.model
        names = [name for name in body.segments if name in plan.directions]
        self._directions = Directions(body, names)
        self._wanted = np.stack([plan.directions[name] for name in names], axis=1)
        self._limbs = np.array([not name.endswith("_hand") for name in names])
        self.plan, self._rest = plan, body.rest
        self.frames: dict[str, Array] = {}
        self._turned: dict[str, mink.FrameTask] = {}
        self._across: dict[str, Array] = {}
        for part, cost in (("pelvis", _PELVIS), ("torso", _TORSO), ("head", _HEAD)):
            if part in body.bodies and part in plan.frames:
                self._add_turned(body, part, plan.frames[part], cost)
        down = np.logical_or(*(plan.feet[side].kind != NONE for side in SIDES))
        near = ramped(down, _ALOFT, 1.0 / float(plan.time[1]))
        self._root = near * _ROOT + (1.0 - near) * _ROOT_ALOFT
        self._ankles: dict[str, mink.FrameTask] = {}
        self._near: dict[str, Array] = {}
        for side in SIDES:
            foot = plan.feet[side]
            self._near[side] = ramped(foot.kind != NONE, _NEARS, 1.0 / float(plan.time[1]))
            self._add_turned(body, f"{side}_foot", foot.turn, _LAID)
            if f"{side}_toe" in body.bodies:
                bent = Rotation.from_matrix(foot.turn) * Rotation.from_euler(
                    "y", -foot.raised[:, None]
                )
                self._add_turned(body, f"{side}_toe", bent.as_matrix(), _LAID)
            site = model.site(body.sites[f"{side}_ankle"]).name
            self._ankles[side] = mink.FrameTask(site, "site", _PLANTED, 0.0)
        self._placed: dict[str, mink.FrameTask] = {}
        self._targets: dict[str, list[mink.SE3]] = {}
        self._costs: dict[str, Array] = {}
        self._ask_all()
        self._posture = mink.PostureTask(model, cost=_posture_cost(model))
        self._posture.set_target(body.rest)
        steady = mink.DampingTask(model, cost=_steady_cost(body))
        self.wanted: list[mink.Task] = [
            self._directions,
            *self._turned.values(),
            *self._ankles.values(),
            self._posture,
        ]
        self.tasks: list[mink.Task] = [*self.wanted, steady]

    def _add_turned(self, body: Body, part: str, turns: Array, cost: float) -> None:
        name = body.model.body(body.bodies[part]).name
        self._turned[part] = mink.FrameTask(name, "body", 0.0, cost)
        whole = Rotation.from_matrix(turns @ body.turned[part])
        self._across[part] = 1.0 - np.abs(body.turned[part].T[:, 0]).round()
        self.frames[part] = whole.as_quat(scalar_first=True)

    def upright(self, i: int) -> Array:
        """The pose at rest, with the pelvis as sample `i` has it."""
        pose = self._rest.copy()
        pose[:3] = self.plan.pelvis[i]
        pose[3:7] = self.frames["pelvis"][i]
        return pose

    def farthest(self, configuration: mink.Configuration) -> float:
        """How far the worst of the segments points from where it should, as a chord of 1."""
        off = self._directions.compute_error(configuration).reshape(-1, 3)[self._limbs]
        return float(np.linalg.norm(off, axis=1).max())

    def cost(self, configuration: mink.Configuration) -> float:
        """What is left of all that is asked."""
        tasks = [self._directions, *self._turned.values(), *self._ankles.values()]
        return sum(
            float(np.sum((task.cost * task.compute_error(configuration)) ** 2)) for task in tasks
        )

    def ask(self, i: int) -> None:
        """Set the targets and costs of sample `i`."""
        self._directions.target = self._wanted[i]
        for name, task in self._placed.items():
            task.transform_target_to_world = self._targets[name][i]
            task.cost = self._costs[name][i]

    def _ask_all(self) -> None:
        """Targets and costs of every sample: each is asked for some thirty times."""
        plan = self.plan
        for part in self._turned:
            place = plan.pelvis if part == "pelvis" else np.zeros_like(plan.pelvis)
            self._aim(part, np.hstack([self.frames[part], place]), self._turned[part])
        self._costs["pelvis"][:, :3] = self._root[:, None]
        for side, task in self._ankles.items():
            near = self._near[side][:, None]
            upright = np.tile([1.0, 0.0, 0.0, 0.0], (len(near), 1))
            self._aim(side, np.hstack([upright, plan.feet[side].ankle]), task)
            self._costs[side][:, :3] = _FREE * (_PLANTED / _FREE) ** near
            for part in (f"{side}_foot", f"{side}_toe"):
                if part in self._turned:
                    # How a foot in the air is rolled about itself, captures do not know.
                    loose = _LOOSE * self._across[part]
                    self._costs[part][:, 3:] = loose + near * (_LAID - loose)

    def _aim(self, name: str, targets: Array, task: mink.FrameTask) -> None:
        """Keep what a frame is asked: turns and places (T, 7), and its costs, its own without."""
        self._placed[name] = task
        self._targets[name] = [mink.SE3(target) for target in targets]
        self._costs[name] = np.tile(task.cost, (len(targets), 1))


def _posture_cost(model: mujoco.MjModel) -> Array:
    cost = np.full(model.nv, _POSTURE)
    cost[:6] = 0.0
    return cost


def _steady_cost(body: Body) -> Array:
    model = body.model
    cost = np.full(model.nv, _STEADY)
    feet = [body.bodies[part] for part in sided("foot", "toe") if part in body.bodies]
    cost[np.isin(model.dof_bodyid, feet)] = _STEADY_FOOT
    data = mujoco.MjData(model)
    data.qpos[:] = body.rest
    mujoco.mj_kinematics(model, data)
    for start, end, length in body.segments.values():
        along = (data.site_xpos[end] - data.site_xpos[start]) / length
        mine = model.dof_bodyid == model.site_bodyid[start]
        twists = np.abs(data.xaxis[model.dof_jntid] @ along) > _TWIST
        cost[mine & twists] = _STEADY_FOOT
    return cost
