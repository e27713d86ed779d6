"""Which way the limbs point: a pose without anybody's proportions."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from math import degrees, radians

import mujoco
import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.spatial.transform import Rotation

from enpointe.models.foot_positions import DEFAULT_TURNOUT_DEG
from enpointe.models.footing import Footing, footing
from enpointe.models.joints import Joints
from enpointe.notation import Orientation, Side
from enpointe.notation.stage import shorter_way

__all__ = ["LimbDirections", "orientation"]

Vector = NDArray[np.float64]
_HIGH = 0.25
"""A toe this high, m, is one that the pelvis gives way to: the hip alone takes a leg behind to some
40 degrees (`rules.hip`), which is where this is."""
_SQUARE_DEG = 6.0
"""Pelvis and chest that face the same way within this need no decision which of them to believe."""


@dataclass(frozen=True)
class LimbDirections:
    """The directions of one pose, as notation takes them; all unit vectors (3,).

    Attributes:
        upper_arm: By side, in the torso's frame.
        forearm: By side, in the torso's frame.
        thigh: By side, in the frame that stands upright and faces where the dancer does.
        shank: The same.
        foot: The same, from the heel to the ball.
        head: Of the head against the torso.
        body: Of the torso against the pelvis; against the upright where the pelvis is `lent`.
        pelvis: Of the pelvis against the upright.
        facing_degrees: Where the dancer faces, from the audience, + to her left, -180 to 180.
        lent: Whether a leg works, so that what the pelvis gives way is the leg's and not written.
        feet: How each foot meets the floor.
    """

    upper_arm: Mapping[Side, Vector]
    forearm: Mapping[Side, Vector]
    thigh: Mapping[Side, Vector]
    shank: Mapping[Side, Vector]
    foot: Mapping[Side, Vector]
    head: Orientation
    body: Orientation
    pelvis: Orientation
    facing_degrees: float
    lent: bool
    feet: Mapping[Side, Footing]

    @classmethod
    def of(cls, model: mujoco.MjModel, qpos: ArrayLike) -> LimbDirections:
        """The directions of one configuration (nq,) of a dancer.

        Raises:
            PoseError: A configuration of another size, or one that is not finite.
        """
        return cls.from_joints(Joints.of(model, qpos))

    @classmethod
    def from_joints(cls, joints: Joints) -> LimbDirections:
        """The directions between any dancer's joints."""
        feet = footing(joints)
        facing = _facing(joints, feet)
        upright = Rotation.from_euler("z", facing).as_matrix()
        lent = not all(foot.bears for foot in feet.values())
        girdle = upright if lent else joints.pelvis

        def limb(start: str, end: str, frame: Vector) -> dict[Side, Vector]:
            return {
                side: np.asarray(frame.T @ joints.between(f"{side}_{start}", f"{side}_{end}"))
                for side in Side
            }

        return cls(
            upper_arm=limb("shoulder", "elbow", joints.torso),
            forearm=limb("elbow", "wrist", joints.torso),
            thigh=limb("hip", "knee", upright),
            shank=limb("knee", "ankle", upright),
            foot=limb("heel", "ball", upright),
            head=orientation(joints.torso.T @ joints.head),
            body=orientation(girdle.T @ joints.torso),
            pelvis=orientation(upright.T @ joints.pelvis),
            facing_degrees=shorter_way(degrees(facing)),
            lent=lent,
            feet=feet,
        )

    @property
    def bearing(self) -> tuple[Side, ...]:
        """The feet that bear weight."""
        return tuple(side for side in Side if self.feet[side].bears)

    @property
    def working(self) -> Side | None:
        """The one leg that does not bear weight; None with both or neither on the floor."""
        return self.bearing[0].other if len(self.bearing) == 1 else None


def orientation(rotation: Vector) -> Orientation:
    """Turn, tilt and bend of a rotation (3, 3), in degrees, in that order (eq. 4.9)."""
    turn, tilt, bend = Rotation.from_matrix(rotation).as_euler("ZXY", degrees=True)
    return Orientation(float(turn), float(-tilt), float(bend))


def _facing(joints: Joints, feet: Mapping[Side, Footing]) -> float:
    """Where the dancer faces, rad.

    The pelvis says it where both feet bear. A dancer opens the pelvis for a high leg and keeps the
    chest; another one turns the chest over a square pelvis. Where the two disagree, the chest is
    believed with a leg in the air, and otherwise what agrees with the foot that she stands on.
    """
    pelvis = radians(orientation(joints.pelvis).turn)
    torso = radians(orientation(joints.torso).turn)
    bearing = [side for side in Side if feet[side].bears]
    if len(bearing) != 1 or abs(shorter_way(degrees(torso - pelvis))) < _SQUARE_DEG:
        return pelvis
    (side,) = bearing
    if feet[side.other].clearance > _HIGH:
        return torso
    foot = joints[f"{side}_ball"] - joints[f"{side}_ankle"]
    outward = DEFAULT_TURNOUT_DEG if side is Side.LEFT else -DEFAULT_TURNOUT_DEG
    from_foot = degrees(float(np.arctan2(foot[1], foot[0]))) - outward

    def disagreement(heading: float) -> float:
        return abs(shorter_way(degrees(heading) - from_foot))

    return min((pelvis, torso), key=disagreement)
