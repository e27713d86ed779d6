"""The way of a leg from one key pose to the next: standing, leaving the floor, swinging, arriving.

A leg that stands before and after on the same place stays, and rises or bends by degrees. One that
leaves first gives up its weight, then swings. One that arrives swings first and takes weight then.
The ballet rules hold the rest: foot above the floor, legs clear of each other.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from math import radians

import mujoco
import numpy as np
from numpy.typing import NDArray

from enpointe.models.foot_positions import Footprint
from enpointe.models.keypose import KeyPose
from enpointe.models.leg_target import (
    DEMI_POINTE_DEG,
    FOOT_JOINTS,
    LEG_JOINTS,
    POINTED_DEG,
    LegTarget,
    OnPointe,
    Passing,
    Standing,
)
from enpointe.motion.clock import Clock
from enpointe.motion.leg_swing import LegSwing, leg_angles
from enpointe.notation import Side

__all__ = ["LegPath"]

Vector = NDArray[np.float64]
STRETCH = 0.4
"""Share of a flight in which a foot stretches, or gives itself up to the floor again."""
ROLL_DEG = 35.0
"""How far the heel is raised from the floor as a foot steps off it or on to it: a dancer's foot
rolls through, by toes, ball and heel."""


EVEN = Clock()


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
        slides: Shares of the passage between which a foot that stays is moved to its new place.
        yields: Whether heel and knee of a standing leg give way to a passing weight.
        steps: Whether the weight goes with a step or a slide, falling from foot to foot, so that
            feet roll off and on; otherwise it is over the feet at every moment.
        clock: Of the passage: a foot that steps is timed by the floor under it, not by the quality
            of the movement.
        knots: Shares of the passage and poses that are solved already: between them heel and knee
            of a leg that yields go by degrees.
    """

    model: mujoco.MjModel
    side: Side
    start: KeyPose
    end: KeyPose
    leaves_at: float = 0.0
    arrives_at: float = 1.0
    lift: KeyPose | None = None
    touch: KeyPose | None = None
    slides: tuple[float, float] = (0.0, 1.0)
    yields: bool = False
    steps: bool = False
    clock: Clock = EVEN
    knots: tuple[tuple[float, KeyPose], ...] = ()

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
        low, high = self._window
        begin, end = self.clock.moment(low), self.clock.moment(high)
        return float(np.clip((self.clock.moment(share) - begin) / (end - begin), 0.0, 1.0))

    @property
    def _window(self) -> tuple[float, float]:
        """Shares of the passage between which the leg swings."""
        return self.leaves_at if self.leaves else 0.0, self.arrives_at if self.arrives else 1.0

    def _meanwhile(self, swing: float) -> float:
        """How far the rest of the body is between the two ends of the swing."""
        low, high = self._window
        begin, end = self.clock.moment(low), self.clock.moment(high)
        share = self.clock.share(begin + swing * (end - begin))
        return (share - low) / (high - low)

    def at(self, share: float, *, aloft: bool = False) -> LegTarget:
        """What the leg is asked at `share` of the passage, on the floor or `aloft`."""
        if aloft:
            return self._aloft(share)
        return self.contact(share) or Passing(self._swing.at(self.swing(share)))

    def contact(self, share: float) -> Standing | OnPointe | None:
        """How the foot stands at `share` of a passage on the floor; None where it does not."""
        if self.stays:
            return self._standing(share)
        if self.leaves and share <= self.leaves_at:
            return self.leaving(share)
        if self.arrives and share >= self.arrives_at:
            return self.arriving(share)
        return None

    def leaving(self, share: float) -> Standing | OnPointe:
        """The stance before, turned about its ball as far as the body has turned by then."""
        return self._pivoted(self.before, share, share)

    def arriving(self, share: float) -> Standing | OnPointe:
        """The stance after, turned about its ball by what the body has still to turn."""
        return self._pivoted(self.after, share, share - 1.0)

    @property
    def travels(self) -> float:
        """How far the ball of a foot that stays is moved, m."""
        before, after = _print(self.before), _print(self.after)
        if before is None or after is None:
            return 0.0
        ball = self.start.target.figure.ball_forward
        return float(np.linalg.norm(after.point(ball) - before.point(ball)))

    def _pivoted(self, leg: LegTarget, share: float, turned: float) -> Standing | OnPointe:
        if isinstance(leg, Standing) and self.yields:
            rise, bend = self._yielding(share, leg.rise, leg.knee_bend)
            leg = replace(leg, yields=True, rise=rise, knee_bend=bend)
        turn = turned * (self.end.target.facing - self.start.target.facing)
        assert isinstance(leg, Standing | OnPointe)
        if turn == 0.0:
            return leg
        ball = self.start.target.figure.ball_forward
        pivot = leg.footprint.point(ball)
        foot = Footprint(pivot, leg.footprint.direction + turn)
        return replace(leg, footprint=Footprint(foot.point(-ball), foot.direction))

    def _standing(self, share: float) -> Standing | OnPointe:
        footprint = _print(self.before)
        turned = _print(self.after)
        assert footprint is not None and turned is not None
        low, high = self.slides
        moved = float(np.clip((share - low) / (high - low), 0.0, 1.0))
        direction = (1 - share) * footprint.direction + share * turned.direction
        ball = self.start.target.figure.ball_forward
        pivot = (1 - moved) * footprint.point(ball) + moved * turned.point(ball)
        foot = Footprint(pivot, direction)
        place = Footprint(foot.point(-ball), direction)
        if isinstance(self.before, OnPointe) and isinstance(self.after, OnPointe):
            bend = (1 - share) * self.before.knee_bend + share * self.after.knee_bend
            return OnPointe(place, bend)
        rise = (1 - share) * _rise(self.before) + share * _rise(self.after)
        bend = (1 - share) * _bend(self.before) + share * _bend(self.after)
        if self.yields:
            rise, bend = self._yielding(share, rise, bend)
        return Standing(place, rise, bend, self.yields)

    def _yielding(self, share: float, rise: float, bend: float) -> tuple[float, float]:
        """Rise and bend (rad) wished of a leg that yields: between the knots by degrees."""
        knots = [(at, pose) for at, pose in self.knots if self._stands(at)]
        if len(knots) < 2:
            rolls = 0.0 < share < 1.0 and self.steps
            return (max(rise, radians(ROLL_DEG)) if rolls else rise), bend
        shares = [at for at, _ in knots]
        angles = np.array([leg_angles(self.model, pose.qpos, self.side) for _, pose in knots])
        knee, toe = LEG_JOINTS.index("knee_bend"), LEG_JOINTS.index("toe_raise")
        return (
            max(float(np.interp(share, shares, angles[:, toe])), 0.0),
            max(float(np.interp(share, shares, angles[:, knee])), 0.0),
        )

    def _stands(self, share: float) -> bool:
        if self.leaves:
            return share <= self.leaves_at
        return self.stays or (self.arrives and share >= self.arrives_at)

    @cached_property
    def _swing(self) -> LegSwing:
        start, end = self.lift or self.start, self.touch or self.end
        return LegSwing(self.model, self.side, start.qpos, end.qpos, body=self._meanwhile)

    def _aloft(self, share: float) -> Passing:
        """A leg in a flight: its foot stretches on the way up, and is given up on the way down.

        In a flight from floor to floor without a pose between it stretches and is given up again.
        """
        angles = self._flight.at(share)
        foot = angles[-len(FOOT_JOINTS) :]
        ends = [leg_angles(self.model, pose.qpos, self.side) for pose in (self.start, self.end)]
        if not any(_pointed(end) for end in ends):
            far = min(share, 1.0 - share) / STRETCH
            foot += min(far, 1.0) * (np.radians(POINTED_DEG) - foot)
        return Passing(angles)

    @cached_property
    def _flight(self) -> LegSwing:
        return LegSwing(self.model, self.side, self.start.qpos, self.end.qpos, floor=False)


def _pointed(angles: Vector) -> bool:
    foot = angles[-len(FOOT_JOINTS) :]
    return bool(np.abs(foot - np.radians(POINTED_DEG)).max() < radians(5.0))


def _print(leg: LegTarget) -> Footprint | None:
    return leg.footprint if isinstance(leg, Standing | OnPointe) else None


def _rise(leg: LegTarget) -> float:
    if isinstance(leg, Standing):
        return leg.rise
    return radians(DEMI_POINTE_DEG + 18.0)


def _bend(leg: LegTarget) -> float:
    assert isinstance(leg, Standing | OnPointe)
    return leg.knee_bend
