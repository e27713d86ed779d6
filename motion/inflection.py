"""Inflection of the wrist: the hand trails behind the wrist, more for a light movement.

Neagle 2005 §5.2.3, §5.4.3: the wrist leads and the hand follows, most in light movement and least
in heavy; at the side a lowering hand goes little finger first (Cecchetti), which is the same trail
seen from a palm that faces the front. How many degrees "most" and "least" are, the thesis does not
print; the two bounds here are ours.
"""

from __future__ import annotations

from math import pi, radians, sin

import numpy as np
from numpy.typing import NDArray

from enpointe.models.target import ArmTarget
from enpointe.motion.effort import WEIGHT_RANGE
from enpointe.notation import Side

__all__ = ["inflected"]

HEAVY_DEG, LIGHT_DEG = 4.0, 22.0
_BEND_LIMIT = radians(55.0)
_CROSS_LIMIT = (radians(-30.0), radians(20.0))


def inflected(
    arm: ArmTarget, side: Side, heading: NDArray[np.float64], k: float, weight: float
) -> tuple[float, float]:
    """Bend and cross of a wrist on its way.

    Args:
        arm: Where the arm is, with the wrist line of its key pose.
        side: Whose arm.
        heading: Unit direction of the wrist's movement in the torso's frame, (3,), or zero.
        k: Share of the path, in [0, 1]; the trail is widest half-way.
        weight: Laban's weight, 0.3 heavy to 0.8 light.

    Returns:
        Wrist bend (towards the palm) and cross (towards the thumb), rad.
    """
    low, high = WEIGHT_RANGE
    lightness = (weight - low) / (high - low)
    trail = radians(HEAVY_DEG + lightness * (LIGHT_DEG - HEAVY_DEG)) * sin(pi * k)
    palm, thumb = _hand_axes(arm, side)
    bend = arm.wrist_bend - trail * float(heading @ palm)
    cross = arm.wrist_cross - trail * float(heading @ thumb)
    return float(np.clip(bend, -_BEND_LIMIT, _BEND_LIMIT)), float(np.clip(cross, *_CROSS_LIMIT))


def _hand_axes(arm: ArmTarget, side: Side) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Where palm and thumb face: with the forearm unturned along the elbow's hinge and into its
    crook, and turned about the forearm from there. Zeros for a straight arm, which has no hinge."""
    upper, along = arm.elbow - arm.shoulder, arm.wrist - arm.elbow
    along = along / np.linalg.norm(along)
    hinge = np.cross(upper / np.linalg.norm(upper), along)
    sine = float(np.linalg.norm(hinge))
    if sine < 1e-3:
        return np.zeros(3), np.zeros(3)
    hinge = hinge / sine if side is Side.LEFT else -hinge / sine
    crook = np.cross(hinge, along) if side is Side.LEFT else np.cross(along, hinge)
    c, s = np.cos(arm.forearm_turn), np.sin(arm.forearm_turn)
    return c * hinge + s * crook, c * crook - s * hinge
