"""Feet on their way from one planned stance to the next."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from enpointe.motion.foot_turns import turned_about

__all__ = ["carried"]

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]


def carried(points: Array, planned: Array, bears: Mask) -> Array:
    """The soles of one foot (T, N, 3), moved and turned over the floor to where it is to stand.

    Where some of them bear, the foot is laid over their planned places, by least squares in the
    plane (Kabsch 1976), and the others come with it; while none does, what it is moved and turned
    by goes by a smooth step from that of one stance to that of the next. A foot that is put down
    elsewhere than it was captured is so under way there all the time that it is in the air.

    Args:
        points: As captured, m.
        planned: Where the soles are to stand, (T, N, 3), m.
        bears: (T, N).
    """
    stands = np.asarray(bears.any(axis=1))
    if not stands.any():
        return points
    weights = bears / np.maximum(bears.sum(axis=1, keepdims=True), 1)
    centre = np.einsum("tn,tnk->tk", weights, points[:, :, :2])
    there = np.einsum("tn,tnk->tk", weights, planned[:, :, :2])
    spread = _complex(points - _level(centre)) * bears
    wanted = _complex(planned - _level(there)) * bears
    angle = np.unwrap(_between(np.angle((wanted * spread.conj()).sum(axis=1)), stands))
    middle = points[:, :, :2].mean(axis=1)
    laid = turned_about(points, middle, angle)
    gone = there - np.einsum("tn,tnk->tk", weights, laid[:, :, :2])
    laid[:, :, :2] += np.stack([_between(part, stands) for part in gone.T], axis=1)[:, None]
    return laid


def _level(places: Array) -> Array:
    return np.concatenate([places, np.zeros((len(places), 1))], axis=1)[:, None]


def _complex(points: Array) -> NDArray[np.complex128]:
    return np.asarray(points[:, :, 0] + 1j * points[:, :, 1])


def _between(values: Array, known: Mask) -> Array:
    """Values (T,) where they are known, and smooth steps between."""
    rows, found = np.arange(len(values)), np.flatnonzero(known)
    after = found[np.minimum(np.searchsorted(found, rows), len(found) - 1)]
    before = found[np.maximum(np.searchsorted(found, rows, side="right") - 1, 0)]
    share = np.clip((rows - before) / np.maximum(after - before, 1), 0.0, 1.0)
    share = share**2 * (3.0 - 2.0 * share)
    return np.asarray((1.0 - share) * values[before] + share * values[after])
