"""Triangles of a body's geoms, for files that hold pictures of it."""

from __future__ import annotations

from dataclasses import dataclass
from math import pi

import mujoco
import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

__all__ = ["Surface", "surfaces"]

Array = NDArray[np.float64]
_AROUND, _DOWN = 20, 6
_SHOWN = 2


@dataclass(frozen=True)
class Surface:
    """Triangles of one colour, in a body's frame.

    Attributes:
        points: (N, 3), m.
        normals: (N, 3), outwards, unit.
        triangles: (K, 3), indices of points, anticlockwise seen from outside.
        colour: Red, green, blue, alpha, 0 to 1.
    """

    points: Array
    normals: Array
    triangles: NDArray[np.uint32]
    colour: tuple[float, float, float, float]


def surfaces(model: mujoco.MjModel, body: int, *, hidden: bool = False) -> list[Surface]:
    """What is to be seen of a body, joined by colour: geom groups 0 to 2, planes left out.

    Args:
        model: Whose body.
        body: Its index.
        hidden: What is not to be seen as well, as shapes are that only touch.
    """
    found: dict[tuple[float, float, float, float], list[Surface]] = {}
    first = int(model.body_geomadr[body])
    for geom in range(first, first + int(model.body_geomnum[body])):
        surface = _surface(model, geom) if hidden or model.geom_group[geom] <= _SHOWN else None
        if surface is not None:
            found.setdefault(surface.colour, []).append(surface)
    return [_joined(parts) for parts in found.values()]


def _surface(model: mujoco.MjModel, geom: int) -> Surface | None:
    size = model.geom_size[geom]
    kind = mujoco.mjtGeom(int(model.geom_type[geom]))
    if kind == mujoco.mjtGeom.mjGEOM_MESH:
        points, normals, triangles = _mesh(model, int(model.geom_dataid[geom]))
    elif kind == mujoco.mjtGeom.mjGEOM_SPHERE:
        points, normals, triangles = _round(np.full(3, size[0]), 0.0)
    elif kind == mujoco.mjtGeom.mjGEOM_ELLIPSOID:
        points, normals, triangles = _round(size, 0.0)
    elif kind == mujoco.mjtGeom.mjGEOM_CAPSULE:
        points, normals, triangles = _round(np.full(3, size[0]), float(size[1]))
    elif kind == mujoco.mjtGeom.mjGEOM_CYLINDER:
        points, normals, triangles = _cylinder(float(size[0]), float(size[1]))
    elif kind == mujoco.mjtGeom.mjGEOM_BOX:
        points, normals, triangles = _box(size)
    else:
        return None
    turn = Rotation.from_quat(model.geom_quat[geom], scalar_first=True)
    return Surface(
        turn.apply(points) + model.geom_pos[geom],
        turn.apply(normals),
        triangles,
        _colour(model, geom),
    )


def _colour(model: mujoco.MjModel, geom: int) -> tuple[float, float, float, float]:
    material = int(model.geom_matid[geom])
    rgba = model.mat_rgba[material] if material >= 0 else model.geom_rgba[geom]
    red, green, blue, alpha = (round(float(value), 6) for value in rgba)
    return red, green, blue, alpha


def _round(radii: Array, half: float) -> tuple[Array, Array, NDArray[np.uint32]]:
    """An ellipsoid, cut at its equator and drawn out by `half` to both sides: a capsule."""
    polar = np.linspace(0, pi / 2, _DOWN + 1)
    rings = np.concatenate([polar, pi - polar[::-1]])
    lift = np.repeat([half, -half], _DOWN + 1)
    around = np.linspace(0, 2 * pi, _AROUND + 1)
    unit = np.stack(
        [
            np.outer(np.sin(rings), np.cos(around)),
            np.outer(np.sin(rings), np.sin(around)),
            np.outer(np.cos(rings), np.ones_like(around)),
        ],
        axis=2,
    )
    points = unit * radii
    points[..., 2] += lift[:, None]
    normals = unit / radii
    normals /= np.linalg.norm(normals, axis=2, keepdims=True)
    return points.reshape(-1, 3), normals.reshape(-1, 3), _grid(len(rings), _AROUND + 1)


def _cylinder(radius: float, half: float) -> tuple[Array, Array, NDArray[np.uint32]]:
    around = np.linspace(0, 2 * pi, _AROUND + 1)
    circle = np.stack([np.cos(around), np.sin(around), np.zeros_like(around)], axis=1)
    up = np.array([0.0, 0.0, 1.0])
    heights = (half, half, half, -half, -half, -half)
    widths = (0.0, radius, radius, radius, radius, 0.0)
    facing = (up, up, None, None, -up, -up)
    points = np.concatenate([circle * w + up * h for w, h in zip(widths, heights, strict=True)])
    normals = np.concatenate(
        [circle if n is None else np.broadcast_to(n, circle.shape) for n in facing]
    )
    return points, normals, _grid(len(heights), _AROUND + 1)


def _grid(rows: int, columns: int) -> NDArray[np.uint32]:
    """Two triangles a cell, rows from the top down and columns anticlockwise seen from there."""
    corner = np.arange(rows * columns, dtype=np.uint32).reshape(rows, columns)
    a, b, c, d = corner[:-1, :-1], corner[1:, :-1], corner[1:, 1:], corner[:-1, 1:]
    return np.stack([a, b, c, a, c, d], axis=2).reshape(-1, 3)


def _box(half: Array) -> tuple[Array, Array, NDArray[np.uint32]]:
    points, normals = [], []
    for axis in range(3):
        for side in (1.0, -1.0):
            normal, across = np.zeros(3), np.zeros(3)
            normal[axis], across[(axis + 1) % 3] = side, 1.0
            along = np.cross(normal, across)
            for u, v in ((-1, -1), (1, -1), (1, 1), (-1, 1)):
                points.append((normal + u * across + v * along) * half)
                normals.append(normal)
    face = np.array([[0, 1, 2], [0, 2, 3]], dtype=np.uint32)
    return np.array(points), np.array(normals), np.concatenate([face + 4 * i for i in range(6)])


def _mesh(model: mujoco.MjModel, mesh: int) -> tuple[Array, Array, NDArray[np.uint32]]:
    """A mesh with its own normals, or those of its faces where a corner has several."""
    first, count = int(model.mesh_vertadr[mesh]), int(model.mesh_vertnum[mesh])
    face, faces = int(model.mesh_faceadr[mesh]), int(model.mesh_facenum[mesh])
    points = np.asarray(model.mesh_vert[first : first + count], dtype=float)
    corners = np.asarray(model.mesh_face[face : face + faces])
    at = int(model.mesh_normaladr[mesh])
    turned = model.mesh_normal[at : at + int(model.mesh_normalnum[mesh])]
    normals = np.asarray(turned[model.mesh_facenormal[face : face + faces].ravel()], dtype=float)
    pairs = np.stack([corners.ravel(), model.mesh_facenormal[face : face + faces].ravel()], axis=1)
    unique, index, inverse = np.unique(pairs, axis=0, return_index=True, return_inverse=True)
    triangles = inverse.reshape(-1, 3).astype(np.uint32)
    own = normals[index]
    lengths = np.linalg.norm(own, axis=1, keepdims=True)
    up = np.array([0.0, 0.0, 1.0])
    return (
        points[unique[:, 0]],
        np.where(lengths > 0, own / np.maximum(lengths, 1e-12), up),
        triangles,
    )


def _joined(parts: list[Surface]) -> Surface:
    starts = np.cumsum([0, *(len(part.points) for part in parts)])
    return Surface(
        np.concatenate([part.points for part in parts]),
        np.concatenate([part.normals for part in parts]),
        np.concatenate(
            [part.triangles + np.uint32(s) for part, s in zip(parts, starts, strict=False)]
        ),
        parts[0].colour,
    )
