"""The kinematics in CasADi are MuJoCo's, and so are their derivatives."""

from __future__ import annotations

import casadi as ca
import mujoco
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from enpointe.errors import ModelError
from enpointe.models.kinematics import Kinematics, SymbolicBody, qpos_from_tangent

from .posing import random_qpos, random_tangent

FOREIGN = """
<mujoco>
  <compiler angle="radian"/>
  <worldbody>
    <body name="cart" pos=".3 -.2 .5" quat=".9 .1 -.3 .2">
      <joint name="rail" type="slide" axis="1 2 -1" pos=".1 .2 .3" ref=".25"/>
      <joint name="lift" type="slide" axis="0 0 1"/>
      <geom size=".1" pos=".05 .02 0"/>
      <body name="boom" pos=".2 .1 .4" euler=".3 -.5 1.1">
        <joint name="ball" type="ball" pos="-.1 .07 .2"/>
        <geom type="capsule" fromto="0 0 0 .3 .1 .2" size=".04"/>
        <site name="tip" pos=".31 .12 .22"/>
        <body name="flap" pos=".3 .1 .2" quat=".5 .5 -.5 .5">
          <joint name="hinge" type="hinge" axis="1 -1 3" pos=".02 -.03 .05" ref=".7"/>
          <joint name="twist" type="hinge" axis="0 1 0" pos="-.05 .01 .02"/>
          <joint name="wag" type="slide" axis="0 1 1" pos=".4 .1 .2"/>
          <geom type="box" size=".1 .03 .02" pos=".1 0 0"/>
          <body name="plate" pos="0 .1 0"><geom size=".05"/></body>
        </body>
      </body>
    </body>
    <body name="float" pos="1 2 3" quat=".2 .3 .4 .5">
      <freejoint name="free"/>
      <geom size=".1" pos=".01 0 .02"/>
      <body name="arm" pos=".1 0 0">
        <joint name="swivel" type="ball"/>
        <geom size=".05" pos="0 .1 0"/>
      </body>
    </body>
  </worldbody>
</mujoco>
"""


def any_qpos(model: mujoco.MjModel, rng: np.random.Generator) -> np.ndarray:
    """Any configuration at all; quaternions are drawn at random and normalised."""
    qpos: np.ndarray = rng.uniform(-np.pi, np.pi, model.nq)
    for j in range(model.njnt):
        start, kind = model.jnt_qposadr[j], model.jnt_type[j]
        offset = {int(mujoco.mjtJoint.mjJNT_FREE): 3, int(mujoco.mjtJoint.mjJNT_BALL): 0}
        if int(kind) in offset:
            part = slice(start + offset[int(kind)], start + offset[int(kind)] + 4)
            quaternion = rng.normal(size=4)
            qpos[part] = quaternion / np.linalg.norm(quaternion)
    return qpos


def disagreement(
    model: mujoco.MjModel, configurations: list[np.ndarray]
) -> tuple[float, float, float]:
    """Largest differences in positions, rotations and centre of mass over the configurations."""
    kinematics, data = Kinematics(model), mujoco.MjData(model)
    worst = np.zeros(3)
    for qpos in configurations:
        data.qpos[:] = qpos
        mujoco.mj_kinematics(model, data)
        mujoco.mj_comPos(model, data)
        found = kinematics.poses(qpos)
        masses = model.body_mass[1:]
        true_com = masses @ data.xipos[1:] / masses.sum()
        differences = (
            found[0] - data.xpos[1:],
            found[1].reshape(-1, 9) - data.xmat[1:],
            found[2] - true_com,
        )
        worst = np.maximum(worst, [np.abs(d).max() for d in differences])
    positions, rotations, com = worst
    return float(positions), float(rotations), float(com)


def test_the_dancer_s_frames_agree_with_mujoco(
    model: mujoco.MjModel, rng: np.random.Generator
) -> None:
    """Positions and rotations of every body within 1e-9 in 1,000 random configurations."""
    configurations = [random_qpos(model, rng) for _ in range(1000)]
    positions, rotations, com = disagreement(model, configurations)
    assert positions < 1e-9
    assert rotations < 1e-9
    assert com < 1e-9


def test_a_foreign_model_s_frames_agree_with_mujoco(rng: np.random.Generator) -> None:
    """Slides, balls, several joints a body, anchors off the origin, reference positions."""
    model = mujoco.MjModel.from_xml_string(FOREIGN)
    positions, rotations, com = disagreement(model, [any_qpos(model, rng) for _ in range(300)])
    assert positions < 1e-9
    assert rotations < 1e-9
    assert com < 1e-9


def test_a_quaternion_is_normalised_on_the_way(
    model: mujoco.MjModel, rng: np.random.Generator
) -> None:
    kinematics = Kinematics(model)
    qpos = random_qpos(model, rng)
    scaled = np.array(qpos)
    scaled[3:7] *= 3.7
    for one, other in zip(kinematics.poses(qpos), kinematics.poses(scaled), strict=True):
        assert np.allclose(one, other, atol=1e-12)


def test_every_body_has_its_own_name_and_place(model: mujoco.MjModel) -> None:
    kinematics = Kinematics(model)
    positions, rotations, com = kinematics.poses(np.array(model.key("standing").qpos))
    assert kinematics.bodies[0] == "pelvis"
    assert len(kinematics.bodies) == len(positions) == len(rotations) == model.nbody - 1
    assert np.allclose(rotations, np.eye(3))
    assert com.shape == (3,)


@pytest.mark.parametrize(
    ("method", "kind"), [("frame", "body"), ("site", "site"), ("joint", "joint")]
)
def test_an_unknown_name_is_a_model_error(model: mujoco.MjModel, method: str, kind: str) -> None:
    body = SymbolicBody(model, ca.SX.sym("q", model.nq))
    with pytest.raises(ModelError, match=f"no {kind} called 'left_wing'"):
        getattr(body, method)("left_wing")


def site_function(model: mujoco.MjModel) -> tuple[ca.Function, ca.Function]:
    """All site positions, and their Jacobian, as functions of the tangent coordinates (nv,)."""
    x = ca.SX.sym("x", model.nv)
    body = SymbolicBody(model, qpos_from_tangent(model, x))
    sites = ca.vertcat(*(body.site(model.site(i).name) for i in range(model.nsite)))
    bodies = ca.vertcat(*(body.frame(model.body(i).name).position for i in range(1, model.nbody)))
    stacked = ca.vertcat(sites, bodies, body.com)
    return ca.Function("points", [x], [stacked]), ca.Function("J", [x], [ca.jacobian(stacked, x)])


def mujoco_points(model: mujoco.MjModel, tangent: np.ndarray) -> np.ndarray:
    data = mujoco.MjData(model)
    quaternion = Rotation.from_rotvec(tangent[3:6]).as_quat(scalar_first=True)
    data.qpos[:] = np.concatenate([tangent[:3], quaternion, tangent[6:]])
    mujoco.mj_kinematics(model, data)
    mujoco.mj_comPos(model, data)
    return np.concatenate([data.site_xpos.ravel(), data.xpos[1:].ravel(), data.subtree_com[0]])


def test_jacobians_agree_with_finite_differences_of_mujoco(
    model: mujoco.MjModel, rng: np.random.Generator
) -> None:
    """CasADi's Jacobian of sites, bodies and CoM against central differences through MuJoCo."""
    points, jacobian = site_function(model)
    step = 1e-6
    for _ in range(5):
        x = random_tangent(model, rng)
        assert np.allclose(np.asarray(points(x)).ravel(), mujoco_points(model, x), atol=1e-12)
        exact = np.asarray(jacobian(x))
        for column in range(model.nv):
            shift = step * np.eye(model.nv)[column]
            slope = (mujoco_points(model, x + shift) - mujoco_points(model, x - shift)) / (2 * step)
            assert np.allclose(exact[:, column], slope, atol=1e-8)


def test_jacobians_agree_with_mujoco_s_own(model: mujoco.MjModel, rng: np.random.Generator) -> None:
    """Against `mj_jacSite`, `mj_jacBody` and `mj_jacSubtreeCom`.

    MuJoCo turns a free root by its angular velocity in its own frame; a rotation vector's rate
    becomes one through the right Jacobian of SO(3).
    """
    _, jacobian = site_function(model)
    data = mujoco.MjData(model)
    for _ in range(5):
        x = random_tangent(model, rng)
        mujoco_points(model, x)
        quaternion = Rotation.from_rotvec(x[3:6]).as_quat(scalar_first=True)
        data.qpos[:] = np.concatenate([x[:3], quaternion, x[6:]])
        mujoco.mj_forward(model, data)
        blocks = []
        block = np.zeros((3, model.nv))
        for i in range(model.nsite):
            mujoco.mj_jacSite(model, data, block, None, i)
            blocks.append(block.copy())
        for i in range(1, model.nbody):
            mujoco.mj_jacBody(model, data, block, None, i)
            blocks.append(block.copy())
        mujoco.mj_jacSubtreeCom(model, data, block, 0)
        blocks.append(block.copy())
        theirs = np.vstack(blocks)
        theirs[:, 3:6] = theirs[:, 3:6] @ right_jacobian(x[3:6])
        assert np.allclose(np.asarray(jacobian(x)), theirs, atol=1e-10)


def right_jacobian(vector: np.ndarray) -> np.ndarray:
    """Of SO(3), body angular velocity over the rate of the rotation vector (Sola 2018, eq. 143)."""
    angle = np.linalg.norm(vector)
    x, y, z = vector
    skew = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    first = (1 - np.cos(angle)) / angle**2
    second = (angle - np.sin(angle)) / angle**3
    jacobian: np.ndarray = np.eye(3) - first * skew + second * skew @ skew
    return jacobian


@given(st.lists(st.floats(-3.1, 3.1), min_size=3, max_size=3))
def test_a_rotation_vector_becomes_its_unit_quaternion(vector: list[float]) -> None:
    model = mujoco.MjModel.from_xml_string(
        "<mujoco><worldbody><body><freejoint/><geom size='1'/></body></worldbody></mujoco>"
    )
    x = ca.SX.sym("x", 6)
    to_qpos = ca.Function("f", [x], [qpos_from_tangent(model, x)])
    qpos = np.asarray(to_qpos(np.concatenate([[1, 2, 3], vector]))).ravel()
    assert np.array_equal(qpos[:3], [1, 2, 3])
    assert np.linalg.norm(qpos[3:]) == pytest.approx(1, abs=1e-12)
    theirs = Rotation.from_rotvec(vector)
    ours = Rotation.from_quat(qpos[3:], scalar_first=True)
    assert (theirs.inv() * ours).magnitude() < 1e-9


@given(st.lists(st.floats(-1.7, 1.7), min_size=3, max_size=3), st.floats(-12.0, 12.0))
def test_the_rotation_vector_is_about_the_upright_that_faces(
    vector: list[float], facing: float
) -> None:
    """Facing turns the whole configuration about the vertical, however many times round."""
    model = mujoco.MjModel.from_xml_string(
        "<mujoco><worldbody><body><freejoint/><geom size='1'/></body></worldbody></mujoco>"
    )
    x, angle = ca.SX.sym("x", 6), ca.SX.sym("angle")
    to_qpos = ca.Function("f", [x, angle], [qpos_from_tangent(model, x, angle)])
    qpos = np.asarray(to_qpos(np.concatenate([[1, 2, 3], vector]), facing)).ravel()
    theirs = Rotation.from_euler("z", facing) * Rotation.from_rotvec(vector)
    ours = Rotation.from_quat(qpos[3:], scalar_first=True)
    assert np.array_equal(qpos[:3], [1, 2, 3])
    assert (theirs.inv() * ours).magnitude() < 1e-9


def test_the_tangent_has_a_derivative_at_the_identity(model: mujoco.MjModel) -> None:
    x = ca.SX.sym("x", model.nv)
    slope = ca.Function("J", [x], [ca.jacobian(qpos_from_tangent(model, x), x)])
    at_zero = np.asarray(slope(np.zeros(model.nv)))
    assert np.allclose(at_zero[3:7, 3:6], np.vstack([np.zeros(3), 0.5 * np.eye(3)]))


@pytest.mark.parametrize(
    "joints",
    ["<joint type='hinge'/>", "<joint type='ball'/>", "<freejoint/>"],
    ids=["no free root", "ball root", "second free body"],
)
def test_the_tangent_needs_one_free_root(joints: str) -> None:
    first = f"<body>{joints}<geom size='1'/></body>"
    second = first if "free" in joints else ""
    model = mujoco.MjModel.from_xml_string(
        f"<mujoco><worldbody>{first}{second}</worldbody></mujoco>"
    )
    with pytest.raises(ModelError, match="one free root"):
        qpos_from_tangent(model, ca.SX.sym("x", model.nv))
