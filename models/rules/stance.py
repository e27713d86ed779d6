"""Head, body and pelvis: erect, or turned, tilted and bent as written."""

from __future__ import annotations

from typing import ClassVar

import casadi as ca
import numpy as np
from numpy.typing import NDArray

from enpointe.models.kinematics import SymbolicBody, angle_over_sine
from enpointe.models.rules.base import Kind, Rule, Symbols
from enpointe.models.target import PoseTarget, turn_tilt_bend

__all__ = ["BodyAsWritten", "BodyLent", "HeadAsWritten", "PelvisAsWritten", "PelvisLent"]

_HINGES = ("turn", "tilt", "bend")


class HeadAsWritten(Rule):
    """q_neck = q_turn q_tilt q_bend; the neck's hinges stand in that order, so angles compare."""

    name: ClassVar[str] = "head as written"
    unit: ClassVar[str] = "deg"
    bound: ClassVar[float] = 1.0
    kind: ClassVar[Kind] = Kind.EQUAL
    source: ClassVar[str] = "Neagle 2005 §4.4.5, §4.6.1, eq. 4.9"

    def residual(self, body: SymbolicBody, symbols: Symbols) -> ca.SX:
        return ca.vertcat(*(body.joint(f"neck_{h}") for h in _HINGES)) - symbols("head", 3)

    def values(self, target: PoseTarget) -> dict[str, NDArray[np.float64]]:
        return {"head": target.head}


class BodyAsWritten(Rule):
    """The upper body is held as written, whatever the pelvis lends to a leg below it.

    q_torso = q_pelvis,written q_turn q_tilt q_bend; the residual is the rotation vector left over.
    """

    name: ClassVar[str] = "body as written"
    unit: ClassVar[str] = "deg"
    bound: ClassVar[float] = 3.0
    kind: ClassVar[Kind] = Kind.PREFER
    weight: ClassVar[float] = 100.0
    source: ClassVar[str] = "Neagle 2005 §4.4.5, §4.6.1, eq. 4.9; Blasis (erect stance)"

    def residual(self, body: SymbolicBody, symbols: Symbols) -> ca.SX:
        return _rotation_left(body, "torso", symbols("torso_rotation", 9))

    def values(self, target: PoseTarget) -> dict[str, NDArray[np.float64]]:
        wanted = target.upright @ turn_tilt_bend(target.body)
        return {"torso_rotation": wanted.ravel(order="F")}


class BodyLent(BodyAsWritten):
    """A real dancer's back comes forward under a leg behind that hip and spine alone do not lift.

    The same residual and weight as the perfect dancer's: it is the last that she lends.
    """

    name: ClassVar[str] = "body lent to the leg"
    bound: ClassVar[float] = 30.0
    source: ClassVar[str] = "Neagle 2005 §4.8; ballet teaching (past 90 degrees the back gives)"


class PelvisAsWritten(Rule):
    """The pelvis is erect and square, or as written: the rotation vector left over is 0.

    A wish, since two straight legs on given feet leave the pelvis little choice.
    """

    name: ClassVar[str] = "pelvis as written"
    unit: ClassVar[str] = "deg"
    bound: ClassVar[float] = 5.0
    kind: ClassVar[Kind] = Kind.PREFER
    weight: ClassVar[float] = 40.0
    source: ClassVar[str] = "Neagle 2005 §4.2.2 (erect stance, hips not twisted)"

    def residual(self, body: SymbolicBody, symbols: Symbols) -> ca.SX:
        return _rotation_left(body, "pelvis", symbols("pelvis_rotation", 9))

    def values(self, target: PoseTarget) -> dict[str, NDArray[np.float64]]:
        return {"pelvis_rotation": target.upright.ravel(order="F")}


class PelvisLent(PelvisAsWritten):
    """A real dancer tips and opens the pelvis for a leg that her hip alone does not lift.

    The same residual as the perfect dancer's, with the bound of what dancers are seen to lend.
    """

    name: ClassVar[str] = "pelvis lent to the leg"
    bound: ClassVar[float] = 80.0
    weight: ClassVar[float] = 2.0
    source: ClassVar[str] = "Neagle 2005 §4.5.4 d, §4.7.3, §4.8 (hips opened to gain the line)"


def _rotation_left(body: SymbolicBody, part: str, wanted: ca.SX) -> ca.SX:
    error = ca.reshape(wanted, 3, 3).T @ body.frame(part).rotation
    across = 0.5 * ca.vertcat(
        error[2, 1] - error[1, 2], error[0, 2] - error[2, 0], error[1, 0] - error[0, 1]
    )
    return across * angle_over_sine(ca.sumsqr(across), 0.5 * (ca.trace(error) - 1))
