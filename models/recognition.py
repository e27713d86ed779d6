"""Naming a pose: which position of the vocabulary it is, or which is nearest and how far.

Poses are compared limb by limb, by the directions of the bones and not by where hands and feet end
up, so that a tall dancer and a small one, or one from motion capture, compare alike. Of a limb, the
upper bone counts by the angle between its directions, the lower one by the angle that is left when
the upper ones are laid on each other: errors of a shoulder are then not counted twice. The distance
of a position is the root mean square of its angles.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

import mujoco
import numpy as np
from numpy.typing import ArrayLike, NDArray

from enpointe.models.dancer import dancer_model
from enpointe.models.footing import DEMI_PLIE_DEG
from enpointe.models.joints import Joints
from enpointe.models.limbs import LimbDirections
from enpointe.models.matching import (
    ALTERNATIVES,
    Match,
    at_height,
    at_listed_height,
    both_arms,
    leg_names,
    leg_parts,
    limb_error,
    match_of,
    named_within,
    nearest,
    of_left,
    rms,
    touch_penalty,
    turned,
    without_doubles,
)
from enpointe.models.reading import ReadFrame, distances_to_feet, read_joints
from enpointe.models.references import References
from enpointe.models.style import Style
from enpointe.notation import (
    ArmsPosition,
    Bend,
    LegPosition,
    PosePosition,
    Side,
)
from enpointe.notation.vocabulary import POSES, PoseEntry
from enpointe.notation.writer import arms_name, feet_name

__all__ = ["Match", "Recogniser", "Recognition", "recognise", "recognise_joints", "recogniser_of"]

Vector = NDArray[np.float64]
_NAMED_CM = 7.0
"""Feet no farther than this from a position are named: about as far as third is from fifth."""
_SAME_DEG = 4.0
"""Positions no farther apart than this are one class with several names."""
_FACING_SHARE = 0.3
"""How much a degree of facing counts against a degree of a limb where names differ in it only."""
_ANYWHERE_DEG = 22.5
"""What a position that may face anywhere counts as being off its facing: half an eighth."""


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

    def is_called(self, name: str, side: Side = Side.RIGHT) -> bool:
        """Whether a part of this pose is a position of the vocabulary.

        Args:
            name: With its part in front, as `enpointe.notation.names` lists it: "feet fifth", "arms
                fourth en haut", "leg raised devant 90", "pose first arabesque". A height means the
                nearest of those that the list has.
            side: The foot in front, the arm that leads or the leg that works.
        """
        part, _, position = name.partition(" ")
        match = {
            "feet": self.feet,
            "arms": self.arms,
            "leg": self.legs.get(side),
            "pose": self.pose,
        }.get(part)
        if match is None:
            return False
        if part == "leg":
            return position in {at_listed_height(each) for each in match.names}
        sided = {
            "feet": f"{position} {side} front",
            "arms": f"{position} {side} leads",
            "pose": f"{position} on {side.other}",
        }[part]
        return bool({position, sided} & set(match.names))


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
    return recogniser_of(model).recognise(qpos)


def recognise_joints(joints: Joints, model: mujoco.MjModel | None = None) -> Recognition:
    """Name a pose of any dancer, such as one from motion capture.

    Args:
        joints: Where her joints are.
        model: Whose vocabulary it is compared with; a dancer of 1.68 m if None.
    """
    return recogniser_of(dancer_model(flesh=False) if model is None else model).of_joints(joints)


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
            (side, name): limb_error(
                of_left(limbs.upper_arm[side], side),
                of_left(limbs.forearm[side], side),
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
            parts = both_arms({side: errors[side, each.places[side]] for side in Side})
            found.append(match_of(each.position, (arms_name(each.position),), parts))
        return nearest(found)

    def _one_arm(self, limbs: LimbDirections, side: Side) -> Match:
        errors = self._arm_errors(limbs)
        found = []
        for each in self.references.arms:
            upper, lower = errors[side, each.places[side]]
            parts = {f"{side} upper arm": upper, f"{side} forearm": lower}
            found.append(match_of(each.position, (each.places[side],), parts))
        return min(found, key=lambda match: match.distance)

    def _feet(self, joints: Joints, limbs: LimbDirections) -> list[Match]:
        found = []
        for each in distances_to_feet(joints, limbs, self.figure):
            cm = 100.0 * each.metres
            name = feet_name(each.position)
            found.append(Match(each.position, (name,), cm, "cm", "one foot", cm, cm < _NAMED_CM))
        return found[: ALTERNATIVES + 1]

    def _leg(self, limbs: LimbDirections, side: Side) -> list[Match]:
        best: dict[LegPosition, tuple[float, Match]] = {}
        for each in self.references.legs:
            if not each.fits(limbs, side):
                continue
            parts = leg_parts(limbs, side, each)
            rank = sum(e**2 for e in parts.values()) + touch_penalty(limbs, side, each)
            position = at_height(each, limbs, side)
            if position not in best or rank < best[position][0]:
                within = named_within(limbs, side, each)
                match = match_of(position, leg_names(position), parts, within=within)
                best[position] = rank, match
        ranked = sorted(best.values(), key=lambda each: each[0])
        return without_doubles(match for _, match in ranked)

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
            match = match_of(position, tuple(f"{name} on {support}" for name in names), parts)
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
        parts = both_arms({side: arms[side, places[side]] for side in Side})
        legs = [
            (leg_parts(limbs, working, each), touch_penalty(limbs, working, each))
            for each in self.references.legs
            if each.position == replace(entry.leg, at=None) and each.fits(limbs, working)
        ]
        parts |= min(legs, key=lambda leg: sum(e**2 for e in leg[0].values()) + leg[1])[0]
        bend = limbs.feet[working.other].bend
        if (bend is Bend.STRAIGHT) != (entry.bend is Bend.STRAIGHT):
            parts[f"{working.other} knee"] = Style().demi_plie_deg - 0.5 * DEMI_PLIE_DEG
        parts["head"] = turned(limbs.head, entry.head, mirrored)
        parts["body"] = turned(limbs.body, entry.body, mirrored)
        return parts


_KNOWN: dict[int, Recogniser] = {}
_MOST_KNOWN = 4


def recogniser_of(model: mujoco.MjModel) -> Recogniser:
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
        head = turned(one.head, other.head, False)
        body = turned(one.body, other.body, False)
        angles = (0.0,) * 6 + (head, body)
        return same and one.bend == other.bend and rms(angles) < _SAME_DEG

    return {
        one.name: tuple(o.name for o in POSES if o.name != one.name and alike(one, o))
        for one in POSES
    }
