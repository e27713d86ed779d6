"""What the named positions look like as directions of limbs: what a pose is compared with.

Where signs alone say it (arms, straight legs, attitudes), the directions come from the signs. Where
a position is defined by what the foot touches (tendu, retiré, cou-de-pied), or has one height only,
they come from the solved pose too, of the perfect dancer and of the real one.
"""

from __future__ import annotations

import functools
from collections.abc import Iterator
from dataclasses import dataclass, replace
from fractions import Fraction
from itertools import product

import mujoco
import numpy as np
from numpy.typing import NDArray

from enpointe.models.figure import Figure
from enpointe.models.keypose import KeyPoseSolver
from enpointe.models.leg_target import InAir
from enpointe.models.limbs import LimbDirections
from enpointe.models.style import Style
from enpointe.models.target import PoseTarget, pose_target
from enpointe.notation import (
    ArmsPosition,
    Bend,
    Direction,
    Frame,
    LegPosition,
    Score,
    Side,
    Support,
)
from enpointe.notation.vocabulary import ARM_PLACES, ARMS, LEGS, ArmPlace, find_leg
from enpointe.notation.vocabulary_legs import LegEntry

__all__ = ["ArmReference", "ArmsReference", "LegReference", "References", "heights_of"]

Vector = NDArray[np.float64]
_STEP_DEG = 15.0
"""Heights of a leg are tried this far apart."""
_STEPS = 5
_LOWEST = 40.0
"""A straight leg is not called raised below this: dégagé and tendu are there."""
_IN_FLIGHT = ("pointed",)
"""Positions that only a jump has: a leg that hangs straight down is off no floor otherwise."""
_MIRROR = np.array([1.0, -1.0, 1.0])


@dataclass(frozen=True)
class ArmReference:
    """One arm at a place, for the left arm, in the torso's frame."""

    place: str
    upper: Vector
    lower: Vector


@dataclass(frozen=True)
class ArmsReference:
    """A named position of both arms, by the places that they take."""

    position: ArmsPosition
    places: dict[Side, str]


@dataclass(frozen=True)
class LegReference:
    """A named position of a working leg, for the left leg, in the upright.

    Attributes:
        position: With its direction and its height in degrees where it has one.
        upper: Direction of the thigh.
        lower: Direction of the shank.
        touches: Whether the toe is on the floor.
        bend: Of the leg that she stands on, where the position depends on it; None for any.
    """

    position: LegPosition
    upper: Vector
    lower: Vector
    touches: bool = False
    bend: Bend | None = None

    def fits(self, limbs: LimbDirections, side: Side) -> bool:
        """Whether a leg of `side` can be in this position over the leg that she stands on."""
        if self.position.name in _IN_FLIGHT and limbs.bearing:
            return False
        if self.bend is None:
            return True
        straight = limbs.feet[side.other].bend is Bend.STRAIGHT
        return straight == (self.bend is Bend.STRAIGHT)


def heights_of(position: LegPosition) -> tuple[float, float]:
    """Least and greatest height of a position that has one, degrees."""
    found = find_leg(position.name)
    assert found is not None and found[0].degrees is not None
    low, _, high = found[0].degrees
    return max(low, _LOWEST), high


class References:
    """The vocabulary as directions of one dancer's limbs.

    Args:
        model: The dancer.

    Attributes:
        arm_places: Every place of an arm.
        arms: Every position of the arms, with each arm leading.
    """

    def __init__(self, model: mujoco.MjModel) -> None:
        self.figure = Figure.of(model)
        self._model = model
        self.arms = tuple(_arms())
        self.arm_places = {name: self._arm_place(name, place) for name, place in ARM_PLACES.items()}

    @functools.cached_property
    def legs(self) -> tuple[LegReference, ...]:
        """Laid out when the first working leg is looked at: solving takes seconds."""
        return tuple(self._legs(self._model))

    def _arm_place(self, name: str, place: ArmPlace) -> ArmReference:
        """The directions that a sign gives an arm, with no body to give way."""
        hands = dict.fromkeys(Side, place.wrist)
        frame = Frame(Fraction(0), hands=hands, support=dict.fromkeys(Side, Support()))
        named = next(ref for ref in self.arms if name in ref.places.values())
        side = next(side for side, where in named.places.items() if where == name)
        arm = self._target(replace(frame, hands={}, arms=named.position)).arms[side]
        upper, lower = _unit(arm.elbow - arm.shoulder), _unit(arm.wrist - arm.elbow)
        if side is Side.RIGHT:
            upper, lower = _MIRROR * upper, _MIRROR * lower
        return ArmReference(name, upper, lower)

    def _legs(self, model: mujoco.MjModel) -> Iterator[LegReference]:
        solver = KeyPoseSolver(model)
        for entry in LEGS:
            for direction in entry.directions:
                yield from self._by_signs(entry, direction)
                if entry.degrees is None:
                    yield from self._by_solving(entry, direction, solver)

    def _by_signs(self, entry: LegEntry, direction: Direction) -> Iterator[LegReference]:
        heights: list[float | None] = [None]
        if entry.degrees is not None:
            low, usual, high = entry.degrees
            steps = np.arange(-_STEPS, _STEPS + 1) * _STEP_DEG + usual
            heights = [float(h) for h in steps if max(low, _LOWEST) <= h <= high]
        for height in heights:
            position = LegPosition(entry.name, direction, height)
            leg = self._target(_on_the_right(position)).legs[Side.LEFT]
            if not isinstance(leg, InAir):
                continue
            hip = self.figure.hips[Side.LEFT]
            knee = leg.knee if leg.knee is not None else 0.5 * (hip + leg.ankle)
            thigh, shank = _unit(knee - hip), _unit(leg.ankle - knee)
            yield LegReference(position, thigh, shank)

    def _by_solving(
        self, entry: LegEntry, direction: Direction, solver: KeyPoseSolver
    ) -> Iterator[LegReference]:
        position = LegPosition(entry.name, direction)
        for bend, real in product((Bend.STRAIGHT, Bend.DEMI_PLIE), (False, True)):
            frame = _on_the_right(position, bend)
            solved = solver.solve(self._target(frame, Style(real=real)))
            if solved.held:
                limbs = LimbDirections.of(solver.model, solved.qpos)
                thigh, shank = limbs.thigh[Side.LEFT], limbs.shank[Side.LEFT]
                yield LegReference(position, thigh, shank, entry.name == "tendu", bend)

    def _target(self, frame: Frame, style: Style | None = None) -> PoseTarget:
        score = Score("reference", "Cecchetti", (4, 4), 60.0, (frame,))
        return pose_target(score.resolved()[0], self.figure, style)


def _arms() -> Iterator[ArmsReference]:
    for entry in ARMS:
        for leading in Side if entry.needs_leading else (None,):
            places = {
                side: entry.leading if side is leading or leading is None else entry.other
                for side in Side
            }
            yield ArmsReference(ArmsPosition(entry.name, leading), places)


def _on_the_right(position: LegPosition, bend: Bend = Bend.STRAIGHT) -> Frame:
    """Standing on the right leg, the left leg working."""
    return Frame(
        Fraction(0),
        arms=ArmsPosition("à la seconde"),
        support={Side.RIGHT: Support(bend=bend)},
        legs={Side.LEFT: position},
    )


def _unit(vector: Vector) -> Vector:
    return np.asarray(vector / np.linalg.norm(vector))
