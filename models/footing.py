"""How the feet meet the floor: flat, on demi-pointe, on pointe, touching, or not at all."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from math import atan2, degrees

import numpy as np
from numpy.typing import NDArray

from enpointe.models.figure import Figure
from enpointe.models.foot_positions import Footprint
from enpointe.models.joints import Joints
from enpointe.notation import Bend, FloorContact, Side

__all__ = ["Footing", "footing", "footprint_of", "knee_bend"]

Vector = NDArray[np.float64]
ALOFT = 0.08
"""A dancer whose lowest sole is higher than this, m, is in the air; a lower one is taken for a
dancer not quite set down, and her lowest sole for the floor."""
NEAR = 0.06
"""A sole that is no higher above the floor than this, m, may bear weight: what 5 degrees in hip,
knee and ankle together lift the nearest part of a foot that stood."""
TOUCHING = 0.015
"""A toe that is no higher than this, m, touches the floor."""
HEEL_DOWN_DEG = 25.0
"""A foot at less than this to the floor is flat: well below a rise of 62 degrees."""
TOES_UP_DEG = 45.0
"""Toes steeper than this stand on their tip: halfway between demi-pointe, 0, and pointe, 90."""
GRAND_PLIE_DEG = 90.0
DEMI_PLIE_DEG = 29.0
"""Bends of the knee from which it is a grand plié and a demi-plié: halfway between their amounts
and that of the next lower one (`Style`)."""
_RISE_OF_GRAND_PLIE = 50.0
_LEAST_SHARE = 0.15
"""A raised foot that carries less of the way to the centre of mass than this does not bear."""
_CLOSE = 0.10
"""Feet no farther apart than this, m, share the weight."""


@dataclass(frozen=True, slots=True)
class Footing:
    """How one foot meets the floor.

    Attributes:
        floor: Flat, demi-pointe, pointe or touching; None in the air.
        bend: Of the knee above it.
        clearance: Lowest point of the sole above the floor, m.
        rise_deg: Angle of the foot from heel to ball to the floor, + heel up.
    """

    floor: FloorContact | None
    bend: Bend
    clearance: float
    rise_deg: float

    @property
    def bears(self) -> bool:
        """Whether weight is on it."""
        return self.floor is not None and self.floor is not FloorContact.TOUCH


def footing(joints: Joints) -> Mapping[Side, Footing]:
    """Both feet, from the heights of their soles and the place of the centre of mass."""
    lows = {side: min(_sole(joints, side)[:, 2]) for side in Side}
    floor = min(lows.values())
    aloft = floor > ALOFT
    clearance = {side: low - (0.0 if aloft else floor) for side, low in lows.items()}
    shares = _shares(joints)
    return {side: _one(joints, side, clearance[side], shares[side], aloft=aloft) for side in Side}


def knee_bend(joints: Joints, side: Side) -> float:
    """Bend of a knee, degrees; 0 is straight."""
    thigh = joints.between(f"{side}_hip", f"{side}_knee")
    shank = joints.between(f"{side}_knee", f"{side}_ankle")
    return degrees(float(np.arccos(np.clip(thigh @ shank, -1.0, 1.0))))


def footprint_of(joints: Joints, side: Side, contact: FloorContact, figure: Figure) -> Footprint:
    """Where a foot that bears weight would stand flat, in the world.

    A rising foot keeps its ball; on pointe it has drawn its tip in to where a quarter of the way
    from heel to tip was (see `StanceTracker`).
    """
    along = joints[f"{side}_ball"] - joints[f"{side}_heel"]
    along = along / np.linalg.norm(along)
    rise = joints[f"{side}_ankle"] - joints[f"{side}_heel"]
    up = rise - (rise @ along) * along
    aside = np.cross(up, along)
    direction = atan2(-aside[0], aside[1])
    if contact is FloorContact.POINTE:
        forward = figure.ball_forward + figure.toe_length
        drawn = -0.5 * figure.heel_back
        place, offset = joints[f"{side}_toe_tip"], drawn + 0.25 * (forward - drawn)
    else:
        place, offset = joints[f"{side}_ball"], figure.ball_forward
    turned = np.array([np.cos(direction), np.sin(direction)])
    return Footprint(place[:2] - offset * turned, direction)


def _one(joints: Joints, side: Side, clearance: float, share: float, *, aloft: bool) -> Footing:
    rise = _steepness(joints[f"{side}_ball"] - joints[f"{side}_heel"])
    knee = knee_bend(joints, side)
    bend = (
        Bend.GRAND_PLIE
        if knee > GRAND_PLIE_DEG
        else Bend.DEMI_PLIE
        if knee > DEMI_PLIE_DEG
        else Bend.STRAIGHT
    )
    flat = rise < HEEL_DOWN_DEG or (bend is Bend.GRAND_PLIE and rise < _RISE_OF_GRAND_PLIE)
    floor: FloorContact | None = None
    if not aloft and clearance < NEAR and (flat or share > _LEAST_SHARE):
        toes = _steepness(joints[f"{side}_toe_tip"] - joints[f"{side}_ball"])
        risen = FloorContact.POINTE if toes > TOES_UP_DEG else FloorContact.DEMI_POINTE
        floor = FloorContact.FLAT if flat else risen
    elif not aloft and clearance < TOUCHING:
        floor = FloorContact.TOUCH
    return Footing(floor, bend, clearance, rise)


def _steepness(along: Vector) -> float:
    """How far a vector points down, degrees."""
    return degrees(atan2(-along[2], float(np.hypot(along[0], along[1]))))


def _sole(joints: Joints, side: Side) -> Vector:
    return np.array([joints[f"{side}_{part}"] for part in ("heel", "ball", "toe_tip")])


def _shares(joints: Joints) -> dict[Side, float]:
    """How far the centre of mass is on the way from the other foot to each one, about 0 to 1."""
    left, right = (joints[f"{side}_ball"][:2] for side in Side)
    apart = left - right
    length2 = float(apart @ apart)
    if length2 < _CLOSE**2:
        return dict.fromkeys(Side, 0.5)
    share = float((joints.com[:2] - right) @ apart) / length2
    return {Side.LEFT: share, Side.RIGHT: 1.0 - share}
