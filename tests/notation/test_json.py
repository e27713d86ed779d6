"""The JSON form: as strict as its schema, and with a path to whatever is wrong."""

from __future__ import annotations

import json
import re
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given

from enpointe.errors import ScoreError
from enpointe.notation import (
    Score,
    load_score,
    score_from_json,
    score_schema,
    score_to_json,
    shipped_scores,
)

from .strategies import scores

SCHEMA = score_schema()
KINDS: dict[str, type | tuple[type, ...]] = {
    "object": dict,
    "array": list,
    "string": str,
    "integer": int,
    "number": (int, float),
    "boolean": bool,
}


def fits(value: Any, schema: Any) -> bool:
    """Whether a value fits a schema, for the words of JSON Schema that ours uses."""
    if isinstance(schema, bool):
        return schema
    kind = schema.get("type")
    if kind and (
        not isinstance(value, KINDS[kind]) or isinstance(value, bool) != (kind == "boolean")
    ):
        return False
    checks = [
        "$ref" not in schema or fits(value, SCHEMA["$defs"][schema["$ref"].rsplit("/", 1)[1]]),
        "const" not in schema or value == schema["const"],
        "enum" not in schema or value in schema["enum"],
        "anyOf" not in schema or any(fits(value, each) for each in schema["anyOf"]),
        "pattern" not in schema or re.search(schema["pattern"], value) is not None,
        "minimum" not in schema or value >= schema["minimum"],
        "maximum" not in schema or value <= schema["maximum"],
        "exclusiveMinimum" not in schema or value > schema["exclusiveMinimum"],
        len(value) >= schema.get("minLength", 0) if isinstance(value, str) else True,
        len(value) <= schema.get("maxLength", len(value)) if isinstance(value, str) else True,
    ]
    if isinstance(value, list):
        first = schema.get("prefixItems", [])
        checks.append(all(map(fits, value, first)))
        checks += [fits(each, schema.get("items", True)) for each in value[len(first) :]]
        checks.append(schema.get("minItems", 0) <= len(value) <= schema.get("maxItems", 10**9))
    if isinstance(value, dict):
        known = schema.get("properties", {})
        checks.append(schema.get("additionalProperties", True) or set(value) <= set(known))
        checks.append(set(schema.get("required", ())) <= set(value))
        checks += [fits(each, known.get(key, True)) for key, each in value.items()]
    return all(checks)


@given(scores())
def test_every_score_fits_the_schema(score: Score) -> None:
    """What we write is what the schema says."""
    assert fits(score_to_json(score), SCHEMA)


@pytest.mark.parametrize("name", shipped_scores())
def test_shipped_scores_fit_the_schema(name: str) -> None:
    """The shipped scores too."""
    assert fits(score_to_json(load_score(name)), SCHEMA)


def good() -> dict[str, Any]:
    """A small good score."""
    return {
        "format": "benesh",
        "version": 1,
        "title": "T",
        "method": "M",
        "metre": [4, 4],
        "tempo": 60,
        "frames": [
            {"beat": 0, "feet": {"name": "first"}, "arms": {"name": "first"}},
            {"beat": "1+1/2", "head": {"turn": 10}},
        ],
    }


def test_the_least_is_enough() -> None:
    """What has a usual value may be left out."""
    score = score_from_json(good())
    assert score.frames[1].beat == 1.5
    assert score.frames[1].head is not None
    assert score.frames[1].head.tilt == 0.0


HAND = {"width": 0.5, "height": 4, "depth": "front"}
FRAME_FAULTS = {
    "unknown key": ({"hat": 1}, "$.frames[1]: 'hat'"),
    "side as width": (
        {"hands": {"left": {**HAND, "width": "wide"}}},
        "$.frames[1].hands.left.width",
    ),
    "truth as width": (
        {"hands": {"left": {**HAND, "width": True}}},
        "$.frames[1].hands.left.width",
    ),
    "nan": ({"hands": {"left": {**HAND, "width": float("nan")}}}, "$.frames[1].hands.left.width"),
    "out of reach": ({"hands": {"left": {**HAND, "height": 7}}}, "$.frames[1].hands.left.height"),
    "no depth": ({"hands": {"left": {"width": 0, "height": 4}}}, "'depth' is missing"),
    "straight foot": ({"foot_signs": {"left": {**HAND, "straight": True}}}, "'straight'"),
    "unknown arms": ({"arms": {"name": "sixth"}}, "$.frames[1].arms"),
    "no lead": ({"arms": {"name": "fourth en haut"}}, "$.frames[1].arms"),
    "no front": ({"feet": {"name": "fifth"}}, "$.frames[1].feet"),
    "open first": ({"feet": {"name": "first", "open": True}}, "$.frames[1].feet"),
    "wrong direction": (
        {"legs": {"left": {"name": "arabesque", "direction": "devant"}}},
        "$.frames[1].legs.left",
    ),
    "both": ({"hands": {"left": HAND}, "arms": {"name": "first"}}, "$.frames[1]: "),
    "face and turn": ({"facing": 0, "turn": {"degrees": 90, "sense": "left"}}, "contradicts"),
    "no turn": ({"turn": {"degrees": 0, "sense": "left"}}, "$.frames[1].turn"),
    "late jump": ({"jump": {"off": 1, "on": 2}}, "$.frames[1].jump"),
    "standing in the air": (
        {"foot_signs": {"left": HAND}, "support": {"left": {"floor": "flat"}}},
        "$.frames[1].support.left",
    ),
}


@pytest.mark.parametrize("case", FRAME_FAULTS)
def test_says_which_value_of_a_frame_is_wrong(case: str) -> None:
    """The path in the message leads to it."""
    extra, message = FRAME_FAULTS[case]
    data = good()
    data["frames"][1].update(extra)
    with pytest.raises(ScoreError) as caught:
        score_from_json(data, "a.json")
    assert message in caught.value.message
    assert caught.value.source == "a.json"


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"version": 2}, "$.version"),
        ({"format": "laban"}, "format"),
        ({"metre": [4, 3]}, "$.metre"),
        ({"tempo": 0}, "$.tempo"),
        ({"pickup": 4}, "$.pickup"),
        ({"title": " "}, "$.title"),
        ({"frames": []}, "no frames"),
        ({"frames": {}}, "$.frames"),
        ({"repeats": [{"first": 1, "last": 9}]}, "$.repeats[0]"),
        ({"repeats": [{"first": 1, "last": 1, "endings": [[1, 1]]}]}, "ending"),
        ({"phrases": [{"first": 1, "last": 1}]}, "says nothing"),
        ({"phrases": [{"first": 1, "last": 1, "effort": "glad"}]}, "$.phrases[0].effort"),
    ],
)
def test_says_which_value_of_the_heading_is_wrong(change: dict[str, Any], message: str) -> None:
    """Paths, again."""
    with pytest.raises(ScoreError) as caught:
        score_from_json({**good(), **change})
    assert message in caught.value.message


@pytest.mark.parametrize(
    "text",
    [
        "",
        "{",
        "[]",
        "null",
        '{"a": 1, "a": 2}',
        '{"tempo": NaN}',
        "[" * 100_000,
        "1" * 5000,
        b"\xff",
    ],
)
def test_what_is_no_json(text: str | bytes) -> None:
    """Refused like any other wrong score."""
    with pytest.raises(ScoreError):
        score_from_json(text)


def test_a_file_is_read_by_its_contents(tmp_path: Path) -> None:
    """Whatever it is called."""
    score = load_score("first-port-de-bras")
    path = tmp_path / "score.bmn"
    path.write_text("\ufeff \n" + json.dumps(score_to_json(score)), "utf-8")
    assert load_score(path) == score
