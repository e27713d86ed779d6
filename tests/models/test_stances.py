"""Where the feet stand, frame after frame: what stays, what turns, what travels."""

from __future__ import annotations

from math import radians

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from enpointe.models import Figure, dancer_model
from enpointe.models.foot_positions import footprints
from enpointe.models.leg_target import Standing
from enpointe.models.stances import Ground
from enpointe.notation import (
    FeetPosition,
    FloorContact,
    ResolvedFrame,
    Side,
    load_score,
    mirrored,
    shipped_scores,
)

from .posing import DANCERS, grounds, targets_of, written_score

FIGURE = Figure.of(dancer_model())
ARMS = "arms: fifth en bas"
FEET = ("first", "second", "third right front", "fourth left front", "fifth right front")


def ball(ground: Ground, side: Side, figure: Figure = FIGURE) -> np.ndarray:
    return ground.prints[side].point(figure.ball_forward)


def follow(*frames: tuple[str, ...]) -> list[Ground]:
    first, *rest = frames
    return grounds(written_score((*first, ARMS), *rest), FIGURE)


def facing_line(degrees: float) -> str:
    return f"face: {'left' if degrees >= 0 else 'right'} {abs(round(degrees))}"


def flat_or_demi(frame: ResolvedFrame, side: Side) -> bool:
    support = frame.legs[side].support
    return support is not None and support.floor in (FloorContact.FLAT, FloorContact.DEMI_POINTE)


@pytest.mark.parametrize("dancer", DANCERS)
@pytest.mark.parametrize("name", shipped_scores())
def test_a_foot_that_stays_keeps_its_ball_over_a_whole_score(name: str, dancer: str) -> None:
    """Of one foot that bears before and after, without travelling, the ball does not move at all.

    Where both feet bear before and after and change their position, the middle of the balls stays.
    """
    figure = Figure.of(dancer_model(DANCERS[dancer]))
    score = load_score(name)
    frames, ground = score.resolved(), grounds(score, figure)
    kept = 0
    for i in range(1, len(frames)):
        if frames[i].place != frames[i - 1].place:
            continue
        before, after = ground[i - 1], ground[i]
        both = [side for side in Side if side in before.prints and side in after.prints]
        if not both or not all(
            flat_or_demi(frame, side) for frame in frames[i - 1 : i + 1] for side in both
        ):
            continue
        kept += 1
        if len(before.prints) == 1 or len(both) == 1:
            moved = [ball(after, s, figure) - ball(before, s, figure) for s in both[:1]]
        else:
            moved = [np.mean([ball(after, s, figure) - ball(before, s, figure) for s in both], 0)]
        assert np.allclose(moved, 0.0, atol=1e-9), f"{name}, beat {frames[i].beat}"
    assert kept > 0


@pytest.mark.parametrize("name", ["first-port-de-bras", "third-port-de-bras"])
def test_feet_that_do_not_change_do_not_move(name: str) -> None:
    first, *rest = grounds(load_score(name), FIGURE)
    for ground in rest:
        for side in Side:
            assert np.allclose(ground.prints[side].ankle, first.prints[side].ankle, atol=1e-12)
            assert ground.prints[side].direction == pytest.approx(first.prints[side].direction)


@given(st.sampled_from(FEET), st.sampled_from(FEET), st.floats(-180, 180), st.floats(-3, 3))
@settings(max_examples=40)
def test_an_echappe_keeps_the_middle(one: str, other: str, facing: float, left: float) -> None:
    """From one position of both feet to another, the middle between the balls stays."""
    where = facing_line(facing), f"place: {abs(left):.2f} {'left' if left >= 0 else 'right'}"
    before, after = follow((f"feet: {one}", *where), (f"feet: {other}",))
    middles = [np.mean([ball(g, side) for side in Side], axis=0) for g in (before, after)]
    assert np.allclose(middles[0], middles[1], atol=1e-9)
    assert before.facing == after.facing


@given(st.floats(15, 720), st.sampled_from(Side))
@settings(max_examples=25)
def test_turning_on_one_foot_keeps_its_ball(degrees: float, sense: Side) -> None:
    """The standing foot turns with the dancer about its ball: a pirouette does not wander."""
    before, after = follow(
        ("left leg: straight, demi-pointe", "right leg: retiré devant"),
        (f"turn: {degrees:.0f} {sense}",),
    )
    assert np.allclose(ball(before, Side.LEFT), ball(after, Side.LEFT), atol=1e-9)
    signed = round(degrees) * (1 if sense is Side.LEFT else -1)
    assert np.degrees(after.facing - before.facing) == pytest.approx(signed, abs=1)
    turned = after.prints[Side.LEFT].direction - before.prints[Side.LEFT].direction
    assert turned == pytest.approx(after.facing - before.facing)


@given(st.floats(0.05, 1.5), st.sampled_from(["audience", "stage left", "upstage", "corner 2"]))
@settings(max_examples=25)
def test_travel_moves_the_feet_by_as_much(metres: float, towards: str) -> None:
    way = {"audience": 0.0, "stage left": 90.0, "upstage": 180.0, "corner 2": 45.0}[towards]
    before, after = follow(
        ("feet: fifth right front",), (f"travel: {metres:.2f} m towards {towards}",)
    )
    step = round(metres, 2) * np.array([np.cos(radians(way)), np.sin(radians(way))])
    for side in Side:
        moved = after.prints[side].ankle - before.prints[side].ankle
        assert np.allclose(moved, step, atol=1e-9)
    assert np.allclose(after.middle - before.middle, step)


def test_a_step_onto_the_other_foot_stays_where_the_dancer_was() -> None:
    """Without travel, one foot takes the other's place about the dancer's middle."""
    stood, stepped = follow(
        ("left leg: straight", "right leg: cou-de-pied devant"),
        ("right leg: straight", "left leg: cou-de-pied derrière"),
    )
    assert set(stood.prints) == {Side.LEFT}
    assert set(stepped.prints) == {Side.RIGHT}
    assert np.allclose(stood.middle, stepped.middle)


def test_a_tendu_and_back_ends_where_it_began() -> None:
    """The standing foot is the anchor, so the fifth closes on its own marks."""
    fifth, tendu, closed = follow(
        ("feet: fifth right front",),
        ("left leg: straight", "right leg: tendu devant"),
        ("feet: fifth right front",),
    )
    assert set(tendu.prints) == {Side.LEFT}
    assert np.allclose(ball(tendu, Side.LEFT), ball(closed, Side.LEFT), atol=1e-9)
    for side in Side:
        if side is Side.LEFT:
            assert np.allclose(ball(fifth, side), ball(tendu, side), atol=1e-9)
        one, other = (g.prints[side].ankle - g.prints[side.other].ankle for g in (fifth, closed))
        assert np.allclose(one, other, atol=1e-9)
        assert np.allclose(fifth.prints[side].ankle, closed.prints[side].ankle, atol=1e-9)


def test_a_jump_on_the_spot_lands_where_it_left() -> None:
    ground = follow(
        ("feet: fifth right front, demi-plié",),
        ("right leg: pointed devant", "left leg: pointed derrière"),
        ("feet: fifth left front, demi-plié",),
    )
    assert ground[1].prints == {}
    assert np.allclose(ground[0].middle, ground[2].middle)


@given(st.floats(-180, 180), st.sampled_from(FEET))
def test_feet_are_laid_out_about_where_the_dancer_faces(facing: float, feet: str) -> None:
    """Facing turns the whole layout about the dancer's middle, which stays at the place."""
    (ground,) = follow((f"feet: {feet}", facing_line(facing), "place: 1 left, 2 up"))
    words = feet.split()
    position = FeetPosition(words[0], Side(words[1]) if len(words) > 1 else None)
    c, s = np.cos(ground.facing), np.sin(ground.facing)
    for side, foot in footprints(FIGURE, position).items():
        x, y = foot.ankle
        place = np.array([-2.0, 1.0]) + np.array([c * x - s * y, s * x + c * y])
        assert np.allclose(ground.prints[side].ankle, place)
        assert ground.prints[side].direction == pytest.approx(foot.direction + ground.facing)
    wanted = radians(round(facing))
    assert np.cos(ground.facing - wanted) == pytest.approx(1)


@pytest.mark.parametrize("name", shipped_scores())
def test_the_mirrored_score_stands_on_the_mirrored_ground(name: str) -> None:
    score = load_score(name)
    for ground, image in zip(grounds(score, FIGURE), grounds(mirrored(score), FIGURE), strict=True):
        assert image.facing == pytest.approx(-ground.facing)
        assert set(image.prints) == {side.other for side in ground.prints}
        for side, foot in ground.prints.items():
            there = image.prints[side.other]
            assert np.allclose(there.ankle, foot.ankle * [1, -1], atol=1e-9)
            assert there.direction == pytest.approx(-foot.direction)


@pytest.mark.parametrize("name", shipped_scores())
def test_targets_stand_on_the_ground_that_was_followed(name: str) -> None:
    score = load_score(name)
    for target, ground in zip(targets_of(name), grounds(score, FIGURE), strict=True):
        assert target.facing == ground.facing
        for side, leg in target.legs.items():
            if isinstance(leg, Standing):
                assert np.allclose(leg.footprint.ankle, ground.prints[side].ankle)
        assert (target.com is not None) is (not ground.prints)
