"""How a foot in the air is carried clear of the floor, smoothly and in time."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import maximum_filter1d

from enpointe.motion.averaging import averaged

__all__ = ["LIFTING", "lifted"]

Array = NDArray[np.float64]
LIFTING = 0.1
"""s that a foot takes to be clear of the floor, and to come down again."""


def lifted(short: Array, rate: float) -> Array:
    """A smooth lift (T,), m, of at least what is short of the clearance wherever it is.

    Args:
        short: (T,), what is missing, m, 0 where nothing is.
        rate: Samples per second.
    """
    width = 2 * int(0.5 * LIFTING * rate) + 1
    held = maximum_filter1d(short, width)
    return averaged(held[:, None], 2 * LIFTING, rate)[:, 0]
