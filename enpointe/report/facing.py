"""From where a movement is best seen: a capture's dancer may have her back to the audience."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from scipy.spatial.transform import Rotation

from enpointe.motion import Motion
from enpointe.sim.camera import View

__all__ = ["SEEN", "in_front_of", "seen_from"]

SEEN = "Seen from the audience."
_TURNED = 60.0
"""Degrees from the audience up to which she is seen from there."""
_STEADY = 0.5
"""Length of the mean of her headings, as unit vectors, below which she faces nowhere."""


def in_front_of(motion: Motion, view: View) -> View:
    """The view, carried round her to where she faces, if that is not to the audience."""
    return replace(view, azimuth=view.azimuth + _turn(motion))


def seen_from(motion: Motion) -> str:
    """A sentence for a caption, of a view that was carried round."""
    turn = _turn(motion)
    if turn == 0.0:
        return SEEN
    side = "left" if turn > 0.0 else "right"
    return f"Seen from in front of her: she faces {abs(turn):.0f}° to the {side} of the audience."


def _turn(motion: Motion) -> float:
    """Degrees to the left from the audience to where she faces; 0 where she can be seen from it."""
    ahead = Rotation.from_quat(motion.qpos[:, 3:7], scalar_first=True).apply([1.0, 0.0, 0.0])
    level = ahead[:, :2] / np.maximum(np.linalg.norm(ahead[:, :2], axis=1, keepdims=True), 1e-9)
    x, y = level.mean(axis=0)
    turn = float(np.degrees(np.arctan2(y, x)))
    return turn if np.hypot(x, y) > _STEADY and abs(turn) > _TURNED else 0.0
