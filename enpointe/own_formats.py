"""Formats that hold a motion of ours whole, the shapes that it moves, or its joints for ROS 2."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from enpointe.motion import Motion
    from enpointe.motion.formats.fitting import Movement
    from enpointe.motion.formats.joint_trajectory import JointTrajectory

__all__ = ["OF_ANY_BODY", "OWN_ENDINGS", "own_writers"]

OWN_ENDINGS = {
    ".npz": "npz",
    ".gltf": "gltf",
    ".glb": "gltf",
    ".xml": "keyframes",
    ".yaml": "ros2",
    ".yml": "ros2",
    ".mcap": "mcap",
}
"""Of each ending, its format."""
OF_ANY_BODY = frozenset({"npz", "keyframes", "ros2", "mcap"})
"""Those that hold a puppet's motion as well as the dancer's."""
_ROOT_LOST = "the root: a JointTrajectory commands hinges alone"
_USUAL_RATE = 50.0


def own_writers() -> dict[str, Callable[[Movement, Path], tuple[str, ...]]]:
    """By name, what writes a motion and says what was lost."""
    from enpointe.motion.formats.gltf import write_gltf
    from enpointe.motion.formats.mjcf import write_keyframes
    from enpointe.motion.npz import save_motion

    writers = {
        "npz": save_motion,
        "gltf": write_gltf,
        "keyframes": write_keyframes,
        "ros2": _write_yaml,
        "mcap": _write_mcap,
    }
    return {name: _of_motion(write) for name, write in writers.items()}


def _of_motion(
    write: Callable[[Motion, Path], tuple[str, ...] | None],
) -> Callable[[Movement, Path], tuple[str, ...]]:
    def checked(movement: Movement, path: Path) -> tuple[str, ...]:
        from enpointe.motion import Motion

        assert isinstance(movement, Motion)
        return write(movement, path) or ()

    return checked


def _write_yaml(motion: Motion, path: Path) -> tuple[str, ...]:
    from enpointe.motion.formats.joint_trajectory import write_yaml

    write_yaml(_trajectory(motion), path)
    return (_ROOT_LOST,)


def _write_mcap(motion: Motion, path: Path) -> tuple[str, ...]:
    from enpointe.motion.formats.joint_trajectory import write_mcap

    write_mcap(_trajectory(motion), path)
    return (_ROOT_LOST,)


def _trajectory(motion: Motion) -> JointTrajectory:
    from enpointe.motion.formats.joint_trajectory import JointTrajectory
    from enpointe.motion.formats.of_dancer import even_rate

    return JointTrajectory.of(motion, rate=even_rate(motion) or _USUAL_RATE)
