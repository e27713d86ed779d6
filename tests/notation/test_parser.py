"""Reading scores: what a person writes is understood, what is wrong is named with its place."""

from __future__ import annotations

import os
from fractions import Fraction
from pathlib import Path

import pytest

from enpointe.errors import ScoreError
from enpointe.notation import (
    MAX_BYTES,
    ArmsPosition,
    Depth,
    FeetPosition,
    Location,
    Orientation,
    Side,
    Sign,
    load_score,
    parse_score,
    shipped_scores,
)

HEAD = "benesh 1\ntitle: T\nmethod: Cecchetti\nmetre: 4/4\ntempo: 60\n"
START = HEAD + "beat 0:\n  feet: first\n  arms: first\n"


def frame(lines: str) -> str:
    """A good score, then beat 1 on line 9 and these lines from line 10."""
    return f"{START}beat 1:\n{lines}\n"


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


WRONG = {
    "no header": ("title: T\n", 1, 1, "benesh 1"),
    "empty": ("", 1, 1, "empty"),
    "only blanks": (" \n\t\n", 1, 1, "empty"),
    "only a comment": ("# nothing\n", 1, 1, "benesh 1"),
    "a later version": (START.replace("benesh 1", "benesh 2"), 1, 8, "version '2'"),
    "no title": (START.replace("title: T\n", ""), 5, 1, "lacks its title"),
    "no tempo": (START.replace("tempo: 60\n", ""), 5, 1, "lacks its tempo"),
    "title twice": (HEAD + "title: U\n", 6, 1, "already given on line 2"),
    "unknown field": (HEAD + "composer: X\n", 6, 1, "title, method, metre, tempo"),
    "metre 4/0": (START.replace("4/4", "4/0"), 4, 8, "not a metre"),
    "metre 4/3": (START.replace("4/4", "4/3"), 4, 8, "not a metre"),
    "metre in words": (START.replace("4/4", "waltz"), 4, 8, "not a metre"),
    "tempo 0": (START.replace("60", "0"), 5, 8, "1 to 250"),
    "tempo 251": (START.replace("60", "251"), 5, 8, "1 to 250"),
    "tempo infinite": (START.replace("60", "1e999"), 5, 8, "1 to 250"),
    "tempo nan": (START.replace("60", "nan"), 5, 8, "1 to 250"),
    "tempo empty": (START.replace("tempo: 60", "tempo:"), 5, 7, "some words"),
    "unclosed quote": (START.replace("title: T", 'title: "T'), 2, 8, "some words"),
    "bad escape": (START.replace("title: T", r'title: "\q"'), 2, 8, "backslash"),
    "empty quotes": (START.replace("title: T", 'title: ""'), 2, 8, "missing"),
    "control character": (START.replace("title: T", 'title: "\\u0007"'), 2, 8, "control"),
    "no frames": (HEAD, 5, 1, "no frames"),
    "starts late": (START.replace("beat 0", "beat 1"), 6, 6, "beat 0"),
    "no feet at first": (START.replace("  feet: first\n", ""), 6, 1, "both feet"),
    "one hand at first": (
        START.replace("arms: first", "left hand: 1 wide, 4 high, level"),
        6,
        1,
        "both arms",
    ),
    "beat repeated": (START + "beat 0:\n", 9, 6, "already written on line 6"),
    "beat going back": (frame("beat 1/2:"), 10, 6, "beats go forward"),
    "beat without count": (START + "beat:\n", 9, 5, "a count"),
    "beat over zero": (START + "beat 1/0:\n", 9, 6, "not a beat"),
    "beat plus over zero": (START + "beat 1+1/0:\n", 9, 6, "not a beat"),
    "beat huge": (START + "beat 99999999999999999999:\n", 9, 6, "not a beat"),
    "beat too late": (START + "beat 999999:\n", 9, 6, "not a beat"),
    "beat too fine": (START + "beat 1/997:\n", 9, 6, "not a beat"),
    "beat negative": (START + "beat -1:\n", 9, 6, "not a beat"),
    "unknown part": (frame("  hat: erect"), 10, 3, "head"),
    "misspelt part": (frame("  hed: erect"), 10, 3, "did you mean 'head'"),
    "unknown arms": (frame("  arms: fith en haut"), 10, 9, "fifth en haut"),
    "unlike any arms": (frame("  arms: xyzzy"), 10, 9, "known are first"),
    "unknown feet": (frame("  feet: sixth right front"), 10, 9, "not a position of the feet"),
    "no name": (frame("  arms:"), 10, 8, "end of the line"),
    "fifth without front": (frame("  feet: fifth"), 10, 9, "foot in front"),
    "first with front": (frame("  feet: first left front"), 10, 15, "no foot is in front"),
    "fourth without lead": (frame("  arms: fourth en haut"), 10, 9, "arm that leads"),
    "third without lead": (frame("  arms: third"), 10, 9, "arm that leads"),
    "fifth with lead": (frame("  arms: fifth en bas left"), 10, 22, "both arms do the same"),
    "unknown depth": (frame("  left hand: 1 wide, 4 high, beside"), 10, 30, "'behind'"),
    "no depth": (frame("  left hand: 1 wide, 4 high"), 10, 3, "lacks its depth"),
    "width twice": (frame("  left hand: 1 wide, 1 wide, level"), 10, 22, "written twice"),
    "below the floor": (frame("  left hand: 1 wide, 0.5 high, level"), 10, 22, "1 to 6"),
    "above reach": (frame("  left hand: 1 wide, 6.1 high, level"), 10, 22, "1 to 6"),
    "arm too long": (frame("  left hand: 1.5 wide, 4 high, level"), 10, 14, "out of reach"),
    "infinite width": (frame("  left hand: 1e999 wide, 4 high, level"), 10, 14, "not a number"),
    "huge height": (
        frame("  left hand: 1 wide, 99999999999999999999 high, level"),
        10,
        22,
        "not a number",
    ),
    "nan width": (frame("  left hand: nan wide, 4 high, level"), 10, 14, "a number"),
    "no unit": (frame("  left hand: 1, 4 high, level"), 10, 15, "'wide' or 'high'"),
    "hand twice": (
        frame("  left hand: 1 wide, 4 high, level\n  left hand: 1 wide, 4 high, front"),
        11,
        3,
        "already written",
    ),
    "arms and hand": (
        frame("  arms: first\n  left hand: 1 wide, 4 high, level"),
        11,
        3,
        "contradicts 'arms' on line 10",
    ),
    "elbow and arms": (
        frame("  right elbow: .5 wide, 4 high, level\n  arms: first"),
        11,
        3,
        "contradicts 'right elbow'",
    ),
    "feet and foot": (
        frame("  left foot: 1 wide, 3 high, front\n  feet: first"),
        11,
        3,
        "contradicts",
    ),
    "straight and bent": (
        frame("  left hand: 1 wide, 4 high, level, straight\n  left elbow: .5 wide, 4 high, front"),
        11,
        3,
        "straight and bent",
    ),
    "straight foot": (
        frame("  left foot: 1 wide, 3 high, level, straight"),
        10,
        37,
        "only a hand",
    ),
    "turned twice": (frame("  head: turn left, turn right"), 10, 20, "turn of the head"),
    "erect and tilted": (frame("  head: erect, tilt left"), 10, 14, "end of the line"),
    "turned forward": (frame("  head: turn forward"), 10, 14, "'left' or 'right'"),
    "turned too far": (frame("  head: turn left 720"), 10, 19, "0 to 90"),
    "stray comma": (frame("  head: turn left,"), 10, 19, "end of the line"),
    "nested": (frame("  head: ((((((turn))))))"), 10, 9, "'erect'"),
    "frame in a frame": (frame("  arms: beat 2: feet: first"), 10, 14, "but found '2'"),
    "long line": (frame("  head: " + "turn left, " * 200), 10, 1001, "too long"),
    "binary": (b"PK\x03\x04\n\x00\x00", 2, 1, "binary"),
    "not utf-8": (HEAD.encode() + b"beat 0: \xff\n", 6, 9, "UTF-8"),
    "too large": (b"#" * (MAX_BYTES + 1), 1, 1, "too large"),
    "lone surrogate": (START.replace("title: T", "title: \ud800"), 2, 8, "U+D800"),
    "escape code": (START.replace("title: T", "title: \x1b[0m"), 2, 8, "U+001B"),
}


@pytest.mark.parametrize("case", WRONG)
def test_says_what_is_wrong_and_where(case: str) -> None:
    """Each malformed score: one line, the exact line and column, and what would be right."""
    text, line, column, message = WRONG[case]
    with pytest.raises(ScoreError) as caught:
        parse_score(text, "a.bmn")
    assert (caught.value.line, caught.value.column) == (line, column), caught.value
    assert message in caught.value.message
    assert str(caught.value).startswith(f"a.bmn:{line}:{column}: ")
    assert "\n" not in str(caught.value)


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


@pytest.mark.parametrize("name", shipped_scores())
def test_shipped_scores_are_good(name: str) -> None:
    """All of them read, resolve and go forward."""
    score = load_score(name)
    assert score.method == "Cecchetti"
    assert len(score.resolved()) == len(score.frames)
    assert score.duration() > 0


def test_the_three_port_de_bras_are_shipped() -> None:
    """Key poses as Neagle 2005 §3.2.2 and §5.3.1 count them."""
    counts = {name: len(load_score(name).frames) for name in shipped_scores()}
    for name, count in (
        ("first-port-de-bras", 4),
        ("third-port-de-bras", 9),
        ("fourth-port-de-bras", 9),
    ):
        assert counts[name] == count
