"""The shipped scores: the exercises of Neagle 2005 §3.2.2 and the poses of its table 4.2."""

from __future__ import annotations

from fractions import Fraction
from itertools import pairwise

import pytest

from enpointe.notation import (
    FloorContact,
    ResolvedFrame,
    Side,
    load_score,
    shipped_scores,
)

EXERCISES = (
    "third-port-de-bras",
    "fourth-port-de-bras",
    "temps-lie-grand-battement",
    "adage-developpe",
    "grand-jete-en-tournant",
    "glissade-jete-assemble",
)
STEPS = ("releve", "releve-one-foot", "plie-releve", "fondu", "grand-battement")


def at(name: str, beat: Fraction | int) -> ResolvedFrame:
    """What a shipped score means at a beat."""
    return next(frame for frame in load_score(name).resolved() if frame.beat == beat)


def named(frame: ResolvedFrame, side: Side) -> tuple[str, str, float | None]:
    """The position of a working leg."""
    leg = frame.legs[side].named
    assert leg is not None
    return leg.name, str(leg.direction), leg.degrees


def test_all_are_shipped() -> None:
    """The six exercises, the first port de bras, five steps and the evaluation poses."""
    others = {"first-port-de-bras", "evaluation-poses"}
    assert set(shipped_scores()) == {*EXERCISES, *STEPS, *others}


@pytest.mark.parametrize("name", shipped_scores())
def test_each_is_good_and_says_where_it_is_from(name: str) -> None:
    """It resolves, lasts, and names its method."""
    score = load_score(name)
    assert score.method == "Cecchetti"
    assert len(score.performed().resolved()) >= len(score.frames)
    assert score.duration() > 0


@pytest.mark.parametrize("name", shipped_scores())
def test_weight_is_on_a_foot_except_in_the_air(name: str) -> None:
    """No frame floats but those between a take-off and its landing; all jumps have one."""
    frames = load_score(name).performed().resolved()
    flights = [frame.jump for frame in frames if frame.jump is not None]
    for frame in frames:
        flying = any(jump.off < frame.beat < jump.on for jump in flights)
        assert any(leg.bears for leg in frame.legs.values()) is not flying
    for jump in flights:
        assert any(jump.off < frame.beat < jump.on for frame in frames)


def test_port_de_bras() -> None:
    """Key poses as Neagle 2005 §3.2.2 and §5.3.1 count them."""
    third = [load_score("third-port-de-bras").resolved()[i].arms[Side.LEFT].named for i in range(5)]
    names = [position.name if position else None for position in third]
    assert names == [
        "fifth en bas",
        "fifth en haut",
        "fifth en haut",
        "à la seconde",
        "fifth en bas",
    ]
    counts = {"first-port-de-bras": 4, "third-port-de-bras": 9, "fourth-port-de-bras": 9}
    assert {name: len(load_score(name).performed().frames) for name in counts} == counts


def test_temps_lie() -> None:
    """Grand battement devant on 1 and derrière on 3, fourth on 2, fifth on 4; then in reverse."""
    name = "temps-lie-grand-battement"
    for first, third, front, back in ((1, 3, Side.RIGHT, Side.LEFT), (7, 5, Side.RIGHT, Side.LEFT)):
        assert named(at(name, first), front) == ("raised", "devant", 90)
        assert named(at(name, third), back) == ("raised", "derrière", 90)
    for fourth, fifth in ((2, 4), (6, 8)):
        feet = [at(name, beat).feet for beat in (fourth, fifth)]
        assert [each.name for each in feet if each] == ["fourth", "fifth"]


def test_adage() -> None:
    """Développé to 4, relevé on 5, fondu with cou-de-pied derrière, close devant."""
    name = "adage-developpe"
    assert named(at(name, 4), Side.RIGHT) == ("raised", "seconde", 90)
    floors = {leg.support.floor for leg in at(name, 5).legs.values() if leg.support}
    assert floors == {FloorContact.DEMI_POINTE}
    assert named(at(name, 6), Side.LEFT) == ("cou-de-pied", "derrière", None)


def risen(frame: ResolvedFrame) -> set[Side]:
    """The feet that stand on demi-pointe."""
    return {
        side
        for side, leg in frame.legs.items()
        if leg.support and leg.support.floor is FloorContact.DEMI_POINTE
    }


def bent(frame: ResolvedFrame) -> set[Side]:
    """The legs that stand in demi-plié."""
    return {
        side
        for side, leg in frame.legs.items()
        if leg.support and leg.bears and leg.support.bend == "demi-plié"
    }


@pytest.mark.parametrize(
    ("name", "feet"), [("releve", set(Side)), ("releve-one-foot", {Side.LEFT})]
)
def test_eight_releves_in_a_row(name: str, feet: set[Side]) -> None:
    """Up and down on every other count, nothing in between, ending on two flat feet."""
    frames = load_score(name).performed().resolved()
    up = [frame.beat for frame in frames if risen(frame)]
    assert len(up) == 8
    assert {later - earlier for earlier, later in pairwise(up)} == {2}
    assert all(risen(frame) == feet for frame in frames if frame.beat in up)
    assert all(
        frame.beat + 1 in up
        for frame in frames
        if not risen(frame) and frame.beat < up[-1] and frame.beat > up[0]
    )
    assert not risen(frames[-1])
    assert all(leg.bears for leg in frames[-1].legs.values())


def test_plie_releve() -> None:
    """Each relevé comes straight out of a demi-plié of both legs, in first and in second."""
    frames = load_score("plie-releve").performed().resolved()
    rises = [(before, after) for before, after in pairwise(frames) if risen(after)]
    assert [frame.feet.name for _, frame in rises if frame.feet] == ["first"] * 2 + ["second"] * 2
    for before, after in rises:
        assert bent(before) == risen(after) == set(Side)
        assert not bent(after)


def test_fondu() -> None:
    """The supporting knee bends with the other foot at the ankle; both stretch, to 45 degrees."""
    frames = load_score("fondu").performed().resolved()
    for standing, moving in ((Side.LEFT, Side.RIGHT), (Side.RIGHT, Side.LEFT)):
        ways = [
            (named(before, moving)[0], named(after, moving))
            for before, after in pairwise(frames)
            if bent(before) == {standing} and not bent(after)
        ]
        expected = [("raised", way, 45) for way in ("devant", "seconde", "derrière")]
        assert ways == [("cou-de-pied", each) for each in expected]


def test_grand_jete_en_tournant() -> None:
    """It turns half about in the air, and lands in arabesque on the leg that was thrown."""
    name = "grand-jete-en-tournant"
    assert named(at(name, Fraction(7, 2)), Side.LEFT) == ("raised", "devant", 90)
    assert named(at(name, 4), Side.RIGHT)[0] == "arabesque"
    assert at(name, Fraction(7, 2)).facing_degrees - at(name, 4).facing_degrees == 180
    assert load_score(name).performed().resolved()[-1].facing_degrees % 360 == 90


def test_allegro() -> None:
    """Four flights a side, each landing on its count."""
    score = load_score("glissade-jete-assemble")
    landings = [frame.jump.on for frame in score.frames if frame.jump is not None]
    assert landings == [1, 2, 3, 4]


def test_evaluation_poses() -> None:
    """In the words of table 4.2's experimenter."""
    one, two, three, four, five, six = load_score("evaluation-poses").resolved()
    assert one.feet is not None
    assert (one.feet.name, one.feet.front) == ("fifth", Side.RIGHT)
    assert one.head.turn < 0 > one.head.bend
    assert two.feet is not None
    assert (two.feet.name, two.feet.open) == ("fourth", False)
    assert {leg.support.bend for leg in two.legs.values() if leg.support} == {"demi-plié"}
    assert named(three, Side.RIGHT) == ("raised", "devant", 90)
    assert four.pose is not None
    assert four.pose.name == "fourth arabesque"
    assert five.feet is not None
    assert five.feet.name == "first"
    assert five.body.tilt > 0 < five.head.tilt
    assert named(six, Side.LEFT)[0] == "attitude"
    assert six.arms[Side.LEFT].wrist.height > six.arms[Side.RIGHT].wrist.height
    assert six.head.turn < 0
