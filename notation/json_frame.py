"""Reads one frame of the JSON form."""

from __future__ import annotations

from collections.abc import Callable
from typing import TypeVar

from enpointe.notation.amounts import (
    HEIGHTS,
    MAX_CURVE,
    MAX_DEGREES,
    MAX_METRES,
    MAX_TURN,
    WIDTHS,
)
from enpointe.notation.frame import Frame
from enpointe.notation.json_values import Node
from enpointe.notation.movement import (
    Jump,
    Limb,
    Locomotion,
    PathKind,
    PathMark,
    StepKind,
    Via,
)
from enpointe.notation.signs import (
    ArmsPosition,
    Bend,
    BodyPlace,
    Depth,
    Direction,
    FeetPosition,
    FloorContact,
    HandContact,
    LegPosition,
    Orientation,
    PosePosition,
    Side,
    Sign,
    Support,
)
from enpointe.notation.stage import Facing, StagePlace, Travel, Turn
from enpointe.notation.vocabulary import find_arms, find_feet, find_leg, find_pose

__all__ = ["read_frame"]

Value = TypeVar("Value")

_NAME = 80


def read_frame(node: Node) -> Frame:
    """A frame.

    Raises:
        ScoreError: A value is missing, of the wrong kind, out of range or unknown.
    """
    paths = node.get("paths")
    facing = _part(node, "facing", lambda child: child.number(-180.0, 180.0))
    frame = Frame(
        beat=node.need("beat").beat(),
        feet=_part(node, "feet", _feet),
        arms=_part(node, "arms", _arms),
        hands=_sides(node, "hands", _hand),
        elbows=_sides(node, "elbows", _sign),
        foot_signs=_sides(node, "foot_signs", _sign),
        knees=_sides(node, "knees", _sign),
        head=_part(node, "head", _orientation),
        body=_part(node, "body", _orientation),
        pelvis=_part(node, "pelvis", _orientation),
        support=_sides(node, "support", _support),
        legs=_sides(node, "legs", _leg),
        pose=_part(node, "pose", _pose),
        contacts=_sides(node, "contacts", lambda child: HandContact(child.word(BodyPlace))),
        facing=None if facing is None else Facing(facing),
        place=_part(node, "place", _place),
        travel=_part(node, "travel", _travel),
        turn=_part(node, "turn", _turn),
        paths={} if paths is None else _paths(paths),
        locomotion=_sides(node, "locomotion", lambda child: Locomotion(child.word(StepKind))),
        jump=_part(node, "jump", _jump),
    )
    node.done()
    return frame


def _part(node: Node, key: str, read: Callable[[Node], Value]) -> Value | None:
    child = node.get(key)
    return None if child is None else read(child)


def _sides(node: Node, key: str, read: Callable[[Node], Value]) -> dict[Side, Value]:
    child = node.get(key)
    return {} if child is None else child.sides(read)


def _flag(node: Node, key: str) -> bool:
    return bool(_part(node, key, Node.flag))


def _side(node: Node) -> Side:
    return node.word(Side)


def _sign(node: Node, straight: bool = False) -> Sign:
    sign = Sign(
        node.need("width").number(*WIDTHS),
        node.need("height").number(*HEIGHTS),
        node.need("depth").word(Depth),
        straight and _flag(node, "straight"),
    )
    node.done()
    return sign


def _hand(node: Node) -> Sign:
    return _sign(node, straight=True)


def _orientation(node: Node) -> Orientation:
    turn, tilt, bend = (
        _part(node, key, lambda child: child.number(-MAX_DEGREES, MAX_DEGREES)) or 0.0
        for key in ("turn", "tilt", "bend")
    )
    node.done()
    return Orientation(turn, tilt, bend)


def _feet(node: Node) -> FeetPosition:
    name = node.need("name").text(_NAME)
    entry = find_feet(name)
    if entry is None:
        raise node.fail(f"'{name}' is not a position of the feet")
    front, is_open = _part(node, "front", _side), _flag(node, "open")
    if entry.crossed is (front is None):
        raise node.fail(f"'{entry.name}' {'needs' if entry.crossed else 'has no'} front foot")
    if is_open and not entry.has_open:
        raise node.fail(f"'{entry.name}' has no open form")
    node.done()
    return FeetPosition(entry.name, front, is_open)


def _arms(node: Node) -> ArmsPosition:
    name = node.need("name").text(_NAME)
    entry = find_arms(name)
    if entry is None:
        raise node.fail(f"'{name}' is not a position of the arms")
    leading = _part(node, "leading", _side)
    if entry.needs_leading is (leading is None):
        raise node.fail(
            f"'{entry.name}' {'needs a' if entry.needs_leading else 'has no'} leading arm"
        )
    node.done()
    return ArmsPosition(entry.name, leading)


def _leg(node: Node) -> LegPosition:
    name = node.need("name").text(_NAME)
    found = find_leg(name)
    if found is None or found[0].name != name:
        raise node.fail(f"'{name}' is not a position of the leg")
    entry, _ = found
    direction = node.need("direction").word(Direction)
    if direction not in entry.directions:
        raise node.fail(f"'{name}' has no form {direction}")
    degrees = None
    if entry.degrees is not None:
        low, usual, high = entry.degrees
        given = _part(node, "degrees", lambda child: child.number(low, high))
        degrees = usual if given is None else given
    node.done()
    return LegPosition(entry.name, direction, degrees)


def _pose(node: Node) -> PosePosition:
    name = node.need("name").text(_NAME)
    entry = find_pose(name)
    if entry is None:
        raise node.fail(f"'{name}' is not a position of the whole body")
    pose = PosePosition(entry.name, node.need("support").word(Side))
    node.done()
    return pose


def _support(node: Node) -> Support:
    floor = _part(node, "floor", lambda child: child.word(FloorContact))
    bend = _part(node, "bend", lambda child: child.word(Bend))
    node.done()
    return Support(floor or FloorContact.FLAT, bend or Bend.STRAIGHT)


def _place(node: Node) -> StagePlace:
    left, up = (
        _part(node, key, lambda child: child.number(-MAX_METRES, MAX_METRES)) or 0.0
        for key in ("left", "up")
    )
    node.done()
    return StagePlace(left, up)


def _travel(node: Node) -> Travel:
    travel = Travel(
        node.need("degrees").number(-180.0, 180.0),
        node.need("metres").number(0.0, MAX_METRES),
        _part(node, "curve", lambda child: child.number(-MAX_CURVE, MAX_CURVE)) or 0.0,
    )
    node.done()
    return travel


def _turn(node: Node) -> Turn:
    degrees = node.need("degrees").number(0.0, MAX_TURN)
    if not degrees:
        raise node.fail("a turn of 0 degrees is none; leave it out")
    turn = Turn(degrees, node.need("sense").word(Side))
    node.done()
    return turn


def _paths(node: Node) -> dict[Limb, PathMark]:
    found = {limb: node.get(limb.value) for limb in Limb}
    node.done()
    return {limb: _path(child) for limb, child in found.items() if child is not None}


def _path(node: Node) -> PathMark:
    path = PathMark(
        node.need("kind").word(PathKind), _part(node, "via", lambda child: child.word(Via))
    )
    node.done()
    return path


def _jump(node: Node) -> Jump:
    jump = Jump(node.need("off").beat(), node.need("on").beat())
    node.done()
    return jump
