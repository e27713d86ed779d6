"""Reads the lines below the stave, and jumps."""

from __future__ import annotations

from lark import Token, Tree

from enpointe.notation.amounts import MAX_CURVE, MAX_METRES, MAX_TURN
from enpointe.notation.draft import Draft
from enpointe.notation.movement import Jump
from enpointe.notation.reading import (
    location,
    side_of,
    token_of,
    tokens_of,
    trees_of,
    words_of,
)
from enpointe.notation.signs import Side
from enpointe.notation.spelling import spelt
from enpointe.notation.stage import DIRECTION_WORDS, Facing, StagePlace, Travel, Turn

__all__ = ["read_face", "read_jump", "read_place", "read_travel", "read_turn"]

_DIRECTIONS = spelt(DIRECTION_WORDS)


def read_face(draft: Draft, line: Tree[Token]) -> None:
    """Takes a line such as "face: corner 2"."""
    at = location(tokens_of(line)[0])
    draft.claim("face", at)
    draft.facing = Facing(_direction(draft, next(trees_of(line))), at)


def read_place(draft: Draft, line: Tree[Token]) -> None:
    """Takes a line such as "place: 0.5 left, 1.2 up" or "place: centre"."""
    at = location(tokens_of(line)[0])
    draft.claim("place", at)
    amounts: dict[str, float] = {}
    for node in trees_of(line):
        metres, way = tokens_of(node)
        value = draft.reader.value(metres, 0.0, MAX_METRES, "metres, with the direction in words")
        name = "left" if way.type == "SIDE" else "up"
        if name in amounts:
            raise draft.reader.fail(f"'{way}' is written twice or both ways; keep one", way)
        negative = way.lower() in ("right", "down", "downstage")
        amounts[name] = 0.0 - value if negative else value
    draft.place = StagePlace(amounts.get("left", 0.0), amounts.get("up", 0.0), at)


def read_travel(draft: Draft, line: Tree[Token]) -> None:
    """Takes a line such as "travel: 2 m towards corner 2, curving left 90"."""
    keyword, metres, *curving = tokens_of(line)
    at = location(keyword)
    draft.claim("travel", at)
    length = draft.reader.value(metres, 0.0, MAX_METRES, "metres")
    curve = 0.0
    if curving:
        side, degrees = curving
        curve = draft.reader.value(degrees, 0.0, MAX_CURVE, "degrees")
        curve = curve if side_of(side) is Side.LEFT else 0.0 - curve
    draft.travel = Travel(_direction(draft, next(trees_of(line))), length, curve, at)


def read_turn(draft: Draft, line: Tree[Token]) -> None:
    """Takes a line such as "turn: 360 right"."""
    keyword = tokens_of(line)[0]
    degrees, side = token_of(line, "NUMBER"), token_of(line, "SIDE")
    assert degrees is not None
    assert side is not None
    draft.claim("turn", location(keyword))
    value = draft.reader.value(degrees, 0.0, MAX_TURN, "degrees")
    if not value:
        raise draft.reader.fail("a turn of 0 degrees is none; leave it out", degrees)
    draft.turn = Turn(value, side_of(side), location(keyword))


def read_jump(draft: Draft, line: Tree[Token]) -> None:
    """Takes a line such as "jump: off 1+1/2, on 2"."""
    keyword, off, on = tokens_of(line)
    draft.claim("jump", location(keyword))
    draft.jump = Jump(draft.reader.beat(off), draft.reader.beat(on), location(keyword))


def _direction(draft: Draft, node: Tree[Token]) -> float:
    tokens = tokens_of(node)
    if tokens[0].type == "SIDE":
        side, amount = tokens
        degrees = draft.reader.value(amount, 0.0, 180.0, "degrees from the audience")
        return degrees if side_of(side) is Side.LEFT else 0.0 - degrees
    return draft.reader.choice(words_of(node), _DIRECTIONS, "a direction", tokens[0])
