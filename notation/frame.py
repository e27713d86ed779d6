"""One key pose: as it is written, and with everything filled in."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from fractions import Fraction

from enpointe.notation.movement import Jump, Limb, Locomotion, PathMark
from enpointe.notation.signs import (
    ArmsPosition,
    FeetPosition,
    HandContact,
    LegPosition,
    Location,
    Orientation,
    PosePosition,
    Side,
    Sign,
    Support,
)
from enpointe.notation.stage import Facing, StagePlace, Travel, Turn

__all__ = ["ArmSigns", "Frame", "ResolvedFrame", "ResolvedLeg"]

_START = Location(1, 1)


@dataclass(frozen=True, slots=True)
class Frame:
    """One key pose as it is written; what is None or absent holds from before.

    Attributes:
        beat: When, in pulses from the start.
        feet: A named position of the feet.
        arms: A named position of the arms.
        hands: Wrist signs, by side.
        elbows: Signs of bent elbows, by side.
        foot_signs: Ankle signs, by side.
        knees: Signs of bent knees, by side; these may stand with a named position (a plié).
        head: Orientation of the head against the body.
        body: Orientation of the body above the waist.
        pelvis: Orientation of the pelvis, below the waist.
        at: The line of its beat; takes no part in equality.
        support: How a foot meets the floor and its knee is bent, by side.
        legs: Named positions of a working leg, by side.
        pose: A named position of the whole body, which the rest of the frame overrides.
        contacts: Hands on the body, by side.
        facing: Where the dancer faces.
        place: Where the dancer is on the stage.
        travel: The way here from the frame before.
        turn: The turn of the whole body on the way here.
        paths: Movement lines of hands and feet that arrive here.
        locomotion: Whether a foot steps, slides or jumps here, by side.
        jump: The flight that lands here.
    """

    beat: Fraction
    feet: FeetPosition | None = None
    arms: ArmsPosition | None = None
    hands: Mapping[Side, Sign] = field(default_factory=dict, hash=False)
    elbows: Mapping[Side, Sign] = field(default_factory=dict, hash=False)
    foot_signs: Mapping[Side, Sign] = field(default_factory=dict, hash=False)
    knees: Mapping[Side, Sign] = field(default_factory=dict, hash=False)
    head: Orientation | None = None
    body: Orientation | None = None
    pelvis: Orientation | None = None
    at: Location = field(default=_START, compare=False)
    support: Mapping[Side, Support] = field(default_factory=dict, hash=False)
    legs: Mapping[Side, LegPosition] = field(default_factory=dict, hash=False)
    pose: PosePosition | None = None
    contacts: Mapping[Side, HandContact] = field(default_factory=dict, hash=False)
    facing: Facing | None = None
    place: StagePlace | None = None
    travel: Travel | None = None
    turn: Turn | None = None
    paths: Mapping[Limb, PathMark] = field(default_factory=dict, hash=False)
    locomotion: Mapping[Side, Locomotion] = field(default_factory=dict, hash=False)
    jump: Jump | None = None


@dataclass(frozen=True, slots=True)
class ArmSigns:
    """All that a frame means for one arm.

    Attributes:
        wrist: Where the wrist is.
        elbow: Where the elbow is, if its sign was written; it overrides the rounding
            (Neagle 2005 §4.4.3).
        rounded: Whether the ballet rule of the rounded arm applies (§4.4.2): True unless the arm is
            straight or its elbow is written.
        named: The named position that set this arm, or None if raw signs did.
    """

    wrist: Sign
    elbow: Sign | None = None
    rounded: bool = True
    named: ArmsPosition | None = None


@dataclass(frozen=True, slots=True)
class ResolvedLeg:
    """All that a frame means for one leg.

    It stands in a named position of the feet (`position` and `support`), or on the floor under a
    sign of its own (`foot` at height 1 and `support`), or it is a working leg in the air or
    touching (`foot`, `knee` where bent, and `named` if a name set them).

    Attributes:
        position: The named position of the feet that it stands in.
        named: The named position of a working leg that set its signs.
        foot: The ankle's sign; None exactly when `position` is given.
        knee: The knee's sign; None for a knee that is straight or bent as `support` says.
        support: How the foot meets the floor; None for a foot in the air.
    """

    position: FeetPosition | None
    named: LegPosition | None
    foot: Sign | None
    knee: Sign | None
    support: Support | None

    @property
    def bears(self) -> bool:
        """Whether weight is on this leg."""
        return self.support is not None and self.support.bears


@dataclass(frozen=True, slots=True)
class ResolvedFrame:
    """One key pose with everything filled in; each thing carries the location that set it.

    Attributes:
        beat: When, in pulses from the start.
        feet: The named position that the feet hold, or None once both feet have signs of their own.
        foot_signs: Feet that have left the named position, by side; the other foot stays as `feet`
            has it. A foot at height 1 is on the floor.
        knees: Bent knees that have a sign, by side.
        arms: Both arms.
        head: Orientation of the head.
        body: Orientation of the body.
        pelvis: Orientation of the pelvis.
        at: The line of its beat; takes no part in equality.
        legs: Both legs, with all that `feet`, `foot_signs` and `knees` say and their support.
        contacts: Hands on the body, by side; `arms` has their signs.
        facing_degrees: Where the dancer faces, degrees from the audience, + to the left, turns
            added up: after a full turn to the right from the audience it is -360.
        place: Where the dancer is on the stage, travelled or written; its centre at first.
        travel: The way here; only where it is written.
        turn: The turn on the way here; only where it is written.
        paths: Movement lines; only where they are written.
        locomotion: Steps, slides and jumps; only where they are written.
        jump: The flight that lands here; only where it is written.
        pose: The named position of the whole body; only where it is written.
    """

    beat: Fraction
    feet: FeetPosition | None
    foot_signs: Mapping[Side, Sign] = field(hash=False)
    knees: Mapping[Side, Sign] = field(hash=False)
    arms: Mapping[Side, ArmSigns] = field(hash=False)
    head: Orientation
    body: Orientation
    pelvis: Orientation
    at: Location = field(compare=False)
    legs: Mapping[Side, ResolvedLeg] = field(hash=False)
    contacts: Mapping[Side, HandContact] = field(hash=False)
    facing_degrees: float
    place: StagePlace
    travel: Travel | None
    turn: Turn | None
    paths: Mapping[Limb, PathMark] = field(hash=False)
    locomotion: Mapping[Side, Locomotion] = field(hash=False)
    jump: Jump | None
    pose: PosePosition | None
