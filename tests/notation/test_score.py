"""What a score means: unwritten holds, the latest writing wins, beats become seconds."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction

import pytest
from hypothesis import given
from hypothesis import strategies as st

from enpointe.errors import ScoreError
from enpointe.notation import (
    ArmsPosition,
    FeetPosition,
    Frame,
    Location,
    Orientation,
    Score,
    Side,
    arm_signs,
    load_score,
    parse_score,
)

from .strategies import scores
from .texts import IN_FIFTH

HIGH = "left hand: 0.2 wide, 5.5 high, front\n"


def test_unwritten_holds() -> None:
    """An empty frame is the frame before it."""
    first, second = parse_score(IN_FIFTH + "head: turn left 20\nbeat 1:\n").resolved()
    assert replace(second, beat=first.beat) == first
    assert second.head == Orientation(turn=20)
    assert second.body == second.pelvis == Orientation()


def test_a_hand_leaves_the_named_position_alone() -> None:
    """A hand sign overrides its own side only; a name overrides both again."""
    _, raw, named = parse_score(IN_FIFTH + f"beat 1:\n{HIGH}beat 2:\narms: à la seconde").resolved()
    assert raw.arms[Side.LEFT].named is None
    assert raw.arms[Side.LEFT].wrist.height == 5.5
    assert raw.arms[Side.LEFT].rounded
    assert raw.arms[Side.RIGHT].named == ArmsPosition("fifth en bas")
    assert {arm.named for arm in named.arms.values()} == {ArmsPosition("à la seconde")}


def test_an_elbow_lasts_until_its_hand_moves() -> None:
    """A written elbow ends the rounding (Neagle 2005 §4.4.3) until the arm is written anew."""
    text = (
        IN_FIFTH + f"beat 1:\n{HIGH}left elbow: .5 wide, 4.5 high, level\nbeat 2:\nbeat 3:\n{HIGH}"
    )
    _, bent, held, moved = parse_score(text).resolved()
    for frame in (bent, held):
        assert frame.arms[Side.LEFT].elbow is not None
        assert not frame.arms[Side.LEFT].rounded
    assert moved.arms[Side.LEFT].elbow is None
    assert moved.arms[Side.LEFT].rounded


def test_arabesque_arms_are_not_rounded() -> None:
    """Neagle 2005 §4.2.2; written straight by hand means the same."""
    text = IN_FIFTH + "beat 1:\narms: first arabesque left\nbeat 2:\n"
    text += "left hand: 1 wide, 4 high, level, straight"
    _, named, raw = parse_score(text).resolved()
    assert not any(arm.rounded for arm in named.arms.values())
    assert not raw.arms[Side.LEFT].rounded


def test_feet_leave_the_position_one_by_one() -> None:
    """One raised foot leaves the other in its place; a name gathers both, knees straight."""
    text = IN_FIFTH + (
        "beat 1:\nright foot: 1 wide, 3 high, level\nleft knee: .2 wide, 2 high, level\n"
        "beat 2:\nleft foot: 0 wide, 1 high, front\nbeat 3:\nfeet: first"
    )
    _, one, two, gathered = parse_score(text).resolved()
    assert one.feet == FeetPosition("fifth", Side.RIGHT)
    assert set(one.foot_signs) == {Side.RIGHT}
    assert set(one.knees) == {Side.LEFT}
    assert two.feet is None
    assert set(two.foot_signs) == set(Side)
    assert not two.knees
    assert gathered.feet == FeetPosition("first")
    assert not gathered.foot_signs


def test_a_plie_is_a_position_with_knees() -> None:
    """Knees may be written with a named position of the feet."""
    text = IN_FIFTH + "beat 1:\nfeet: first\nleft knee: .3 wide, 2 high, level\n"
    assert set(parse_score(text).resolved()[1].knees) == {Side.LEFT}


def test_everything_resolved_knows_the_line_that_set_it() -> None:
    """Also what was held: errors about a pose point to where it was written."""
    last = parse_score(IN_FIFTH + "beat 1:\nhead: turn left\nbeat 2:\n").resolved()[2]
    assert last.at == Location(11, 1)
    assert last.head.at == Location(10, 1)
    assert last.feet is not None
    assert last.feet.at == Location(7, 7)
    assert last.arms[Side.LEFT].wrist.at == Location(8, 7)


@given(scores())
def test_resolved_frames_are_whole(score: Score) -> None:
    """Every frame has two arms and two feet, and says what its own frame wrote."""
    for written, whole in zip(score.frames, score.resolved(), strict=True):
        assert whole.beat == written.beat
        assert set(whole.arms) == set(whole.legs) == set(Side)
        assert whole.feet is not None or set(whole.foot_signs) == set(Side)
        for side, sign in written.hands.items():
            assert whole.arms[side].wrist == sign
        for side, leg in whole.legs.items():
            assert (leg.position is None) is (leg.foot is not None)
            assert leg.foot == whole.foot_signs.get(side)
            assert leg.knee == whole.knees.get(side)
            on_the_floor = leg.foot is None or leg.foot.height == 1
            assert on_the_floor is (leg.support is not None)
            assert leg.named == written.legs.get(side, leg.named)
            assert leg.support == written.support.get(side, leg.support)
        if written.arms is not None:
            expected = arm_signs(written.arms)
            assert {side: arm.wrist for side, arm in whole.arms.items()} == expected
        for name in ("head", "body", "pelvis"):
            assert getattr(written, name) in (None, getattr(whole, name))


def test_a_score_built_by_hand_is_checked_when_resolved() -> None:
    """Unknown names and missing limbs are ScoreErrors there too."""
    score = load_score("first-port-de-bras")
    bad = [
        Frame(Fraction(0), feet=FeetPosition("first")),
        Frame(Fraction(0), feet=FeetPosition("sixth"), arms=ArmsPosition("first")),
        Frame(Fraction(0), feet=FeetPosition("first"), arms=ArmsPosition("fourth en haut")),
    ]
    for frame in bad:
        with pytest.raises(ScoreError):
            replace(score, frames=(frame,)).resolved()


@given(st.floats(1, 250), st.fractions(0, 1000))
def test_beats_become_seconds(tempo: float, beat: Fraction) -> None:
    """Sixty seconds hold `tempo` beats, by the score's own tempo or another."""
    score = load_score("third-port-de-bras")
    assert score.seconds(beat, tempo) * tempo == pytest.approx(60 * float(beat))
    assert score.seconds(beat) == replace(score, tempo=1.0).seconds(beat, score.tempo)
    assert score.duration(tempo) == score.seconds(8, tempo)


@pytest.mark.parametrize("tempo", [0.0, -60.0, 251.0, float("nan"), float("inf")])
def test_a_tempo_nobody_can_dance(tempo: float) -> None:
    """An overriding tempo has the same bounds as a written one."""
    with pytest.raises(ScoreError, match="tempo"):
        load_score("third-port-de-bras").duration(tempo)


def test_scores_are_values() -> None:
    """Equal scores hash alike; places in the text take no part."""
    one, two = parse_score(IN_FIFTH, "a"), parse_score("\n\n" + IN_FIFTH, "b")
    assert one == two
    assert hash(one) == hash(two)
