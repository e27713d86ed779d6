"""Reading scores: what a person writes is understood, what is wrong is named with its place."""

from __future__ import annotations

import os
from fractions import Fraction
from pathlib import Path

import pytest

from enpointe.errors import ScoreError
from enpointe.notation import (
    ArmsPosition,
    Bend,
    BodyPlace,
    Depth,
    Direction,
    Facing,
    FeetPosition,
    FloorContact,
    HandContact,
    Jump,
    LegPosition,
    Limb,
    Location,
    Locomotion,
    Orientation,
    PathKind,
    PathMark,
    Phrase,
    PosePosition,
    Repeat,
    Side,
    Sign,
    StagePlace,
    StepKind,
    Support,
    Travel,
    Turn,
    Via,
    load_score,
    parse_score,
)

from .texts import START, frame, headed


def test_reads_every_kind_of_line() -> None:
    """Keywords in any case, accents or none, comments, any indentation and any order of a sign."""
    score = parse_score(
        START
        + "BEAT 1+1/2: # and a half\n"
        + "Feet: 5th, RIGHT front\n"
        + "\t arms: A LA SECONDE\n"
        + "head: turn left 30, tilt right, bend back 5\n"
        + "  # a remark\n\n"
        + "beat 2+1/3:\n"
        + "left hand: level, 4 high, \u22120.25 wide\n"
        + "right hand: .5 wide, 4.5 high, front, straight\n"
        + "left elbow: 5e-1 wide, 4 high, behind\n"
        + "right knee: 0.3 wide, 2 high, level\n"
        + "body: erect"
    )
    _, second, third = score.frames
    assert second.beat == Fraction(3, 2)
    assert third.beat == Fraction(7, 3)
    assert second.feet == FeetPosition("fifth", Side.RIGHT)
    assert second.arms == ArmsPosition("à la seconde")
    assert second.head == Orientation(30, -15, -5)
    assert third.hands == {
        Side.LEFT: Sign(-0.25, 4, Depth.LEVEL),
        Side.RIGHT: Sign(0.5, 4.5, Depth.FRONT, straight=True),
    }
    assert third.elbows == {Side.LEFT: Sign(0.5, 4, Depth.BEHIND)}
    assert third.knees == {Side.RIGHT: Sign(0.3, 2, Depth.LEVEL)}
    assert third.body == Orientation()


def test_everything_knows_its_place() -> None:
    """Locations count lines and columns from 1, comments and blank lines included."""
    score = parse_score(frame("\n   left hand: 1 wide, 4 high, level\n  head: erect"))
    assert score.frames[1].at == Location(9, 1)
    assert score.frames[1].hands[Side.LEFT].at == Location(11, 4)
    assert score.frames[1].head is not None
    assert score.frames[1].head.at == Location(12, 3)


@pytest.mark.parametrize("mark", [b"", b"\xef\xbb\xbf"])
@pytest.mark.parametrize("end", ["\n", "\r\n", "\r"])
def test_any_line_ends_and_a_byte_order_mark(mark: bytes, end: str) -> None:
    """Files of every system read as the same score, errors at the same place."""
    assert parse_score(mark + START.replace("\n", end).encode()) == parse_score(START)
    with pytest.raises(ScoreError) as caught:
        parse_score(mark + frame("  arms: fith en haut").replace("\n", end).encode())
    assert (caught.value.line, caught.value.column) == (10, 9)


def test_quoted_titles_hold_anything() -> None:
    """A '#' opens a comment unless it is in quotes."""
    assert parse_score(START.replace("title: T", 'title: "Study #3"')).title == "Study #3"
    assert parse_score(START.replace("title: T", "title: Study # 3")).title == "Study"


def test_reads_the_legs_and_how_they_stand() -> None:
    """Named legs, stances of one leg or both, floor contact on a foot's own line."""
    first, second, third = parse_score(
        START.replace("feet: first", "feet: fourth ouverte right front, fondu, half point")
        + "beat 1:\nright leg: en l'air side 60\nleft leg: relevé\n"
        + "beat 2:\nleft foot: .1 wide, 1 high, level, pointe, slides\nright leg: passé devant\n"
    ).frames
    assert first.feet == FeetPosition("fourth", Side.RIGHT, open=True)
    low = Support(FloorContact.DEMI_POINTE, Bend.DEMI_PLIE)
    assert first.support == {Side.LEFT: low, Side.RIGHT: low}
    assert second.legs == {Side.RIGHT: LegPosition("raised", Direction.SECONDE, 60)}
    assert second.support == {Side.LEFT: Support(FloorContact.DEMI_POINTE)}
    assert third.support == {Side.LEFT: Support(FloorContact.POINTE)}
    assert third.locomotion == {Side.LEFT: Locomotion(StepKind.SLIDE)}
    assert third.legs == {Side.RIGHT: LegPosition("retiré", Direction.DEVANT)}


def test_reads_contact_and_paths() -> None:
    """Hands on the body, and movement lines with and without a sign."""
    text = "left hand: on the hips\nright hand: .2 wide, 4 high, front, by an arc through front\n"
    second, third = parse_score(
        START + "beat 1:\n" + text + "beat 2:\narms: first, by a straight line\n"
    ).frames[1:]
    assert second.contacts == {Side.LEFT: HandContact(BodyPlace.HIP)}
    assert second.paths == {Limb.RIGHT_HAND: PathMark(PathKind.CIRCULAR, Via.FRONT)}
    straight = PathMark(PathKind.STRAIGHT)
    assert third.paths == {Limb.LEFT_HAND: straight, Limb.RIGHT_HAND: straight}
    assert third.arms == ArmsPosition("first")


def test_reads_what_stands_below_the_stave() -> None:
    """Facing, place, travel and turn, and a jump."""
    _, second, third, fourth = parse_score(
        START
        + "beat 1:\nface: corner 1\nplace: 0.5 m left, 1.2 up\n"
        + "beat 2:\nface: point 2\ntravel: 2 m towards right 30, curving left 90\n"
        + "beat 3:\nturn: right 720\nplace: center\njump: off 2+1/2, on 3\n"
    ).frames
    assert second.facing == third.facing == Facing(-45)
    assert second.place == StagePlace(0.5, 1.2)
    assert third.travel == Travel(-30, 2, 90)
    assert fourth.turn == Turn(720, Side.RIGHT)
    assert fourth.place == StagePlace()
    assert fourth.jump == Jump(Fraction(5, 2), Fraction(3))


@pytest.mark.parametrize(
    ("words", "degrees"),
    [
        ("audience", 0),
        ("wall 5", 0),
        ("corner 2", 45),
        ("stage left", 90),
        ("wall 6", 90),
        ("corner 3", 135),
        ("upstage", 180),
        ("corner 4", -135),
        ("point 3", -90),
        ("left 10", 10),
        ("right 12.5", -12.5),
    ],
)
def test_directions(words: str, degrees: float) -> None:
    """Cecchetti's corners and walls, the points of other schools, degrees to either side."""
    assert parse_score(START + f"beat 1:\nface: {words}\n").frames[1].facing == Facing(degrees)


def test_reads_a_named_pose() -> None:
    """A pose with the leg to stand on, by an alias too."""
    score = parse_score(START + "beat 1:\npose: attitude croisee on right\nhead: erect\n")
    assert score.frames[1].pose == PosePosition("attitude croisée derrière", Side.RIGHT)


def test_reads_what_stands_above_the_stave() -> None:
    """Tempo in words, pickup, repeats with endings, phrases."""
    score = parse_score(
        START.replace("tempo: 60", "tempo: allegro")
        .replace("beat 0", "pickup: 1/2\nREPEAT 1 to 4: twice, on the other side\nbeat 0")
        .replace(
            "beat 0",
            "repeat 5 to 8: 3 times more, first ending 7 to 8, second ending 9 to 9\nbeat 0",
        )
        .replace("beat 0", 'phrase 1 to 4: time=-3.5, space=1, slowing to .8, "one #1"\nbeat 0')
        .replace("beat 0", "phrase 5 to 6: Sad\nbeat 0")
        + "beat 9:\n"
    )
    assert (score.tempo, score.tempo_word) == (138, "allegro")
    assert score.pickup == Fraction(1, 2)
    assert score.repeats == (
        Repeat(1, 4, 2, other_side=True),
        Repeat(5, 8, 3, endings=((7, 8), (9, 9))),
    )
    assert score.phrases == (
        Phrase(1, 4, "time=-3.5,space=1", 0.8, "one #1"),
        Phrase(5, 6, "sad"),
    )


def test_bars_are_another_way_to_count() -> None:
    """A beat of a bar is a beat of the score, after the pickup."""
    text = headed("pickup: 1") + "bar 1 beat 1:\nbar 2 beat 4+1/2:\n"
    assert [frame.beat for frame in parse_score(text).frames] == [0, 2, Fraction(19, 2)]


def test_ten_thousand_lines_need_no_deep_stack() -> None:
    """A long score is only long."""
    beats = "".join(f"beat {beat}:\n  head: turn left 9\n" for beat in range(1, 5001))
    assert len(parse_score(START + beats).frames) == 5001


def test_loads_shipped_scores_and_files(tmp_path: Path) -> None:
    """A name on the shelf comes first; anything else is a path."""
    path = tmp_path / "mine.bmn"
    path.write_text(START, "utf-8")
    assert load_score(path) == load_score(str(path)) == parse_score(START)
    assert load_score(path).source == str(path)
    assert load_score("first-port-de-bras").source == "first-port-de-bras"


@pytest.mark.parametrize("name", ["third-port-de-bra", "no/such.bmn", "a\0b", "x" * 5000, ""])
def test_what_is_not_there(name: str) -> None:
    """A missing score is a ScoreError too, with the nearest shipped names."""
    with pytest.raises(ScoreError) as caught:
        load_score(name)
    if name.startswith("third"):
        assert "third-port-de-bras" in caught.value.message


def test_refuses_what_is_no_file(tmp_path: Path) -> None:
    """A folder or a pipe is not read."""
    os.mkfifo(tmp_path / "pipe")
    for path in (tmp_path, tmp_path / "pipe"):
        with pytest.raises(ScoreError, match="not a file"):
            load_score(path)


def test_refuses_a_large_file_unread(tmp_path: Path) -> None:
    """The size alone decides: the file is sparse and would take its time to read."""
    path = tmp_path / "large.bmn"
    with path.open("wb") as file:
        file.truncate(50_000_000)
    with pytest.raises(ScoreError, match="too large"):
        load_score(path)
