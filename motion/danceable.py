"""From a motion that can be seen to one that can be danced: standing feet, carried weight.

The kinematic motion says what the limbs do, which soles are on the floor, and where the weight
should be. The corners of its legs are rounded to what muscles can do, the way of the weight is
planned so that the floor can carry it (`plan_weight`), and the whole body is then brought onto
both, sample by sample: soles on their places, centre of mass on its way, everything else as near as
may be. Key poses keep their moments.
"""

from __future__ import annotations

from dataclasses import dataclass

import mujoco
import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import CubicSpline
from scipy.ndimage import convolve1d
from scipy.signal.windows import parzen

from enpointe.motion.bearing import bearing_columns
from enpointe.motion.contact_plan import ContactPlan, plan_contacts
from enpointe.motion.motion import Motion
from enpointe.motion.weight_plan import WeightPlan, plan_height, plan_weight

__all__ = ["Danceable", "danceable"]

Array = NDArray[np.float64]
RATE = 100.0
"""Samples a second at which the body is solved; a spline joins them."""
ROUNDING = 0.15
"""Width of the window that rounds legs and root, s."""
SOFTENING = 0.12
"""s over which a foot gives itself to the floor and takes itself away."""
MOMENTUM = 0.3
"""Width of the window that angular momentum is averaged over before weight is planned for it, s."""
SETTLING = (0.1, 0.05, 0.03)
"""Widths of the windows that the body's way to its contacts is averaged over, s, one after the
other: an average leaves the floor a little, and is brought back to it."""
CLEARANCE = 0.012
"""Air under a foot that slides or passes, m: it must not take weight by accident."""
ITERATIONS = 4
_CONTACT, _WEIGHT, _HEIGHT, _TRUNK, _POSTURE = 300.0, 100.0, 30.0, 3.0, 1.0
_STEADY = 3.0
"""How much dearer a change of the arms, neck and waist is than one of the legs."""


@dataclass(frozen=True)
class Danceable:
    """A motion that a body with weight can follow.

    Attributes:
        motion: The motion.
        contacts: The soles on the floor at the same times.
        weight: The planned way of the weight, at `RATE`.
    """

    motion: Motion
    contacts: ContactPlan
    weight: WeightPlan


def danceable(motion: Motion) -> Danceable:
    """Make a motion danceable.

    Args:
        motion: Evenly sampled, with its feet on the floor where they stand.
    """
    model = motion.model
    contacts = plan_contacts(motion)
    every = max(round(1.0 / (RATE * float(motion.time[1] - motion.time[0]))), 1)
    chosen = np.arange(0, len(motion.time), every)
    if chosen[-1] != len(motion.time) - 1:
        chosen = np.append(chosen, len(motion.time) - 1)
    time = motion.time[chosen]
    rounded = _rounded(motion, ROUNDING)[chosen]
    step = float(time[1] - time[0])
    body = _Body(model, contacts.soles)
    com, momentum = body.movement(rounded, step)
    supports = [contacts.support(int(k)) for k in chosen]
    com[:, 2] = plan_height(time, com[:, 2], np.asarray(contacts.planted[chosen].any(axis=1)))
    # What is quicker than this the trunk and arms take up by themselves.
    slow = convolve1d(momentum, _window(time, MOMENTUM), axis=0, mode="nearest")
    rate = np.gradient(slow, step, axis=0)
    weight = plan_weight(time, com, rate, supports, float(model.body_mass.sum()))
    share = _softened(contacts.planted, motion.time)[chosen]
    places = contacts.places[chosen]
    asked = rounded
    for width in SETTLING:
        solved = _brought(body, asked, weight.com, com[:, 2], places, share)
        asked = _settled(model, asked, solved, _window(time, width))
    path = CubicSpline(time, asked)(motion.time)
    for row in path:
        mujoco.mj_normalizeQuat(model, row)
    danced = Motion.from_qpos(
        model, motion.time, path, events=motion.events, name=f"{motion.name}, danceable"
    )
    return Danceable(danced, contacts, weight)


def _brought(
    body: _Body, asked: Array, com: Array, height: Array, places: Array, share: Array
) -> Array:
    """Every sample of `asked` (N, nq) brought onto its contacts and the way of the weight."""
    qpos, guess = np.empty_like(asked), asked[0]
    for i in range(len(asked)):
        wanted = np.array([com[i, 0], com[i, 1], height[i]])
        qpos[i] = body.brought(guess, asked[i], wanted, places[i], share[i])
        guess = _carried(body.model, asked[i], qpos[i], asked[min(i + 1, len(asked) - 1)])
    return qpos


class _Body:
    """Brings one model onto wanted places by damped Gauss-Newton steps in its tangent space."""

    def __init__(self, model: mujoco.MjModel, soles: NDArray[np.int64]) -> None:
        self.model, self.data = model, mujoco.MjData(model)
        self._soles = soles
        self._radius = model.geom_size[soles, 0]
        self._cost = np.full(model.nv, _POSTURE)
        self._cost[:3] = 0.02
        self._cost[3:6] = _TRUNK
        for j in range(1, model.njnt):
            if model.jnt_qposadr[j] not in bearing_columns(model):
                self._cost[model.jnt_dofadr[j]] = _STEADY
        self._torso = model.body("torso").id

    def movement(self, qpos: Array, step: float) -> tuple[Array, Array]:
        """Centre of mass and angular momentum about it, (N, 3) each."""
        com, momentum = np.empty((2, len(qpos), 3))
        velocity = np.zeros(self.model.nv)
        for i in range(len(qpos)):
            a, b = max(i - 1, 0), min(i + 1, len(qpos) - 1)
            mujoco.mj_differentiatePos(self.model, velocity, (b - a) * step, qpos[a], qpos[b])
            self._place(qpos[i])
            self.data.qvel[:] = velocity
            mujoco.mj_comVel(self.model, self.data)
            mujoco.mj_subtreeVel(self.model, self.data)
            com[i], momentum[i] = self.data.subtree_com[0], self.data.subtree_angmom[0]
        return com, momentum

    def brought(self, guess: Array, asked: Array, com: Array, places: Array, share: Array) -> Array:
        """The configuration near `asked` with its weight at `com` and its soles on their places.

        Args:
            guess: (nq,), where to begin.
            asked: (nq,).
            com: (3,), m.
            places: (S, 2), m.
            share: (S,), how much each sole is held to its place, 0 to 1.
        """
        qpos, away = guess.copy(), np.zeros(self.model.nv)
        low, high = self.model.jnt_range[1:].T
        sunk = np.zeros(len(share), dtype=bool)
        for _ in range(ITERATIONS):
            self._place(qpos)
            # Once too low, always held up: else every other step would let it sink again.
            sunk |= self._points()[:, 2] < CLEARANCE * (1.0 - share)
            rows, errors = self._rows(com, places, share, sunk)
            mujoco.mj_differentiatePos(self.model, away, 1.0, qpos, asked)
            matrix = rows.T @ rows + np.diag(self._cost**2)
            change = np.linalg.solve(matrix, rows.T @ errors + self._cost**2 * away)
            mujoco.mj_integratePos(self.model, qpos, change, 1.0)
            qpos[7:] = np.clip(qpos[7:], low, high)
        return qpos

    def _points(self) -> Array:
        points = self.data.geom_xpos[self._soles].copy()
        points[:, 2] -= self._radius
        return points

    def _rows(
        self, com: Array, places: Array, share: Array, sunk: NDArray[np.bool_]
    ) -> tuple[Array, Array]:
        model, data = self.model, self.data
        points, jacobian = self._points(), np.zeros((3, model.nv))
        rows, errors = [], []
        for s in np.flatnonzero(sunk | (share > 1e-3)):
            point, held = points[s], share[s]
            mujoco.mj_jac(model, data, jacobian, None, point, model.geom_bodyid[self._soles[s]])
            error = np.array([*(places[s] - point[:2]), CLEARANCE * (1.0 - held) - point[2]])
            gain = _CONTACT * np.array([held, held, 1.0 if sunk[s] else held])
            rows.append(gain[:, None] * jacobian)
            errors.append(gain * error)
        mujoco.mj_jacSubtreeCom(model, data, jacobian, 0)
        gain = np.array([_WEIGHT, _WEIGHT, _HEIGHT])
        rows.append(gain[:, None] * jacobian)
        errors.append(gain * (com - data.subtree_com[0]))
        return np.vstack(rows), np.concatenate(errors)

    def _place(self, qpos: Array) -> None:
        self.data.qpos[:] = qpos
        mujoco.mj_kinematics(self.model, self.data)
        mujoco.mj_comPos(self.model, self.data)


def _carried(model: mujoco.MjModel, here: Array, solved: Array, ahead: Array) -> Array:
    """`solved` moved on by what the asked motion moves from `here` to `ahead`: the next guess."""
    change = np.zeros(model.nv)
    mujoco.mj_differentiatePos(model, change, 1.0, here, ahead)
    guess = solved.copy()
    mujoco.mj_integratePos(model, guess, change, 1.0)
    return guess


def _settled(model: mujoco.MjModel, asked: Array, solved: Array, window: Array) -> Array:
    """`solved` without the jerks where soles begin and end: its way from `asked` averaged."""
    way = np.zeros((len(asked), model.nv))
    for row, a, b in zip(way, asked, solved, strict=True):
        mujoco.mj_differentiatePos(model, row, 1.0, a, b)
    way = convolve1d(way, window, axis=0, mode="nearest")
    settled = asked.copy()
    for qpos, change in zip(settled, way, strict=True):
        mujoco.mj_integratePos(model, qpos, change, 1.0)
    return settled


def _rounded(motion: Motion, width: float) -> Array:
    qpos = motion.qpos.copy()
    for i in range(1, len(qpos)):
        if qpos[i, 3:7] @ qpos[i - 1, 3:7] < 0:
            qpos[i, 3:7] *= -1
    smooth = qpos.copy()
    columns = bearing_columns(motion.model)
    window = _window(motion.time, width)
    smooth[:, columns] = convolve1d(qpos[:, columns], window, axis=0, mode="nearest")
    smooth[:, 3:7] /= np.linalg.norm(smooth[:, 3:7], axis=1, keepdims=True)
    return np.asarray(smooth)


def _softened(planted: NDArray[np.bool_], time: Array) -> Array:
    window = _window(time, SOFTENING)
    held = convolve1d(planted.astype(float), window, axis=0, mode="nearest")
    # While it is planned to stand a sole is held wholly; before and after it is led there and away.
    return np.asarray(np.where(planted, 1.0, np.clip(2.0 * held, 0.0, 1.0) ** 2))


def _window(time: Array, width: float) -> Array:
    rate = 1.0 / float(time[1] - time[0])
    window = parzen(2 * int(width * rate / 2) + 1, sym=True)
    return np.asarray(window / window.sum())
