"""The feet: where the position puts them, flat without rolling, turned out, pointed in the air."""

from __future__ import annotations

from math import cos, radians, sin
from typing import ClassVar

import casadi as ca
import numpy as np
from numpy.typing import NDArray

from enpointe.models.kinematics import SymbolicBody
from enpointe.models.rules.base import Kind, Rule, SidedRule, Symbols
from enpointe.models.target import LegTarget, PoseTarget
from enpointe.notation import Side

__all__ = [
    "FeetTurnedOutAlike",
    "FlatFoot",
    "FootOnItsMark",
    "FootOnItsSign",
    "FootTurnout",
    "PointedFoot",
    "TurnoutAtTheHip",
]


class _LegRule(SidedRule):
    def _leg(self, target: PoseTarget) -> LegTarget:
        return target.legs[Side(self.side)]


class FootOnItsMark(_LegRule):
    """The ankle stands over its footprint at the height of the ankle: a - a_print = 0."""

    name: ClassVar[str] = "foot on its mark"
    unit: ClassVar[str] = "mm"
    bound: ClassVar[float] = 1.0
    kind: ClassVar[Kind] = Kind.EQUAL
    source: ClassVar[str] = "Neagle 2005 §4.2.2, five positions of the feet"

    def residual(self, body: SymbolicBody, symbols: Symbols) -> ca.SX:
        height = -float(body.model.site(f"{self.side}_heel").pos[2])
        ankle = body.site(f"{self.side}_ankle")
        return ankle - ca.vertcat(symbols(f"{self.side}_print", 2), height)

    def values(self, target: PoseTarget) -> dict[str, NDArray[np.float64]]:
        footprint = self._leg(target).footprint
        assert footprint is not None
        return {f"{self.side}_print": footprint.ankle}


class FlatFoot(_LegRule):
    """Heel, big toe and little toe on the floor, no rolling: R31 = R32 = 0, toes level.

    Not R33 = 1, whose gradient vanishes at the solution.
    """

    name: ClassVar[str] = "flat foot"
    unit: ClassVar[str] = "deg"
    bound: ClassVar[float] = 0.5
    kind: ClassVar[Kind] = Kind.EQUAL
    source: ClassVar[str] = "Neagle 2005 §4.6.2, eq. 4.10"

    def residual(self, body: SymbolicBody, symbols: Symbols) -> ca.SX:
        rotation = body.frame(f"{self.side}_foot").rotation
        return ca.vertcat(rotation[2, 0], rotation[2, 1], body.joint(f"{self.side}_toe_raise"))

    def values(self, target: PoseTarget) -> dict[str, NDArray[np.float64]]:
        return {}


class FootTurnout(_LegRule):
    """The foot points where the position asks: its axis crossed with the print's is 0."""

    name: ClassVar[str] = "turnout of the foot"
    unit: ClassVar[str] = "deg"
    bound: ClassVar[float] = 0.5
    kind: ClassVar[Kind] = Kind.EQUAL
    source: ClassVar[str] = "Neagle 2005 §4.4.6"

    def residual(self, body: SymbolicBody, symbols: Symbols) -> ca.SX:
        axis = body.frame(f"{self.side}_foot").rotation[:2, 0]
        wanted = symbols(f"{self.side}_direction", 2)
        return wanted[0] * axis[1] - wanted[1] * axis[0]

    def values(self, target: PoseTarget) -> dict[str, NDArray[np.float64]]:
        footprint = self._leg(target).footprint
        assert footprint is not None
        angle = footprint.direction
        return {f"{self.side}_direction": np.array([cos(angle), sin(angle)])}


class FootOnItsSign(_LegRule):
    """The ankle of a leg in the air is where the sign puts it, in the pelvis' frame."""

    name: ClassVar[str] = "foot on its sign"
    unit: ClassVar[str] = "mm"
    bound: ClassVar[float] = 2.0
    kind: ClassVar[Kind] = Kind.EQUAL
    source: ClassVar[str] = "Neagle 2005 §4.4.1, §4.4.6"

    def residual(self, body: SymbolicBody, symbols: Symbols) -> ca.SX:
        ankle = body.frame("pelvis").to_local(body.site(f"{self.side}_ankle"))
        return ankle - symbols(f"{self.side}_ankle", 3)

    def values(self, target: PoseTarget) -> dict[str, NDArray[np.float64]]:
        ankle = self._leg(target).ankle
        assert ankle is not None
        return {f"{self.side}_ankle": ankle}


class PointedFoot(_LegRule):
    """A foot off the floor is stretched: instep out, toes carrying the line on."""

    name: ClassVar[str] = "pointed foot"
    unit: ClassVar[str] = "deg"
    bound: ClassVar[float] = 3.0
    kind: ClassVar[Kind] = Kind.EQUAL
    source: ClassVar[str] = "Neagle 2005 §4.5.2; Russell et al. 2010 (77-83 deg of plantar flexion)"

    def residual(self, body: SymbolicBody, symbols: Symbols) -> ca.SX:
        stretch = {"ankle_point": POINTED_DEG, "ankle_turn": 0, "ankle_roll": 0, "toe_raise": -15}
        return ca.vertcat(
            *(body.joint(f"{self.side}_{joint}") - radians(v) for joint, v in stretch.items())
        )

    def values(self, target: PoseTarget) -> dict[str, NDArray[np.float64]]:
        return {}


POINTED_DEG = 75.0


class TurnoutAtTheHip(_LegRule):
    """Turnout comes from the hip first: what the ankle adds is kept small."""

    name: ClassVar[str] = "turnout lent by the ankle"
    unit: ClassVar[str] = "deg"
    bound: ClassVar[float] = 21.0
    kind: ClassVar[Kind] = Kind.PREFER
    weight: ClassVar[float] = 0.5
    source: ClassVar[str] = (
        "60 % hip, 20-30 % ankle and foot, 10-20 % knee (IADMS through Athletico)"
    )

    def residual(self, body: SymbolicBody, symbols: Symbols) -> ca.SX:
        return body.joint(f"{self.side}_ankle_turn")

    def values(self, target: PoseTarget) -> dict[str, NDArray[np.float64]]:
        return {}


class FeetTurnedOutAlike(Rule):
    """Both feet on the floor are turned out alike: the hips are not twisted over them."""

    name: ClassVar[str] = "feet turned out alike"
    unit: ClassVar[str] = "deg"
    bound: ClassVar[float] = 1.0
    kind: ClassVar[Kind] = Kind.CHECK
    source: ClassVar[str] = "Neagle 2005 §4.2.2 (third: hips not twisted)"

    def residual(self, body: SymbolicBody, symbols: Symbols) -> ca.SX:
        angles = []
        for side in Side:
            axis = body.frame(f"{side}_foot").rotation[:2, 0]
            angles.append(ca.atan2(axis[1], axis[0]) * (1 if side is Side.LEFT else -1))
        return angles[0] - angles[1]

    def values(self, target: PoseTarget) -> dict[str, NDArray[np.float64]]:
        return {}
