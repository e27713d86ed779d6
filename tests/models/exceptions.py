"""What a dancer does not hold yet, pose by pose and with its reason; everything else is held.

Each entry is an upper bound: a pose may break the rules named here and no other, and is legal all
the same. An entry that nothing needs any more should go.
"""

from __future__ import annotations

from enpointe.notation import Bend, FloorContact, ResolvedFrame

__all__ = ["OVERLAPS", "allowed", "how_it_stands"]

KNEE, PELVIS = "knee over the toe", "pelvis as written"
WEIGHT, ON_ONE = "weight in the middle", "weight over the foot"
ALL = ("perfect", "real", "tall man", "small woman")


def _all(rules: set[str]) -> dict[str, set[str]]:
    return dict.fromkeys(ALL, rules)


_ALLOWED: dict[str, dict[str, set[str]]] = {
    # A real hip turns out 54 degrees and feet 66: 12 degrees of a shank's 0.4 m are 80 mm, of which
    # the bent hip's slack gives back the most.
    "first demi-plié": {"real": {KNEE}},
    "second demi-plié": {"real": {KNEE}},
    "third demi-plié": {"real": {KNEE}},
    "fifth demi-plié": {"real": {KNEE}, "tall man": {PELVIS, KNEE, WEIGHT}},
    "second demi-pointe demi-plié": {"real": {KNEE}},
    "third demi-pointe demi-plié": {"real": {KNEE}},
    "fifth demi-pointe demi-plié": {"real": {KNEE}},
    # The thigh of the back foot hangs behind, where the hip has no slack, and its knee falls in.
    "fourth demi-plié": _all({KNEE}),
    "fourth open demi-plié": _all({KNEE}),
    "fourth demi-pointe demi-plié": _all({KNEE}),
    "fourth open demi-pointe demi-plié": _all({KNEE}),
    # The heels stay down in second and both ankles are at the end of their range: the weight stays
    # over the heels. The tall man's feet are longer for his ankles, here, in fifth and on one foot.
    "one foot demi-plié": {"tall man": {ON_ONE}},
    "second grand plié": {**_all({KNEE, WEIGHT}), "tall man": {PELVIS, KNEE, WEIGHT}},
}

OVERLAPS: dict[tuple[str, str], float] = {
    # A stretched toe lies on the floor with its tip, whose sole is rounder than the toe: mm.
    ("floor", "tip"): 4.0,
}
"""Pairs of parts, without sides, that go deeper into one another than 2 mm, and how deep, mm."""


def how_it_stands(frame: ResolvedFrame) -> str:
    """Position, floor and bend of the legs that bear, in words: the table's key."""
    bearing = [leg for leg in frame.legs.values() if leg.bears]
    if not bearing:
        return "in the air"
    supports = [leg.support for leg in bearing if leg.support is not None]
    bend = max((s.bend for s in supports), key=list(Bend).index)
    floor = max((s.floor for s in supports), key=list(FloorContact).index)
    feet = bearing[0].position if len(bearing) == 2 else None
    words = ["one foot"] if feet is None else [feet.name, "open" if feet.open else ""]
    words += ["" if floor is FloorContact.FLAT else str(floor)]
    words += ["" if bend is Bend.STRAIGHT else str(bend)]
    return " ".join(word for word in words if word)


def allowed(frame: ResolvedFrame, who: str) -> set[str]:
    """Rules, without their side, that this dancer may break in this pose."""
    return _ALLOWED.get(how_it_stands(frame), {}).get(who, set())
