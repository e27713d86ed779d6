"""Bodies of servos: weighed, measured, mirrored, and signed as the dancer is."""

from __future__ import annotations

import mujoco
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from enpointe.hardware import datasheet
from enpointe.models.dancer import dancer_model
from enpointe.models.puppet import SERVOS, op3_model, puppet_model
from enpointe.models.puppet.gearmotor import GEARMOTORS
from enpointe.models.puppet.servos import OP3_IDS, PUPPET_IDS
from enpointe.models.soles import sole_geoms, sole_points

BODIES = {"puppet": puppet_model, "op3": op3_model}


def placed(model: mujoco.MjModel, qpos: np.ndarray | None = None) -> mujoco.MjData:
    data = mujoco.MjData(model)
    data.qpos[:] = model.key("standing").qpos if qpos is None else qpos
    mujoco.mj_forward(model, data)
    return data


@pytest.fixture(params=sorted(BODIES))
def body(request: pytest.FixtureRequest) -> str:
    return str(request.param)


def test_every_joint_has_its_servo_and_its_motor(body: str) -> None:
    """Actuators are torque sources named as their joints, as strong as the servo stalls."""
    model = BODIES[body]()
    assert {model.actuator(i).name for i in range(model.nu)} == set(SERVOS[body])
    for i in range(model.nu):
        name = model.actuator(i).name
        sheet = datasheet(SERVOS[body][name])
        joint = model.joint(name)
        assert model.actuator_trnid[i, 0] == joint.id
        assert model.actuator_forcerange[i, 1] == pytest.approx(sheet.stall_torque)
        assert model.dof_armature[joint.dofadr[0]] == pytest.approx(sheet.armature)
        assert model.dof_frictionloss[joint.dofadr[0]] == pytest.approx(sheet.friction)
    assert not model.dof_damping.any()


def test_ids_are_in_the_order_of_the_bus() -> None:
    assert list(PUPPET_IDS.values()) == list(range(1, 26))
    assert (PUPPET_IDS["waist_turn"], PUPPET_IDS["right_ankle_roll"]) == (1, 25)
    assert (OP3_IDS["r_sho_pitch"], OP3_IDS["l_ank_roll"], OP3_IDS["head_tilt"]) == (1, 18, 20)


def test_a_datasheet_is_of_the_motor_of_the_bodies() -> None:
    for name, motor in GEARMOTORS.items():
        sheet = datasheet(name)
        assert (sheet.mass, sheet.stall_torque, sheet.back_emf) == (
            motor.mass,
            motor.stall_torque,
            motor.back_emf,
        )


def test_the_puppet_weighs_what_her_parts_do() -> None:
    """25 cases at the datasheets' weight, each where its servo is, and the rest is structure."""
    model = puppet_model()
    data = placed(model)
    spec_mass = float(model.body_mass.sum())
    cases = [model.geom(f"{joint}_servo").id for joint in SERVOS["puppet"]]
    servos = sum(datasheet(servo).mass for servo in SERVOS["puppet"].values())
    assert servos == pytest.approx(12 * 0.082 + 2 * 0.082 + 11 * 0.023)
    assert 0.35 < 1.0 - servos / spec_mass < 0.45
    for joint, case in zip(SERVOS["puppet"], cases, strict=True):
        anchor = data.xanchor[model.joint(joint).id]
        assert np.linalg.norm(data.geom_xpos[case] - anchor) < 0.05
        # A case is carried by one of the two bodies that its servo turns against each other.
        turned = int(model.joint(joint).bodyid[0])
        assert int(model.geom_bodyid[case]) in (turned, int(model.body_parentid[turned]))


def test_op3_weighs_what_is_published() -> None:
    assert op3_model().body_mass.sum() == pytest.approx(3.147, abs=1e-3)


def test_inertias_are_possible(body: str) -> None:
    model = BODIES[body]()
    for i in range(1, model.nbody):
        a, b, c = sorted(model.body_inertia[i])
        if model.body_mass[i] > 0:
            assert a > 0, model.body(i).name
            assert a + b >= c * (1 - 1e-9), model.body(i).name


def test_she_stands_on_her_soles_with_her_weight_between_them(body: str) -> None:
    model = BODIES[body]()
    data = placed(model)
    points = sole_points(model, data, sole_geoms(model))
    low = points[points[:, 2] < 1e-3]
    assert np.abs(low[:, 2]).max() < 1e-6
    com = data.subtree_com[0]
    assert low[:, 0].min() + 0.01 < com[0] < low[:, 0].max() - 0.01
    assert abs(com[1]) < 1e-3
    touching = {model.geom(g).name for c in data.contact for g in c.geom} - {"floor"}
    assert touching <= {model.geom(int(g)).name for g in sole_geoms(model)}


@given(st.data())
@settings(max_examples=25, deadline=None)
def test_a_joint_turns_as_the_dancers_of_its_name(data: st.DataObject) -> None:
    """The same angle of a shared joint turns the limb's end the same way from upright."""
    puppet, dancer = puppet_model(), dancer_model(flesh=False)
    shared = [
        n for n in SERVOS["puppet"] if mujoco.mj_name2id(dancer, mujoco.mjtObj.mjOBJ_JOINT, n)
    ]
    name = data.draw(st.sampled_from(shared))
    low, high = puppet.joint(name).range
    angle = data.draw(st.floats(low, high))
    turned = []
    for model in (puppet, dancer):
        qpos = np.array(model.key("standing").qpos)
        qpos[model.joint(name).qposadr[0]] = angle
        posed = placed(model, qpos)
        end = "head" if "neck" in name else "torso" if "waist" in name else None
        if end is None:
            part = "foot" if any(k in name for k in ("hip", "knee", "ankle")) else "forearm"
            end = f"{name.split('_')[0]}_{part}"
        turned.append(posed.body(end).xmat.copy())
    np.testing.assert_allclose(turned[0], turned[1], atol=1e-9)


@given(st.data())
@settings(max_examples=25, deadline=None)
def test_mirrored_angles_are_mirrored_poses(data: st.DataObject) -> None:
    """Left and right are alike: ranges, masses, and where parts are when angles are mirrored."""
    model = puppet_model()
    qpos = np.array(model.key("standing").qpos)
    for name in SERVOS["puppet"]:
        if name.startswith("left_"):
            low, high = model.joint(name).range
            other = model.joint(name.replace("left_", "right_"))
            np.testing.assert_array_equal(other.range, (low, high))
            angle = data.draw(st.floats(low, high))
            for each in (model.joint(name), other):
                qpos[each.qposadr[0]] = angle
    posed = placed(model, qpos)
    for i in range(model.nbody):
        name = model.body(i).name
        if name.startswith("left_"):
            right = posed.body(name.replace("left_", "right_"))
            np.testing.assert_allclose(posed.xipos[i] * [1, -1, 1], right.xipos, atol=1e-9)
            assert model.body_mass[i] == model.body(name.replace("left_", "right_")).mass[0]


def test_her_second_sole_lies_flat_when_the_heel_is_up() -> None:
    """At 45 degrees ball and tip studs are level, and her ankle stands over them."""
    model = puppet_model()
    qpos = np.array(model.key("standing").qpos)
    angle = np.pi / 4
    for side in ("left", "right"):
        qpos[model.joint(f"{side}_ankle_point").qposadr[0]] = angle
    data = placed(model, qpos)
    points = {
        model.geom(int(g)).name: p
        for g, p in zip(sole_geoms(model), sole_points(model, data, sole_geoms(model)), strict=True)
    }
    ball, tip, heel = (points[f"left_{part}_inner"] for part in ("ball", "tip", "heel"))
    assert tip[2] == pytest.approx(ball[2], abs=1e-4)
    assert heel[2] - ball[2] > 0.045
    assert ball[0] - 0.01 < data.site("left_ankle").xpos[0] < tip[0]
