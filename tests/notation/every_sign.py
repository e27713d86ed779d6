"""A score that writes everything that there is to write."""

from __future__ import annotations

from fractions import Fraction

from enpointe.notation import (
    ArmsPosition,
    Bend,
    BodyPlace,
    Depth,
    Facing,
    FeetPosition,
    FloorContact,
    Frame,
    HandContact,
    Jump,
    Limb,
    Locomotion,
    Orientation,
    PathKind,
    PathMark,
    Phrase,
    Repeat,
    Score,
    Side,
    Sign,
    StagePlace,
    StepKind,
    Support,
    Travel,
    Turn,
    Via,
)

L, R = Side.LEFT, Side.RIGHT
FIFTH = FeetPosition("fifth", R)


def _both(
    floor: FloorContact = FloorContact.FLAT, bend: Bend = Bend.STRAIGHT
) -> dict[Side, Support]:
    return {side: Support(floor, bend) for side in Side}


def _frames() -> list[Frame]:
    beat = Fraction
    hands = (Limb.LEFT_HAND, Limb.RIGHT_HAND)
    circular = PathMark(PathKind.CIRCULAR, Via.FRONT)
    return [
        Frame(
            beat(0),
            feet=FIFTH,
            arms=ArmsPosition("fifth en bas"),
            head=Orientation(),
            body=Orientation(),
            pelvis=Orientation(),
            facing=Facing(0),
            place=StagePlace(-2, 3),
        ),
        Frame(
            beat(1),
            feet=FeetPosition("first"),
            arms=ArmsPosition("fifth en haut"),
            paths=dict.fromkeys(hands, circular),
        ),
        Frame(
            beat(3, 2),
            feet=FeetPosition("second"),
            support=_both(bend=Bend.DEMI_PLIE),
            facing=Facing(-45),
        ),
        Frame(
            beat(2),
            support=_both(FloorContact.DEMI_POINTE),
            arms=ArmsPosition("à la seconde"),
            paths={
                Limb.LEFT_HAND: PathMark(PathKind.STRAIGHT, Via.SIDE),
                Limb.RIGHT_HAND: PathMark(PathKind.STRAIGHT, Via.BACK),
            },
        ),
        Frame(beat(9, 4), support=_both(FloorContact.POINTE), turn=Turn(360, R)),
        Frame(beat(11, 4), feet=FeetPosition("third", L), head=Orientation(-20)),
        Frame(
            beat(3),
            feet=FeetPosition("fourth", R),
            support=_both(bend=Bend.GRAND_PLIE),
            travel=Travel(-90, 1.5),
            body=Orientation(0, -10),
        ),
        Frame(beat(10, 3), feet=FeetPosition("fourth", L, True), turn=Turn(540, L)),
        Frame(beat(11, 3), feet=FeetPosition("fourth", R), travel=Travel(45, 2, 90)),
        Frame(
            beat(4),
            foot_signs={R: Sign(0.5, 1, Depth.LEVEL)},
            support={R: Support(FloorContact.TOUCH)},
            head=Orientation(20),
            body=Orientation(0, 10),
            pelvis=Orientation(0, 0, 10),
        ),
        Frame(
            beat(25, 6),
            foot_signs={R: Sign(0.1, 2, Depth.LEVEL)},
            knees={R: Sign(0.4, 2.4, Depth.LEVEL)},
            hands={L: Sign(-0.2, 3.5, Depth.FRONT), R: Sign(-0.1, 4.4, Depth.FRONT)},
            head=Orientation(20, 20, 20),
            travel=Travel(135, 2, -60),
        ),
        Frame(beat(5), feet=FIFTH, contacts={side: HandContact(BodyPlace.HIP) for side in Side}),
        Frame(
            beat(6),
            foot_signs={L: Sign(0.1, 3, Depth.BEHIND)},
            arms=ArmsPosition("first arabesque", R),
            locomotion={R: Locomotion(StepKind.STEP)},
        ),
        Frame(
            beat(7),
            feet=FIFTH,
            support=_both(bend=Bend.DEMI_PLIE),
            locomotion={L: Locomotion(StepKind.SLIDE)},
        ),
        Frame(
            beat(15, 2),
            foot_signs={L: Sign(0.1, 1.5, Depth.BEHIND), R: Sign(0.1, 1.5, Depth.FRONT)},
        ),
        Frame(
            beat(8),
            feet=FeetPosition("fifth", L),
            support=_both(bend=Bend.DEMI_PLIE),
            jump=Jump(beat(29, 4), beat(8)),
        ),
        Frame(
            beat(9),
            hands={side: Sign(0, 4.5, Depth.LEVEL) for side in Side},
            elbows={L: Sign(0.5, 4, Depth.BEHIND), R: Sign(0.5, 4, Depth.FRONT)},
            head=Orientation(-30, 0, -20),
        ),
        Frame(beat(12), feet=FIFTH, arms=ArmsPosition("fifth en bas"), place=StagePlace(4, -4)),
        Frame(beat(25), feet=FIFTH),
        Frame(beat(51, 2), head=Orientation()),
    ]


def every_sign() -> Score:
    """Every kind of sign in, above and below the stave, and between its frames."""
    return Score(
        "Every sign",
        "Cecchetti",
        (4, 4),
        96.0,
        tuple(_frames()),
        tempo_word="allegretto",
        repeats=(
            Repeat(1, 4, 1, other_side=True),
            Repeat(5, 8, 2, endings=((7, 8), (9, 10))),
            Repeat(21, 25, 1, other_side=True),
        ),
        phrases=(
            Phrase(1, 4, "happy"),
            Phrase(5, 7, "time=-3.5,weight=0.41,space=1", 0.7, "soft"),
            Phrase(8, 8, None, 1.4),
        ),
    )
