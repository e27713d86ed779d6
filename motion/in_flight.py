"""Key moments about a jump: in the air nothing pauses, so that its poses show by their names alone.

A notator writes how a dancer leaves the floor and how she looks in the air. Of the moments about a
take-off, and of those in the air, the one that is nearest to a named position is taken.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from math import degrees

import numpy as np

from enpointe.models.limbs import LimbDirections
from enpointe.models.recognition import Recognition
from enpointe.motion.keyframes import KeyMoment, MotionOutline
from enpointe.notation import Bend, Side, Support

__all__ = ["TOUCH", "in_flight", "is_position", "landed"]

_POSITION_WITHIN = 4.5
_FEET_WITHIN = 3.0
"""A moment that nothing else marks is a position if its pose is a named one within these, degrees
and cm."""
_PUSH = (0.12, 0.03)
"""A take-off is looked for between these before the floor is left, s: after that the foot that
pushes is on its way to the point."""
_LANDING = 0.06
"""A landing is looked for until this long after the floor is back, s."""
TOUCH = 0.15
"""And so long she is landing, s."""
_GIVES_DEG = 10.0
"""A knee bent by more than this when it lands is giving: on its way into a demi-plié."""


def in_flight(
    outline: MotionOutline, pose_at: Callable[[float], Recognition]
) -> Iterator[tuple[KeyMoment, Recognition]]:
    """Of each take-off the last position, of each landing and time in the air the nearest to one.

    Args:
        outline: Of the motion.
        pose_at: What the pose at a time is called.
    """
    for flight in outline.flights:
        early, late = _PUSH
        push = [
            (time, pose_at(time))
            for time in _between(outline, flight.start - early, flight.start - late)
        ]
        yield from _moment([each for each in push if is_position(each[1])][-1:])
        for start, end, sure in (
            (flight.end, flight.end + _LANDING, True),
            (flight.start + late, flight.end - late, False),
        ):
            times = _between(outline, start, end)
            yield from _moment([(time, pose_at(time)) for time in times], sure)


def _moment(
    poses: Sequence[tuple[float, Recognition]], sure: bool = False
) -> Iterator[tuple[KeyMoment, Recognition]]:
    """The one nearest to its names, if any has names."""
    named = [(time, pose) for time, pose in poses if pose.named]
    if named:
        time, pose = min(named, key=lambda each: _off(each[1]))
        yield KeyMoment(time, False, 0.0, sure), pose


def landed(pose: Recognition) -> Recognition:
    """A pose at the moment of a landing: knees that give are written as the demi-plié they go into.

    Any jump ends in a demi-plié (Grant, sauté); toe, ball and heel come down one after the other.
    """
    legs = dict(pose.signs.legs)
    for side, leg in legs.items():
        support = leg.support
        if support is not None and support.bears and _knee(pose.signs.limbs, side) > _GIVES_DEG:
            legs[side] = replace(leg, support=Support(bend=Bend.DEMI_PLIE))
    return replace(pose, signs=replace(pose.signs, legs=legs))


def is_position(pose: Recognition) -> bool:
    """Whether a pose is a position as it stands, and not on the way from one to another."""
    return pose.named and _off(pose) < 1.0


def _off(pose: Recognition) -> float:
    """How far from its names, against what a position may be off."""
    feet = 0.0 if pose.feet is None else pose.feet.distance / _FEET_WITHIN
    return max(feet, pose.distance / _POSITION_WITHIN)


def _between(outline: MotionOutline, start: float, end: float) -> list[float]:
    inside = (outline.time > start) & (outline.time < end)
    return [float(time) for time in outline.time[np.flatnonzero(inside)]]


def _knee(limbs: LimbDirections, side: Side) -> float:
    cosine = float(np.clip(limbs.thigh[side] @ limbs.shank[side], -1.0, 1.0))
    return degrees(float(np.arccos(cosine)))
