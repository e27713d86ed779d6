"""Movement lines: what happens on the way to a frame, written in the frame of arrival.

A line from place to place replaces many frames in between (Neagle 2005 §5.2.1). Those of hands and
feet tell a path; those between the feet tell whether the dancer steps, slides or jumps there.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from enum import StrEnum
from fractions import Fraction

from enpointe.notation.signs import Location, Side

__all__ = ["Jump", "Limb", "Locomotion", "PathKind", "PathMark", "StepKind", "Via"]


class Limb(StrEnum):
    """The four extremities."""

    LEFT_HAND = "left hand"
    RIGHT_HAND = "right hand"
    LEFT_FOOT = "left foot"
    RIGHT_FOOT = "right foot"

    @classmethod
    def of(cls, side: Side, kind: str) -> Limb:
        """The limb of a side; `kind` is "hand" or "foot"."""
        return cls(f"{side} {kind}")

    @property
    def side(self) -> Side:
        """Whose side it is on."""
        return Side(self.value.split()[0])

    @property
    def kind(self) -> str:
        """ "hand" or "foot"."""
        return self.value.split()[1]


class PathKind(StrEnum):
    """The shape of a path."""

    STRAIGHT = "straight"
    CIRCULAR = "circular"


class Via(StrEnum):
    """Where the tick on a movement line sends the extremity halfway (Neagle 2005 §5.2.1)."""

    FRONT = "front"
    SIDE = "side"
    BACK = "back"


@dataclass(frozen=True, slots=True)
class PathMark:
    """The path by which an extremity arrives.

    Attributes:
        kind: Straight, or along an arc about the shoulder or hip.
        via: Through the front, the side or the back of the body; None without a tick.
        at: Where it was written; takes no part in equality.
    """

    kind: PathKind
    via: Via | None = None
    at: Location | None = field(default=None, compare=False)


class StepKind(StrEnum):
    """How a foot gets to its place on the floor."""

    STEP = "steps"
    SLIDE = "slides"
    JUMP = "jumps"


@dataclass(frozen=True, slots=True)
class Locomotion:
    """A locomotion line to one foot.

    Attributes:
        kind: Step, slide or jump.
        at: Where it was written; takes no part in equality.
    """

    kind: StepKind
    at: Location | None = field(default=None, compare=False)


@dataclass(frozen=True, slots=True)
class Jump:
    """A flight, written in the frame that it lands in; frames in between are in the air.

    Attributes:
        off: Beat at which the last foot leaves the floor.
        on: Beat at which the first foot is back on it; at most the beat of the frame.
        at: Where it was written; takes no part in equality.
    """

    off: Fraction
    on: Fraction
    at: Location | None = field(default=None, compare=False)
