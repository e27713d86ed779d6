"""What a real dancer's joints do: limits that no single hinge of the model can state."""

from __future__ import annotations

from typing import ClassVar

import casadi as ca
import numpy as np
from numpy.typing import NDArray

from enpointe.models.kinematics import SymbolicBody
from enpointe.models.rules.base import Kind, SidedRule, Symbols
from enpointe.models.target import PoseTarget

__all__ = ["HipExtension"]


class HipExtension(SidedRule):
    """The thigh goes behind the pelvis by `EXTENSION_DEG` at most: sin(e) + d_x >= 0.

    d is the thigh's direction in the pelvis' frame. The hinges' own ranges can't say this: a swing
    of three hinges shares its angle between them.
    """

    name: ClassVar[str] = "hip extension within range"
    unit: ClassVar[str] = "deg"
    bound: ClassVar[float] = 0.0
    kind: ClassVar[Kind] = Kind.AT_LEAST
    source: ClassVar[str] = "normal 20-30 deg of extension (AAOS), a dancer's with turnout somewhat more"

    def residual(self, body: SymbolicBody, symbols: Symbols) -> ca.SX:
        pelvis = body.frame("pelvis")
        thigh = pelvis.rotation.T @ body.frame(f"{self.side}_thigh").rotation
        return float(np.sin(np.radians(EXTENSION_DEG))) - thigh[0, 2]

    def values(self, target: PoseTarget) -> dict[str, NDArray[np.float64]]:
        return {}


EXTENSION_DEG = 40.0
