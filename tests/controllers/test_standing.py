"""The reference is laid over the feet as they stand, and weight put on them as they come down."""

from __future__ import annotations

import mujoco
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from enpointe.controllers.wholebody.contacts import Uptake
from enpointe.controllers.wholebody.controller import DEFAULT_TASKS
from enpointe.controllers.wholebody.goal import Goal
from enpointe.controllers.wholebody.problem import WholeBodyProblem
from enpointe.controllers.wholebody.reference import Reference
from enpointe.controllers.wholebody.standing_place import Placement, StandingPlace
from enpointe.controllers.wholebody.tasks import Contact, Landing

from .wholebody_cases import FIRST, MODEL, RETIRE, RETIRE_DEMI, driver, held, observed, state

ALL = np.arange(12)
places = st.builds(
    Placement,
    st.floats(-3.0, 3.0),
    st.tuples(st.floats(-3.0, 3.0), st.floats(-3.0, 3.0)),
)


def goal(pose: str) -> Goal:
    motion = held(pose)
    return Reference(motion, observed(motion.qpos[0], motion.qvel[0])).at(0.5)


@given(places)
def test_the_placement_of_feet_elsewhere_is_found(place: Placement) -> None:
    wanted = goal(FIRST).points
    there = wanted @ place.rotation().T + np.array([*place.offset, 0.0])
    found = StandingPlace()
    found.reset(there, wanted, ALL)
    assert found.value.yaw == pytest.approx(place.yaw, abs=1e-9)
    np.testing.assert_allclose(found.value.offset, place.offset, atol=1e-9)


@given(places)
def test_a_goal_elsewhere_is_the_goal_of_the_pose_elsewhere(place: Placement) -> None:
    asked = goal(RETIRE)
    moved = asked.placed(place)
    data = mujoco.MjData(MODEL)
    data.qpos[:] = moved.qpos
    mujoco.mj_kinematics(MODEL, data)
    mujoco.mj_comPos(MODEL, data)
    np.testing.assert_allclose(data.subtree_com[0], moved.com, atol=1e-9)
    np.testing.assert_allclose(data.xmat[1].reshape(3, 3), moved.root_rotation, atol=1e-9)
    soles = observed(moved.qpos, moved.qvel).points()
    np.testing.assert_allclose(soles, moved.points, atol=1e-9)


def test_a_foot_that_pivots_keeps_its_middle_and_turns_the_reference() -> None:
    """The heel, when it comes down, finds the weight where it left it: no jump."""
    wanted = goal(RETIRE).points
    ball, flat = np.arange(2, 6), np.arange(6)
    middle = wanted[ball].mean(axis=0)
    turn = Placement(np.radians(9.0), (0.0, 0.0)).rotation()
    there = (wanted - middle) @ turn.T + middle
    place = StandingPlace()
    place.reset(wanted, wanted, ball)
    for _ in range(1000):
        place.follow(there, wanted, ball, 0.002)
    assert np.degrees(place.value.yaw) == pytest.approx(9.0, abs=0.1)
    before = place.value
    after = place.follow(there, wanted, flat, 0.002)
    assert np.allclose(after.offset, before.offset, atol=1e-4)
    heel = wanted[0] @ after.rotation().T + np.array([*after.offset, 0.0])
    np.testing.assert_allclose(heel[:2], there[0, :2], atol=5e-4)


def test_nothing_that_bears_moves_nothing() -> None:
    wanted = goal(RETIRE).points
    place = StandingPlace()
    place.reset(wanted + 1.0, wanted, ALL)
    before = place.value
    assert place.follow(wanted, wanted, np.array([], dtype=np.int64), 0.002) is before


@pytest.mark.parametrize("pose", [FIRST, RETIRE, RETIRE_DEMI])
def test_it_does_not_matter_which_way_she_faces(pose: str) -> None:
    qpos = held(pose).qpos[0]
    torques = []
    for yaw in (0.0, 2.0):
        place = Placement(yaw, (0.4, -0.2))
        there = goal(pose).placed(place).qpos
        there[7:] = qpos[7:] + 0.001 * np.sin(np.arange(MODEL.nu))
        controller = driver(pose)
        controller.reset(state(there, np.zeros(MODEL.nv)))
        torques.append(controller.command(0.0, state(there, np.zeros(MODEL.nv))).torque)
    # The friction pyramids stand on the world's axes, which turn under her.
    np.testing.assert_allclose(torques[0], torques[1], atol=0.02 * np.abs(torques[0]).max())


def test_a_sole_that_hovers_is_brought_down() -> None:
    """Two millimetres up and counted on: asked to sink; on the floor: asked to stay."""
    qpos = held(RETIRE).qpos[0].copy()
    for rise, sinks in ((0.002, True), (-0.0005, False)):
        lifted = qpos.copy()
        lifted[2] += rise
        observer = observed(lifted, np.zeros(MODEL.nv))
        active = np.flatnonzero(observer.clearance() < 0.003)
        instant = observer.instant(active)
        asked = Contact().rows(instant, goal(RETIRE)).target.reshape(-1, 3)
        asked = asked + instant.drifts[active]
        np.testing.assert_allclose(asked[:, :2], 0.0, atol=1e-9)
        assert np.all(asked[:, 2] < -0.3) if sinks else np.allclose(asked[:, 2], 0.0, atol=0.3)


def test_heels_that_a_push_lifted_come_down() -> None:
    motion, controller = held(FIRST), driver(FIRST)
    qpos = motion.qpos[0].copy()
    for side in ("left", "right"):
        # Up onto the balls, by as much at the toes as at the ankles: the body stays upright.
        for joint, angle in ((f"{side}_toe_raise", 0.1), (f"{side}_ankle_point", 0.1)):
            qpos[MODEL.joint(joint).qposadr[0]] += angle
    controller.reset(state(qpos, np.zeros(MODEL.nv)))
    problem = controller.build(0.0, state(qpos, np.zeros(MODEL.nv)))
    instant = problem.instant
    assert set(instant.due) | set(instant.active) == set(ALL)
    assert len(instant.due) > 0
    unknowns = problem.solve()
    assert unknowns is not None
    falling = instant.jacobians[instant.due, 2] @ unknowns[: instant.nv]
    assert np.all(falling + instant.drifts[instant.due, 2] < -1.0)
    asked = Landing().rows(instant, goal(FIRST))
    np.testing.assert_allclose(asked.target, -900.0 * instant.points[instant.due, 2], atol=1e-9)


def test_weight_comes_onto_a_heel_little_by_little() -> None:
    ball, flat = np.arange(2, 6), np.arange(6)
    uptake = Uptake(12)
    uptake.reset(ball)
    assert np.all(np.isinf(uptake.follow(ball, 0.002)))
    shares = np.array([uptake.follow(flat, 0.002) for _ in range(30)])
    heel = shares[:, :2]
    assert heel[0].max() < 0.01
    assert np.all(np.diff(heel[np.isfinite(heel[:, 0]), 0]) > 0)
    assert np.all(np.isinf(shares[:, 2:]))
    assert np.all(np.isinf(heel[-1]))


def test_what_lands_alone_bears_at_once() -> None:
    uptake = Uptake(12)
    uptake.reset(np.array([], dtype=np.int64))
    assert np.all(np.isinf(uptake.follow(np.arange(6), 0.002)))


def test_no_more_weight_is_put_on_a_sole_than_it_may_bear() -> None:
    motion = held(FIRST)
    observer = observed(motion.qpos[0], motion.qvel[0])
    capacity = np.full(12, np.inf)
    capacity[:2] = 0.01
    instant = observer.instant(ALL, capacity)
    problem = WholeBodyProblem.build(instant, goal(FIRST), DEFAULT_TASKS, driver(FIRST).constraints)
    unknowns = problem.solve()
    assert unknowns is not None
    forces = (unknowns[instant.nv :, None] * instant.edges).reshape(12, 4, 3).sum(axis=1)
    assert np.all(forces[:2, 2] < 0.011 * instant.weight)
    assert forces[:, 2].sum() == pytest.approx(instant.weight, rel=0.02)
