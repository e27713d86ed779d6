"""Head, body and pelvis: erect, or turned, tilted and bent as written."""

from __future__ import annotations

from typing import ClassVar

import casadi as ca
import numpy as np
from numpy.typing import NDArray

from enpointe.models.kinematics import SymbolicBody
from enpointe.models.rules.base import Kind, Rule, Symbols
from enpointe.models.target import PoseTarget

__all__ = ["BodyAsWritten", "HeadAsWritten", "PelvisAsWritten"]

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
    """The same at the waist."""

    name: ClassVar[str] = "body as written"
    unit: ClassVar[str] = "deg"
    bound: ClassVar[float] = 1.0
    kind: ClassVar[Kind] = Kind.EQUAL
    source: ClassVar[str] = "Neagle 2005 §4.4.5, §4.6.1, eq. 4.9"

    def residual(self, body: SymbolicBody, symbols: Symbols) -> ca.SX:
        return ca.vertcat(*(body.joint(f"waist_{h}") for h in _HINGES)) - symbols("body", 3)

    def values(self, target: PoseTarget) -> dict[str, NDArray[np.float64]]:
        return {"body": target.body}


class PelvisAsWritten(Rule):
    """The pelvis is erect and square, or as written: the rotation vector left over is 0.

    A wish, since two straight legs on given feet leave the pelvis little choice.
    """

    name: ClassVar[str] = "pelvis as written"
    unit: ClassVar[str] = "deg"
    bound: ClassVar[float] = 5.0
    kind: ClassVar[Kind] = Kind.PREFER
    weight: ClassVar[float] = 20.0
    source: ClassVar[str] = "Neagle 2005 §4.2.2 (erect stance, hips not twisted)"

    def residual(self, body: SymbolicBody, symbols: Symbols) -> ca.SX:
        wanted = symbols("pelvis_rotation", 9)
        error = ca.reshape(wanted, 3, 3).T @ body.frame("pelvis").rotation
        return 0.5 * ca.vertcat(
            error[2, 1] - error[1, 2], error[0, 2] - error[2, 0], error[1, 0] - error[0, 1]
        )

    def values(self, target: PoseTarget) -> dict[str, NDArray[np.float64]]:
        return {"pelvis_rotation": turn_tilt_bend(target.pelvis).ravel(order="F")}


def turn_tilt_bend(angles: NDArray[np.float64]) -> NDArray[np.float64]:
    """Rotation matrix (3, 3) of turn, tilt and bend in that order (eq. 4.9)."""
    turn, tilt, bend = angles
    ct, st = np.cos(turn), np.sin(turn)
    about_z = np.array([[ct, -st, 0], [st, ct, 0], [0, 0, 1]])
    cx, sx = np.cos(-tilt), np.sin(-tilt)
    about_x = np.array([[1, 0, 0], [0, cx, -sx], [0, sx, cx]])
    cy, sy = np.cos(bend), np.sin(bend)
    about_y = np.array([[cy, 0, sy], [0, 1, 0], [-sy, 0, cy]])
    return np.asarray(about_z @ about_x @ about_y, dtype=np.float64)
