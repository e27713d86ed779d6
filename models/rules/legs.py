"""The legs: straight or bent over the toes on the floor; placed, pointed and turned out off it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import casadi as ca
import numpy as np
from numpy.typing import NDArray

from enpointe.models.kinematics import SymbolicBody
from enpointe.models.leg_target import (
    FOOT_JOINTS,
    LEG_JOINTS,
    InAir,
    OnPointe,
    Passing,
    Standing,
    ToeOnFloor,
    ToeOnLeg,
)
from enpointe.models.rules.base import Kind, SidedRule, Symbols
from enpointe.models.rules.hip import thigh_twist
from enpointe.models.target import PoseTarget
from enpointe.notation import Side

__all__ = [
    "FootOnItsSign",
    "KneeBend",
    "KneeOnItsSign",
    "KneeOverToe",
    "KneeYields",
    "LegOnItsWay",
    "LegTurnedOut",
    "StretchedKnee",
    "ToeAtTheLeg",
    "ToeAway",
    "ToeOnTheFloor",
]


class KneeBend(SidedRule):
    """The knee of a standing leg is pulled up straight, or bent as deep as written."""

    name: ClassVar[str] = "knee as written"
    unit: ClassVar[str] = "deg"
    bound: ClassVar[float] = 1.0
    kind: ClassVar[Kind] = Kind.EQUAL
    source: ClassVar[str] = "Neagle 2005 §4.3; grand plie 135 deg (Fotaki 2024, 20 professionals)"

    def residual(self, body: SymbolicBody, symbols: Symbols) -> ca.SX:
        return body.joint(f"{self.side}_knee_bend") - symbols(f"{self.side}_knee_bend")

    def values(self, target: PoseTarget) -> dict[str, NDArray[np.float64]]:
        leg = target.legs[Side(self.side)]
        assert isinstance(leg, Standing | OnPointe)
        return {f"{self.side}_knee_bend": np.array(leg.knee_bend)}


class KneeYields(KneeBend):
    """The knee of a leg that weight is coming to or leaving gives as the weight needs it."""

    name: ClassVar[str] = "knee that yields"
    bound: ClassVar[float] = 60.0
    kind: ClassVar[Kind] = Kind.PREFER
    weight: ClassVar[float] = 10.0


class KneeOverToe(SidedRule):
    """A bent knee is over the toes: its distance from the foot's line, seen from above, is 0."""

    name: ClassVar[str] = "knee over the toe"
    unit: ClassVar[str] = "mm"
    bound: ClassVar[float] = 30.0
    kind: ClassVar[Kind] = Kind.PREFER
    weight: ClassVar[float] = 50.0
    source: ClassVar[str] = "ballet teaching (plie: knees over the toes)"

    def residual(self, body: SymbolicBody, symbols: Symbols) -> ca.SX:
        knee = body.site(f"{self.side}_knee") - body.frame(f"{self.side}_toe").position
        aside = body.frame(f"{self.side}_toe").rotation[:2, 1]
        return ca.dot(knee[:2], aside)

    def values(self, target: PoseTarget) -> dict[str, NDArray[np.float64]]:
        return {}


class StretchedKnee(SidedRule):
    """The knee of a working leg that is not written bent is stretched."""

    name: ClassVar[str] = "stretched knee"
    unit: ClassVar[str] = "deg"
    bound: ClassVar[float] = 4.0
    kind: ClassVar[Kind] = Kind.CHECK
    source: ClassVar[str] = "Neagle 2005 §4.3 (legs straight unless a bent knee is written)"

    def residual(self, body: SymbolicBody, symbols: Symbols) -> ca.SX:
        return body.joint(f"{self.side}_knee_bend")

    def values(self, target: PoseTarget) -> dict[str, NDArray[np.float64]]:
        return {}


class FootOnItsSign(SidedRule):
    """The ankle of a leg in the air is where the sign puts it from its hip, in the written frame.

    From the hip joint, not from the middle of the pelvis: a pelvis lent to the leg moves the joint,
    and a straight leg would have to bend to end where the sign put it on an erect one.
    """

    name: ClassVar[str] = "foot on its sign"
    unit: ClassVar[str] = "mm"
    bound: ClassVar[float] = 2.0
    kind: ClassVar[Kind] = Kind.EQUAL
    source: ClassVar[str] = "Neagle 2005 §4.4.1, §4.4.6"

    def residual(self, body: SymbolicBody, symbols: Symbols) -> ca.SX:
        upright = ca.reshape(symbols("girdle", 9), 3, 3)
        leg = body.site(f"{self.side}_ankle") - body.site(f"{self.side}_hip")
        return upright.T @ leg - symbols(f"{self.side}_ankle", 3)

    def values(self, target: PoseTarget) -> dict[str, NDArray[np.float64]]:
        leg = target.legs[Side(self.side)]
        assert isinstance(leg, InAir)
        hip = target.figure.hips[Side(self.side)]
        return {f"{self.side}_ankle": leg.ankle - hip, "girdle": target.upright.ravel(order="F")}


class LegOnItsWay(SidedRule):
    """Hip and knee of a passing leg keep to their way, as well as floor and other leg let them."""

    name: ClassVar[str] = "leg on its way"
    unit: ClassVar[str] = "deg"
    bound: ClassVar[float] = 20.0
    kind: ClassVar[Kind] = Kind.PREFER
    weight: ClassVar[float] = 30.0
    source: ClassVar[str] = "Neagle 2005 §5.2.1 (shortest path)"

    def residual(self, body: SymbolicBody, symbols: Symbols) -> ca.SX:
        joints = LEG_JOINTS[: -len(FOOT_JOINTS)]
        angles = ca.vertcat(*(body.joint(f"{self.side}_{joint}") for joint in joints))
        return angles - symbols(f"{self.side}_leg_angles", len(joints))

    def values(self, target: PoseTarget) -> dict[str, NDArray[np.float64]]:
        leg = target.legs[Side(self.side)]
        assert isinstance(leg, Passing)
        return {f"{self.side}_leg_angles": leg.angles[: -len(FOOT_JOINTS)]}


class KneeOnItsSign(SidedRule):
    """A written knee is where its sign puts it from its hip, in the written frame: a wish."""

    name: ClassVar[str] = "knee on its sign"
    unit: ClassVar[str] = "mm"
    bound: ClassVar[float] = 40.0
    kind: ClassVar[Kind] = Kind.PREFER
    weight: ClassVar[float] = 50.0
    source: ClassVar[str] = "Neagle 2005 §4.4.3, for the knee"

    def residual(self, body: SymbolicBody, symbols: Symbols) -> ca.SX:
        upright = ca.reshape(symbols("girdle", 9), 3, 3)
        thigh = body.site(f"{self.side}_knee") - body.site(f"{self.side}_hip")
        return upright.T @ thigh - symbols(f"{self.side}_knee", 3)

    def values(self, target: PoseTarget) -> dict[str, NDArray[np.float64]]:
        leg = target.legs[Side(self.side)]
        assert isinstance(leg, InAir) and leg.knee is not None
        hip = target.figure.hips[Side(self.side)]
        return {f"{self.side}_knee": leg.knee - hip, "girdle": target.upright.ravel(order="F")}


class ToeOnTheFloor(SidedRule):
    """A tendu: the stretched leg's toe touches the floor on its line from the hips."""

    name: ClassVar[str] = "toe on the floor"
    unit: ClassVar[str] = "mm"
    bound: ClassVar[float] = 2.0
    kind: ClassVar[Kind] = Kind.EQUAL
    source: ClassVar[str] = "Grant, battement tendu"

    def residual(self, body: SymbolicBody, symbols: Symbols) -> ca.SX:
        tip = body.site(f"{self.side}_toe_tip")
        upright = ca.reshape(symbols("girdle", 9), 3, 3)
        place = upright.T @ (tip - body.frame("pelvis").position)
        across = symbols(f"{self.side}_across_line", 2)
        knee = body.joint(f"{self.side}_knee_bend") - symbols(f"{self.side}_stretch")
        return ca.vertcat(tip[2] - TOE_THICKNESS, ca.dot(across, place[:2]), 0.1 * knee)

    def values(self, target: PoseTarget) -> dict[str, NDArray[np.float64]]:
        leg = target.legs[Side(self.side)]
        assert isinstance(leg, ToeOnFloor)
        return {
            f"{self.side}_across_line": np.array(leg.across),
            f"{self.side}_stretch": np.radians(2.0),
            "girdle": target.upright.ravel(order="F"),
        }


class ToeAway(SidedRule):
    """The toe of a tendu is out on the side that it points to: t . d - 0.2 m >= 0.

    The line that the toe lies on goes through under the body to the other side.
    """

    name: ClassVar[str] = "toe away from the body"
    unit: ClassVar[str] = "mm"
    bound: ClassVar[float] = 0.0
    kind: ClassVar[Kind] = Kind.AT_LEAST
    source: ClassVar[str] = "Grant, battement tendu"

    def residual(self, body: SymbolicBody, symbols: Symbols) -> ca.SX:
        upright = ca.reshape(symbols("girdle", 9), 3, 3)
        tip = body.site(f"{self.side}_toe_tip") - body.frame("pelvis").position
        return ca.dot(symbols(f"{self.side}_towards", 2), (upright.T @ tip)[:2]) - 0.2

    def values(self, target: PoseTarget) -> dict[str, NDArray[np.float64]]:
        leg = target.legs[Side(self.side)]
        assert isinstance(leg, ToeOnFloor)
        outward = 1.0 if self.side == "left" else -1.0
        towards = [leg.ahead, 0.0] if leg.ahead else [0.0, outward]
        return {
            f"{self.side}_towards": np.array(towards),
            "girdle": target.upright.ravel(order="F"),
        }


TOE_THICKNESS = 0.011
"""Bone to floor at the tip of a stretched toe, m."""


@dataclass(frozen=True)
class ToeAtTheLeg(SidedRule):
    """Retire and cou-de-pied: the pointed toe is at its place on the supporting leg."""

    name: ClassVar[str] = "toe at the supporting leg"
    unit: ClassVar[str] = "mm"
    bound: ClassVar[float] = 2.0
    kind: ClassVar[Kind] = Kind.EQUAL
    source: ClassVar[str] = "Grant, retiré (toe at the knee) and cou-de-pied (at the ankle)"
    at: str = "knee"

    def residual(self, body: SymbolicBody, symbols: Symbols) -> ca.SX:
        other = "right" if self.side == "left" else "left"
        upright = ca.reshape(symbols("girdle", 9), 3, 3)
        gap = body.site(f"{self.side}_toe_tip") - body.site(f"{other}_{self.at}")
        return upright.T @ gap - symbols(f"{self.side}_toe_place", 3)

    def values(self, target: PoseTarget) -> dict[str, NDArray[np.float64]]:
        leg = target.legs[Side(self.side)]
        assert isinstance(leg, ToeOnLeg)
        outward = 1.0 if self.side == "left" else -1.0
        ahead, aside, up = leg.offset
        return {
            f"{self.side}_toe_place": np.array([ahead, outward * aside, up]),
            "girdle": target.upright.ravel(order="F"),
        }


class LegTurnedOut(SidedRule):
    """The knee of a working leg faces as far outwards as the turnout asks.

    The turnout is the twist of the thigh about its own axis d, once the shortest swing from hanging
    to d is taken away (swing-twist): a leg devant then faces up without turnout and out with 90.
    """

    name: ClassVar[str] = "turnout of the leg"
    unit: ClassVar[str] = "deg"
    bound: ClassVar[float] = 30.0
    kind: ClassVar[Kind] = Kind.PREFER
    weight: ClassVar[float] = 2.0
    source: ClassVar[str] = "Neagle 2005 §4.4.6 (turnout about the thigh)"

    def residual(self, body: SymbolicBody, symbols: Symbols) -> ca.SX:
        return thigh_twist(body, self.side) - symbols(f"{self.side}_turnout")

    def values(self, target: PoseTarget) -> dict[str, NDArray[np.float64]]:
        leg = target.legs[Side(self.side)]
        assert isinstance(leg, InAir | ToeOnFloor | ToeOnLeg)
        return {f"{self.side}_turnout": np.array(leg.turnout)}
