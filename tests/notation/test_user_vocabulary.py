"""A user's own names: they stand for what is under them, on either side."""

from __future__ import annotations

from pathlib import Path

import pytest

from enpointe.errors import ScoreError
from enpointe.notation import (
    Depth,
    FeetPosition,
    Score,
    Side,
    Sign,
    Vocabulary,
    format_score,
    load_score,
    load_vocabulary,
    parse_score,
)

from .texts import START

WORDS = """benesh 1
define arms swan wings:        # the right arm higher
  right hand: 0.9 wide, 4.4 high, behind, straight
  left hand: 0.9 wide, 3.6 high, behind
define leg low passé:
  right foot: 0.1 wide, 1.8 high, front
  right knee: 0.5 wide, 2.4 high, level
define pose dying swan:
  right leg: demi-plié
  left leg: tendu derrière
  arms: swan wings
  head: turn right 20
  face: corner 1
define pose arabesque of ours:
  pose: first arabesque on right
  head: bend back 5
"""


@pytest.fixture
def vocabulary(tmp_path: Path) -> Vocabulary:
    """The words above, from a file."""
    path = tmp_path / "words.bmn"
    path.write_text(WORDS, "utf-8")
    return load_vocabulary(path)


def read(lines: str, vocabulary: Vocabulary) -> Score:
    """A score with these lines at beat 1."""
    return parse_score(START + "beat 1:\n" + lines, None, vocabulary)


def test_a_name_stands_for_its_signs(vocabulary: Vocabulary) -> None:
    """As written with the right, mirrored with the left; the score needs no vocabulary after."""
    right = read("arms: Swan Wings right leads\nright leg: low passe\n", vocabulary)
    left = read("arms: swan wings left leads\nleft leg: low-passé\n", vocabulary)
    high = Sign(0.9, 4.4, Depth.BEHIND, straight=True)
    assert right.frames[1].hands[Side.RIGHT] == left.frames[1].hands[Side.LEFT] == high
    assert right.frames[1].knees[Side.RIGHT] == left.frames[1].knees[Side.LEFT]
    assert parse_score(format_score(left)) == left


def test_a_pose_is_overridden_limb_by_limb(vocabulary: Vocabulary) -> None:
    """The rest of the frame is read over it."""
    frame = read("pose: dying swan on left\nright hand: on hip\nhead: erect\n", vocabulary).frames[
        1
    ]
    assert frame.support[Side.LEFT].bend == "demi-plié"
    assert frame.legs[Side.RIGHT].name == "tendu"
    assert set(frame.hands) == {Side.LEFT}
    assert set(frame.contacts) == {Side.RIGHT}
    assert frame.facing is not None
    assert frame.facing.degrees == 45.0
    assert frame.head is not None
    assert frame.head.turn == 0.0


def test_a_named_part_under_a_sign_goes_over_into_signs(vocabulary: Vocabulary) -> None:
    """The score that comes out contradicts itself nowhere."""
    score = read("pose: arabesque of ours\nleft hand: on hip\n", vocabulary)
    frame = score.frames[1]
    assert frame.arms is None
    assert frame.hands[Side.RIGHT].straight
    assert parse_score(format_score(score)) == score


def test_feet_override_the_legs_of_a_pose(vocabulary: Vocabulary) -> None:
    """A position of both feet takes the legs' place."""
    frame = read("pose: dying swan\nfeet: fifth right front\n", vocabulary).frames[1]
    assert frame.feet == FeetPosition("fifth", Side.RIGHT)
    assert not frame.legs
    assert not frame.support


def test_names_are_listed_and_suggested(vocabulary: Vocabulary) -> None:
    """A misspelt name of the user's is recognised as such."""
    assert vocabulary.names("pose") == ("dying swan", "arabesque of ours")
    with pytest.raises(ScoreError, match="dying swan"):
        read("pose: dyin swan\n", vocabulary)


@pytest.mark.parametrize(
    ("text", "line", "column", "message"),
    [
        ("define arms x:\n right hand: 9 wide, 4 high, front\n", 2, 14, "out of reach"),
        ("benesh 2\n", 1, 8, "version"),
        ("benesh 1\ndefine arms first:\n left hand: on hip\n", 2, 13, "already"),
        ("benesh 1\ndefine arms x:\n", 2, 13, "nothing else"),
        ("benesh 1\ndefine arms x:\n left foot: .1 wide, 2 high, front\n", 2, 13, "nothing else"),
        ("benesh 1\ndefine leg x:\n left foot: .1 wide, 2 high, front\n", 2, 12, "right foot"),
        ("benesh 1\ndefine pose x:\n place: centre\n", 2, 13, "no part of a pose"),
        ("benesh 1\ndefine pose x:\n turn: 90 left\n", 3, 2, "beat 0"),
        ("benesh 1\nbeat 0:\n", 2, 1, "define"),
        ("benesh 1\ndefine feet x:\n", 2, 8, "'arms', 'leg' or 'pose'"),
    ],
)
def test_says_what_is_wrong_and_where(
    tmp_path: Path, text: str, line: int, column: int, message: str
) -> None:
    """Line and column, as in a score."""
    path = tmp_path / "words.bmn"
    path.write_text(text if text.startswith("benesh") else "benesh 1\n" + text, "utf-8")
    with pytest.raises(ScoreError) as caught:
        load_vocabulary(path)
    expected = line if text.startswith("benesh") else line + 1
    assert (caught.value.line, caught.value.column) == (expected, column), caught.value
    assert message in caught.value.message
    assert caught.value.source == str(path)


def test_a_missing_file(tmp_path: Path) -> None:
    """No traceback."""
    with pytest.raises(ScoreError, match="no such"):
        load_vocabulary(tmp_path / "none")
    assert load_score("first-port-de-bras", Vocabulary()) == load_score("first-port-de-bras")
