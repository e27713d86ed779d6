"""Play in the gears: within it nothing passes, at its ends everything does, and none is made."""

from __future__ import annotations

from collections.abc import Sequence

import mujoco
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from enpointe.errors import BodyError
from enpointe.hardware.datasheet import datasheet
from enpointe.hardware.emulator import Bus, GearedPlant, Servo
from enpointe.models.puppet import SERVOS, puppet_model, puppet_spec
from enpointe.sim.gear_play import rotor_of, with_play
from enpointe.sim.servo_plant import ServoPlant
from enpointe.sim.stand_plant import StandPlant

JOINTS = tuple(SERVOS["puppet"])
QUARTER = np.radians(0.25)
TEETH = 2e-4
"""rad that teeth may be in one another while they meet at the speeds below."""

widths = st.floats(1e-3, 0.2)
inertias = st.floats(1e-4, 1e-1)
rotors = st.floats(2e-3, 1e-1)
"""kg m^2 at the horn: those of the servos are 0.0025 to 0.18."""


def wheel(inertia: float, armature: float, friction: float = 0.0) -> mujoco.MjSpec:
    """A wheel on a hinge, nothing pulling at it."""
    spec = mujoco.MjSpec()
    spec.option.timestep = 0.001
    spec.option.integrator = mujoco.mjtIntegrator.mjINT_IMPLICITFAST
    spec.option.gravity = [0, 0, 0]
    spec.compiler.degree = False
    body = spec.worldbody.add_body(
        name="wheel", mass=1.0, inertia=[inertia] * 3, explicitinertial=True
    )
    body.add_joint(
        name="axle", axis=[0, 0, 1], armature=armature, frictionloss=friction,
        type=mujoco.mjtJoint.mjJNT_HINGE,
    )  # fmt: skip
    spec.add_actuator(name="axle", target="axle", trntype=mujoco.mjtTrn.mjTRN_JOINT).set_to_motor()
    return spec


def energy(data: mujoco.MjData, inertia: float, armature: float) -> float:
    return 0.5 * float(inertia * data.qvel[0] ** 2 + armature * data.qvel[1] ** 2)


@given(widths, inertias, rotors, st.floats(0.1, 2.0))
@settings(max_examples=25, deadline=None)
def test_a_pushed_horn_turns_freely_then_takes_its_motor_along(
    width: float, inertia: float, armature: float, speed: float
) -> None:
    """From the middle half the play without loss; then momentum is shared, energy is not made."""
    model = with_play(wheel(inertia, armature), {"axle": width})
    data = mujoco.MjData(model)
    data.qvel[0] = speed
    start = energy(data, inertia, armature)
    while data.qpos[0] + 0.002 * speed < 0.5 * width:
        mujoco.mj_step(model, data)
        assert data.qvel[0] == pytest.approx(speed, rel=1e-9)
        assert data.qvel[1] == 0.0
    for _ in range(300):
        mujoco.mj_step(model, data)
        assert energy(data, inertia, armature) <= start * (1 + 1e-9)
        assert abs(data.qpos[0] - data.qpos[1]) < 0.5 * width + 0.004 * speed
    momentum = inertia * data.qvel[0] + armature * data.qvel[1]
    assert momentum == pytest.approx(inertia * speed, rel=1e-6)
    assert data.qvel[1] > 0.0
    assert abs(data.qvel[1] - data.qvel[0]) < 0.3 * speed


@given(widths)
@settings(max_examples=10, deadline=None)
def test_a_motor_that_turns_round_loses_the_play(width: float) -> None:
    """Driven one way and the other, the horn is led by half of the play either way."""
    model = with_play(wheel(0.01, 0.01), {"axle": width})
    data = mujoco.MjData(model)
    leads = []
    for torque in (0.1, -0.1):
        data.ctrl[0] = torque
        for _ in range(1500):
            mujoco.mj_step(model, data)
        leads.append(float(data.qpos[1] - data.qpos[0]))
    np.testing.assert_allclose(leads, [0.5 * width, -0.5 * width], atol=TEETH)


@given(inertias, rotors)
@settings(max_examples=15, deadline=None)
def test_less_and_less_play_comes_to_none(inertia: float, armature: float) -> None:
    """The same torques turn a horn with a hair's breadth of play as one without, friction too."""

    def danced(width: float) -> np.ndarray:
        model = with_play(wheel(inertia, armature, 0.03), {"axle": width})
        data = mujoco.MjData(model)
        path = []
        for step in range(800):
            data.ctrl[0] = (inertia + armature) * 40.0 * np.cos(0.0157 * step) + 0.03
            mujoco.mj_step(model, data)
            path.append(float(data.qpos[0]))
        return np.array(path)

    exact = danced(0.0)
    assert np.ptp(exact) > 0.1
    away = [float(np.abs(danced(width) - exact).max()) for width in (1e-2, 1e-3, 1e-5)]
    assert away[2] < 0.02 * np.ptp(exact)
    assert away[2] <= away[0] + 1e-4


def test_without_play_it_is_the_body_that_it_was() -> None:
    model = with_play(puppet_spec(), dict.fromkeys(JOINTS, 0.0))
    assert (model.nq, model.nkey) == (puppet_model().nq, 1)
    np.testing.assert_array_equal(model.dof_armature, puppet_model().dof_armature)


def test_floor_and_stops_are_as_stiff_as_before_and_teeth_are_stiff() -> None:
    """Against its stop at stall torque a joint stands where it would without play."""
    elbow = JOINTS.index("left_elbow_bend")
    torque = [0.0] * len(JOINTS)
    torque[elbow] = datasheet("XC330-T288").stall_torque
    ends = []
    for width in (0.0, QUARTER):
        plant = StandPlant(
            puppet_spec(), np.zeros(len(JOINTS)), JOINTS, play=dict.fromkeys(JOINTS, width)
        )
        for _ in range(2000):
            plant.advance(torque, 0.001)
        ends.append(plant.position()[elbow])
    assert ends[1] == pytest.approx(ends[0], abs=1e-6)
    rotor = plant.model.joint(rotor_of(plant.model, "left_elbow_bend")).qposadr[0]
    give = plant.data.qpos[rotor] - ends[1] - 0.5 * QUARTER
    assert 0.0 < give < np.radians(0.01)


def standing(play: float) -> ServoPlant:
    model = with_play(puppet_spec(), dict.fromkeys(JOINTS, play))
    plant = ServoPlant(model, puppet_model().key("standing").qpos, JOINTS, period=0.001)
    plant.let_go()
    return plant


def test_what_was_seen_has_no_rotors_and_nobody_helped() -> None:
    plant = standing(QUARTER)
    assert isinstance(plant, GearedPlant)
    rng = np.random.default_rng(5)
    for _ in range(60):
        plant.advance(rng.uniform(-0.3, 0.3, len(JOINTS)).tolist(), 0.001)
    seen = plant.recorded()
    assert seen["qpos"].shape == (60, puppet_model().nq)
    assert seen["qvel"].shape == (60, puppet_model().nv)
    assert np.all(seen["root_force"] == 0.0)
    assert np.abs(np.subtract(plant.rotor_velocity(), plant.velocity())).max() > 0.01


def test_a_jammed_horn_has_its_play_and_no_more() -> None:
    plant = standing(np.radians(2.0))
    elbow = JOINTS.index("left_elbow_bend")
    plant.jam(elbow, True)
    rotor = int(plant.model.joint(rotor_of(plant.model, "left_elbow_bend")).dofadr[0])
    own = int(plant.model.joint("left_elbow_bend").dofadr[0])
    ends = []
    for push in (0.05, -0.05):
        plant.data.qfrc_applied[own] = push
        for _ in range(400):
            plant.advance([0.0] * len(JOINTS), 0.001)
        ends.append(plant.position()[elbow])
        assert abs(plant.data.qvel[rotor]) < 0.01
    # The elbow's own stop at 0 degrees is one of the two ends, give or take its softness.
    assert 0.5 * np.radians(2.0) < ends[0] - ends[1] < np.radians(2.1)


def test_the_winding_feels_the_rotor_and_the_sensor_the_horn() -> None:
    """A motor that races in its play is braked by its own voltage, while its horn stands still."""

    class Racing:
        def advance(self, torque: Sequence[float], period: float) -> None: ...
        def position(self) -> list[float]: return [0.0]  # fmt: skip

        def velocity(self) -> list[float]: return [0.0]  # fmt: skip

        def rotor_velocity(self) -> list[float]: return [3.0]  # fmt: skip

        def jam(self, joint: int, jammed: bool) -> None: ...

    model = datasheet("XM430-W350")
    servo = Servo(model, 1)
    bus = Bus([servo], Racing())
    servo.write(64, b"\x01")
    bus.run_until(0.002)
    assert servo.motor.current == pytest.approx(-model.back_emf * 3.0 / model.resistance, rel=0.05)
    assert servo.horn.rate == 0.0


def test_a_play_that_is_none_is_refused() -> None:
    with pytest.raises(BodyError, match="tail"):
        with_play(puppet_spec(), {"tail": 0.1})
    for width in (-0.1, float("nan"), 4.0):
        with pytest.raises(BodyError, match="play"):
            with_play(puppet_spec(), {"left_knee_bend": width})
