"""The hip: how far it turns out, and in a real dancer how far it goes back."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import casadi as ca
import numpy as np
from numpy.typing import NDArray

from enpointe.models.kinematics import SymbolicBody
from enpointe.models.rules.base import Kind, SidedRule, Symbols
from enpointe.models.target import PoseTarget

__all__ = ["HipExtension", "HipRotation", "thigh_twist"]

PERFECT_ROTATION_DEG = 62.0
"""Outward rotation of the perfect dancer's hip: an elite's 52 on each side (Hamilton 1992: 104 in
all) and what the shin turns on the thigh, 10-20 % of the turnout, which this body's knee does
not."""
REAL_ROTATION_DEG = 54.0
"""The same from 50.2 passive degrees (Australian Ballet, n = 45) less what is never used up."""
EXTENSION_DEG = 40.0
"""Normal hips go 20-30 deg behind the body (AAOS); a turned-out dancer's somewhat farther."""


@dataclass(frozen=True)
class HipRotation(SidedRule):
    """The thigh turns out about itself no farther than the hip lets it: limit - twist >= 0."""

    name: ClassVar[str] = "hip rotation within range"
    unit: ClassVar[str] = "deg"
    bound: ClassVar[float] = 0.0
    kind: ClassVar[Kind] = Kind.AT_LEAST
    source: ClassVar[str] = "Hamilton 1992; Australian Ballet, n = 45 (turnout shared, IADMS)"
    limit_deg: float = PERFECT_ROTATION_DEG

    def residual(self, body: SymbolicBody, symbols: Symbols) -> ca.SX:
        return float(np.radians(self.limit_deg)) - thigh_twist(body, self.side)

    def values(self, target: PoseTarget) -> dict[str, NDArray[np.float64]]:
        return {}


class HipExtension(SidedRule):
    """The thigh goes behind the pelvis by `EXTENSION_DEG` at most: sin(e) + d_x >= 0.

    d is the thigh's direction in the pelvis' frame. The hinges' own ranges can't say this: a swing
    of three hinges shares its angle between them.
    """

    name: ClassVar[str] = "hip extension within range"
    unit: ClassVar[str] = "deg"
    bound: ClassVar[float] = 0.0
    kind: ClassVar[Kind] = Kind.AT_LEAST
    source: ClassVar[str] = "AAOS, hip extension"

    def residual(self, body: SymbolicBody, symbols: Symbols) -> ca.SX:
        thigh = _thigh(body, self.side)
        return float(np.sin(np.radians(EXTENSION_DEG))) - thigh[0, 2]

    def values(self, target: PoseTarget) -> dict[str, NDArray[np.float64]]:
        return {}


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
