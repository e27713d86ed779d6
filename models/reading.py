"""From a configuration back to the signs of the stave: the inverse of what a score means.

A wrist or ankle becomes its width, height and depth by eqs 4.1 to 4.3 turned round, with the
dancer's own lengths, in the frames that the signs are read in: arms from the torso, legs from the
hip in the upright that faces where the dancer does.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from math import degrees, radians

import mujoco
import numpy as np
from numpy.typing import ArrayLike, NDArray

from enpointe.models.anatomy import side_sign
from enpointe.models.extremities import elbow_of_rounded_arm
from enpointe.models.figure import ROUNDED_ELBOW_DEG, STRETCHED_DEG, Figure
from enpointe.models.foot_positions import (
    TURNOUT_RANGE_DEG,
    Footprint,
    footprints,
)
from enpointe.models.footing import footprint_of
from enpointe.models.joints import Joints, angle_between
from enpointe.models.limbs import LimbDirections
from enpointe.notation import (
    Depth,
    FeetPosition,
    FloorContact,
    Orientation,
    Side,
    Sign,
    Support,
)
from enpointe.notation.vocabulary_feet import FEET

__all__ = ["FeetDistance", "ReadFrame", "ReadLeg", "distances_to_feet", "read_joints", "read_signs"]

Vector = NDArray[np.float64]
LEVEL = 0.06
"""A point no farther before or behind its joint than this share of the limb is level with it."""
STRAIGHT_ARM_DEG = 0.5 * (ROUNDED_ELBOW_DEG + STRETCHED_DEG)
"""An elbow bent less than this is stretched: halfway to the rounded arm's bend."""
_ROUNDED_WITHIN_DEG = 15.0
_SLOPE_WITHIN = 0.15
"""A rounded elbow may be off its slope by this share of the upper arm before it has a sign."""
_BENT_KNEE_DEG = 20.0
"""A working knee bent by more than this has a sign."""


@dataclass(frozen=True, slots=True)
class ReadLeg:
    """One leg as signs.

    Attributes:
        foot: The ankle's sign; at height 1 for a foot on the floor.
        knee: The knee's sign; None for a straight one, and for one that stands (see `support`).
        support: How the foot meets the floor and its knee is bent; None in the air.
    """

    foot: Sign
    knee: Sign | None
    support: Support | None


@dataclass(frozen=True, slots=True)
class FeetDistance:
    """How far two feet are from a position.

    Attributes:
        position: One of the five, closed or open.
        metres: Between where the feet are to each other and where the position has them.
    """

    position: FeetPosition
    metres: float


@dataclass(frozen=True)
class ReadFrame:
    """A pose as signs, raw: nothing of the vocabulary but the five positions of the feet.

    Attributes:
        hands: The wrist's sign of each arm, with whether it is straight.
        elbows: The elbow's sign of each arm that is neither straight nor rounded as ballet rounds
            it; the wrist's depth is then seen from the elbow.
        legs: Each leg.
        head: Against the body.
        body: Against the pelvis as written.
        pelvis: Against the upright; erect where a leg works, whatever the leg borrows of it.
        facing_degrees: From the audience, + to the left.
        feet: The position of the feet and how far they are from it; None unless both bear.
        limbs: What all this was read from.
    """

    hands: Mapping[Side, Sign]
    elbows: Mapping[Side, Sign]
    legs: Mapping[Side, ReadLeg]
    head: Orientation
    body: Orientation
    pelvis: Orientation
    facing_degrees: float
    feet: FeetDistance | None
    limbs: LimbDirections


def read_signs(model: mujoco.MjModel, qpos: ArrayLike, figure: Figure | None = None) -> ReadFrame:
    """Read one configuration.

    Args:
        model: The dancer.
        qpos: (nq,); any, legal or not.
        figure: Of the model, if it is at hand.

    Raises:
        PoseError: A configuration of another size, or one that is not finite.
    """
    return read_joints(Joints.of(model, qpos), figure or Figure.of(model))


def read_joints(joints: Joints, figure: Figure) -> ReadFrame:
    """Read any dancer's joints as the signs of a dancer with the lengths of `figure`."""
    limbs = LimbDirections.from_joints(joints)
    hands: dict[Side, Sign] = {}
    elbows: dict[Side, Sign] = {}
    for side in Side:
        hands[side], elbow = _arm(limbs, side, figure)
        if elbow is not None:
            elbows[side] = elbow
    distances = distances_to_feet(joints, limbs, figure)
    return ReadFrame(
        hands=hands,
        elbows=elbows,
        legs={side: _leg(limbs, side, figure) for side in Side},
        head=limbs.head,
        body=limbs.body,
        pelvis=Orientation() if limbs.lent else limbs.pelvis,
        facing_degrees=limbs.facing_degrees,
        feet=distances[0] if distances else None,
        limbs=limbs,
    )


def distances_to_feet(
    joints: Joints, limbs: LimbDirections, figure: Figure
) -> tuple[FeetDistance, ...]:
    """How far the feet are from each of the five positions, nearest first.

    Compared is the vector between the two ankles, with the feet drawn flat and turned out as they
    are: that is what the thesis distinguishes the positions by (Neagle 2005 §4.4.6).

    Returns:
        Empty unless both feet bear weight.
    """
    if len(limbs.bearing) < 2:
        return ()
    prints: dict[Side, Footprint] = {}
    for side in Side:
        contact = limbs.feet[side].floor
        assert contact is not None
        prints[side] = footprint_of(joints, side, contact, figure)
    facing = radians(limbs.facing_degrees)
    turnout = _turnout(prints, facing)
    forward = np.array([np.cos(facing), np.sin(facing)])
    leftward = np.array([-np.sin(facing), np.cos(facing)])
    between = prints[Side.LEFT].ankle - prints[Side.RIGHT].ankle
    found = np.array([forward @ between, leftward @ between])
    distances = []
    for position in _feet_positions():
        wanted = footprints(figure, position, turnout)
        apart = wanted[Side.LEFT].ankle - wanted[Side.RIGHT].ankle
        distances.append(FeetDistance(position, float(np.linalg.norm(found - apart))))
    return tuple(sorted(distances, key=lambda each: each.metres))


def _feet_positions() -> list[FeetPosition]:
    positions = []
    for entry in FEET:
        for front in Side if entry.crossed else (None,):
            positions.append(FeetPosition(entry.name, front))
            if entry.has_open:
                positions.append(FeetPosition(entry.name, front, True))
    return positions


def _turnout(prints: Mapping[Side, Footprint], facing: float) -> float:
    """Of both feet together, degrees, within what `footprints` draws."""
    spread = degrees(prints[Side.LEFT].direction - prints[Side.RIGHT].direction)
    low, high = TURNOUT_RANGE_DEG
    return min(max(0.5 * ((spread + 180.0) % 360.0 - 180.0), low), high)


def _arm(limbs: LimbDirections, side: Side, figure: Figure) -> tuple[Sign, Sign | None]:
    shoulder = figure.shoulders[side]
    elbow = shoulder + figure.upper_arm * limbs.upper_arm[side]
    wrist = elbow + figure.forearm * limbs.forearm[side]
    bend = angle_between(limbs.upper_arm[side], limbs.forearm[side])
    sign = _sign(wrist, shoulder, side, figure, leg=False)
    if bend < STRAIGHT_ARM_DEG:
        return replace(sign, straight=True), None
    off_slope = np.linalg.norm(elbow - elbow_of_rounded_arm(figure, side, wrist))
    amount = abs(bend - ROUNDED_ELBOW_DEG)
    if amount < _ROUNDED_WITHIN_DEG and off_slope < _SLOPE_WITHIN * figure.upper_arm:
        return sign, None
    return (
        _sign(wrist, elbow, side, figure, leg=False),
        _sign(elbow, shoulder, side, figure, leg=False),
    )


def _leg(limbs: LimbDirections, side: Side, figure: Figure) -> ReadLeg:
    foot = limbs.feet[side]
    hip = figure.hips[side]
    knee = hip + figure.thigh * limbs.thigh[side]
    ankle = knee + figure.shank * limbs.shank[side]
    bend = angle_between(limbs.thigh[side], limbs.shank[side])
    support = None if foot.floor is None else Support(foot.floor, foot.bend)
    if foot.bears:
        return ReadLeg(
            replace(_sign(ankle, hip, side, figure, leg=True), height=1.0), None, support
        )
    if foot.floor is FloorContact.TOUCH:
        touching = Support(FloorContact.TOUCH)
        return ReadLeg(
            replace(_sign(ankle, hip, side, figure, leg=True), height=1.0), None, touching
        )
    if bend < _BENT_KNEE_DEG:
        return ReadLeg(_sign(ankle, hip, side, figure, leg=True), None, None)
    return ReadLeg(
        _sign(ankle, knee, side, figure, leg=True),
        _sign(knee, hip, side, figure, leg=True),
        None,
    )


def _sign(point: Vector, root: Vector, side: Side, figure: Figure, *, leg: bool) -> Sign:
    """The sign of a point in the girdle's frame, its depth seen from `root`."""
    origin = figure.pelvis_origin if leg else figure.torso_origin
    outward = side_sign(side)
    ahead = float(point[0] - root[0])
    level = LEVEL * float(np.linalg.norm(point - root))
    depth = Depth.LEVEL if abs(ahead) < level else Depth.FRONT if ahead > 0 else Depth.BEHIND
    width = outward * float(point[1]) / figure.full_width(leg=leg)
    height = figure.line(float(point[2] + origin[2]), leg=leg)
    return Sign(width, height, depth)
