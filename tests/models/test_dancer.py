"""The dancer's body: mass, joints, strength, symmetry, and what of it can touch."""

from __future__ import annotations

from collections import Counter

import mujoco
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.optimize import least_squares

from enpointe.models import Anthropometry, Figure, Sex, build_dancer, dancer_model
from enpointe.models.anatomy import SIDES, Skeleton
from enpointe.models.dancer import dancer_spec

from .posing import (
    DANCERS,
    at,
    contact_pairs,
    measures,
    mirrored_qpos,
    other_side,
    random_qpos,
    standing,
)

VISUAL_GROUP = 1


@given(measures())
@settings(max_examples=8)
def test_any_allowed_body_can_be_built_and_stands(body: Anthropometry) -> None:
    """Total mass, CoM at 53-60 % of stature, crown at the stature, soles on the floor."""
    model = build_dancer(body)
    data = at(model, standing(model))
    assert model.body_mass.sum() == pytest.approx(body.mass, rel=1e-9)
    assert 0.53 < data.subtree_com[1][2] / body.height < 0.60
    assert data.site("crown").xpos[2] == pytest.approx(body.height, abs=1e-9)
    for part in ("heel", "ball", "tip"):
        for side in SIDES:
            for edge in ("inner", "outer"):
                name = f"{side}_{part}_{edge}"
                lowest = data.geom(name).xpos[2] - model.geom(name).size[0]
                assert abs(lowest) < 1e-3
    assert Figure.of(model).straight_arm == pytest.approx(Skeleton(body).straight_arm)


@pytest.mark.parametrize("height", [1.30, 1.50, 1.68, 2.00, 2.10])
@pytest.mark.parametrize("sex", Sex)
def test_only_the_soles_meet_the_floor_when_standing(height: float, sex: Sex) -> None:
    model = build_dancer(Anthropometry(height, 20 * height**2, sex))
    lowered = standing(model)
    lowered[2] -= 2e-4  # the spheres touch to within a rounding error: settle on the floor
    pairs = contact_pairs(model, at(model, lowered))
    assert len(pairs) == 12
    for first, second, _ in pairs:
        assert first == "floor"
        assert any(part in second for part in ("_heel_", "_ball_", "_tip_"))


@pytest.mark.parametrize("body", DANCERS.values(), ids=DANCERS.keys())
def test_joints_and_actuators_come_in_the_skeleton_s_order(body: Anthropometry) -> None:
    model = dancer_model(body)
    hinges = [name for name, _ in Skeleton(body).hinges()]
    assert [model.joint(j).name for j in range(model.njnt)] == ["root", *hinges]
    assert [model.actuator(a).name for a in range(model.nu)] == hinges
    assert list(model.actuator_trnid[:, 0]) == list(range(1, model.njnt))
    assert (model.actuator_trntype == mujoco.mjtTrn.mjTRN_JOINT).all()


def test_strength_is_positive_and_proportional_to_mass(model: mujoco.MjModel) -> None:
    heavier = build_dancer(Anthropometry(mass=1.2 * Anthropometry().mass))
    low, high = model.actuator_forcerange.T
    assert (high > 0).all()
    assert np.allclose(low, -high)
    assert np.allclose(heavier.actuator_forcerange, 1.2 * model.actuator_forcerange)
    assert model.actuator_forcelimited.all()


def test_a_motor_gives_the_torque_it_is_told_up_to_its_limit(model: mujoco.MjModel) -> None:
    data = mujoco.MjData(model)
    limits = model.actuator_forcerange[:, 1]
    for share in (0.5, -0.5, 3.0):
        data.ctrl[:] = share * limits
        mujoco.mj_forward(model, data)
        assert np.allclose(data.qfrc_actuator[6:], np.clip(share, -1, 1) * limits)
        assert np.allclose(data.qfrc_actuator[:6], 0)


def test_nothing_holds_the_dancer_but_the_floor(model: mujoco.MjModel) -> None:
    """No equality (weld), no mocap body, no tendon, one free root, no force from springs."""
    assert model.neq == 0
    assert model.nmocap == 0
    assert model.ntendon == 0
    kinds = Counter(int(kind) for kind in model.jnt_type)
    assert kinds[int(mujoco.mjtJoint.mjJNT_FREE)] == 1
    assert kinds[int(mujoco.mjtJoint.mjJNT_HINGE)] == model.njnt - 1
    assert not model.jnt_stiffness.any()
    assert not model.body_gravcomp.any()
    assert model.dof_damping[:6].sum() == 0
    assert model.dof_armature[:6].sum() == 0
    assert np.allclose(model.opt.gravity, [0, 0, -9.81])


def test_the_constraint_jacobian_stays_dense(model: mujoco.MjModel) -> None:
    """MuJoCo 4.0.0's Newton solver has a wrong Hessian with a sparse one (mujoco #3767)."""
    assert model.opt.jacobian == mujoco.mjtJacobian.mjJAC_DENSE


def test_no_name_is_used_twice(model: mujoco.MjModel) -> None:
    """Pinocchio reads bodies, joints, sites and geoms as frames of one namespace."""
    kinds = {
        "body": (model.nbody, model.body),
        "joint": (model.njnt, model.joint),
        "site": (model.nsite, model.site),
        "geom": (model.ngeom, model.geom),
    }
    names = Counter(get(i).name for count, get in kinds.values() for i in range(count))
    assert "" not in names
    assert [name for name, count in names.items() if count > 1] == []


def test_all_hinges_are_limited_and_standing_is_inside(model: mujoco.MjModel) -> None:
    low, high = model.jnt_range[1:].T
    assert model.jnt_limited[1:].all()
    assert (low < high).all()
    assert ((low <= standing(model)[7:]) & (standing(model)[7:] <= high)).all()


@pytest.mark.parametrize("body", DANCERS.values(), ids=DANCERS.keys())
def test_left_and_right_are_mirror_images(body: Anthropometry, rng: np.random.Generator) -> None:
    """In any pose, the mirrored pose puts every site and centre of mass at the mirrored place."""
    model = dancer_model(body)
    mirror = np.array([1.0, -1.0, 1.0])
    swapped = [model.site(other_side(model.site(i).name)).id for i in range(model.nsite)]
    bodies = [model.body(other_side(model.body(i).name)).id for i in range(model.nbody)]
    for _ in range(50):
        qpos = random_qpos(model, rng)
        here, there = at(model, qpos), at(model, mirrored_qpos(model, qpos))
        assert np.allclose(there.site_xpos[swapped], here.site_xpos * mirror, atol=1e-12)
        assert np.allclose(there.xipos[bodies], here.xipos * mirror, atol=1e-12)


def test_left_and_right_are_equally_strong_and_heavy(model: mujoco.MjModel) -> None:
    for left, right in ((f"left_{n}", f"right_{n}") for n in ("hand", "thigh", "foot", "toe")):
        assert model.body(left).mass == model.body(right).mass
        assert np.allclose(model.body(left).inertia, model.body(right).inertia)
    for a in range(model.nu):
        name = model.actuator(a).name
        twin = model.actuator(other_side(name)).id
        assert np.array_equal(model.actuator_forcerange[a], model.actuator_forcerange[twin])
        assert np.array_equal(model.joint(name).range, model.joint(other_side(name)).range)


def test_limbs_have_a_human_s_inertia(model: mujoco.MjModel) -> None:
    """Every body's moments are those of some real distribution of mass."""
    for b in range(1, model.nbody):
        least, middle, most = sorted(model.body_inertia[b])
        assert least > 0
        assert most <= least + middle + 1e-12


@pytest.mark.parametrize("side", SIDES)
def test_a_positive_angle_moves_the_limb_the_way_it_is_named(
    model: mujoco.MjModel, side: str
) -> None:
    """Bending lifts the hand, raising lifts the arm and leg, turning out points the toes out."""
    outward = 1.0 if side == "left" else -1.0

    def moved(joint: str, site: str, angle: float = 0.3) -> np.ndarray:
        qpos = standing(model)
        before = np.array(at(model, qpos).site(site).xpos)
        qpos[model.joint(joint).qposadr[0]] = angle
        way: np.ndarray = np.array(at(model, qpos).site(site).xpos) - before
        return way

    assert moved(f"{side}_elbow_bend", f"{side}_wrist")[0] > 0.03
    assert moved(f"{side}_shoulder_raise", f"{side}_wrist")[2] > 0.01
    assert moved(f"{side}_hip_raise", f"{side}_ankle")[2] > 0.01
    assert outward * moved(f"{side}_hip_turn", f"{side}_toe_tip")[1] > 0.03
    assert outward * moved(f"{side}_ankle_turn", f"{side}_toe_tip")[1] > 0.03
    assert moved(f"{side}_knee_bend", f"{side}_ankle")[0] < -0.03
    assert moved(f"{side}_ankle_point", f"{side}_toe_tip")[2] < -0.02
    assert moved(f"{side}_toe_raise", f"{side}_toe_tip")[2] > 0.01
    assert outward * moved(f"{side}_wrist_bend", f"{side}_fingertips")[1] < -0.02


def test_the_head_and_waist_turn_left_tilt_left_and_bend_forward(model: mujoco.MjModel) -> None:
    """The senses of `Orientation`: + turn and + tilt to the dancer's left, + bend forward."""
    for joint in ("neck", "waist"):
        for hinge, site, axis in (
            ("turn", "eyes", 1),
            ("tilt", "crown", 1),
            ("bend", "crown", 0),
        ):
            qpos = standing(model)
            before = at(model, qpos).site(site).xpos[axis]
            qpos[model.joint(f"{joint}_{hinge}").qposadr[0]] = 0.3
            assert at(model, qpos).site(site).xpos[axis] - before > 0.02


def brought_together(
    model: mujoco.MjModel, first: str, second: str
) -> list[tuple[str, str, float]]:
    """Contacts between two geoms after moving the joints so that their middles meet."""
    free = model.jnt_range[1:]
    start = np.clip(standing(model)[7:], free[:, 0] + 1e-3, free[:, 1] - 1e-3)
    data = mujoco.MjData(model)
    one, two = model.geom(first).id, model.geom(second).id

    def gap(angles: np.ndarray) -> np.ndarray:
        data.qpos[:] = np.concatenate([standing(model)[:7], angles])
        mujoco.mj_kinematics(model, data)
        apart = data.geom_xpos[one] - data.geom_xpos[two]
        return np.concatenate([apart, 1e-3 * (angles - start)])

    found = least_squares(gap, start + 0.05, bounds=(free[:, 0], free[:, 1]))
    result = at(model, np.concatenate([standing(model)[:7], found.x]))
    return [pair for pair in contact_pairs(model, result) if {first, second} == set(pair[:2])]


@pytest.mark.parametrize(
    ("first", "second"),
    [
        ("left_hand_limb", "right_hand_limb"),
        ("left_hand_limb", "left_thigh_limb"),
        ("left_hand_limb", "right_thigh_limb"),
        ("right_forearm_limb", "head_limb"),
        ("left_shank_limb", "right_shank_limb"),
        ("left_thigh_limb", "right_thigh_limb"),
        ("left_foot_limb", "right_foot_limb"),
        ("left_foot_limb", "right_shank_limb"),
        ("left_hand_limb", "torso_limb"),
        ("left_forearm_limb", "right_forearm_limb"),
    ],
)
def test_limbs_that_can_meet_collide(model: mujoco.MjModel, first: str, second: str) -> None:
    contacts = brought_together(model, first, second)
    assert contacts, f"{first} and {second} pass through one another"
    assert min(distance for *_, distance in contacts) < -0.005


@pytest.mark.parametrize(
    ("one", "two", "meets"),
    [
        ("left_ball_inner", "floor", True),
        ("left_thigh_limb", "floor", True),
        ("head_limb", "floor", True),
        ("left_ball_inner", "right_ball_inner", False),
        ("left_heel_inner", "right_shank_limb", False),
    ],
)
def test_which_classes_meet(model: mujoco.MjModel, one: str, two: str, meets: bool) -> None:
    """MuJoCo's filter: a contact needs one geom's type in the other's affinity."""
    a, b = model.geom(one).id, model.geom(two).id
    bits = (model.geom_contype[a] & model.geom_conaffinity[b]) | (
        model.geom_contype[b] & model.geom_conaffinity[a]
    )
    assert bool(bits) is meets


def test_a_fallen_dancer_lies_on_the_floor(model: mujoco.MjModel) -> None:
    """Lying down, trunk and head meet the floor: nothing sinks through it."""
    qpos = standing(model)
    qpos[2], qpos[3:7] = 0.08, [np.sqrt(0.5), 0, np.sqrt(0.5), 0]
    touching = {name for pair in contact_pairs(model, at(model, qpos)) for name in pair[:2]}
    assert {"floor", "torso_limb", "pelvis_limb"} <= touching


def test_flesh_is_only_for_the_eye(model: mujoco.MjModel) -> None:
    """Without the visual geoms the body has the same mass, inertia and contacts."""
    visual = model.geom_group == VISUAL_GROUP
    assert visual.sum() > 20
    assert not model.geom_contype[visual].any()
    assert not model.geom_conaffinity[visual].any()
    spec = dancer_spec(Anthropometry())
    for geom in list(spec.geoms):
        if geom.group == VISUAL_GROUP:
            spec.delete(geom)
    bare = spec.compile()
    assert bare.ngeom == model.ngeom - visual.sum()
    assert np.array_equal(bare.body_mass, model.body_mass)
    assert np.array_equal(bare.body_inertia, model.body_inertia)
    assert np.array_equal(bare.body_ipos, model.body_ipos)
    assert contact_pairs(bare, at(bare, standing(bare))) == contact_pairs(
        model, at(model, standing(model))
    )


@given(st.integers(0, 2**32 - 1))
@settings(max_examples=5)
def test_passive_motion_in_the_air_obeys_newton(seed: int) -> None:
    """Thrown, with slack muscles, the centre of mass falls at g whatever the limbs do."""
    model = dancer_model()
    rng = np.random.default_rng(seed)
    qpos = standing(model)
    qpos[2] += 3.0
    data = mujoco.MjData(model)
    data.qpos[:] = qpos
    data.qvel[6:] = rng.normal(scale=1.0, size=model.nv - 6)
    mujoco.mj_forward(model, data)
    jacobian = np.zeros((3, model.nv))
    mujoco.mj_jacSubtreeCom(model, data, jacobian, 1)
    before = jacobian @ data.qvel
    for _ in range(20):
        mujoco.mj_step(model, data)
    mujoco.mj_forward(model, data)
    mujoco.mj_jacSubtreeCom(model, data, jacobian, 1)
    fallen = jacobian @ data.qvel - before
    assert np.allclose(fallen, [0, 0, -9.81 * 20 * model.opt.timestep], atol=2e-3)
