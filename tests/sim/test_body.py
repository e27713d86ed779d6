"""The simulated body is honest: joints, gravity and floor, and nothing that nobody has."""

from __future__ import annotations

import copy
from collections.abc import Callable
from dataclasses import replace

import mujoco
import numpy as np
import pytest
from numpy.typing import NDArray

from enpointe.controllers import PD, Body, Command, FeedForward, Gains, Recording, perform
from enpointe.controllers.plant import Plant
from enpointe.errors import BodyError
from enpointe.models import Anthropometry
from enpointe.models.dancer import dancer_spec
from enpointe.motion import Motion
from enpointe.sim.body import SimulatedBody
from enpointe.sim.measures import measure

from ..motion.dancing import solved, solver

Array = NDArray[np.float64]
MODEL = solver().model
FIRST_POSE = solved("first-port-de-bras").key_poses[0].qpos


def still(seconds: float, qpos: Array = FIRST_POSE) -> Motion:
    return Motion.from_qpos(MODEL, [0.0, seconds], np.stack([qpos, qpos]), name="still")


def limp() -> Command:
    return Command(*np.zeros((5, MODEL.nu)))


def run_limp(body: SimulatedBody, seconds: float) -> None:
    for _ in range(round(seconds / body.period)):
        body.write(limp())
        if body.fault is not None:
            return


def edited(change: Callable[[mujoco.MjModel], None]) -> mujoco.MjModel:
    model = copy.copy(MODEL)
    change(model)
    return model


def respecified(change: Callable[[mujoco.MjSpec], None]) -> mujoco.MjModel:
    spec = dancer_spec(Anthropometry(), flesh=False)
    change(spec)
    return spec.compile()


# -- What it refuses ---------------------------------------------------------------------------


def without_gravity(model: mujoco.MjModel) -> None:
    model.opt.gravity[:] = 0


def upside_down(model: mujoco.MjModel) -> None:
    model.opt.gravity[2] = 9.81


def gravity_off(model: mujoco.MjModel) -> None:
    model.opt.disableflags |= int(mujoco.mjtDisableBit.mjDSBL_GRAVITY)


def contact_off(model: mujoco.MjModel) -> None:
    model.opt.disableflags |= int(mujoco.mjtDisableBit.mjDSBL_CONTACT)


@pytest.mark.parametrize("change", [without_gravity, upside_down, gravity_off, contact_off])
def test_a_stage_without_gravity_or_contact_is_refused(
    change: Callable[[mujoco.MjModel], None],
) -> None:
    with pytest.raises(BodyError, match="gravity and contact must be on") as refused:
        SimulatedBody(edited(change), FIRST_POSE)
    assert "\n" not in str(refused.value)


def weld_the_pelvis(spec: mujoco.MjSpec) -> None:
    spec.add_equality(
        type=mujoco.mjtEq.mjEQ_WELD, objtype=mujoco.mjtObj.mjOBJ_BODY, name1="pelvis", name2="world"
    )


def hang_on_a_mocap_body(spec: mujoco.MjSpec) -> None:
    spec.worldbody.add_body(name="hand of god", mocap=True)


@pytest.mark.parametrize("change", [weld_the_pelvis, hang_on_a_mocap_body])
def test_a_dancer_who_is_held_is_refused(change: Callable[[mujoco.MjSpec], None]) -> None:
    with pytest.raises(BodyError, match="no mocap bodies and no equality constraints"):
        SimulatedBody(respecified(change), FIRST_POSE)


@pytest.mark.parametrize("period", [0.0, 0.0004, 0.0015, -0.002])
def test_a_period_that_steps_do_not_fill_is_refused(period: float) -> None:
    with pytest.raises(BodyError, match=r"must be a multiple of the time step 0\.001 s"):
        SimulatedBody(MODEL, FIRST_POSE, period=period)


FIELDS = ("position", "velocity", "torque", "stiffness", "damping")


@pytest.mark.parametrize("name", FIELDS)
def test_bad_commands_are_refused_and_nothing_moves(name: str) -> None:
    body = SimulatedBody(MODEL, FIRST_POSE)
    with pytest.raises(BodyError, match=rf"command {name} must have shape \(36,\), got \(35,\)"):
        body.write(replace(limp(), **{name: np.zeros(35)}))
    for bad in (np.nan, np.inf, -np.inf):
        with pytest.raises(BodyError, match=f"command {name} has values that are not numbers"):
            body.write(replace(limp(), **{name: np.r_[np.zeros(35), bad]}))
    assert body.read().time == 0.0
    np.testing.assert_array_equal(body.read().qpos, FIRST_POSE)


# -- What it is --------------------------------------------------------------------------------


def test_it_is_a_body_and_leaves_the_model_alone() -> None:
    before = {
        n: np.array(getattr(MODEL, n))
        for n in ("actuator_biasprm", "actuator_ctrllimited", "actuator_biastype", "body_mass")
    }
    body = SimulatedBody.at_start_of(still(1.0))
    assert isinstance(body, Body)
    run_limp(body, 0.05)
    for name, array in before.items():
        np.testing.assert_array_equal(getattr(MODEL, name), array)
    assert body.model is not MODEL


def test_a_state_is_the_readers_own() -> None:
    body = SimulatedBody(MODEL, FIRST_POSE)
    state = body.read()
    state.qpos[:] = 7.0
    state.qvel[:] = 7.0
    np.testing.assert_array_equal(body.read().qpos, FIRST_POSE)
    assert not body.read().qvel.any()


@pytest.mark.parametrize("period", [0.001, 0.002, 0.01])
def test_time_passes_by_its_period(period: float) -> None:
    body = SimulatedBody(MODEL, FIRST_POSE, period=period)
    for _ in range(5):
        body.write(limp())
    assert body.read().time == pytest.approx(5 * period, abs=1e-12)


def test_what_it_observes_keeps_its_shape() -> None:
    body = SimulatedBody(MODEL, FIRST_POSE)
    body.write(limp())
    first = {n: np.shape(a) for n, a in body.observe().items()}
    body.write(limp())
    assert {n: np.shape(a) for n, a in body.observe().items()} == first
    assert first["sole_force"] == first["sole_point"] == (12, 3)


def test_joints_are_springs_dampers_and_torques() -> None:
    """tau = torque + K (position - q) + D (velocity - v), up to what the muscle has."""
    body = SimulatedBody(MODEL, FIRST_POSE, period=0.001)
    rng = np.random.default_rng(2)
    plant = Plant(MODEL)
    for _ in range(20):
        command = Command(
            FIRST_POSE[7:] + rng.normal(size=36) * 0.1,
            rng.normal(size=36) * 0.2,
            rng.normal(size=36),
            rng.uniform(0, 40, 36),
            rng.uniform(0, 0.5, 36),
        )
        state = body.read()
        body.write(command)
        asked = (
            command.torque
            + command.stiffness * (command.position - state.qpos[7:])
            + command.damping * (command.velocity - state.qvel[6:])
        )
        limited = np.clip(asked, -plant.torque_limit, plant.torque_limit)
        np.testing.assert_allclose(body.read().effort, limited, atol=1e-9)


def test_no_muscle_gives_more_than_it_has() -> None:
    body = SimulatedBody(MODEL, FIRST_POSE)
    body.write(replace(limp(), torque=np.full(36, 1e4)))
    np.testing.assert_allclose(body.read().effort, MODEL.actuator_forcerange[:, 1])


# -- Gravity, contact and the honesty meter ----------------------------------------------------


def test_in_the_air_everything_falls_alike() -> None:
    qpos = FIRST_POSE.copy()
    qpos[2] += 0.5
    body = SimulatedBody(MODEL, qpos, period=0.001)
    heights = []
    for _ in range(200):
        body.write(limp())
        heights.append(float(body.observe()["com"][2]))
        assert not body.observe()["sole_force"].any()
    t = np.arange(len(heights)) * 0.001
    fallen = np.polyfit(t, heights, 2)
    assert 2 * fallen[0] == pytest.approx(-9.81, abs=0.02)


def test_muscles_do_not_change_the_fall() -> None:
    """No joint torque moves the centre of mass in the air."""
    qpos = FIRST_POSE.copy()
    qpos[2] += 0.5
    bodies = [SimulatedBody(MODEL, qpos) for _ in range(2)]
    strong = replace(limp(), torque=15.0 * np.sin(np.arange(36.0)))
    for _ in range(100):
        bodies[0].write(limp())
        bodies[1].write(strong)
    one, other = (np.asarray(body.observe()["com"], dtype=float) for body in bodies)
    assert np.abs(one - other).max() < 2e-3
    assert np.abs(bodies[0].read().qpos - bodies[1].read().qpos).max() > 0.1


def test_a_limp_dancer_falls_and_is_reported() -> None:
    body = SimulatedBody(MODEL, FIRST_POSE)
    run_limp(body, 3.0)
    assert body.fault == "fell"
    assert 0.2 < body.read().time < 2.0


def test_a_diverged_simulation_is_a_fault() -> None:
    body = SimulatedBody(MODEL, FIRST_POSE, np.full(MODEL.nv, 1e9))
    body.write(limp())
    assert body.fault == "the simulation diverged"


def held(gains: Gains, feedforward: FeedForward | None = None, *, speed: float = 0.0) -> Recording:
    """Three seconds of standing, that begin with a sway forwards at `speed` m/s."""
    reference = still(3.0)
    body = SimulatedBody(MODEL, FIRST_POSE, np.r_[speed, np.zeros(MODEL.nv - 1)])
    return perform(reference, PD(reference, gains, feedforward), body)


def test_weak_ankles_fall() -> None:
    """Physics says no: with less stiffness than m g h nobody stands (physics.md, finding 4)."""
    good = Gains.suggested(MODEL, FIRST_POSE)
    assert held(good, speed=0.1).fault is None
    legs = ["hip" in n or "knee" in n or "ankle" in n for n in _joints()]
    share = np.where(legs, 0.2, 1.0)
    weak = Gains(share * good.stiffness, share * good.damping)
    assert held(weak, speed=0.1).fault == "fell"


def _joints() -> list[str]:
    return [MODEL.actuator(i).name for i in range(MODEL.nu)]


def test_without_feed_forward_the_dancer_sags_or_falls() -> None:
    good = Gains.suggested(MODEL, FIRST_POSE)
    nothing = FeedForward(np.array([0.0, 10.0]), np.zeros((2, MODEL.nu)), np.zeros(2))
    with_it, without = held(good), held(good, nothing)
    tracked = measure(with_it).tracking_rms_deg
    assert without.fault == "fell" or measure(without).tracking_rms_deg > 5 * tracked + 0.5


class Pushed(SimulatedBody):
    """Somebody lends a hand, in one of the ways MuJoCo has."""

    how = ""

    def write(self, command: Command) -> None:
        if self.how == "a hand on the pelvis":
            self.data.xfrc_applied[self.model.body("pelvis").id, 2] = 5.0
        elif self.how == "a hand on the head":
            self.data.xfrc_applied[self.model.body("head").id, 0] = 5.0
        elif self.how == "a force on the root":
            self.data.qfrc_applied[1] = -5.0
        elif self.how == "a twist of the root":
            self.data.qfrc_applied[5] = 5.0
        elif self.how == "two hands that cancel":
            self.data.xfrc_applied[self.model.body("left_hand").id, 2] = 5.0
            self.data.xfrc_applied[self.model.body("right_hand").id, 2] = -5.0
        super().write(command)


@pytest.mark.parametrize(
    ("how", "newtons"),
    [
        ("a hand on the pelvis", 5.0),
        ("a hand on the head", 5.0),
        ("a force on the root", 5.0),
        ("a twist of the root", 5.0),
        ("two hands that cancel", 10.0),
    ],
)
def test_help_shows_on_the_meter(how: str, newtons: float) -> None:
    reference = still(0.1)
    body = Pushed.at_start_of(reference)
    assert isinstance(body, Pushed)
    body.how = how
    figures = measure(perform(reference, PD(reference), body))
    assert figures.root_force_max == pytest.approx(newtons)


def test_no_help_reads_nothing() -> None:
    reference = still(0.1)
    body = Pushed.at_start_of(reference)
    assert measure(perform(reference, PD(reference), body)).root_force_max == 0.0


def carried(spec: mujoco.MjSpec) -> None:
    for body in spec.worldbody.find_all("body"):
        body.gravcomp = 0.9


def rooted(spec: mujoco.MjSpec) -> None:
    next(j for j in spec.joints if j.type == mujoco.mjtJoint.mjJNT_FREE).damping[0] = 500.0


@pytest.mark.parametrize("change", [carried, rooted])
def test_passive_help_is_refused(change: Callable[[mujoco.MjSpec], None]) -> None:
    with pytest.raises(BodyError, match="would carry the dancer"):
        SimulatedBody(respecified(change), FIRST_POSE)


def test_what_passes_the_doors_shows_on_the_meter() -> None:
    """Help that is put on after the start is metered as it acts."""
    reference = still(0.1)
    body = SimulatedBody.at_start_of(reference)
    body.model.dof_damping[:6] = 500.0
    body.data.qvel[0] = 0.1
    assert measure(perform(reference, PD(reference), body)).root_force_max > 10.0
