"""How the feet meet the floor: flat, on demi-pointe, on pointe, touching, or not at all."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from math import atan2, degrees

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from enpointe.models.figure import Figure
from enpointe.models.foot_positions import Footprint
from enpointe.models.joints import Joints, angle_between
from enpointe.notation import Bend, FloorContact, Side

__all__ = ["Footing", "footing", "footprint_of", "knee_bend", "lowest_sole"]

Vector = NDArray[np.float64]
ALOFT = 0.08
"""A dancer whose lowest sole is higher than this, m, is in the air; a lower one is taken for a
dancer not quite set down, and the lowest point of the foot under her weight for the floor."""
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
_LEAST_SHARE = 0.3
"""A raised foot that carries less of the weight than this does not bear: a toe stretched out to the
floor carries none, of two raised feet each carries half, and noise of 5 degrees moves either by 15
per cent."""
_OF_THE_HIP = 0.4
"""The share of a sole's tilt that is the hip's: a half where hip and ankle alone make it, sideways,
a third where the knee does too."""
_CLOSE = 0.12
"""Raised feet no farther apart than this, m, share the weight."""


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
    lows = {side: _low(joints, side) for side in Side}
    shares = _shares(joints)
    floor = min(lows[side] for side in Side if shares[side] > _LEAST_SHARE)
    aloft = min(lows.values()) > ALOFT
    return {
        side: _one(joints, side, low - (0.0 if aloft else floor), shares[side], aloft=aloft)
        for side, low in lows.items()
    }


def lowest_sole(joints: Joints) -> float:
    """Height of the lowest point of both soles, m."""
    return min(_low(joints, side) for side in Side)


def knee_bend(joints: Joints, side: Side) -> float:
    """Bend of a knee, degrees; 0 is straight."""
    thigh = joints.between(f"{side}_hip", f"{side}_knee")
    shank = joints.between(f"{side}_knee", f"{side}_ankle")
    return angle_between(thigh, shank)


def footprint_of(joints: Joints, side: Side, contact: FloorContact, figure: Figure) -> Footprint:
    """Where a foot that bears weight would stand flat, in the world.

    A rising foot, as in a grand plié, keeps its ball; on pointe it has drawn its tip in to where a
    quarter of the way from heel to tip was (see `StanceTracker`). A foot that stands lies flat, so
    that what its sole is off the level is an error of the angles above it; `_OF_THE_HIP` of it is
    taken back about the hip.
    """
    along = joints[f"{side}_ball"] - joints[f"{side}_heel"]
    along = along / np.linalg.norm(along)
    rise = joints[f"{side}_ankle"] - joints[f"{side}_heel"]
    up = rise - (rise @ along) * along
    aside = np.cross(up, along)
    direction = atan2(-aside[0], aside[1])
    turned = np.array([np.cos(direction), np.sin(direction)])
    if contact is FloorContact.FLAT and _steepness(along) < HEEL_DOWN_DEG:
        hip, ankle = joints[f"{side}_hip"], joints[f"{side}_ankle"]
        tilt = np.cross(up / np.linalg.norm(up), [0.0, 0.0, 1.0])
        level = hip + Rotation.from_rotvec(_OF_THE_HIP * tilt).apply(ankle - hip)
        return Footprint(level[:2], direction)
    if contact is FloorContact.POINTE:
        forward = figure.ball_forward + figure.toe_length
        drawn = -0.5 * figure.heel_back
        offset = drawn + 0.25 * (forward - drawn)
        return Footprint(joints[f"{side}_toe_tip"][:2] - offset * turned, direction)
    return Footprint(joints[f"{side}_ball"][:2] - figure.ball_forward * turned, direction)


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
    if not aloft and abs(clearance) < NEAR and (flat or share > _LEAST_SHARE):
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


def _low(joints: Joints, side: Side) -> float:
    return float(min(_sole(joints, side)[:, 2]))


def _shares(joints: Joints) -> dict[Side, float]:
    """What each foot carries of the weight, 0 to 1, by the lever of the centre of mass.

    Of a foot that is down the whole sole counts, of a raised one the toes.
    """
    soles = {side: _sole(joints, side)[:, :2] for side in Side}
    bases = {}
    for side in Side:
        rise = _steepness(joints[f"{side}_ball"] - joints[f"{side}_heel"])
        start = 0 if rise < HEEL_DOWN_DEG else 1
        bases[side] = soles[side][start], soles[side][2]
    if float(np.linalg.norm(soles[Side.LEFT][1] - soles[Side.RIGHT][1])) < _CLOSE:
        return dict.fromkeys(Side, 0.5)
    away = {side: _distance_to(joints.com[:2], *base) for side, base in bases.items()}
    total = max(sum(away.values()), 1e-9)
    return {side: away[side.other] / total for side in Side}


def _distance_to(point: Vector, start: Vector, end: Vector) -> float:
    """Of a point to a line segment, m."""
    along = end - start
    share = float(np.clip((point - start) @ along / max(float(along @ along), 1e-12), 0.0, 1.0))
    return float(np.linalg.norm(point - start - share * along))
