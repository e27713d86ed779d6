"""Limbs come apart and feet stay over the floor while a body is posed."""

from __future__ import annotations

import mink
import mujoco
import numpy as np
import pytest

from enpointe.models.puppet import op3_model, puppet_model
from enpointe.models.soles import sole_points
from enpointe.motion.feet_over_floor import FeetOverFloor
from enpointe.motion.limbs_apart import LimbsApart

BODIES = {
    "puppet": (puppet_model, {"left_hip_cross": -0.35, "right_hip_cross": -0.35}),
    "op3": (op3_model, {"l_hip_roll": 0.25, "r_hip_roll": -0.25}),
}


def crossed(name: str) -> mink.Configuration:
    """A body that stands with its legs in one another."""
    make, angles = BODIES[name]
    model = make()
    qpos = model.key("standing").qpos.copy()
    for joint, angle in angles.items():
        qpos[model.joint(joint).qposadr[0]] = angle
    configuration = mink.Configuration(model, q=qpos)
    if overlap(configuration) == 0.0:
        for joint, angle in angles.items():
            qpos[model.joint(joint).qposadr[0]] = -angle
        configuration.update(qpos)
    return configuration


def overlap(configuration: mink.Configuration) -> float:
    """How deep limbs are in one another as the engine sees it, m."""
    model = configuration.model
    data = mujoco.MjData(model)
    data.qpos[:] = configuration.q
    mujoco.mj_forward(model, data)
    plane = int(mujoco.mjtGeom.mjGEOM_PLANE)
    limbs = (model.geom_type[data.contact.geom] != plane).all(axis=1)
    return float(-data.contact.dist[limbs].min(initial=0.0))


def relaxed(configuration: mink.Configuration, limit: mink.Limit, steps: int) -> None:
    """Go on as nothing but a limit asks."""
    stay = mink.DampingTask(configuration.model, cost=1.0)
    for _ in range(steps):
        step = mink.solve_ik(configuration, [stay], 1.0, "daqp", 1e-6, limits=[limit])
        configuration.integrate_inplace(step, 1.0)


@pytest.mark.parametrize("name", sorted(BODIES))
def test_limbs_in_one_another_come_apart(name: str) -> None:
    configuration = crossed(name)
    assert overlap(configuration) > 0.002
    relaxed(configuration, LimbsApart(configuration.model), 40)
    assert overlap(configuration) == 0.0


@pytest.mark.parametrize("name", sorted(BODIES))
def test_limbs_that_are_clear_may_do_as_they_like(name: str) -> None:
    model = BODIES[name][0]()
    configuration = mink.Configuration(model, q=model.key("standing").qpos)
    constraint = LimbsApart(model).compute_qp_inequalities(configuration, 1.0)
    assert constraint.h is None or constraint.h.min() >= 0.0


def test_a_sole_rises_to_its_clearance_and_others_may_stay() -> None:
    model = puppet_model()
    configuration = mink.Configuration(model, q=model.key("standing").qpos)
    limit = FeetOverFloor(model)
    before = sole_points(model, configuration.data, limit.soles)[:, 2]
    assert limit.compute_qp_inequalities(configuration, 1.0).inactive
    left = np.array([model.geom(int(g)).name.startswith("left") for g in limit.soles])
    limit.clearance[left] = 0.01
    relaxed(configuration, limit, 12)
    after = sole_points(model, configuration.data, limit.soles)[:, 2]
    assert after[left].min() == pytest.approx(0.01, abs=5e-4)
    assert before[left].min() < 1e-3
