"""A body on a stand behind servos: it hangs, swings and jams as its weight says."""

from __future__ import annotations

import mujoco
import numpy as np
import pytest

from enpointe.errors import BodyError
from enpointe.models.puppet import op3_model, op3_spec
from enpointe.motion import Motion
from enpointe.sim.joint_loads import joint_loads
from enpointe.sim.stand_plant import StandPlant

JOINTS = tuple(op3_model().joint(j).name for j in range(1, op3_model().njnt))


def raised() -> Motion:
    """OP3 with an arm and a leg held up."""
    model = op3_model()
    qpos = np.tile(model.key("standing").qpos, (3, 1))
    for joint, angle in (("l_sho_roll", 0.9), ("r_hip_pitch", 0.8)):
        qpos[:, model.joint(joint).qposadr[0]] = angle
    return Motion.from_qpos(model, np.arange(3) * 0.01, qpos)


def plant_of(motion: Motion, signs: np.ndarray, offsets: np.ndarray) -> StandPlant:
    angles = np.array([motion.qpos[0, motion.model.joint(j).qposadr[0]] for j in JOINTS])
    return StandPlant(op3_spec(), angles, JOINTS, signs=list(signs), offsets=list(offsets))


def test_the_static_torques_hold_it_still_whatever_way_servos_are_mounted() -> None:
    motion = raised()
    signs = np.where(np.arange(len(JOINTS)) % 2, -1.0, 1.0)
    plant = plant_of(motion, signs, 0.1 * signs)
    loads = joint_loads(motion, stand=True)
    assert loads.joints == JOINTS
    first = np.array(plant.position())
    for _ in range(300):
        plant.advance((signs * loads.static[0]).tolist(), 1e-3)
    np.testing.assert_allclose(plant.position(), first, atol=2e-3)
    dropped = plant_of(motion, signs, 0.1 * signs)
    for _ in range(300):
        dropped.advance([0.0] * len(JOINTS), 1e-3)
    assert np.abs(np.array(dropped.position()) - first).max() > 0.1


def test_a_jammed_joint_stays_and_goes_again() -> None:
    motion = raised()
    place = JOINTS.index("r_hip_pitch")
    plant = plant_of(motion, np.ones(len(JOINTS)), np.zeros(len(JOINTS)))
    plant.jam(place, True)
    for jammed in (True, False):
        plant.jam(place, jammed)
        before = plant.position()[place]
        for _ in range(200):
            plant.advance([0.0] * len(JOINTS), 1e-3)
        assert (abs(plant.position()[place] - before) < 5e-3) is jammed


def test_a_body_without_a_root_or_the_joint_is_refused() -> None:
    with pytest.raises(BodyError, match="elbow"):
        StandPlant(op3_spec(), np.zeros(1), ("elbow",))
    with pytest.raises(BodyError, match="free root"):
        StandPlant(mujoco.MjSpec(), np.zeros(0), ())
