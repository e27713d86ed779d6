"""Motions as ROS 2 messages, read back by others' readers."""

from __future__ import annotations

import struct
from pathlib import Path
from typing import Any

import mujoco
import numpy as np
import pytest

from enpointe.controllers import Recording
from enpointe.errors import EnpointeError, MotionError
from enpointe.motion import Motion
from enpointe.motion.formats.joint_trajectory import JointTrajectory, write_mcap, write_yaml

MODEL = mujoco.MjModel.from_xml_string("""<mujoco><worldbody><body><freejoint name="root"/>
<geom size=".1"/><body name="a"><joint name="knee" axis="0 1 0"/><geom size=".1"/>
<body name="b"><joint name="it's" axis="1 0 0"/><geom size=".1"/></body></body></body></worldbody>
<actuator><motor name="knee" joint="knee"/><motor name="it's" joint="it's"/></actuator></mujoco>""")


@pytest.fixture
def swing() -> Motion:
    time = np.arange(0.0, 1.3, 0.004)
    qpos = np.zeros((len(time), MODEL.nq))
    qpos[:, 3] = 1.0
    qpos[:, 7], qpos[:, 8] = np.sin(3.0 * time), -1e-7 * time
    return Motion.from_qpos(MODEL, time, qpos)


def test_points_are_the_motions_and_end_at_rest(swing: Motion) -> None:
    found = JointTrajectory.of(swing, rate=40.0, approach=1.5)
    assert found.joints == ("knee", "it's")
    assert found.time[0] == 1_500_000_000
    assert np.all(np.diff(found.time) > 0)
    seconds = found.time / 1e9 - 1.5
    assert seconds[-1] == pytest.approx(swing.duration, abs=1e-9)
    np.testing.assert_allclose(found.position[:, 0], np.sin(3.0 * seconds), atol=1e-4)
    np.testing.assert_allclose(found.velocity[:-1, 0], 3 * np.cos(3 * seconds[:-1]), atol=2e-2)
    assert not found.velocity[-1].any()
    assert not found.acceleration[-1].any()


def test_joints_come_in_the_order_asked(swing: Motion) -> None:
    found = JointTrajectory.of(swing, joints=("it's", "knee"))
    np.testing.assert_array_equal(found.position[:, 1], JointTrajectory.of(swing).position[:, 0])
    with pytest.raises(MotionError, match="elbow"):
        JointTrajectory.of(swing, joints=("elbow",))


@pytest.mark.parametrize("wrong", [{"rate": 0.0}, {"approach": -1.0}, {"rate": float("nan")}])
def test_no_rate_and_no_approach_are_refused(swing: Motion, wrong: dict[str, Any]) -> None:
    with pytest.raises(MotionError):
        JointTrajectory.of(swing, **wrong)


def test_yaml_reads_back_by_a_yaml_reader(swing: Motion, tmp_path: Path) -> None:
    yaml = pytest.importorskip("yaml")
    trajectory = JointTrajectory.of(swing)
    content = yaml.safe_load(write_yaml(trajectory, tmp_path / "t.yaml").read_text())
    assert content["joint_names"] == ["knee", "it's"]
    assert content["header"] == {"stamp": {"sec": 0, "nanosec": 0}, "frame_id": ""}
    for point, position, velocity in zip(
        content["points"], trajectory.position, trajectory.velocity, strict=True
    ):
        assert set(point) == {
            "positions", "velocities", "accelerations", "effort", "time_from_start"
        }  # fmt: skip
        assert all(isinstance(value, float) for value in point["positions"])
        np.testing.assert_allclose(point["positions"], position, atol=1e-9)
        np.testing.assert_allclose(point["velocities"], velocity, atol=1e-9)
    times = [p["time_from_start"]["sec"] + p["time_from_start"]["nanosec"] / 1e9
             for p in content["points"]]  # fmt: skip
    np.testing.assert_allclose(times, trajectory.time / 1e9, atol=1e-9)


def recording_of(motion: Motion) -> Recording:
    n, nu = len(motion.time), MODEL.nu
    zero = np.zeros((n, nu))
    effort = np.arange(2.0 * n).reshape(n, nu)
    return Recording(
        MODEL, motion, motion.time, motion.qpos, motion.qvel, effort, zero, zero, zero,
        np.ones((n, nu), dtype=bool), {}, None, 1.0,
    )  # fmt: skip


def test_mcap_reads_back_by_the_librarys_own_reader(swing: Motion, tmp_path: Path) -> None:
    reader = pytest.importorskip("mcap_ros2.reader")
    trajectory = JointTrajectory.of(swing, joints=("it's", "knee"))
    path = write_mcap(trajectory, tmp_path / "t.mcap", recording_of(swing))
    first, *states = list(reader.read_ros2_messages(str(path)))
    assert first.channel.topic == "/joint_trajectory_controller/joint_trajectory"
    assert first.schema.name == "trajectory_msgs/msg/JointTrajectory"
    assert (first.schema.encoding, first.channel.message_encoding) == ("ros2msg", "cdr")
    message = first.ros_msg
    assert list(message.joint_names) == ["it's", "knee"]
    for i, point in enumerate(message.points):
        np.testing.assert_array_equal(point.positions, trajectory.position[i])
        np.testing.assert_array_equal(point.velocities, trajectory.velocity[i])
        np.testing.assert_array_equal(point.accelerations, trajectory.acceleration[i])
        when = point.time_from_start
        assert when.sec * 1_000_000_000 + when.nanosec == trajectory.time[i]
    assert len(states) == len(swing.time)
    assert states[3].schema.name == "sensor_msgs/msg/JointState"
    assert list(states[3].ros_msg.name) == ["knee", "it's"]
    np.testing.assert_array_equal(states[3].ros_msg.position, swing.qpos[3, 7:])
    np.testing.assert_array_equal(states[3].ros_msg.effort, [6.0, 7.0])
    assert states[0].log_time_ns == trajectory.time[0]


def test_the_message_is_cdr_as_ros_lays_it_out(swing: Motion, tmp_path: Path) -> None:
    """By hand, from the CDR rules: little endian, each number at a multiple of its size."""
    mcap = pytest.importorskip("mcap.reader")
    trajectory = JointTrajectory.of(swing, joints=("knee",))
    path = write_mcap(trajectory, tmp_path / "t.mcap")
    with path.open("rb") as file:
        found = mcap.make_reader(file)
        assert found.get_header().profile == "ros2"
        (_, _, message), = found.iter_messages()  # fmt: skip
    data = message.data
    assert data[:4] == b"\x00\x01\x00\x00"
    body = data[4:]
    assert struct.unpack_from("<iI", body, 0) == (0, 0)
    assert struct.unpack_from("<I", body, 8) == (1,)  # frame_id, "" with its zero byte
    assert struct.unpack_from("<I", body, 16) == (1,)  # one name
    assert body[20:29] == struct.pack("<I", 5) + b"knee\x00"
    assert struct.unpack_from("<I", body, 32) == (len(trajectory.time),)
    assert struct.unpack_from("<I", body, 36) == (1,)  # positions of the first point
    assert struct.unpack_from("<d", body, 40) == (trajectory.position[0, 0],)


def test_without_the_extra_one_line_says_what_to_install(
    swing: Motion, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    import sys

    monkeypatch.setitem(sys.modules, "mcap_ros2.writer", None)
    with pytest.raises(EnpointeError, match=r"enpointe\[ros\]"):
        write_mcap(JointTrajectory.of(swing), tmp_path / "t.mcap")
    assert not list(tmp_path.iterdir())
