"""Balance: the centre of mass over the soles."""

from __future__ import annotations

from typing import ClassVar

import casadi as ca
import numpy as np
from numpy.typing import NDArray

from enpointe.models.kinematics import SymbolicBody
from enpointe.models.rules.base import Kind, Rule, Symbols
from enpointe.models.target import PoseTarget

__all__ = ["CentredWeight", "ComOverSupport"]

_EDGES = 12


class ComOverSupport(Rule):
    """The centre of mass stands inside the hull of the soles: b - A c >= margin for every edge."""

    name: ClassVar[str] = "centre of mass over the support"
    unit: ClassVar[str] = "mm"
    bound: ClassVar[float] = 10.0
    kind: ClassVar[Kind] = Kind.AT_LEAST
    source: ClassVar[str] = "statics; Neagle 2005 §4.5.2 (perpendicularity and exact equilibrium)"

    def residual(self, body: SymbolicBody, symbols: Symbols) -> ca.SX:
        normals = ca.reshape(symbols("support_normals", 2 * _EDGES), _EDGES, 2)
        return symbols("support_offsets", _EDGES) - normals @ body.com[:2]

    def values(self, target: PoseTarget) -> dict[str, NDArray[np.float64]]:
        normals, offsets = half_planes(target.support)
        index = np.arange(_EDGES) % len(offsets)
        return {
            "support_normals": normals[index].ravel(order="F"),
            "support_offsets": offsets[index],
        }


class CentredWeight(Rule):
    """The weight is shared: the centre of mass is over the middle of the support."""

    name: ClassVar[str] = "weight in the middle"
    unit: ClassVar[str] = "mm"
    bound: ClassVar[float] = 20.0
    kind: ClassVar[Kind] = Kind.PREFER
    weight: ClassVar[float] = 400.0
    source: ClassVar[str] = "Neagle 2005 §4.2.2 (hips centred, weight equally distributed)"

    def residual(self, body: SymbolicBody, symbols: Symbols) -> ca.SX:
        return body.com[:2] - symbols("support_centre", 2)

    def values(self, target: PoseTarget) -> dict[str, NDArray[np.float64]]:
        return {"support_centre": centroid(target.support)}


def half_planes(hull: NDArray[np.float64]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Outward unit normals (H, 2) and offsets (H,) of a counter-clockwise hull: A c <= b inside."""
    edges = np.roll(hull, -1, axis=0) - hull
    normals = np.stack([edges[:, 1], -edges[:, 0]], axis=1)
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    return normals, np.einsum("ij,ij->i", normals, hull)


def centroid(hull: NDArray[np.float64]) -> NDArray[np.float64]:
    """Centre of area of a counter-clockwise hull, (2,) (shoelace formula)."""
    following = np.roll(hull, -1, axis=0)
    cross = hull[:, 0] * following[:, 1] - following[:, 0] * hull[:, 1]
    return np.asarray(((hull + following) * cross[:, None]).sum(0) / (3 * cross.sum()))
