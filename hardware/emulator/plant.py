"""What the servos turn: torques in, angles and velocities out."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Protocol, runtime_checkable

from enpointe.hardware.datasheet import ServoModel

__all__ = ["GearedPlant", "Load", "Loads", "Plant"]


@runtime_checkable
class Plant(Protocol):
    """The mechanics behind the horns, all servos of a bus together, in the bus's order.

    Rotor inertia and dry friction of the gears belong to the plant, as `ServoModel.armature` and
    `ServoModel.friction` give them; back-EMF belongs to the motors.
    """

    def advance(self, torque: Sequence[float], period: float) -> None:
        """Go on by a period (s) under the motors' torques (N m)."""

    def position(self) -> Sequence[float]:
        """Angle of each horn, rad, over as many turns as it has made; 0 is the mark up."""

    def velocity(self) -> Sequence[float]:
        """Velocity of each horn, rad/s."""

    def jam(self, joint: int, jammed: bool) -> None:
        """Hold a joint where it is, as gears with a stone in them do, or let it go."""


@runtime_checkable
class GearedPlant(Plant, Protocol):
    """A plant whose gears may have play, so that a motor can turn while its horn doesn't.

    Sensors see the horns; what the motors' windings feel is their own turning.
    """

    def rotor_velocity(self) -> Sequence[float]:
        """Velocity of the motors' side of the gears, as horns would turn without play, rad/s."""


@dataclass(frozen=True, slots=True)
class Load:
    """What hangs on one horn.

    Attributes:
        inertia: kg m^2, the rotor's included.
        friction: N m, dry.
        gravity: N m that a weight on a horizontal arm gives; the arm hangs down at `hanging`.
        hanging: rad.
        start: rad, where it is at first.
    """

    inertia: float
    friction: float = 0.0
    gravity: float = 0.0
    hanging: float = 0.0
    start: float = 0.0

    @classmethod
    def of(cls, model: ServoModel, *, extra: float = 0.0, start: float = 0.0) -> Load:
        """A bare servo, or one with so much more inertia on it, kg m^2."""
        return cls(model.armature + extra, model.friction, start=start)


class Loads:
    """A `Plant` of joints that know nothing of one another.

    Semi-implicit Euler; dry friction takes what it can and never turns a joint round.

    Args:
        loads: One a servo.
    """

    def __init__(self, loads: Sequence[Load]) -> None:
        self._loads = tuple(loads)
        self._position = [load.start for load in loads]
        self._velocity = [0.0] * len(loads)
        self._jammed = [False] * len(loads)

    def advance(self, torque: Sequence[float], period: float) -> None:
        for joint, load in enumerate(self._loads):
            if self._jammed[joint]:
                continue
            speed, angle = self._velocity[joint], self._position[joint]
            force = torque[joint]
            if load.gravity:
                force -= load.gravity * math.sin(angle - load.hanging)
            speed += force * period / load.inertia
            brake = load.friction * period / load.inertia
            speed = 0.0 if abs(speed) <= brake else speed - math.copysign(brake, speed)
            self._velocity[joint] = speed
            self._position[joint] = angle + speed * period

    def position(self) -> Sequence[float]:
        return self._position

    def velocity(self) -> Sequence[float]:
        return self._velocity

    def turn_by_hand(self, joint: int, angle: float) -> None:
        """Put a joint, which nothing holds, at an angle, rad."""
        self._position[joint], self._velocity[joint] = angle, 0.0

    def jam(self, joint: int, jammed: bool) -> None:
        self._jammed[joint] = jammed
        if jammed:
            self._velocity[joint] = 0.0
