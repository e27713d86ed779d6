"""The shapes of the signs, all in one table, so that a choreologist can correct a drawing here
alone.

Units are the distance between two stave lines; x to the right, y down, the plotted point at the
origin. The page is seen from behind the dancer: the dancer's right is on the right (Neagle 2005
§4.3). Drawings are SVG path data with the absolute commands M, L, Q, C and Z.

A line that runs from one place to another is drawn from (0, 0) to (1, 0) as if it went to the
right: `along` says how it is fitted to its two ends.

`confirmed` is True where a published description of Benesh notation gives the shape, and False
where the shape is a proposal of ours. Sizes and stroke weights are ours throughout.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Literal

from enpointe.notation.glyph_shapes import CROSSES, disc, dotted, flag, oval
from enpointe.notation.signs import Depth, Orientation

__all__ = ["FEET_APART", "GLYPHS", "Glyph", "extremity", "joint", "orientation"]

SIGN_WEIGHT = 0.17
BEND_WEIGHT = 0.11
LEAN_WEIGHT = 0.085
PATH_WEIGHT = 0.06

STEM = 0.38
LEAN = 0.19


@dataclass(frozen=True, slots=True)
class Glyph:
    """A sign of the stave.

    Attributes:
        meaning: What it says, for people.
        stroke: Path of its centre lines, drawn with `weight` and butt ends.
        fill: Path of its filled outlines.
        weight: Thickness of the strokes.
        text: Letters or figures, centred on the origin; `size` is their size.
        size: Size of the letters.
        floor: For how a foot meets the floor: its sign stands below the line (1), on it (0) or
            above it (-1).
        along: None for a sign that stands at a place. "whole" for a line whose breadth grows with
            its length, "across" for one whose breadth is fixed, in stave spaces.
        confirmed: Whether a published source gives the shape.
        source: That source, or what the proposal follows from.
    """

    meaning: str
    stroke: str = ""
    fill: str = ""
    weight: float = 0.0
    text: str = ""
    size: float = 0.0
    floor: int | None = None
    along: Literal["whole", "across"] | None = None
    confirmed: bool = False
    source: str = "proposal; no published shape found"


_EXTREMITY = "Neagle 2005 §4.3; Wikipedia, Benesh Movement Notation"
_BEND = "everything2, Benesh Notation; Neagle 2005 §4.3"
_LEAN_SOURCE = "a line in the space of its part (Wikipedia); its slant is inferred"
_VIA_SOURCE = "Neagle 2005 §5.2.1"
_LINE = "such lines exist (Neagle 2005 §5.2.1); how they run is ours"
_LOCOMOTION = "such lines link the feet (benesh.org, Giselle act 1); shape and side are ours"
_FACING = "readable as an arrow to where the dancer faces (benesh.org, Giselle act 1)"
_COUNTED = "so counted by a trained notator (Ballet Alert 11260)"
_REPEAT = (
    "matching vertical signs with dashes inside (benesh.org, Giselle act 1); the dashes are ours"
)
_MUSIC = "as in music (benesh.org, Giselle act 1)"
_FLOOR = "confirmed for the demi-pointe (Ballet Alert 11260), else inferred"


def _placed(meaning: str, stroke: str, weight: float) -> Glyph:
    """A hand or foot, or a bent joint: the signs that sources describe."""
    source = _BEND if weight == BEND_WEIGHT else _EXTREMITY
    return Glyph(meaning, stroke, weight=weight, confirmed=True, source=source)


def _leaning(
    meaning: str, stroke: str, source: str = "proposal; no published shape found"
) -> Glyph:
    return Glyph(meaning, stroke, weight=LEAN_WEIGHT, source=source)


GLYPHS: Mapping[str, Glyph] = {
    # Hands, feet, elbows and knees
    "level": _placed("hand or foot in the plane of the body", "M-.3 0L.3 0", SIGN_WEIGHT),
    "front": _placed("hand or foot in front of the body", "M0 -.3L0 .3", SIGN_WEIGHT),
    "behind": Glyph(
        "hand or foot behind the body", fill=disc(0.16), confirmed=True, source=_EXTREMITY
    ),
    "bend level": _placed(
        "bent elbow or knee in the plane of the body", "M-.29 0L.29 0M0 -.15L0 .15", BEND_WEIGHT
    ),
    "bend front": _placed(
        "bent elbow or knee in front of the body", "M-.15 0L.15 0M0 -.29L0 .29", BEND_WEIGHT
    ),
    "bend behind": _placed(
        "bent elbow or knee behind the body", "M-.21 -.21L.21 .21M-.21 .21L.21 -.21", BEND_WEIGHT
    ),
    "crossed left": Glyph(
        "the sign is the left limb's, across the centre line", "M.3 .24L-.3 -.24", weight=0.06
    ),
    "crossed right": Glyph(
        "the sign is the right limb's, across the centre line", "M-.3 .24L.3 -.24", weight=0.06
    ),
    "straight": Glyph(
        "the arm is stretched, not rounded", "M-.17 -.38L0 -.54L.17 -.38", weight=0.055
    ),
    "contact left": Glyph(
        "the left hand touches the body", "M.2 -.3C.54 -.24 .54 .24 .2 .3", weight=0.06
    ),
    "contact right": Glyph(
        "the right hand touches the body", "M-.2 -.3C-.54 -.24 -.54 .24 -.2 .3", weight=0.06
    ),
    # How a foot meets the floor: where its sign stands
    "floor flat": Glyph("whole foot: the sign hangs from the floor line", floor=1, source=_FLOOR),
    "floor demi-pointe": Glyph(
        "demi-pointe: the sign lies on the floor line",
        floor=0,
        confirmed=True,
        source="Ballet Alert 11260 (a trained notator)",
    ),
    "floor pointe": Glyph("pointe: the sign stands on the floor line", floor=-1, source=_FLOOR),
    "floor touching": Glyph(
        "toe on the floor without weight: as on pointe, with a ring below the line",
        disc(0.11),
        weight=0.05,
        floor=-1,
    ),
    # Head, body and pelvis: one sign each, of these strokes
    "upright": _leaning("stem: no tilt", f"M0 {-STEM}L0 {STEM}"),
    "tilt left": _leaning(
        "stem: tilted to the left", f"M{LEAN} {STEM}L{-LEAN} {-STEM}", _LEAN_SOURCE
    ),
    "tilt right": _leaning(
        "stem: tilted to the right", f"M{-LEAN} {STEM}L{LEAN} {-STEM}", _LEAN_SOURCE
    ),
    "turn left": _leaning("turned to the left", "M-.34 0L.34 0M-.3 .04L-.3 -.27"),
    "turn right": _leaning("turned to the right", "M-.34 0L.34 0M.3 .04L.3 -.27"),
    "joined turn left": _leaning(
        "turned to the left, joined to a stem", "M0 0L-.44 0M-.4 .04L-.4 -.25"
    ),
    "joined turn right": _leaning(
        "turned to the right, joined to a stem", "M0 0L.44 0M.4 .04L.4 -.25"
    ),
    "bend": _leaning("bent: at the foot of the stem forward, at its head back", "M-.2 0L.2 0"),
    # Movement lines, and what they pass through on the way
    "path straight": Glyph(
        "the limb goes straight there", "M0 0L1 0", weight=PATH_WEIGHT, along="whole", source=_LINE
    ),
    "path circular": Glyph(
        "the limb goes there in an arc",
        "M0 0C.22 -.26 .78 -.26 1 0",
        weight=PATH_WEIGHT,
        along="whole",
        source=_LINE,
    ),
    "via front": Glyph(
        "through the front: a tick across the line",
        "M0 -.2L0 .2",
        weight=0.07,
        confirmed=True,
        source=_VIA_SOURCE,
    ),
    "via side": Glyph("through the side: a tick aslant", "M-.15 .15L.15 -.15", weight=0.07),
    "via back": Glyph("through the back: a dot on the line", fill=disc(0.11)),
    # Locomotion: from the floor line of one frame to that of the next
    "locomotion steps": Glyph(
        "the foot steps: an arc over the floor line",
        fill="M0 -.16C.25 -.66 .75 -.66 1 -.16C.75 -.54 .25 -.54 0 -.16Z",
        along="across",
        source=_LOCOMOTION,
    ),
    "locomotion slides": Glyph(
        "the foot slides: a straight line under the feet",
        "M0 .76L1 .76",
        weight=0.09,
        along="across",
        source=_LOCOMOTION,
    ),
    "locomotion jumps": Glyph(
        "the dancer jumps: an arc below the stave, from take-off to landing",
        fill="M0 .9C.22 1.65 .78 1.65 1 .9C.78 1.5 .22 1.5 0 .9Z",
        along="across",
        source=_LOCOMOTION,
    ),
    # Above the stave
    "half": Glyph("half a beat later", text="&", size=0.9, source=_COUNTED),
    "quarter": Glyph("a quarter of a beat later", "M0 -.52L0 -.02", weight=0.08),
    "three quarters": Glyph(
        "three quarters of a beat later",
        "M-.16 -.52L-.16 -.02M0 -.52L0 -.02M.16 -.52L.16 -.02",
        weight=0.08,
    ),
    "third": Glyph(
        "a third of a beat later",
        "M-.3 -.4L-.3 -.56L.3 -.56L.3 -.4M0 -.36L0 -.02",
        weight=0.06,
    ),
    "two thirds": Glyph(
        "two thirds of a beat later",
        "M-.3 -.4L-.3 -.56L.3 -.56L.3 -.4M-.1 -.36L-.1 -.02M.1 -.36L.1 -.02",
        weight=0.06,
    ),
    "phrase": Glyph(
        "a phrase, with the word for its quality above",
        fill="M0 0C.1 -.75 .9 -.75 1 0C.9 -.61 .1 -.61 0 0Z",
        along="across",
    ),
    "gradual": Glyph(
        "slowing or quickening lasts as far as this",
        "M0 0L1 0M1 -.2L1 .2",
        weight=0.05,
        along="across",
    ),
    "ending closed": Glyph(
        "an ending, and back to the sign",
        "M0 .75L0 0L1 0L1 .75",
        weight=0.06,
        along="across",
        source=_MUSIC,
    ),
    "ending open": Glyph(
        "the last ending", "M0 .75L0 0L1 0", weight=0.06, along="across", source=_MUSIC
    ),
    # Between frames
    "repeat same": Glyph(
        "repeat: exactly the same",
        "M-.3 0L-.3 4M.3 0L.3 4M-.14 1.5L.14 1.5M-.14 2.5L.14 2.5",
        weight=0.1,
        source=_REPEAT,
    ),
    "repeat other side": Glyph(
        "repeat: to the other side",
        "M-.3 0L-.3 4M.3 0L.3 4" + CROSSES,
        weight=0.1,
        source=_REPEAT,
    ),
    "repeat same within a bar": Glyph(
        "repeat that is not at a bar line: exactly the same",
        dotted(-0.3) + dotted(0.3) + "M-.14 1.5L.14 1.5M-.14 2.5L.14 2.5",
        weight=0.1,
        source=_REPEAT,
    ),
    "repeat other side within a bar": Glyph(
        "repeat that is not at a bar line: to the other side",
        dotted(-0.3) + dotted(0.3) + CROSSES,
        weight=0.1,
        source=_REPEAT,
    ),
    "held bars": Glyph(
        "bars in which nothing is written: all holds",
        fill="M0 -.45L.12 -.45L.12 -.13L.88 -.13L.88 -.45L1 -.45L1 .45L.88 .45L.88 .13L.12 .13"
        "L.12 .45L0 .45Z",
        source="as in music: bars of rest",
    ),
    # Below the stave; up the page is towards the audience
    "facing": Glyph(
        "faces this way", "M0 .55L0 -.1", "M0 -.6L.2 -.02L-.2 -.02Z", weight=0.09, source=_FACING
    ),
    "stage": Glyph(
        "the stage from above, the audience along its heavy side",
        "M-.7 -.5L-.7 .5L.7 .5L.7 -.5",
        "M-.73 -.56L.73 -.56L.73 -.44L-.73 -.44Z",
        weight=0.05,
    ),
    "place": Glyph("stands here on the stage", fill=disc(0.12)),
    "travel straight": Glyph(
        "travels this way", "M0 0L1 0M.82 -.14L1 0L.82 .14", weight=0.065, along="whole"
    ),
    "travel left": Glyph(
        "travels this way, curving to the left",
        "M0 0C.25 .34 .75 .34 1 0M.77 .04L1 0L.97 .235",
        weight=0.065,
        along="whole",
    ),
    "travel right": Glyph(
        "travels this way, curving to the right",
        "M0 0C.25 -.34 .75 -.34 1 0M.77 -.04L1 0L.97 -.235",
        weight=0.065,
        along="whole",
    ),
    "turning left": Glyph(
        "turns to the left, as seen from above",
        "M.45 .25C.55 -.1 .3 -.42 0 -.42C-.3 -.42 -.5 -.15 -.45 .15",
        "M-.4 .42L-.62 .06L-.24 .08Z",
        weight=0.07,
    ),
    "turning right": Glyph(
        "turns to the right, as seen from above",
        "M-.45 .25C-.55 -.1 -.3 -.42 0 -.42C.3 -.42 .5 -.15 .45 .15",
        "M.4 .42L.62 .06L.24 .08Z",
        weight=0.07,
    ),
    # Music's own
    "note 1": Glyph(
        "a whole note", oval(0.36, 0.21, 0.0), weight=0.1, confirmed=True, source=_MUSIC
    ),
    "note 2": Glyph(
        "a half note",
        oval(0.27, 0.17, 0.4) + "M.25 -.08L.25 -1.35",
        weight=0.08,
        confirmed=True,
        source=_MUSIC,
    ),
    "note 4": Glyph(
        "a quarter note",
        "M.25 -.08L.25 -1.35",
        oval(0.29, 0.2, 0.4),
        weight=0.075,
        confirmed=True,
        source=_MUSIC,
    ),
    "note 8": Glyph(
        "an eighth note",
        "M.25 -.08L.25 -1.35",
        oval(0.29, 0.2, 0.4) + flag(-1.35),
        weight=0.075,
        confirmed=True,
        source=_MUSIC,
    ),
    "note 16": Glyph(
        "a sixteenth note",
        "M.25 -.08L.25 -1.35",
        oval(0.29, 0.2, 0.4) + flag(-1.35) + flag(-1.02),
        weight=0.075,
        confirmed=True,
        source=_MUSIC,
    ),
}

FEET_APART: Mapping[str, float] = {
    "first": 0.33,
    "second": 0.8,
    "third": 0.2,
    "fourth": 0.42,
    "fourth open": 0.66,
    "fifth": 0.123,
}
"""Distance of each foot's sign from the centre line in the five positions, in stave spaces. That
the signs touch in the closed positions and stand apart in the open ones follows from the signs;
third against fifth, and the open forms, are proposals of ours."""


def extremity(depth: Depth) -> str:
    """The name of the sign of a hand or foot."""
    return depth.value


def joint(depth: Depth) -> str:
    """The name of the sign of a bent elbow or knee."""
    return f"bend {depth.value}"


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
