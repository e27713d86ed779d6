"""The shapes of the signs, all in one table, so that a choreologist can correct a drawing here
alone.

Units are the distance between two stave lines; x to the right, y down, the plotted point at the
origin. The page is seen from behind the dancer: the dancer's right is on the right (Neagle 2005
§4.3).

`confirmed` is True where a published description of Benesh notation gives the shape, and False
where the shape is a proposal of ours. Sizes and stroke weights are ours throughout.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

from enpointe.notation.signs import Depth, Orientation, Sign

__all__ = ["FEET_APART", "GLYPHS", "Glyph", "extremity", "joint", "orientation"]

SIGN_WEIGHT = 0.16
BEND_WEIGHT = 0.11
LEAN_WEIGHT = 0.09

STEM = 0.36
LEAN = 0.17

Stroke = tuple[float, float, float, float]


@dataclass(frozen=True, slots=True)
class Glyph:
    """A sign as straight strokes with butt ends, or as a filled disc.

    Attributes:
        strokes: Each (x1, y1, x2, y2).
        weight: Thickness of the strokes.
        radius: Radius of the disc; 0 for none.
        confirmed: Whether a published source gives the shape.
        source: That source, or what the proposal follows from.
    """

    strokes: tuple[Stroke, ...]
    weight: float
    radius: float
    confirmed: bool
    source: str


def _strokes(*strokes: Stroke, weight: float, confirmed: bool, source: str) -> Glyph:
    return Glyph(strokes, weight, 0.0, confirmed, source)


_EXTREMITY = "Neagle 2005 §4.3; Wikipedia, Benesh Movement Notation"
_BEND = "everything2, Benesh Notation; Neagle 2005 §4.3"
_LEAN = "a line in the space of its part (Wikipedia); its slant is inferred"
_OURS = "proposal; no published shape found"

GLYPHS: Mapping[str, Glyph] = {
    "level": _strokes((-0.28, 0, 0.28, 0), weight=SIGN_WEIGHT, confirmed=True, source=_EXTREMITY),
    "front": _strokes((0, -0.28, 0, 0.28), weight=SIGN_WEIGHT, confirmed=True, source=_EXTREMITY),
    "behind": Glyph((), 0.0, 0.15, True, _EXTREMITY),
    "bend level": _strokes(
        (-0.275, 0, 0.275, 0), (0, -0.14, 0, 0.14), weight=BEND_WEIGHT, confirmed=True, source=_BEND
    ),
    "bend front": _strokes(
        (-0.14, 0, 0.14, 0), (0, -0.275, 0, 0.275), weight=BEND_WEIGHT, confirmed=True, source=_BEND
    ),
    "bend behind": _strokes(
        (-0.2, -0.2, 0.2, 0.2),
        (-0.2, 0.2, 0.2, -0.2),
        weight=BEND_WEIGHT,
        confirmed=True,
        source=_BEND,
    ),
    "crossed": _strokes((-0.26, 0.26, 0.26, -0.26), weight=0.06, confirmed=False, source=_OURS),
    "turn left": _strokes(
        (-0.3, 0, 0.3, 0),
        (-0.255, 0, -0.255, -0.26),
        weight=LEAN_WEIGHT,
        confirmed=False,
        source=_OURS,
    ),
    "turn right": _strokes(
        (-0.3, 0, 0.3, 0),
        (0.255, 0, 0.255, -0.26),
        weight=LEAN_WEIGHT,
        confirmed=False,
        source=_OURS,
    ),
    "joined turn left": _strokes(
        (0, 0, -0.42, 0),
        (-0.375, 0, -0.375, -0.26),
        weight=LEAN_WEIGHT,
        confirmed=False,
        source=_OURS,
    ),
    "joined turn right": _strokes(
        (0, 0, 0.42, 0), (0.375, 0, 0.375, -0.26), weight=LEAN_WEIGHT, confirmed=False, source=_OURS
    ),
    "tilt left": _strokes(
        (LEAN, STEM, -LEAN, -STEM), weight=LEAN_WEIGHT, confirmed=False, source=_LEAN
    ),
    "tilt right": _strokes(
        (-LEAN, STEM, LEAN, -STEM), weight=LEAN_WEIGHT, confirmed=False, source=_LEAN
    ),
    "upright": _strokes((0, -STEM, 0, STEM), weight=LEAN_WEIGHT, confirmed=False, source=_OURS),
    "bend": _strokes((-0.2, 0, 0.2, 0), weight=LEAN_WEIGHT, confirmed=False, source=_OURS),
}

FEET_APART: Mapping[str, float] = {
    "first": 0.30,
    "second": 0.80,
    "third": 0.24,
    "fourth": 0.50,
    "fifth": 0.12,
}
"""Distance of each foot's sign from the centre line in the five positions, in stave spaces. That
the signs touch in the closed positions and stand apart in the open ones follows from the signs;
third against fifth is a proposal of ours."""


def extremity(depth: Depth) -> str:
    """The name of the sign of a hand or foot."""
    return depth.value


def joint(depth: Depth) -> str:
    """The name of the sign of a bent elbow or knee."""
    return f"bend {depth.value}"


def crossed(sign: Sign) -> bool:
    """Whether the sign stands over the centre line and needs the mark that says so."""
    return sign.width < 0


def orientation(part: Orientation) -> Iterator[tuple[str, float, float]]:
    """The one sign of a head, body or pelvis, whatever its rotations (Neagle 2005 §4.3).

    A stem leans the way of the tilt, has a foot when the bend is forward and a head when it is
    back, and an arm towards the side of the turn. A turn alone has no stem; erect is a bare stem.

    Args:
        part: The orientation.

    Yields:
        Name of a glyph and how far it stands from the centre of the part's space, (x, y).
    """
    side = "left" if part.turn > 0 else "right"
    if part.turn and not part.tilt and not part.bend:
        yield f"turn {side}", 0.0, 0.0
        return
    lean = (part.tilt < 0) - (part.tilt > 0)
    yield {-1: "tilt left", 0: "upright", 1: "tilt right"}[lean], 0.0, 0.0
    if part.bend:
        end = 1 if part.bend > 0 else -1
        yield "bend", -end * lean * LEAN, end * (STEM - LEAN_WEIGHT / 2)
    if part.turn:
        yield f"joined turn {side}", 0.0, 0.0
