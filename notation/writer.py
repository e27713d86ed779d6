"""Writes a score as text that reads back as the same score."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping
from fractions import Fraction

from enpointe.notation.frame import Frame
from enpointe.notation.score import Score
from enpointe.notation.signs import ArmsPosition, FeetPosition, Orientation, Side, Sign

__all__ = ["format_beat", "format_score", "frame_lines"]


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
        f"tempo: {_number(score.tempo)}",
    ]
    for frame in score.frames:
        lines += ["", f"beat {format_beat(frame.beat)}:"]
        lines += [f"  {line}" for line in frame_lines(frame)]
    return "\n".join(lines) + "\n"


def format_beat(beat: Fraction) -> str:
    """A beat as scores write it: "2", "1/2", "1+1/2"."""
    whole, rest = divmod(beat, 1)
    if not rest:
        return str(whole)
    return f"{whole}+{rest}" if whole else str(rest)


def frame_lines(frame: Frame) -> Iterator[str]:
    """The lines under a frame's beat, without indentation."""
    if frame.feet is not None:
        yield f"feet: {_feet(frame.feet)}"
    yield from _limbs("foot", frame.foot_signs)
    yield from _limbs("knee", frame.knees)
    if frame.arms is not None:
        yield f"arms: {_arms(frame.arms)}"
    yield from _limbs("hand", frame.hands)
    yield from _limbs("elbow", frame.elbows)
    for name, part in (("head", frame.head), ("body", frame.body), ("pelvis", frame.pelvis)):
        if part is not None:
            yield f"{name}: {_orientation(part)}"


def _limbs(name: str, signs: Mapping[Side, Sign]) -> Iterator[str]:
    for side in Side:
        if side in signs:
            yield f"{side} {name}: {_sign(signs[side])}"


def _sign(sign: Sign) -> str:
    text = f"{_number(sign.width)} wide, {_number(sign.height)} high, {sign.depth}"
    return f"{text}, straight" if sign.straight else text


def _feet(position: FeetPosition) -> str:
    return position.name if position.front is None else f"{position.name} {position.front} front"


def _arms(position: ArmsPosition) -> str:
    return (
        position.name if position.leading is None else f"{position.name} {position.leading} leads"
    )


def _orientation(part: Orientation) -> str:
    rotations = [
        f"{name} {positive if amount > 0 else negative} {_number(abs(amount))}"
        for name, amount, positive, negative in (
            ("turn", part.turn, "left", "right"),
            ("tilt", part.tilt, "left", "right"),
            ("bend", part.bend, "forward", "back"),
        )
        if amount
    ]
    return ", ".join(rotations) or "erect"


def _number(value: float) -> str:
    return str(int(value)) if value == int(value) else repr(value)


def _text(value: str) -> str:
    """The words themselves, in quotes where they would read as a comment or a quotation."""
    plain = value == value.strip() and "#" not in value and not value.startswith('"')
    return value if plain and value.isprintable() else json.dumps(value, ensure_ascii=False)
