"""Free spelling of names: accents, case, hyphens and ordinals don't matter."""

from __future__ import annotations

import difflib
import functools
import unicodedata
from collections.abc import Iterable, Mapping
from typing import TypeVar

__all__ = ["close_to", "fold", "spelt"]

Value = TypeVar("Value")

_ORDINALS = {"1st": "first", "2nd": "second", "3rd": "third", "4th": "fourth", "5th": "fifth"}


@functools.lru_cache(maxsize=1024)
def fold(name: str) -> str:
    """The name without case, accents, hyphens and spare blanks, ordinals spelt out."""
    bare = "".join(
        char
        for char in unicodedata.normalize("NFKD", name.casefold())
        if not unicodedata.combining(char)
    )
    words = bare.replace("-", " ").split()
    return " ".join(_ORDINALS.get(word, word) for word in words)


def spelt(table: Mapping[Value, Iterable[str]]) -> dict[str, Value]:
    """From every folded spelling to what it means."""
    return {fold(word): value for value, words in table.items() for word in words}


def close_to(name: str, table: Mapping[str, Value], count: int = 3) -> tuple[Value, ...]:
    """What is spelt most like a name that isn't known, best first; empty when nothing is."""
    found = difflib.get_close_matches(fold(name), table, n=count, cutoff=0.5)
    return tuple(dict.fromkeys(table[key] for key in found))
