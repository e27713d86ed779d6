"""A motion made danceable: the floor can carry its weight, and its feet stand where they stand."""

from __future__ import annotations

from functools import cache

import mujoco
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from enpointe.models.foot_positions import support_hull
from enpointe.motion import Motion, find_effort, interpolate
from enpointe.motion.bearing import bearing_columns
from enpointe.motion.contact_plan import plan_contacts, sole_geoms, steps
from enpointe.motion.danceable import Danceable, danceable
from enpointe.motion.weight_plan import LIFT, plan_height, plan_weight
from enpointe.sim.balance import margin

from .dancing import PORTS_DE_BRAS, motion, solved, written_score

Array = NDArray[np.float64]
MASS, HEIGHT = 54.0, 0.95
TIME = np.arange(150) / 100
SQUARE = np.array([[-0.1, -0.1], [0.1, -0.1], [0.1, 0.1], [-0.1, 0.1]])
RETIRE = written_score(
    "feet: fifth right front; arms: fifth en bas",
    "left leg: straight; right leg: retiré devant; arms: fifth en avant",
    tempo=25,
)


@cache
def shifting() -> Motion:
    quality, _, _ = find_effort(None)
    return interpolate(solved(RETIRE), quality)


@cache
def made() -> Danceable:
    return danceable(shifting())


def still(x: float, y: float) -> Array:
    return np.tile([x, y, HEIGHT], (len(TIME), 1))


@settings(max_examples=8, deadline=None)
@given(st.floats(-0.06, 0.06), st.floats(-0.06, 0.06))
def test_weight_leaves_before_the_foot(x: float, y: float) -> None:
    """Support jumps from one square to another: the zero-moment point keeps to each in its time."""
    ahead = SQUARE + np.array([0.25, 0.0])
    both = support_hull(np.vstack([SQUARE, ahead]))
    supports = [SQUARE] * 40 + [both] * 50 + [ahead] * 60
    asked = still(x, y)
    asked[75:, 0] += 0.25
    plan = plan_weight(TIME, asked, np.zeros_like(asked), supports, MASS)
    assert plan.outside.max() < 1e-3
    assert all(margin(h, p) > 0.01 for h, p in zip(supports, plan.zmp, strict=True))
    np.testing.assert_allclose(plan.com[[0, -1]], asked[[0, -1], :2], atol=0.03)
    acceleration = np.gradient(np.gradient(plan.com, 0.01, axis=0), 0.01, axis=0)
    expected = plan.com - HEIGHT / 9.81 * acceleration
    np.testing.assert_allclose(plan.zmp[5:-5], expected[5:-5], atol=5e-3)


def test_a_shift_that_nobody_can_make_is_said_to_be_one() -> None:
    far = SQUARE + np.array([3.0, 0.0])
    plan = plan_weight(TIME, still(0, 0), np.zeros((150, 3)), [SQUARE] * 75 + [far] * 75, MASS)
    assert plan.outside.max() > 0.05


def test_a_moment_moves_the_point_and_not_the_weight() -> None:
    """Held long enough, L' would need the weight moved; the point shows it at once."""
    rate = np.zeros((150, 3))
    rate[:, 1] = 5.0
    plan = plan_weight(TIME, still(0, 0), rate, [SQUARE] * 150, MASS)
    acceleration = np.gradient(np.gradient(plan.com[:, 0], 0.01), 0.01)
    point = plan.com[:, 0] - HEIGHT / 9.81 * acceleration - 5.0 / (MASS * 9.81)
    np.testing.assert_allclose(plan.zmp[5:-5, 0], point[5:-5], atol=2e-3)


def test_height_is_changed_no_quicker_than_legs_can() -> None:
    asked = np.where(TIME < 0.7, 0.95, 0.85)
    free = plan_height(TIME, asked, np.ones(150, dtype=bool))
    bend = np.gradient(np.gradient(free, 0.01), 0.01)
    assert np.abs(bend).max() < 1.01 * LIFT
    np.testing.assert_allclose(free[[0, -1]], [0.95, 0.85], atol=0.005)
    flown = 0.9 - 0.5 * 9.81 * (TIME - 0.75) ** 2
    aloft = plan_height(TIME, flown, np.zeros(150, dtype=bool))
    np.testing.assert_allclose(aloft, flown, atol=2e-3)


def test_contacts_of_a_lifted_foot() -> None:
    plan = plan_contacts(shifting())
    names = [shifting().model.geom(int(g)).name for g in plan.soles]
    right = np.array([name.startswith("right") for name in names])
    assert plan.planted[0].all()
    assert plan.planted[:, ~right].all()
    assert not plan.planted[-1, right].any()
    assert (np.diff(plan.planted[:, right].astype(int), axis=0) <= 0).all()
    assert np.ptp(plan.places[:, ~right], axis=0).max() < 2e-3
    assert steps(shifting())


@pytest.mark.parametrize("score", PORTS_DE_BRAS)
def test_a_port_de_bras_has_no_steps(score: str) -> None:
    assert not steps(motion(score, "happy"))


def test_feet_stand_where_they_stand() -> None:
    plan, danced = made().contacts, made().motion
    model = danced.model
    data, soles = mujoco.MjData(model), sole_geoms(model)
    for k in range(0, len(danced.time), 10):
        data.qpos[:] = danced.qpos[k]
        mujoco.mj_kinematics(model, data)
        points = data.geom_xpos[soles] - np.array([0, 0, 1]) * model.geom_size[soles, :1]
        held = plan.planted[max(k - 15, 0) : k + 15].all(axis=0)
        assert np.abs(points[held, 2]).max() < 2e-3
        assert np.abs(points[held, :2] - plan.places[k, held]).max() < 2e-3
        assert points[:, 2].min() > -3e-3


def test_the_weight_goes_where_it_was_planned() -> None:
    weight, danced = made().weight, made().motion
    data = mujoco.MjData(danced.model)
    assert weight.outside.max() < 2e-3
    for t, place in zip(weight.time[::20], weight.com[::20], strict=True):
        data.qpos[:] = danced.sample(float(t))[0]
        mujoco.mj_kinematics(danced.model, data)
        mujoco.mj_comPos(danced.model, data)
        assert np.linalg.norm(data.subtree_com[0, :2] - place) < 4e-3


def test_what_does_not_bear_moves_as_it_did_and_keeps_its_moments() -> None:
    danced, asked = made().motion, shifting()
    assert danced.events == asked.events
    np.testing.assert_array_equal(danced.time, asked.time)
    others = np.setdiff1d(np.arange(danced.model.nq), bearing_columns(danced.model))
    assert np.abs(danced.qpos[:, others] - asked.qpos[:, others]).max() < np.radians(3.0)
    assert np.abs(danced.qvel[:, 6:]).max() < np.abs(asked.qvel[:, 6:]).max()
