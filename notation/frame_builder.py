"""Builds one frame from the lines under its beat, refusing what contradicts itself."""

from __future__ import annotations

import math
import re
from collections.abc import Iterable
from fractions import Fraction

from lark import Token, Tree

from enpointe.errors import ScoreError
from enpointe.notation.frame import Frame
from enpointe.notation.signs import (
    ArmsPosition,
    Depth,
    FeetPosition,
    Location,
    Orientation,
    Side,
    Sign,
)
from enpointe.notation.vocabulary import Part, find_arms, find_feet, names, nearest
from enpointe.notation.wording import either

__all__ = ["DEFAULT_DEGREES", "HEIGHTS", "MAX_DEGREES", "WIDTHS", "FrameBuilder", "number"]

HEIGHTS = (1.0, 6.0)
"""Lowest and highest sign, in stave lines: the floor, and a stretched wrist overhead (signs.py)."""

WIDTHS = (-1.0, 1.0)
"""Widest crossed and open sign: nothing reaches further than its full reach."""

MAX_DEGREES = 90.0
"""Largest turn, tilt or bend of head, body or pelvis; the models know a body's own limits."""

DEFAULT_DEGREES = {
    ("head", "turn"): 45.0,
    ("head", "tilt"): 15.0,
    ("head", "bend"): 15.0,
    ("body", "turn"): 15.0,
    ("body", "tilt"): 10.0,
    ("body", "bend"): 10.0,
    ("pelvis", "turn"): 10.0,
    ("pelvis", "tilt"): 10.0,
    ("pelvis", "bend"): 10.0,
}
"""Degrees meant by a direction without an amount. The signs give a direction only, and Neagle (2005
§4.4.5) took each joint's limit; no source prints amounts for ballet. These are ours, modest
ones."""

_NUMBER = re.compile(r"[+-]?(?:[0-9]{1,9}(?:\.[0-9]{0,20})?|\.[0-9]{1,20})(?:[eE][+-]?[0-9]{1,3})?")


def number(text: str) -> float | None:
    """The finite number that the text is, or None."""
    text = text.replace("\u2212", "-")
    if not _NUMBER.fullmatch(text):
        return None
    value = float(text)
    return value if math.isfinite(value) else None


class FrameBuilder:
    """Gathers the lines of one frame.

    Args:
        source: The name to give in error messages.
    """

    def __init__(self, source: str | None) -> None:
        self._source = source
        self._written: dict[str, Location] = {}
        self._feet: FeetPosition | None = None
        self._arms: ArmsPosition | None = None
        self._signs: dict[str, dict[Side, Sign]] = {"hand": {}, "elbow": {}, "foot": {}, "knee": {}}
        self._parts: dict[str, Orientation] = {}

    def add(self, line: Tree[Token]) -> None:
        """Takes one parsed line: feet, arms, limb or orientation.

        Raises:
            ScoreError: The line is wrong in itself or contradicts an earlier one.
        """
        readers = {
            "feet": self._read_feet,
            "arms": self._read_arms,
            "limb": self._read_limb,
            "orientation": self._read_orientation,
        }
        readers[str(line.data)](line)

    def frame(self, beat: Fraction, at: Location) -> Frame:
        """The frame of all lines taken."""
        return Frame(
            beat,
            self._feet,
            self._arms,
            self._signs["hand"],
            self._signs["elbow"],
            self._signs["foot"],
            self._signs["knee"],
            self._parts.get("head"),
            self._parts.get("body"),
            self._parts.get("pelvis"),
            at,
        )

    def _fail(self, message: str, at: Token | Location) -> ScoreError:
        return ScoreError(message, at.line or 1, at.column or 1, self._source)

    def _claim(self, part: str, at: Location, against: Iterable[str] = ()) -> None:
        """Notes that the frame writes this part; refuses it twice or against another."""
        for other in (part, *against):
            earlier = self._written.get(other)
            if earlier is not None and other == part:
                raise self._fail(
                    f"'{part}' is already written in this frame, on line {earlier.line}; keep one",
                    at,
                )
            if earlier is not None:
                raise self._fail(
                    f"'{part}' contradicts '{other}' on line {earlier.line}; keep one of them",
                    at,
                )
        self._written[part] = at

    def _name(self, node: Tree[Token], part: Part) -> tuple[str, Location]:
        name = next(child for child in node.children if isinstance(child, Tree))
        words = [word for word in name.children if isinstance(word, Token)]
        text, at = " ".join(words), _at(words[0])
        entry = find_arms(text) if part == "arms" else find_feet(text)
        if entry is None:
            close = nearest(text, part)
            hint = (
                f"did you mean {either(close)}?" if close else f"known are {', '.join(names(part))}"
            )
            raise self._fail(f"'{text[:60]}' is not a position of the {part}; {hint}", at)
        return entry.name, at

    def _read_feet(self, line: Tree[Token]) -> None:
        keyword, side = _keyword(line), _token(line, "SIDE")
        self._claim("feet", _at(keyword), ("left foot", "right foot"))
        name, at = self._name(line, "feet")
        entry = find_feet(name)
        assert entry is not None
        if entry.crossed and side is None:
            raise self._fail(
                f"{name} position of the feet needs the foot in front; "
                f"write '{name} right front' or '{name} left front'",
                at,
            )
        if not entry.crossed and side is not None:
            raise self._fail(f"in {name} position no foot is in front; write only '{name}'", side)
        self._feet = FeetPosition(name, _side(side) if side else None, at=at)

    def _read_arms(self, line: Tree[Token]) -> None:
        keyword, side = _keyword(line), _token(line, "SIDE")
        self._claim(
            "arms",
            _at(keyword),
            [f"{each} {limb}" for limb in ("hand", "elbow") for each in ("left", "right")],
        )
        name, at = self._name(line, "arms")
        entry = find_arms(name)
        assert entry is not None
        if entry.needs_leading and side is None:
            raise self._fail(
                f"'{name}' needs the arm that leads ({entry.description}); "
                f"write '{name} right leads' or '{name} left leads'",
                at,
            )
        if not entry.needs_leading and side is not None:
            raise self._fail(f"in '{name}' both arms do the same; leave out '{side}'", side)
        self._arms = ArmsPosition(name, _side(side) if side else None, at)

    def _read_limb(self, line: Tree[Token]) -> None:
        keyword, limb = _keyword(line), _token(line, "LIMB")
        assert limb is not None
        side, kind = _side(keyword), str(limb.lower())
        whole = {"hand": ("arms",), "elbow": ("arms",), "foot": ("feet",), "knee": ()}[kind]
        self._claim(f"{side} {kind}", _at(keyword), whole)
        seen: dict[str, float | str] = {}
        for item in line.children[2:]:
            self._read_item(item, kind, seen, f"{side} {kind}")
        for needed, example in (("width", "0.8 wide"), ("height", "4 high"), ("depth", "front")):
            if needed not in seen:
                raise self._fail(
                    f"the {side} {kind} lacks its {needed}; write all three, such as "
                    f"'{side} {kind}: 0.8 wide, 4 high, front' (here add '{example}')",
                    keyword,
                )
        opposite = {"hand": "elbow", "elbow": "hand"}.get(kind)
        pair = self._signs[opposite].get(side) if opposite else None
        if (kind == "elbow" and pair and pair.straight) or (pair and "straight" in seen):
            raise self._fail(
                f"the {side} arm can't be straight and bent at the elbow in one frame", keyword
            )
        self._signs[kind][side] = Sign(
            float(seen["width"]),
            float(seen["height"]),
            Depth(str(seen["depth"])),
            "straight" in seen,
            _at(keyword),
        )

    def _read_item(
        self, item: Tree[Token] | Token, kind: str, seen: dict[str, float | str], who: str
    ) -> None:
        if isinstance(item, Tree):
            token = item.children[0]
            assert isinstance(token, Token)
            name = str(item.data)
            lowest, highest = HEIGHTS if name == "height" else WIDTHS
            value: float | str = self._number(token)
            if not lowest <= float(value) <= highest:
                meaning = (
                    "from the floor (1) to a wrist stretched overhead (6)"
                    if name == "height"
                    else "as a fraction of the full reach, negative when crossed"
                )
                raise self._fail(
                    f"{name} {token[:20]} is out of reach; "
                    f"write {lowest:g} to {highest:g}, {meaning}",
                    token,
                )
        else:
            token, value = item, str(item.lower())
            name = "straight" if item.type == "STRAIGHT" else "depth"
            if name == "straight" and kind != "hand":
                raise self._fail("only a hand can be written 'straight'; leave it out", token)
        if name in seen:
            raise self._fail(f"the {name} of the {who} is written twice; keep one", token)
        seen[name] = value

    def _number(self, token: Token) -> float:
        value = number(str(token))
        if value is None:
            raise self._fail(f"'{token[:40]}' is not a number that a sign can have", token)
        return value

    def _read_orientation(self, line: Tree[Token]) -> None:
        keyword = _keyword(line)
        part = str(keyword.lower())
        self._claim(part, _at(keyword))
        amounts: dict[str, float] = {}
        for item in line.children[1:]:
            if isinstance(item, Token):
                continue
            tokens = [token for token in item.children if isinstance(token, Token)]
            bend = item.data == "bend"
            kind = "bend" if bend else str(tokens[0].lower())
            direction, *amount = tokens if bend else tokens[1:]
            if kind in amounts:
                raise self._fail(f"the {kind} of the {part} is written twice; keep one", tokens[0])
            degrees = self._degrees(amount[0]) if amount else DEFAULT_DEGREES[part, kind]
            amounts[kind] = degrees if direction.lower() in ("left", "forward") else -degrees
        self._parts[part] = Orientation(
            amounts.get("turn", 0.0),
            amounts.get("tilt", 0.0),
            amounts.get("bend", 0.0),
            _at(keyword),
        )

    def _degrees(self, token: Token) -> float:
        value = number(str(token))
        if value is None or not 0.0 <= value <= MAX_DEGREES:
            raise self._fail(
                f"'{token[:40]}' is not an amount; write degrees from 0 to {MAX_DEGREES:g}, "
                "with the direction in words",
                token,
            )
        return value


def _keyword(line: Tree[Token]) -> Token:
    keyword = line.children[0]
    assert isinstance(keyword, Token)
    return keyword


def _token(line: Tree[Token], kind: str) -> Token | None:
    return next(
        (each for each in line.children if isinstance(each, Token) and each.type == kind), None
    )


def _side(token: Token) -> Side:
    return Side(token.lower())


def _at(token: Token) -> Location:
    return Location(token.line or 1, token.column or 1)
