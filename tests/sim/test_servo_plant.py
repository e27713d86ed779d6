"""A body behind the horns of servos: what goes in are torques, and nothing else holds it up."""

from __future__ import annotations

import numpy as np
import pytest

from enpointe.errors import BodyError
from enpointe.hardware.emulator.plant import Plant
from enpointe.models.puppet import SERVOS, puppet_model
from enpointe.sim.servo_plant import ServoPlant

JOINTS = tuple(SERVOS["puppet"])


def standing(**kwargs: object) -> ServoPlant:
    model = puppet_model()
    plant = ServoPlant(model, model.key("standing").qpos, JOINTS, **kwargs)  # type: ignore[arg-type]
    plant.let_go()
    return plant


def test_it_is_a_plant_of_the_emulated_bus() -> None:
    assert isinstance(standing(), Plant)


def test_unpowered_it_falls() -> None:
    """Bent at the knees: straight, the friction of 25 gears would keep her up for a while."""
    model = puppet_model()
    qpos = np.array(model.key("standing").qpos)
    for side in ("left", "right"):
        qpos[model.joint(f"{side}_knee_bend").qposadr[0]] = 0.6
        qpos[model.joint(f"{side}_ankle_point").qposadr[0]] = -0.6
    qpos[2] -= 0.13 * (1.0 - np.cos(0.6))
    plant = ServoPlant(model, qpos, JOINTS)
    plant.let_go()
    for _ in range(3000):
        plant.advance([0.0] * 25, 0.001)
        if plant.fault:
            break
    assert plant.fault == "fell"
    assert np.all(plant.recorded()["root_force"] == 0.0)


def test_held_it_does_not_move() -> None:
    model = puppet_model()
    plant = ServoPlant(model, model.key("standing").qpos, JOINTS)
    plant.advance([1.0] * 25, 0.5)
    assert plant.position() == [0.0] * 25
    assert plant.recorded() == {}


def test_a_torque_turns_its_own_joint_its_own_way() -> None:
    """Order, sign and offset are those of the bus; the arm of a servo the other way swings back."""
    elbow = JOINTS.index("left_elbow_bend")
    signs = [1.0] * 25
    signs[elbow] = -1.0
    offsets = [0.0] * 25
    offsets[elbow] = 0.3
    plant = standing(signs=signs, offsets=offsets)
    torque = [0.0] * 25
    torque[elbow] = -0.4
    for _ in range(50):
        plant.advance(torque, 0.001)
    joint = plant.data.joint("left_elbow_bend").qpos[0]
    assert joint > 0.01
    assert plant.position()[elbow] == pytest.approx(0.3 - joint)
    assert plant.velocity()[elbow] < 0.0


def test_torques_between_parts_do_not_move_the_whole() -> None:
    """In the air, motors change neither the fall of the weight nor the turning of the whole."""
    model = puppet_model()
    qpos = np.array(model.key("standing").qpos)
    qpos[2] += 1.0
    plant = ServoPlant(model, qpos, JOINTS, period=0.001)
    plant.let_go()
    start = plant.data.subtree_com[0].copy()
    rng = np.random.default_rng(7)
    torque = rng.uniform(-0.4, 0.4, 25).tolist()
    for _ in range(100):
        plant.advance(torque, 0.001)
    fallen = plant.data.subtree_com[0] - start
    # Semi-implicit steps of h fall g t (t + h) / 2; the mass of the rotors adds inertia to joints
    # only, so that nothing of it shows here.
    assert fallen[2] == pytest.approx(-0.5 * 9.81 * 0.1 * 0.101, rel=0.02)
    assert np.abs(fallen[:2]).max() < 5e-4
    assert np.all(plant.recorded()["root_force"] == 0.0)


def test_a_jammed_joint_stays() -> None:
    plant = standing()
    elbow = JOINTS.index("left_elbow_bend")
    plant.jam(elbow, True)
    torque = [0.0] * 25
    torque[elbow] = 0.9
    for _ in range(100):
        plant.advance(torque, 0.001)
    assert abs(plant.position()[elbow]) < 0.01
    plant.jam(elbow, False)
    for _ in range(100):
        plant.advance(torque, 0.001)
    assert plant.position()[elbow] > 0.02


def test_a_joint_that_is_not_there_is_named() -> None:
    model = puppet_model()
    with pytest.raises(BodyError, match="left_tail"):
        ServoPlant(model, model.key("standing").qpos, (*JOINTS[:-1], "left_tail"))
