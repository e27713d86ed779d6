"""What holds from frame to frame: legs and their stances, poses, contacts, facing and place."""

from __future__ import annotations

import math

import pytest
from hypothesis import given

from enpointe.notation import (
    Bend,
    BodyPlace,
    FeetPosition,
    FloorContact,
    ResolvedFrame,
    Score,
    Side,
    Support,
    mirrored,
    parse_score,
)

from .strategies import scores
from .texts import IN_FIFTH


def resolved(*beats: str) -> tuple[ResolvedFrame, ...]:
    """The frames after a start in fifth; one string a beat, lines apart by '; '."""
    text = "".join(
        f"beat {i}:\n" + lines.replace("; ", "\n") + "\n" for i, lines in enumerate(beats, 1)
    )
    return parse_score(IN_FIFTH + text).resolved()


def test_a_working_leg_leaves_the_other_where_it_stands() -> None:
    """The supporting leg keeps its place in the position; only its stance changes."""
    _, raised, bent = resolved("right leg: retiré devant", "left leg: demi-plié, demi-pointe")
    assert raised.legs[Side.LEFT].position == FeetPosition("fifth", Side.RIGHT)
    assert raised.legs[Side.LEFT].support == Support()
    assert raised.legs[Side.RIGHT].support is None
    assert raised.knees[Side.RIGHT] == raised.legs[Side.RIGHT].knee
    assert bent.legs[Side.LEFT].position == FeetPosition("fifth", Side.RIGHT)
    assert bent.legs[Side.LEFT].support == Support(FloorContact.DEMI_POINTE, Bend.DEMI_PLIE)
    assert bent.legs[Side.RIGHT] == raised.legs[Side.RIGHT]
    assert [leg.bears for leg in bent.legs.values()] == [True, False]


def test_a_leg_that_comes_down_stands_under_its_hip() -> None:
    """After a jump from one leg to the other only the stance is written."""
    *_, landed = resolved(
        "right leg: raised side 45", "right leg: fondu; left leg: cou-de-pied back"
    )
    leg = landed.legs[Side.RIGHT]
    assert leg.position is None
    assert leg.named is None
    assert leg.foot is not None
    assert leg.foot.height == 1.0
    assert 0 < leg.foot.width < 0.2
    assert leg.support == Support(bend=Bend.DEMI_PLIE)
    assert landed.feet is None


def test_a_tendu_touches_without_weight() -> None:
    """On the floor line, and no weight on it."""
    _, tendu = resolved("right leg: tendu devant")
    leg = tendu.legs[Side.RIGHT]
    assert leg.foot is not None
    assert leg.foot.height == 1.0
    assert leg.support == Support(FloorContact.TOUCH)
    assert not leg.bears


def test_feet_gather_both_legs() -> None:
    """A position of both feet ends names, bends and demi-pointe unless it writes them."""
    *_, gathered, risen = resolved(
        "right leg: retiré devant; left leg: demi-plié",
        "feet: fifth left front",
        "feet: first, demi-pointe",
    )
    assert {leg.position for leg in gathered.legs.values()} == {FeetPosition("fifth", Side.LEFT)}
    assert {leg.support for leg in gathered.legs.values()} == {Support()}
    assert not gathered.foot_signs
    assert {leg.support for leg in risen.legs.values()} == {Support(FloorContact.DEMI_POINTE)}


def test_a_pose_is_all_its_parts_and_the_frame_is_over_it() -> None:
    """Legs, arms, head and facing at once; whatever else is written overrides that part."""
    _, plain, varied = resolved(
        "pose: second arabesque on left",
        "pose: first arabesque on left; left leg: demi-plié; right hand: 1 wide, 4 high, level; "
        "face: audience",
    )
    working = plain.legs[Side.RIGHT].named
    assert working is not None
    assert working.name == "arabesque"
    assert plain.arms[Side.RIGHT].named is not None
    assert plain.head.turn < 0
    assert plain.facing_degrees == 90.0
    assert varied.legs[Side.LEFT].support == Support(bend=Bend.DEMI_PLIE)
    assert varied.arms[Side.RIGHT].named is None
    assert varied.arms[Side.LEFT].named is not None
    assert varied.head.turn == 0.0
    assert varied.facing_degrees == 0.0


def test_feet_over_a_pose_take_both_legs_from_it() -> None:
    """The arms of an arabesque with the feet in fifth."""
    _, frame = resolved("pose: first arabesque on left; feet: fifth left front")
    assert frame.feet == FeetPosition("fifth", Side.LEFT)
    assert not frame.foot_signs


def test_a_hand_stays_on_the_body_until_it_moves() -> None:
    """Its elbow is bent; a sign or a name ends the contact."""
    _, laid, held, moved = resolved("left hand: on hip", "", "left hand: 1 wide, 4 high, level")
    for frame in (laid, held):
        assert frame.contacts[Side.LEFT].place is BodyPlace.HIP
        assert frame.arms[Side.LEFT].elbow is not None
        assert not frame.arms[Side.LEFT].rounded
    assert not moved.contacts
    assert moved.arms[Side.LEFT].elbow is None


def test_facing_adds_up_and_goes_the_shorter_way() -> None:
    """A turn says how far; a facing alone takes the shorter way, half a turn the left one."""
    frames = resolved(
        "face: corner 2", "turn: 360 right", "face: corner 3", "face: corner 1", "face: audience"
    )
    assert [frame.facing_degrees for frame in frames] == [0, 45, -315, -225, -45, 0]
    assert resolved("face: upstage")[-1].facing_degrees == 180


def test_travel_adds_up_to_a_place() -> None:
    """Metres from the centre of the stage; a written place starts anew."""
    frames = resolved("travel: 2 m towards corner 2", "travel: 1 towards upstage", "place: 1 right")
    places = [(frame.place.left, frame.place.up) for frame in frames]
    assert places[1] == pytest.approx((math.sqrt(2), -math.sqrt(2)))
    assert places[2] == pytest.approx((math.sqrt(2), 1 - math.sqrt(2)))
    assert places[3] == (-1, 0)


def test_what_happens_on_the_way_does_not_hold() -> None:
    """Paths, steps, turns and jumps belong to the frame that they arrive at."""
    _, arriving, after = resolved(
        "turn: 90 left; right foot: steps, by a circle; jump: off 0, on 1; left hand: by a circle",
        "",
    )
    assert arriving.turn is not None
    assert arriving.paths
    assert arriving.locomotion
    assert arriving.jump is not None
    assert after.turn is None
    assert after.jump is None
    assert not after.paths
    assert not after.locomotion


@given(scores())
def test_the_mirror_image_resolves_to_the_mirror_image(score: Score) -> None:
    """Left and right change places in everything that a frame means."""
    assert mirrored(mirrored(score)) == score
    for one, other in zip(score.resolved(), mirrored(score).resolved(), strict=True):
        for side in Side:
            this, that = one.arms[side], other.arms[side.other]
            assert (this.wrist, this.elbow, this.rounded) == (that.wrist, that.elbow, that.rounded)
            leg, opposite = one.legs[side], other.legs[side.other]
            assert (leg.foot, leg.knee, leg.support) == (
                opposite.foot,
                opposite.knee,
                opposite.support,
            )
        assert one.head.turn == -other.head.turn
        assert one.body.tilt == -other.body.tilt
        assert one.place.left == pytest.approx(-other.place.left, abs=1e-6)
        assert one.place.up == pytest.approx(other.place.up, abs=1e-6)
        sum_of_facings = (one.facing_degrees + other.facing_degrees + 180) % 360 - 180
        assert sum_of_facings == pytest.approx(0, abs=1e-6)
