"""The hip: how far it turns out, and in a real dancer how far it goes back."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import casadi as ca
import numpy as np
from numpy.typing import NDArray

from enpointe.models.kinematics import SymbolicBody, angle_over_sine
from enpointe.models.rules.base import Kind, SidedRule, Symbols
from enpointe.models.target import PoseTarget

__all__ = ["HipExtension", "HipRotation", "thigh_swing", "thigh_twist"]

PERFECT_ROTATION_DEG = 62.0
"""Outward rotation of the perfect dancer's hip: an elite's 52 on each side (Hamilton 1992: 104 in
all) and what the shin turns on the thigh, 10-20 % of the turnout, which this body's knee does
not."""
REAL_ROTATION_DEG = 54.0
"""The same from 50.2 passive degrees (Australian Ballet, n = 45) less what is never used up."""
EXTENSION_DEG = 40.0
"""Normal hips go 10-30 deg behind the body (AAOS; Clippinger, Dance Anatomy and Kinesiology, 2007,
says 10-15, and of elite dancers two or three times that)."""


SLACK_DEG = 40.0
"""How much more a thigh turns out that is level in front, and half as much to the side: the
ligaments before the hip slacken as it bends (Kapandji, The Physiology of the Joints), and whoever
sits cross-legged turns out much more. The amount is ours; it lets a grand plié open as it does."""


@dataclass(frozen=True)
class HipRotation(SidedRule):
    """The thigh turns out about itself no farther than the hip lets it: limit + slack >= twist.

    The slack grows as the thigh is lifted, slack = s (1 - cos a)(1 + f) / 2, with a the angle from
    hanging and f how far forward the thigh points, from -1 to 1: none behind.
    """

    name: ClassVar[str] = "hip rotation within range"
    unit: ClassVar[str] = "deg"
    bound: ClassVar[float] = 0.0
    kind: ClassVar[Kind] = Kind.AT_LEAST
    source: ClassVar[str] = "Hamilton 1992; Australian Ballet, n = 45 (turnout shared, IADMS)"
    limit_deg: float = PERFECT_ROTATION_DEG

    def residual(self, body: SymbolicBody, symbols: Symbols) -> ca.SX:
        up = _thigh(body, self.side)[:, 2]
        slack = float(np.radians(SLACK_DEG)) * (1 - up[2]) * (1 - up[0]) / 2
        return float(np.radians(self.limit_deg)) + slack - thigh_twist(body, self.side)

    def values(self, target: PoseTarget) -> dict[str, NDArray[np.float64]]:
        return {}


class HipExtension(SidedRule):
    """The thigh swings behind the pelvis by `EXTENSION_DEG` at most, less where it crosses over.

    limit - e >= 0 and limit - e - a >= 0, with e and a the extension and adduction of
    `thigh_swing`: the ligament before the hip tightens with both. The extension grows with the leg
    all the way up behind, where a sine would turn back at level. The hinges' own ranges can't say
    this: a swing of three hinges shares its angle between them.
    """

    name: ClassVar[str] = "hip extension within range"
    unit: ClassVar[str] = "deg"
    bound: ClassVar[float] = 0.0
    kind: ClassVar[Kind] = Kind.AT_LEAST
    source: ClassVar[str] = (
        "AAOS, hip extension; Clippinger 2007 (elite dancers two or three times)"
    )

    def residual(self, body: SymbolicBody, symbols: Symbols) -> ca.SX:
        behind, across = thigh_swing(body, self.side)
        limit = float(np.radians(EXTENSION_DEG))
        return ca.vertcat(limit - behind, limit - behind - across)

    def values(self, target: PoseTarget) -> dict[str, NDArray[np.float64]]:
        return {}


def thigh_swing(body: SymbolicBody, side: str) -> tuple[ca.SX, ca.SX]:
    """Extension and adduction of a thigh in the pelvis' frame, rad: behind and across are +.

    The shortest swing from hanging to the thigh's direction is a rotation vector across the thigh;
    these are its parts about the axes from side to side and from back to front.
    """
    up = _thigh(body, side)[:, 2]
    share = angle_over_sine(ca.sumsqr(up[:2]), up[2])
    return share * up[0], (1.0 if side == "left" else -1.0) * share * up[1]


def thigh_twist(body: SymbolicBody, side: str) -> ca.SX:
    """Outward turn of a thigh about its own axis d, rad, by swing-twist decomposition.

    The shortest swing from hanging to d is taken away first: a leg devant then faces up at 0 and
    out at 90 degrees.
    """
    thigh = _thigh(body, side)
    front, left = _swung_axes(-thigh[:, 2])
    twist = ca.atan2(ca.dot(thigh[:, 0], left), ca.dot(thigh[:, 0], front))
    return twist if side == "left" else -twist


def _thigh(body: SymbolicBody, side: str) -> ca.SX:
    return body.frame("pelvis").rotation.T @ body.frame(f"{side}_thigh").rotation


def _swung_axes(direction: ca.SX) -> tuple[ca.SX, ca.SX]:
    """Where front and left of a hanging thigh go by the shortest swing to `direction` (3, 1)."""
    x, y, z = direction[0], direction[1], direction[2]
    axis = ca.vertcat(y, -x, 0)
    share = 1 / (1 - z + 1e-6)

    def swing(v: ca.SX) -> ca.SX:
        across = ca.cross(axis, v)
        return v + across + share * ca.cross(axis, across)

    return swing(ca.SX([1, 0, 0])), swing(ca.SX([0, 1, 0]))
