"""Averaging a motion over a window, as muscles that take time to raise their force do."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import convolve1d
from scipy.signal.windows import parzen

__all__ = ["averaged", "averaged_qpos"]

Array = NDArray[np.float64]


def averaged(values: Array, seconds: float, rate: float) -> Array:
    """Rows (T, n) averaged over a Parzen window of a width in s; the ends are held."""
    window = parzen(2 * int(seconds * rate / 2) + 1, sym=True)
    return np.asarray(convolve1d(values, window / window.sum(), axis=0, mode="nearest"))


def averaged_qpos(qpos: Array, seconds: float, rate: float) -> Array:
    """Configurations (T, nq) averaged; quaternions nearly agree within a window, so theirs hold."""
    smooth = averaged(qpos, seconds, rate)
    smooth[:, 3:7] /= np.linalg.norm(smooth[:, 3:7], axis=1, keepdims=True)
    return smooth
