"""The page: frames in their room, staves that follow each other, nothing beyond the paper."""

from __future__ import annotations

import re
from dataclasses import replace
from fractions import Fraction
from itertools import pairwise
from xml.etree import ElementTree

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from enpointe.notation import (
    Depth,
    Frame,
    Locomotion,
    Orientation,
    Score,
    Side,
    Sign,
    StepKind,
    load_score,
    shipped_scores,
    stave_svg,
)
from enpointe.notation.stave import A4, Page, stave_pages

from .staves import EMPTY, START, SVG, check_document, frame_groups, score_of, written_at
from .strategies import scores


@settings(deadline=None, max_examples=20)
@given(scores(max_frames=16), st.sampled_from([A4, Page(297, 210), Page(148, 210, 10, 2.0)]))
def test_pages_hold_every_frame_once(score: Score, page: Page) -> None:
    """Whatever the paper, all frames are on it, none twice, and none beyond its edge."""
    pages = stave_pages(score, page)
    found = [group.get("id") for svg in pages for group in frame_groups(svg)]
    assert found == [f"frame-{i}" for i in range(len(score.frames))]
    for svg in pages:
        check_document(svg)


@pytest.mark.parametrize("name", shipped_scores())
def test_shipped_scores_stay_on_the_page(name: str) -> None:
    """In one piece and on pages."""
    score = load_score(name)
    for svg in (stave_svg(score), *stave_pages(score)):
        check_document(svg)


@pytest.mark.parametrize("unit", [1, 2, 4, 8, 16])
def test_tempo_shows_the_note_of_the_pulse(unit: int) -> None:
    """The metronome mark has the note that the metre counts in."""
    assert f'"sign note-{unit}"' in stave_svg(replace(EMPTY, metre=(3, unit)))


def test_click_targets_tile_the_stave() -> None:
    """Each covers its frame from side to side and from top to bottom; none reaches into another.

    Only locomotion lines begin in the frame before.
    """
    for name in shipped_scores():
        cells = []
        for group in frame_groups(stave_svg(load_score(name))):
            (cell,) = group.iter(f"{SVG}rect")
            x, width = float(cell.attrib["x"]), float(cell.attrib["width"])
            cells.append((float(cell.attrib["y"]), x, x + width))
            inked = [
                float(number)
                for path in group.iter(f"{SVG}path")
                if "locomotion" not in path.get("class", "")
                for number in re.findall(r"(-?[\d.]+) -?[\d.]+", path.attrib["d"])
            ]
            assert all(x - 0.02 <= number <= x + width + 0.02 for number in inked)
        for (y1, _, right), (y2, left, _) in pairwise(cells):
            assert y1 < y2 or right <= left + 0.02


def test_time_takes_room() -> None:
    """The longer until the next frame, the further it stands, but less than in proportion."""
    beats = [Fraction(n) for n in (1, 2, 4, 8)]
    frames = [Frame(beat, head=Orientation(turn=9)) for beat in beats]
    svg = stave_svg(replace(EMPTY, metre=(16, 4), frames=(START, *frames)))
    lefts = [float(cell.attrib["x"]) for g in frame_groups(svg) for cell in g.iter(f"{SVG}rect")]
    short, middle, long = (b - a for a, b in pairwise(lefts[1:]))
    assert short < middle < long
    assert long < 4 * short


def test_long_scores_go_on_in_the_next_stave_and_page() -> None:
    """Staves start with the number of their bar, bars are kept whole, and pages are numbered."""
    score = score_of(*(written_at(0, head=Orientation(turn=9)) for _ in range(400)))
    pages = stave_pages(score)
    assert len(pages) > 1
    for number, svg in enumerate(pages, 1):
        root = ElementTree.fromstring(svg)
        (page_number,) = [each for each in root.iter() if each.get("class") == "page-number"]
        assert page_number.text == str(number)
        for stave in root.iter(f"{SVG}g"):
            if stave.get("class") != "line":
                continue
            beats = [
                Fraction(group.attrib["data-beat"])
                for group in stave
                if group.get("class") == "frame"
            ]
            assert beats[0] == 0 or score.bar(beats[0]) > score.bar(beats[0] - 1)
            bar_numbers = [each.text for each in stave if each.get("class") == "bar-number"]
            assert bar_numbers == ([] if beats[0] == 0 else [str(score.bar(beats[0]))])


def test_a_page_without_room_is_refused() -> None:
    """It says what a stave needs."""
    with pytest.raises(ValueError, match="no room for a stave"):
        Page(50, 50)


def test_text_is_escaped() -> None:
    """A title is words, never markup, and XML can hold all of it."""
    title = "<script>alert('x')</script> & \ufffe"
    svg = stave_svg(replace(EMPTY, title=title, method="<b>", tempo_word='"&'))
    assert "<script" not in svg
    assert "<b>" not in svg
    assert ElementTree.fromstring(svg).findtext(f"{SVG}title") == title.replace("\ufffe", "\ufffd")


def test_each_frame_says_in_words_what_it_writes() -> None:
    """Its title holds the lines of the score; an empty one says that nothing changes."""
    svg = stave_svg(score_of(written_at(1, head=Orientation(turn=20)), Frame(Fraction(2))))
    first, head, empty = (group.findtext(f"{SVG}title") or "" for group in frame_groups(svg))
    assert "fifth en bas" in first
    assert "turn left 20" in head
    assert "as before" in empty
    assert all(group.get("tabindex") == "0" for group in frame_groups(svg))


def test_locomotion_lines_link_the_same_foot() -> None:
    """A slide runs below the stave, from under where the foot was to under where it is."""
    both = {side: Sign(0.4, 1.0, Depth.LEVEL) for side in Side}
    slide = {Side.RIGHT: Locomotion(StepKind.SLIDE)}
    score = score_of(
        written_at(1, foot_signs=both), written_at(2, foot_signs=both, locomotion=slide)
    )
    feet = []
    for group in frame_groups(stave_svg(score))[1:]:
        (foot,) = [path for path in group if path.get("data-limb") == "right foot"]
        feet.append([float(x) for x in re.findall(r"[ML]([\d.]+) ", foot.attrib["d"])])
    (line,) = [path for path in group if path.get("class") == "sign locomotion-slides"]
    start, end = (float(x) for x in re.findall(r"[ML]([\d.]+) ", line.attrib["d"]))
    assert feet[0][0] < start < feet[0][1]
    assert feet[1][0] < end < feet[1][1]
