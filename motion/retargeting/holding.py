"""A track held still while it should be, and led smoothly from one such time to the next."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

__all__ = ["hysteresis", "ramped", "runs", "shifted"]

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]


def runs(mask: Mask) -> Iterator[slice]:
    """Stretches of samples at which a mask (T,) holds."""
    edges = np.flatnonzero(np.diff(np.concatenate([[0], mask.astype(np.int8), [0]])))
    for first, last in zip(edges[::2], edges[1::2], strict=True):
        yield slice(int(first), int(last))


def hysteresis(surely: Mask, perhaps: Mask) -> Mask:
    """Stretches of `perhaps` (T,) that hold a sample of `surely`."""
    held = np.zeros_like(surely)
    for run in runs(perhaps | surely):
        held[run] = surely[run].any()
    return held


def shifted(track: Array, still: Mask, held: Callable[[Array], Array] | None = None) -> Array:
    """What to add to a track (T, n) so that it stands still where it should.

    In between the shift goes from one to the next by a smooth step, and before the first and after
    the last it stays; so the track as shifted has no breaks.

    Args:
        track: The track.
        still: (T,), when.
        held: Where it stands, (n,), of the samples of a stretch (k, n); their median without.
    """
    shift = np.zeros_like(track)
    place = held if held is not None else _median
    stretches = list(runs(still))
    if not stretches:
        return shift
    for run in stretches:
        shift[run] = place(track[run]) - track[run]
    shift[: stretches[0].start] = shift[stretches[0].start]
    shift[stretches[-1].stop :] = shift[stretches[-1].stop - 1]
    for one, other in pairwise(stretches):
        count = other.start - one.stop
        u = (np.arange(1, count + 1) / (count + 1))[:, None]
        share = u * u * (3.0 - 2.0 * u)
        start, end = shift[one.stop - 1], shift[other.start]
        shift[one.stop : other.start] = (1.0 - share) * start + share * end
    return shift


def ramped(mask: Mask, seconds: float, rate: float) -> Array:
    """(T,), 1 where a mask holds, falling smoothly to 0 over a time on both sides."""
    if not mask.any():
        return np.zeros(len(mask))
    at = np.flatnonzero(mask)
    here = np.arange(len(mask))
    place = np.searchsorted(at, here)
    away = np.minimum(
        np.abs(here - at[np.clip(place, 0, len(at) - 1)]),
        np.abs(here - at[np.clip(place - 1, 0, len(at) - 1)]),
    )
    left = np.clip(1.0 - away / (seconds * rate), 0.0, 1.0)
    return np.asarray(left * left * (3.0 - 2.0 * left))


def _median(track: Array) -> Array:
    return np.asarray(np.median(track, axis=0))
