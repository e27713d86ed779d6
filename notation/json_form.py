"""A score as JSON: the same information as its text, for other programs.

What is unwritten in a frame is absent; beats are whole numbers, or strings such as "1+1/2". The
shape is that of score.schema.json (JSON Schema, draft 2020-12), which ships with the package;
reading is as strict as the schema and refuses contradictions besides.
"""

from __future__ import annotations

import json
from fractions import Fraction
from importlib import resources
from typing import Any

from enpointe.notation.frame import Frame
from enpointe.notation.json_reader import score_from_json
from enpointe.notation.numerals import format_beat
from enpointe.notation.phrasing import Phrase, Repeat
from enpointe.notation.score import Score
from enpointe.notation.signs import Orientation, Sign

__all__ = ["score_from_json", "score_schema", "score_to_json"]

Json = dict[str, Any]


def score_schema() -> Json:
    """The JSON Schema (draft 2020-12) of a score's JSON form."""
    file = resources.files("enpointe.notation").joinpath("score.schema.json")
    schema: Json = json.loads(file.read_text("utf-8"))
    return schema


def score_to_json(score: Score) -> Json:
    """A score as what `json.dumps` takes.

    Args:
        score: The score; places in its text are not part of it.

    Returns:
        A dictionary that :func:`score_from_json` reads as an equal score.
    """
    result: Json = {
        "format": "benesh",
        "version": score.version,
        "title": score.title,
        "method": score.method,
        "metre": list(score.metre),
        "tempo": score.tempo,
    }
    if score.tempo_word is not None:
        result["tempo_word"] = score.tempo_word
    if score.pickup:
        result["pickup"] = _beat(score.pickup)
    if score.repeats:
        result["repeats"] = [_repeat(repeat) for repeat in score.repeats]
    if score.phrases:
        result["phrases"] = [_phrase(phrase) for phrase in score.phrases]
    result["frames"] = [_frame(frame) for frame in score.frames]
    return result


def _beat(beat: Fraction) -> int | str:
    return int(beat) if beat.denominator == 1 else format_beat(beat)


def _repeat(repeat: Repeat) -> Json:
    result: Json = {"first": repeat.first, "last": repeat.last, "times": repeat.times}
    if repeat.other_side:
        result["other_side"] = True
    if repeat.endings:
        result["endings"] = [list(ending) for ending in repeat.endings]
    return result


def _phrase(phrase: Phrase) -> Json:
    return {
        "first": phrase.first,
        "last": phrase.last,
        **_written(effort=phrase.effort, tempo_end=phrase.tempo_end, name=phrase.name),
    }


def _frame(frame: Frame) -> Json:
    feet, arms, pose = frame.feet, frame.arms, frame.pose
    place, travel, turn, jump = frame.place, frame.travel, frame.turn, frame.jump
    return {
        "beat": _beat(frame.beat),
        **_written(
            pose=pose and {"name": pose.name, "support": pose.support},
            feet=feet and {**_written(name=feet.name, front=feet.front), **_if(open=feet.open)},
            foot_signs=_signs(frame.foot_signs),
            knees=_signs(frame.knees),
            legs={
                side: _written(name=leg.name, direction=leg.direction, degrees=leg.degrees)
                for side, leg in frame.legs.items()
            },
            support={
                side: {"floor": stance.floor, "bend": stance.bend}
                for side, stance in frame.support.items()
            },
            arms=arms and _written(name=arms.name, leading=arms.leading),
            hands=_signs(frame.hands),
            elbows=_signs(frame.elbows),
            contacts={side: contact.place for side, contact in frame.contacts.items()},
            head=_orientation(frame.head),
            body=_orientation(frame.body),
            pelvis=_orientation(frame.pelvis),
            facing=frame.facing.degrees if frame.facing else None,
            place=place and {"left": place.left, "up": place.up},
            travel=travel
            and {"degrees": travel.degrees, "metres": travel.metres, "curve": travel.curve},
            turn=turn and {"degrees": turn.degrees, "sense": turn.sense},
            paths={
                limb: _written(kind=path.kind, via=path.via) for limb, path in frame.paths.items()
            },
            locomotion={side: line.kind for side, line in frame.locomotion.items()},
            jump=jump and {"off": _beat(jump.off), "on": _beat(jump.on)},
        ),
    }


def _signs(signs: Any) -> Json:
    return {side: _sign(sign) for side, sign in signs.items()}


def _sign(sign: Sign) -> Json:
    plotted = {"width": sign.width, "height": sign.height, "depth": sign.depth}
    return {**plotted, **_if(straight=sign.straight)}


def _orientation(part: Orientation | None) -> Json | None:
    return None if part is None else {"turn": part.turn, "tilt": part.tilt, "bend": part.bend}


def _written(**values: Any) -> Json:
    """Those that are written, as plain JSON values."""
    return {
        name: _plain(value) for name, value in values.items() if value is not None and value != {}
    }


def _if(**flags: bool) -> Json:
    return {name: True for name, flag in flags.items() if flag}


def _plain(value: Any) -> Any:
    """Names of the notation as bare strings."""
    if isinstance(value, dict):
        return {str(key): _plain(each) for key, each in value.items()}
    return str(value) if isinstance(value, str) else value
