"""What tests of the stave need: short scores, and ways to read a drawing back."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import replace
from fractions import Fraction
from typing import Any
from xml.etree import ElementTree

from enpointe.notation import ArmsPosition, FeetPosition, Frame, Score, Side
from enpointe.notation.stave_frame import frame_marks, written
from enpointe.notation.stave_ink import Mark

SVG = "{http://www.w3.org/2000/svg}"
FIFTH = FeetPosition("fifth", Side.RIGHT)
START = Frame(Fraction(0), feet=FIFTH, arms=ArmsPosition("fifth en bas"))
EMPTY = Score("T", "M", (4, 4), 60.0, (START,))


def score_of(*frames: Frame) -> Score:
    """The start, then a frame on each beat."""
    return replace(
        EMPTY,
        frames=(START, *(replace(each, beat=Fraction(i)) for i, each in enumerate(frames, 1))),
    )


def written_at(beat: int, **parts: Any) -> Frame:
    """A frame that writes these parts."""
    return replace(Frame(Fraction(beat)), **parts)


def frame_groups(svg: str) -> list[ElementTree.Element]:
    """The frames' groups in order of drawing."""
    return [
        group
        for group in ElementTree.fromstring(svg).iter(f"{SVG}g")
        if group.get("class") == "frame"
    ]


def drawn(group: ElementTree.Element) -> list[str]:
    """Names of the signs in a frame, hyphens for blanks."""
    return sorted(
        name.removeprefix("sign ")
        for each in group.iter()
        if (name := each.get("class", "")).startswith("sign ") and name != "sign facing"
    )


def marks_of(score: Score) -> Iterator[tuple[Mark, ...]]:
    """The signs in the stave, frame by frame, about each frame's centre line."""
    before = None
    for frame, resolved in zip(score.frames, score.resolved(), strict=True):
        yield frame_marks(written(frame), resolved, before)
        before = resolved


def places(svg: str) -> Iterator[tuple[float, float]]:
    """Every point of every path, and where letters stand, in the view box."""
    for element in ElementTree.fromstring(svg).iter():
        numbers = re.findall(r"-?\d+\.?\d*", element.get("d", ""))
        yield from zip(map(float, numbers[::2]), map(float, numbers[1::2]), strict=True)
        if element.tag == f"{SVG}text":
            yield float(element.attrib["x"]), float(element.attrib["y"])
        if element.tag == f"{SVG}rect":
            x, y = float(element.get("x", 0)), float(element.get("y", 0))
            yield x, y
            yield x + float(element.attrib["width"]), y + float(element.attrib["height"])


def check_document(svg: str) -> None:
    """Well-formed, ids unique, no point outside the paper."""
    root = ElementTree.fromstring(svg)
    ids = [each.attrib["id"] for each in root.iter() if "id" in each.attrib]
    assert len(ids) == len(set(ids))
    *_, width, height = map(float, root.attrib["viewBox"].split())
    assert all(0 <= x <= width + 0.02 and 0 <= y <= height + 0.02 for x, y in places(svg))
