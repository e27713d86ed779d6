"""Outlines that the table of glyphs is drawn with, as SVG path data in stave spaces."""

from __future__ import annotations

import math

__all__ = ["CROSSES", "disc", "dotted", "flag", "oval"]

CROSSES = "M-.14 1.36L.14 1.64M-.14 1.64L.14 1.36M-.14 2.36L.14 2.64M-.14 2.64L.14 2.36"
"""Two small crosses in the middle spaces, between the two lines of a repeat sign."""


def disc(radius: float) -> str:
    """Outline of a disc about the origin."""
    r, k = radius, 0.5523 * radius
    return (
        f"M{r} 0C{r} {k} {k} {r} 0 {r}C{-k} {r} {-r} {k} {-r} 0"
        f"C{-r} {-k} {-k} {-r} 0 {-r}C{k} {-r} {r} {-k} {r} 0Z"
    )


def oval(wide: float, high: float, lean: float) -> str:
    """Outline of an oval about the origin whose right end is raised by `lean` radians."""
    c, s, k = math.cos(lean), math.sin(lean), 0.5523
    corners: list[tuple[float, float]] = []
    corners += ((1, 0), (1, k), (k, 1), (0, 1), (-k, 1), (-1, k), (-1, 0))
    corners += ((-1, -k), (-k, -1), (0, -1), (k, -1), (1, -k), (1, 0))
    points = [
        f"{x * wide * c + y * high * s:.3f} {-x * wide * s + y * high * c:.3f}" for x, y in corners
    ]
    curves = "".join(f"C{' '.join(points[i : i + 3])}" for i in range(1, 13, 3))
    return f"M{points[0]}{curves}Z"


def dotted(x: float) -> str:
    """An upright dotted line from the top line of the stave to the floor line."""
    return "".join(f"M{x} {0.4 * dot + 0.15:.2f}L{x} {0.4 * dot + 0.25:.2f}" for dot in range(10))


def flag(top: float) -> str:
    """Outline of a note's flag, hung from the stem at `top`."""
    return (
        f"M.23 {top}C.3 {top + 0.3} .72 {top + 0.35} .55 {top + 0.95}"
        f"C.6 {top + 0.6} .4 {top + 0.45} .23 {top + 0.45}Z"
    )
