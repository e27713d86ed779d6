"""Averaging a motion over a window, as muscles that take time to raise their force do."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import convolve1d

__all__ = ["averaged", "averaged_qpos", "parzen"]

Array = NDArray[np.float64]


def parzen(count: int) -> Array:
    """A Parzen window of `count` samples, symmetric, 1 in the middle (Parzen 1961).

    As `scipy.signal.windows` has it, whose import takes longer than a short dance is solved.
    """
    away = np.abs(np.arange(count) - (count - 1) / 2) / (count / 2)
    inner = 1.0 - 6.0 * away**2.0 + 6.0 * away**3.0
    outer = 2.0 * (1.0 - away) ** 3.0
    return np.asarray(np.where(away <= 0.5 * (count - 1) / count, inner, outer))


def averaged(values: Array, seconds: float, rate: float) -> Array:
    """Rows (T, n) averaged over a Parzen window of a width in s; the ends are held."""
    window = parzen(2 * int(seconds * rate / 2) + 1)
    return np.asarray(convolve1d(values, window / window.sum(), axis=0, mode="nearest"))


def averaged_qpos(qpos: Array, seconds: float, rate: float) -> Array:
    """Configurations (T, nq) averaged; quaternions nearly agree within a window, so theirs hold."""
    smooth = averaged(qpos, seconds, rate)
    smooth[:, 3:7] /= np.linalg.norm(smooth[:, 3:7], axis=1, keepdims=True)
    return smooth
