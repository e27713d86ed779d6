"""What the body should do, each wish a small class: rows A x = b, kept by weighted least squares.

x = [qacc, lambda], see `Instant`. A task's rows are in its own unit; its weight says what a squared
unit costs. Gains are per second squared (stiffness) and per second (damping): a task alone would
make its error obey  e'' + damping e' + stiffness e = 0.

The tasks and their weights grew from trials that held nine poses on one leg; leaving `CentreOfMass`
out made the dancer fall in all that were tried without it.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import ClassVar, Protocol

import numpy as np
from numpy.typing import NDArray

from enpointe.controllers.wholebody.goal import Goal
from enpointe.controllers.wholebody.instant import Instant, skew
from enpointe.controllers.wholebody.rows import Direct, Rows, repeated

__all__ = [
    "AngularMomentum",
    "CentreOfMass",
    "Contact",
    "Landing",
    "Orientation",
    "Posture",
    "SwingFoot",
    "Task",
]

Array = NDArray[np.float64]


class Task(Protocol):
    """One wish."""

    name: ClassVar[str]

    def rows(self, instant: Instant, goal: Goal) -> Rows | Direct:
        """Its rows at this moment; none where it does not apply."""


@dataclass(frozen=True, slots=True)
class CentreOfMass:
    """The floor's forces drive the centre of mass:  sum f / m - g = c''.

    Horizontally by its divergent component (capture point) xi = c + c' / omega with
    omega = sqrt(g / c_z): the zero-moment point is asked to be p = p_r + k (xi - xi_r), so

        c'' = c''_r + omega^2 (k - 1) (c_r - c) + omega k (c'_r - c'),

    whose xi-error decays at omega (k - 1) (Englsberger et al. 2013; Hof et al. 2005). Vertically a
    spring and damper.

    Attributes:
        weight: Per (m/s^2)^2.
        capture_gain: k.
        stiffness: Vertical, 1/s^2.
        damping: Vertical, 1/s.
    """

    name: ClassVar[str] = "centre of mass"
    weight: float = 2000.0
    capture_gain: float = 8.0
    stiffness: float = 300.0
    damping: float = 35.0

    def rows(self, instant: Instant, goal: Goal) -> Rows:
        if len(instant.edges) == 0:
            return _nothing(instant.forces)
        target = self.acceleration(instant, goal)
        target[2] += instant.gravity
        weight = repeated(self.weight, 3)
        return Rows(instant.edges.T / instant.mass, target, weight, instant.forces)

    def acceleration(self, instant: Instant, goal: Goal) -> Array:
        """The acceleration asked for, (3,), m/s^2."""
        omega = math.sqrt(instant.gravity / max(float(instant.com[2]), 0.1))
        level = omega**2 * (self.capture_gain - 1.0)
        stiffness = np.array([level, level, self.stiffness])
        damping = np.array([omega * self.capture_gain] * 2 + [self.damping])
        feedback = stiffness * (goal.com - instant.com)
        feedback += damping * (goal.com_velocity - instant.com_velocity)
        return np.asarray(goal.com_acceleration + feedback)


@dataclass(frozen=True, slots=True)
class AngularMomentum:
    """The floor's forces turn the body:  sum (p - c) x f = L'_r + k (L_r - L), about the CoM.

    Attributes:
        weight: Per (N m)^2.
        gain: k, 1/s.
    """

    name: ClassVar[str] = "angular momentum"
    weight: float = 0.05
    gain: float = 5.0

    def rows(self, instant: Instant, goal: Goal) -> Rows:
        if len(instant.edges) == 0:
            return _nothing(instant.forces)
        arms = instant.points[instant.active] - instant.com
        moments = instant.edges.reshape(len(arms), -1, 3) @ skew(arms).transpose(0, 2, 1)
        error = goal.angular_momentum - instant.angular_momentum
        target = goal.angular_momentum_rate + self.gain * error
        weight = repeated(self.weight, 3)
        return Rows(moments.reshape(-1, 3).T, target, weight, instant.forces)


@dataclass(frozen=True, slots=True)
class Contact:
    """A sole that bears stays where it is, on the floor:  J qacc = -J' v - k J v - s h.

    h is its height above the floor, upwards, where it has not quite come down: weight is counted
    on it already. A wish and not a constraint, since six points of one foot can't all be kept
    independently. One that pivots goes over the floor with its reference instead of stopping:
    J qacc = p''_r - J' v + k (p'_r - J v).

    Attributes:
        weight: Per (m/s^2)^2.
        damping: k, 1/s.
        stiffness: s, 1/s^2.
        pivots: Whether a sole may be meant to turn or slide while it bears.
    """

    name: ClassVar[str] = "contact"
    weight: float = 300.0
    damping: float = 40.0
    stiffness: float = 400.0
    pivots: bool = False

    def rows(self, instant: Instant, goal: Goal) -> Rows:
        active = instant.active
        jacobian = instant.jacobians.take(active, axis=0).reshape(-1, instant.nv)
        towards = -(instant.drifts + self.damping * instant.velocities)[active]
        towards[:, 2] -= self.stiffness * np.maximum(instant.points[active, 2], 0.0)
        if self.pivots:
            led = goal.point_acceleration[active] + self.damping * goal.point_velocity[active]
            towards[:, :2] += led[:, :2]
        target = towards.ravel()
        return Rows(jacobian, target, repeated(self.weight, len(target)), instant.accelerations)


@dataclass(frozen=True, slots=True)
class Landing:
    """A sole that should bear and is off the floor comes down:  J_z qacc = -J_z' v - k J_z v - s h.

    A push lifts heels, and forces can't be planned under them: what stands then is a line of toes.
    Without this task the trunk bends and bends to keep her over that line, and a push sideways on
    two feet was survived up to .80 of the bound of the extrapolated centre of mass; with it, 1.12.

    Attributes:
        weight: Per (m/s^2)^2.
        damping: k, 1/s.
        stiffness: s, 1/s^2.
    """

    name: ClassVar[str] = "landing"
    weight: float = 1000.0
    damping: float = 60.0
    stiffness: float = 900.0

    def rows(self, instant: Instant, goal: Goal) -> Rows:
        due = instant.due
        if len(due) == 0:
            return _nothing(instant.accelerations)
        towards = -instant.drifts[due, 2] - self.damping * instant.velocities[due, 2]
        towards -= self.stiffness * instant.points[due, 2]
        weight = repeated(self.weight, len(due))
        return Rows(instant.jacobians[due, 2], towards, weight, instant.accelerations)


@dataclass(frozen=True, slots=True)
class Orientation:
    """The pelvis turns with its reference:  omega' = omega'_r + k e + d (omega_r - omega).

    e is the rotation vector from the pelvis to its reference, and omega its angular velocity, all
    in the pelvis' own frame as MuJoCo has them for a free joint. In the air the weight is small:
    there no force can turn the body as a whole, and the limbs would be spoilt for it.

    Attributes:
        weight: Per (rad/s^2)^2, on the floor.
        weight_aloft: The same without any contact.
        stiffness: k, 1/s^2.
        damping: d, 1/s.
    """

    name: ClassVar[str] = "orientation"
    weight: float = 1.0
    weight_aloft: float = 0.04
    stiffness: float = 200.0
    damping: float = 28.0

    def rows(self, instant: Instant, goal: Goal) -> Direct:
        between = instant.root_rotation.T @ goal.root_rotation
        target = self.stiffness * _rotation_vector(between)
        target += self.damping * (between @ goal.qvel[3:6] - instant.qvel[3:6])
        target += between @ goal.qacc[3:6]
        weight = self.weight if len(instant.active) else self.weight_aloft
        return Direct(target, repeated(weight, 3), slice(3, 6))


@dataclass(frozen=True, slots=True)
class Posture:
    """Every joint follows its reference:  q'' = q''_r + k (q_r - q) + d (q'_r - q').

    Trunk and arms less than the legs: they are what she catches her balance with, while a leg that
    is late is a step that is late.

    Attributes:
        weight: Of the legs, per (rad/s^2)^2.
        upper_weight: Of all else.
        stiffness: k, 1/s^2.
        damping: d, 1/s.
    """

    name: ClassVar[str] = "posture"
    weight: float = 0.2
    upper_weight: float = 0.1
    stiffness: float = 400.0
    damping: float = 40.0

    def rows(self, instant: Instant, goal: Goal) -> Direct:
        dofs, angles = instant.actuated, instant.angles
        target = goal.qacc[dofs] + self.stiffness * (goal.qpos[angles] - instant.qpos[angles])
        target += self.damping * (goal.qvel[dofs] - instant.qvel[dofs])
        weight = np.where(instant.in_legs, self.weight, self.upper_weight)
        return Direct(target, weight, dofs)


@dataclass(frozen=True, slots=True)
class SwingFoot:
    """A foot on its way goes where its reference is, seen from the centre of mass.

    For each sole that is off the floor, or not meant to bear:
    J qacc = p''_r - J' v + k ((p_r - c_r) - (p - c)) + d ((p'_r - c'_r) - (p' - c')).
    Seen from the centre of mass, since that is where a foot must come down to catch the body.

    Attributes:
        weight: Per (m/s^2)^2, shared by a foot's soles.
        stiffness: k, 1/s^2.
        damping: d, 1/s.
    """

    name: ClassVar[str] = "swing foot"
    weight: float = 20.0
    stiffness: float = 900.0
    damping: float = 60.0

    def rows(self, instant: Instant, goal: Goal) -> Rows:
        away = instant.resting
        if len(away) == 0:
            return _nothing(instant.accelerations)
        jacobian = instant.jacobians.take(away, axis=0).reshape(-1, instant.nv)
        place = goal.points - instant.points - (goal.com - instant.com)
        rate = goal.point_velocity - instant.velocities
        rate -= goal.com_velocity - instant.com_velocity
        target = goal.point_acceleration - instant.drifts
        target = (target + self.stiffness * place + self.damping * rate)[away].ravel()
        weight = repeated(self.weight / 6.0, len(target))
        return Rows(jacobian, target, weight, instant.accelerations)


def _nothing(columns: slice) -> Rows:
    return Rows(np.zeros((0, columns.stop - columns.start)), np.zeros(0), np.zeros(0), columns)


def _rotation_vector(rotation: Array) -> Array:
    """Axis times angle of a rotation matrix, (3,), rad, for angles below a half turn."""
    # Plain floats: nine numbers are not worth an array's overhead, 500 times a second.
    (xx, xy, xz), (yx, yy, yz), (zx, zy, zz) = rotation.tolist()
    axis = (0.5 * (zy - yz), 0.5 * (xz - zx), 0.5 * (yx - xy))
    sine = math.hypot(*axis)
    angle = math.atan2(sine, 0.5 * (xx + yy + zz - 1.0))
    scale = 1.0 if sine < 1e-9 else angle / sine
    return np.array([scale * a for a in axis])
