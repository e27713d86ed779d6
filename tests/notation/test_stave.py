"""The stave: well-formed, within its page, signs on their own side, nothing hidden or unescaped."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import replace
from fractions import Fraction
from itertools import combinations, pairwise
from pathlib import Path
from xml.etree import ElementTree

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from enpointe.notation import (
    ArmsPosition,
    Bend,
    Depth,
    FeetPosition,
    FloorContact,
    Frame,
    Orientation,
    PathKind,
    Score,
    Side,
    Sign,
    StepKind,
    Support,
    Via,
    format_beat,
    load_score,
    shipped_scores,
    stave_svg,
)
from enpointe.notation.glyphs import GLYPHS, orientation
from enpointe.notation.stave import A4, Page, stave_pages
from enpointe.notation.stave_frame import FLOOR, REACH, frame_marks, written
from enpointe.notation.stave_ink import Mark

from .every_sign import every_sign
from .strategies import orientations, scores

SVG = "{http://www.w3.org/2000/svg}"
DOCS = Path(__file__).parents[2] / "docs" / "stave.md"
LEANING = {name for name in GLYPHS if re.match("(joined )?turn |tilt |upright|bend$", name)} | {
    "leader"
}
FIFTH = FeetPosition("fifth", Side.RIGHT)
START = Frame(Fraction(0), feet=FIFTH, arms=ArmsPosition("fifth en bas"))
EMPTY = Score("T", "M", (4, 4), 60.0, (START,))


def score_of(*frames: Frame) -> Score:
    """The start, then a frame on each beat."""
    return replace(
        EMPTY,
        frames=(START, *(replace(each, beat=Fraction(i)) for i, each in enumerate(frames, 1))),
    )


def written_at(beat: int, **parts: object) -> Frame:
    """A frame that writes these parts."""
    return replace(Frame(Fraction(beat)), **parts)  # type: ignore[arg-type]


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


@settings(deadline=None, max_examples=40)
@given(scores(max_frames=16))
def test_any_score_is_drawn(score: Score) -> None:
    """A group for each frame, in order, that carries its beat; all within the paper."""
    svg = stave_svg(score)
    check_document(svg)
    groups = frame_groups(svg)
    assert [group.get("id") for group in groups] == [f"frame-{i}" for i in range(len(score.frames))]
    assert [group.get("data-beat") for group in groups] == [
        format_beat(frame.beat) for frame in score.frames
    ]


@settings(deadline=None, max_examples=20)
@given(scores(max_frames=16), st.sampled_from([A4, Page(297, 210), Page(148, 210, 10, 2.0)]))
def test_pages_hold_every_frame_once(score: Score, page: Page) -> None:
    """Whatever the paper, all frames are on it, none twice, and none beyond its edge."""
    pages = stave_pages(score, page)
    found = [group.get("id") for svg in pages for group in frame_groups(svg)]
    assert found == [f"frame-{i}" for i in range(len(score.frames))]
    for svg in pages:
        check_document(svg)


@settings(deadline=None, max_examples=60)
@given(scores(max_frames=6))
def test_head_and_body_never_hide_a_limb(score: Score) -> None:
    """Signs of head, body and pelvis overlap no hand, foot, elbow or knee, nor each other."""
    for frame, marks in zip(score.frames, marks_of(score), strict=True):
        leaning = [mark for mark in marks if mark.name in LEANING and mark.name != "leader"]
        limbs = [
            mark
            for mark in marks
            if mark.name not in LEANING and not re.match("path|via", mark.name)
        ]
        assert not [(a, b) for a in leaning for b in limbs if a.box.touches(b.box)]
        parts = [each for each in (frame.head, frame.body, frame.pelvis) if each is not None]
        sizes = [len(list(orientation(part))) for part in parts]
        if frame.pose is None:
            assert sum(sizes) == len(leaning)


uncrossed = st.builds(Sign, st.floats(0, 1), st.floats(1, 6), st.sampled_from(Depth))
pairs = st.fixed_dictionaries(dict.fromkeys(Side, uncrossed))


@settings(deadline=None)
@given(hands=pairs, elbows=pairs, feet=pairs, head=st.none() | orientations)
def test_right_is_on_the_right(
    hands: dict[Side, Sign],
    elbows: dict[Side, Sign],
    feet: dict[Side, Sign],
    head: Orientation | None,
) -> None:
    """Seen from behind: no sign goes over the centre line; it may give way outward only."""
    frame = written_at(1, hands=hands, elbows=elbows, foot_signs=feet, head=head)
    marks = list(marks_of(score_of(frame)))[1]
    placed = [mark for mark in marks if mark.name.removeprefix("bend ") in [*Depth]]
    expected = [
        sign for part in (feet, hands, elbows) for sign in (part[Side.LEFT], part[Side.RIGHT])
    ]
    assert len(placed) == len(expected)
    for mark, sign, side in zip(placed, expected, [*Side] * 3, strict=True):
        way = 1 if side is Side.RIGHT else -1
        middle = (mark.box.left + mark.box.right) / 2
        assert mark.name.removeprefix("bend ") == sign.depth
        assert middle * way >= sign.width * REACH - 1e-9


@pytest.mark.parametrize("name", shipped_scores())
def test_shipped_scores_stay_on_the_page(name: str) -> None:
    """In one piece and on pages."""
    score = load_score(name)
    for svg in (stave_svg(score), *stave_pages(score)):
        check_document(svg)


def test_every_sign_is_drawn() -> None:
    """A score that writes all there is to write uses the whole table; no entry is idle."""
    score = every_sign()
    svg = stave_svg(score)
    check_document(svg)
    names = set(re.findall(r'class="sign ([\w-]+)"', svg))
    floors = {name for name in GLYPHS if GLYPHS[name].floor is not None} - {"floor touching"}
    notes = {f"note {unit}" for unit in (1, 2, 8, 16)}
    assert names == {name.replace(" ", "-") for name in set(GLYPHS) - floors - notes}


@pytest.mark.parametrize("unit", [1, 2, 4, 8, 16])
def test_tempo_shows_the_note_of_the_pulse(unit: int) -> None:
    """The metronome mark has the note that the metre counts in."""
    assert f'"sign note-{unit}"' in stave_svg(replace(EMPTY, metre=(3, unit)))


def test_the_table_has_every_kind() -> None:
    """One entry for each value of each kind of sign."""
    kinds = [
        *(depth.value for depth in Depth),
        *(f"bend {depth}" for depth in Depth),
        *(f"floor {floor}" for floor in FloorContact),
        *(f"path {kind}" for kind in PathKind),
        *(f"via {via}" for via in Via),
        *(f"locomotion {kind}" for kind in StepKind),
        *(f"{kind} {side}" for kind in ("crossed", "contact", "turning") for side in Side),
    ]
    assert set(kinds) <= set(GLYPHS)
    for glyph in GLYPHS.values():
        assert glyph.source
        assert glyph.meaning
        assert glyph.stroke or glyph.fill or glyph.text or glyph.floor is not None


def test_provisional_signs_are_listed_in_the_docs() -> None:
    """The list that a choreologist reads is the table's own."""
    rows = re.findall(r"^\| `([^`]+)` \| (.+?) \| (.+?) \|$", DOCS.read_text("utf-8"), re.M)
    table = {name: (glyph.meaning, glyph.source) for name, glyph in GLYPHS.items()}
    provisional = {name for name, glyph in GLYPHS.items() if not glyph.confirmed}
    assert {name: (meaning, source) for name, meaning, source in rows} == {
        name: table[name] for name in provisional
    }
    assert len(rows) == len(provisional)


def test_text_is_escaped() -> None:
    """A title is words, never markup, and XML can hold all of it."""
    title = "<script>alert('x')</script> & \ufffe"
    svg = stave_svg(replace(EMPTY, title=title, method="<b>", tempo_word='"&'))
    assert "<script" not in svg
    assert "<b>" not in svg
    assert ElementTree.fromstring(svg).findtext(f"{SVG}title") == title.replace("\ufffe", "\ufffd")


def test_only_what_is_written_is_drawn() -> None:
    """Unwritten stays as it was and needs no sign; a named position is its signs."""
    svg = stave_svg(score_of(Frame(Fraction(1)), written_at(2, head=Orientation(turn=20))))
    first, empty, head = frame_groups(svg)
    assert drawn(first) == ["behind", "front", "front", "front"]
    assert drawn(empty) == []
    assert drawn(head) == ["turn-left"]


def test_each_frame_says_in_words_what_it_writes() -> None:
    """Its title holds the lines of the score; an empty one says that nothing changes."""
    svg = stave_svg(score_of(written_at(1, head=Orientation(turn=20)), Frame(Fraction(2))))
    first, head, empty = (group.findtext(f"{SVG}title") or "" for group in frame_groups(svg))
    assert "fifth en bas" in first
    assert "turn left 20" in head
    assert "as before" in empty
    assert all(group.get("tabindex") == "0" for group in frame_groups(svg))


def test_click_targets_tile_the_stave() -> None:
    """Each covers its frame from side to side and from top to bottom; none reaches into another."""
    for name in shipped_scores():
        cells = []
        for group in frame_groups(stave_svg(load_score(name))):
            (cell,) = group.iter(f"{SVG}rect")
            x, width = float(cell.attrib["x"]), float(cell.attrib["width"])
            cells.append((float(cell.attrib["y"]), x, x + width))
            inked = [
                float(number)
                for path in group.iter(f"{SVG}path")
                for number in re.findall(r"(-?[\d.]+) -?[\d.]+", path.attrib["d"])
            ]
            assert all(x <= number <= x + width for number in inked)
        for (y1, _, right), (y2, left, _) in pairwise(cells):
            assert y1 < y2 or right <= left + 1e-6


def test_floor_contact_shows_against_the_floor_line() -> None:
    """Flat hangs below, demi-pointe lies on it, pointe stands on it; the air is higher."""
    extents = {}
    for floor in FloorContact:
        support = {side: Support(floor) for side in Side}
        for depth in Depth:
            foot = {Side.LEFT: Sign(0.3, 1.0, depth), Side.RIGHT: Sign(0.3, 1.0, depth)}
            score = score_of(written_at(1, foot_signs=foot, support=support))
            marks = [mark for mark in list(marks_of(score))[1] if mark.name == depth]
            extents[floor, depth] = [(mark.box.top, mark.box.bottom) for mark in marks]
    for depth in Depth:
        assert all(top >= FLOOR for top, _ in extents[FloorContact.FLAT, depth])
        for top, bottom in extents[FloorContact.DEMI_POINTE, depth]:
            assert FLOOR - top == pytest.approx(bottom - FLOOR)
        for floor in (FloorContact.POINTE, FloorContact.TOUCH):
            assert all(bottom <= FLOOR for _, bottom in extents[floor, depth])
    low = score_of(written_at(1, foot_signs={Side.LEFT: Sign(0.3, 1.05, Depth.LEVEL)}))
    (air,) = [mark for mark in list(marks_of(low))[1] if mark.name == "level"]
    assert air.box.bottom < min(top for top, _ in extents[FloorContact.POINTE, Depth.LEVEL])


def test_touching_without_weight_has_its_own_mark() -> None:
    """A pointe tendue is not a foot on pointe."""
    for floor, count in ((FloorContact.TOUCH, 1), (FloorContact.POINTE, 0)):
        frame = written_at(
            1,
            foot_signs={Side.RIGHT: Sign(0.4, 1.0, Depth.LEVEL)},
            support={Side.RIGHT: Support(floor)},
        )
        marks = list(marks_of(score_of(frame)))[1]
        assert [mark.name for mark in marks].count("floor touching") == count


def test_a_plie_bends_the_knees_down_and_out() -> None:
    """Deeper is lower and further out, on either side; straight has no knee sign."""
    knees = {}
    for bend in Bend:
        frame = written_at(1, support={side: Support(bend=bend) for side in Side})
        marks = list(marks_of(score_of(frame)))[1]
        knees[bend] = sorted(
            (mark.box.left, mark.box.top) for mark in marks if mark.name == "bend level"
        )
    assert knees[Bend.STRAIGHT] == []
    (demi_left, demi_right), (left, right) = knees[Bend.DEMI_PLIE], knees[Bend.GRAND_PLIE]
    assert left[0] < demi_left[0] < demi_right[0] < right[0]
    assert left[1] > demi_left[1]


def test_five_positions_look_different() -> None:
    """No two positions of the feet are drawn alike, nor with the other foot in front."""
    positions = [
        FeetPosition(name, front, is_open)
        for name in ("first", "second", "third", "fourth", "fifth")
        for front in ([None] if name in ("first", "second") else list(Side))
        for is_open in ([False, True] if name == "fourth" else [False])
    ]
    shapes = [
        tuple(sorted((mark.name, mark.box.left, mark.box.top) for mark in list(marks_of(score))[1]))
        for score in (score_of(written_at(1, feet=position)) for position in positions)
    ]
    assert all(a != b for a, b in combinations(shapes, 2))


def test_combined_rotations_are_one_sign() -> None:
    """A stem that leans, with its bend and its turn joined to it; erect is a bare stem."""
    head = Orientation(turn=-9, tilt=9, bend=-9)
    svg = stave_svg(score_of(written_at(1, head=head, body=Orientation())))
    assert drawn(frame_groups(svg)[1]) == ["bend", "joined-turn-right", "tilt-left", "upright"]


def test_crossed_and_bent_signs() -> None:
    """A crossed extremity carries its owner's mark; elbows and knees are crosses."""
    frame = written_at(
        1,
        hands={Side.LEFT: Sign(-0.2, 3.0, Depth.FRONT)},
        elbows={Side.LEFT: Sign(0.5, 3.0, Depth.BEHIND)},
        knees={
            Side.LEFT: Sign(0.2, 2.0, Depth.LEVEL),
            Side.RIGHT: Sign(0.2, 2.0, Depth.FRONT),
        },
    )
    group = frame_groups(stave_svg(score_of(frame)))[1]
    assert drawn(group) == [
        "bend-behind", "bend-front", "bend-level", "crossed-left", "front"
    ]  # fmt: skip


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
