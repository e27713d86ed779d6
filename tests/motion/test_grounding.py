"""Feet put where they stand: what was off comes back, and no sole stays in the floor."""

from __future__ import annotations

import mujoco
import numpy as np
import pytest
from numpy.typing import NDArray

from enpointe.models.leg_target import Standing
from enpointe.motion.grounding import FADE, Contact, ground
from enpointe.notation import Side

from .dancing import solved, solver

Array = NDArray[np.float64]
COUNT, RATE = 50, 250.0


def stand() -> tuple[Array, dict[Side, list[Contact]]]:
    """A second of standing in the first pose of a shipped score, and how its feet stand."""
    pose = solved("first-port-de-bras").key_poses[0]
    contacts: dict[Side, list[Contact]] = {}
    for side, leg in pose.target.legs.items():
        assert isinstance(leg, Standing)
        contacts[side] = [leg] * COUNT
    return np.tile(pose.qpos, (COUNT, 1)), contacts


def toe(qpos: Array, side: Side) -> Array:
    model = solver().model
    data = mujoco.MjData(model)
    data.qpos[:] = qpos
    mujoco.mj_kinematics(model, data)
    return np.array(data.body(f"{side}_toe").xpos)


def lowest(qpos: Array) -> float:
    model = solver().model
    data = mujoco.MjData(model)
    data.qpos[:] = qpos
    mujoco.mj_kinematics(model, data)
    soles = [g for g in range(model.ngeom) if model.geom(g).name.endswith(("_inner", "_outer"))]
    return float((data.geom_xpos[soles, 2] - model.geom_size[soles, 0]).min())


TIME = np.arange(COUNT) / RATE


def test_feet_that_stand_are_left_alone() -> None:
    qpos, contacts = stand()
    assert ground(solver().model, TIME, qpos, contacts) == pytest.approx(qpos, abs=2e-3)


def test_a_planted_foot_comes_back_to_its_place() -> None:
    model = solver().model
    qpos, contacts = stand()
    moved = qpos.copy()
    moved[:, model.joint("left_hip_raise").qposadr[0]] += 0.05
    moved[:, 2] += 0.004
    held = ground(model, TIME, moved, contacts)
    assert np.linalg.norm(toe(moved[0], Side.LEFT) - toe(qpos[0], Side.LEFT)) > 0.02
    for row in held:
        for side in Side:
            assert toe(row, side) == pytest.approx(toe(qpos[0], side), abs=1e-3)


def test_a_sole_comes_out_of_the_floor() -> None:
    model = solver().model
    qpos, contacts = stand()
    qpos[:, model.joint("left_ankle_point").qposadr[0]] += 0.3
    nobody: dict[Side, list[Contact]] = {
        Side.LEFT: [None] * COUNT,
        Side.RIGHT: contacts[Side.RIGHT],
    }
    assert lowest(qpos[0]) < -0.02
    held = ground(model, TIME, qpos, nobody)
    assert min(lowest(row) for row in held) > -0.001


def test_a_correction_fades_when_the_foot_has_left() -> None:
    qpos, contacts = stand()
    qpos[:, 0] += 0.01
    leaves = COUNT // 3
    contacts[Side.LEFT] = contacts[Side.LEFT][:leaves] + [None] * (COUNT - leaves)
    contacts[Side.RIGHT] = [None] * COUNT
    change = np.abs(ground(solver().model, TIME, qpos, contacts) - qpos).max(axis=1)
    assert change[leaves - 1] > 0.005
    assert change[leaves] == pytest.approx(change[leaves - 1], rel=0.1)
    assert change[leaves + round(FADE * RATE) + 1 :].max() < 1e-6
