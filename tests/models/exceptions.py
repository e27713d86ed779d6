"""What a dancer does not hold yet, pose by pose and with its reason; everything else is held.

Each entry is an upper bound: a pose may break the rules named here and no other, and is legal all
the same. An entry that nothing needs any more should go.
"""

from __future__ import annotations

from enpointe.notation import Bend, FloorContact, ResolvedFrame

__all__ = ["OVERLAPS", "allowed", "how_it_stands"]

KNEE, PELVIS, BODY = "knee over the toe", "pelvis as written", "body as written"
WEIGHT, ON_ONE = "weight in the middle", "weight over the foot"
ALL = ("perfect", "real", "tall man", "small woman")


def _all(rules: set[str]) -> dict[str, set[str]]:
    return dict.fromkeys(ALL, rules)


_ALLOWED: dict[str, dict[str, set[str]]] = {
    # Feet turned out 66 degrees under knees that turn out 62 at most and less as the hip bends; the
    # wider the feet, the farther the knees fall in.
    "second demi-plié": _all({KNEE}),
    "second grand plié": {"perfect": {KNEE, WEIGHT}, "real": {KNEE, WEIGHT}},
    "second demi-pointe demi-plié": _all({KNEE}),
    "third demi-pointe demi-plié": _all({KNEE}),
    "fifth demi-pointe demi-plié": _all({KNEE}),
    "fourth demi-pointe demi-plié": _all({KNEE}),
    "fourth open demi-pointe demi-plié": _all({KNEE}),
    "one foot grand plié": {"perfect": {KNEE}},
    # A real hip turns out 54: 12 degrees of a shank's 0.4 m are 80 mm.
    "first demi-plié": {"real": {KNEE}},
    "first grand plié": {"real": {KNEE}},
    "first demi-pointe demi-plié": {"real": {KNEE}},
    "third demi-plié": {"real": {KNEE}},
    "third grand plié": {"real": {KNEE}},
    "fifth grand plié": {"real": {KNEE}},
    # A whole foot apart, both heels down and both ankles at the end of their range: the hips turn
    # to the back foot and the weight stays there.
    "fourth demi-plié": _all({PELVIS, KNEE, WEIGHT}),
    "fourth grand plié": _all({PELVIS, KNEE}),
    "fourth open demi-plié": _all({PELVIS, KNEE, WEIGHT}),
    # The tall man's feet are longer and his ankles end where hers do: his weight stays behind.
    "fifth demi-plié": {"real": {KNEE}, "tall man": {PELVIS, KNEE, WEIGHT}},
    "one foot demi-plié": {"tall man": {ON_ONE}},
    # The foot on pointe is asked to stand upright under a leg that does not: the ankle's 85 degrees
    # are used up and the pelvis tips. In second this is far from what a dancer shows.
    "first pointe": _all({BODY, PELVIS}),
    "second pointe": _all({BODY, PELVIS}),
    "fourth pointe": {"real": {WEIGHT}},
    "fourth open pointe": {"real": {WEIGHT}},
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
