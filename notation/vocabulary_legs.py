"""Named positions of the working leg, each a macro over the signs of ankle and knee.

The figures are those of a dancer of 1.68 m (all in metres): hip .850 above the floor and .083 from
the centre line, knee .493, shoulder 1.331 and crown 1.680 above the floor; thigh .357, shank .419,
pointed foot .190 beyond the ankle. No source prints them; what the sources say in words stands with
each position.

A leg goes out to second in the plane of the body, as the perfectly turned-out leg does: a knee sign
of a bent leg is level, and the foot in front of it, level with it or behind. A body turned out less
brings it forward. In front and behind, the foot finds the centre line.
"""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Mapping
from dataclasses import dataclass, replace
from math import cos, radians, sin

from enpointe.notation.signs import Depth, Direction, FloorContact, LegPosition, Sign, Support

__all__ = ["DIRECTIONS", "LEGS", "LegEntry", "LegSigns", "expand_leg"]


@dataclass(frozen=True, slots=True)
class LegSigns:
    """What a named position means for one leg.

    Attributes:
        foot: The ankle's sign; at height 1 for a foot on the floor.
        knee: The knee's sign; None for a straight leg.
        support: How the foot touches the floor; None in the air.
    """

    foot: Sign
    knee: Sign | None = None
    support: Support | None = None


@dataclass(frozen=True, slots=True)
class LegEntry:
    """A named position of the working leg.

    Attributes:
        name: The name that scores are written with.
        directions: Where the leg can be.
        description: One line for people.
        source: Where the position is defined.
        aliases: Other names for exactly this position.
        degrees: Least, usual and greatest height; None for a position with one height only.
    """

    name: str
    directions: tuple[Direction, ...]
    description: str
    source: str
    aliases: tuple[str, ...] = ()
    degrees: tuple[float, float, float] | None = None


_ALL = tuple(Direction)
_DEVANT, _SECONDE, _DERRIERE = _ALL

LEGS: tuple[LegEntry, ...] = (
    LegEntry(
        "tendu",
        _ALL,
        "straight, the pointed toe on the floor without weight",
        "Grant, battement tendu",
        ("pointe tendue", "à terre"),
    ),
    LegEntry(
        "dégagé",
        _ALL,
        "straight, the pointed toe just off the floor",
        "Grant, dégagé (a few cm); the amount, 35 degrees, is ours",
        ("RAD glissé", "glissé", "Vaganova jeté"),
    ),
    LegEntry(
        "pointed",
        _ALL,
        "straight down off the floor, the foot pointed, as in the air of a jump: in second under "
        "its own hip, in front or behind as in the fifth",
        "Grant, sauté and soubresaut; the name is ours",
    ),
    LegEntry(
        "raised",
        _ALL,
        "straight, at its height in degrees: 45 demi-hauteur, 90 à la hauteur, above extended",
        "Grant, en l'air and hauteur",
        ("en l'air", "à la hauteur", "grand battement", "développé"),
        (36.0, 90.0, 150.0),
    ),
    LegEntry(
        "cou-de-pied",
        (_DEVANT, _DERRIERE),
        "the foot at the ankle of the supporting leg, the thigh turned out to second",
        "Grant, cou-de-pied",
        ("sur le cou-de-pied", "coupé"),
    ),
    LegEntry(
        "retiré",
        _ALL,
        "the toe at the knee of the supporting leg, the thigh raised to second",
        "Grant, retiré",
        ("passé",),
    ),
    LegEntry(
        "attitude",
        _ALL,
        "the knee bent at a right angle; behind, it is higher than the foot",
        "Grant, attitude",
        (),
        (60.0, 90.0, 110.0),
    ),
    LegEntry(
        "arabesque",
        (_DERRIERE,),
        "straight behind, at a right angle to the supporting leg",
        "Grant, arabesque",
        (),
        (45.0, 90.0, 150.0),
    ),
)

DIRECTIONS: Mapping[Direction, tuple[str, ...]] = {
    _DEVANT: ("devant", "fourth devant", "à la quatrième devant", "quatrième devant", "front"),
    _SECONDE: ("seconde", "à la seconde", "second", "de côté", "side"),
    _DERRIERE: (
        "derrière",
        "fourth derrière",
        "à la quatrième derrière",
        "quatrième derrière",
        "back",
    ),
}
"""Words for the three directions; the first is the one that scores are written with."""

_LINES = (0.0, 0.493, 0.850, 1.331, 1.680)
_HIP = _LINES[2]
_HIP_ASIDE = 0.083
_THIGH, _SHANK = 0.357, 0.419
_LEG = _THIGH + _SHANK
_REACH = _HIP_ASIDE + _LEG

_DEPTH = {_DEVANT: Depth.FRONT, _SECONDE: Depth.LEVEL, _DERRIERE: Depth.BEHIND}
_DEGAGE = 35.0

# Pointed: straight down, .776 below the hip; crossed in the fifth, .083 aside and .050 ahead too.
#
# The thigh at height h and the toe at a given place leave a triangle of thigh (.357), shank with
# pointed foot (.609) and hip-to-toe, the thigh in the plane of the body. Retiré: the toe at the
# height of the knee (.493), .033 beyond the centre line, where the inside of the supporting knee
# is, or in front of and behind it (.060 beyond, .060 ahead). Cou-de-pied: the toe at .120, .060
# beyond and .070 ahead. The ankle is .190/.609 of the way back to the knee.
_FIXED = {
    ("pointed", _DEVANT): (Sign(0.0, 1.162, Depth.FRONT), None),
    ("pointed", _SECONDE): (Sign(0.097, 1.152, Depth.LEVEL), None),
    ("pointed", _DERRIERE): (Sign(0.0, 1.162, Depth.BEHIND), None),
    ("retiré", _DEVANT): (Sign(0.112, 2.299, Depth.FRONT), Sign(0.512, 2.959, Depth.LEVEL)),
    ("retiré", _SECONDE): (Sign(0.133, 2.336, Depth.LEVEL), Sign(0.511, 3.057, Depth.LEVEL)),
    ("retiré", _DERRIERE): (Sign(0.112, 2.299, Depth.BEHIND), Sign(0.512, 2.959, Depth.LEVEL)),
    ("cou-de-pied", _DEVANT): (Sign(0.070, 1.539, Depth.FRONT), Sign(0.377, 2.262, Depth.LEVEL)),
    ("cou-de-pied", _DERRIERE): (
        Sign(0.070, 1.539, Depth.BEHIND),
        Sign(0.377, 2.262, Depth.LEVEL),
    ),
}

_OUTWARD = {_DEVANT: 30.0, _SECONDE: 65.0, _DERRIERE: 40.0}
"""How far an attitude's thigh is from straight ahead or behind, towards the side, degrees: ours. At
40 the foot behind ends near the centre line, a little under the knee; to the side the thigh stays
before the plane of the body, since no hip turns out the 90 degrees that would bring the foot up."""
_TURNED_OUT = 60.0
"""Outward turn of an attitude's thigh about itself, degrees (elite hips, 52, and the shin)."""


def expand_leg(position: LegPosition, entry: LegEntry) -> LegSigns:
    """Expands a named position of a working leg.

    Args:
        position: Its direction is one of the entry's.
        entry: The position's entry; its usual height is taken where none is given.

    Returns:
        The signs, located where the position was written.
    """
    direction = position.direction or entry.directions[0]
    degrees = position.degrees
    if degrees is None:
        degrees = entry.degrees[1] if entry.degrees else _DEGAGE
    if (entry.name, direction) in _FIXED:
        foot, knee = _FIXED[entry.name, direction]
        signs = LegSigns(foot, knee)
    elif entry.name == "attitude":
        signs = _attitude(direction, degrees)
    elif entry.name == "tendu":
        foot = replace(_straight(direction, _DEGAGE), height=1.0)
        signs = LegSigns(foot, None, Support(FloorContact.TOUCH, at=position.at))
    else:
        signs = LegSigns(_straight(direction, degrees))
    located = signs.knee and replace(signs.knee, at=position.at)
    return replace(signs, foot=replace(signs.foot, at=position.at), knee=located)


def _straight(direction: Direction, degrees: float) -> Sign:
    """The ankle of a straight leg raised so far from hanging."""
    aside = _HIP_ASIDE + _LEG * sin(radians(degrees)) if direction is _SECONDE else 0.0
    return _sign(aside, _HIP - _LEG * cos(radians(degrees)), _DEPTH[direction])


def _attitude(direction: Direction, degrees: float) -> LegSigns:
    """The thigh t raised by the degrees, and the shank where a turned-out knee bends to.

    A hanging knee faces ahead. Swung to t by the shortest way and turned out by e about t it faces
    f; the shank of a right-angled knee points away from it, along -f.
    """
    ahead = -1.0 if direction is _DERRIERE else 1.0
    a, p, e = radians(degrees), radians(_OUTWARD[direction]), radians(_TURNED_OUT)
    thigh = (ahead * sin(a) * cos(p), sin(a) * sin(p), -cos(a))
    front, side = (_swung(axis, thigh) for axis in ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0)))
    shank = tuple(-cos(e) * f - sin(e) * s for f, s in zip(front, side, strict=True))
    knee_ahead, knee_aside, knee_up = (_THIGH * t for t in thigh)
    foot_ahead, foot_aside, foot_up = (
        _THIGH * t + _SHANK * s for t, s in zip(thigh, shank, strict=True)
    )
    knee = _sign(_HIP_ASIDE + knee_aside, _HIP + knee_up, _depth(knee_ahead))
    foot = _sign(_HIP_ASIDE + foot_aside, _HIP + foot_up, _depth(foot_ahead - knee_ahead))
    return LegSigns(foot, knee)


def _depth(ahead: float) -> Depth:
    return Depth.FRONT if ahead >= 0.0 else Depth.BEHIND


def _swung(
    v: tuple[float, float, float], thigh: tuple[float, float, float]
) -> tuple[float, float, float]:
    """Where a direction goes by the shortest swing that takes straight down to `thigh`."""
    wx, wy, share = thigh[1], -thigh[0], 1.0 / (1.0 - thigh[2])
    x, y, z = v
    cx, cy, cz = wy * z, -wx * z, wx * y - wy * x
    dx, dy, dz = wy * cz, -wx * cz, wx * cy - wy * cx
    return (x + cx + share * dx, y + cy + share * dy, z + cz + share * dz)


def _sign(aside: float, up: float, depth: Depth) -> Sign:
    """The sign of a point, metres from the centre line and above the floor."""
    line = min(bisect_right(_LINES, up), len(_LINES) - 1)
    low, high = _LINES[line - 1 : line + 1]
    height = line + (up - low) / (high - low)
    return Sign(round(aside / _REACH, 3), round(height, 3), depth)
