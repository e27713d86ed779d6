"""The least time scale at which many quadratic inequalities hold, found exactly.

With s = 1/k the speed that is left of a movement, all that servos and floor can't do is

    square s^2 + linear s + constant <= 0,

one row a joint and moment. Each row forbids an interval or two of s; what is looked for is the
largest s of (0, 1] in none of them. A motion may be possible fast and not slow (a weight thrown
up), so that a bisection would be wrong in general; intervals are not.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

__all__ = ["SLOWEST", "Rows", "allowed_speeds", "fastest_lasting"]

Array = NDArray[np.float64]
SLOWEST = 20.0
"""A movement in more than so many times its time is not that movement any more."""
TOLERANCE = 1e-9
"""Of the limit: rounding."""
_STEP = 0.98
_FLAT = 1e-12


@dataclass(frozen=True)
class Rows:
    """Inequalities of one kind, each divided by its limit.

    The share of the limit that is used is  square s^2 + linear s + constant + 1.

    Attributes:
        kind: What is limited.
        joint: (K,), which joint each is of; -1 for the body as a whole.
        sample: (K,), which moment.
        square: (K,).
        linear: (K,).
        constant: (K,).
    """

    kind: str
    joint: NDArray[np.int64]
    sample: NDArray[np.int64]
    square: Array
    linear: Array
    constant: Array

    def used(self, speed: float = 1.0) -> Array:
        """(K,), the share of the limit that is used at a speed."""
        return np.asarray((self.square * speed + self.linear) * speed + self.constant + 1.0)

    def only(self, chosen: NDArray[np.bool_]) -> Rows:
        """Some of them."""
        names = ("joint", "sample", "square", "linear", "constant")
        return Rows(self.kind, *(getattr(self, name)[chosen] for name in names))

    def forbidden(self) -> Array:
        """(F, 2), open intervals of speeds that some row does not allow, within (0, 1]."""
        a, b, c = self.square, self.linear, self.constant - TOLERANCE
        curved, sloped = np.abs(a) > _FLAT, np.abs(b) > _FLAT
        with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
            root = np.sqrt(np.maximum(b * b - 4.0 * a * c, 0.0))
            # Without the difference of two like numbers that the schoolbook's formula has.
            q = -0.5 * (b + np.where(b >= 0.0, root, -root))
            ends = np.sort(np.stack([q / a, np.where(q == 0.0, 0.0, c / q)]), axis=0)
            crossing = -c / b
        real = b * b - 4.0 * a * c > 0.0
        whole = (curved & (a > 0) & ~real) | (~curved & ~sloped & (c > 0))
        up, down = curved & (a > 0) & real, curved & (a < 0) & real
        line_up, line_down = ~curved & (b > _FLAT), ~curved & (b < -_FLAT)
        always, never = np.full(len(a), np.inf), np.full(len(a), -np.inf)
        found = [
            _pairs(never, always, whole),
            _pairs(never, ends[0], up),
            _pairs(ends[1], always, up),
            _pairs(ends[0], ends[1], down),
            _pairs(crossing, always, line_up),
            _pairs(never, crossing, line_down),
        ]
        spans = np.concatenate(found)
        return np.asarray(spans[(spans[:, 1] > 1.0 / SLOWEST) & (spans[:, 0] < 1.0)])


def _pairs(low: Array, high: Array, chosen: NDArray[np.bool_]) -> Array:
    return np.stack([low[chosen], high[chosen]], axis=1)


def allowed_speeds(rows: Sequence[Rows]) -> tuple[tuple[float, float], ...]:
    """Intervals of speeds (low, high) that all rows allow, within [1/SLOWEST, 1], fastest first."""
    spans = np.concatenate([np.empty((0, 2)), *(each.forbidden() for each in rows)])
    spans = spans[np.argsort(-spans[:, 1], kind="stable")]
    allowed, top = [], 1.0
    for low, high in spans.tolist():
        if high <= top:
            allowed.append((high, top))
        top = min(top, low)
    slowest = 1.0 / SLOWEST
    if top >= slowest:
        allowed.append((slowest, top))
    return tuple((max(low, slowest), high) for low, high in allowed if high >= slowest)


def fastest_lasting(
    allowed: Sequence[tuple[float, float]], lasts: Callable[[float], bool]
) -> float | None:
    """The largest allowed speed at which something lasts, to a thousandth; None if none does.

    Args:
        allowed: Intervals, fastest first.
        lasts: Whether what can't be said of one moment alone, heat say, allows a speed.
    """
    for low, high in allowed:
        failed, speed = None, high
        while not lasts(speed):
            if speed <= low:
                break
            failed, speed = speed, max(low, speed * _STEP)
        else:
            return speed if failed is None else _refined(speed, failed, lasts)
    return None


def _refined(good: float, bad: float, lasts: Callable[[float], bool]) -> float:
    while bad - good > 1e-4 * good:
        middle = 0.5 * (good + bad)
        good, bad = (middle, bad) if lasts(middle) else (good, middle)
    return good
