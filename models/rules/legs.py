"""The legs: straight unless a bent knee is written, turned out in the air."""

from __future__ import annotations

from typing import ClassVar

import casadi as ca
import numpy as np
from numpy.typing import NDArray

from enpointe.models.kinematics import SymbolicBody
from enpointe.models.rules.base import Kind, SidedRule, Symbols
from enpointe.models.target import PoseTarget
from enpointe.notation import Side

__all__ = ["KneeOnItsSign", "LegTurnedOut", "StraightKnee"]


class StraightKnee(SidedRule):
    """The knee is pulled up: knee bend = 0."""

    name: ClassVar[str] = "straight knee"
    unit: ClassVar[str] = "deg"
    bound: ClassVar[float] = 1.0
    kind: ClassVar[Kind] = Kind.EQUAL
    source: ClassVar[str] = "Neagle 2005 §4.3 (legs straight unless a bent knee is written)"

    def residual(self, body: SymbolicBody, symbols: Symbols) -> ca.SX:
        return body.joint(f"{self.side}_knee_bend")

    def values(self, target: PoseTarget) -> dict[str, NDArray[np.float64]]:
        return {}


class KneeOnItsSign(SidedRule):
    """A written knee is where its sign puts it, in the pelvis' frame.

    On the floor the height of the hips decides how deep the knee bends, so the place is a wish.
    """

    name: ClassVar[str] = "knee on its sign"
    unit: ClassVar[str] = "mm"
    bound: ClassVar[float] = 30.0
    kind: ClassVar[Kind] = Kind.PREFER
    weight: ClassVar[float] = 20.0
    source: ClassVar[str] = "Neagle 2005 §4.4.3, for the knee"

    def residual(self, body: SymbolicBody, symbols: Symbols) -> ca.SX:
        knee = body.frame("pelvis").to_local(body.site(f"{self.side}_knee"))
        return knee - symbols(f"{self.side}_knee", 3)

    def values(self, target: PoseTarget) -> dict[str, NDArray[np.float64]]:
        knee = target.legs[Side(self.side)].knee
        assert knee is not None
        return {f"{self.side}_knee": knee}


class LegTurnedOut(SidedRule):
    """The knee of a leg in the air faces as far outwards as the turnout asks.

    The residual is the angle, about the thigh, from the knee's face to the outward direction.
    """

    name: ClassVar[str] = "turnout of the leg"
    unit: ClassVar[str] = "deg"
    bound: ClassVar[float] = 25.0
    kind: ClassVar[Kind] = Kind.PREFER
    weight: ClassVar[float] = 0.3
    source: ClassVar[str] = "Neagle 2005 §4.4.6 (turnout about the thigh)"

    def residual(self, body: SymbolicBody, symbols: Symbols) -> ca.SX:
        pelvis = body.frame("pelvis").rotation
        thigh = pelvis.T @ body.frame(f"{self.side}_thigh").rotation
        outward = 1.0 if self.side == "left" else -1.0
        turnout = symbols(f"{self.side}_turnout")
        wanted = ca.vertcat(ca.cos(turnout), outward * ca.sin(turnout), 0)
        return ca.atan2(ca.dot(wanted, thigh[:, 1]), ca.dot(wanted, thigh[:, 0]) + 1e-9)

    def values(self, target: PoseTarget) -> dict[str, NDArray[np.float64]]:
        turnout = target.legs[Side(self.side)].turnout
        return {f"{self.side}_turnout": np.array(turnout)}
