"""Balance: the support under the feet, and how far inside it the weight is.

Lengths in metres, forces in newtons, the floor at z = 0. A margin is positive inside the support.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from enpointe.models.foot_positions import support_hull
from enpointe.models.rules.balance import half_planes

__all__ = ["LOADED", "centre_of_pressure", "margin", "slip", "support"]

Array = NDArray[np.float64]
LOADED = 2.0
"""A sole with less force than this on it, N, supports nobody (0.4 % of body weight)."""


def support(points: Array, forces: Array) -> Array:
    """Convex hull of the soles that bear weight, counter-clockwise, (H, 2).

    Taken from true contact points each time: boxes round turned-out feet claim ground that no foot
    stands on.

    Args:
        points: (S, 3), lowest points of the soles.
        forces: (S, 3), floor on sole.
    """
    return support_hull(points[forces[:, 2] > LOADED, :2])


def margin(hull: Array, point: Array) -> float:
    """Signed distance from a point on the floor to the edge of the support, m.

    Positive inside. A support of one or two points has no inside: the margin is minus the distance.
    minus infinity without any support.
    """
    if len(hull) == 0:
        return -np.inf
    gap = _distance_to_outline(hull, point)
    if len(hull) < 3:
        return -gap
    normals, offsets = half_planes(hull)
    return gap if bool(np.all(normals @ point <= offsets)) else -gap


def _distance_to_outline(hull: Array, point: Array) -> float:
    following = np.roll(hull, -1, axis=0)
    edges = following - hull
    lengths = np.einsum("ij,ij->i", edges, edges)
    along = np.einsum("ij,ij->i", point - hull, edges) / np.where(lengths > 0, lengths, 1.0)
    nearest = hull + np.clip(along, 0.0, 1.0)[:, None] * edges
    return float(np.linalg.norm(nearest - point, axis=1).min())


def centre_of_pressure(points: Array, forces: Array) -> Array:
    """Where the floor's vertical force acts, (2,), m: sum f_z p / sum f_z; NaN in the air."""
    vertical = forces[:, 2]
    total = vertical.sum()
    if total <= LOADED:
        return np.full(2, np.nan)
    return np.asarray(vertical @ points[:, :2] / total)


def slip(points: Array, forces: Array) -> Array:
    """How far each sole has slid since it last took weight, (N, S), m; 0 while it bears none.

    Args:
        points: (N, S, 3).
        forces: (N, S, 3).
    """
    loaded = forces[:, :, 2] > LOADED
    slid = np.zeros(loaded.shape)
    anchor = np.array(points[0, :, :2])
    for i in range(len(points)):
        fresh = loaded[i] & ~loaded[i - 1] if i else loaded[i]
        anchor[fresh] = points[i, fresh, :2]
        slid[i] = np.where(loaded[i], np.linalg.norm(points[i, :, :2] - anchor, axis=1), 0.0)
    return slid
