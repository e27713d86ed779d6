"""Naming a pose: which position of the vocabulary it is, or which is nearest and how far.

Poses are compared limb by limb, by the directions of the bones and not by where hands and feet end
up, so that a tall dancer and a small one, or one from motion capture, compare alike. Of a limb, the
upper bone counts by the angle between its directions, the lower one by the angle that is left when
the upper ones are laid on each other: errors of a shoulder are then not counted twice. The distance
of a position is the root mean square of its angles.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from math import degrees, sqrt

import mujoco
import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.spatial.transform import Rotation

from enpointe.models.dancer import dancer_model
from enpointe.models.footing import DEMI_PLIE_DEG
from enpointe.models.joints import Joints
from enpointe.models.limbs import LimbDirections
from enpointe.models.reading import ReadFrame, distances_to_feet, read_joints
from enpointe.models.references import LegReference, References
from enpointe.models.style import Style
from enpointe.models.target import turn_tilt_bend
from enpointe.notation import (
    ArmsPosition,
    Bend,
    FeetPosition,
    LegPosition,
    Orientation,
    PosePosition,
    Side,
)
from enpointe.notation.vocabulary import POSES, PoseEntry
from enpointe.notation.writer import format_number

__all__ = ["Match", "Recogniser", "Recognition", "recognise", "recognise_joints"]

Vector = NDArray[np.float64]
Position = FeetPosition | ArmsPosition | LegPosition | PosePosition
_NAMED_DEG = 14.0
_WORST_DEG = 32.0
"""A position is named when its limbs are within the first of these together and within the second
each: halfway between the rms of 5 degrees of noise in every joint, about 7, and the 20 and more
that most neighbours in the vocabulary are apart."""
_NAMED_CM = 7.0
"""The same for the feet: half of what a heel shifts from third to fifth position, twice over."""
_SAME_DEG = 4.0
"""Positions no farther apart than this are one class with several names."""
_FACING_SHARE = 0.3
"""How much a degree of facing counts against a degree of a limb where names differ in it only."""
_ANYWHERE_DEG = 22.5
"""What a position that may face anywhere counts as being off its facing: half an eighth."""
_CLEARANCE_DEG_PER_CM = 1.5
"""What tells a tendu from a dégagé is the toe's height: how many degrees a centimetre counts as."""
_OFF_FLOOR_CM = 2.0
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


@dataclass(frozen=True)
class Recognition:
    """What a pose is called, part by part.

    Attributes:
        feet: The position of the feet; None unless both bear weight.
        arms: The position of both arms.
        each_arm: The place of each arm for itself.
        legs: The position of each leg that bears no weight.
        pose: The position of the whole body; None unless exactly one leg bears weight.
        alternatives: The next best of each part: "feet", "arms", "left leg", "right leg", "pose".
        signs: The raw signs that the pose was read as.
    """

    feet: Match | None
    arms: Match
    each_arm: Mapping[Side, Match]
    legs: Mapping[Side, Match]
    pose: Match | None
    alternatives: Mapping[str, tuple[Match, ...]]
    signs: ReadFrame

    @property
    def name(self) -> str:
        """The pose in words, such as "feet fifth right front, arms fifth en haut"."""
        if self.pose is not None and self.pose.named:
            return f"pose {self.pose.name}"
        parts = [] if self.feet is None else [f"feet {self.feet}"]
        parts += [f"{side} leg {match}" for side, match in self.legs.items()]
        return ", ".join([*parts, f"arms {self.arms}"])

    @property
    def distance(self) -> float:
        """Of what `name` says of limbs, degrees: the largest of its parts."""
        if self.pose is not None and self.pose.named:
            return self.pose.distance
        return max(match.distance for match in (self.arms, *self.legs.values()))

    @property
    def named(self) -> bool:
        """Whether every part has a name."""
        if self.pose is not None and self.pose.named:
            return True
        parts = (self.feet, self.arms, *self.legs.values())
        return all(match.named for match in parts if match is not None)


def recognise(model: mujoco.MjModel, qpos: ArrayLike) -> Recognition:
    """Name one configuration of a dancer.

    Args:
        model: The dancer.
        qpos: (nq,); any, legal or not.

    Raises:
        PoseError: A configuration of another size, or one that is not finite.

    Example:
        >>> from enpointe.models import dancer_model
        >>> from enpointe.models.recognition import recognise
        >>> model = dancer_model(flesh=False)
        >>> recognise(model, model.key("standing").qpos).arms.named
        False
    """
    return _recogniser(model).recognise(qpos)


def recognise_joints(joints: Joints, model: mujoco.MjModel | None = None) -> Recognition:
    """Name a pose of any dancer, such as one from motion capture.

    Args:
        joints: Where her joints are.
        model: Whose vocabulary it is compared with; a dancer of 1.68 m if None.
    """
    return _recogniser(dancer_model(flesh=False) if model is None else model).of_joints(joints)


class Recogniser:
    """Names poses of one dancer; the vocabulary is laid out once, which takes seconds.

    Args:
        model: The dancer.
    """

    def __init__(self, model: mujoco.MjModel) -> None:
        self.model = model
        self.references = References(model)
        self.figure = self.references.figure
        self._alike = _pose_classes(self)

    def recognise(self, qpos: ArrayLike) -> Recognition:
        """Name one configuration (nq,)."""
        return self.of_joints(Joints.of(self.model, qpos))

    def of_joints(self, joints: Joints) -> Recognition:
        """Name a pose of any dancer."""
        signs = read_joints(joints, self.figure)
        limbs = signs.limbs
        every = {"arms": self._arms(limbs)}
        if signs.feet is not None:
            every["feet"] = self._feet(joints, limbs)
        legs = [side for side in Side if not limbs.feet[side].bears]
        for side in legs:
            every[f"{side} leg"] = self._leg(limbs, side)
        if limbs.working is not None:
            every["pose"] = self._poses(limbs, limbs.working)
        best = {part: matches[0] for part, matches in every.items()}
        return Recognition(
            feet=best.get("feet"),
            arms=best["arms"],
            each_arm={side: self._one_arm(limbs, side) for side in Side},
            legs={side: best[f"{side} leg"] for side in legs},
            pose=best.get("pose"),
            alternatives={part: tuple(matches[1:]) for part, matches in every.items()},
            signs=signs,
        )

    def _arm_errors(self, limbs: LimbDirections) -> dict[tuple[Side, str], tuple[float, float]]:
        return {
            (side, name): _limb_error(
                _of_left(limbs.upper_arm[side], side),
                _of_left(limbs.forearm[side], side),
                place.upper,
                place.lower,
            )
            for side in Side
            for name, place in self.references.arm_places.items()
        }

    def _arms(self, limbs: LimbDirections) -> list[Match]:
        errors = self._arm_errors(limbs)
        found = []
        for each in self.references.arms:
            parts = _both_arms({side: errors[side, each.places[side]] for side in Side})
            found.append(_match(each.position, (_arms_name(each.position),), parts))
        return _best(found)

    def _one_arm(self, limbs: LimbDirections, side: Side) -> Match:
        errors = self._arm_errors(limbs)
        found = []
        for each in self.references.arms:
            upper, lower = errors[side, each.places[side]]
            parts = {f"{side} upper arm": upper, f"{side} forearm": lower}
            found.append(_match(each.position, (each.places[side],), parts))
        return min(found, key=lambda match: match.distance)

    def _feet(self, joints: Joints, limbs: LimbDirections) -> list[Match]:
        found = []
        for each in distances_to_feet(joints, limbs, self.figure):
            cm = 100.0 * each.metres
            name = _feet_name(each.position)
            found.append(
                Match(each.position, (name,), cm, "cm", "one foot", cm, cm < _NAMED_CM)
            )
        return found[: ALTERNATIVES + 1]

    def _leg(self, limbs: LimbDirections, side: Side) -> list[Match]:
        best: dict[LegPosition, tuple[float, Match]] = {}
        for each in self.references.legs:
            parts = _leg_parts(limbs, side, each)
            rank = sum(e**2 for e in parts.values()) + _clearance(limbs, side, each)
            position = _at_height(each, limbs, side)
            if position not in best or rank < best[position][0]:
                best[position] = rank, _match(position, _leg_names(position), parts)
        ranked = sorted(best.values(), key=lambda each: each[0])
        return _without_doubles(match for _, match in ranked)

    def _poses(self, limbs: LimbDirections, working: Side) -> list[Match]:
        support = working.other
        found: list[tuple[float, Match]] = []
        arms = self._arm_errors(limbs)
        for entry in POSES:
            parts = self._pose_parts(entry, limbs, working, arms)
            off = _ANYWHERE_DEG
            if entry.facing is not None:
                facing = entry.facing if support is Side.LEFT else -entry.facing
                off = abs((limbs.facing_degrees - facing + 180.0) % 360.0 - 180.0)
            position = PosePosition(entry.name, support)
            names = [entry.name, *self._alike[entry.name]]
            match = _match(position, tuple(f"{name} on {support}" for name in names), parts)
            rank = sum(e**2 for e in parts.values()) + (_FACING_SHARE * off) ** 2
            found.append((rank, match))
        return [match for _, match in sorted(found, key=lambda each: each[0])][: ALTERNATIVES + 1]

    def _pose_parts(
        self,
        entry: PoseEntry,
        limbs: LimbDirections,
        working: Side,
        arms: Mapping[tuple[Side, str], tuple[float, float]],
    ) -> dict[str, float]:
        mirrored = working is Side.LEFT
        leading = entry.leading.other if mirrored and entry.leading else entry.leading
        wanted = ArmsPosition(entry.arms, leading)
        places = next(ref.places for ref in self.references.arms if ref.position == wanted)
        parts = _both_arms({side: arms[side, places[side]] for side in Side})
        legs = [
            (_leg_parts(limbs, working, each), _clearance(limbs, working, each))
            for each in self.references.legs
            if each.position == replace(entry.leg, at=None)
        ]
        parts |= min(legs, key=lambda leg: sum(e**2 for e in leg[0].values()) + leg[1])[0]
        bend = limbs.feet[working.other].bend
        if (bend is Bend.STRAIGHT) != (entry.bend is Bend.STRAIGHT):
            parts[f"{working.other} knee"] = Style().demi_plie_deg - 0.5 * DEMI_PLIE_DEG
        parts["head"] = _turned(limbs.head, entry.head, mirrored)
        parts["body"] = _turned(limbs.body, entry.body, mirrored)
        return parts


_KNOWN: dict[int, Recogniser] = {}
_MOST_KNOWN = 4


def _recogniser(model: mujoco.MjModel) -> Recogniser:
    """The recogniser of a model; it holds the model, so that its id stays its own."""
    if id(model) not in _KNOWN:
        while len(_KNOWN) >= _MOST_KNOWN:
            del _KNOWN[next(iter(_KNOWN))]
        _KNOWN[id(model)] = Recogniser(model)
    return _KNOWN[id(model)]


def _pose_classes(recogniser: Recogniser) -> dict[str, tuple[str, ...]]:
    """Poses whose limbs are alike, so that only facing tells them apart, by name."""

    def alike(one: PoseEntry, other: PoseEntry) -> bool:
        same = one.leg == other.leg and one.arms == other.arms and one.leading == other.leading
        head = _turned(one.head, other.head, False)
        body = _turned(one.body, other.body, False)
        angles = (0.0,) * 6 + (head, body)
        return same and one.bend == other.bend and _rms(angles) < _SAME_DEG

    return {
        one.name: tuple(o.name for o in POSES if o.name != one.name and alike(one, o))
        for one in POSES
    }


def _match(position: Position, names: tuple[str, ...], parts: Mapping[str, float]) -> Match:
    worst = max(parts, key=lambda part: parts[part])
    distance = _rms(parts.values())
    named = distance < _NAMED_DEG and parts[worst] < _WORST_DEG
    return Match(position, names, distance, "deg", worst, parts[worst], named)


def _best(matches: list[Match]) -> list[Match]:
    return sorted(matches, key=lambda match: match.distance)[: ALTERNATIVES + 1]


def _without_doubles(matches: Iterable[Match]) -> list[Match]:
    """The first of each set of names, as many as are shown."""
    kept: list[Match] = []
    for match in matches:
        if not any(set(match.names) & set(other.names) for other in kept):
            kept.append(match)
        if len(kept) > ALTERNATIVES:
            break
    return kept


def _rms(values: Iterable[float]) -> float:
    return sqrt(float(np.mean(np.square(list(values)))))


def _both_arms(errors: Mapping[Side, tuple[float, float]]) -> dict[str, float]:
    return {
        f"{side} {bone}": error
        for side, pair in errors.items()
        for bone, error in zip(("upper arm", "forearm"), pair, strict=True)
    }


def _leg_parts(limbs: LimbDirections, side: Side, each: LegReference) -> dict[str, float]:
    thigh, shank = _of_left(limbs.thigh[side], side), _of_left(limbs.shank[side], side)
    upper, lower = _limb_error(thigh, shank, each.upper, each.lower)
    return {f"{side} thigh": upper, f"{side} shank": lower}


def _clearance(limbs: LimbDirections, side: Side, each: LegReference) -> float:
    """What the height of the toe adds to the square of a distance, deg^2."""
    if each.touches is None:
        return 0.0
    cm = 100.0 * limbs.feet[side].clearance
    off = cm if each.touches else max(_OFF_FLOOR_CM - cm, 0.0)
    return (_CLEARANCE_DEG_PER_CM * off) ** 2


def _at_height(each: LegReference, limbs: LimbDirections, side: Side) -> LegPosition:
    """The position with the height that the leg really has, to the nearest 5 degrees."""
    wanted = each.position.degrees
    if wanted is None:
        return each.position
    bent = each.position.name == "attitude"
    line = limbs.thigh[side] if bent else limbs.thigh[side] + limbs.shank[side]
    ideal = each.upper if bent else each.upper + each.lower
    height = wanted + _elevation(line) - _elevation(ideal)
    low, high = (45.0, 120.0) if bent else (40.0, 150.0)
    return replace(each.position, degrees=float(np.clip(5.0 * round(height / 5.0), low, high)))


def _elevation(direction: Vector) -> float:
    """Angle from hanging, degrees."""
    return degrees(float(np.arccos(np.clip(-direction[2] / np.linalg.norm(direction), -1, 1))))


def _limb_error(
    upper: Vector, lower: Vector, wanted_upper: Vector, wanted_lower: Vector
) -> tuple[float, float]:
    """Angles in degrees: between the upper bones, and between the lower ones when those agree."""
    carried = _carried(wanted_lower, wanted_upper, upper)
    return _angle(upper, wanted_upper), _angle(lower, carried)


def _carried(vector: Vector, start: Vector, end: Vector) -> Vector:
    """A vector turned by the shortest rotation from `start` to `end`."""
    cosine = float(start @ end)
    if cosine < -0.999:
        return vector
    axis = np.cross(start, end)
    across = np.cross(axis, vector)
    return np.asarray(vector + across + np.cross(axis, across) / (1.0 + cosine))


def _angle(one: Vector, other: Vector) -> float:
    return degrees(float(np.arccos(np.clip(one @ other, -1.0, 1.0))))


def _of_left(vector: Vector, side: Side) -> Vector:
    """A direction of one side as its mirror image on the left."""
    return vector if side is Side.LEFT else np.array([1.0, -1.0, 1.0]) * vector


def _turned(found: Orientation, wanted: Orientation, mirrored: bool) -> float:
    """Angle of the rotation between two orientations, degrees."""
    if mirrored:
        wanted = Orientation(-wanted.turn, -wanted.tilt, wanted.bend)
    one, other = (
        turn_tilt_bend(np.radians([each.turn, each.tilt, each.bend])) for each in (found, wanted)
    )
    return degrees(float(Rotation.from_matrix(one.T @ other).magnitude()))


def _arms_name(position: ArmsPosition) -> str:
    return position.name + (f" {position.leading} leads" if position.leading else "")


def _feet_name(position: FeetPosition) -> str:
    opened = " open" if position.open else ""
    return position.name + opened + (f" {position.front} front" if position.front else "")


def _leg_names(position: LegPosition) -> tuple[str, ...]:
    """The name and, for a straight leg behind, both words that ballet has for it."""
    height = "" if position.degrees is None else f" {format_number(position.degrees)}"
    names = [position.name]
    if position.name in ("raised", "arabesque") and position.direction == "derrière":
        names.append("arabesque" if position.name == "raised" else "raised")
        if position.degrees is not None and position.degrees >= _ARABESQUE_DEG:
            names.sort()
    return tuple(f"{name} {position.direction}{height}" for name in names)


_ARABESQUE_DEG = 75.0
"""A straight leg behind is called an arabesque from here on."""
