"""Gains and feed-forward: what is planned is what physics asks, and the floor can give it."""

from __future__ import annotations

import mujoco
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from enpointe.controllers import PD, Controller, FeedForward, Gains, State
from enpointe.controllers.feedforward import FRICTION, floor_forces
from enpointe.controllers.plant import Plant
from enpointe.models import Anthropometry, Sex, dancer_model
from enpointe.motion import Motion
from enpointe.sim.body import SimulatedBody

from ..motion.dancing import motion, solved, solver, tiny_model

Array = NDArray[np.float64]
MODEL = solver().model
PEOPLE = {
    "default": Anthropometry(),
    "tall man": Anthropometry(1.88, 80.0, Sex.MALE),
    "small woman": Anthropometry(1.50, 42.0, Sex.FEMALE),
}
THIRD = "third-port-de-bras"


def standing(model: mujoco.MjModel = MODEL) -> Array:
    return np.array(model.key("standing").qpos)


def still(qpos: Array, seconds: float = 1.0) -> Motion:
    return Motion.from_qpos(MODEL, [0.0, seconds], np.stack([qpos, qpos]), name="still")


def placed(qpos: Array) -> Plant:
    plant = Plant(MODEL)
    plant.place(qpos)
    return plant


def actuator(name: str, model: mujoco.MjModel = MODEL) -> int:
    return int(model.actuator(name).id)


@pytest.mark.parametrize("who", PEOPLE)
def test_the_ankles_together_outweigh_toppling(who: str) -> None:
    """Less stiffness than m g h and the inverted pendulum falls (physics.md, finding 4)."""
    model = dancer_model(PEOPLE[who], flesh=False)
    gains = Gains.suggested(model, standing(model))
    plant = Plant(model)
    plant.place(standing(model))
    toppling = plant.mass * 9.81 * plant.com[2]
    for joint in ("ankle_point", "ankle_roll"):
        both = [actuator(f"{side}_{joint}", model) for side in ("left", "right")]
        assert gains.stiffness[both].sum() > 1.2 * toppling
    assert np.all(gains.stiffness > 0)
    assert np.all(gains.damping > 0)


def _names(model: mujoco.MjModel) -> list[str]:
    return [model.actuator(i).name for i in range(model.nu)]


def test_gains_grow_with_the_body() -> None:
    light, heavy = (dancer_model(Anthropometry(1.68, mass), flesh=False) for mass in (45.0, 90.0))
    gains = [Gains.suggested(m, standing(m)) for m in (light, heavy)]
    assert np.all(gains[1].stiffness > gains[0].stiffness)
    legs = [i for i, n in enumerate(_names(MODEL)) if "knee" in n or "ankle" in n]
    ratio = gains[1].stiffness[legs] / gains[0].stiffness[legs]
    np.testing.assert_allclose(ratio, 2.0, rtol=0.02)


def test_legs_in_the_air_are_limbs() -> None:
    """Without a floor under it no joint carries the body."""
    qpos = standing()
    on_floor = Gains.suggested(MODEL, qpos)
    qpos[2] += 0.5
    aloft = Gains.suggested(MODEL, qpos)
    legs = [i for i, n in enumerate(_names(MODEL)) if "ankle" in n]
    arms = [i for i, n in enumerate(_names(MODEL)) if "elbow" in n]
    assert np.all(aloft.stiffness[legs] < 0.2 * on_floor.stiffness[legs])
    np.testing.assert_allclose(aloft.stiffness[arms], on_floor.stiffness[arms], rtol=1e-6)


def test_standing_on_one_leg_puts_all_the_weight_on_it() -> None:
    one, two = standing(), standing()
    one[MODEL.joint("left_knee_bend").qposadr[0]] = 1.2
    one[MODEL.joint("left_hip_raise").qposadr[0]] = 0.9
    feet = placed(one).standing_bodies()
    assert len(feet) == 1
    right = [i for i, n in enumerate(_names(MODEL)) if n.startswith("right_ankle")]
    ratio = (
        Gains.suggested(MODEL, one).stiffness[right] / Gains.suggested(MODEL, two).stiffness[right]
    )
    assert np.all(ratio > 1.7)


@pytest.mark.parametrize("score", [THIRD, "fourth-port-de-bras"])
def test_in_every_key_pose_the_floor_carries_the_root(score: str) -> None:
    for pose in solved(score).key_poses:
        plant = placed(pose.qpos)
        needed = plant.inverse_dynamics(np.zeros(MODEL.nv))
        given_, missing = floor_forces(plant, needed[:6])
        assert np.linalg.norm(missing) < 0.5
        assert given_[2] == pytest.approx(plant.mass * 9.81, rel=1e-3)
        assert np.abs(given_[:2]).max() < 0.1


@settings(max_examples=40)
@given(st.lists(st.floats(-1, 1), min_size=6, max_size=6))
def test_the_floor_only_pushes_and_rubs_within_its_friction(direction: list[float]) -> None:
    """Whatever wrench is asked, the floor's part lies in the friction pyramid."""
    plant = placed(solved(THIRD).key_poses[0].qpos)
    wrench = 800.0 * np.array(direction) + [0, 0, 530, 0, 0, 0]
    given_, missing = floor_forces(plant, wrench)
    np.testing.assert_allclose(given_[:6] + missing, wrench, atol=1e-9)
    assert given_[2] >= -1e-9
    assert abs(given_[0]) + abs(given_[1]) <= FRICTION * given_[2] + 1e-6


def test_the_floor_cannot_pull() -> None:
    plant = placed(standing())
    pull = np.array([0.0, 0, -100, 0, 0, 0])
    given_, missing = floor_forces(plant, pull)
    np.testing.assert_allclose(given_, 0, atol=1e-9)
    np.testing.assert_allclose(missing, pull, atol=1e-9)


def test_only_what_bears_is_leant_on() -> None:
    """A foot that touches the floor and does not bear carries nothing; one that is about to be
    lifted little."""
    plant = placed(standing())
    soles = plant.soles_on_floor()
    left = np.array([n.startswith("left") for n in (MODEL.geom(int(g)).name for g in soles)])
    wrench = plant.inverse_dynamics(np.zeros(MODEL.nv))[:6]
    leg = [int(MODEL.joint(f"right_{j}").dofadr[0]) for j in ("hip_raise", "knee_bend")]
    given_, _ = floor_forces(plant, wrench, (soles[left], np.ones(left.sum())))
    np.testing.assert_allclose(given_[leg], 0, atol=1e-12)
    force = np.array([0.0, 0, plant.mass * 9.81])
    foot = plant.data.geom_xpos[soles[left]].mean(axis=0)
    over_left = np.concatenate([force, np.cross(foot - plant.data.qpos[:3], force)])
    right = [dof for dof in range(6, MODEL.nv) if _names_dof(dof).startswith("right")]
    even, _ = floor_forces(plant, over_left)
    eased, missing = floor_forces(plant, over_left, (soles, np.where(left, 1.0, 0.1)))
    assert np.linalg.norm(missing) < 0.1
    assert np.linalg.norm(eased[right]) < 0.5 * np.linalg.norm(even[right])


def _names_dof(dof: int) -> str:
    return str(MODEL.joint(int(MODEL.dof_jntid[dof])).name)


def test_in_the_air_there_is_no_floor() -> None:
    qpos = standing()
    qpos[2] += 0.3
    plant = placed(qpos)
    wrench = np.array([1.0, 2, 3, 4, 5, 6])
    given_, missing = floor_forces(plant, wrench)
    assert not given_.any()
    np.testing.assert_array_equal(missing, wrench)
    planned = FeedForward.along(still(qpos))
    assert planned.shortfall.min() == pytest.approx(plant.mass * 9.81, rel=0.2)


def test_a_still_pose_needs_the_torques_that_a_settled_dancer_gives() -> None:
    """Inverse dynamics against the simulator: PD with feed-forward leaves nothing to correct."""
    qpos = solved(THIRD).key_poses[0].qpos
    reference = still(qpos)
    body, control = SimulatedBody(MODEL, qpos), PD(reference)
    state = body.read()
    for k in range(700):
        body.write(control.command(k * body.period, state))
        state = body.read()
    planned = control.feedforward.at(0.5)
    limit = MODEL.actuator_forcerange[:, 1]
    np.testing.assert_allclose(state.effort / limit, planned / limit, atol=0.02)
    assert np.abs(state.qpos - qpos).max() < np.radians(0.5)
    assert np.abs(state.qvel).max() < 0.01


def test_torques_stay_within_the_muscles() -> None:
    planned = FeedForward.along(motion(THIRD, "angry"))
    assert np.all(np.abs(planned.torque) <= MODEL.actuator_forcerange[:, 1] + 1e-12)
    assert planned.shortfall.max() < 5.0
    assert planned.time[0] == 0.0
    assert planned.time[-1] >= motion(THIRD, "angry").duration - 1e-9


@given(st.floats(-1.0, 20.0))
def test_torques_are_known_at_any_time(t: float) -> None:
    time = np.arange(0, 2.02, 1 / 50)
    planned = FeedForward(time, np.column_stack([time, 1 - time]), np.zeros(len(time)))
    at = float(np.clip(t, 0, time[-1]))
    np.testing.assert_allclose(planned.at(t), [at, 1 - at], atol=1e-9)


def test_what_a_motion_needs_is_what_inverse_dynamics_says() -> None:
    """Joint torque and floor together are M qacc + h, as MuJoCo's own inverse dynamics has it."""
    reference = motion(THIRD, "happy")
    qpos, qvel, qacc = reference.sample(3.0)
    plant = Plant(MODEL)
    plant.place(qpos, qvel)
    model = motion_without_contact()
    data = mujoco.MjData(model)
    data.qpos[:], data.qvel[:], data.qacc[:] = qpos, qvel, qacc
    mujoco.mj_inverse(model, data)
    np.testing.assert_allclose(plant.inverse_dynamics(qacc), data.qfrc_inverse, atol=1e-6)


def motion_without_contact() -> mujoco.MjModel:
    import copy

    model = copy.copy(MODEL)
    model.opt.disableflags |= int(mujoco.mjtDisableBit.mjDSBL_CONSTRAINT)
    return model


def test_pd_commands_the_reference_and_its_gains() -> None:
    reference = motion(THIRD, "happy")
    control = PD(reference)
    assert isinstance(control, Controller)
    nu = MODEL.nu
    still, none = np.zeros(MODEL.nv), np.zeros(nu)
    state = State(0.0, reference.qpos[0], still, none, none, np.ones(nu, bool))
    control.reset(state)
    for t in (0.0, 2.345, reference.duration, reference.duration + 5):
        command = control.command(t, state)
        for name in ("position", "velocity", "torque", "stiffness", "damping"):
            assert getattr(command, name).shape == (nu,)
        qpos, qvel, _ = reference.sample(t)
        np.testing.assert_array_equal(command.position, qpos[7:])
        np.testing.assert_array_equal(command.velocity, qvel[6:])
        np.testing.assert_array_equal(command.stiffness, control.gains.stiffness)


def test_gains_and_torques_may_be_brought_along() -> None:
    model = tiny_model()
    reference = Motion.from_qpos(model, [0.0, 1.0], np.tile([0, 0, 1, 1, 0, 0, 0, 0.5], (2, 1)))
    gains = Gains(np.array([7.0]), np.array([0.3]))
    torques = FeedForward(np.array([0.0, 0.02]), np.full((2, 1), 0.25), np.zeros(2))
    none = np.zeros(1)
    state = State(0.0, reference.qpos[0], np.zeros(7), none, none, np.ones(1, bool))
    command = PD(reference, gains, torques).command(0.3, state)
    assert (*command.stiffness, *command.damping, *command.torque) == (7.0, 0.3, 0.25)
    assert command.position == 0.5
