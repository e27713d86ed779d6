"""A short score, and reports read back."""

from __future__ import annotations

from fractions import Fraction
from pathlib import Path
from xml.etree import ElementTree

from enpointe.notation import ArmsPosition, FeetPosition, Frame, Score

HOSTILE = "</title><script>alert('x')</script> & \"quotes\" $x^2$ \x08"


def short_score(title: str = "A short phrase") -> Score:
    """From en bas to à la seconde in one beat."""
    frames = (
        Frame(Fraction(0), feet=FeetPosition("first"), arms=ArmsPosition("fifth en bas")),
        Frame(Fraction(1), arms=ArmsPosition("à la seconde")),
    )
    return Score(title, "Cecchetti", (4, 4), 60.0, frames)


def read(report: Path) -> ElementTree.Element:
    """The page as a tree; it is well-formed XML, or this raises."""
    text = report.read_text(encoding="utf-8")
    tree = ElementTree.fromstring(text)
    for element in tree.iter():
        element.tag = element.tag.rpartition("}")[2]
    return tree


def words_of(element: ElementTree.Element) -> str:
    """All text in an element, spaces made single."""
    return " ".join("".join(element.itertext()).split())
