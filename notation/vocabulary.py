"""The named positions of ballet, each a macro over the signs of the stave.

The numbers of an arm stand once, in :data:`ARM_PLACES`; a position of the arms says which place
each arm takes. They were chosen by eye on a dancer of 1.68 m, whose lines are at 0.49, 1.03, 1.33,
1.68 and 1.85 m and whose full reach is 0.68 m, so that every place is within reach, in front where
it says front. No source prints them as numbers: what the sources say in words is quoted with each
place, the figures are ours.

Sources, by their short names: Neagle 2005 (the thesis); ABT (American Ballet Theatre's dictionary,
after Grant); Grant (Technical Manual and Dictionary of Classical Ballet).
"""

from __future__ import annotations

import difflib
import unicodedata
from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Literal

from enpointe.notation.signs import ArmsPosition, Depth, FeetPosition, Side, Sign

__all__ = [
    "ARMS",
    "ARM_PLACES",
    "FEET",
    "ArmPlace",
    "ArmsEntry",
    "FeetEntry",
    "arm_signs",
    "feet_signs",
    "find_arms",
    "find_feet",
    "names",
    "nearest",
]

Part = Literal["feet", "arms"]


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
class FeetEntry:
    """A named position of the feet on the floor.

    Attributes:
        name: The name that scores are written with.
        apart: Width of each foot's sign, as a fraction of the sideways reach of the leg.
        crossed: Whether one foot is in front of the other, so that the score must say which.
        description: One line for people.
        source: Where the position is defined.
        aliases: Other names for exactly this position.
    """

    name: str
    apart: float
    crossed: bool
    description: str
    source: str
    aliases: tuple[str, ...] = ()


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
        "à la seconde",
        "seconde",
        "seconde",
        "both arms to the side, sloping",
        _THESIS,
        ("second", "seconde"),
    ),
    ArmsEntry(
        "third", "bas", "demi-seconde", "one arm low in the fifth, the other off the side", _THESIS
    ),
    ArmsEntry("fourth en bas", "bas", "seconde", "one arm low, the other to the side", _THESIS),
    ArmsEntry(
        "fourth en avant", "avant", "seconde", "one arm in front, the other to the side", _THESIS
    ),
    ArmsEntry(
        "fourth en haut", "haut", "seconde", "one arm overhead, the other to the side", _THESIS
    ),
    ArmsEntry("fifth en bas", "bas", "bas", "both arms low", _THESIS, ("bras bas",)),
    ArmsEntry("fifth en avant", "avant", "avant", "both arms in front, the gateway", _THESIS),
    ArmsEntry("fifth en haut", "haut", "haut", "both arms overhead", _THESIS, ("en couronne",)),
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
    ),
)

FEET: tuple[FeetEntry, ...] = (
    FeetEntry("first", 0.05, False, "heels together, toes turned out", _THESIS),
    FeetEntry("second", 0.18, False, "heels apart under the shoulders", _THESIS, ("seconde",)),
    FeetEntry("third", 0.04, True, "front heel at the middle of the back foot", _THESIS),
    FeetEntry("fourth", 0.06, True, "one foot in front, a foot's length apart", _THESIS),
    FeetEntry("fifth", 0.0, True, "front heel at the big-toe joint of the back foot", _THESIS),
)

_ORDINALS = {"1st": "first", "2nd": "second", "3rd": "third", "4th": "fourth", "5th": "fifth"}


def _fold(name: str) -> str:
    """The name without case, accents, hyphens and spare blanks, ordinals spelt out."""
    bare = "".join(
        char
        for char in unicodedata.normalize("NFKD", name.casefold())
        if not unicodedata.combining(char)
    )
    words = bare.replace("-", " ").split()
    return " ".join(_ORDINALS.get(word, word) for word in words)


_ARMS_BY_NAME = {_fold(name): entry for entry in ARMS for name in (entry.name, *entry.aliases)}
_FEET_BY_NAME = {_fold(name): entry for entry in FEET for name in (entry.name, *entry.aliases)}


def find_arms(name: str) -> ArmsEntry | None:
    """The position of the arms with this name or alias; accents, case and hyphens don't matter."""
    return _ARMS_BY_NAME.get(_fold(name))


def find_feet(name: str) -> FeetEntry | None:
    """The position of the feet with this name or alias; accents, case and hyphens don't matter."""
    return _FEET_BY_NAME.get(_fold(name))


def names(part: Part | None = None) -> tuple[str, ...]:
    """Every name of the vocabulary, without aliases.

    Args:
        part: "feet" or "arms" for the names of that part as a score writes them. None for all, each
            with its part in front ("feet fifth", "arms fifth en haut"), as some names are in both.

    Returns:
        The names in the order of the tables.
    """
    if part == "feet":
        return tuple(entry.name for entry in FEET)
    if part == "arms":
        return tuple(entry.name for entry in ARMS)
    return tuple(f"{each} {name}" for each in ("feet", "arms") for name in names(each))


def nearest(name: str, part: Part, count: int = 3) -> tuple[str, ...]:
    """The known names most like a name that isn't known, best first; empty when none is like it."""
    table: Mapping[str, ArmsEntry | FeetEntry] = _ARMS_BY_NAME if part == "arms" else _FEET_BY_NAME
    close = difflib.get_close_matches(_fold(name), table, n=count, cutoff=0.5)
    return tuple(dict.fromkeys(table[key].name for key in close))


def arm_signs(position: ArmsPosition) -> dict[Side, Sign]:
    """Expands a named position of the arms to the sign of each wrist.

    Args:
        position: A position whose name the vocabulary knows, with its leading arm where it needs
            one.

    Returns:
        The wrist's sign for each side, located where the position was written.

    Raises:
        KeyError: The vocabulary has no such name.
        ValueError: The position needs a leading arm and has none.
    """
    entry = find_arms(position.name)
    if entry is None:
        raise KeyError(position.name)
    if entry.needs_leading and position.leading is None:
        raise ValueError(f"{entry.name} needs a leading arm")
    return {
        side: replace(
            ARM_PLACES[entry.leading if side is position.leading else entry.other].wrist,
            at=position.at,
        )
        for side in Side
    }


def feet_signs(position: FeetPosition) -> dict[Side, Sign]:
    """Expands a named position of the feet to the signs on the floor line.

    Which foot is in front is read from the depth of the signs (Neagle 2005 §4.4.6).

    Args:
        position: A position whose name the vocabulary knows, with its front foot where it needs
            one.

    Returns:
        The ankle's sign for each side, at height 1 (the floor).

    Raises:
        KeyError: The vocabulary has no such name.
        ValueError: The position needs a front foot and has none.
    """
    entry = find_feet(position.name)
    if entry is None:
        raise KeyError(position.name)
    if entry.crossed and position.front is None:
        raise ValueError(f"{entry.name} needs a front foot")

    def depth(side: Side) -> Depth:
        if not entry.crossed:
            return Depth.LEVEL
        return Depth.FRONT if side is position.front else Depth.BEHIND

    return {side: Sign(entry.apart, 1.0, depth(side), at=position.at) for side in Side}
