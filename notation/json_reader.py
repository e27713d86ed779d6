"""Reads the JSON form of a score; json_form.py says what it is."""

from __future__ import annotations

import json
from dataclasses import replace
from typing import Any

from enpointe.errors import ScoreError
from enpointe.notation.amounts import MAX_TIMES, TEMPO_FACTORS
from enpointe.notation.check import faults
from enpointe.notation.header import MAX_TEXT, is_plain, metre_of
from enpointe.notation.json_frame import read_frame
from enpointe.notation.json_values import Node
from enpointe.notation.numerals import MAX_BEAT
from enpointe.notation.parser import MAX_FRAMES, VERSION
from enpointe.notation.phrasing import EFFORTS, Phrase, Repeat, effort_factors, effort_text
from enpointe.notation.plain_text import MAX_BYTES
from enpointe.notation.score import TEMPO_RANGE, Score
from enpointe.notation.tempo import MAX_TEMPO_WORD, is_tempo_word

__all__ = ["MAX_JSON_BYTES", "score_from_json"]

MAX_JSON_BYTES = 10 * MAX_BYTES
"""Largest JSON form that is read: it has more words than the text of the same score."""


def score_from_json(data: dict[str, Any] | str | bytes, source: str | None = None) -> Score:
    """Reads a score from its JSON form.

    Args:
        data: What :func:`~enpointe.notation.json_form.score_to_json` gives, or its text; bytes are
            UTF-8.
        source: The name to give in error messages, such as the file's.

    Returns:
        The score.

    Raises:
        ScoreError: Anything is wrong with it; the message starts with the path to it, such as
            "$.frames[2].hands.left.width". Nothing else is ever raised.
    """
    node = Node(data if isinstance(data, dict) else _loaded(data, source), "$", source)
    if node.need("format").text(MAX_TEXT) != "benesh":
        raise node.fail("the 'format' of a score is 'benesh'")
    version = node.need("version").whole(VERSION, VERSION)
    slowest, fastest = TEMPO_RANGE
    metre = _metre(node.need("metre"))
    pickup, repeats, phrases = node.get("pickup"), node.get("repeats"), node.get("phrases")
    word = node.get("tempo_word")
    score = Score(
        title=_text(node.need("title")),
        method=_text(node.need("method")),
        metre=metre,
        tempo=node.need("tempo").number(slowest, fastest),
        frames=tuple(read_frame(each) for each in node.need("frames").items(MAX_FRAMES)),
        source=source,
        version=version,
        tempo_word=None if word is None else _tempo_word(word),
        repeats=() if repeats is None else tuple(map(_repeat, repeats.items(MAX_FRAMES))),
        phrases=() if phrases is None else tuple(map(_phrase, phrases.items(MAX_FRAMES))),
    )
    if pickup is not None:
        pulses = pickup.beat()
        if pulses >= metre[0]:
            raise pickup.fail(f"fewer beats than the {metre[0]} of a bar are needed")
        score = replace(score, pickup=pulses)
    node.done()
    for fault in faults(score):
        raise ScoreError(f"$.{fault.where}: {fault.message}", 1, 1, source)
    score.resolved()
    return score


def _loaded(data: str | bytes, source: str | None) -> Any:
    """What the text holds, with nothing in it that JSON has not."""
    if len(data) > MAX_JSON_BYTES:
        raise ScoreError(f"too large for a score: more than {MAX_JSON_BYTES} bytes", 1, 1, source)
    try:
        text = data.decode("utf-8-sig") if isinstance(data, bytes) else data.removeprefix("\ufeff")
        return json.loads(text, parse_constant=_no_number, object_pairs_hook=_no_key_twice)
    except json.JSONDecodeError as error:
        raise ScoreError(f"not JSON: {error.msg}", error.lineno, error.colno, source) from None
    except (ValueError, RecursionError) as error:
        reason = "nested too deep" if isinstance(error, RecursionError) else str(error)
        raise ScoreError(f"not JSON that can be read: {reason}", 1, 1, source) from None


def _no_number(name: str) -> Any:
    raise ValueError(f"{name} is not a number")


def _no_key_twice(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    result = dict(pairs)
    if len(result) < len(pairs):
        keys = [key for key, _ in pairs]
        twice = next(key for key in result if keys.count(key) > 1)
        raise ValueError(f"the key {twice[:40]!r} stands twice in one object")
    return result


def _text(node: Node) -> str:
    text = node.text(MAX_TEXT)
    if not text.strip() or not is_plain(text):
        raise node.fail("words without control characters are needed")
    return text


def _tempo_word(node: Node) -> str:
    word = node.text(MAX_TEMPO_WORD)
    if not is_tempo_word(word):
        raise node.fail("a word such as 'Adagio' is needed")
    return word


def _metre(node: Node) -> tuple[int, int]:
    parts = list(node.items(2))
    metre = metre_of(*(part.whole(1, 32) for part in parts)) if len(parts) == 2 else None
    if metre is None:
        raise node.fail("the beats of a bar and 1, 2, 4, 8 or 16 are needed, such as [3, 4]")
    return metre


def _repeat(node: Node) -> Repeat:
    times, other_side, endings = node.get("times"), node.get("other_side"), node.get("endings")
    repeat = Repeat(
        node.need("first").whole(1, MAX_BEAT),
        node.need("last").whole(1, MAX_BEAT),
        1 if times is None else times.whole(1, MAX_TIMES),
        other_side is not None and other_side.flag(),
        () if endings is None else tuple(_ending(each) for each in endings.items(2)),
    )
    node.done()
    return repeat


def _ending(node: Node) -> tuple[int, int]:
    counts = [each.whole(1, MAX_BEAT) for each in node.items(2)]
    if len(counts) != 2:
        raise node.fail("the first and the last count are needed")
    return counts[0], counts[1]


def _phrase(node: Node) -> Phrase:
    effort, tempo_end, name = node.get("effort"), node.get("tempo_end"), node.get("name")
    factor = None if tempo_end is None else tempo_end.number(*TEMPO_FACTORS)
    if tempo_end is not None and factor == 1.0:
        raise tempo_end.fail("an even tempo is none; leave it out")
    phrase = Phrase(
        node.need("first").whole(1, MAX_BEAT),
        node.need("last").whole(1, MAX_BEAT),
        None if effort is None else _effort(effort),
        factor,
        None if name is None else _text(name),
    )
    node.done()
    return phrase


def _effort(node: Node) -> str:
    text = node.text(MAX_TEXT)
    if text in EFFORTS:
        return text
    factors = effort_factors(text)
    if factors is None:
        raise node.fail(
            f"{', '.join(EFFORTS)} or numbers such as 'time=-3.5,weight=0.41,space=1' are needed"
        )
    return effort_text(factors)
