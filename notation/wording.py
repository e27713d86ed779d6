"""What the grammar's terminals are called in front of a dancer."""

from __future__ import annotations

import difflib
from collections.abc import Iterable, Sequence

__all__ = ["describe_end", "either", "phrase", "quoted", "suggest"]

_PHRASES = {
    "FIELD": "a header line (title, method, metre, tempo, pickup, repeat, phrase)",
    "TEXT": "some words (in quotes if they hold a #)",
    "QUOTED": "a name in quotes",
    "WHEN": "a count such as 0, 1 or 2+1/2",
    "MOMENT": "a count such as 2 or 1+1/2",
    "WORD": "a name",
    "NUMBER": "a number",
    "_METRES": "'m'",
    "_COLON": "':'",
    "_EQUALS": "'='",
    "_COMMA": "','",
    "_NL": "the end of the line",
    "$END": "the end of the score",
}

_KEYWORDS = {
    "FIELD": ("title", "method", "metre", "tempo", "pickup"),
    "REPEAT": ("repeat",),
    "PHRASE": ("phrase",),
    "ONCE_OR_TWICE": ("once", "twice"),
    "_TIMES": ("times",),
    "_MORE": ("more",),
    "OTHER_SIDE": ("other side",),
    "FIRST_OR_SECOND": ("first", "second"),
    "_ENDING": ("ending",),
    "FACTOR": ("time", "weight", "space"),
    "SLOWING_OR_QUICKENING": ("slowing", "quickening"),
    "_TO": ("to",),
    "BAR": ("bar",),
    "BEAT": ("beat",),
    "DEFINE": ("define",),
    "KIND": ("arms", "leg", "pose"),
    "FEET": ("feet",),
    "ARMS": ("arms",),
    "POSE": ("pose",),
    "SIDE": ("left", "right"),
    "LIMB": ("hand", "elbow", "foot", "knee"),
    "LEG": ("leg",),
    "PART": ("head", "body", "pelvis"),
    "FACE": ("face",),
    "PLACE": ("place",),
    "TRAVEL": ("travel",),
    "TURN": ("turn",),
    "JUMP": ("jump",),
    "_FRONT": ("front",),
    "_LEADS": ("leads",),
    "_WIDE": ("wide",),
    "_HIGH": ("high",),
    "DEPTH": ("front", "level", "behind"),
    "STRAIGHT": ("straight",),
    "_ON": ("on",),
    "_BY": ("by",),
    "ERECT": ("erect",),
    "TURN_OR_TILT": ("turn", "tilt"),
    "_BEND": ("bend",),
    "FORWARD_OR_BACK": ("forward", "back"),
    "CENTRE": ("centre",),
    "UP_OR_DOWN": ("up", "down"),
    "_TOWARDS": ("towards",),
    "_CURVING": ("curving",),
    "_OFF": ("off",),
}

_A_LINE_OF_A_FRAME = frozenset(
    ("FEET", "ARMS", "POSE", "SIDE", "PART", "FACE", "PLACE", "TRAVEL", "TURN", "JUMP")
)
_IN_THE_HEADER = frozenset(("FIELD", "REPEAT", "PHRASE"))


def phrase(terminals: Iterable[str]) -> list[str]:
    """The terminals as people would name them, in the order of the format."""
    expected = set(terminals)
    words: list[str] = []
    if expected >= _A_LINE_OF_A_FRAME:
        expected -= _A_LINE_OF_A_FRAME
        words.append(
            "a line for feet, arms, head, body, pelvis, left or right hand (elbow, foot, knee, "
            "leg), pose, face, place, travel, turn, jump"
        )
    if expected >= _IN_THE_HEADER:
        expected -= _IN_THE_HEADER
        words.append(_PHRASES["FIELD"])
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


def quoted(choices: Sequence[str]) -> str:
    """ "'a', 'b' or 'c'"."""
    return either([f"'{each}'" for each in choices])


def suggest(word: str, terminals: Iterable[str]) -> str | None:
    """The expected keyword that the word is most like, if any is."""
    keywords = [each for name in terminals for each in _KEYWORDS.get(name, ())]
    return next(iter(difflib.get_close_matches(word.lower(), sorted(keywords), n=1)), None)


def describe_end(of_score: bool) -> str:
    """What stands where nothing more stands."""
    return "the end of the score" if of_score else "the end of the line"
