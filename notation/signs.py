"""The signs of the stave as values.

What the numbers of a :class:`Sign` mean:

Neagle (2005) plots the *wrist* for a hand sign and the *ankle* for a foot sign, because those are
the ends of the limbs whose lengths are fixed (§4.4.1, fig. 4.6); so do we. An elbow or knee sign
plots the joint itself (§4.4.3).

``height``, in stave lines, counted from the floor. 1 is the floor, 2 the knee, 3 the waist, 4 the
top of the shoulder, 5 the top of the head (§4.3) and 6 the wrist of an arm stretched overhead (the
ledger line that notators imagine above the stave). Between two lines it is linear between the two
heights of the dancer's own body: ``z = z_n + p (z_{n+1} - z_n)`` (§4.4.1, eq. 4.1). For legs line 3
is the height of the hip, so that a foot on the third line is a horizontal leg (§4.7.3).

``width``, as a fraction of the full sideways reach on the limb's own side, measured from the centre
line of the body: 0 is the centre line and 1 the wrist (or ankle) of a limb stretched sideways, so
0.5 is about the elbow (§4.3). Negative is crossed over the centre line. A level extremity with a
limb of known length leaves no choice of width: there it places the sign on the page and says which
side (§4.4.1).

``depth``: in front of the body, level with it, or behind it. How far is not written, for only one
point in front (or behind) agrees with the length of the limb (§4.3).

Rotations of head, body and pelvis apply as turn, then tilt, then bend: ``q = q_turn q_tilt q_bend``
(§4.4.5, table 4.1). ``Orientation()`` is erect, the identity.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from enum import StrEnum

__all__ = [
    "ArmsPosition",
    "Bend",
    "BodyPlace",
    "Depth",
    "Direction",
    "FeetPosition",
    "FloorContact",
    "HandContact",
    "LegPosition",
    "Location",
    "Orientation",
    "PosePosition",
    "Side",
    "Sign",
    "Support",
]


class Side(StrEnum):
    """The dancer's own left and right."""

    LEFT = "left"
    RIGHT = "right"

    @property
    def other(self) -> Side:
        """The opposite side."""
        return Side.RIGHT if self is Side.LEFT else Side.LEFT


class Depth(StrEnum):
    """Where an extremity is, seen against the plane of the body (Neagle 2005 §4.3)."""

    FRONT = "front"
    LEVEL = "level"
    BEHIND = "behind"


class FloorContact(StrEnum):
    """How much of a foot is on the floor."""

    FLAT = "flat"
    DEMI_POINTE = "demi-pointe"
    POINTE = "pointe"
    TOUCH = "touching"
    """The toe, without weight: a pointe tendue."""


class Bend(StrEnum):
    """How far the knee of a supporting leg is bent."""

    STRAIGHT = "straight"
    DEMI_PLIE = "demi-plié"
    """Heels down, as deep as they allow; on one leg it is called fondu."""
    GRAND_PLIE = "grand plié"
    """Thighs level; the heels rise, except in second and in the open fourth."""


class Direction(StrEnum):
    """Where the working leg is, seen from the hips."""

    DEVANT = "devant"
    SECONDE = "seconde"
    DERRIERE = "derrière"


class BodyPlace(StrEnum):
    """A part of the dancer's own body that a hand lies on."""

    HIP = "hip"
    WAIST = "waist"
    SHOULDER = "shoulder"
    THIGH = "thigh"
    HEAD = "head"
    OTHER_HAND = "other hand"


@dataclass(frozen=True, slots=True)
class Location:
    """A place in the text of a score: line and column, both from 1."""

    line: int
    column: int


@dataclass(frozen=True, slots=True)
class Sign:
    """One plotted point of a limb; the module's docstring says what the numbers mean.

    Attributes:
        width: Fraction of the full sideways reach, from the centre line; negative is crossed.
        height: Stave lines, 1 (floor) to 6 (wrist of a stretched arm overhead).
        depth: In front of the body, level with it or behind it.
        straight: For a hand: the arm is stretched, as in the arabesques. Arms are rounded otherwise
            (Neagle 2005 §4.2.2).
        at: Where it was written; takes no part in equality.
    """

    width: float
    height: float
    depth: Depth
    straight: bool = False
    at: Location | None = field(default=None, compare=False)


@dataclass(frozen=True, slots=True)
class Orientation:
    """How the head, the body or the pelvis is held, in degrees (Neagle 2005 §4.4.5).

    Attributes:
        turn: About the vertical; + to the dancer's left.
        tilt: About the front-back axis; + to the dancer's left.
        bend: About the left-right axis; + forward (lowered), - back (raised).
        at: Where it was written; takes no part in equality.
    """

    turn: float = 0.0
    tilt: float = 0.0
    bend: float = 0.0
    at: Location | None = field(default=None, compare=False)


@dataclass(frozen=True, slots=True)
class FeetPosition:
    """One of the five positions of the feet.

    Attributes:
        name: Its name in the vocabulary: "first" to "fifth".
        front: The foot in front, for third, fourth and fifth; None for first and second.
        open: The open form of the fourth (quatrième ouverte): opposite the first, heels in line,
            where the closed one (croisée) is opposite the fifth.
        at: Where it was written; takes no part in equality.
    """

    name: str
    front: Side | None = None
    open: bool = False
    at: Location | None = field(default=None, compare=False)


@dataclass(frozen=True, slots=True)
class ArmsPosition:
    """A named position of both arms.

    Attributes:
        name: Its name in the vocabulary, such as "fifth en haut".
        leading: For positions whose arms differ, the arm in the fifth (third and fourth position)
            or in front, or higher (arabesques); None where both arms do the same.
        at: Where it was written; takes no part in equality.
    """

    name: str
    leading: Side | None = None
    at: Location | None = field(default=None, compare=False)


@dataclass(frozen=True, slots=True)
class Support:
    """How one foot meets the floor and its knee is bent; where it stands is another matter.

    Attributes:
        floor: Flat, on demi-pointe, on pointe, or touching without weight.
        bend: Straight, demi-plié or grand plié.
        at: Where it was written; takes no part in equality.
    """

    floor: FloorContact = FloorContact.FLAT
    bend: Bend = Bend.STRAIGHT
    at: Location | None = field(default=None, compare=False)

    @property
    def bears(self) -> bool:
        """Whether weight is on the foot."""
        return self.floor is not FloorContact.TOUCH


@dataclass(frozen=True, slots=True)
class LegPosition:
    """A named position of the working leg.

    Attributes:
        name: Its name in the vocabulary: "tendu", "dégagé", "raised", "cou-de-pied", "retiré",
            "attitude" or "arabesque".
        direction: Devant, seconde or derrière; never None once read from a score.
        degrees: How high: the angle of the leg (of the thigh in an attitude) from hanging, for the
            positions that have a height; None for the others.
        at: Where it was written; takes no part in equality.
    """

    name: str
    direction: Direction | None = None
    degrees: float | None = None
    at: Location | None = field(default=None, compare=False)


@dataclass(frozen=True, slots=True)
class PosePosition:
    """A named position of the whole body: legs, arms, head, body and facing at once.

    Whatever else a frame writes overrides that part of the pose.

    Attributes:
        name: Its name in the vocabulary, such as "first arabesque" or "croisé devant".
        support: The leg that the dancer stands on.
        at: Where it was written; takes no part in equality.
    """

    name: str
    support: Side
    at: Location | None = field(default=None, compare=False)


@dataclass(frozen=True, slots=True)
class HandContact:
    """A hand that lies on the dancer's own body, on its own side.

    Attributes:
        place: What it lies on.
        at: Where it was written; takes no part in equality.
    """

    place: BodyPlace
    at: Location | None = field(default=None, compare=False)
