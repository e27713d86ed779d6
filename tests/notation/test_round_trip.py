"""Writing and reading back, as text and as JSON, and reading what nobody would write."""

from __future__ import annotations

import contextlib
import json
import random
from typing import Any

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from enpointe.errors import ScoreError
from enpointe.notation import (
    Score,
    format_score,
    load_score,
    mirrored,
    parse_score,
    score_from_json,
    score_to_json,
    shipped_scores,
)

from .strategies import scores

SCRAPS = [
    *("beat 1:", "bar 2 beat 1:", "arms:", "right leg:", "pose:", "turn:", "jump: off 1, on 2"),
    *("repeat 1 to 2:", "phrase 1 to 1:", "once more", "second ending 3 to 3", "sad", "time=-3"),
    *(
        "1/0",
        "9" * 30,
        "1e999",
        "nan",
        ":",
        ",",
        "#",
        '"',
        "\\",
        "\n",
        "+",
        "-",
        "=",
        "((",
        "²",
        "٣",
    ),
    *("left", "fifth", "à", "leads", "erect", "on hip", "by a circle", "demi-plié", "retiré", "m"),
    *("\ufeff", "\u2028", "\0", "corner 1", "towards", "curving left", "touching", "open"),
]
MANY = settings(max_examples=10_000, deadline=None, suppress_health_check=list(HealthCheck))


def refusal(text: str) -> ScoreError | None:
    """The error of a text that is no score."""
    try:
        parse_score(text)
    except ScoreError as error:
        return error
    return None


def check_round_trips(score: Score) -> None:
    """To text and back, to JSON and back, and the text is settled."""
    text = format_score(score)
    assert parse_score(text) == score
    assert parse_score(text.encode()) == score
    assert format_score(parse_score(text)) == text
    assert score_from_json(score_to_json(score)) == score
    assert score_from_json(json.dumps(score_to_json(score)).encode()) == score


@given(scores())
def test_text_and_json_read_back_as_the_same_score(score: Score) -> None:
    """Nothing is lost or changed on the way."""
    check_round_trips(score)


@given(scores())
def test_what_is_performed_and_the_other_side_are_scores_too(score: Score) -> None:
    """Repeats written out, and the mirror image, are written and read like any score."""
    for other in (score.performed(), mirrored(score)):
        assert parse_score(format_score(other)) == other


@pytest.mark.soak
@pytest.mark.slow
@settings(MANY)
@given(scores(max_frames=4))
def test_ten_thousand_scores_read_back(score: Score) -> None:
    """The same for many more scores."""
    check_round_trips(score)


@pytest.mark.parametrize("name", shipped_scores())
def test_shipped_scores_read_back(name: str) -> None:
    """The shipped files survive being written anew."""
    score = load_score(name)
    assert parse_score(format_score(score)) == score


@given(scores(max_frames=3), st.data())
def test_mutated_text_is_read_or_refused(score: Score, data: st.DataObject) -> None:
    """Whatever is done to a score, it is a score or a ScoreError whose place is in the text."""
    text = format_score(score)
    for _ in range(data.draw(st.integers(1, 4))):
        start = data.draw(st.integers(0, len(text)))
        stop = data.draw(st.integers(start, min(len(text), start + 12)))
        text = text[:start] + data.draw(st.sampled_from(SCRAPS) | st.text(max_size=4)) + text[stop:]
    error = refusal(text)
    if error is not None:
        lines = text.removeprefix("\ufeff").replace("\r\n", "\n").replace("\r", "\n").split("\n")
        assert 1 <= error.line <= len(lines)
        assert 1 <= error.column <= len(lines[error.line - 1]) + 1
        assert "\n" not in str(error)


@given(st.text() | st.binary())
def test_noise_is_refused(noise: str | bytes) -> None:
    """Noise is never a score and never another exception."""
    with pytest.raises(ScoreError):
        parse_score(noise)


@given(st.sampled_from(shipped_scores()), st.data())
def test_mutated_bytes_are_read_or_refused(name: str, data: st.DataObject) -> None:
    """Flipped bytes in a shipped score are no other exception either."""
    raw = bytearray(format_score(load_score(name)).encode())
    for _ in range(data.draw(st.integers(1, 6))):
        raw[data.draw(st.integers(0, len(raw) - 1))] = data.draw(st.integers(0, 255))
    with contextlib.suppress(ScoreError):
        parse_score(bytes(raw))


@pytest.mark.soak
@pytest.mark.slow
@settings(MANY, max_examples=1000)
@given(scores(max_frames=3), st.integers(0, 2**32))
def test_a_hundred_thousand_mutants_are_read_or_refused(score: Score, seed: int) -> None:
    """A hundred mutants of each of a thousand scores raise a ScoreError or nothing."""
    dice = random.Random(seed)
    text = format_score(score)
    for _ in range(100):
        mutant = text
        for _ in range(dice.randint(1, 4)):
            start = dice.randint(0, len(mutant))
            stop = min(len(mutant), start + dice.choice([0, 0, 1, 2, 6, 20]))
            mutant = mutant[:start] + dice.choice([*SCRAPS, ""]) + mutant[stop:]
        refusal(mutant)


@given(scores(max_frames=3), st.data())
def test_mutated_json_is_read_or_refused(score: Score, data: st.DataObject) -> None:
    """Whatever stands in place of a value, it is a score or a ScoreError with the value's path."""
    whole = score_to_json(score)
    node: Any = whole
    for _ in range(data.draw(st.integers(1, 5))):
        if isinstance(node, dict) and node:
            key: str | int = data.draw(st.sampled_from(sorted(node)))
        elif isinstance(node, list) and node:
            key = data.draw(st.integers(0, len(node) - 1))
        else:
            break
        inside = node[key]
        if data.draw(st.booleans()) or not isinstance(inside, dict | list):
            scrap = st.none() | st.booleans() | st.floats() | st.text(max_size=5) | st.integers()
            value = data.draw(scrap | st.just({"a": 1}) | st.lists(st.integers(), max_size=3))
            node[key] = value
            break
        node = inside
    error = None
    try:
        score_from_json(whole)
    except ScoreError as raised:
        error = raised
    assert error is None or error.message.startswith("$")


@given(st.sampled_from(shipped_scores()), st.data())
def test_mutated_json_text_is_read_or_refused(name: str, data: st.DataObject) -> None:
    """Flipped bytes in JSON are no other exception either."""
    raw = bytearray(json.dumps(score_to_json(load_score(name))).encode())
    for _ in range(data.draw(st.integers(1, 4))):
        raw[data.draw(st.integers(0, len(raw) - 1))] = data.draw(st.integers(0, 255))
    with contextlib.suppress(ScoreError):
        score_from_json(bytes(raw))
