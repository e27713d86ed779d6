"""The way of a leg from one key pose to the next: standing, leaving the floor, swinging, arriving.

A leg that stands before and after on the same place stays, and rises or bends by degrees. One that
leaves first gives up its weight, then swings: thigh and shank each take the shortest arc, so that a
straight leg stays straight and a developpe unfolds. One that arrives swings first and takes weight
then. The ballet rules hold the rest: foot above the floor, pointed as soon as it can, turned out.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import acos, radians, sin

import mujoco
import numpy as np
from numpy.typing import NDArray

from enpointe.models.foot_positions import Footprint
from enpointe.models.keypose import KeyPose
from enpointe.models.leg_target import (
    DEMI_POINTE_DEG,
    FOOT_JOINTS,
    POINTED_DEG,
    InAir,
    LegTarget,
    OnPointe,
    Standing,
)
from enpointe.notation import Side

__all__ = ["STEP", "LegPath"]

Vector = NDArray[np.float64]
POINTED_ABOVE = 0.10
"""How much higher than a standing one an ankle must be for a foot to be fully pointed under it, m:
in a tendu it is about so high."""
STRETCH = 0.4
"""Share of a flight in which a foot stretches, or gives itself up to the floor again."""
WEIGHT_SHIFT = 0.25
"""Share of a passage in which weight moves before a foot leaves, or after it arrives."""
STEP = (0.4, 0.6)
"""Shares of a step, from one foot to the other, at which the one arrives and the other leaves."""


@dataclass(frozen=True)
class LegPath:
    """One leg's way between two key poses.

    Attributes:
        model: The dancer.
        side: Whose leg.
        start: The key pose before.
        end: The next.
        leaves_at: Share of the passage at which a foot that leaves is off the floor.
        arrives_at: Share at which a foot that arrives is on it.
        lift: The pose at the moment the foot leaves: still on the floor, the weight gone from it.
        touch: The pose at the moment it arrives: on the floor, the weight not yet on it.
    """

    model: mujoco.MjModel
    side: Side
    start: KeyPose
    end: KeyPose
    leaves_at: float = WEIGHT_SHIFT
    arrives_at: float = 1.0 - WEIGHT_SHIFT
    lift: KeyPose | None = None
    touch: KeyPose | None = None

    @property
    def before(self) -> LegTarget:
        return self.start.target.legs[self.side]

    @property
    def after(self) -> LegTarget:
        return self.end.target.legs[self.side]

    @property
    def stays(self) -> bool:
        """Whether the foot bears weight all the way: on one place, or sliding to another."""
        return _print(self.before) is not None and _print(self.after) is not None

    @property
    def leaves(self) -> bool:
        return _print(self.before) is not None and not self.stays

    @property
    def arrives(self) -> bool:
        return _print(self.after) is not None and not self.stays

    def swing(self, share: float) -> float:
        """How far the swing is at `share` of the passage: 0 still standing, 1 arrived."""
        low = self.leaves_at if self.leaves else 0.0
        high = self.arrives_at if self.arrives else 1.0
        return float(np.clip((share - low) / (high - low), 0.0, 1.0))

    def at(self, share: float, *, aloft: bool = False) -> LegTarget:
        """What the leg is asked at `share` of the passage, on the floor or `aloft`."""
        if aloft:
            return self._swinging(share, aloft=True)
        if self.stays:
            return self._standing(share)
        swing = self.swing(share)
        if swing <= 0.0 and self.leaves:
            return self.leaving(share)
        if swing >= 1.0 and self.arrives:
            return self.arriving(share)
        return self._swinging(swing)

    def leaving(self, share: float) -> LegTarget:
        """The stance before, turned about its ball as far as the body has turned by then."""
        return self._pivoted(self.before, share)

    def arriving(self, share: float) -> LegTarget:
        """The stance after, turned about its ball by what the body has still to turn."""
        return self._pivoted(self.after, share - 1.0)

    def _pivoted(self, leg: LegTarget, share: float) -> LegTarget:
        footprint = _print(leg)
        turn = share * (self.end.target.facing - self.start.target.facing)
        if footprint is None or turn == 0.0:
            return leg
        ball = self.start.target.figure.ball_forward
        pivot = footprint.point(ball)
        foot = Footprint(pivot, footprint.direction + turn)
        assert isinstance(leg, Standing | OnPointe)
        return replace(leg, footprint=Footprint(foot.point(-ball), foot.direction))

    def _standing(self, share: float) -> LegTarget:
        footprint = _print(self.before)
        turned = _print(self.after)
        assert footprint is not None and turned is not None
        direction = (1 - share) * footprint.direction + share * turned.direction
        ball = self.start.target.figure.ball_forward
        pivot = (1 - share) * footprint.point(ball) + share * turned.point(ball)
        foot = Footprint(pivot, direction)
        place = Footprint(foot.point(-ball), direction)
        if isinstance(self.before, OnPointe) and isinstance(self.after, OnPointe):
            bend = (1 - share) * self.before.knee_bend + share * self.after.knee_bend
            return OnPointe(place, bend)
        rise = (1 - share) * _rise(self.before) + share * _rise(self.after)
        bend = (1 - share) * _bend(self.before) + share * _bend(self.after)
        return Standing(place, rise, bend)

    def _swinging(self, swing: float, *, aloft: bool = False) -> InAir:
        thigh0, shank0 = _directions(self.model, self.lift or self.start, self.side)
        thigh1, shank1 = _directions(self.model, self.touch or self.end, self.side)
        figure = self.start.target.figure
        hip = figure.hips[self.side]
        knee = hip + figure.thigh * _arc(thigh0, thigh1, swing)
        ankle = knee + figure.shank * _arc(shank0, shank1, swing)
        turnout = getattr(self.after, "turnout", getattr(self.before, "turnout", radians(60.0)))
        foot = self._foot_aloft(swing) if aloft else self._foot(swing, float(ankle[2]))
        return InAir(ankle, knee, turnout, foot=foot)

    def _foot_aloft(self, share: float) -> Vector:
        """Angles of the foot in a flight: soon stretched, and given up before landing."""
        joints = [self.model.joint(f"{self.side}_{j}").qposadr[0] for j in FOOT_JOINTS]
        pose, far = (self.start, share) if share < 0.5 else (self.end, 1.0 - share)
        own = pose.qpos[joints]
        return np.asarray(own + min(far / STRETCH, 1.0) * (np.radians(POINTED_DEG) - own))

    def _foot(self, swing: float, ankle: float) -> Vector:
        """Angles of the foot: flat where the ankle is as low as a standing one's, pointed above.

        Args:
            swing: How far the swing is.
            ankle: Height of the ankle against the hips, m.
        """
        first, last = self.lift or self.start, self.touch or self.end
        hips = (1 - swing) * first.qpos[2] + swing * last.qpos[2]
        lifted = (hips + ankle - self.start.target.figure.ankle_height) / POINTED_ABOVE
        contact = self.lift if swing < 0.5 or self.touch is None else self.touch
        flat = np.zeros(len(FOOT_JOINTS))
        if contact is not None:
            joints = [self.model.joint(f"{self.side}_{j}").qposadr[0] for j in FOOT_JOINTS]
            flat = contact.qpos[joints]
        return np.asarray(
            flat + float(np.clip(lifted, 0.0, 1.0)) * (np.radians(POINTED_DEG) - flat)
        )


def _print(leg: LegTarget) -> Footprint | None:
    return leg.footprint if isinstance(leg, Standing | OnPointe) else None


def _rise(leg: LegTarget) -> float:
    if isinstance(leg, Standing):
        return leg.rise
    return radians(DEMI_POINTE_DEG + 18.0)


def _bend(leg: LegTarget) -> float:
    assert isinstance(leg, Standing | OnPointe)
    return leg.knee_bend


def _directions(model: mujoco.MjModel, pose: KeyPose, side: Side) -> tuple[Vector, Vector]:
    """Unit directions of thigh and shank of a solved pose, in the pelvis' frame as written."""
    data = mujoco.MjData(model)
    data.qpos[:] = pose.qpos
    mujoco.mj_kinematics(model, data)
    upright = pose.target.upright
    hip, knee, ankle = (data.site(f"{side}_{s}").xpos for s in ("hip", "knee", "ankle"))
    thigh, shank = upright.T @ (knee - hip), upright.T @ (ankle - knee)
    return thigh / np.linalg.norm(thigh), shank / np.linalg.norm(shank)


def _arc(first: Vector, last: Vector, share: float) -> Vector:
    angle = acos(float(np.clip(first @ last, -1.0, 1.0)))
    if angle < 1e-6:
        return last
    return np.asarray((sin((1 - share) * angle) * first + sin(share * angle) * last) / sin(angle))
