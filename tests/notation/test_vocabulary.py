"""Named positions: every name expands, arms are where their words say, spellings are free."""

from __future__ import annotations

import math
from fractions import Fraction

import pytest

from enpointe.notation import (
    ArmsPosition,
    BodyPlace,
    Depth,
    Direction,
    FeetPosition,
    Frame,
    LegPosition,
    PosePosition,
    Side,
    Sign,
    arm_signs,
    feet_signs,
    leg_signs,
    mirrored,
    names,
    parse_score,
    pose_frame,
)
from enpointe.notation.vocabulary import (
    ARM_PLACES,
    ARMS,
    FEET,
    LEGS,
    POSES,
    find_arms,
    find_feet,
    find_leg,
    find_pose,
    nearest,
)
from enpointe.notation.vocabulary_arms import CONTACT_PLACES

from .texts import START

LINES = (0.0, 0.493, 1.026, 1.331, 1.68, 1.853)
SHOULDER, ROUNDED, STRAIGHT, REACH = 0.155, 0.508, 0.522, 0.678
LEG_LINES = (0.0, 0.493, 0.850, 1.331, 1.68, 1.853)
HIP, THIGH, SHANK, LEG_REACH = 0.083, 0.357, 0.419, 0.859


def test_names_list_the_whole_vocabulary() -> None:
    """Feet, arms, legs and poses, and no name twice."""
    assert names("feet") == ("first", "second", "third", "fourth", "fifth", "fourth open")
    for name in ("fifth en bas", "fifth en avant", "fifth en haut", "à la seconde", "demi-seconde"):
        assert name in names("arms")
    for name in ("tendu derrière", "retiré devant", "raised seconde 45", "attitude derrière 90"):
        assert name in names("leg")
    for name in ("fifth arabesque", "attitude croisée derrière", "écarté", "épaulé"):
        assert name in names("pose")
    parts = (names("feet"), names("arms"), names("leg"), names("pose"))
    assert len(set(names())) == len(names()) == sum(map(len, parts))


@pytest.mark.parametrize("entry", [*ARMS, *FEET, *LEGS, *POSES], ids=lambda entry: entry.name)
def test_each_entry_has_its_source_and_words(entry: object) -> None:
    """No position without a source and a description."""
    assert getattr(entry, "source", "")
    assert getattr(entry, "description", "")


def up(sign: Sign, lines: tuple[float, ...]) -> float:
    """The height of a sign, in metres."""
    line = min(int(sign.height), 5)
    return lines[line - 1] + (sign.height - line) * (lines[line] - lines[line - 1])


@pytest.mark.parametrize("place", ARM_PLACES)
def test_each_place_is_within_reach(place: str) -> None:
    """A wrist in front or behind leaves some depth to the arm; a level one is not beyond it."""
    sign = ARM_PLACES[place].wrist
    height = up(sign, LINES)
    across = sign.width * REACH - SHOULDER if sign.depth is not Depth.LEVEL else 0.0
    arm = STRAIGHT if sign.straight else ROUNDED
    assert math.hypot(height - LINES[3], across) < arm


@pytest.mark.parametrize("entry", ARMS, ids=lambda entry: entry.name)
def test_sides_mirror(entry: object) -> None:
    """Leading with the other arm swaps the arms and changes nothing else."""
    name = getattr(entry, "name", "")
    if not getattr(entry, "needs_leading", False):
        both = arm_signs(ArmsPosition(name))
        assert both[Side.LEFT] == both[Side.RIGHT]
        return
    left, right = (arm_signs(ArmsPosition(name, side)) for side in (Side.LEFT, Side.RIGHT))
    assert left[Side.LEFT] == right[Side.RIGHT] != left[Side.RIGHT] == right[Side.LEFT]
    with pytest.raises(ValueError, match="leading"):
        arm_signs(ArmsPosition(name))


def test_fourth_is_one_arm_of_the_fifth_and_one_of_the_second() -> None:
    """Neagle 2005 §4.2.2."""
    second = arm_signs(ArmsPosition("à la seconde"))[Side.LEFT]
    for level in ("en bas", "en avant", "en haut"):
        fourth = arm_signs(ArmsPosition(f"fourth {level}", Side.RIGHT))
        assert fourth[Side.RIGHT] == arm_signs(ArmsPosition(f"fifth {level}"))[Side.RIGHT]
        assert fourth[Side.LEFT] == second


def test_arms_stand_in_the_order_of_their_heights() -> None:
    """From the thighs to overhead, and second slopes down from the shoulder."""
    place = {name: entry.wrist for name, entry in ARM_PLACES.items()}
    assert place["bas"].height < 3 < place["avant"].height < 4
    assert 5 < place["haut"].height < 6
    assert place["first"].height < place["demi-seconde"].height < place["seconde"].height < 4
    assert place["first"].width < place["demi-seconde"].width < place["seconde"].width


@pytest.mark.parametrize("spelling", ["A LA SECONDE", "à-la-seconde", "a\u0300 la seconde", "2nd"])
def test_spellings_of_the_second(spelling: str) -> None:
    """Accents, case, hyphens and ordinals don't matter."""
    entry = find_arms(spelling)
    assert entry is not None
    assert entry.name == "à la seconde"


def test_feet_say_which_is_in_front_by_their_depth() -> None:
    """Neagle 2005 §4.4.6; first and second are level, and all stand on the floor."""
    for entry in FEET:
        signs = feet_signs(FeetPosition(entry.name, Side.LEFT if entry.crossed else None))
        depths = [signs[side].depth for side in (Side.LEFT, Side.RIGHT)]
        crossed = [Depth.FRONT, Depth.BEHIND]
        assert depths == (crossed if entry.crossed else [Depth.LEVEL, Depth.LEVEL])
        assert {sign.height for sign in signs.values()} == {1.0}
    with pytest.raises(ValueError, match="front"):
        feet_signs(FeetPosition("fifth"))


LEG_FORMS = [(entry, direction) for entry in LEGS for direction in entry.directions]


@pytest.mark.parametrize(("entry", "direction"), LEG_FORMS)
def test_each_leg_is_as_long_as_a_leg(entry: object, direction: Direction) -> None:
    """Thigh and shank reach from hip to knee to ankle, at every height that has a name."""
    name, degrees = getattr(entry, "name", ""), getattr(entry, "degrees", None)
    for height in degrees or (None,):
        signs = leg_signs(LegPosition(name, direction, height))
        points = [(HIP, LEG_LINES[2])]
        for sign in (signs.knee, signs.foot):
            if sign is not None:
                points.append((sign.width * LEG_REACH, up(sign, LEG_LINES)))
        bones = (THIGH, SHANK) if signs.knee else (THIGH + SHANK,)
        marks = [sign for sign in (signs.knee, signs.foot) if sign is not None]
        for (x0, z0), (x1, z1), bone, sign in zip(points, points[1:], bones, marks, strict=False):
            gone = math.hypot(x1 - x0, z1 - z0)
            if signs.support is not None:
                assert gone > bone
            elif sign.depth is Depth.LEVEL:
                assert gone == pytest.approx(bone, abs=0.002)
            else:
                assert gone < bone


@pytest.mark.parametrize(("entry", "direction"), LEG_FORMS)
def test_each_leg_is_where_its_direction_says(entry: object, direction: Direction) -> None:
    """Devant in front, derrière behind; a height makes it higher."""
    name, degrees = getattr(entry, "name", ""), getattr(entry, "degrees", None)
    foot = leg_signs(LegPosition(name, direction)).foot
    if direction is not Direction.SECONDE:
        expected = Depth.FRONT if direction is Direction.DEVANT else Depth.BEHIND
        assert foot.depth is expected
    if degrees is not None:
        low, usual, high = (leg_signs(LegPosition(name, direction, each)).foot for each in degrees)
        assert low.height < usual.height < high.height
        assert usual == foot


def test_legs_stand_in_the_order_of_their_heights() -> None:
    """From the floor by the ankle and the knee to the hip; the attitude's knee is the higher."""

    def height(name: str, degrees: float | None = None) -> float:
        return leg_signs(LegPosition(name, Direction.DERRIERE, degrees)).foot.height

    assert height("tendu") == 1.0
    assert 1 < height("dégagé") < height("cou-de-pied") < 2 < height("retiré") < 3
    assert height("raised") == height("arabesque") == pytest.approx(3, abs=0.01)
    assert height("raised", 45) < 2
    signs = leg_signs(LegPosition("attitude", Direction.DERRIERE))
    assert signs.knee is not None
    assert signs.knee.height > signs.foot.height > 2.5


def test_retire_ends_at_the_knee() -> None:
    """The pointed foot, .19 m beyond the ankle, has its toe at the supporting knee's height."""
    for direction in Direction:
        signs = leg_signs(LegPosition("retiré", direction))
        assert signs.knee is not None
        knee, ankle = (
            (each.width * LEG_REACH, up(each, LEG_LINES)) for each in (signs.knee, signs.foot)
        )
        share = 0.19 / SHANK
        toe = [end + share * (end - start) for start, end in zip(knee, ankle, strict=True)]
        assert toe[1] == pytest.approx(LEG_LINES[1], abs=0.02)
        assert -0.08 < toe[0] < 0


@pytest.mark.parametrize("place", BodyPlace)
def test_each_hand_on_the_body_is_within_reach(place: BodyPlace) -> None:
    """Upper arm and forearm meet at the elbow, in the plane of the body."""
    contact = CONTACT_PLACES[place]
    wrist = (contact.wrist.width * REACH, up(contact.wrist, LINES))
    if contact.elbow is None:
        assert math.dist(wrist, (SHOULDER, LINES[3])) < ROUNDED
        return
    elbow = (contact.elbow.width * REACH, up(contact.elbow, LINES))
    assert math.dist(elbow, (SHOULDER, LINES[3])) == pytest.approx(0.266, abs=0.006)
    assert math.dist(elbow, wrist) == pytest.approx(0.256, abs=0.006)


@pytest.mark.parametrize("name", names())
def test_every_name_can_be_written(name: str) -> None:
    """As `names` lists it, with the side that it needs."""
    part, _, position = name.partition(" ")
    key = {"feet": "feet", "arms": "arms", "leg": "right leg", "pose": "pose"}[part]
    needs: dict[str, bool] = {
        "feet": position not in ("first", "second"),
        "arms": bool((entry := find_arms(position)) and entry.needs_leading),
        "leg": False,
        "pose": True,
    }
    side = {"feet": " right front", "arms": " right leads", "leg": "", "pose": " on right"}[part]
    line = f"{key}: {position}{side if needs[part] else ''}\n"
    assert parse_score(f"{START}beat 1:\n{line}").resolved()


@pytest.mark.parametrize(
    ("spelling", "name", "direction"),
    [
        ("passe", "retiré", None),
        ("EN L'AIR SIDE", "raised", Direction.SECONDE),
        ("pointe tendue à la quatrième devant", "tendu", Direction.DEVANT),
        ("sur le cou-de-pied derrière", "cou-de-pied", Direction.DERRIERE),
        ("arabesque", "arabesque", None),
    ],
)
def test_spellings_of_legs(spelling: str, name: str, direction: Direction | None) -> None:
    """Aliases of the position and of the direction, together."""
    found = find_leg(spelling)
    assert found is not None
    assert (found[0].name, found[1]) == (name, direction)


def test_schools_count_otherwise() -> None:
    """RAD and Vaganova names are aliases that say whose they are."""
    for alias, name in (
        ("RAD first", "fifth en avant"),
        ("RAD third", "fourth en avant"),
        ("bras bas", "fifth en bas"),
        ("Vaganova third", "fifth en haut"),
    ):
        entry = find_arms(alias)
        assert entry is not None
        assert entry.name == name


@pytest.mark.parametrize("entry", POSES, ids=lambda entry: entry.name)
def test_poses_mirror(entry: object) -> None:
    """On the other leg a pose is its mirror image."""
    name, at = getattr(entry, "name", ""), Frame(Fraction(3))
    left, right = (pose_frame(PosePosition(name, side), at) for side in Side)
    assert mirrored(left) == right
    assert set(left.support) == {Side.LEFT}
    assert set(left.legs) == {Side.RIGHT}


def test_croise_is_crossed_and_efface_is_not() -> None:
    """The leg in front is near the audience in croisé and far from it in effacé."""
    for name, near in (("croisé devant", True), ("effacé devant", False)):
        frame = pose_frame(PosePosition(name, Side.LEFT), Frame(Fraction(0)))
        assert frame.facing is not None
        right_side_is_near = frame.facing.degrees > 0
        assert right_side_is_near is near
    assert find_pose("effacé") is find_pose("effacé devant")


def test_unknown_names() -> None:
    """An unknown name finds nothing, raises KeyError, and has near ones."""
    assert find_arms("sixth") is None
    assert find_feet("sixth") is None
    assert nearest("fith en haut", "arms")[0] == "fifth en haut"
    with pytest.raises(KeyError):
        arm_signs(ArmsPosition("sixth"))
    with pytest.raises(KeyError):
        feet_signs(FeetPosition("sixth"))
    with pytest.raises(KeyError):
        leg_signs(LegPosition("sixth"))
    with pytest.raises(ValueError, match="devant"):
        leg_signs(LegPosition("arabesque", Direction.DEVANT))
    with pytest.raises(KeyError):
        pose_frame(PosePosition("sixth", Side.LEFT), Frame(Fraction(0)))
    assert find_leg("retire sideways") is None
    assert nearest("retirer devant", "leg")[0] == "retiré devant"
    assert nearest("second arabeske", "pose")[0] == "second arabesque"


def test_only_arabesques_are_straight() -> None:
    """Rounded arms are the rule, arabesques the exception (Neagle 2005 §4.2.2)."""
    for name, place in ARM_PLACES.items():
        assert place.wrist.straight == name.startswith("arabesque")
        assert isinstance(place.wrist, Sign)
