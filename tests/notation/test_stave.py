"""The stave: well-formed, within its page, signs on their own side, nothing hidden or unescaped."""

from __future__ import annotations

import re
from itertools import combinations
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from enpointe.notation import (
    Bend,
    Depth,
    FeetPosition,
    FloorContact,
    Orientation,
    PathKind,
    Score,
    Side,
    Sign,
    StepKind,
    Support,
    Via,
    format_beat,
    stave_svg,
)
from enpointe.notation.glyphs import GLYPHS, orientation
from enpointe.notation.stave_frame import FLOOR, REACH

from .every_sign import every_sign
from .staves import check_document, drawn, frame_groups, marks_of, score_of, written_at
from .strategies import orientations, scores

DOCS = Path(__file__).parents[2] / "docs" / "stave.md"
LEANING = {name for name in GLYPHS if re.match("(joined )?turn |tilt |upright|bend$", name)} | {
    "leader"
}


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


def test_every_sign_is_drawn() -> None:
    """A score that writes all there is to write uses the whole table; no entry is idle."""
    score = every_sign()
    svg = stave_svg(score)
    check_document(svg)
    names = set(re.findall(r'class="sign ([\w-]+)"', svg))
    floors = {name for name in GLYPHS if GLYPHS[name].floor is not None} - {"floor touching"}
    notes = {f"note {unit}" for unit in (1, 2, 8, 16)}
    assert names == {name.replace(" ", "-") for name in set(GLYPHS) - floors - notes}


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


def test_only_what_is_written_is_drawn() -> None:
    """Unwritten stays as it was and needs no sign; a named position is its signs."""
    svg = stave_svg(score_of(written_at(1), written_at(2, head=Orientation(turn=20))))
    first, empty, head = frame_groups(svg)
    assert drawn(first) == ["behind", "front", "front", "front"]
    assert drawn(empty) == []
    assert drawn(head) == ["turn-left"]


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
