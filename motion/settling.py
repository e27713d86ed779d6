"""The contacts of a capture, as steps that a body can take."""

from __future__ import annotations

import mujoco
import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import find_objects, label

from enpointe.models.anatomy import SIDES
from enpointe.motion.contact_schedule import ContactSchedule, without_chatter

__all__ = ["SHORTEST_FLIGHT", "settled"]

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]
SHORTEST_FLIGHT = 0.1
"""s: a shorter time without a sole on the floor is a step seen late; what stood stays down until
something else stands."""


def settled(model: mujoco.MjModel, contacts: ContactSchedule) -> ContactSchedule:
    """The same stances on the floor, and between them a way from each to the next without jumps.

    Where a captured foot comes and goes, its soles jump by centimetres from sample to sample: they
    are seen to stand, or not to. Here

    - contacts, and gaps in them, too short to shift weight in are left out;
    - a foot that comes down with its heel first, or leaves so, is flat meanwhile: nobody balances
      on a heel that rolls;
    - a sole keeps the places at which it stands, at height 0, and goes from one stance to the next
      by a smooth step.

    Args:
        model: Whose soles they are.
        contacts: Evenly sampled.
    """
    period = float(np.median(np.diff(contacts.time)))
    bears = _carried(without_chatter(contacts.bears, period), period)
    points = contacts.points.copy()
    for side in SIDES:
        _flatten(model, contacts.soles, side, bears, points)
    for sole, standing in enumerate(bears.T):
        if standing.any():
            points[:, sole] = _stepped(points[:, sole], standing)
    return ContactSchedule(contacts.time, contacts.soles, points, bears)


def _carried(bears: Mask, period: float) -> Mask:
    """Short times with nothing down are bridged by what stood before them."""
    carried = bears.copy()
    for (gap,) in find_objects(label(~bears.any(axis=1))[0]):
        short = (gap.stop - gap.start) * period < SHORTEST_FLIGHT - 1e-9
        if short and gap.start > 0 and gap.stop < len(bears):
            carried[gap] = bears[gap.start - 1]
    return carried


def _flatten(
    model: mujoco.MjModel, soles: NDArray[np.int64], side: str, bears: Mask, points: Array
) -> None:
    """Stand a foot flat, in place, where only its heel bears beside a time when it is flat."""
    bodies = model.geom_bodyid[soles]
    heel = np.flatnonzero(bodies == model.body(f"{side}_foot").id)
    toes = np.flatnonzero(bodies == model.body(f"{side}_toe").id)
    foot = np.concatenate([heel, toes])
    on_heel, on_toes = (np.asarray(bears[:, part].any(axis=1)) for part in (heel, toes))
    flat = np.asarray(bears[:, foot].all(axis=1))
    for (stance,) in find_objects(label(on_heel | on_toes)[0]):
        rows = np.arange(stance.start, stance.stop)
        stood = rows[flat[rows]]
        if len(stood):
            alone = rows[on_heel[rows] & ~on_toes[rows]]
            nearest = stood[np.abs(alone[:, None] - stood).argmin(axis=1)]
            points[np.ix_(alone, foot)] = points[np.ix_(nearest, foot)]
            bears[np.ix_(alone, foot)] = True


def _stepped(points: Array, standing: Mask) -> Array:
    """A sole's places (T, 3) where it stands, and a smooth step between them."""
    rows = np.arange(len(points))
    stood = np.flatnonzero(standing)
    following = np.searchsorted(stood, rows)
    after = stood[np.minimum(following, len(stood) - 1)]
    before = np.where(standing, rows, stood[np.maximum(following - 1, 0)])
    share = np.clip((rows - before) / np.maximum(after - before, 1), 0.0, 1.0)
    share = (share**2 * (3.0 - 2.0 * share))[:, None]
    stepped = (1.0 - share) * points[before] + share * points[after]
    stepped[:, 2] = 0.0
    return np.asarray(stepped)
