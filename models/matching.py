"""How far a pose is from a position of the vocabulary, limb by limb, and what that is called."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from math import degrees, sqrt

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from enpointe.models.footing import TOUCHING
from enpointe.models.joints import angle_between
from enpointe.models.limbs import LimbDirections
from enpointe.models.references import LegReference, heights_of
from enpointe.models.target import turn_tilt_bend
from enpointe.notation import (
    ArmsPosition,
    FeetPosition,
    FloorContact,
    LegPosition,
    Orientation,
    PosePosition,
    Side,
)
from enpointe.notation.numerals import format_number
from enpointe.notation.vocabulary import names as vocabulary

__all__ = [
    "ALTERNATIVES",
    "NAMED_DEG",
    "Match",
    "Position",
    "at_height",
    "at_listed_height",
    "both_arms",
    "leg_names",
    "leg_parts",
    "limb_error",
    "match_of",
    "named_within",
    "nearest",
    "of_left",
    "rms",
    "touch_penalty",
    "turned",
    "without_doubles",
]

Vector = NDArray[np.float64]
Position = FeetPosition | ArmsPosition | LegPosition | PosePosition
NAMED_DEG = 14.0
_WORST_DEG = 32.0
"""A position is named when its limbs are within the first of these together and within the second
each: halfway between the rms of 5 degrees of noise in every joint, about 7, and the 20 and more
that most neighbours in the vocabulary are apart."""
_HIGH_DEG = 60.0
"""A thigh higher than this, from hanging, is a leg en l'air: straight or in attitude, to the front,
to the side or behind, and nothing else."""
_HIGH_WITHIN_DEG = 40.0
"""Such a leg is named within this: nearly half of what is between two directions."""
_TOUCH_DEG = 3.0
"""What a toe on the floor counts for against a position that has it off, or the other way about."""
ALTERNATIVES = 3


@dataclass(frozen=True)
class Match:
    """A position of the vocabulary, and how far a pose is from it.

    Attributes:
        position: Which, as a frame of a score holds it.
        names: Its name as a score writes it, and the other names that mean the same geometry.
        distance: Root mean square over the limbs, degrees; for feet, cm between heels.
        unit: "deg" or "cm".
        worst: The limb that is farthest off, such as "right forearm".
        worst_distance: How far that limb is.
        named: Whether that is near enough to be called so.
    """

    position: Position
    names: tuple[str, ...]
    distance: float
    unit: str
    worst: str
    worst_distance: float
    named: bool

    @property
    def name(self) -> str:
        """As a score writes it, with its side."""
        return self.names[0]

    def __str__(self) -> str:
        if self.named:
            return self.name
        unit = "°" if self.unit == "deg" else " cm"
        return (
            f"nearest to {self.name} ({self.distance:.0f}{unit} off; "
            f"{self.worst} {self.worst_distance:.0f}{unit})"
        )


def match_of(
    position: Position, names: tuple[str, ...], parts: Mapping[str, float], *, within: float = 0.0
) -> Match:
    """A match from the angles of each limb.

    Args:
        position: Which.
        names: What it is called.
        parts: Degrees by limb.
        within: Degrees within which something else than directions says that it is this position.
    """
    worst = max(parts, key=lambda part: parts[part])
    distance = rms(parts.values())
    near = distance < NAMED_DEG and parts[worst] < _WORST_DEG
    named = near or distance < within
    return Match(position, names, distance, "deg", worst, parts[worst], named)


def nearest(matches: list[Match]) -> list[Match]:
    return sorted(matches, key=lambda match: match.distance)[: ALTERNATIVES + 1]


def without_doubles(matches: Iterable[Match]) -> list[Match]:
    """The first of each set of names, as many as are shown."""
    kept: list[Match] = []
    for match in matches:
        if not any(set(match.names) & set(other.names) for other in kept):
            kept.append(match)
        if len(kept) > ALTERNATIVES:
            break
    return kept


def rms(values: Iterable[float]) -> float:
    return sqrt(float(np.mean(np.square(list(values)))))


def both_arms(errors: Mapping[Side, tuple[float, float]]) -> dict[str, float]:
    return {
        f"{side} {bone}": error
        for side, pair in errors.items()
        for bone, error in zip(("upper arm", "forearm"), pair, strict=True)
    }


def leg_parts(limbs: LimbDirections, side: Side, each: LegReference) -> dict[str, float]:
    thigh, shank = of_left(limbs.thigh[side], side), of_left(limbs.shank[side], side)
    upper, lower = limb_error(thigh, shank, each.upper, each.lower)
    return {f"{side} thigh": upper, f"{side} shank": lower}


def touch_penalty(limbs: LimbDirections, side: Side, each: LegReference) -> float:
    """What a toe that is on the floor, or is not, adds to the square of a distance, deg^2."""
    touches = limbs.feet[side].clearance < TOUCHING
    return 0.0 if touches == each.touches else _TOUCH_DEG**2


def named_within(limbs: LimbDirections, side: Side, each: LegReference) -> float:
    """Degrees within which a leg is in a position whatever its directions say; 0 for any other.

    A toe on the floor that bears nothing is a tendu; a leg en l'air is one of few.
    """
    if each.touches and limbs.feet[side].floor is FloorContact.TOUCH:
        return _WORST_DEG
    high = each.position.name in _EN_L_AIR and _elevation(limbs.thigh[side]) > _HIGH_DEG
    return _HIGH_WITHIN_DEG if high else 0.0


def at_height(each: LegReference, limbs: LimbDirections, side: Side) -> LegPosition:
    """The position with the height that the leg really has, to the nearest 5 degrees."""
    wanted = each.position.degrees
    if wanted is None:
        return each.position
    bent = each.position.name == "attitude"
    line = limbs.thigh[side] if bent else limbs.thigh[side] + limbs.shank[side]
    ideal = each.upper if bent else each.upper + each.lower
    height = wanted + _elevation(line) - _elevation(ideal)
    low, high = heights_of(each.position)
    return replace(each.position, degrees=float(np.clip(5.0 * round(height / 5.0), low, high)))


def _elevation(direction: Vector) -> float:
    """Angle from hanging, degrees."""
    return degrees(float(np.arccos(np.clip(-direction[2] / np.linalg.norm(direction), -1, 1))))


def limb_error(
    upper: Vector, lower: Vector, wanted_upper: Vector, wanted_lower: Vector
) -> tuple[float, float]:
    """Angles in degrees: between the upper bones, and between the lower ones when those agree."""
    carried = _carried(wanted_lower, wanted_upper, upper)
    return angle_between(upper, wanted_upper), angle_between(lower, carried)


def _carried(vector: Vector, start: Vector, end: Vector) -> Vector:
    """A vector turned by the shortest rotation from `start` to `end`."""
    cosine = float(start @ end)
    if cosine < -0.999:
        return vector
    axis = np.cross(start, end)
    across = np.cross(axis, vector)
    return np.asarray(vector + across + np.cross(axis, across) / (1.0 + cosine))


def of_left(vector: Vector, side: Side) -> Vector:
    """A direction of one side as its mirror image on the left."""
    return vector if side is Side.LEFT else np.array([1.0, -1.0, 1.0]) * vector


def turned(found: Orientation, wanted: Orientation, mirrored: bool) -> float:
    """Angle of the rotation between two orientations, degrees."""
    if mirrored:
        wanted = Orientation(-wanted.turn, -wanted.tilt, wanted.bend)
    one, other = (
        turn_tilt_bend(np.radians([each.turn, each.tilt, each.bend])) for each in (found, wanted)
    )
    return degrees(float(Rotation.from_matrix(one.T @ other).magnitude()))


def leg_names(position: LegPosition) -> tuple[str, ...]:
    """The name and, for a straight leg behind, both words that ballet has for it."""
    height = "" if position.degrees is None else f" {format_number(position.degrees)}"
    names = [position.name]
    if position.name in ("raised", "arabesque") and position.direction == "derrière":
        names.append("arabesque" if position.name == "raised" else "raised")
        if position.degrees is not None and position.degrees >= _ARABESQUE_DEG:
            names.sort()
    return tuple(f"{name} {position.direction}{height}" for name in names)


def at_listed_height(name: str) -> str:
    """The name of a leg's position with the nearest height that the vocabulary lists it with."""
    base, _, height = name.rpartition(" ")
    if not height.replace(".", "").isdigit():
        return name
    listed = [each.rpartition(" ")[2] for each in vocabulary("leg") if each.startswith(f"{base} ")]
    return f"{base} {min(listed, key=lambda each: abs(float(each) - float(height)))}"


_EN_L_AIR = ("raised", "arabesque", "attitude")
_ARABESQUE_DEG = 75.0
"""A straight leg behind is called an arabesque from here on."""
