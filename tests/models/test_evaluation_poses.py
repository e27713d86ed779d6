"""The six poses that teachers named and notators wrote: Neagle 2005 §4.7, table 4.2, both ways.

From the score to the pose, and from the pose back to the names of the table and to the signs.
"""

from __future__ import annotations

import numpy as np
import pytest

from enpointe.models.joints import Joints
from enpointe.models.recognition import Recognition
from enpointe.notation import Bend, FloorContact, Side, Support, load_score

from .posing import solved, solver_of
from .vocabulary import recogniser

NAMES = (
    "feet fifth right front, arms fourth en haut right leads",
    "feet fourth right front, arms fifth en avant",
    "right leg raised devant 90, arms fifth en haut",
    "pose fourth arabesque on left",
    "feet first, arms fifth en haut",
    "left leg attitude derrière 90, arms fourth en haut left leads",
)
TIPPED = 1
"""The fourth in demi-plié: its hips give way by some 9 degrees, which no teacher would have."""
FRAMES = load_score("evaluation-poses").resolved()


def seen(index: int) -> Recognition:
    return recogniser().recognise(solved("evaluation-poses", index).qpos)


def looks_at(index: int, hand: Side) -> float:
    """Angle between where the face points and where a hand is, degrees."""
    joints = Joints.of(solver_of("default").model, solved("evaluation-poses", index).qpos)
    middle = 0.5 * (joints["left_shoulder"] + joints["right_shoulder"])
    towards = joints[f"{hand}_wrist"] - middle
    return float(np.degrees(np.arccos(joints.head[:, 0] @ towards / np.linalg.norm(towards))))


@pytest.mark.parametrize("index", range(6))
def test_each_is_certified_and_called_as_in_the_table(index: int) -> None:
    pose = solved("evaluation-poses", index)
    assert pose.held or (index == TIPPED and pose.certificate.legal)
    found = seen(index)
    assert found.name == NAMES[index]
    assert found.named
    assert found.distance < 3.0


@pytest.mark.parametrize("index", range(6))
def test_signs_come_back_as_they_were_written(index: int) -> None:
    """Within a tenth of a stave unit and two degrees."""
    wanted, found = FRAMES[index], seen(index).signs
    for side in Side:
        hand, read = wanted.arms[side].wrist, found.hands[side]
        assert read.width == pytest.approx(hand.width, abs=0.1)
        assert read.height == pytest.approx(hand.height, abs=0.1)
        assert read.depth is hand.depth
        leg, back = wanted.legs[side], found.legs[side]
        assert back.support == leg.support
        if leg.foot is not None and leg.support is None:
            assert back.foot.width == pytest.approx(leg.foot.width, abs=0.1)
            assert back.foot.height == pytest.approx(leg.foot.height, abs=0.1)
            assert back.foot.depth is leg.foot.depth
    for part in ("head", "body", "pelvis"):
        one, other = getattr(found, part), getattr(wanted, part)
        for rotation in ("turn", "tilt", "bend"):
            slack = 10.0 if index == TIPPED and part != "head" else 2.0
            assert getattr(one, rotation) == pytest.approx(getattr(other, rotation), abs=slack)


def test_a_leg_on_the_third_line_is_level() -> None:
    """§4.7.2 c and §4.7.3: notators write ninety degrees there."""
    assert seen(2).signs.legs[Side.RIGHT].foot.height == pytest.approx(3.0, abs=0.1)


def test_knees_in_fourth_are_a_demi_plie() -> None:
    """§4.7.2 c: the teachers inferred them."""
    for leg in seen(1).signs.legs.values():
        assert leg.support == Support(FloorContact.FLAT, Bend.DEMI_PLIE)


def test_fourth_arabesque_is_the_first_on_a_bent_leg() -> None:
    """§4.7.2 d: a teacher who did not see the knee called it the first; to us it is the next."""
    found = seen(3)
    assert found.pose is not None
    assert found.pose.distance < 2.0
    second = found.alternatives["pose"][0]
    assert second.name == "first arabesque on left"
    assert second.worst == "left knee"


def test_heads_look_where_the_table_says() -> None:
    """1: turned and raised to the top arm; 5: turned and tilted to it; 6: to the side arm."""
    first, fifth, sixth = (seen(i).signs.head for i in (0, 4, 5))
    assert (first.turn, first.tilt, first.bend) == pytest.approx((-40.0, 0.0, -15.0), abs=1.0)
    assert (fifth.turn, fifth.tilt, fifth.bend) == pytest.approx((25.0, 15.0, 0.0), abs=1.0)
    assert seen(4).signs.body.tilt == pytest.approx(10.0, abs=2.0)
    assert (sixth.turn, sixth.tilt, sixth.bend) == pytest.approx((-40.0, 0.0, 0.0), abs=1.0)
    assert looks_at(0, Side.RIGHT) < looks_at(0, Side.LEFT)
    assert looks_at(5, Side.RIGHT) < looks_at(5, Side.LEFT)
