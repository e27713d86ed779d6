"""What the grammar's terminals are called in front of a dancer."""

from __future__ import annotations

import difflib
from collections.abc import Iterable, Sequence

__all__ = ["describe_end", "either", "phrase", "suggest"]

_PHRASES = {
    "FIELD": "a header line (title, method, metre, tempo)",
    "TEXT": "some words (in quotes if they hold a #)",
    "WHEN": "a count such as 0, 1 or 2+1/2",
    "WORD": "the name of a position",
    "NUMBER": "a number",
    "_COLON": "':'",
    "_COMMA": "','",
    "_NL": "the end of the line",
    "$END": "the end of the score",
}

_KEYWORDS = {
    "FIELD": ("title", "method", "metre", "tempo"),
    "BEAT": ("beat",),
    "FEET": ("feet",),
    "ARMS": ("arms",),
    "SIDE": ("left", "right"),
    "LIMB": ("hand", "elbow", "foot", "knee"),
    "PART": ("head", "body", "pelvis"),
    "_FRONT": ("front",),
    "_LEADS": ("leads",),
    "_WIDE": ("wide",),
    "_HIGH": ("high",),
    "DEPTH": ("front", "level", "behind"),
    "STRAIGHT": ("straight",),
    "ERECT": ("erect",),
    "TURN_OR_TILT": ("turn", "tilt"),
    "_BEND": ("bend",),
    "FORWARD_OR_BACK": ("forward", "back"),
}

_A_LINE_OF_A_FRAME = {"FEET", "ARMS", "SIDE", "PART"}


def phrase(terminals: Iterable[str]) -> list[str]:
    """The terminals as people would name them, in the order of the format."""
    expected = set(terminals)
    words: list[str] = []
    if expected >= _A_LINE_OF_A_FRAME:
        expected -= _A_LINE_OF_A_FRAME
        words.append(
            "a line for feet, arms, head, body, pelvis, left or right hand (elbow, foot, knee)"
        )
    for name in (*_KEYWORDS, *_PHRASES):
        if name not in expected:
            continue
        if name in _PHRASES:
            words.append(_PHRASES[name])
            expected.remove(name)
        else:
            words += [f"'{keyword}'" for keyword in _KEYWORDS[name]]
    return words


def either(choices: Sequence[str]) -> str:
    """ "a, b or c"."""
    if len(choices) < 2:
        return "".join(choices) or "nothing more"
    return f"{', '.join(choices[:-1])} or {choices[-1]}"


def suggest(word: str, terminals: Iterable[str]) -> str | None:
    """The expected keyword that the word is most like, if any is."""
    keywords = [each for name in terminals for each in _KEYWORDS.get(name, ())]
    return next(iter(difflib.get_close_matches(word.lower(), sorted(keywords), n=1)), None)


def describe_end(of_score: bool) -> str:
    """What stands where nothing more stands."""
    return "the end of the score" if of_score else "the end of the line"
