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
_HIGH_DEG = 50.0
"""A thigh this far from hanging is one that the pelvis gives way to: the hip alone takes a leg
behind to 40 degrees (`rules.hip`)."""
_SQUARE_DEG = 6.0
"""Pelvis and chest that face the same way within this need no decision which of them to believe, as
long as neither gives way to a high leg."""
_ARCHED_DEG = 40.0
"""A waist bent back by more than this has no more to give: the hinge of ours ends at 45 degrees."""
_BACK_LENDS_DEG = 30.0
"""How far the back then comes forward under a leg behind (`rules.stance.BodyLent`)."""


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
        body: Of the torso against the pelvis; against the upright where the pelvis is `lent`, and
            erect but for a turn where the back is lent too.
        pelvis: Of the pelvis against the upright.
        facing_degrees: Where the dancer faces, from the audience, + to her left, -180 to 180.
        lent: Whether a leg works, so that what the pelvis gives way is the leg's and not written;
            nor is what the back comes forward once the waist is bent back as far as it goes.
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
            body=_body(joints, upright if lent else None),
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


def _body(joints: Joints, upright: Vector | None) -> Orientation:
    """The torso as a score means it: against the pelvis, or against the upright of a lent one."""
    waist = orientation(joints.pelvis.T @ joints.torso)
    if upright is None:
        return waist
    body = orientation(upright.T @ joints.torso)
    if waist.bend < -_ARCHED_DEG and 0.0 < body.bend < _BACK_LENDS_DEG:
        return Orientation(turn=body.turn)
    return body


def _facing(joints: Joints, feet: Mapping[Side, Footing]) -> float:
    """Where the dancer faces, rad.

    The pelvis says it where both feet bear. A dancer opens the pelvis for a high leg and keeps the
    chest, which is then believed; another one turns the chest over a square pelvis. Where the two
    disagree with a leg that is not high, what agrees with the foot that she stands on is believed.
    """
    pelvis = radians(orientation(joints.pelvis).turn)
    torso = radians(orientation(joints.torso).turn)
    bearing = [side for side in Side if feet[side].bears]
    if len(bearing) != 1:
        return pelvis
    (side,) = bearing
    thigh = joints.between(f"{side.other}_hip", f"{side.other}_knee")
    if -thigh[2] < np.cos(np.radians(_HIGH_DEG)):
        return torso
    if abs(shorter_way(degrees(torso - pelvis))) < _SQUARE_DEG:
        return pelvis
    foot = joints[f"{side}_ball"] - joints[f"{side}_ankle"]
    outward = DEFAULT_TURNOUT_DEG if side is Side.LEFT else -DEFAULT_TURNOUT_DEG
    from_foot = degrees(float(np.arctan2(foot[1], foot[0]))) - outward

    def disagreement(heading: float) -> float:
        return abs(shorter_way(degrees(heading) - from_foot))

    return min((pelvis, torso), key=disagreement)
