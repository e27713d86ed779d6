"""Numbers and beats as scores write them."""

from __future__ import annotations

import math
import re
from fractions import Fraction

__all__ = [
    "MAX_BEAT",
    "MAX_DENOMINATOR",
    "beat_number",
    "format_beat",
    "format_number",
    "number",
]

MAX_BEAT = 100_000
MAX_DENOMINATOR = 96

_NUMBER = re.compile(r"[+-]?(?:[0-9]{1,9}(?:\.[0-9]{0,20})?|\.[0-9]{1,20})(?:[eE][+-]?[0-9]{1,3})?")
_WHOLE = re.compile(r"[0-9]{1,6}(\.[0-9]{1,6})?")
_RATIO = re.compile(r"[0-9]{1,6}/[0-9]{1,6}")


def number(text: str) -> float | None:
    """The finite number that the text is, or None."""
    text = text.replace("\u2212", "-")
    if not _NUMBER.fullmatch(text):
        return None
    value = float(text)
    return value if math.isfinite(value) else None


def beat_number(text: str) -> Fraction | None:
    """The beat that the text is, such as "2", "1+1/2" or "2.5"; None if it is none."""
    total = Fraction(0)
    for part in text.replace("\t", " ").split("+"):
        part = part.strip()
        whole = _WHOLE.fullmatch(part)
        ratio = _RATIO.fullmatch(part) and int(part.split("/")[1]) > 0
        if not (whole or ratio):
            return None
        total += Fraction(part)
    return total if total <= MAX_BEAT and total.denominator <= MAX_DENOMINATOR else None


def format_beat(beat: Fraction) -> str:
    """A beat as scores write it: "2", "1/2", "1+1/2"."""
    whole, rest = divmod(beat, 1)
    if not rest:
        return str(whole)
    return f"{whole}+{rest}" if whole else str(rest)


def format_number(value: float) -> str:
    """A number that reads back as the same, without a needless point."""
    return str(int(value)) if value == int(value) else repr(value)
