"""When a movement needs an invisible hand, and what the hand would have to do."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import binary_closing, find_objects, label

__all__ = ["Help", "spans_of_help"]

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]
PAUSE = 0.1
"""s: two times of help with less between them are one."""
JOLT = 0.03
"""s: what is missing for less is one sample of it, where a speed changes at once; how much is
missing there says how often was looked, not how hard it is."""
FAR = 1.0
"""m: beyond this the number says nothing more; hardly anything presses on the floor there."""
_AT_ONCE = "too sudden: something starts or stops at once"


@dataclass(frozen=True, slots=True)
class Help:
    """A time in which no floor under the feet can give what the movement needs.

    Attributes:
        start: s.
        end: s.
        most: Largest force, or moment over 1 m, that is missing, N.
        why: In words.
    """

    start: float
    end: float
    most: float
    why: str


def spans_of_help(
    wrench_time: Array,
    wrench: Array,
    bound: float,
    time: Array,
    aloft: Mask,
    zmp_margin: Array,
) -> tuple[Help, ...]:
    """The times in which more is missing than a bound.

    Args:
        wrench_time: (N,), s.
        wrench: (N,), what is missing, N.
        bound: N.
        time: (T,), s, of what follows.
        aloft: (T,), whether nothing stands.
        zmp_margin: (T,), zero-moment point to the edge of the support, m; not-a-number in the air.
    """
    period = float(wrench_time[1] - wrench_time[0]) if len(wrench_time) > 1 else 1.0
    gap = np.ones(2 * int(0.5 * PAUSE / period) + 1, dtype=bool)
    padded = np.pad(np.asarray(wrench > bound), len(gap))
    missing = binary_closing(padded, gap)[len(gap) : -len(gap)]
    found = []
    for (span,) in find_objects(label(missing)[0]):
        start, end = float(wrench_time[span][0]), float(wrench_time[span][-1])
        during = (time >= start - 0.5 * period) & (time <= end + 0.5 * period)
        jolt = end - start < JOLT and not aloft[during].any()
        why = _AT_ONCE if jolt else _why(aloft[during], zmp_margin[during])
        found.append(Help(start, end, float(wrench[span].max()), why))
    return tuple(found)


def _why(aloft: Mask, zmp_margin: Array) -> str:
    if len(aloft) and np.mean(aloft) > 0.5:
        return "in the air, and not falling as bodies fall"
    known = zmp_margin[np.isfinite(zmp_margin)]
    outside = -float(known.min()) if len(known) else 0.0
    if outside > FAR:
        return "the floor would have to push more than a metre outside the feet"
    if outside > 0.0:
        return f"the floor would have to push {1000 * outside:.0f} mm outside the feet"
    return "the floor would have to pull, or the feet to slide"
