"""Writes a score as text that reads back as the same score."""

from __future__ import annotations

import json
from collections.abc import Iterator

from enpointe.notation.frame import Frame
from enpointe.notation.movement import Limb, PathKind, PathMark
from enpointe.notation.numerals import format_beat, format_number
from enpointe.notation.phrasing import Phrase, Repeat
from enpointe.notation.score import Score
from enpointe.notation.signs import (
    ArmsPosition,
    Bend,
    FeetPosition,
    FloorContact,
    LegPosition,
    Orientation,
    Side,
    Sign,
    Support,
)
from enpointe.notation.stage import DIRECTION_WORDS, StagePlace, Travel
from enpointe.notation.tempo import tempo_of
from enpointe.notation.vocabulary_arms import BODY_PLACES

__all__ = ["arms_name", "feet_name", "format_beat", "format_score", "frame_lines"]


def format_score(score: Score) -> str:
    """The text of a score, ending in a line feed.

    Args:
        score: The score; comments of the text that it was read from are not part of it.

    Returns:
        Text that :func:`~enpointe.notation.parser.parse_score` reads as an equal score.
    """
    lines = [
        f"benesh {score.version}",
        f"title: {_text(score.title)}",
        f"method: {_text(score.method)}",
        f"metre: {score.metre[0]}/{score.metre[1]}",
        f"tempo: {_tempo(score)}",
    ]
    if score.pickup:
        lines.append(f"pickup: {format_beat(score.pickup)}")
    lines += [_repeat(each) for each in score.repeats]
    lines += [_phrase(each) for each in score.phrases]
    for frame in score.frames:
        lines += ["", f"beat {format_beat(frame.beat)}:"]
        lines += [f"  {line}" for line in frame_lines(frame)]
    return "\n".join(lines) + "\n"


def frame_lines(frame: Frame) -> Iterator[str]:
    """The lines under a frame's beat, without indentation."""
    if frame.pose is not None:
        yield f"pose: {frame.pose.name} on {frame.pose.support}"
    yield from _leg_lines(frame)
    yield from _arm_lines(frame)
    for name, part in (("head", frame.head), ("body", frame.body), ("pelvis", frame.pelvis)):
        if part is not None:
            yield f"{name}: {_orientation(part)}"
    yield from _stage_lines(frame)
    if frame.jump is not None:
        yield f"jump: off {format_beat(frame.jump.off)}, on {format_beat(frame.jump.on)}"


def _leg_lines(frame: Frame) -> Iterator[str]:
    support = dict(frame.support)
    if frame.feet is not None:
        left, right = (support.get(side) for side in Side)
        both = left if left is not None and left == right else None
        if both is not None:
            support = {}
        yield ", ".join([f"feet: {feet_name(frame.feet)}", *(_stance(both) if both else ())])
    for side in Side:
        items: list[str] = []
        sign, stance = frame.foot_signs.get(side), support.get(side)
        step = frame.locomotion.get(side)
        if sign is not None:
            items.append(_sign(sign))
            if stance is not None and stance.bend is Bend.STRAIGHT:
                items.append(stance.floor)
                del support[side]
        if step is not None:
            items.append(step.kind)
        items += _path(frame, Limb.of(side, "foot"))
        if items:
            yield f"{side} foot: {', '.join(items)}"
    for side in Side:
        if side in frame.knees:
            yield f"{side} knee: {_sign(frame.knees[side])}"
    for side in Side:
        if side in frame.legs:
            yield f"{side} leg: {_leg(frame.legs[side])}"
        if side in support:
            yield f"{side} leg: {', '.join(_stance(support[side]))}"


def _arm_lines(frame: Frame) -> Iterator[str]:
    left, right = (frame.paths.get(Limb.of(side, "hand")) for side in Side)
    together = frame.arms is not None and left is not None and left == right
    if frame.arms is not None:
        path = _path(frame, Limb.LEFT_HAND) if together else []
        yield ", ".join([f"arms: {arms_name(frame.arms)}", *path])
    for side in Side:
        items = [_sign(frame.hands[side])] if side in frame.hands else []
        if side in frame.contacts:
            items.append(f"on {BODY_PLACES[frame.contacts[side].place][0]}")
        if not together:
            items += _path(frame, Limb.of(side, "hand"))
        if items:
            yield f"{side} hand: {', '.join(items)}"
    for side in Side:
        if side in frame.elbows:
            yield f"{side} elbow: {_sign(frame.elbows[side])}"


def _stage_lines(frame: Frame) -> Iterator[str]:
    if frame.facing is not None:
        yield f"face: {_direction(frame.facing.degrees)}"
    if frame.turn is not None:
        yield f"turn: {format_number(frame.turn.degrees)} {frame.turn.sense}"
    if frame.place is not None:
        yield f"place: {_place(frame.place)}"
    if frame.travel is not None:
        yield f"travel: {_travel(frame.travel)}"


def _path(frame: Frame, limb: Limb) -> list[str]:
    path: PathMark | None = frame.paths.get(limb)
    if path is None:
        return []
    line = "a circle" if path.kind is PathKind.CIRCULAR else "a straight line"
    return [f"by {line} through the {path.via}" if path.via else f"by {line}"]


def _sign(sign: Sign) -> str:
    width, height = format_number(sign.width), format_number(sign.height)
    text = f"{width} wide, {height} high, {sign.depth}"
    return f"{text}, straight" if sign.straight else text


def feet_name(position: FeetPosition) -> str:
    """A position of the feet as a score writes it."""
    name = f"{position.name} open" if position.open else position.name
    return name if position.front is None else f"{name} {position.front} front"


def arms_name(position: ArmsPosition) -> str:
    """A position of the arms as a score writes it."""
    return (
        position.name if position.leading is None else f"{position.name} {position.leading} leads"
    )


def _leg(position: LegPosition) -> str:
    words = [position.name, str(position.direction)]
    if position.degrees is not None:
        words.append(format_number(position.degrees))
    return " ".join(words)


def _stance(support: Support) -> list[str]:
    words: list[str] = []
    if support.bend is not Bend.STRAIGHT or support.floor is FloorContact.FLAT:
        words.append(support.bend)
    if support.floor is not FloorContact.FLAT:
        words.append(support.floor)
    return words


def _orientation(part: Orientation) -> str:
    rotations = [
        f"{name} {positive if amount > 0 else negative} {format_number(abs(amount))}"
        for name, amount, positive, negative in (
            ("turn", part.turn, "left", "right"),
            ("tilt", part.tilt, "left", "right"),
            ("bend", part.bend, "forward", "back"),
        )
        if amount
    ]
    return ", ".join(rotations) or "erect"


def _direction(degrees: float) -> str:
    words = DIRECTION_WORDS.get(degrees)
    if words is not None:
        return words[0]
    return f"{'left' if degrees > 0 else 'right'} {format_number(abs(degrees))}"


def _place(place: StagePlace) -> str:
    amounts = [
        f"{format_number(abs(metres))} {positive if metres > 0 else negative}"
        for metres, positive, negative in (
            (place.left, "left", "right"),
            (place.up, "up", "down"),
        )
        if metres
    ]
    return ", ".join(amounts) or "centre"


def _travel(travel: Travel) -> str:
    text = f"{format_number(travel.metres)} m towards {_direction(travel.degrees)}"
    if not travel.curve:
        return text
    side = Side.LEFT if travel.curve > 0 else Side.RIGHT
    return f"{text}, curving {side} {format_number(abs(travel.curve))}"


def _tempo(score: Score) -> str:
    number = format_number(score.tempo)
    if score.tempo_word is None:
        return number
    meant = tempo_of(score.tempo_word) == score.tempo
    return score.tempo_word if meant else f"{score.tempo_word} {number}"


def _repeat(repeat: Repeat) -> str:
    again = {1: "once", 2: "twice"}.get(repeat.times, f"{repeat.times} times")
    parts = [f"{again} more"]
    if repeat.other_side:
        parts.append("other side")
    for which, (first, last) in zip(("first", "second"), repeat.endings, strict=False):
        parts.append(f"{which} ending {first} to {last}")
    return f"repeat {repeat.first} to {repeat.last}: {', '.join(parts)}"


def _phrase(phrase: Phrase) -> str:
    parts: list[str] = []
    if phrase.effort is not None:
        parts.append(phrase.effort)
    if phrase.tempo_end is not None:
        word = "slowing" if phrase.tempo_end < 1 else "quickening"
        parts.append(f"{word} to {format_number(phrase.tempo_end)}")
    if phrase.name is not None:
        parts.append(json.dumps(phrase.name, ensure_ascii=False))
    return f"phrase {phrase.first} to {phrase.last}: {', '.join(parts)}"


def _text(value: str) -> str:
    """The words themselves, in quotes where they would read as a comment or a quotation."""
    plain = value == value.strip() and "#" not in value and not value.startswith('"')
    return value if plain and value.isprintable() else json.dumps(value, ensure_ascii=False)
