"""The way of a wrist between two key poses, as the rules of ballet and Laban's space draw it.

Neagle 2005 §5.2.1, §5.4.4.5, §5.5.3. A path is measured in the torso's frame about the shoulder:

* between two low, narrow places in front of the body the arm goes up or down through the front: the
  wrist keeps its distance from the centre line (linear from one place to the next) and swings
  about the shoulder in the sagittal plane. The hands so stay a face's width apart on the way
  (§5.6.2), which the shortest rotation breaks;
* otherwise it takes the shortest way, an arc of a great circle about the shoulder (§5.2.1).

The reach l(k) then departs from the rounded arm's r by Laban's space S in [0, 1]:

* upwards in front, drawn in: l = r - (1 - S) (0.1 r) sin(k pi / (n - 1))              (eq. 5.5)
* any other way, let out:    l = r + (1 - S) (L - r) sin(k pi / (n - 1))               (eq. 5.6)

Eq. 5.6 is printed without its sine and would jump at the key poses; the text (§5.4.4.5) has the
reach longest half-way and back to r at both ends, so the sine of eq. 5.5 stands here. L is the
reach of an elbow that is not quite straight, as the same paragraph demands.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from math import acos, atan2, cos, pi, radians, sin, sqrt

import numpy as np
from numpy.typing import NDArray

from enpointe.models.extremities import elbow_of_rounded_arm
from enpointe.models.figure import Figure
from enpointe.models.target import ArmShape, ArmTarget
from enpointe.notation import Side

__all__ = ["LET_OUT_ELBOW_DEG", "ArmPath"]

Vector = NDArray[np.float64]
DRAWN_IN = 0.1
"""Most that an indirect path draws the reach in, as a share of it (eq. 5.5)."""
LET_OUT_ELBOW_DEG = 8.0
"""Bend left in the elbow where an indirect path lets the arm out most: it does not straighten."""
_STILL = 0.02
"""Places nearer than this (m) are one place: the arm waits."""
_NARROW = 0.30
"""A wrist is in front of the body when it is nearer to the centre line than this (m)."""
_PARAMETERS = np.linspace(0.0, 1.0, 241)


@dataclass(frozen=True)
class ArmPath:
    """One arm's way between two key poses.

    Attributes:
        figure: The dancer's lengths.
        side: Whose arm.
        start: Where the key pose before has the arm.
        end: Where the next one has it.
        space: Laban's space, 1 direct to 0 indirect.
    """

    figure: Figure
    side: Side
    start: ArmTarget
    end: ArmTarget
    space: float

    @cached_property
    def _walked(self) -> Vector:
        """Length of the way up to each of `_PARAMETERS`, m."""
        points = np.array([self.wrist(k) for k in _PARAMETERS])
        steps = np.linalg.norm(np.diff(points, axis=0), axis=1)
        return np.concatenate([[0.0], np.cumsum(steps)])

    @property
    def length(self) -> float:
        """m."""
        return float(self._walked[-1])

    @property
    def waits(self) -> bool:
        """Whether the arm stays where it is."""
        return float(np.linalg.norm(self.end.wrist - self.start.wrist)) < _STILL

    @property
    def through_front(self) -> bool:
        """Whether the wrist swings in front of the body rather than by the shortest arc."""
        return all(
            abs(float(arm.wrist[1])) < _NARROW and arm.wrist[0] > arm.shoulder[0]
            for arm in (self.start, self.end)
        )

    @property
    def drawn_in(self) -> bool:
        """Whether the way is upwards in front, where an indirect path comes nearer to the body."""
        return self.through_front and bool(self.end.wrist[2] > self.start.wrist[2])

    def at_share(self, share: float) -> float:
        """The path parameter where the wrist has gone `share` of the way's length."""
        walked, length = self._walked, self.length
        shares = walked / length if length > 0 else _PARAMETERS
        return float(np.interp(share, shares, _PARAMETERS))

    def wrist(self, k: float) -> Vector:
        """The wrist (3,) at the parameter `k` in [0, 1], in the torso's frame, m."""
        if self.waits:
            return (1 - k) * self.start.wrist + k * self.end.wrist
        return self.start.shoulder + self._reach(k) * self._direction(k)

    def target(self, k: float) -> ArmTarget:
        """The arm at `k`, its hand following the curve; no inflection yet."""
        wrist = self.wrist(k)
        blend = {
            name: (1 - k) * getattr(self.start, name) + k * getattr(self.end, name)
            for name in ("wrist_bend", "wrist_cross", "forearm_turn")
        }
        arm = ArmTarget(self.shape, self.start.shoulder, wrist, self._elbow(k, wrist), **blend)
        if self.shape is not ArmShape.ROUNDED:
            return arm
        # An arm drawn in curves more at the elbow; a hand that curved on as well would cross over.
        at_rest = (1 - k) * self.start.elbow_bend + k * self.end.elbow_bend
        return replace(arm, wrist_bend=arm.wrist_bend - max(arm.elbow_bend - at_rest, 0.0))

    def _elbow(self, k: float, wrist: Vector) -> Vector:
        if self.shape is ArmShape.ROUNDED:
            return elbow_of_rounded_arm(self.figure, self.side, wrist)
        elbow = (1 - k) * self.start.elbow + k * self.end.elbow
        if self.shape is ArmShape.STRAIGHT:
            return np.asarray(elbow)
        bone = elbow - self.start.shoulder
        reach = self.figure.upper_arm / np.linalg.norm(bone)
        return np.asarray(self.start.shoulder + reach * bone)

    def heading(self, k: float, step: float = 0.02) -> Vector:
        """Unit direction of the wrist's movement at `k`, (3,); zero for an arm that waits."""
        if self.waits:
            return np.zeros(3)
        low, high = max(k - step, 0.0), min(k + step, 1.0)
        way = self.wrist(high) - self.wrist(low)
        return np.asarray(way / np.linalg.norm(way))

    def _reach(self, k: float) -> float:
        first, last = (
            float(np.linalg.norm(arm.wrist - arm.shoulder)) for arm in (self.start, self.end)
        )
        rounded = (1 - k) * first + k * last
        stray = (1.0 - self.space) * sin(pi * k)
        if self.drawn_in:
            return rounded - stray * DRAWN_IN * rounded
        longest = max(self.figure.arm_reach(radians(LET_OUT_ELBOW_DEG)), rounded)
        return rounded + stray * (longest - rounded)

    def _direction(self, k: float) -> Vector:
        if self.through_front:
            return self._front_direction(k)
        first, last = self.start.wrist - self.start.shoulder, self.end.wrist - self.end.shoulder
        first, last = first / np.linalg.norm(first), last / np.linalg.norm(last)
        angle = acos(float(np.clip(first @ last, -1.0, 1.0)))
        if angle < 1e-6:
            return np.asarray(last)
        return np.asarray((sin((1 - k) * angle) * first + sin(k * angle) * last) / sin(angle))

    def _front_direction(self, k: float) -> Vector:
        first, last = self.start.wrist - self.start.shoulder, self.end.wrist - self.end.shoulder
        angle = (1 - k) * atan2(first[2], first[0]) + k * atan2(last[2], last[0])
        reach = self._reach(k)
        aside = ((1 - k) * first[1] + k * last[1]) / reach
        forward = sqrt(max(1.0 - aside**2, 0.0))
        return np.array([forward * cos(angle), aside, forward * sin(angle)])

    @property
    def shape(self) -> ArmShape:
        """How the arm is shaped on the way: as the key pose it goes to, but rounded where a rounded
        arm stretches or a stretched one rounds."""
        shapes = {self.start.shape, self.end.shape}
        return (
            ArmShape.ROUNDED if shapes == {ArmShape.ROUNDED, ArmShape.STRAIGHT} else self.end.shape
        )
