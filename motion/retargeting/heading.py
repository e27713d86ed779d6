"""Where a captured foot points, seen from above."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from enpointe.models.anatomy import side_sign
from enpointe.motion.averaging import averaged
from enpointe.motion.retargeting.directions import unit
from enpointe.motion.retargeting.source import Source

__all__ = ["headings"]

Array = NDArray[np.float64]
_OUT = np.radians(25.0)
"""How far a foot points outside of where its knee bends to."""
_WINDOW = 0.1
"""s: headings are averaged over this, each as long as it is sure."""
_TRUST = 0.02
"""Weight of the leg, against the foot's own axes."""


def headings(source: Source, side: str, turn: Array) -> Array:
    """Heading of a foot, (T,), rad.

    The foot's axis forward tells it, unless the foot points straight down or farther; so does its
    axis across, unless the ankle was captured rolled over, which fitted skeletons often are. Each
    is believed by the square of the cosine of its angle to where the leg lets a foot point.

    Args:
        source: Levelled.
        side: "left" or "right".
        turn: (T, 3, 3), the foot's frame.
    """
    ahead, across = turn[:, :2, 0], np.stack([turn[:, 1, 1], -turn[:, 0, 1]], axis=1)
    leg = _of_leg(source, side)
    whole = _TRUST * leg
    for axis in (ahead, across):
        length = np.linalg.norm(axis, axis=1)
        cosine = np.sum(axis * leg, axis=1) / np.maximum(length, 1e-9)
        whole = whole + np.maximum(cosine, 0.0)[:, None] ** 2 * axis
    smooth = averaged(whole, _WINDOW, source.rate)
    return np.asarray(np.unwrap(np.arctan2(smooth[:, 1], smooth[:, 0])))


def _of_leg(source: Source, side: str) -> Array:
    """Where a leg lets its foot point, (T, 2), unit: out from where its knee bends to, or, with a
    straight knee, from where the pelvis faces."""
    hip, knee, ankle = (source.points[f"{side}_{joint}"] for joint in ("hip", "knee", "ankle"))
    thigh, shank = unit(knee - hip), unit(ankle - knee)
    hinge = np.cross(thigh, shank)
    bends = np.stack([hinge[:, 1], -hinge[:, 0]], axis=1)
    straight = 1.0 - np.minimum(np.linalg.norm(hinge, axis=1, keepdims=True), 1.0)
    faces = source.frames["pelvis"][:, :2, 0]
    out = Rotation.from_euler("z", side_sign(side) * _OUT).as_matrix()[:2, :2]
    return unit((bends + straight * faces) @ out.T)
