"""The shipped rigs against what is published, and against their own bodies at their ends."""

from __future__ import annotations

import mujoco
import numpy as np
import pytest

from enpointe.hardware.rig_file import RigServo, load_rig, shipped_rigs
from enpointe.models.puppet import op3_model, puppet_model

OP3 = {
    "r_sho_pitch": (1, -0.5, 0.5), "l_sho_pitch": (2, -0.5, 0.5),
    "r_sho_roll": (3, -0.5, 0.3), "l_sho_roll": (4, -0.3, 0.5),
    "r_el": (5, -0.5, 0.5), "l_el": (6, -0.5, 0.5),
    "r_hip_yaw": (7, -0.45, 0.45), "l_hip_yaw": (8, -0.45, 0.45),
    "r_hip_roll": (9, -0.3, 0.3), "l_hip_roll": (10, -0.3, 0.3),
    "r_hip_pitch": (11, -0.4, 0.4), "l_hip_pitch": (12, -0.4, 0.4),
    "r_knee": (13, -0.7, 0.1), "l_knee": (14, -0.1, 0.7),
    "r_ank_pitch": (15, -0.45, 0.45), "l_ank_pitch": (16, -0.45, 0.45),
    "r_ank_roll": (17, -0.45, 0.45), "l_ank_roll": (18, -0.45, 0.45),
    "head_pan": (19, -0.5, 0.5), "head_tilt": (20, -0.5, 0.5),
}  # fmt: skip
"""ID (OP3.robot) and limits over pi (op3_kinematics_dynamics.cpp): ROBOTIS-OP3 at 3bc2bd5."""
INITIAL = {
    "r_sho_pitch": 15, "l_sho_pitch": -15, "r_sho_roll": -45, "l_sho_roll": 45,
    "r_el": 45, "l_el": -45, "r_hip_pitch": 70, "l_hip_pitch": -70,
    "r_knee": -142, "l_knee": 142, "r_ank_pitch": -70, "l_ank_pitch": 70, "head_tilt": -10,
}  # fmt: skip
"""Degrees, of the same: op3_base_module/data/ini_pose.yaml; the others are 0."""
KNEES_MEET = 148.0
"""Degrees at which the published meshes of thigh (ll3.stl) and shank (ll4.stl) are in one another:
ROBOTIS-OP3-Common at 0780e54, triangle by triangle; at 145 they are not."""
AT_11_V = 43 * 6.0
"""Degrees/s of an XM430-W350 without load at the 11.1 V of OP3's battery (e-manual)."""


def body_of(name: str) -> mujoco.MjModel:
    return {"op3": op3_model, "puppet": puppet_model}[name]()


def test_op3_is_the_one_that_is_published() -> None:
    rig = load_rig("op3")
    assert (rig.baud, rig.rate) == (2_000_000, 125.0)
    assert {servo.joint: servo.id for servo in rig.servos} == {j: row[0] for j, row in OP3.items()}
    for servo in rig.servos:
        assert (servo.sign, servo.offset, servo.model) == (1, 0.0, "XM430-W350")
        assert servo.speed <= AT_11_V
        published = [180.0 * share for share in OP3[servo.joint][1:]]
        if servo.joint.endswith("knee"):
            bent = abs(INITIAL[servo.joint])
            assert max(map(abs, published)) < bent <= max(map(abs, servo.limits)) < KNEES_MEET
            published[int(np.argmax(np.abs(published)))] = max(servo.limits, key=abs)
        assert servo.limits == pytest.approx(published), servo.joint


def test_op3_can_take_its_own_initial_pose() -> None:
    for servo in load_rig("op3").servos:
        low, high = servo.limits
        assert low <= INITIAL.get(servo.joint, 0) <= high, servo.joint


@pytest.mark.parametrize("name", shipped_rigs())
def test_limits_are_the_bodys_own(name: str) -> None:
    model = body_of(name)
    for servo in load_rig(name).servos:
        assert servo.range == pytest.approx(model.joint(servo.joint).range, abs=1e-6), servo.joint


@pytest.mark.parametrize("name", shipped_rigs())
def test_servos_of_left_and_right_are_alike(name: str) -> None:
    servos = {servo.joint: servo for servo in load_rig(name).servos}
    for joint, servo in servos.items():
        side = {"left_": "right_", "l_": "r_"}
        for left, right in side.items():
            if not joint.startswith(left):
                continue
            other = servos[right + joint.removeprefix(left)]
            mirrored = tuple(sorted(-angle for angle in other.limits))
            assert servo.limits in (other.limits, mirrored)
            for what in ("model", "speed", "current", "gains", "offset", "sign"):
                assert getattr(servo, what) == getattr(other, what), (joint, what)


def in_its_own_chain(model: mujoco.MjModel, servo: RigServo, angle: float) -> list[str]:
    """What of a limb is in another part of it, when one joint alone is turned from standing."""
    data = mujoco.MjData(model)
    data.qpos[:] = model.key("standing").qpos
    data.qpos[2] += 1.0
    data.qpos[model.joint(servo.joint).qposadr[0]] = np.radians(angle)
    mujoco.mj_kinematics(model, data)
    mujoco.mj_collision(model, data)
    found = []
    for contact in data.contact:
        first, second = (int(model.geom_bodyid[geom]) for geom in contact.geom)
        if contact.dist < 0.0 and (above(model, first, second) or above(model, second, first)):
            found.append(f"{model.body(first).name} in {model.body(second).name}")
    return found


def above(model: mujoco.MjModel, ancestor: int, body: int) -> bool:
    while body:
        body = int(model.body_parentid[body])
        if body == ancestor:
            return True
    return False


@pytest.mark.parametrize("name", shipped_rigs())
def test_no_joint_alone_turns_a_limb_into_itself(name: str) -> None:
    """A limit that the body itself stops short of is no limit."""
    model = body_of(name)
    for servo in load_rig(name).servos:
        for end in servo.limits:
            assert in_its_own_chain(model, servo, end) == [], (servo.joint, end)


@pytest.mark.parametrize("name", shipped_rigs())
def test_a_rig_stays_below_what_stalls_or_outruns_its_servos(name: str) -> None:
    """Goals of speed leave a margin under no-load speed, of current under the stall's."""
    for servo in load_rig(name).servos:
        assert servo.speed < 0.95 * np.degrees(servo.sheet.no_load_speed), servo.joint
        assert servo.current < 0.6e3 * servo.sheet.stall_current, servo.joint
