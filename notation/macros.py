"""A user's own names for positions, each a macro that a score is read with.

A score that uses one keeps what it stands for, not its name: it needs no vocabulary afterwards.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace

from enpointe.notation.frame import Frame
from enpointe.notation.resolving import overlaid
from enpointe.notation.signs import Bend, Side
from enpointe.notation.spelling import close_to, fold
from enpointe.notation.vocabulary import Part, arm_signs, feet_signs, leg_signs

__all__ = ["Vocabulary", "laid_under"]


@dataclass(frozen=True, slots=True)
class Vocabulary:
    """Names that a user adds.

    Attributes:
        macros: What each stands for, by part ("arms", "leg" or "pose") and folded name, written for
            the right: the right arm leading, the right leg working, or standing on the right leg.
        spellings: The names as their user wrote them, by the same keys.
    """

    macros: Mapping[tuple[str, str], Frame] = field(default_factory=dict, hash=False)
    spellings: Mapping[tuple[str, str], str] = field(default_factory=dict, hash=False)

    def find(self, name: str, part: Part) -> Frame | None:
        """What a name stands for, written for the right; None for an unknown one."""
        return self.macros.get((part, fold(name))) if self.macros else None

    def names(self, part: Part) -> tuple[str, ...]:
        """The names of a part, in the order of their file."""
        return tuple(name for (kind, _), name in self.spellings.items() if kind == part)

    def nearest(self, name: str, part: Part) -> tuple[str, ...]:
        """The names most like one that isn't known."""
        return close_to(name, {fold(each): each for each in self.names(part)})


def laid_under(under: Frame, over: Frame) -> Frame:
    """A macro's frame under what a frame writes itself, in parts that don't contradict each other.

    A named position of which one limb is overridden goes over into the signs of the other limb.
    """
    frame = overlaid(under, over)
    hands, elbows = dict(frame.hands), dict(frame.elbows)
    arms = frame.arms
    if arms is not None and (hands or elbows or frame.contacts):
        for side, sign in arm_signs(arms).items():
            if side not in hands and side not in frame.contacts:
                hands[side] = sign
        arms = None
    for side in elbows:
        if side in hands:
            hands[side] = replace(hands[side], straight=False)
    foot_signs, legs = dict(frame.foot_signs), dict(frame.legs)
    feet, support = frame.feet, dict(frame.support)
    for side in [side for side in legs if side in frame.knees]:
        signs = leg_signs(legs.pop(side))
        foot_signs[side] = signs.foot
        if signs.support is not None:
            support[side] = signs.support
    if feet is not None and (foot_signs or legs):
        for side, sign in feet_signs(feet).items():
            if side not in foot_signs and side not in legs:
                foot_signs[side] = sign
        feet = None
    for side in Side:
        if side in support and side in frame.knees:
            support[side] = replace(support[side], bend=Bend.STRAIGHT)
    return replace(
        frame,
        arms=arms,
        hands=hands,
        elbows=elbows,
        feet=feet,
        foot_signs=foot_signs,
        legs=legs,
        support=support,
    )
