"""The whole movement posed at once, so that no joint jumps from one sample to the next.

Sample by sample a pose has several answers: a thigh turned out or in under a straight knee, a limb
on either side of the end of a joint's range. Whoever takes the nearest each time jumps when it is
lost. So all samples are sought together,

    minimise  sum_t |W r_t(q_t)|^2  +  sum_t |S (q_{t+1} - 2 q_t + q_{t-1}) / h^2|^2

with r what the plan asks of a sample, its feet's places and its joints' ranges among them, and the
second term what it costs to accelerate. Gauss-Newton: each step solves one banded system, in
windows that overlap by more than an acceleration reaches.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import mink
import mujoco
import numpy as np
from numpy.typing import NDArray
from scipy.linalg import solveh_banded
from scipy.ndimage import maximum_filter1d, minimum_filter1d, uniform_filter1d

from enpointe.motion.retargeting.aloft import thrown
from enpointe.motion.retargeting.body import Body
from enpointe.motion.retargeting.pinning import pins_of
from enpointe.motion.retargeting.plan import Plan
from enpointe.motion.retargeting.posing import Asking

__all__ = ["flowing"]

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]
_TURN, _WAY = 4e-4, 2e-3
"""What acceleration costs, s^2/rad of joints and s^2/m of the root: with unit cost of a direction
what is quicker than 8 Hz goes, and of what hardly anything asks for, what is quicker than 2 Hz."""
_HELD = 100.0
"""Cost of a standing foot's place and of soles' heights, 1/m."""
_RANGE = 10.0
"""Cost of a joint beyond its range, 1/rad."""
_FASTEST, _HURRY = 18.0, 0.2
"""rad/s that a joint turns at most, and what it costs to turn faster, s/rad."""
_CAUTION = (0.1, 1e-3, 1e3)
"""Cost of going anywhere in a step, 1/rad^2: at first, least and most."""
_NEAR = 0.1
"""s: samples nearer than this to one whose cost rose go on with more caution."""
_WORSE, _SPARED = 1.01, 1e-3
"""A step made things worse where the cost nearby is more than so much of what it was, and more."""
_STAYS = 2e-4
"""A sample that would move by less, rad and m, stays."""
_FALLING = 40.0
"""Cost of a centre of mass that is off its parabola, 1/m."""
_STEPS, _STEPS_FLYING, _DONE = 16, 6, 5e-3
"""Steps at most, and what share of the cost the last saves."""
_LONGEST = 0.25
"""No joint goes farther in one step, rad, nor the root, m."""
_WINDOW, _OVERLAP = 2.5, 0.4
"""s."""
_FIRST, _SECOND = (-1.0, 1.0), (1.0, -2.0, 1.0)
"""Differences."""


def flowing(
    plan: Plan, body: Body, qpos: Array, progress: Callable[[int, int], None] | None = None
) -> Array:
    """Configurations (T, nq) that follow a plan without jumps.

    Args:
        plan: What is asked.
        body: Who is asked.
        qpos: (T, nq), where to begin.
        progress: Called with (done, all) now and then.
    """
    whole = _Whole(plan, body)
    found = whole.least(qpos, _STEPS, progress)
    if plan.aloft.any():
        whole.fly(found)
        found = whole.least(found, _STEPS_FLYING, progress)
    return found


def _nearby(cost: Array, reach: int) -> Array:
    return np.asarray(uniform_filter1d(cost, 2 * reach + 1, mode="nearest"))


def _shortened(step: Array, reach: int) -> Array:
    """A step (T, nv) of which no joint goes too far, neighbours shortened alike."""
    size = np.abs(step).max(axis=1)
    share = np.minimum(1.0, _LONGEST / np.maximum(size, 1e-12))
    share = uniform_filter1d(minimum_filter1d(share, 2 * reach + 1), 2 * reach + 1)
    return np.asarray(step * share[:, None])


@dataclass(frozen=True)
class _Linear:
    """The problem about a guess.

    Attributes:
        qpos: (T, nq), the guess.
        hessians: (T, nv, nv), of what is asked of each sample (Gauss and Newton).
        slopes: (T, nv).
        asked: (T,), what is left of what is asked.
        bend: (T - 2, nv), second differences.
        excess: (T - 1, nv), what first differences are beyond the fastest.
        cost: (T,), all of it.
    """

    qpos: Array
    hessians: Array
    slopes: Array
    asked: Array
    bend: Array
    excess: Array
    cost: Array


class _Whole:
    """The problem, linear about a guess."""

    def __init__(self, plan: Plan, body: Body) -> None:
        self._asking, self._model = Asking(plan, body), body.model
        self._pins = pins_of(plan, body)
        self._weight, self._thrown = mink.ComTask(_FALLING), dict[int, Array]()
        self._period = float(plan.time[1])
        model = body.model
        joints = model.dof_jntid[6:]
        limited = model.jnt_limited[joints].astype(bool)
        self._low = np.where(limited, model.jnt_range[joints, 0], -np.inf)
        self._high = np.where(limited, model.jnt_range[joints, 1], np.inf)
        cost = np.full(model.nv, _TURN)
        cost[:3] = _WAY
        self._smooth = (cost / self._period**2) ** 2
        self._fastest = np.full(model.nv, _FASTEST * self._period)
        self._fastest[:6] = np.inf
        self._hurry = (np.full(model.nv, _HURRY) / self._period) ** 2

    def fly(self, qpos: Array) -> None:
        """Ask that the weight of configurations (T, nq) fall as it should from here on."""
        plan, data = self._asking.plan, mujoco.MjData(self._model)
        com = np.empty((len(qpos), 3))
        for i in np.flatnonzero(plan.aloft):
            data.qpos[:] = qpos[i]
            mujoco.mj_kinematics(self._model, data)
            mujoco.mj_comPos(self._model, data)
            com[i] = data.subtree_com[0]
        self._thrown = thrown(plan.time, com, plan.aloft, plan.scale)

    def least(self, qpos: Array, steps: int, progress: Callable[[int, int], None] | None) -> Array:
        """The configurations (T, nq) that cost least, sought from a guess."""
        reach = max(round(_NEAR / self._period), 1)
        caution = np.full(len(qpos), _CAUTION[0])
        here = self.about(qpos)
        for count in range(steps):
            if progress is not None:
                progress(count, steps)
            step = _shortened(self.step(here, caution), reach)
            step[np.abs(step).max(axis=1) < _STAYS] = 0.0
            there = self.about(self.moved(here.qpos, step), here)
            worse = _nearby(there.cost, reach) > _WORSE * _nearby(here.cost, reach) + _SPARED
            caution = np.clip(np.where(worse, 10.0, 0.2) * caution, *_CAUTION[1:])
            if worse.any():
                # Back where it went wrong, and smoothly from there to where it went well.
                wrong = maximum_filter1d(worse * 1.0, 2 * reach + 1)
                share = np.round(1.0 - _nearby(wrong, reach), 3)
                there = self.about(self.moved(here.qpos, share[:, None] * step), here, there)
            gained = float(here.cost.sum() - there.cost.sum())
            here = there
            if abs(gained) < _DONE * float(here.cost.sum()):
                break
        return here.qpos

    def moved(self, qpos: Array, step: Array) -> Array:
        """Configurations (T, nq) after a step (T, nv); those that make none are the same."""
        found = qpos.copy()
        for i in np.flatnonzero(step.any(axis=1)):
            mujoco.mj_integratePos(self._model, found[i], step[i], 1.0)
        return found

    def about(self, qpos: Array, *known: _Linear) -> _Linear:
        """The problem about a guess (T, nq); samples that are as in a known one are from there."""
        model, count = self._model, len(qpos)
        hessians, slopes = np.empty((count, model.nv, model.nv)), np.empty((count, model.nv))
        asked, new = np.empty(count), np.ones(count, dtype=bool)
        for each in known:
            same = new & (qpos == each.qpos).all(axis=1)
            hessians[same], slopes[same] = each.hessians[same], each.slopes[same]
            asked[same] = each.asked[same]
            new &= ~same
        configuration = mink.Configuration(model, q=qpos[0])
        for i in np.flatnonzero(new):
            configuration.update(qpos[i])
            hessians[i], slopes[i], asked[i] = self._asked(configuration, int(i))
        changes = self._changes(qpos)
        bend = np.diff(changes, axis=0)
        excess = changes - np.clip(changes, -self._fastest, self._fastest)
        cost = asked.copy()
        cost[1:-1] += bend**2 @ self._smooth
        cost[1:] += excess**2 @ self._hurry
        return _Linear(qpos, hessians, slopes, asked, bend, excess, cost)

    def step(self, about: _Linear, caution: Array) -> Array:
        """(T, nv), towards less cost.

        Args:
            about: Where from.
            caution: (T,), what it costs to go anywhere (Levenberg and Marquardt).
        """
        count, nv = about.slopes.shape
        width, over = (max(round(s / self._period), 2) for s in (_WINDOW, _OVERLAP))
        step = np.empty((count, nv))
        for start in range(0, count, width):
            end = min(start + width, count)
            first, last = max(start - over, 0), min(end + over, count)
            near = slice(first, last)
            hessians = about.hessians[near] + caution[near, None, None] * np.eye(nv)
            part = self._solved(hessians, about, first)
            step[start:end] = part[start - first : end - first]
        return step

    def _asked(self, configuration: mink.Configuration, i: int) -> tuple[Array, Array, float]:
        self._asking.ask(i)
        data = configuration.data
        residuals = [task.compute_qp_residual(configuration) for task in self._asking.wanted]
        rows = [residual[0] for residual in residuals]
        off = [-residual[1] for residual in residuals]
        for foot in self._pins.values():
            for pin in foot.misplaced(data, i):
                if pin.place:
                    rows.append(_HELD * pin.jacobian)
                    off.append(_HELD * pin.off)
        if i in self._thrown:
            self._weight.set_target(self._thrown[i])
            jacobian, error, _ = self._weight.compute_qp_residual(configuration)
            rows.append(jacobian)
            off.append(-error)
        angles = configuration.q[7:]
        beyond = np.minimum(angles - self._low, 0.0) + np.maximum(angles - self._high, 0.0)
        ended = np.flatnonzero(beyond)
        rows.append(_RANGE * np.eye(self._model.nv)[ended + 6])
        off.append(_RANGE * beyond[ended])
        jacobian, error = np.vstack(rows), np.concatenate(off)
        return jacobian.T @ jacobian, jacobian.T @ error, float(error @ error)

    def _changes(self, qpos: Array) -> Array:
        """From each of T samples to the next, (T - 1, nv)."""
        changes = np.zeros((len(qpos) - 1, self._model.nv))
        for moved, one, other in zip(changes, qpos[:-1], qpos[1:], strict=True):
            mujoco.mj_differentiatePos(self._model, moved, 1.0, one, other)
        return changes

    def _solved(self, hessians: Array, about: _Linear, first: int) -> Array:
        """The step of the samples (K, nv) from `first` on; what is before and after them stays."""
        count, nv = len(hessians), self._model.nv
        upper = 2 * nv
        right = -about.slopes[first : first + count]
        band = np.zeros((upper + 1, count, nv))
        for column in range(nv):
            for row in range(column + 1):
                band[upper + row - column, :, column] = hessians[:, row, column]
        samples = len(about.qpos)
        for second in range(max(first - 2, 0), min(first + count, samples - 2)):
            _couple(band, right, second - first, _SECOND, self._smooth, about.bend[second])
        hurried = self._hurry * (about.excess != 0.0)
        for change in range(max(first - 1, 0), min(first + count, samples - 1)):
            if hurried[change].any():
                _couple(band, right, change - first, _FIRST, hurried[change], about.excess[change])
        found = solveh_banded(band.reshape(upper + 1, -1), right.ravel(), check_finite=False)
        return np.asarray(found).reshape(count, nv)


def _couple(
    band: Array, right: Array, start: int, weights: tuple[float, ...], cost: Array, now: Array
) -> None:
    """Add the cost of a difference over samples to the banded system, in place.

    Args:
        band: (2 nv + 1, K, nv), the upper band, joints of samples in order.
        right: (K, nv).
        start: The first sample that the difference is over.
        weights: Of the samples in it.
        cost: (nv,), of its square.
        now: (nv,), what it is.
    """
    count, nv = right.shape
    for k, one in enumerate(weights):
        if not 0 <= start + k < count:
            continue
        right[start + k] -= one * cost * now
        for m in range(k, len(weights)):
            if start + m < count:
                band[2 * nv - (m - k) * nv, start + m] += one * weights[m] * cost
