"""The stave: well-formed, one group a frame, signs on the dancer's own side, nothing unescaped."""

from __future__ import annotations

import re
from xml.etree import ElementTree

import pytest
from hypothesis import given

from enpointe.notation import Score, format_beat, load_score, parse_score, shipped_scores, stave_svg
from enpointe.notation.glyphs import GLYPHS

from .strategies import scores

SVG = "{http://www.w3.org/2000/svg}"
START = (
    "benesh 1\ntitle: T\nmethod: M\nmetre: 4/4\ntempo: 60\n"
    "beat 0:\nfeet: fifth right front\narms: fifth en bas\n"
)


def frame_groups(svg: str) -> list[ElementTree.Element]:
    """The frames' groups in order of drawing."""
    return [
        group
        for group in ElementTree.fromstring(svg).iter(f"{SVG}g")
        if group.get("class") == "frame"
    ]


def drawn(group: ElementTree.Element) -> list[str]:
    """Classes of the signs in a frame."""
    return sorted(
        each.get("class", "").removeprefix("sign ")
        for each in group
        if each.get("class", "").startswith("sign ")
    )


@given(scores(max_frames=16))
def test_any_score_is_drawn(score: Score) -> None:
    """Well-formed XML with a group for each frame, in order, that carries its beat."""
    groups = frame_groups(stave_svg(score))
    assert [group.get("id") for group in groups] == [f"frame-{i}" for i in range(len(score.frames))]
    assert [group.get("data-beat") for group in groups] == [
        format_beat(frame.beat) for frame in score.frames
    ]


@pytest.mark.parametrize("name", shipped_scores())
def test_shipped_scores_stay_on_the_page(name: str) -> None:
    """No stroke leaves the view box."""
    svg = stave_svg(load_score(name))
    *_, width, height = map(float, ElementTree.fromstring(svg).attrib["viewBox"].split())
    points = re.findall(r"[ML]([-\d.]+) ([-\d.]+)", svg)
    assert points
    assert all(0 <= float(x) <= width and 0 <= float(y) <= height for x, y in points)


def test_text_is_escaped() -> None:
    """A title is words, never markup, and XML can hold all of it."""
    title = "<script>alert('x')</script> & \ufffe"
    svg = stave_svg(parse_score(START.replace("title: T", f"title: {title}")))
    assert "<script" not in svg
    texts = [each.text for each in ElementTree.fromstring(svg).iter(f"{SVG}text")]
    assert title.replace("\ufffe", "\ufffd") in texts


def test_only_what_is_written_is_drawn() -> None:
    """Unwritten stays as it was and needs no sign; a named position is its signs."""
    first, empty, head = frame_groups(
        stave_svg(parse_score(START + "beat 1:\nbeat 2:\nhead: turn left 20\n"))
    )
    assert drawn(first) == ["behind", "front", "front", "front"]
    assert drawn(empty) == []
    assert drawn(head) == ["turn-left"]


def test_seen_from_behind() -> None:
    """The dancer's right hand is on the right of the page, higher when its arm is."""
    text = START + "beat 1:\nright hand: 1 wide, 4 high, front\nleft hand: .5 wide, 5 high, front\n"
    group = frame_groups(stave_svg(parse_score(text)))[1]
    number = group.find(f"{SVG}text")
    assert number is not None
    centre = float(number.attrib["x"])
    left, right = sorted(
        tuple(map(float, re.findall(r"M([\d.]+) ([\d.]+)", path.attrib["d"])[0]))
        for path in group.iter(f"{SVG}path")
    )
    assert left[0] < centre < right[0]
    assert right[0] - centre == pytest.approx(2 * (centre - left[0]), abs=0.1)
    assert left[1] < right[1]


def test_combined_rotations_are_one_sign() -> None:
    """A stem that leans, with its bend and its turn joined to it."""
    text = START + "beat 1:\nhead: turn right 9, tilt left 9, bend back 9\nbody: erect\n"
    group = frame_groups(stave_svg(parse_score(text)))[1]
    assert drawn(group) == ["bend", "joined-turn-right", "tilt-left", "upright"]


def test_crossed_and_bent_signs() -> None:
    """A crossed extremity carries its mark; elbows and knees are crosses."""
    text = START + (
        "beat 1:\nleft hand: -.2 wide, 3 high, front\nleft elbow: .5 wide, 3 high, behind\n"
        "left knee: .2 wide, 2 high, level\nright knee: .2 wide, 2 high, front\n"
    )
    group = frame_groups(stave_svg(parse_score(text)))[1]
    assert drawn(group) == ["bend-behind", "bend-front", "bend-level", "crossed", "front"]


def test_long_scores_wrap() -> None:
    """More than a stave holds goes on the next, below; twelve frames at most stand side by side."""
    beats = "".join(f"beat {beat}:\n" for beat in range(1, 40))
    svg = stave_svg(parse_score(START + beats))
    rows: dict[str, int] = {}
    for group in frame_groups(svg):
        cell = group.find(f"{SVG}rect")
        assert cell is not None
        rows[cell.attrib["y"]] = rows.get(cell.attrib["y"], 0) + 1
    assert len(rows) > 1
    assert max(rows.values()) <= 12


def test_each_glyph_says_whether_it_is_confirmed() -> None:
    """The three extremity signs and the three bends have sources; provisional ones say so."""
    for name in ("level", "front", "behind", "bend level", "bend front", "bend behind"):
        assert GLYPHS[name].confirmed
    assert not all(glyph.confirmed for glyph in GLYPHS.values())
    for glyph in GLYPHS.values():
        assert glyph.source
        assert bool(glyph.strokes) != bool(glyph.radius)
