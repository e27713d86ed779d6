"""Reads the lines of a hand, an elbow, a foot, a knee or a leg."""

from __future__ import annotations

import re
from dataclasses import dataclass, field

from lark import Token, Tree

from enpointe.notation.amounts import HEIGHTS, WIDTHS
from enpointe.notation.draft import Draft
from enpointe.notation.movement import Limb, Locomotion, PathKind, PathMark, StepKind, Via
from enpointe.notation.numerals import number
from enpointe.notation.reading import (
    location,
    side_of,
    tokens_of,
    trees_of,
    words_of,
)
from enpointe.notation.signs import (
    Bend,
    BodyPlace,
    Depth,
    Direction,
    FloorContact,
    HandContact,
    LegPosition,
    Location,
    Side,
    Sign,
    Support,
)
from enpointe.notation.spelling import fold, spelt
from enpointe.notation.vocabulary import find_leg, nearest
from enpointe.notation.vocabulary_arms import BODY_PLACES
from enpointe.notation.vocabulary_feet import BENDS, FLOOR
from enpointe.notation.vocabulary_legs import LegEntry
from enpointe.notation.wording import either, quoted

__all__ = ["read_leg", "read_limb", "read_path", "read_stance"]

_PLACES = spelt(BODY_PLACES)
_BENDS = spelt(BENDS)
_FLOOR = spelt(FLOOR)
_STEPS = spelt({kind: (kind.value,) for kind in StepKind})
_PATH = re.compile(
    r"(?:an? |the )?(?P<kind>circle|arc|straight line|line)"
    r"(?: through (?:the )?(?P<via>front|side|back))?"
)
_ARTICLES = re.compile(r"(?:the|its|own) ")


@dataclass
class _Items:
    """What one limb's line has said so far."""

    numbers: dict[str, float] = field(default_factory=dict)
    depth: Depth | None = None
    straight: bool = False
    contact: BodyPlace | None = None
    floor: FloorContact | None = None
    step: StepKind | None = None
    path: PathMark | None = None

    @property
    def plots(self) -> bool:
        """Whether any of the sign itself is written."""
        return bool(self.numbers) or self.depth is not None or self.straight


def read_limb(draft: Draft, line: Tree[Token]) -> None:
    """Takes a line such as "left hand: 0.8 wide, 4 high, front".

    Raises:
        ScoreError: It is wrong in itself or contradicts an earlier one.
    """
    keyword, limb = tokens_of(line)[:2]
    side, kind = side_of(keyword), str(limb.lower())
    items = _Items()
    for child in line.children[2:]:
        _read_item(draft, child, f"{side} {kind}", items)
    at = location(keyword)
    if items.step is not None:
        draft.claim(f"step of the {side} foot", at)
        draft.locomotion[side] = Locomotion(items.step, at)
    if items.path is not None:
        draft.claim(f"path of the {side} {kind}", at)
        draft.paths[Limb.of(side, kind)] = items.path
    if items.floor is not None and not items.plots:
        raise draft.reader.fail(
            f"'{items.floor}' alone goes on the leg's line, such as "
            f"'{side} leg: straight, {items.floor}'",
            keyword,
        )
    if items.contact is not None or items.plots:
        draft.claim(f"{side} {kind}", at)
    if items.contact is not None:
        draft.contacts[side] = HandContact(items.contact, at)
    if items.floor is not None:
        draft.claim(f"{side} support", at)
        draft.support[side] = Support(items.floor, at=at)
    if items.plots:
        _plot(draft, keyword, side, kind, items)


def _plot(draft: Draft, keyword: Token, side: Side, kind: str, items: _Items) -> None:
    for needed, written, example in (
        ("width", "width" in items.numbers, "0.8 wide"),
        ("height", "height" in items.numbers, "4 high"),
        ("depth", items.depth is not None, "front"),
    ):
        if not written:
            raise draft.reader.fail(
                f"the {side} {kind} lacks its {needed}; write all three, such as "
                f"'{side} {kind}: 0.8 wide, 4 high, front' (here add '{example}')",
                keyword,
            )
    assert items.depth is not None
    signs = {
        "hand": draft.hands,
        "elbow": draft.elbows,
        "foot": draft.foot_signs,
        "knee": draft.knees,
    }[kind]
    signs[side] = Sign(
        items.numbers["width"],
        items.numbers["height"],
        items.depth,
        items.straight,
        location(keyword),
    )


def _read_item(draft: Draft, item: Tree[Token] | Token, who: str, items: _Items) -> None:
    kind = who.split()[1]
    token = item if isinstance(item, Token) else tokens_of(item)[0]
    name = item.type.lower() if isinstance(item, Token) else str(item.data)

    def once(what: str, written: object) -> None:
        if written:
            raise draft.reader.fail(f"the {what} of the {who} is written twice; keep one", token)

    if isinstance(item, Token):
        if name == "straight":
            once("'straight'", items.straight)
            if kind != "hand":
                raise draft.reader.fail(
                    "only a hand can be written 'straight'; leave it out", token
                )
            items.straight = True
        else:
            once("depth", items.depth)
            items.depth = Depth(item.lower())
    elif name in ("width", "height"):
        once(name, name in items.numbers)
        items.numbers[name] = _amount(draft, name, token)
    elif name == "contact":
        once("contact", items.contact)
        if kind != "hand":
            raise draft.reader.fail("only a hand lies on the body; leave it out", token)
        text = _ARTICLES.sub("", fold(words_of(item)) + " ").strip()
        items.contact = draft.reader.choice(text, _PLACES, "a place for a hand", token)
    elif name == "path":
        once("path", items.path)
        if kind not in ("hand", "foot"):
            raise draft.reader.fail("only a hand or a foot has a path; leave it out", token)
        items.path = read_path(draft, item)
    elif kind == "foot" and fold(words_of(item)) in _STEPS:
        once("step", items.step)
        items.step = _STEPS[fold(words_of(item))]
    elif kind == "foot" and fold(words_of(item)) in _FLOOR:
        once("contact with the floor", items.floor)
        items.floor = _FLOOR[fold(words_of(item))]
    else:
        known = {"hand": ("straight", "on hip"), "foot": (*_FLOOR, *_STEPS)}.get(kind, ())
        raise draft.reader.fail(
            f"'{words_of(item)[:60]}' is not part of the sign of a {kind}; "
            f"write a number and 'wide' or 'high', {quoted([*Depth, *known])}",
            token,
        )


def _amount(draft: Draft, name: str, token: Token) -> float:
    value = number(str(token))
    if value is None:
        raise draft.reader.fail(f"'{token[:40]}' is not a number that a sign can have", token)
    lowest, highest = HEIGHTS if name == "height" else WIDTHS
    if not lowest <= value <= highest:
        meaning = (
            "from the floor (1) to a wrist stretched overhead (6)"
            if name == "height"
            else "as a fraction of the full reach, negative when crossed"
        )
        raise draft.reader.fail(
            f"{name} {token[:20]} is out of reach; write {lowest:g} to {highest:g}, {meaning}",
            token,
        )
    return value


def read_path(draft: Draft, node: Tree[Token]) -> PathMark:
    """A path such as "by a circle through the front".

    Raises:
        ScoreError: It is none.
    """
    token = tokens_of(node)[0]
    match = _PATH.fullmatch(fold(words_of(node)))
    if match is None:
        raise draft.reader.fail(
            f"'by {words_of(node)[:60]}' is not a path; write 'by a circle' or 'by a straight "
            "line', and if need be 'through the front', 'the side' or 'the back'",
            token,
        )
    circular = match["kind"] in ("circle", "arc")
    kind = PathKind.CIRCULAR if circular else PathKind.STRAIGHT
    return PathMark(kind, Via(match["via"]) if match["via"] else None, location(token))


def read_leg(draft: Draft, line: Tree[Token]) -> None:
    """Takes a line such as "right leg: retiré devant" or "left leg: demi-plié, demi-pointe".

    Raises:
        ScoreError: It is wrong in itself or contradicts an earlier one.
    """
    keyword = tokens_of(line)[0]
    side, at = side_of(keyword), location(keyword)
    positions = list(trees_of(line))
    stance = read_stance(draft, positions, at)
    if stance is not None:
        draft.claim(f"{side} support", at)
        draft.support[side] = stance
        return
    draft.claim(f"{side} leg", at)
    if len(positions) > 1:
        raise draft.reader.fail(
            "a working leg has one position, and a standing leg a bend and a contact with the "
            "floor; keep one of the two",
            tokens_of(positions[1])[0],
        )
    draft.legs[side] = _leg_position(draft, positions[0])


def read_stance(draft: Draft, items: list[Tree[Token]], at: Location) -> Support | None:
    """How a leg stands, from its words; None if the first word says nothing of the kind.

    Raises:
        ScoreError: The first word does and another doesn't, or they contradict each other.
    """
    bend: Bend | None = None
    floor: FloorContact | None = None
    for item in items:
        token, word = tokens_of(item)[0], fold(words_of(item))
        if word not in _BENDS and word not in _FLOOR:
            if bend is None and floor is None:
                return None
            draft.reader.choice(word, {**_BENDS, **_FLOOR}, "a way to stand", token)
        if (bend if word in _BENDS else floor) is not None:
            raise draft.reader.fail(f"'{word}' contradicts what stands before it; keep one", token)
        if word in _BENDS:
            bend = _BENDS[word]
        else:
            floor = _FLOOR[word]
    return Support(floor or FloorContact.FLAT, bend or Bend.STRAIGHT, at)


def _leg_position(draft: Draft, node: Tree[Token]) -> LegPosition:
    tokens = tokens_of(node)
    height = tokens.pop() if tokens[-1].type == "NUMBER" else None
    text = " ".join(tokens)
    found = find_leg(text)
    if found is None:
        close = nearest(text, "leg")
        hint = f"did you mean {either(close)}?" if close else "see `enpointe pose --list`"
        raise draft.reader.fail(f"'{text[:60]}' is not a position of the leg; {hint}", tokens[0])
    entry, direction = found
    direction = _direction(draft, entry, direction, tokens[0])
    degrees = entry.degrees[1] if entry.degrees else None
    if height is not None:
        if entry.degrees is None:
            raise draft.reader.fail(f"{entry.name} has one height; leave out '{height}'", height)
        low, _, high = entry.degrees
        degrees = draft.reader.value(height, low, high, "degrees, 90 for a right angle")
    return LegPosition(entry.name, direction, degrees, location(tokens[0]))


def _direction(
    draft: Draft, entry: LegEntry, direction: Direction | None, token: Token
) -> Direction:
    if direction is None and len(entry.directions) == 1:
        return entry.directions[0]
    if direction in entry.directions:
        assert direction is not None
        return direction
    forms = quoted([f"{entry.name} {each}" for each in entry.directions])
    problem = "needs its direction" if direction is None else f"has no form {direction}"
    raise draft.reader.fail(f"{entry.name} {problem}; write {forms}", token)
