"""Balance: the centre of mass over the soles, or on its way through the air."""

from __future__ import annotations

from typing import ClassVar

import casadi as ca
import numpy as np
from numpy.typing import NDArray

from enpointe.models.kinematics import SymbolicBody
from enpointe.models.rules.base import Kind, Rule, Symbols
from enpointe.models.target import PoseTarget

__all__ = [
    "CentredWeight",
    "ComInFlight",
    "ComOverSupport",
    "WeightOnItsWay",
    "WeightOverTheFoot",
    "centroid",
    "half_planes",
]

_EDGES = 12


class ComOverSupport(Rule):
    """The centre of mass stands inside the hull of the soles: b - A c >= margin for every edge.

    A support too small for the margin (pointe) asks for half its own half-width instead.
    """

    name: ClassVar[str] = "centre of mass over the support"
    unit: ClassVar[str] = "mm"
    bound: ClassVar[float] = 0.0
    kind: ClassVar[Kind] = Kind.AT_LEAST
    source: ClassVar[str] = "statics; Neagle 2005 §4.5.2 (perpendicularity and exact equilibrium)"

    def residual(self, body: SymbolicBody, symbols: Symbols) -> ca.SX:
        normals = ca.reshape(symbols("support_normals", 2 * _EDGES), _EDGES, 2)
        inside = symbols("support_offsets", _EDGES) - normals @ body.com[:2]
        return inside - symbols("support_margin")

    def values(self, target: PoseTarget) -> dict[str, NDArray[np.float64]]:
        normals, offsets = half_planes(target.support)
        index = np.arange(_EDGES) % len(offsets)
        room = float(np.min(offsets - normals @ centroid(target.support)))
        return {
            "support_normals": normals[index].ravel(order="F"),
            "support_offsets": offsets[index],
            "support_margin": np.array(min(MARGIN, 0.5 * room)),
        }


MARGIN = 0.010
"""How far inside the support the centre of mass stays, m, where the support is broad enough."""


class CentredWeight(Rule):
    """The weight is shared: the centre of mass is over the middle of the support, or as asked."""

    name: ClassVar[str] = "weight in the middle"
    unit: ClassVar[str] = "mm"
    bound: ClassVar[float] = 20.0
    kind: ClassVar[Kind] = Kind.PREFER
    weight: ClassVar[float] = 400.0
    source: ClassVar[str] = "Neagle 2005 §4.2.2 (hips centred, weight equally distributed)"

    def residual(self, body: SymbolicBody, symbols: Symbols) -> ca.SX:
        return body.com[:2] - symbols("support_centre", 2)

    def values(self, target: PoseTarget) -> dict[str, NDArray[np.float64]]:
        centre = centroid(target.support) if target.weight is None else target.weight
        return {"support_centre": centre}


class WeightOverTheFoot(CentredWeight):
    """On one foot the weight is near its middle; how near, the lifted leg decides."""

    name: ClassVar[str] = "weight over the foot"
    bound: ClassVar[float] = 70.0
    weight: ClassVar[float] = 400.0
    source: ClassVar[str] = "statics; the margin inside the sole is a rule of its own"


class ComInFlight(Rule):
    """In the air the centre of mass is where its parabola has it."""

    name: ClassVar[str] = "centre of mass on its parabola"
    unit: ClassVar[str] = "mm"
    bound: ClassVar[float] = 1.0
    kind: ClassVar[Kind] = Kind.EQUAL
    source: ClassVar[str] = "free fall"

    def residual(self, body: SymbolicBody, symbols: Symbols) -> ca.SX:
        return body.com - symbols("com", 3)

    def values(self, target: PoseTarget) -> dict[str, NDArray[np.float64]]:
        assert target.com is not None
        return {"com": target.com}


class WeightOnItsWay(ComInFlight):
    """In a step the weight passes from foot to foot and is over neither on its way: a wish."""

    name: ClassVar[str] = "weight on its way"
    bound: ClassVar[float] = 80.0
    kind: ClassVar[Kind] = Kind.PREFER
    weight: ClassVar[float] = 200.0
    source: ClassVar[str] = "Neagle 2005 §5.2.1 (shortest path), for the centre of mass"


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
