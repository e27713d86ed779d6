"""Named positions of the arms, each a macro over the signs of the wrists.

The numbers of an arm stand once, in :data:`ARM_PLACES`; a position of the arms says which place
each arm takes. They were tuned on a dancer of 1.68 m (knee .493, waist 1.026, shoulder 1.331, crown
1.68, stretched wrist overhead 1.853; shoulder .155 from the centre line; wrist .508 from the
shoulder when the arm is rounded and .522 when it is straight, hence a full reach of .678; all in
metres) so that every place is within reach, in front where it says front. No source prints them as
numbers: what they say in words stands with each place, the figures are ours.

Sources, by their short names: Neagle 2005 (the thesis); ABT (American Ballet Theatre's dictionary,
after Grant); Grant (Technical Manual and Dictionary of Classical Ballet).

Names are Cecchetti's. Other schools count the same positions otherwise, so that their numbers carry
the school's name: "RAD third" is the fourth en avant.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from enpointe.notation.signs import BodyPlace, Depth, Sign

__all__ = [
    "ARMS",
    "ARM_PLACES",
    "BODY_PLACES",
    "CONTACT_PLACES",
    "ArmPlace",
    "ArmsEntry",
    "ContactPlace",
]


@dataclass(frozen=True, slots=True)
class ArmPlace:
    """A place that one arm can take, as the sign of its wrist."""

    wrist: Sign
    description: str
    source: str


@dataclass(frozen=True, slots=True)
class ArmsEntry:
    """A named position of both arms.

    Attributes:
        name: The name that scores are written with.
        leading: Key in :data:`ARM_PLACES` of the leading arm.
        other: Key of the other arm; the same key where both arms do the same.
        description: One line for people.
        source: Where the position is defined.
        aliases: Other names for exactly this position.
    """

    name: str
    leading: str
    other: str
    description: str
    source: str
    aliases: tuple[str, ...] = ()

    @property
    def needs_leading(self) -> bool:
        """Whether the score must say which arm leads."""
        return self.leading != self.other


@dataclass(frozen=True, slots=True)
class ContactPlace:
    """Where an arm is whose hand lies on the body.

    Attributes:
        wrist: The wrist's sign.
        elbow: The elbow's sign; None for an arm that stays rounded.
        description: One line for people.
    """

    wrist: Sign
    elbow: Sign | None
    description: str


_THESIS = "Neagle 2005 §4.2.2"

ARM_PLACES: Mapping[str, ArmPlace] = {
    "first": ArmPlace(
        Sign(0.28, 2.64, Depth.FRONT), "at the side, fingertips near the thigh", _THESIS
    ),
    "bas": ArmPlace(
        Sign(0.185, 2.68, Depth.FRONT), "low, rounded, just off the front of the thighs", _THESIS
    ),
    "avant": ArmPlace(
        Sign(0.21, 3.50, Depth.FRONT),
        "in front, at the base of the breastbone",
        "ABT, port de bras (gateway); webref, Positions des bras (height)",
    ),
    "haut": ArmPlace(
        Sign(0.20, 5.75, Depth.FRONT),
        "overhead, some 20 cm in front of the crown",
        f"{_THESIS}; balletterms.net (15 to 25 cm)",
    ),
    "seconde": ArmPlace(
        Sign(0.955, 3.72, Depth.FRONT),
        "to the side, sloping down, never behind the shoulder",
        _THESIS,
    ),
    "demi-seconde": ArmPlace(
        Sign(0.73, 3.00, Depth.FRONT),
        "halfway between first and à la seconde",
        "Grant, demi-seconde",
    ),
    "demi-bras": ArmPlace(
        Sign(0.47, 3.20, Depth.FRONT),
        "forward at half the height and half the width of the second",
        "Grant, demi-bras",
    ),
    "arabesque eye level": ArmPlace(
        Sign(0.20, 4.45, Depth.FRONT, straight=True),
        "straight in front, fingertips on the line between the eyes",
        f"{_THESIS}; Grant, arabesque",
    ),
    "arabesque above shoulder": ArmPlace(
        Sign(0.20, 4.20, Depth.FRONT, straight=True),
        "straight in front, just above the shoulder",
        _THESIS,
    ),
    "arabesque shoulder level": ArmPlace(
        Sign(0.20, 4.00, Depth.FRONT, straight=True), "straight in front at shoulder level", _THESIS
    ),
    "arabesque side": ArmPlace(
        Sign(0.85, 3.60, Depth.BEHIND, straight=True),
        "straight, below the shoulder and slightly behind it",
        _THESIS,
    ),
    "arabesque back": ArmPlace(
        Sign(0.78, 3.70, Depth.BEHIND, straight=True),
        "straight, below and behind, on the line of the front arm",
        _THESIS,
    ),
}

ARMS: tuple[ArmsEntry, ...] = (
    ArmsEntry("first", "first", "first", "both arms at the sides", _THESIS),
    ArmsEntry(
        "demi-seconde",
        "demi-seconde",
        "demi-seconde",
        "both arms halfway to the second",
        "Grant, demi-seconde",
        ("demi-second",),
    ),
    ArmsEntry(
        "demi-bras",
        "demi-bras",
        "demi-bras",
        "both arms forward, open as if asking",
        "Grant, demi-bras",
    ),
    ArmsEntry(
        "à la seconde",
        "seconde",
        "seconde",
        "both arms to the side, sloping",
        _THESIS,
        ("second", "seconde", "RAD second", "Vaganova second"),
    ),
    ArmsEntry(
        "third", "bas", "demi-seconde", "one arm low in the fifth, the other off the side", _THESIS
    ),
    ArmsEntry("fourth en bas", "bas", "seconde", "one arm low, the other to the side", _THESIS),
    ArmsEntry(
        "fourth en avant",
        "avant",
        "seconde",
        "one arm in front, the other to the side",
        _THESIS,
        ("RAD third",),
    ),
    ArmsEntry(
        "fourth en haut",
        "haut",
        "seconde",
        "one arm overhead, the other to the side",
        _THESIS,
        ("RAD fourth",),
    ),
    ArmsEntry(
        "fourth en haut demi-seconde",
        "haut",
        "demi-seconde",
        "one arm overhead, the other low at the side, as in croisé and effacé",
        "balletclassroom 2012, Cecchetti body positions (low second)",
    ),
    ArmsEntry(
        "fifth en bas",
        "bas",
        "bas",
        "both arms low",
        _THESIS,
        ("bras bas", "RAD bras bas", "Vaganova preparatory"),
    ),
    ArmsEntry(
        "fifth en avant",
        "avant",
        "avant",
        "both arms in front, the gateway",
        _THESIS,
        ("RAD first", "French first", "Vaganova first", "gateway"),
    ),
    ArmsEntry(
        "fifth en haut",
        "haut",
        "haut",
        "both arms overhead",
        _THESIS,
        ("en couronne", "couronne", "RAD fifth", "French fifth", "Vaganova third"),
    ),
    ArmsEntry(
        "first arabesque",
        "arabesque eye level",
        "arabesque side",
        "one arm in front at eye level, the other slightly behind",
        _THESIS,
    ),
    ArmsEntry(
        "second arabesque",
        "arabesque above shoulder",
        "arabesque back",
        "one arm in front above the shoulder, the other behind on the same line",
        _THESIS,
    ),
    ArmsEntry(
        "third arabesque",
        "arabesque eye level",
        "arabesque shoulder level",
        "both arms in front, one higher than the other",
        _THESIS,
        ("à deux bras",),
    ),
)

CONTACT_PLACES: Mapping[BodyPlace, ContactPlace] = {
    BodyPlace.HIP: ContactPlace(
        Sign(0.30, 2.99, Depth.LEVEL),
        Sign(0.57, 3.57, Depth.LEVEL),
        "the hand on the crest of the hip, the elbow to the side",
    ),
    BodyPlace.WAIST: ContactPlace(
        Sign(0.28, 3.24, Depth.LEVEL),
        Sign(0.60, 3.70, Depth.LEVEL),
        "the hand in the waist, the elbow to the side",
    ),
    BodyPlace.SHOULDER: ContactPlace(
        Sign(0.26, 4.11, Depth.LEVEL),
        Sign(0.62, 3.83, Depth.LEVEL),
        "the hand on its own shoulder, the elbow to the side",
    ),
    BodyPlace.THIGH: ContactPlace(
        Sign(0.28, 2.64, Depth.FRONT), None, "the hand on the front of its own thigh"
    ),
    BodyPlace.HEAD: ContactPlace(
        Sign(0.19, 4.77, Depth.LEVEL),
        Sign(0.54, 4.47, Depth.LEVEL),
        "the hand on the side of the head, the elbow to the side",
    ),
    BodyPlace.OTHER_HAND: ContactPlace(
        Sign(0.06, 2.72, Depth.FRONT), None, "the hands folded low in front"
    ),
}
"""Ours, by trigonometry on a dancer of 1.68 m whose upper arm is .266 m and forearm .256 m: in the
plane of the body the elbow stands where both lengths meet. The sources say only that contact of
hand and body is written (Neagle 2005 fig. 4.2)."""

BODY_PLACES: Mapping[BodyPlace, tuple[str, ...]] = {
    BodyPlace.HIP: ("hip", "hips"),
    BodyPlace.WAIST: ("waist",),
    BodyPlace.SHOULDER: ("shoulder",),
    BodyPlace.THIGH: ("thigh",),
    BodyPlace.HEAD: ("head",),
    BodyPlace.OTHER_HAND: ("other hand",),
}
"""Words for the places that a hand lies on; the first is the one that scores are written with."""
