"""The trajectory that a servo makes of a goal: step, rectangle, triangle or trapezoid of velocity.

Source: e-manual, Profile Velocity(112), Profile Acceleration(108), Moving Status(123). A goal that
comes while another is pursued is taken on at the velocity of that moment (velocity override).
"""

from __future__ import annotations

import math
from enum import IntEnum

__all__ = ["Profile", "ProfileKind", "velocity_step"]


class ProfileKind(IntEnum):
    """As bits 4 and 5 of Moving Status(123) tell it."""

    STEP = 0x00
    RECTANGULAR = 0x10
    TRIANGULAR = 0x20
    TRAPEZOIDAL = 0x30


def velocity_step(present: float, wanted: float, acceleration: float, period: float) -> float:
    """The velocity after one period on the way to a wanted one; no limit if acceleration is 0."""
    if acceleration <= 0.0:
        return wanted
    change = acceleration * period
    return present + min(max(wanted - present, -change), change)


class Profile:
    """Desired position and velocity, in pulses and pulses/s.

    Attributes:
        position: Where the servo should be now.
        velocity: How fast it should move now.
        goal: Where it should come to.
        kind: Of the movement to the goal.
        ongoing: Whether the goal is still to be reached.
    """

    def __init__(self, position: float) -> None:
        self.position = position
        self.velocity = 0.0
        self.goal = position
        self.kind = ProfileKind.STEP
        self.ongoing = False
        self._speed = 0.0
        self._acceleration = 0.0

    def stop_at(self, position: float) -> None:
        """Be somewhere, at rest, with nothing left to do."""
        self.position = self.goal = position
        self.velocity = 0.0
        self.kind = ProfileKind.STEP
        self.ongoing = False

    def aim(self, goal: float, speed: float, acceleration: float) -> None:
        """Start towards a goal.

        Args:
            goal: pulses.
            speed: pulses/s, the most; 0 steps to the goal at once.
            acceleration: pulses/s^2; 0 takes the speed at once.
        """
        self.goal = goal
        self.ongoing = True
        self._speed, self._acceleration = speed, acceleration
        distance = abs(goal - self.position)
        if speed <= 0.0:
            self.kind = ProfileKind.STEP
        elif acceleration <= 0.0:
            self.kind = ProfileKind.RECTANGULAR
        elif distance < speed**2 / acceleration:
            self.kind = ProfileKind.TRIANGULAR
        else:
            self.kind = ProfileKind.TRAPEZOIDAL

    def aim_in(self, goal: float, duration: float, rise: float) -> None:
        """Start towards a goal to be reached at a time (time-based profile, from rest).

        Args:
            goal: pulses.
            duration: s for the whole way; 0 steps to the goal at once.
            rise: s to come to speed, at most half the duration.
        """
        distance = abs(goal - self.position)
        rise = min(rise, duration / 2.0)
        if duration <= 0.0 or distance == 0.0:
            self.aim(goal, 0.0, 0.0)
            return
        speed = distance / (duration - rise)
        self.aim(goal, speed, speed / rise if rise > 0.0 else 0.0)

    def advance(self, period: float) -> None:
        """One period on."""
        if not self.ongoing:
            return
        left = self.goal - self.position
        if self.kind is ProfileKind.STEP:
            self._arrive()
            return
        wanted = math.copysign(min(self._speed, self._braking(abs(left), period)), left)
        velocity = velocity_step(self.velocity, wanted, self._acceleration, period)
        # The last step is what is left of the way.
        if abs(left) <= abs(velocity) * period and velocity * left >= 0.0:
            self._arrive()
            return
        self.velocity = velocity
        self.position += velocity * period

    def _braking(self, distance: float, period: float) -> float:
        """The speed from which the way left is enough to stop, braking in whole periods."""
        if self._acceleration <= 0.0:
            return math.inf
        half = self._acceleration * period / 2.0
        return math.sqrt(half**2 + 2.0 * self._acceleration * distance) - half

    def _arrive(self) -> None:
        self.position = self.goal
        self.velocity = 0.0
        self.ongoing = False
