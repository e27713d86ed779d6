"""From poses to the frames of a score: names where there are names, signs otherwise, and only what
changes.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from fractions import Fraction

import numpy as np

from enpointe.models.matching import NAMED_DEG, leg_names
from enpointe.models.reading import ReadLeg
from enpointe.models.recognition import Recognition
from enpointe.notation import (
    ArmsPosition,
    FeetPosition,
    FloorContact,
    Frame,
    LegPosition,
    Orientation,
    PosePosition,
    Side,
    Sign,
    Support,
)
from enpointe.notation.amounts import HEIGHTS, MAX_DEGREES, WIDTHS
from enpointe.notation.stage import Facing, Turn
from enpointe.notation.vocabulary import find_pose

__all__ = ["Scribe", "arms_of", "leg_of", "same_position"]

_SAME_SIGN = 0.1
"""Signs that are no farther apart than this, in stave units, are one sign."""
_SAME_DEG = 4.0
"""Orientations that are no farther apart than this are one."""
_SAME_FACING = 10.0
_COMPASS = 10.0
"""A facing this close to one of the eight directions, degrees, is that direction."""
_POSE_WITHIN = 6.0
"""A named pose stands for a frame whose limbs are this close to it, degrees rms."""
_POSE_WORST = 14.0
_WHOLE_TURN = 200.0
"""A change of facing by more than this is a turn."""


@dataclass(frozen=True, slots=True)
class Arm:
    """One arm that no name covers."""

    hand: Sign
    elbow: Sign | None


Arms = ArmsPosition | Mapping[Side, Arm]


@dataclass(frozen=True, slots=True)
class Leg:
    """One leg: a name, or its signs, or the way it stands."""

    position: FeetPosition | LegPosition | None
    foot: Sign | None
    knee: Sign | None
    support: Support | None


def arms_of(recognition: Recognition) -> Arms:
    """Both arms as a frame would write them."""
    if recognition.arms.named:
        position = recognition.arms.position
        assert isinstance(position, ArmsPosition)
        return position
    signs = recognition.signs
    arms = {}
    for side in Side:
        elbow = signs.elbows.get(side)
        hand = signs.hands[side] if elbow is None else replace(signs.hands[side], straight=False)
        arms[side] = Arm(_plain(hand), None if elbow is None else _plain(elbow))
    return arms


def leg_of(recognition: Recognition, side: Side) -> Leg:
    """One leg as a frame would write it."""
    read = recognition.signs.legs[side]
    match = recognition.legs.get(side)
    if match is None:
        support = read.support
        assert support is not None
        feet = recognition.feet
        if feet is not None and feet.named:
            assert isinstance(feet.position, FeetPosition)
            return Leg(feet.position, None, None, support)
        if feet is not None:
            return Leg(None, replace(_plain(read.foot), height=HEIGHTS[0]), None, support)
        return Leg(None, None, None, support)
    touching = read.support is not None
    if match.named and (touching or match.distance < NAMED_DEG):
        assert isinstance(match.position, LegPosition)
        return Leg(match.position, None, None, None)
    return _working(read)


def same_position(one: Recognition, other: Recognition) -> bool:
    """Whether a frame would say of both poses the same, wherever they face."""
    a, b = one.signs, other.signs
    parts = ((a.head, b.head), (a.body, b.body), (a.pelvis, b.pelvis))
    return (
        _same_arms(arms_of(one), arms_of(other))
        and all(_same_leg(leg_of(one, side), leg_of(other, side)) for side in Side)
        and all(_apart(part, another) <= _SAME_DEG for part, another in parts)
    )


def _working(read: ReadLeg) -> Leg:
    foot = _plain(read.foot)
    if read.support is not None and read.support.floor is FloorContact.TOUCH:
        touch = Support(FloorContact.TOUCH)
        return Leg(None, replace(foot, height=HEIGHTS[0]), None, touch)
    # A foot at the floor line would stand on it.
    foot = replace(foot, height=max(foot.height, HEIGHTS[0] + 0.01))
    return Leg(None, foot, None if read.knee is None else _plain(read.knee), None)


@dataclass
class Scribe:
    """Writes frame after frame and remembers what holds.

    Attributes:
        frames: What is written so far.
    """

    frames: list[Frame] = field(default_factory=list)
    _arms: Arms | None = None
    _legs: dict[Side, Leg] = field(default_factory=dict)
    _parts: dict[str, Orientation] = field(default_factory=dict)
    _facing: float = 0.0

    def write(
        self, beat: Fraction, recognition: Recognition, turned: float = 0.0, holds: bool = False
    ) -> None:
        """Add a frame.

        Args:
            beat: Later than the last one.
            recognition: Of the pose.
            turned: How far she has turned since the last frame, degrees, + to the left.
            holds: Whether the last pose was held up to here: its arms are then written again.
        """
        frame = self._with_legs(Frame(beat), recognition)
        frame = self._with_arms(frame, recognition, again=holds)
        frame = self._with_parts(frame, recognition)
        frame = self._with_facing(frame, recognition, turned)
        self.frames.append(self._with_pose(frame, recognition))

    def _with_arms(self, frame: Frame, recognition: Recognition, *, again: bool) -> Frame:
        arms = arms_of(recognition)
        if not again and _same_arms(arms, self._arms):
            return frame
        self._arms = arms
        if isinstance(arms, ArmsPosition):
            return replace(frame, arms=arms)
        elbows = {side: arm.elbow for side, arm in arms.items() if arm.elbow is not None}
        return replace(frame, hands={side: arm.hand for side, arm in arms.items()}, elbows=elbows)

    def _with_legs(self, frame: Frame, recognition: Recognition) -> Frame:
        legs = {side: leg_of(recognition, side) for side in Side}
        before = self._legs
        both = legs[Side.LEFT].position
        if isinstance(both, FeetPosition):
            placed = all(before.get(side, legs[side]).position == both for side in Side)
            anew = not before or not placed
            support = {}
            for side, leg in legs.items():
                assert leg.support is not None
                held = Support() if anew else before[side].support
                if leg.support != held:
                    support[side] = leg.support
            self._legs = legs
            return replace(frame, feet=both if anew else None, support=support)
        for side, leg in legs.items():
            last = before.get(side)
            if leg.position is None and leg.foot is None and last is not None and _stood(last):
                # She stays on this foot, wherever it stood.
                if leg.support != last.support:
                    assert leg.support is not None
                    frame = replace(frame, support={**frame.support, side: leg.support})
                legs[side] = replace(last, support=leg.support)
            elif last is None or not _same_leg(leg, last):
                frame = _with_leg(frame, side, leg)
            else:
                legs[side] = last
        self._legs = legs
        return frame

    def _with_parts(self, frame: Frame, recognition: Recognition) -> Frame:
        signs = recognition.signs
        written: dict[str, Orientation] = {}
        for name, part in (("head", signs.head), ("body", signs.body), ("pelvis", signs.pelvis)):
            whole = _whole_degrees(part)
            held = self._parts.get(name, Orientation())
            if _apart(whole, held) > _SAME_DEG or (not self.frames and name == "head"):
                written[name] = whole
                self._parts[name] = whole
        return replace(
            frame,
            head=written.get("head"),
            body=written.get("body"),
            pelvis=written.get("pelvis"),
        )

    def _with_facing(self, frame: Frame, recognition: Recognition, turned: float) -> Frame:
        facing = recognition.signs.facing_degrees
        if abs(turned) > _WHOLE_TURN and self.frames:
            degrees = _near_compass(abs(turned))
            self._facing = _wrapped(self._facing + (degrees if turned > 0 else -degrees))
            return replace(frame, turn=Turn(degrees, Side.LEFT if turned > 0 else Side.RIGHT))
        if abs(_wrapped(facing - self._facing)) < _SAME_FACING and self.frames:
            return frame
        self._facing = _wrapped(_near_compass(facing))
        return replace(frame, facing=Facing(self._facing))

    def _with_pose(self, frame: Frame, recognition: Recognition) -> Frame:
        """The same frame under the name of its pose, where legs and arms have just taken it."""
        match = recognition.pose
        if match is None or not frame.legs or frame.arms is None or frame.turn is not None:
            return frame
        close = match.distance < _POSE_WITHIN and match.worst_distance < _POSE_WORST
        if not (match.named and close) or frame.foot_signs or frame.feet:
            return frame
        assert isinstance(match.position, PosePosition)
        entry = find_pose(match.position.name)
        assert entry is not None
        if recognition.signs.legs[match.position.support].support != Support(bend=entry.bend):
            return frame
        working = frame.legs.get(match.position.support.other)
        if working is None or not _alike(working, entry.leg):
            return frame
        head, body = recognition.signs.head, recognition.signs.body
        self._parts |= {"head": _whole_degrees(head), "body": _whole_degrees(body)}
        return Frame(
            frame.beat,
            pose=match.position,
            head=self._parts["head"],
            body=self._parts["body"],
            pelvis=frame.pelvis,
            facing=Facing(self._facing),
        )


def _with_leg(frame: Frame, side: Side, leg: Leg) -> Frame:
    if isinstance(leg.position, LegPosition):
        return replace(frame, legs={**frame.legs, side: leg.position})
    if leg.foot is not None:
        frame = replace(frame, foot_signs={**frame.foot_signs, side: leg.foot})
    if leg.knee is not None:
        frame = replace(frame, knees={**frame.knees, side: leg.knee})
    if leg.support is not None:
        frame = replace(frame, support={**frame.support, side: leg.support})
    return frame


def _stood(leg: Leg) -> bool:
    return leg.support is not None and leg.support.bears


def _same_leg(leg: Leg, other: Leg) -> bool:
    return (
        leg.position == other.position
        and leg.support == other.support
        and _same_sign(leg.foot, other.foot)
        and _same_sign(leg.knee, other.knee)
    )


def _alike(leg: LegPosition, other: LegPosition) -> bool:
    """Whether two names mean the same position, at whatever height."""
    names, others = (set(leg_names(replace(each, degrees=None))) for each in (leg, other))
    return bool(names & others)


def _same_arms(arms: Arms, other: Arms | None) -> bool:
    if isinstance(arms, ArmsPosition) or isinstance(other, ArmsPosition) or other is None:
        return arms == other
    return all(
        _same_sign(arms[side].hand, other[side].hand)
        and _same_sign(arms[side].elbow, other[side].elbow)
        for side in Side
    )


def _same_sign(sign: Sign | None, other: Sign | None) -> bool:
    if sign is None or other is None:
        return sign is other
    near = max(abs(sign.width - other.width), abs(sign.height - other.height)) < _SAME_SIGN
    return near and sign.depth == other.depth and sign.straight == other.straight


def _plain(sign: Sign) -> Sign:
    """To a thousandth, within what a stave holds."""
    width = float(np.clip(round(sign.width, 3), *WIDTHS))
    height = float(np.clip(round(sign.height, 3), *HEIGHTS))
    return replace(sign, width=width + 0.0, height=height)


def _whole_degrees(part: Orientation) -> Orientation:
    """To a degree; what is less than `_SAME_DEG` is none."""

    def plain(amount: float) -> float:
        whole = float(np.clip(round(amount), -MAX_DEGREES, MAX_DEGREES))
        return whole if abs(amount) >= _SAME_DEG - 1.0 else 0.0

    return Orientation(plain(part.turn), plain(part.tilt), plain(part.bend))


def _apart(one: Orientation, other: Orientation) -> float:
    return max(abs(one.turn - other.turn), abs(one.tilt - other.tilt), abs(one.bend - other.bend))


def _near_compass(degrees: float) -> float:
    """An angle on the compass where it is close to it, otherwise to 5 degrees."""
    eighth = 45.0 * round(degrees / 45.0)
    return eighth if abs(eighth - degrees) < _COMPASS else 5.0 * round(degrees / 5.0)


def _wrapped(angle: float) -> float:
    """The same direction, above -180 and up to 180."""
    return 180.0 - (180.0 - angle) % 360.0
