"""Units and the upward axis of markers in a file that does not tell."""

from __future__ import annotations

from typing import Literal

import numpy as np
from numpy.typing import NDArray

from enpointe.motion.formats.space import Space

__all__ = ["UNITS", "guessed_space", "guessed_up", "unit_name"]

Array = NDArray[np.float64]
Axis = Literal["x", "y", "z"]

UNITS = {
    "m": 1.0,
    "meter": 1.0,
    "meters": 1.0,
    "metre": 1.0,
    "metres": 1.0,
    "dm": 0.1,
    "cm": 0.01,
    "centimeters": 0.01,
    "mm": 0.001,
    "millimeters": 0.001,
    "in": 0.0254,
    "inch": 0.0254,
    "inches": 0.0254,
    "ft": 0.3048,
    "feet": 0.3048,
}
_AXES: tuple[Axis, Axis, Axis] = ("x", "y", "z")
_LOOKED_AT = 200
_NEAR_FLOOR = 0.25
_TALLEST, _SMALLEST = 2.6, 0.75


def unit_name(metres: float) -> str | None:
    """The short name of a unit of length, or None where it has none."""
    return next((name for name, size in UNITS.items() if np.isclose(size, metres, rtol=1e-6)), None)


def guessed_up(positions: Array, usual: Axis) -> Axis:
    """The axis along which a figure stands: the tallest of those that start near a floor at 0.

    Args:
        positions: (T, M, 3), NaN where not seen.
        usual: The format's own, taken where the points do not tell.
    """
    low, high = _ranges(positions)
    height = high - low
    if not np.isfinite(height).all() or height.max() <= 0:
        return usual
    floored = np.abs(low) < _NEAR_FLOOR * height
    if not floored.any():
        return usual
    return _AXES[int(np.argmax(np.where(floored, height, -1.0)))]


def guessed_space(
    positions: Array, usual: Axis, metres: float | None, usual_metres: float = 0.001
) -> tuple[Space, list[str]]:
    """How a file measures that does not tell all, and a line for each guess.

    Args:
        positions: (T, M, 3), file units, NaN where not seen.
        usual: Upward axis of files of this format.
        metres: Size of the unit where the file names it.
        usual_metres: Size of the unit where neither the file nor the points tell.
    """
    up = guessed_up(positions, usual)
    warnings = [f"the file names no upward axis; {up} is taken"]
    if metres is None:
        metres = _guessed_unit(positions, "xyz".index(up), usual_metres)
        warnings.append(f"the file names no unit of length; {unit_name(metres)} is taken")
    return Space(metres_per_unit=metres, up=up), warnings


def _guessed_unit(positions: Array, axis: int, usual: float) -> float:
    low, high = _ranges(positions)
    height = high[axis] - low[axis]
    for metres in (usual, 0.001, 0.01, 1.0, 0.0254):
        if np.isfinite(height) and _SMALLEST < height * metres < _TALLEST:
            return metres
    return usual


def _ranges(positions: Array) -> tuple[Array, Array]:
    """Lowest and highest coordinates, (3,) each, typical for a frame."""
    few = positions[:: max(len(positions) // _LOOKED_AT, 1)]
    known = np.isfinite(few)
    whole = np.any(np.all(known, axis=2), axis=1)
    if not whole.any():
        return np.full(3, np.nan), np.full(3, np.nan)
    low = few.min(axis=1, initial=np.inf, where=known)[whole]
    high = few.max(axis=1, initial=-np.inf, where=known)[whole]
    return np.median(low, axis=0), np.median(high, axis=0)
