"""The named positions of ballet: found by any of their names, listed, and expanded to signs.

The tables stand beside this module: `vocabulary_arms`, `vocabulary_feet`, `vocabulary_legs` and
`vocabulary_poses`.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Literal, TypeAlias, get_args

from enpointe.notation.frame import Frame
from enpointe.notation.mirror import mirrored
from enpointe.notation.signs import (
    ArmsPosition,
    Depth,
    Direction,
    FeetPosition,
    LegPosition,
    PosePosition,
    Side,
    Sign,
    Support,
)
from enpointe.notation.spelling import close_to, fold
from enpointe.notation.stage import Facing
from enpointe.notation.vocabulary_arms import ARM_PLACES, ARMS, ArmPlace, ArmsEntry
from enpointe.notation.vocabulary_feet import FEET, FeetEntry
from enpointe.notation.vocabulary_legs import DIRECTIONS, LEGS, LegEntry, LegSigns, expand_leg
from enpointe.notation.vocabulary_poses import POSES, PoseEntry

__all__ = [
    "ARMS",
    "ARM_PLACES",
    "FEET",
    "LEGS",
    "POSES",
    "ArmPlace",
    "ArmsEntry",
    "FeetEntry",
    "LegEntry",
    "Part",
    "PoseEntry",
    "arm_signs",
    "feet_signs",
    "find_arms",
    "find_feet",
    "find_leg",
    "find_pose",
    "leg_signs",
    "names",
    "nearest",
    "pose_frame",
]

Part: TypeAlias = Literal["feet", "arms", "leg", "pose"]

_HEIGHTS = (45.0, 90.0, 120.0)
"""Heights that a leg position with a height is listed with."""

_ARMS_BY_NAME = {fold(name): entry for entry in ARMS for name in (entry.name, *entry.aliases)}
_FEET_BY_NAME = {fold(name): entry for entry in FEET for name in (entry.name, *entry.aliases)}
_POSES_BY_NAME = {fold(name): entry for entry in POSES for name in (entry.name, *entry.aliases)}
_LEGS_BY_NAME: Mapping[str, tuple[LegEntry, Direction | None]] = {
    fold(f"{name} {word}"): (entry, direction)
    for entry in LEGS
    for name in (entry.name, *entry.aliases)
    for direction, words in ((None, ("",)), *DIRECTIONS.items())
    for word in words
}


def find_arms(name: str) -> ArmsEntry | None:
    """The position of the arms with this name or alias; accents, case and hyphens don't matter."""
    return _ARMS_BY_NAME.get(fold(name))


def find_feet(name: str) -> FeetEntry | None:
    """The position of the feet with this name or alias; accents, case and hyphens don't matter."""
    return _FEET_BY_NAME.get(fold(name))


def find_leg(name: str) -> tuple[LegEntry, Direction | None] | None:
    """The position of a working leg with this name or alias, and its direction where it has one.

    "raised", "raised seconde" and "en l'air side" are such names; a height is not part of them.
    """
    return _LEGS_BY_NAME.get(fold(name))


def find_pose(name: str) -> PoseEntry | None:
    """The position of the whole body with this name or alias."""
    return _POSES_BY_NAME.get(fold(name))


def names(part: Part | None = None) -> tuple[str, ...]:
    """Every name of the vocabulary, without aliases.

    Args:
        part: "feet", "arms", "leg" or "pose" for the names of that part as a score writes them
            (without the side that some need). None for all, each with its part in front ("feet
            fifth", "arms fifth en haut"), as some names are in several.

    Returns:
        The names in the order of the tables; legs in each direction and at the usual heights.
    """
    if part == "feet":
        opened = (f"{entry.name} open" for entry in FEET if entry.has_open)
        return (*(entry.name for entry in FEET), *opened)
    if part == "arms":
        return tuple(entry.name for entry in ARMS)
    if part == "leg":
        return tuple(
            f"{entry.name} {direction}{height}"
            for entry in LEGS
            for direction in entry.directions
            for height in _listed_heights(entry)
        )
    if part == "pose":
        return tuple(entry.name for entry in POSES)
    return tuple(f"{each} {name}" for each in get_args(Part) for name in names(each))


def _listed_heights(entry: LegEntry) -> list[str]:
    if entry.degrees is None:
        return [""]
    least, _, greatest = entry.degrees
    return [f" {each:g}" for each in _HEIGHTS if least <= each <= greatest]


def nearest(name: str, part: Part, count: int = 3) -> tuple[str, ...]:
    """The known names most like a name that isn't known, best first; empty when none is like it."""
    if part == "leg":
        legs = close_to(name, _LEGS_BY_NAME, count)
        return tuple(
            f"{entry.name} {direction or entry.directions[0]}" for entry, direction in legs
        )
    tables: Mapping[str, Mapping[str, ArmsEntry | FeetEntry | PoseEntry]] = {
        "arms": _ARMS_BY_NAME,
        "feet": _FEET_BY_NAME,
        "pose": _POSES_BY_NAME,
    }
    return tuple(entry.name for entry in close_to(name, tables[part], count))


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
        ValueError: The position needs a front foot and has none, or has no open form.
    """
    entry = find_feet(position.name)
    if entry is None:
        raise KeyError(position.name)
    if entry.crossed and position.front is None:
        raise ValueError(f"{entry.name} needs a front foot")
    apart = entry.open_apart if position.open else entry.apart
    if apart is None:
        raise ValueError(f"{entry.name} has no open form")

    def depth(side: Side) -> Depth:
        if not entry.crossed:
            return Depth.LEVEL
        return Depth.FRONT if side is position.front else Depth.BEHIND

    return {side: Sign(apart, 1.0, depth(side), at=position.at) for side in Side}


def leg_signs(position: LegPosition) -> LegSigns:
    """Expands a named position of a working leg to the signs of its ankle and knee.

    Args:
        position: A position whose name the vocabulary knows.

    Raises:
        KeyError: The vocabulary has no such name.
        ValueError: The position has no such direction.
    """
    found = find_leg(position.name)
    if found is None:
        raise KeyError(position.name)
    entry, _ = found
    if position.direction is not None and position.direction not in entry.directions:
        raise ValueError(f"{entry.name} has no form {position.direction}")
    return expand_leg(position, entry)


def pose_frame(position: PosePosition, frame: Frame) -> Frame:
    """A frame with nothing but the parts of a named pose, at the beat and place of another.

    Raises:
        KeyError: The vocabulary has no such name.
    """
    entry = find_pose(position.name)
    if entry is None:
        raise KeyError(position.name)
    at = position.at
    on_left = Frame(
        frame.beat,
        arms=ArmsPosition(entry.arms, entry.leading, at),
        head=replace(entry.head, at=at),
        body=replace(entry.body, at=at),
        at=frame.at,
        support={Side.LEFT: Support(bend=entry.bend, at=at)},
        legs={Side.RIGHT: replace(entry.leg, at=at)},
        facing=None if entry.facing is None else Facing(entry.facing, at),
    )
    return on_left if position.support is Side.LEFT else mirrored(on_left)
