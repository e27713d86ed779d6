"""The feet: on their marks, flat without rolling or raised on the ball, on pointe, or pointed."""

from __future__ import annotations

from itertools import product
from math import cos, radians, sin
from typing import ClassVar

import casadi as ca
import numpy as np
from numpy.typing import NDArray

from enpointe.models.foot_positions import Footprint
from enpointe.models.kinematics import SymbolicBody
from enpointe.models.leg_target import (
    FOOT_JOINTS,
    POINTED_DEG,
    OnPointe,
    Passing,
    Standing,
)
from enpointe.models.rules.balance import centroid
from enpointe.models.rules.base import Kind, Rule, SidedRule, Symbols
from enpointe.models.target import PoseTarget
from enpointe.notation import Side

__all__ = [
    "BallOnItsMark",
    "FeetTurnedOutAlike",
    "FootAboveTheFloor",
    "FootOnItsWayToPoint",
    "FootRaised",
    "FootTurnout",
    "FootYields",
    "HeelAboveTheFloor",
    "OnTheTip",
    "PointedFoot",
    "ToesFlat",
    "TurnoutAtTheHip",
]


class _FootRule(SidedRule):
    def _footprint(self, target: PoseTarget) -> Footprint:
        leg = target.legs[Side(self.side)]
        assert isinstance(leg, Standing | OnPointe)
        return leg.footprint


class BallOnItsMark(_FootRule):
    """The ball of the foot is where the position puts it: t - t_print = 0, t the toe joint.

    Marking the ball, not the ankle, lets one rule serve the flat foot, the rise and demi-pointe.
    """

    name: ClassVar[str] = "foot on its mark"
    unit: ClassVar[str] = "mm"
    bound: ClassVar[float] = 1.0
    kind: ClassVar[Kind] = Kind.EQUAL
    source: ClassVar[str] = "Neagle 2005 §4.2.2, five positions of the feet"

    def residual(self, body: SymbolicBody, symbols: Symbols) -> ca.SX:
        height = -float(body.model.site(f"{self.side}_toe_tip").pos[2])
        toe_joint = body.frame(f"{self.side}_toe").position
        return toe_joint - ca.vertcat(symbols(f"{self.side}_mark", 2), height)

    def values(self, target: PoseTarget) -> dict[str, NDArray[np.float64]]:
        footprint = self._footprint(target)
        return {f"{self.side}_mark": footprint.point(target.figure.ball_forward)}


class ToesFlat(_FootRule):
    """The toes lie on the floor, big and little alike, no rolling: R31 = R32 = 0 for the toes.

    Not R33 = 1, whose gradient vanishes at the solution.
    """

    name: ClassVar[str] = "no rolling"
    unit: ClassVar[str] = "deg"
    bound: ClassVar[float] = 0.5
    kind: ClassVar[Kind] = Kind.EQUAL
    source: ClassVar[str] = "Neagle 2005 §4.6.2, eq. 4.10"

    def residual(self, body: SymbolicBody, symbols: Symbols) -> ca.SX:
        rotation = body.frame(f"{self.side}_toe").rotation
        return ca.vertcat(rotation[2, 0], rotation[2, 1])

    def values(self, target: PoseTarget) -> dict[str, NDArray[np.float64]]:
        return {}


class FootRaised(_FootRule):
    """The foot stands at the written angle on its toes: 0 flat, `DEMI_POINTE_DEG` demi-pointe."""

    name: ClassVar[str] = "rise of the foot"
    unit: ClassVar[str] = "deg"
    bound: ClassVar[float] = 0.5
    kind: ClassVar[Kind] = Kind.EQUAL
    source: ClassVar[str] = "Neagle 2005 §4.6.2 (flat foot); toe joint 80-90 deg on demi-pointe"

    def residual(self, body: SymbolicBody, symbols: Symbols) -> ca.SX:
        return body.joint(f"{self.side}_toe_raise") - symbols(f"{self.side}_rise")

    def values(self, target: PoseTarget) -> dict[str, NDArray[np.float64]]:
        leg = target.legs[Side(self.side)]
        assert isinstance(leg, Standing)
        return {f"{self.side}_rise": np.array(leg.rise)}


class FootYields(FootRaised):
    """The heel of a foot that weight is coming to or leaving rises as the weight needs it."""

    name: ClassVar[str] = "heel that yields"
    bound: ClassVar[float] = 60.0
    kind: ClassVar[Kind] = Kind.PREFER
    weight: ClassVar[float] = 5.0


class FootTurnout(_FootRule):
    """The foot points where the position asks: its axis crossed with the print's is 0.

    On pointe, where the foot stands upright, its instep faces there instead.
    """

    name: ClassVar[str] = "turnout of the foot"
    unit: ClassVar[str] = "deg"
    bound: ClassVar[float] = 0.5
    kind: ClassVar[Kind] = Kind.EQUAL
    source: ClassVar[str] = "Neagle 2005 §4.4.6"

    def residual(self, body: SymbolicBody, symbols: Symbols) -> ca.SX:
        # The foot's sideways axis is level both flat and on pointe.
        aside = body.frame(f"{self.side}_toe").rotation[:2, 1]
        wanted = symbols(f"{self.side}_direction", 2)
        return ca.dot(wanted, aside)

    def values(self, target: PoseTarget) -> dict[str, NDArray[np.float64]]:
        angle = self._footprint(target).direction
        return {f"{self.side}_direction": np.array([cos(angle), sin(angle)])}


class OnTheTip(_FootRule):
    """The tip of the toes stands on its mark and the toes carry on the line of the leg: pointe.

    They stand upright, but with straight legs that open to both feet further than the ankles give:
    then they lean as far as the line from hip to tip does, and an edge of a pointe shoe bears.
    """

    name: ClassVar[str] = "on the tip of the toes"
    unit: ClassVar[str] = "mm"
    bound: ClassVar[float] = 2.0
    kind: ClassVar[Kind] = Kind.EQUAL
    source: ClassVar[str] = "Russell et al. 2010 (83 deg of plantar flexion en pointe)"

    def residual(self, body: SymbolicBody, symbols: Symbols) -> ca.SX:
        tip = body.site(f"{self.side}_toe_tip")
        toes = body.frame(f"{self.side}_toe").rotation[:, 0]
        shod = body.has_geom(f"{self.side}_platform_under_inner")
        height = symbols(f"{self.side}_edge") if shod else 0
        place = tip - ca.vertcat(symbols(f"{self.side}_tip", 2), height)
        curl = body.joint(f"{self.side}_toe_raise") + radians(POINTE_TOES_DEG)
        return ca.vertcat(place, toes[:2] - symbols(f"{self.side}_lean", 2), curl)

    def values(self, target: PoseTarget) -> dict[str, NDArray[np.float64]]:
        side, figure = Side(self.side), target.figure
        leg = target.legs[side]
        assert isinstance(leg, OnPointe)
        tip = self._footprint(target).point(figure.ball_forward + figure.toe_length)
        lean = np.zeros(2)
        both = all(isinstance(other, Standing | OnPointe) for other in target.legs.values())
        if both and not leg.knee_bend:
            c, s = cos(target.facing), sin(target.facing)
            hip = float(figure.hips[side][1]) * np.array([-s, c])
            lean = (tip - centroid(target.support) - hip) / (
                figure.straight_leg + figure.foot_length
            )
            lean *= np.linalg.norm(lean) > sin(radians(ANKLE_GIVES_DEG))
        edge = np.max((tip - leg.soles(figure)) @ lean)
        return {
            f"{self.side}_tip": tip,
            f"{self.side}_lean": lean,
            f"{self.side}_edge": np.array(edge),
        }


ANKLE_GIVES_DEG = 7.0
"""How far an ankle on pointe gives sideways so that the whole platform stands: third and fifth need
no more. In second and fourth it would be a sickled foot, or a leg turned in."""
POINTE_TOES_DEG = -POINTED_DEG[-1]
"""What the toes add to the ankle so that the line from shin to toe is straight, as in the air."""


class PointedFoot(SidedRule):
    """A foot off the floor is stretched: instep out, toes carrying the line on."""

    name: ClassVar[str] = "pointed foot"
    unit: ClassVar[str] = "deg"
    bound: ClassVar[float] = 3.0
    kind: ClassVar[Kind] = Kind.EQUAL
    source: ClassVar[str] = "Neagle 2005 §4.5.2; Russell et al. 2010 (77-83 deg of plantar flexion)"

    def residual(self, body: SymbolicBody, symbols: Symbols) -> ca.SX:
        angles = ca.vertcat(*(body.joint(f"{self.side}_{joint}") for joint in FOOT_JOINTS))
        return angles - symbols(f"{self.side}_foot_angles", 4)

    def values(self, target: PoseTarget) -> dict[str, NDArray[np.float64]]:
        leg = target.legs[Side(self.side)]
        angles = leg.angles[4:] if isinstance(leg, Passing) else np.radians(POINTED_DEG)
        return {f"{self.side}_foot_angles": angles}


class FootOnItsWayToPoint(PointedFoot):
    """A passing foot rolls from flat to pointed and back, as far as the floor under it allows."""

    name: ClassVar[str] = "foot on its way to point"
    bound: ClassVar[float] = 45.0
    kind: ClassVar[Kind] = Kind.PREFER
    weight: ClassVar[float] = 2.0


class FootAboveTheFloor(SidedRule):
    """No part of a passing foot goes through the floor: z >= 0 under heel, ball and toe tip.

    Under both edges of each, as the compiled soles have them: a foot on its way rolls.
    """

    name: ClassVar[str] = "foot above the floor"
    unit: ClassVar[str] = "mm"
    bound: ClassVar[float] = 0.0
    kind: ClassVar[Kind] = Kind.AT_LEAST
    source: ClassVar[str] = "Neagle 2005 §4.5.3 e (toes below the floor)"
    parts: ClassVar[tuple[str, ...]] = ("heel", "ball", "tip")

    def residual(self, body: SymbolicBody, symbols: Symbols) -> ca.SX:
        spheres = product(self.parts, ("inner", "outer"))
        return ca.vertcat(*(body.lowest(f"{self.side}_{p}_{edge}") for p, edge in spheres))

    def values(self, target: PoseTarget) -> dict[str, NDArray[np.float64]]:
        return {}


class HeelAboveTheFloor(FootAboveTheFloor):
    """The heel of a foot whose ball stays on its mark does not go through the floor."""

    name: ClassVar[str] = "heel above the floor"
    bound: ClassVar[float] = -0.5
    parts: ClassVar[tuple[str, ...]] = ("heel",)


class TurnoutAtTheHip(SidedRule):
    """Turnout comes from the hip first: what the ankle adds is kept small."""

    name: ClassVar[str] = "turnout lent by the ankle"
    unit: ClassVar[str] = "deg"
    bound: ClassVar[float] = 21.6
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
        facing = symbols("facing")
        angles = []
        for side in Side:
            axis = body.frame(f"{side}_toe").rotation[:2, 0]
            forward = ca.cos(facing) * axis[0] + ca.sin(facing) * axis[1]
            left = -ca.sin(facing) * axis[0] + ca.cos(facing) * axis[1]
            angles.append(ca.atan2(left, forward) * (1 if side is Side.LEFT else -1))
        return angles[0] - angles[1]

    def values(self, target: PoseTarget) -> dict[str, NDArray[np.float64]]:
        return {"facing": np.array(target.facing)}
