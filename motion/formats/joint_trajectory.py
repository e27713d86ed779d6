"""Motions for ROS 2: the message trajectory_msgs/msg/JointTrajectory, as YAML and in MCAP.

Layout: ros2/common_interfaces, trajectory_msgs/msg/JointTrajectory(Point).msg and
sensor_msgs/msg/JointState.msg; std_msgs/msg/Header and builtin_interfaces/msg/Time, Duration with
int32 sec and uint32 nanosec. What a joint_trajectory_controller asks besides: times that increase,
and a last point at rest (control.ros.org, allow_nonzero_velocity_at_trajectory_end).

The YAML is what `ros2 topic pub --once TOPIC trajectory_msgs/msg/JointTrajectory "$(cat FILE)"`
takes. The MCAP file has the profile ros2, schemas as ros2msg and messages as CDR (mcap.dev/spec),
and so is a bag for `ros2 bag play`.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Protocol

import mujoco
import numpy as np
from numpy.typing import NDArray

from enpointe.errors import EnpointeError, MotionError
from enpointe.files import atomic_path, write_text
from enpointe.motion.motion import Motion

__all__ = ["APPROACH", "JointTrajectory", "Performed", "write_mcap", "write_yaml"]

Array = NDArray[np.float64]
APPROACH = 2.0
"""s that a robot is given to come to the first pose."""
_RATE = 50.0
_NANO = 1_000_000_000
TOPIC = "/joint_trajectory_controller/joint_trajectory"
STATES = "/joint_states"
_RULE = "=" * 80
_HEADER = f"""{_RULE}
MSG: std_msgs/Header
builtin_interfaces/Time stamp
string frame_id
{_RULE}
MSG: builtin_interfaces/Time
int32 sec
uint32 nanosec
"""
_TRAJECTORY = f"""std_msgs/Header header
string[] joint_names
trajectory_msgs/JointTrajectoryPoint[] points
{_HEADER}{_RULE}
MSG: trajectory_msgs/JointTrajectoryPoint
float64[] positions
float64[] velocities
float64[] accelerations
float64[] effort
builtin_interfaces/Duration time_from_start
{_RULE}
MSG: builtin_interfaces/Duration
int32 sec
uint32 nanosec
"""
_STATE = f"""std_msgs/Header header
string[] name
float64[] position
float64[] velocity
float64[] effort
{_HEADER}"""


@dataclass(frozen=True)
class JointTrajectory:
    """Points of J joints.

    Attributes:
        joints: Their names.
        time: (N,), ns from the start of the trajectory, increasing.
        position: (N, J), rad.
        velocity: (N, J), rad/s; none at the last point.
        acceleration: (N, J), rad/s^2; none at the last point.
    """

    joints: tuple[str, ...]
    time: NDArray[np.int64]
    position: Array
    velocity: Array
    acceleration: Array

    @classmethod
    def of(
        cls,
        motion: Motion,
        *,
        joints: Sequence[str] | None = None,
        rate: float = _RATE,
        approach: float = APPROACH,
    ) -> JointTrajectory:
        """The hinges of a motion; its root is left out, since nobody commands it.

        Args:
            motion: What is to be danced.
            joints: Names of hinges, in the order wanted; all of the model's if None.
            rate: Points a second; the last moment is one whatever the rate.
            approach: s until the first point.

        Raises:
            MotionError: A name that is no hinge of the model, a rate or an approach of 0 or less.
        """
        if not (rate > 0.0 and approach > 0.0):
            raise MotionError("points come at a rate above 0, the first of them after a time")
        model = motion.model
        hinges = {
            model.joint(int(j)).name: int(j)
            for j in np.flatnonzero(model.jnt_type == mujoco.mjtJoint.mjJNT_HINGE)
        }
        names = tuple(hinges) if joints is None else tuple(joints)
        if missing := [name for name in names if name not in hinges]:
            raise MotionError(f"the motion has no joint {', '.join(missing)}")
        chosen = [hinges[name] for name in names]
        angles, dofs = model.jnt_qposadr[chosen], model.jnt_dofadr[chosen]
        moments = np.arange(0.0, motion.duration - 0.5 / rate, 1.0 / rate)
        points = [motion.sample(float(t)) for t in moments]
        position, velocity, acceleration = (
            np.array([point[part][chosen_] for point in points])
            for part, chosen_ in ((0, angles), (1, dofs), (2, dofs))
        )
        rest = np.zeros((1, len(names)))
        time = np.append(moments, motion.duration) + approach
        return cls(
            names,
            np.round(time * _NANO).astype(np.int64),
            np.vstack([position, motion.qpos[-1:, angles]]),
            np.vstack([velocity, rest]),
            np.vstack([acceleration, rest]),
        )


class Performed(Protocol):
    """What a body did, as a `Recording` has it: N samples of the model's joints and nu motors."""

    @property
    def model(self) -> mujoco.MjModel:
        """The body."""

    @property
    def time(self) -> Array:
        """(N,), s."""

    @property
    def qpos(self) -> Array:
        """(N, nq)."""

    @property
    def qvel(self) -> Array:
        """(N, nv)."""

    @property
    def effort(self) -> Array:
        """(N, nu), N m."""


def write_yaml(trajectory: JointTrajectory, path: Path) -> Path:
    """Write the message as YAML.

    Raises:
        EnpointeError: It can't be written there.
    """
    lines = [
        "header:",
        "  stamp: {sec: 0, nanosec: 0}",
        "  frame_id: ''",
        f"joint_names: [{', '.join(_quoted(name) for name in trajectory.joints)}]",
        "points:",
    ]
    for point in _points(trajectory):
        first, *rest = (
            f"{name}: [{', '.join(f'{value:.9f}' for value in point[name])}]"
            for name in ("positions", "velocities", "accelerations", "effort")
        )
        when = point["time_from_start"]
        lines += [f"- {first}", *(f"  {line}" for line in rest)]
        lines.append(f"  time_from_start: {{sec: {when['sec']}, nanosec: {when['nanosec']}}}")
    return write_text(path, "\n".join(lines) + "\n")


def write_mcap(trajectory: JointTrajectory, path: Path, recording: Performed | None = None) -> Path:
    """Write the message, and what servos did of it if given, as a bag.

    Args:
        trajectory: On `/joint_trajectory_controller/joint_trajectory`, at time 0.
        path: Where to.
        recording: Of a performance, on `/joint_states`: positions, velocities and torques of the
            joints of the trajectory that it has, from the moment of the first point.

    Raises:
        EnpointeError: It can't be written there, or the extra `ros` is not installed.
    """
    try:
        from mcap_ros2.writer import Writer
    except ImportError:
        raise EnpointeError(
            "MCAP needs a package more: pip install 'enpointe[ros]'; YAML needs none"
        ) from None
    with atomic_path(path) as beside, beside.open("wb") as file:
        writer = Writer(file)
        schema = writer.register_msgdef("trajectory_msgs/msg/JointTrajectory", _TRAJECTORY)
        message = {
            "header": _header(0),
            "joint_names": list(trajectory.joints),
            "points": list(_points(trajectory)),
        }
        writer.write_message(TOPIC, schema, message, 0, 0)
        if recording is not None:
            schema = writer.register_msgdef("sensor_msgs/msg/JointState", _STATE)
            for moment, state in _states(recording, trajectory):
                writer.write_message(STATES, schema, state, moment, moment)
        writer.finish()  # type: ignore[no-untyped-call]
    return path


def _points(trajectory: JointTrajectory) -> Iterator[dict[str, Any]]:
    for i, moment in enumerate(trajectory.time.tolist()):
        yield {
            "positions": trajectory.position[i].tolist(),
            "velocities": trajectory.velocity[i].tolist(),
            "accelerations": trajectory.acceleration[i].tolist(),
            "effort": [],
            "time_from_start": _time(moment),
        }


def _states(
    recording: Performed, trajectory: JointTrajectory
) -> Iterator[tuple[int, dict[str, Any]]]:
    model, start = recording.model, int(trajectory.time[0])
    motors = [model.actuator_trnid[i, 0] for i in range(model.nu)]
    names = [model.joint(int(joint)).name for joint in motors]
    rows = [i for i, name in enumerate(names) if name in trajectory.joints]
    joints = np.array(motors)[rows]
    angles, dofs = model.jnt_qposadr[joints], model.jnt_dofadr[joints]
    for i, t in enumerate((recording.time - recording.time[0]).tolist()):
        moment = start + round(t * _NANO)
        yield (
            moment,
            {
                "header": _header(moment),
                "name": [names[row] for row in rows],
                "position": recording.qpos[i, angles].tolist(),
                "velocity": recording.qvel[i, dofs].tolist(),
                "effort": recording.effort[i, rows].tolist(),
            },
        )


def _header(moment: int) -> dict[str, Any]:
    return {"stamp": _time(moment), "frame_id": ""}


def _time(moment: int) -> dict[str, int]:
    return {"sec": moment // _NANO, "nanosec": moment % _NANO}


def _quoted(name: str) -> str:
    return "'" + name.replace("'", "''") + "'"
