"""What the body can't do otherwise: rows A x = b, rows G x <= h, and bounds on x.

x = [qacc, lambda], see `Instant`.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar, Protocol

import mujoco
import numpy as np
from numpy.typing import NDArray

from enpointe.controllers.wholebody.instant import Instant
from enpointe.controllers.wholebody.rows import Bounds, Equality, Limits, Places, places, repeated

__all__ = [
    "Constraint",
    "FloatingBase",
    "FrictionPyramids",
    "JointRange",
    "TorqueLimits",
    "joint_torques",
]

Array = NDArray[np.float64]


class Constraint(Protocol):
    """One thing that holds whatever the tasks wish."""

    name: ClassVar[str]

    def limits(self, instant: Instant) -> Equality | Limits | Bounds:
        """Its rows or bounds at this moment."""


@dataclass(frozen=True, slots=True)
class FloatingBase:
    """No muscle acts on the root:  M_b qacc + h_b = J_b^T f  (its six rows of the dynamics)."""

    name: ClassVar[str] = "floating base"

    def limits(self, instant: Instant) -> Equality:
        return Equality(instant.dynamics[:6], -instant.bias[:6])


@dataclass(frozen=True, slots=True)
class TorqueLimits:
    """Joints are as strong as they are:  |M_j qacc + h_j - J_j^T f| <= limit.

    Attributes:
        limit: (nu,), N m.
    """

    name: ClassVar[str] = "torque limits"
    limit: Array

    def limits(self, instant: Instant) -> Limits:
        dofs = instant.actuated
        bias = instant.bias[dofs]
        return Limits(instant.dynamics[dofs], -self.limit - bias, self.limit - bias)


@dataclass(frozen=True, slots=True)
class FrictionPyramids:
    """The floor pushes, within its friction:  0 <= lambda <= c m g / 4  for each of the four edges
    of a pyramid, c the sole's `capacity`.
    """

    name: ClassVar[str] = "friction pyramids"

    def limits(self, instant: Instant) -> Bounds:
        high = np.repeat(instant.capacity * (0.25 * instant.weight), 4)
        return Bounds(repeated(0.0, len(high)), high, instant.forces)


@dataclass(frozen=True, slots=True)
class JointRange:
    """Joints stay within their range and speed, as bounds on acceleration (Del Prete 2018, RA-L 3):

        q + v T + qacc T^2 / 2 <= q_max,    v + qacc T <= v_max,

    and so at the lower end, a horizon T ahead. Where both ends can't be had the nearer one is kept.

    Attributes:
        dofs: Of the limited joints, (J,).
        angles: Their places in qpos, (J,).
        low: (J,), rad.
        high: (J,), rad.
        horizon: T, s.
        speed: v_max, rad/s.
    """

    name: ClassVar[str] = "joint range"
    dofs: Places
    angles: Places
    low: Array
    high: Array
    horizon: float = 0.03
    speed: float = 25.0

    @classmethod
    def of(cls, model: mujoco.MjModel) -> JointRange:
        """Of all limited hinges of a model."""
        limited = np.flatnonzero(model.jnt_limited)
        ends = model.jnt_range[limited]
        return cls(
            places(model.jnt_dofadr[limited]),
            places(model.jnt_qposadr[limited]),
            np.array(ends[:, 0]),
            np.array(ends[:, 1]),
        )

    def limits(self, instant: Instant) -> Bounds:
        ahead = self.horizon
        q, v = instant.qpos[self.angles], instant.qvel[self.dofs]
        scale, fastest, slowing = 2.0 / ahead**2, self.speed / ahead, v / ahead
        high = np.minimum(scale * (self.high - q) - slowing, fastest) - slowing
        low = np.maximum(scale * (self.low - q) - slowing, -fastest) - slowing
        crossed = low > high
        if crossed.any():
            middle = 0.5 * (self.low + self.high)
            low = np.where(crossed & (q > middle), high, low)
            high = np.where(crossed & (q <= middle), low, high)
        return Bounds(low, high, self.dofs)


def joint_torques(instant: Instant, unknowns: Array) -> Array:
    """tau = M_j qacc + h_j - J_j^T f, (nu,), N m, at a solution."""
    return np.asarray((instant.dynamics @ unknowns + instant.bias)[instant.actuated])
