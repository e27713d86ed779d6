"""The whole-body programme obeys mechanics, and its command does what the programme found."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import ClassVar

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from enpointe.controllers import Controller, WholeBody
from enpointe.controllers.wholebody.constraints import JointRange, TorqueLimits, joint_torques
from enpointe.controllers.wholebody.instant import Instant, Observer, skew
from enpointe.controllers.wholebody.reference import Reference
from enpointe.controllers.wholebody.rows import Equality
from enpointe.controllers.wholebody.tasks import (
    AngularMomentum,
    CentreOfMass,
    Orientation,
    Posture,
)
from enpointe.motion import Motion

from .wholebody_cases import (
    FIRST,
    MODEL,
    RETIRE,
    RETIRE_DEMI,
    driver,
    held,
    moved,
    observed,
    shaken,
    state,
)

Array = NDArray[np.float64]
POSES = (FIRST, RETIRE, RETIRE_DEMI)
STEP = 1e-5
poses_and_seeds = pytest.mark.parametrize(
    ("pose", "seed"), [(pose, seed) for pose in POSES for seed in (0, 1)]
)


def solved(pose: str, seed: int, **options: object) -> tuple[WholeBody, Instant, Array]:
    controller = driver(pose, **options)
    qpos, qvel = shaken(pose, seed, angle=0.002, speed=0.05)
    controller.reset(state(qpos, qvel))
    problem = controller.build(0.0, state(qpos, qvel))
    unknowns = problem.solve()
    assert unknowns is not None
    return controller, problem.instant, unknowns


@poses_and_seeds
def test_soles_move_as_their_jacobians_say(pose: str, seed: int) -> None:
    """J v and J' v against central differences of places and of J v."""
    qpos, qvel = shaken(pose, seed)
    here = observed(qpos, qvel).instant(np.arange(12))
    places, speeds = [], []
    for sign in (-1.0, 1.0):
        there = observed(moved(qpos, qvel, sign * STEP), qvel)
        # A body's own point, not whichever is lowest: it is carried along with its sphere's frame.
        places.append(_carried(there, here))
        speeds.append(_speeds(there, here))
    velocity = (places[1] - places[0]) / (2 * STEP)
    np.testing.assert_allclose(here.jacobians @ qvel, velocity, atol=1e-6)
    drift = (speeds[1] - speeds[0]) / (2 * STEP)
    np.testing.assert_allclose(here.drifts, drift, atol=1e-4)


def _carried(there: Observer, here: Instant) -> Array:
    """Where the points that are lowest `here` have gone, carried by their bodies."""
    data, places = there.plant.data, []
    start = observed(here.qpos, here.qvel).plant.data
    for geom, point in zip(here.soles, here.points, strict=True):
        body = MODEL.geom_bodyid[geom]
        local = start.xmat[body].reshape(3, 3).T @ (point - start.xpos[body])
        places.append(data.xpos[body] + data.xmat[body].reshape(3, 3) @ local)
    return np.array(places)


def _speeds(there: Observer, here: Instant) -> Array:
    import mujoco

    data = there.plant.data
    jacobian, speeds = np.zeros((3, MODEL.nv)), []
    for geom, point in zip(here.soles, _carried(there, here), strict=True):
        mujoco.mj_jac(MODEL, data, jacobian, None, point, MODEL.geom_bodyid[geom])
        speeds.append(jacobian @ here.qvel)
    return np.array(speeds)


@poses_and_seeds
def test_a_solution_obeys_newton_and_euler(pose: str, seed: int) -> None:
    """M qacc + h = tau + J^T f with no torque on the root, forces in the pyramids."""
    controller, instant, unknowns = solved(pose, seed)
    qacc, edges = unknowns[: instant.nv], unknowns[instant.nv :]
    left = instant.mass_matrix @ qacc + instant.bias - instant.force_matrix @ edges
    np.testing.assert_allclose(left[:6], 0.0, atol=1e-5)
    torque = joint_torques(instant, unknowns)
    np.testing.assert_allclose(left[instant.actuated], torque, atol=1e-9)
    assert np.all(np.abs(torque) <= MODEL.actuator_forcerange[:, 1] + 1e-6)
    forces = instant.sole_forces(unknowns)
    assert edges.min() >= -1e-6
    level = np.abs(forces[:, :2]).sum(axis=1)
    assert np.all(level <= 0.7 * forces[:, 2] + 1e-6)
    assert not forces[instant.resting].any()
    assert controller.motion is held(pose)


@poses_and_seeds
def test_forces_and_accelerations_tell_one_story(pose: str, seed: int) -> None:
    """The floor's forces move the centre of mass and turn the body as the accelerations do."""
    _, instant, unknowns = solved(pose, seed)
    qacc = unknowns[: instant.nv]
    ahead, behind = (
        observed(
            moved(instant.qpos, instant.qvel + 0.5 * s * qacc, s), instant.qvel + s * qacc
        ).instant(instant.active)
        for s in (STEP, -STEP)
    )
    forces = instant.sole_forces(unknowns)
    acceleration = (ahead.com_velocity - behind.com_velocity) / (2 * STEP)
    gravity = np.array([0, 0, instant.gravity])
    np.testing.assert_allclose(forces.sum(axis=0) / instant.mass - gravity, acceleration, atol=2e-4)
    moment = np.cross(instant.points - instant.com, forces).sum(axis=0)
    rate = (ahead.angular_momentum - behind.angular_momentum) / (2 * STEP)
    np.testing.assert_allclose(moment, rate, atol=2e-2)


def test_standing_still_asks_for_weight_and_nothing_else() -> None:
    controller = driver(RETIRE)
    start = state(held(RETIRE).qpos[0], np.zeros(MODEL.nv))
    controller.reset(start)
    problem = controller.build(0.0, start)
    unknowns = problem.solve()
    assert unknowns is not None
    assert np.abs(unknowns[: MODEL.nv]).max() < 0.2
    total = problem.instant.sole_forces(unknowns).sum(axis=0)
    np.testing.assert_allclose(total, [0, 0, problem.instant.mass * 9.81], atol=0.5)
    assert set(problem.rows) == {
        "centre of mass",
        "angular momentum",
        "contact",
        "orientation",
        "posture",
        "swing foot",
        "landing",
    }
    errors = problem.errors(unknowns)
    assert all(len(errors[name]) == len(rows.target) for name, rows in problem.rows.items())


@pytest.mark.parametrize("pose", POSES)
def test_it_does_not_matter_where_on_the_floor_she_stands(pose: str) -> None:
    qpos, qvel = shaken(pose, 4, angle=0.001, speed=0.02)
    commands = []
    for place in ((0.0, 0.0), (1.3, -0.7)):
        there = qpos.copy()
        there[:2] += place
        controller = driver(pose)
        controller.reset(state(there, qvel))
        commands.append(controller.command(0.0, state(there, qvel)))
    np.testing.assert_allclose(commands[0].torque, commands[1].torque, atol=1e-5)
    np.testing.assert_allclose(commands[0].position, commands[1].position, atol=1e-9)


def test_it_is_a_controller_and_forgets_at_reset() -> None:
    controller = driver(RETIRE)
    assert isinstance(controller, Controller)
    qpos, qvel = shaken(RETIRE, 2, angle=0.001, speed=0.02)
    first = []
    for _ in range(2):
        controller.reset(state(qpos, qvel))
        first.append(controller.command(0.0, state(qpos, qvel)))
        controller.command(0.002, state(qpos + 0.0, 0.5 * qvel))
    np.testing.assert_array_equal(first[0].torque, first[1].torque)
    np.testing.assert_array_equal(first[0].position, first[1].position)
    assert controller.workload.commands == 2
    assert controller.workload.failures == 0


@dataclass(frozen=True)
class Impossible:
    """Two different values of the same unknown."""

    name: ClassVar[str] = "impossible"

    def limits(self, instant: Instant) -> Equality:
        matrix = np.zeros((2, instant.size))
        matrix[:, 7] = 1.0
        return Equality(matrix, np.array([0.0, 1.0]))


def test_without_a_solution_it_falls_back_and_counts() -> None:
    controller = driver(RETIRE)
    start = state(held(RETIRE).qpos[0], np.zeros(MODEL.nv))
    controller.reset(start)
    before = controller.command(0.0, start)
    controller.constraints = (*controller.constraints, Impossible())
    after = controller.command(0.002, start)
    assert controller.workload.failures == 1
    assert controller.unknowns is None
    np.testing.assert_array_equal(after.torque, before.torque)
    np.testing.assert_allclose(after.position, held(RETIRE).qpos[0][7:])
    assert np.all(after.stiffness >= before.stiffness)


def test_a_weak_dancer_stays_within_her_strength() -> None:
    limit = 0.15 * MODEL.actuator_forcerange[:, 1]
    strong = driver(RETIRE)
    constraints = [
        TorqueLimits(limit) if isinstance(c, TorqueLimits) else c for c in strong.constraints
    ]
    _, instant, unknowns = solved(RETIRE, 0, constraints=constraints)
    assert np.all(np.abs(joint_torques(instant, unknowns)) <= limit + 1e-6)
    _, instant, unknowns = solved(RETIRE, 0)
    assert np.any(np.abs(joint_torques(instant, unknowns)) > limit)


@settings(max_examples=60, deadline=None)
@given(
    share=st.lists(st.floats(0.0, 1.0), min_size=36, max_size=36),
    speed=st.lists(st.floats(-3.0, 3.0), min_size=36, max_size=36),
    end=st.sampled_from(["low", "high"]),
)
def test_within_the_bounds_a_joint_is_in_its_range_a_horizon_later(
    share: list[float], speed: list[float], end: str
) -> None:
    limits = JointRange.of(MODEL)
    qpos, qvel = held(FIRST).qpos[0].copy(), np.zeros(MODEL.nv)
    qpos[7:] = limits.low + np.array(share) * (limits.high - limits.low)
    qvel[6:] = speed
    instant = replace(observed(qpos, qvel).instant(np.arange(0)))
    bounds = limits.limits(instant)
    assert bounds.columns == slice(6, instant.nv)
    qacc = getattr(bounds, end)
    assert np.all(bounds.low <= bounds.high)
    ahead = limits.horizon
    later = qpos[7:] + qvel[6:] * ahead + 0.5 * qacc * ahead**2
    assert np.all(later >= limits.low - 1e-9)
    assert np.all(later <= limits.high + 1e-9)


def test_a_wish_met_is_the_references_own_acceleration() -> None:
    """With no error, each task asks for what the reference does."""
    motion, controller = held(RETIRE), driver(RETIRE)
    start = state(motion.qpos[0], np.zeros(MODEL.nv))
    controller.reset(start)
    instant = controller.build(0.0, start).instant
    still = controller._reference.at(0.0)
    goal = still._replace(qacc=np.arange(MODEL.nv, dtype=float), rates=still.rates.copy())
    goal.com_acceleration[:] = 0.1, -0.2, 0.3
    goal.angular_momentum_rate[:] = 1.0, 2.0, 3.0
    np.testing.assert_allclose(Posture().rows(instant, goal).target, goal.qacc[6:], atol=1e-9)
    np.testing.assert_allclose(Orientation().rows(instant, goal).target, goal.qacc[3:6], atol=1e-9)
    gravity = [0, 0, instant.gravity]
    target = CentreOfMass().rows(instant, goal).target
    np.testing.assert_allclose(target, goal.com_acceleration + gravity, atol=1e-9)
    target = AngularMomentum().rows(instant, goal).target
    np.testing.assert_allclose(target, goal.angular_momentum_rate, atol=1e-9)


@pytest.mark.parametrize("gain", [2.0, 5.0])
def test_the_capture_point_comes_back_at_its_own_rate(gain: float) -> None:
    """Under the centre of mass' law alone, xi - xi_r decays by exp(-omega (k - 1) t)."""
    instant = observed(held(FIRST).qpos[0], np.zeros(MODEL.nv)).instant(np.arange(12))
    goal = driver(FIRST)._reference.at(0.0)
    goal.com[:] = instant.com
    omega = np.sqrt(instant.gravity / instant.com[2])
    com, velocity = instant.com + np.array([0.01, -0.02, 0.0]), np.array([0.03, 0.01, 0.0])
    dt = 1e-4
    task = CentreOfMass(capture_gain=gain)
    apart = [(com + velocity / omega - goal.com)[:2]]
    for _ in range(3000):
        here = replace(instant, com=com, com_velocity=velocity)
        velocity = velocity + dt * task.acceleration(here, goal)
        com = com + dt * velocity
        apart.append((com + velocity / omega - goal.com)[:2])
    expected = apart[0] * np.exp(-omega * (gain - 1) * 3000 * dt)
    np.testing.assert_allclose(apart[-1], expected, atol=2e-5)


@given(st.lists(st.floats(-3, 3), min_size=3, max_size=3), st.floats(-2, 2))
def test_a_skew_matrix_is_a_cross_product(a: list[float], x: float) -> None:
    b = np.array([x, 1.0, -x])
    np.testing.assert_allclose(skew(np.array([a]))[0] @ b, np.cross(a, b), atol=1e-12)


def test_a_corner_in_the_poses_is_not_asked_of_the_floor() -> None:
    """A bump of a millimetre in her height within 40 ms is 12 m/s^2; less than 1 is asked for."""
    standing = held(FIRST)
    lifted = standing.qpos.copy()
    off = np.abs(standing.time - 0.5) / 0.02
    lifted[:, 2] += np.where(off < 1.0, 0.0005 * (1.0 + np.cos(np.pi * off)), 0.0)
    bumped = Motion.from_qpos(MODEL, standing.time, lifted)
    reference = Reference(bumped, Observer(MODEL, 0.7))
    asked = max(abs(reference.at(float(t)).com_acceleration[2]) for t in standing.time)
    assert 0.0 < asked < 1.0
