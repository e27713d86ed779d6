"""The other side: a score or a frame as its mirror image."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import TYPE_CHECKING, TypeVar, overload

from enpointe.notation.frame import Frame
from enpointe.notation.movement import Limb
from enpointe.notation.signs import Orientation, Side

if TYPE_CHECKING:
    from enpointe.notation.score import Score

__all__ = ["mirrored"]

Value = TypeVar("Value")


@overload
def mirrored(what: Frame) -> Frame: ...
@overload
def mirrored(what: Score) -> Score: ...
def mirrored(what: Frame | Score) -> Frame | Score:
    """The mirror image: left and right change places, turns and tilts change their sense.

    Args:
        what: A frame, or a score (all its frames).

    Returns:
        The same danced to the other side; the mirror image of that is the original.
    """
    if isinstance(what, Frame):
        return _frame(what)
    return replace(what, frames=tuple(_frame(frame) for frame in what.frames))


def _frame(frame: Frame) -> Frame:
    feet, arms, pose = frame.feet, frame.arms, frame.pose
    facing, place, travel, turn = frame.facing, frame.place, frame.travel, frame.turn
    return replace(
        frame,
        feet=feet and replace(feet, front=_other(feet.front)),
        arms=arms and replace(arms, leading=_other(arms.leading)),
        hands=_sides(frame.hands),
        elbows=_sides(frame.elbows),
        foot_signs=_sides(frame.foot_signs),
        knees=_sides(frame.knees),
        head=_orientation(frame.head),
        body=_orientation(frame.body),
        pelvis=_orientation(frame.pelvis),
        support=_sides(frame.support),
        legs=_sides(frame.legs),
        pose=pose and replace(pose, support=pose.support.other),
        contacts=_sides(frame.contacts),
        facing=facing and replace(facing, degrees=_minus(facing.degrees)),
        place=place and replace(place, left=_minus(place.left)),
        travel=travel
        and replace(travel, degrees=_minus(travel.degrees), curve=_minus(travel.curve)),
        turn=turn and replace(turn, sense=turn.sense.other),
        paths={Limb.of(limb.side.other, limb.kind): path for limb, path in frame.paths.items()},
        locomotion=_sides(frame.locomotion),
    )


def _other(side: Side | None) -> Side | None:
    return side and side.other


def _minus(value: float) -> float:
    """The negative, without a negative zero."""
    return 0.0 - value


def _sides(signs: Mapping[Side, Value]) -> dict[Side, Value]:
    return {side.other: sign for side, sign in signs.items()}


def _orientation(part: Orientation | None) -> Orientation | None:
    return part and replace(part, turn=_minus(part.turn), tilt=_minus(part.tilt))
