"""Named positions: every name expands, arms are where their words say, spellings are free."""

from __future__ import annotations

import math

import pytest

from enpointe.models import Figure, dancer_model
from enpointe.notation import (
    ArmsPosition,
    Depth,
    FeetPosition,
    Side,
    Sign,
    arm_signs,
    feet_signs,
    names,
)
from enpointe.notation.vocabulary import ARM_PLACES, ARMS, FEET, find_arms, find_feet, nearest

FIGURE = Figure.of(dancer_model())
"""The dancer that the places were chosen on."""


def test_names_list_the_whole_vocabulary() -> None:
    """The five positions of the feet, those of the arms, and no name twice."""
    assert names("feet") == ("first", "second", "third", "fourth", "fifth")
    for name in ("fifth en bas", "fifth en avant", "fifth en haut", "à la seconde", "demi-seconde"):
        assert name in names("arms")
    assert len(set(names())) == len(names()) == len(names("feet")) + len(names("arms"))


@pytest.mark.parametrize("entry", [*ARMS, *FEET], ids=lambda entry: entry.name)
def test_each_entry_has_its_source_and_words(entry: object) -> None:
    """No position without a source and a description."""
    assert getattr(entry, "source", "")
    assert getattr(entry, "description", "")


@pytest.mark.parametrize("place", ARM_PLACES)
def test_each_place_is_within_reach(place: str) -> None:
    """A wrist in front or behind leaves some depth to the arm; a level one is not beyond it.

    So the names mean the same to the dancer as their signs written out, and give way for nobody
    but a dancer of other proportions.
    """
    sign = ARM_PLACES[place].wrist
    shoulder = FIGURE.lines[3]
    across = (
        sign.width * FIGURE.full_width(leg=False) - FIGURE.shoulders[Side.LEFT][1]
        if sign.depth is not Depth.LEVEL
        else 0.0
    )
    arm = FIGURE.stretched_arm if sign.straight else FIGURE.rounded_arm
    assert math.hypot(FIGURE.height(sign.height) - shoulder, across) < arm


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


def test_unknown_names() -> None:
    """An unknown name finds nothing, raises KeyError, and has near ones."""
    assert find_arms("sixth") is None
    assert find_feet("sixth") is None
    assert nearest("fith en haut", "arms")[0] == "fifth en haut"
    with pytest.raises(KeyError):
        arm_signs(ArmsPosition("sixth"))
    with pytest.raises(KeyError):
        feet_signs(FeetPosition("sixth"))


def test_only_arabesques_are_straight() -> None:
    """Rounded arms are the rule, arabesques the exception (Neagle 2005 §4.2.2)."""
    for name, place in ARM_PLACES.items():
        assert place.wrist.straight == name.startswith("arabesque")
        assert isinstance(place.wrist, Sign)
