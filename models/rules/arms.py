"""The arms: on their signs, rounded, on one slope, palms along the curve."""

from __future__ import annotations

from typing import ClassVar

import casadi as ca
import numpy as np
from numpy.typing import NDArray

from enpointe.models.kinematics import SymbolicBody
from enpointe.models.rules.base import Kind, SidedRule, Symbols
from enpointe.models.target import ArmTarget, PoseTarget
from enpointe.notation import Side

__all__ = [
    "ElbowOnItsSign",
    "ElbowOnTheSlope",
    "ElbowOutward",
    "ForearmTurn",
    "HandOnItsSign",
    "PalmDown",
    "RoundedElbow",
    "StraightElbow",
    "WristLine",
]


class _ArmRule(SidedRule):
    def _arm(self, target: PoseTarget) -> ArmTarget:
        return target.arms[Side(self.side)]

    def _in_torso(self, body: SymbolicBody, site: str) -> ca.SX:
        return body.frame("torso").to_local(body.site(f"{self.side}_{site}"))


class HandOnItsSign(_ArmRule):
    """The wrist is where the sign puts it: w_torso - w_sign = 0."""

    name: ClassVar[str] = "hand on its sign"
    unit: ClassVar[str] = "mm"
    bound: ClassVar[float] = 1.0
    kind: ClassVar[Kind] = Kind.EQUAL
    source: ClassVar[str] = "Neagle 2005 §4.4.1, eqs 4.1-4.5"

    def residual(self, body: SymbolicBody, symbols: Symbols) -> ca.SX:
        return self._in_torso(body, "wrist") - symbols(f"{self.side}_wrist", 3)

    def values(self, target: PoseTarget) -> dict[str, NDArray[np.float64]]:
        return {f"{self.side}_wrist": self._arm(target).wrist}


class ElbowOnTheSlope(_ArmRule):
    """The elbow is neither dropped nor lifted: it lies in the plane of the arm's slope.

    (e - s) . n = 0, with n normal to the line shoulder-wrist and a horizontal across it.
    """

    name: ClassVar[str] = "elbow on the slope"
    unit: ClassVar[str] = "mm"
    bound: ClassVar[float] = 1.0
    kind: ClassVar[Kind] = Kind.EQUAL
    source: ClassVar[str] = "Neagle 2005 §4.4.2, eqs 4.6, 4.7"

    def residual(self, body: SymbolicBody, symbols: Symbols) -> ca.SX:
        elbow = self._in_torso(body, "elbow") - symbols(f"{self.side}_elbow", 3)
        return ca.dot(elbow, symbols(f"{self.side}_slope_normal", 3))

    def values(self, target: PoseTarget) -> dict[str, NDArray[np.float64]]:
        arm = self._arm(target)
        normal = np.cross(arm.elbow - arm.shoulder, arm.wrist - arm.shoulder)
        return {
            f"{self.side}_elbow": arm.elbow,
            f"{self.side}_slope_normal": normal / np.linalg.norm(normal),
        }


class ElbowOutward(_ArmRule):
    """The elbow is on the outer or back side of the arm, never folded in towards the body.

    (e - i) . v >= 0 with i the point of eq. 4.6 on the line shoulder-wrist and v towards the
    elbow's place of eq. 4.7. The slope alone leaves both sides open.
    """

    name: ClassVar[str] = "elbow on the outer side"
    unit: ClassVar[str] = "mm"
    bound: ClassVar[float] = 0.0
    kind: ClassVar[Kind] = Kind.AT_LEAST
    source: ClassVar[str] = "Neagle 2005 §4.4.2, eqs 4.6, 4.7"

    def residual(self, body: SymbolicBody, symbols: Symbols) -> ca.SX:
        elbow = self._in_torso(body, "elbow") - symbols(f"{self.side}_inner", 3)
        return ca.dot(elbow, symbols(f"{self.side}_outward", 3))

    def values(self, target: PoseTarget) -> dict[str, NDArray[np.float64]]:
        arm = self._arm(target)
        line = arm.wrist - arm.shoulder
        share = (arm.elbow - arm.shoulder) @ line / (line @ line)
        inner = arm.shoulder + share * line
        outward = arm.elbow - inner
        length = max(float(np.linalg.norm(outward)), 1e-9)
        return {f"{self.side}_inner": inner, f"{self.side}_outward": outward / length}


class ElbowOnItsSign(_ArmRule):
    """A written elbow is where its sign puts it: e_torso - e_sign = 0."""

    name: ClassVar[str] = "elbow on its sign"
    unit: ClassVar[str] = "mm"
    bound: ClassVar[float] = 2.0
    kind: ClassVar[Kind] = Kind.PREFER
    weight: ClassVar[float] = 1e4
    source: ClassVar[str] = "Neagle 2005 §4.4.3"

    def residual(self, body: SymbolicBody, symbols: Symbols) -> ca.SX:
        return self._in_torso(body, "elbow") - symbols(f"{self.side}_elbow", 3)

    def values(self, target: PoseTarget) -> dict[str, NDArray[np.float64]]:
        return {f"{self.side}_elbow": self._arm(target).elbow}


class StraightElbow(_ArmRule):
    """An arm of an arabesque is stretched: elbow bend = 0."""

    name: ClassVar[str] = "straight elbow"
    unit: ClassVar[str] = "deg"
    bound: ClassVar[float] = 3.0
    kind: ClassVar[Kind] = Kind.CHECK
    source: ClassVar[str] = "Neagle 2005 §4.4.2"

    def residual(self, body: SymbolicBody, symbols: Symbols) -> ca.SX:
        return body.joint(f"{self.side}_elbow_bend")

    def values(self, target: PoseTarget) -> dict[str, NDArray[np.float64]]:
        return {}


class RoundedElbow(_ArmRule):
    """The elbow bends by the amount that the reach of the arm stands for (cosine rule, eq. 4.5)."""

    name: ClassVar[str] = "rounded elbow"
    unit: ClassVar[str] = "deg"
    bound: ClassVar[float] = 1.0
    kind: ClassVar[Kind] = Kind.CHECK
    source: ClassVar[str] = "Neagle 2005 §4.4.1, eq. 4.5"

    def residual(self, body: SymbolicBody, symbols: Symbols) -> ca.SX:
        bend = body.joint(f"{self.side}_elbow_bend")
        return bend - symbols(f"{self.side}_elbow_bend")

    def values(self, target: PoseTarget) -> dict[str, NDArray[np.float64]]:
        return {f"{self.side}_elbow_bend": np.array(self._arm(target).elbow_bend)}


class ForearmTurn(_ArmRule):
    """The forearm is turned so that the palm faces along the curve of the arm."""

    name: ClassVar[str] = "palm along the curve"
    unit: ClassVar[str] = "deg"
    bound: ClassVar[float] = 2.0
    kind: ClassVar[Kind] = Kind.EQUAL
    source: ClassVar[str] = "Neagle 2005 §4.4.4, §4.5.3 b; AAOS supination"

    def residual(self, body: SymbolicBody, symbols: Symbols) -> ca.SX:
        return body.joint(f"{self.side}_forearm_turn") - symbols(f"{self.side}_forearm_turn")

    def values(self, target: PoseTarget) -> dict[str, NDArray[np.float64]]:
        return {f"{self.side}_forearm_turn": np.array(self._arm(target).forearm_turn)}


class PalmDown(_ArmRule):
    """The palm of a stretched arm faces the floor: a . h = 0 and it looks down.

    The residual is the palm's normal along the horizontal across the arm, in radians for small
    angles.
    """

    name: ClassVar[str] = "palm down"
    unit: ClassVar[str] = "deg"
    bound: ClassVar[float] = 10.0
    kind: ClassVar[Kind] = Kind.PREFER
    weight: ClassVar[float] = 1.0
    source: ClassVar[str] = "Cecchetti arabesques (Grant, arabesque)"

    def residual(self, body: SymbolicBody, symbols: Symbols) -> ca.SX:
        inward = ca.DM([0, -1 if self.side == "left" else 1, 0])
        palm = body.frame("torso").rotation.T @ body.frame(f"{self.side}_hand").rotation @ inward
        across = symbols(f"{self.side}_across", 3)
        down = symbols(f"{self.side}_under", 3)
        return ca.atan2(ca.dot(palm, across), ca.dot(palm, down))

    def values(self, target: PoseTarget) -> dict[str, NDArray[np.float64]]:
        arm = self._arm(target)
        along = arm.wrist - arm.shoulder
        along = along / np.linalg.norm(along)
        across = np.cross([0.0, 0.0, 1.0], along)
        norm = np.linalg.norm(across)
        across = across / norm if norm > 1e-9 else np.array([0.0, 1.0, 0.0])
        under = np.cross(across, along)
        under = under if under[2] < 0 else -under
        return {f"{self.side}_across": across, f"{self.side}_under": under}


class WristLine(_ArmRule):
    """The hand carries the arm's line on: bent with the curve, or inflected by the movement."""

    name: ClassVar[str] = "line of the wrist"
    unit: ClassVar[str] = "deg"
    bound: ClassVar[float] = 2.0
    kind: ClassVar[Kind] = Kind.EQUAL
    source: ClassVar[str] = "Neagle 2005 §4.4.2, §5.2.3"

    def residual(self, body: SymbolicBody, symbols: Symbols) -> ca.SX:
        return ca.vertcat(
            body.joint(f"{self.side}_wrist_bend") - symbols(f"{self.side}_wrist_bend"),
            body.joint(f"{self.side}_wrist_cross") - symbols(f"{self.side}_wrist_cross"),
        )

    def values(self, target: PoseTarget) -> dict[str, NDArray[np.float64]]:
        arm = self._arm(target)
        return {
            f"{self.side}_wrist_bend": np.array(arm.wrist_bend),
            f"{self.side}_wrist_cross": np.array(arm.wrist_cross),
        }
