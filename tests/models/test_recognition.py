"""A pose is called by its name, and one without a name says what is nearest and how far."""

from __future__ import annotations

import numpy as np
import pytest

from enpointe.models import Anthropometry, Sex, dancer_model
from enpointe.models.joints import Joints
from enpointe.models.recognition import recognise, recognise_joints
from enpointe.notation import ArmsPosition, LegPosition, Side

from .posing import solver_of, standing
from .vocabulary import ALL, recogniser, solved

SAMPLE = (
    ("feet third", Side.LEFT),
    ("arms fourth en haut", Side.RIGHT),
    ("arms fifth en bas", Side.RIGHT),
    ("leg dégagé devant", Side.RIGHT),
    ("leg retiré seconde", Side.LEFT),
    ("leg arabesque derrière 120", Side.LEFT),
    ("pose second arabesque", Side.LEFT),
    ("pose attitude effacée derrière", Side.RIGHT),
    ("pose écarté", Side.RIGHT),
)
NOISE_DEG = 5.0


def shaken(qpos: np.ndarray, rng: np.random.Generator) -> np.ndarray:
    """Every hinge off by up to 5 degrees, within its range; the root as it was."""
    model = solver_of("default").model
    noise = np.radians(rng.uniform(-NOISE_DEG, NOISE_DEG, len(qpos) - 7))
    image = np.array(qpos)
    image[7:] = np.clip(qpos[7:] + noise, *model.jnt_range[1:].T)
    return image


@pytest.mark.parametrize(("name", "side"), SAMPLE)
def test_a_solved_position_has_its_own_name(name: str, side: Side) -> None:
    found = recogniser().recognise(solved(name, side).qpos)
    assert found.is_called(name, side)
    assert found.named
    assert found.distance < 3.0


@pytest.mark.slow
@pytest.mark.parametrize(("name", "side", "real"), ALL)
def test_every_solved_position_has_its_own_name(name: str, side: Side, real: bool) -> None:
    pose = solved(name, side, real)
    assert recogniser().recognise(pose.qpos).is_called(name, side)


@pytest.mark.slow
def test_five_degrees_of_noise_change_few_names(rng: np.random.Generator) -> None:
    called = [
        recogniser().recognise(shaken(solved(*key).qpos, rng)).is_called(*key[:2])
        for key in ALL
        for _ in range(2)
    ]
    assert np.mean(called) >= 0.95


def test_noise_leaves_whole_poses_and_arms_their_names(rng: np.random.Generator) -> None:
    for name, side in SAMPLE:
        if name.startswith(("pose", "arms")):
            for _ in range(5):
                found = recogniser().recognise(shaken(solved(name, side).qpos, rng))
                assert found.is_called(name, side)


def test_a_pose_without_a_name_says_what_is_nearest(rng: np.random.Generator) -> None:
    model = solver_of("default").model
    qpos = standing(model)
    qpos[model.joint("left_elbow_bend").qposadr[0]] = 2.0
    found = recogniser().recognise(qpos)
    assert not found.arms.named
    assert not found.named
    assert found.arms.worst == "left forearm"
    assert "nearest to" in str(found.arms)
    assert found.arms.distance > 20.0


def test_distance_grows_with_what_is_wrong() -> None:
    pose = solved("arms fifth en haut")
    model = solver_of("default").model
    distances = []
    for degrees in (0.0, 5.0, 10.0, 20.0):
        qpos = np.array(pose.qpos)
        qpos[model.joint("right_shoulder_raise").qposadr[0]] -= np.radians(degrees)
        distances.append(recogniser().recognise(qpos).arms.distance)
    assert distances == sorted(distances)
    assert distances[0] < 1.0 < distances[1]


def test_a_straight_leg_behind_has_two_names() -> None:
    found = recogniser().recognise(solved("leg arabesque derrière 90").qpos).legs[Side.RIGHT]
    assert {name.split()[0] for name in found.names} == {"arabesque", "raised"}
    low = recogniser().recognise(solved("leg raised derrière 45").qpos).legs[Side.RIGHT]
    assert isinstance(low.position, LegPosition)
    assert low.position.degrees == pytest.approx(45.0)


def test_poses_that_differ_in_facing_alone_are_told_apart_by_it() -> None:
    croisee = solved("pose attitude croisée derrière")
    found = recogniser().recognise(croisee.qpos).pose
    assert found is not None
    assert found.name == "attitude croisée derrière on left"
    assert "attitude derrière on left" in found.names


def test_alternatives_come_after_the_match() -> None:
    found = recogniser().recognise(solved("arms fourth en avant").qpos)
    distances = [found.arms.distance, *(each.distance for each in found.alternatives["arms"])]
    assert distances == sorted(distances)
    assert found.arms.position == ArmsPosition("fourth en avant", Side.RIGHT)


def test_another_body_is_named_alike() -> None:
    """Directions of limbs do not depend on how long they are."""
    tall = dancer_model(Anthropometry(1.9, 80.0, Sex.MALE), flesh=False)
    qpos = solved("arms fifth en haut").qpos
    joints = Joints.of(tall, qpos)
    found = recognise_joints(joints, solver_of("default").model)
    assert found.arms.name == "fifth en haut"


def test_the_reference_is_laid_out_once() -> None:
    model = solver_of("default").model
    qpos = solved("feet third", Side.LEFT).qpos
    assert str(recognise(model, qpos).feet) == "third left front"
