"""Fills in what the frames of a score leave unwritten."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import replace
from typing import TYPE_CHECKING, TypeVar

from enpointe.errors import ScoreError
from enpointe.notation.frame import ArmSigns, Frame, ResolvedFrame, ResolvedLeg
from enpointe.notation.signs import (
    ArmsPosition,
    Depth,
    FeetPosition,
    HandContact,
    LegPosition,
    Location,
    Orientation,
    Side,
    Sign,
    Support,
)
from enpointe.notation.stage import StagePlace, shorter_way
from enpointe.notation.vocabulary import (
    arm_signs,
    find_arms,
    find_feet,
    find_leg,
    find_pose,
    leg_signs,
    pose_frame,
)
from enpointe.notation.vocabulary_arms import CONTACT_PLACES
from enpointe.notation.vocabulary_legs import LegSigns

if TYPE_CHECKING:
    from enpointe.notation.score import Score

__all__ = ["FLOOR_LINE", "overlaid", "resolve"]

_Value = TypeVar("_Value")

FLOOR_LINE = 1.0
"""Height of a foot that is on the floor."""

_UNDER_THE_HIP = Sign(0.097, FLOOR_LINE, Depth.LEVEL)
"""Where a foot stands of which only the support is written: .083 of .858 m from the centre line, on
the dancer of 1.68 m that the vocabulary's legs are reckoned for."""


def resolve(score: Score) -> tuple[ResolvedFrame, ...]:
    """See :meth:`~enpointe.notation.score.Score.resolved`."""
    state = _State(score.source)
    return tuple(state.read(frame) for frame in score.frames)


def overlaid(under: Frame, over: Frame) -> Frame:
    """One frame with another laid over it: whatever the upper one writes overrides the lower one.

    A limb that the upper one writes in any way is taken from it whole.
    """
    arms, hands, elbows, contacts = under.arms, under.hands, under.elbows, under.contacts
    if over.arms is not None:
        arms, hands, elbows, contacts = over.arms, {}, {}, {}
    moved = {*over.hands, *over.contacts}
    feet, foot_signs, knees = under.feet, under.foot_signs, under.knees
    legs, support = under.legs, under.support
    if over.feet is not None:
        feet, foot_signs, knees, legs, support = over.feet, {}, {}, {}, {}
    placed = {*over.foot_signs, *over.legs}
    stood = {*placed, *over.support}
    facing = over.facing if over.facing or over.turn else under.facing
    return replace(
        over,
        feet=feet,
        arms=arms,
        hands={**_without(hands, moved), **over.hands},
        elbows={**_without(elbows, moved), **over.elbows},
        contacts={**_without(contacts, moved), **over.contacts},
        foot_signs={**_without(foot_signs, {*over.legs}), **over.foot_signs},
        knees={**_without(knees, stood), **over.knees},
        legs={**_without(legs, stood), **over.legs},
        support={**_without(support, stood), **over.support},
        head=over.head or under.head,
        body=over.body or under.body,
        pelvis=over.pelvis or under.pelvis,
        facing=facing,
    )


def _without(signs: Mapping[Side, _Value], sides: Collection[Side]) -> dict[Side, _Value]:
    return {side: sign for side, sign in signs.items() if side not in sides}


class _State:
    """What holds at a frame, carried from one to the next."""

    def __init__(self, source: str | None) -> None:
        self._source = source
        self._arms: dict[Side, ArmSigns] = {}
        self._contacts: dict[Side, HandContact] = {}
        self._legs: dict[Side, ResolvedLeg] = {}
        self._head = self._body = self._pelvis = Orientation()
        self._facing = 0.0
        self._place = StagePlace()

    def read(self, written: Frame) -> ResolvedFrame:
        """Takes one frame over what held before."""
        frame = written
        if written.pose is not None:
            entry = find_pose(written.pose.name)
            self._known(f"pose: {written.pose.name}", entry, written.pose.at or written.at)
            frame = overlaid(pose_frame(written.pose, written), written)
        self._read_arms(frame)
        self._read_legs(frame)
        if len(self._arms) < len(Side) or len(self._legs) < len(Side):
            raise self._fail(
                "the first frame must give both feet and both arms, such as "
                "'feet: fifth right front' and 'arms: fifth en bas'",
                frame.at,
            )
        self._head = frame.head or self._head
        self._body = frame.body or self._body
        self._pelvis = frame.pelvis or self._pelvis
        self._read_stage(frame)
        legs = {side: self._legs[side] for side in Side}
        positions = [leg.position for leg in legs.values() if leg.position is not None]
        return ResolvedFrame(
            beat=frame.beat,
            feet=positions[0] if positions else None,
            foot_signs={side: leg.foot for side, leg in legs.items() if leg.foot is not None},
            knees={side: leg.knee for side, leg in legs.items() if leg.knee is not None},
            arms={side: self._arms[side] for side in Side},
            head=self._head,
            body=self._body,
            pelvis=self._pelvis,
            at=frame.at,
            legs=legs,
            contacts=dict(self._contacts),
            facing_degrees=self._facing,
            place=self._place,
            travel=frame.travel,
            turn=frame.turn,
            paths=dict(frame.paths),
            locomotion=dict(frame.locomotion),
            jump=frame.jump,
            pose=frame.pose,
        )

    def _read_arms(self, frame: Frame) -> None:
        if frame.arms is not None:
            self._arms = self._named_arms(frame.arms, frame)
            self._contacts = {}
        for side, contact in frame.contacts.items():
            place = CONTACT_PLACES[contact.place]
            wrist = replace(place.wrist, at=contact.at)
            elbow = place.elbow and replace(place.elbow, at=contact.at)
            self._arms[side] = ArmSigns(wrist, elbow, elbow is None, None)
            self._contacts[side] = contact
        for side, sign in frame.hands.items():
            self._arms[side] = ArmSigns(sign, None, not sign.straight, None)
            if side not in frame.contacts:
                self._contacts.pop(side, None)
        for side, sign in frame.elbows.items():
            if side in self._arms:
                self._arms[side] = ArmSigns(self._arms[side].wrist, sign, False, None)

    def _named_arms(self, position: ArmsPosition, frame: Frame) -> dict[Side, ArmSigns]:
        what, at = f"arms: {position.name}", position.at or frame.at
        entry = self._known(what, find_arms(position.name), at)
        if entry.needs_leading and position.leading is None:
            raise self._fail(f"'{what}' must say which arm leads", at)
        return {
            side: ArmSigns(sign, None, not sign.straight, position)
            for side, sign in arm_signs(position).items()
        }

    def _read_legs(self, frame: Frame) -> None:
        if frame.feet is not None:
            self._check_feet(frame.feet, frame)
            for side in Side:
                self._legs[side] = ResolvedLeg(frame.feet, None, None, None, Support())
        for side, sign in frame.foot_signs.items():
            floor = Support() if sign.height == FLOOR_LINE else None
            self._legs[side] = ResolvedLeg(None, None, sign, None, floor)
        for side, position in frame.legs.items():
            signs = self._named_leg(position, frame)
            self._legs[side] = ResolvedLeg(None, position, signs.foot, signs.knee, signs.support)
        for side, support in frame.support.items():
            leg = self._legs.get(side)
            if leg is None or leg.named is not None or leg.support is None:
                foot = replace(_UNDER_THE_HIP, at=support.at)
                leg = ResolvedLeg(None, None, foot, None, None)
            self._legs[side] = replace(leg, knee=None, support=support)
        for side, knee in frame.knees.items():
            if side in self._legs:
                self._legs[side] = replace(self._legs[side], knee=knee)

    def _check_feet(self, position: FeetPosition, frame: Frame) -> None:
        what, at = f"feet: {position.name}", position.at or frame.at
        entry = self._known(what, find_feet(position.name), at)
        if entry.crossed and position.front is None:
            raise self._fail(f"'{what}' must say which foot is in front", at)
        if position.open and not entry.has_open:
            raise self._fail(f"'{what}' has no open form", at)

    def _named_leg(self, position: LegPosition, frame: Frame) -> LegSigns:
        what, at = f"leg: {position.name}", position.at or frame.at
        entry, _ = self._known(what, find_leg(position.name), at)
        if position.direction is not None and position.direction not in entry.directions:
            raise self._fail(f"'{what}' has no form {position.direction}", at)
        return leg_signs(position)

    def _read_stage(self, frame: Frame) -> None:
        if frame.turn is not None:
            self._facing += frame.turn.signed
        elif frame.facing is not None:
            self._facing += shorter_way(frame.facing.degrees - self._facing)
        if frame.place is not None:
            self._place = frame.place
        elif frame.travel is not None:
            self._place = frame.travel.after(self._place)

    def _known(self, what: str, entry: _Value | None, at: Location) -> _Value:
        if entry is None:
            raise self._fail(f"'{what}' is not in the vocabulary", at)
        return entry

    def _fail(self, message: str, at: Location) -> ScoreError:
        return ScoreError(message, at.line, at.column, self._source)
