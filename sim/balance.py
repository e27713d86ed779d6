"""Balance: the support under the feet, and how far inside it the weight is.

Lengths in metres, forces in newtons, the floor at z = 0. A margin is positive inside the support.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from enpointe.models.foot_positions import support_hull
from enpointe.models.rules.balance import half_planes

__all__ = [
    "LOADED",
    "area",
    "centre_of_pressure",
    "extrapolated_com",
    "margin",
    "margin_of_stability",
    "margins",
    "penetration",
    "room",
    "slip",
    "support",
    "supports",
    "zero_moment_point",
]

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


def supports(points: Array, forces: Array) -> list[Array]:
    """`support` of each sample of points and forces (N, S, 3)."""
    return [support(p, f) for p, f in zip(points, forces, strict=True)]


def margin(hull: Array, point: Array) -> float:
    """Signed distance from a point on the floor to the edge of the support, m.

    Positive inside. A support of one or two points has no inside: the margin is minus the distance.
    minus infinity without any support.
    """
    return float(margins([hull], np.asarray(point)[None])[0])


def margins(hulls: Sequence[Array], points: Array) -> Array:
    """`margin` of each of the points (N, 2) in its own hull, (N,), m."""
    corners = np.array([len(hull) for hull in hulls])
    found = np.full(len(hulls), -np.inf)
    for count in np.unique(corners[corners > 0]):
        alike = np.flatnonzero(corners == count)
        found[alike] = _margins_alike(np.stack([hulls[i] for i in alike.tolist()]), points[alike])
    return found


def _margins_alike(hulls: Array, points: Array) -> Array:
    """Margins (K,) of points (K, 2) in hulls of as many corners each, (K, H, 2)."""
    edges = np.roll(hulls, -1, axis=1) - hulls
    away = points[:, None] - hulls
    lengths = np.einsum("kij,kij->ki", edges, edges)
    along = np.einsum("kij,kij->ki", away, edges) / np.where(lengths > 0, lengths, 1.0)
    gaps = away - np.clip(along, 0.0, 1.0)[:, :, None] * edges
    nearest = np.sqrt(np.einsum("kij,kij->ki", gaps, gaps)).min(axis=1)
    to_the_left = edges[:, :, 0] * away[:, :, 1] >= edges[:, :, 1] * away[:, :, 0]
    inside = to_the_left.all(axis=1) & (hulls.shape[1] > 2)
    return np.asarray(np.where(inside, nearest, -nearest))


def centre_of_pressure(points: Array, forces: Array) -> Array:
    """Where the floor's vertical force acts, (2,), m: sum f_z p / sum f_z; NaN in the air."""
    vertical = forces[:, 2]
    total = vertical.sum()
    if total <= LOADED:
        return np.full(2, np.nan)
    return np.asarray(vertical @ points[:, :2] / total)


def zero_moment_point(
    com: Array, acceleration: Array, momentum_rate: Array, mass: float, gravity: float
) -> Array:
    """Where the floor must push for this movement, (2,), m; NaN where it need not push up.

    From F = m (c'' + g z) and the moment balance (p - c) x F = L' about the level axes, p_z = 0
    (Vukobratovic and Borovac 2004):

        p_x = c_x - (c_z F_x + L'_y) / F_z,    p_y = c_y - (c_z F_y - L'_x) / F_z.

    On a level floor it is the centre of pressure, found without looking at the floor.

    Args:
        com: c, (3,), m.
        acceleration: c'', (3,), m/s^2.
        momentum_rate: L' about the centre of mass, (3,), N m.
        mass: m, kg.
        gravity: g, m/s^2, positive.
    """
    force = mass * (acceleration + np.array([0.0, 0.0, gravity]))
    if force[2] <= LOADED:
        return np.full(2, np.nan)
    moment = np.array([momentum_rate[1], -momentum_rate[0]])
    return np.asarray(com[:2] - (com[2] * force[:2] + moment) / force[2])


def extrapolated_com(com: Array, velocity: Array, gravity: float) -> Array:
    """The extrapolated centre of mass or capture point, (2,), m:  c + c' sqrt(l / g).

    Hof et al. 2005 (J. Biomech. 38:1-8). l is the height of the centre of mass above the floor.

    Args:
        com: (3,), m.
        velocity: (3,) or (2,), m/s.
        gravity: m/s^2, positive.
    """
    return np.asarray(com[:2] + velocity[:2] * np.sqrt(max(com[2], 0.0) / gravity))


def margin_of_stability(hull: Array, com: Array, velocity: Array, gravity: float) -> float:
    """Signed distance of the extrapolated centre of mass to the edge of the support, m.

    Hof et al. 2005. Positive inside: a force under these feet can still stop the fall. Minus
    infinity in the air.
    """
    return margin(hull, extrapolated_com(com, velocity, gravity))


def room(hull: Array, point: Array, direction: Array) -> float:
    """How far a point inside a support is from its edge along a direction, m; positive inside.

    Args:
        hull: (H, 2), counter-clockwise, with an inside.
        point: (2,), m.
        direction: (2,), a unit vector.
    """
    normals, offsets = half_planes(hull)
    ahead = normals @ direction
    faces = ahead > 1e-9
    return float(np.min((offsets - normals @ point)[faces] / ahead[faces]))


def area(hull: Array) -> float:
    """Of a counter-clockwise hull, m^2 (shoelace formula); 0 for a line, a point or nothing."""
    if len(hull) < 3:
        return 0.0
    following = np.roll(hull, -1, axis=0)
    return float(0.5 * np.sum(hull[:, 0] * following[:, 1] - following[:, 0] * hull[:, 1]))


def penetration(depths: Array) -> float:
    """Deepest that any sole is in the floor, m, positive downwards.

    Contact gives way, as a sprung floor does: a fraction of a millimetre under a standing dancer.

    Args:
        depths: (S,), each sole's.
    """
    return float(depths.max(initial=0.0))


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
