"""Wrists from their shoulders in arm lengths, on bodies of any size."""

from __future__ import annotations

import mujoco
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from enpointe.models import Anthropometry
from enpointe.models.dancer import dancer_model
from enpointe.models.puppet import op3_model, puppet_model
from enpointe.motion import Motion
from enpointe.motion.reach import has_reach, reaches
from enpointe.notation import Side

DANCER, TALL = dancer_model(flesh=False), dancer_model(Anthropometry(1.9, 80.0), flesh=False)
MOMENTS = np.array([0.0, 0.05, 0.1])


def arms(model: mujoco.MjModel, **angles: float) -> Motion:
    qpos = np.tile(model.key("standing").qpos, (2, 1))
    for joint, angle in angles.items():
        qpos[:, model.joint(joint).qposadr[0]] = angle
    return Motion.from_qpos(model, [0.0, 0.1], qpos)


@given(st.floats(0.0, 2.0), st.floats(-0.8, 0.8), st.floats(0.0, 1.5))
def test_it_does_not_depend_on_the_size_of_the_body(up: float, cross: float, bend: float) -> None:
    angles = {"left_shoulder_raise": up, "left_shoulder_cross": cross, "left_elbow_bend": bend}
    small, tall = (reaches(arms(model, **angles), MOMENTS) for model in (DANCER, TALL))
    for side in Side:
        np.testing.assert_allclose(small[side], tall[side], atol=0.02)


@pytest.mark.parametrize("model", [DANCER, puppet_model()], ids=["dancer", "puppet"])
def test_a_straight_arm_is_one_long_and_a_bent_one_is_shorter(model: mujoco.MjModel) -> None:
    straight = reaches(arms(model, left_elbow_bend=0.0, right_elbow_bend=1.2), MOMENTS)
    assert np.linalg.norm(straight[Side.LEFT], axis=1) == pytest.approx(1.0, abs=0.01)
    assert np.linalg.norm(straight[Side.RIGHT], axis=1).max() < 0.9


def test_where_the_root_is_does_not_count() -> None:
    still = arms(DANCER, left_shoulder_raise=1.0)
    turned = still.qpos.copy()
    turned[:, :3] += [1.0, 2.0, 3.0]
    turned[:, 3:7] = [np.cos(0.4), 0.0, 0.0, np.sin(0.4)]
    moved = Motion.from_qpos(DANCER, still.time, turned)
    for side in Side:
        np.testing.assert_allclose(reaches(moved, MOMENTS)[side], reaches(still, MOMENTS)[side])


def test_who_has_arms() -> None:
    assert all(has_reach(model) for model in (DANCER, puppet_model(), op3_model()))
    assert not has_reach(mujoco.MjModel.from_xml_string("<mujoco/>"))
