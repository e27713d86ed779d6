"""Named positions of the feet on the floor, and the bends that a leg stands with."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from enpointe.notation.signs import Bend, FloorContact

__all__ = ["BENDS", "FEET", "FLOOR", "FeetEntry"]


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
        open_apart: The width in its open form; None if it has none.
    """

    name: str
    apart: float
    crossed: bool
    description: str
    source: str
    aliases: tuple[str, ...] = ()
    open_apart: float | None = None

    @property
    def has_open(self) -> bool:
        """Whether the position has an open form."""
        return self.open_apart is not None


_THESIS = "Neagle 2005 §4.2.2"

FEET: tuple[FeetEntry, ...] = (
    FeetEntry("first", 0.05, False, "heels together, toes turned out", _THESIS),
    FeetEntry(
        "second",
        0.18,
        False,
        "heels apart under the shoulders",
        _THESIS,
        ("seconde", "à la seconde"),
    ),
    FeetEntry("third", 0.04, True, "front heel at the middle of the back foot", _THESIS),
    FeetEntry(
        "fourth",
        0.06,
        True,
        "one foot in front, a foot's length apart",
        _THESIS,
        ("quatrième",),
        0.10,
    ),
    FeetEntry("fifth", 0.0, True, "front heel at the big-toe joint of the back foot", _THESIS),
)

BENDS: Mapping[Bend, tuple[str, ...]] = {
    Bend.STRAIGHT: ("straight", "stretched"),
    Bend.DEMI_PLIE: ("demi-plié", "plié", "fondu"),
    Bend.GRAND_PLIE: ("grand plié",),
}
"""Words for the knee of a leg that stands; the first is the one that scores are written with."""

FLOOR: Mapping[FloorContact, tuple[str, ...]] = {
    FloorContact.FLAT: ("flat", "whole foot", "à plat"),
    FloorContact.DEMI_POINTE: ("demi-pointe", "half point", "relevé", "ball"),
    FloorContact.POINTE: ("pointe", "full point", "en pointe", "relevé on pointe"),
    FloorContact.TOUCH: ("touching", "without weight"),
}
"""Words for a foot on the floor; the first is the one that scores are written with."""
