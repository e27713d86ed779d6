"""Smooth closed surfaces for a dancer's flesh: elliptical rings lofted along a line."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import PchipInterpolator

__all__ = ["Ring", "loft"]


@dataclass(frozen=True, slots=True)
class Ring:
    """An ellipse across the line of a loft.

    Attributes:
        at: Distance along the loft's axis, m.
        forward: Half-width along the first cross axis, m.
        sideways: Half-width along the second cross axis, m.
        shift: Offset of the centre along the first cross axis, m.
        slide: Offset of the centre along the second cross axis, m.
    """

    at: float
    forward: float
    sideways: float
    shift: float = 0.0
    slide: float = 0.0


def loft(
    rings: Sequence[Ring], axis: str, *, slices: int = 28, around: int = 28
) -> tuple[NDArray[np.float64], NDArray[np.int32]]:
    """Skin a monotone row of rings with a closed triangle surface.

    Widths are interpolated with a shape-preserving cubic (PCHIP), which neither dents nor bulges
    between rings. Both ends close in a point at the last ring's centre.

    Args:
        rings: At least two, `at` strictly increasing or strictly decreasing.
        axis: "x" or "z": the loft runs along it. Cross axes are (z, y) for "x", (x, y) for "z".
        slices: Rings in the surface.
        around: Vertices in each ring.

    Returns:
        Vertices (V, 3) in metres and triangles (F, 3), wound outwards.
    """
    ordered = sorted(rings, key=lambda ring: ring.at)
    table = np.array([[r.at, r.forward, r.sideways, r.shift, r.slide] for r in ordered])
    curve = PchipInterpolator(table[:, 0], table[:, 1:])
    along = table[0, 0] + (table[-1, 0] - table[0, 0]) * _crowded_to_ends(slices)
    widths = curve(along)
    angle = np.linspace(0.0, 2.0 * np.pi, around, endpoint=False)
    first = widths[:, 2, None] + widths[:, 0, None] * np.cos(angle)
    second = widths[:, 3, None] + widths[:, 1, None] * np.sin(angle)
    line = np.broadcast_to(along[:, None], first.shape)
    body = np.stack([line, first, second], axis=-1).reshape(-1, 3)
    tips = np.array(
        [[along[0], widths[0, 2], widths[0, 3]], [along[-1], widths[-1, 2], widths[-1, 3]]]
    )
    vertices = np.vstack([body, tips])
    faces = _ring_faces(slices, around)
    if axis == "z":
        return vertices[:, [1, 2, 0]], faces
    if axis == "x":
        return vertices[:, [0, 2, 1]], faces[:, ::-1].copy()
    raise ValueError(f"axis must be 'x' or 'z', got {axis!r}")


def _crowded_to_ends(count: int) -> NDArray[np.float64]:
    """Parameters in [0, 1], denser at both ends, where a closed surface curves most."""
    return np.asarray(0.5 * (1.0 - np.cos(np.linspace(0.0, np.pi, count))), dtype=np.float64)


def _ring_faces(slices: int, around: int) -> NDArray[np.int32]:
    ring = np.arange(around)
    follower = (ring + 1) % around
    faces = []
    for i in range(slices - 1):
        low, high = i * around, (i + 1) * around
        faces.append(np.stack([low + ring, low + follower, high + follower], axis=1))
        faces.append(np.stack([low + ring, high + follower, high + ring], axis=1))
    start, end = slices * around, slices * around + 1
    faces.append(np.stack([np.full(around, start), follower, ring], axis=1))
    last = (slices - 1) * around
    faces.append(np.stack([np.full(around, end), last + ring, last + follower], axis=1))
    return np.vstack(faces).astype(np.int32)
