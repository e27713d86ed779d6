"""Joint loads beside MuJoCo's own inverse dynamics, on bodies small enough to check by hand."""

from __future__ import annotations

import mujoco
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from enpointe.errors import MotionError
from enpointe.models.soles import sole_geoms
from enpointe.motion import Motion
from enpointe.motion.contact_schedule import ContactSchedule
from enpointe.sim.floor_limits import floor_limits
from enpointe.sim.joint_loads import JointLoads, joint_loads

Array = NDArray[np.float64]
RATE = 200.0
SOLES = "".join(
    f'<geom type="sphere" size=".005" pos="{x} {y} -.045" mass="0" contype="2" conaffinity="1"/>'
    for x in (-0.03, 0.07)
    for y in (-0.03, 0.03)
)
LIMB = 'contype="4" conaffinity="4"'
FOOT = f'<geom type="box" size=".05 .03 .02" mass=".1" {LIMB}/>{SOLES}'
SHANK = (
    '<geom type="capsule" fromto="0 0 0 0 0 -.1" size=".02" mass=".3" contype="4" conaffinity="4"/>'
)
TRUNK = (
    '<geom type="box" size=".04 .06 .08" pos=".01 0 .08" mass="1.2" contype="4" conaffinity="4"/>'
)
ARM = f"""<body name="arm" pos="0 .08 .1"><joint name="shoulder" axis="0 1 0" armature=".02"/>
<geom type="capsule" fromto="0 0 0 .12 0 0" size=".015" mass=".2" {LIMB}/>
</body>"""
HIP = '<joint name="hip" axis="0 1 0" armature=".045"/>'
ANKLE = '<joint name="ankle" axis="0 1 0" armature=".045"/>'


def body(root: str) -> mujoco.MjModel:
    """Trunk, one leg and an arm; the trunk on a free root, or fixed."""
    return mujoco.MjModel.from_xml_string(f"""<mujoco><worldbody>
    <geom type="plane" size="1 1 1" contype="1" conaffinity="6"/>
    <body name="trunk" pos="0 0 .15">{root}{TRUNK}{ARM}
    <body name="shank">{HIP}{SHANK}<body name="foot" pos="0 0 -.1">{ANKLE}{FOOT}</body></body>
    </body></worldbody></mujoco>""")


# The same leg the other way up: the foot is nailed to the floor. A joint turns what is above it,
# the other way round.
NAILED = mujoco.MjModel.from_xml_string(f"""<mujoco><worldbody>
    <body pos="0 0 .05"><body name="shank">
    <joint name="ankle" axis="0 -1 0" armature=".045"/>
    <geom type="capsule" fromto="0 0 .1 0 0 0" size=".02" mass=".3" contype="0" conaffinity="0"/>
    <body name="trunk" pos="0 0 .1"><joint name="hip" axis="0 -1 0" armature=".045"/>
    {TRUNK}{ARM}</body></body></body></worldbody></mujoco>""")
FREE = body('<freejoint name="root"/>')
HUNG = body("")


def hung(amplitudes: Array, hz: float, seconds: float = 1.0) -> Motion:
    """All joints to and fro, the trunk held still."""
    time = np.arange(0.0, seconds + 0.5 / RATE, 1.0 / RATE)
    w = 2.0 * np.pi * hz
    wave, slope = np.sin(w * time)[:, None], w * np.cos(w * time)[:, None]
    qpos = np.zeros((len(time), FREE.nq))
    qpos[:, 2], qpos[:, 3] = 0.15, 1.0
    qvel, qacc = np.zeros((2, len(time), FREE.nv))
    qpos[:, 7:], qvel[:, 6:] = wave * amplitudes, slope * amplitudes
    qacc[:, 6:] = -(w**2) * wave * amplitudes
    return Motion(FREE, time, qpos, qvel, qacc)


def slower(motion: Motion, scale: float) -> Motion:
    return Motion(
        motion.model,
        motion.time * scale,
        motion.qpos,
        motion.qvel / scale,
        motion.qacc / scale**2,
    )


def inverse(model: mujoco.MjModel, qpos: Array, qvel: Array, qacc: Array) -> Array:
    model.opt.disableflags |= mujoco.mjtDisableBit.mjDSBL_CONTACT
    data = mujoco.MjData(model)
    data.qpos[:], data.qvel[:], data.qacc[:] = qpos, qvel, qacc
    mujoco.mj_inverse(model, data)
    return np.array(data.qfrc_inverse)


def always(motion: Motion) -> ContactSchedule:
    """Every sole bears, wherever it is."""
    soles = sole_geoms(motion.model)
    shape = (len(motion.time), len(soles))
    return ContactSchedule(motion.time, soles, np.zeros((*shape, 3)), np.ones(shape, dtype=bool))


amplitudes = st.tuples(*[st.floats(-1.0, 1.0)] * 3).map(np.array)


@settings(max_examples=20, deadline=None)
@given(amplitudes, st.floats(0.2, 3.0))
def test_on_a_stand_torques_are_inverse_dynamics_of_a_fixed_base(sway: Array, hz: float) -> None:
    motion = hung(sway, hz, 0.3)
    loads = joint_loads(motion, stand=True)
    assert loads.joints == ("shoulder", "hip", "ankle")
    for i in range(0, len(motion.time), 7):
        expected = inverse(HUNG, motion.qpos[i, 7:], motion.qvel[i, 6:], motion.qacc[i, 6:])
        np.testing.assert_allclose(loads.static[i] + loads.dynamic[i], expected, atol=1e-9)


@settings(max_examples=20, deadline=None)
@given(amplitudes, st.floats(0.5, 4.0), st.booleans())
def test_slowing_divides_the_dynamic_part_by_the_square(
    sway: Array, scale: float, stand: bool
) -> None:
    motion = hung(sway, 1.0, 0.2)
    one = joint_loads(motion, always(motion), stand=stand)
    slow = slower(motion, scale)
    other = joint_loads(slow, always(slow), stand=stand)
    np.testing.assert_allclose(other.static, one.static, atol=1e-9)
    np.testing.assert_allclose(other.dynamic, one.dynamic / scale**2, atol=1e-9)
    np.testing.assert_allclose(other.force[:, 1], one.force[:, 1] / scale**2, atol=1e-9)


def standing(hip: Array, ankle: Array, time: Array) -> tuple[Motion, Array]:
    """The free body with its foot kept on the floor; and the nailed one's angles."""
    data = mujoco.MjData(NAILED)
    qpos = np.zeros((len(time), FREE.nq))
    angles = np.stack([ankle, hip, 0.3 * hip], axis=1)
    trunk = NAILED.body("trunk").id
    for i in range(len(time)):
        data.qpos[:] = angles[i]
        mujoco.mj_kinematics(NAILED, data)
        qpos[i, :3], qpos[i, 3:7] = data.xpos[trunk], data.xquat[trunk]
        qpos[i, 7:] = 0.3 * hip[i], hip[i], ankle[i]
    return Motion.from_qpos(FREE, time, qpos), angles


def test_on_one_foot_torques_are_those_of_a_leg_nailed_to_the_floor() -> None:
    time = np.arange(0.0, 0.6, 1.0 / RATE)
    motion, angles = standing(0.3 * np.sin(5 * time), -0.2 * np.sin(4 * time), time)
    loads = joint_loads(motion, always(motion))
    speeds = np.gradient(angles, time, axis=0)
    rises = np.gradient(speeds, time, axis=0)
    for i in range(5, len(time) - 5, 9):
        ankle, hip, shoulder = inverse(NAILED, angles[i], speeds[i], rises[i])
        np.testing.assert_allclose(
            loads.static[i] + loads.dynamic[i], [shoulder, hip, ankle], atol=2e-3
        )


def test_the_zero_moment_point_is_found_as_ever() -> None:
    from enpointe.sim.balance import zero_moment_point

    time = np.arange(0.0, 0.6, 1.0 / RATE)
    motion, _ = standing(0.3 * np.sin(5 * time), -0.2 * np.sin(4 * time), time)
    loads = joint_loads(motion, always(motion))
    data = mujoco.MjData(FREE)
    momentum, com, velocity = np.empty((3, len(time), 3))
    for i in range(len(time)):
        data.qpos[:], data.qvel[:] = motion.qpos[i], motion.qvel[i]
        mujoco.mj_forward(FREE, data)
        mujoco.mj_subtreeVel(FREE, data)
        com[i], velocity[i] = data.subtree_com[0], data.subtree_linvel[0]
        momentum[i] = data.subtree_angmom[0]
    rises, turns = (np.gradient(v, time, axis=0) for v in (velocity, momentum))
    mass = loads.weight / 9.81
    (balance,) = [limit for limit in floor_limits(loads) if limit.kind == "balance"]
    for i in range(5, len(time) - 5, 9):
        zmp = zero_moment_point(com[i], rises[i], turns[i], mass, 9.81)
        rows = balance.sample == i
        beyond = (balance.constant + balance.dynamic)[rows].max()
        front, back = 0.07 - zmp[0], zmp[0] + 0.03
        side = 0.03 - abs(zmp[1])
        share = loads.force[i].sum(axis=0)[2] / loads.weight
        assert beyond / share == pytest.approx(-min(front, back, side), abs=1e-4)


def test_a_lean_that_falls_over_is_off_balance_however_slow() -> None:
    time = np.arange(0.0, 0.6, 1.0 / RATE)
    # Over the toes by the ankle: 15 cm of height and 7 cm of foot.
    motion, _ = standing(0.0 * time, -0.9 * time / time[-1], time)
    (balance,) = [
        f for f in floor_limits(joint_loads(motion, always(motion))) if f.kind == "balance"
    ]
    assert balance.constant.max() > 0.0
    assert balance.constant[balance.sample == 0].max() < 0.0


def falling(acceleration: float) -> JointLoads:
    time = np.arange(0.0, 0.3, 1.0 / RATE)
    qpos = np.zeros((len(time), FREE.nq))
    qpos[:, 3] = 1.0
    qpos[:, 2] = 1.0 - 0.5 * acceleration * time**2
    return joint_loads(Motion.from_qpos(FREE, time, qpos))


def test_only_a_fall_with_gravity_is_free() -> None:
    for acceleration, free in ((9.81, True), (9.81 / 4.0, False)):
        loads = falling(acceleration)
        assert loads.aloft.all()
        (flight,) = floor_limits(loads)
        inner = (flight.sample > 1) & (flight.sample < len(loads.time) - 2)
        assert ((flight.constant + flight.dynamic)[inner].max() <= 0.0) is np.bool_(free)


def test_limbs_in_one_another_are_named() -> None:
    motion = hung(np.array([0.0, 2.9, 0.0]), 0.25)
    (overlap,) = joint_loads(motion, stand=True).overlaps
    assert {overlap.first, overlap.second} == {"trunk", "foot"}
    assert overlap.depth[0] == 0.0
    assert 0.0 < overlap.depth.max() < 0.1


def test_other_bodies_are_refused() -> None:
    time = np.array([0.0, 0.1])
    motion = Motion.from_qpos(HUNG, time, np.zeros((2, HUNG.nq)))
    with pytest.raises(MotionError, match="free root"):
        joint_loads(motion, stand=True)
