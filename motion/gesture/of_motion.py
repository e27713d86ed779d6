"""A dancer's motion as a gesture scene: positions and forces, each at its own rate."""

from __future__ import annotations

import mujoco
import numpy as np
from numpy.typing import NDArray

from enpointe.errors import MotionError
from enpointe.motion.gesture.scene import Channel, Dimension, Scene, Unit, Variable
from enpointe.motion.motion import Motion

__all__ = ["scene_of_motion"]

Array = NDArray[np.float64]


def scene_of_motion(
    motion: Motion, *, position_rate: float = 100.0, force_rate: float = 1000.0
) -> Scene:
    """What a haptic device or a simulator takes of a dance.

    Two units, as the document asks for extensive and intensive variables together where energy is
    exchanged (ENACTIVE D.RD3.3.1 §4.3.3), with the rates that it gives for what is seen and for
    what is touched (§4.3.2):

    - "dancer": where the root is ("root", 3Dxyz, m), how it is turned ("root turn", 3Dxyz, rad: the
      rotation vector, of half a turn at most) and how every hinge is bent (0D, rad).
    - "floor": the centre of mass (3Dxyz, m) and the force that the floor must give for the body to
      move so, F = m (a_com - g) (3Dxyz, N): all contacts together, from the inverse dynamics of the
      motion and not from a simulated contact. Where a motion is impossible it pulls.

    Args:
        motion: Of a body with a free root.
        position_rate: Of "dancer", frames per second.
        force_rate: Of "floor".

    Returns:
        The scene, called by the motion's name. Between the motion's samples values are linear.

    Raises:
        MotionError: A body without a free root, or with joints other than hinges; a rate that is
            none.
    """
    root, hinges = _joints(motion.model)
    channels = [
        Channel("root", Variable.POSITION, Dimension.XYZ, "m"),
        Channel("root turn", Variable.ANGLE, Dimension.XYZ, "rad"),
    ]
    channels += [
        Channel(motion.model.joint(hinge).name, Variable.ANGLE, Dimension.SCALAR, "rad")
        for hinge in hinges
    ]
    dancer = Unit("dancer", tuple(channels), position_rate)
    weight = Channel("centre of mass", Variable.POSITION, Dimension.XYZ, "m")
    force = Channel("ground reaction", Variable.FORCE, Dimension.XYZ, "N")
    floor = Unit("floor", (weight, force), force_rate)
    signals = _postures(motion, root, hinges, position_rate), _floor(motion, root, force_rate)
    return Scene(motion.name, (dancer, floor), signals)


def _joints(model: mujoco.MjModel) -> tuple[int, list[int]]:
    kinds = model.jnt_type.tolist()
    free, hinge = mujoco.mjtJoint.mjJNT_FREE, mujoco.mjtJoint.mjJNT_HINGE
    roots = [index for index, kind in enumerate(kinds) if kind == free]
    hinges = [index for index, kind in enumerate(kinds) if kind == hinge]
    if len(roots) != 1 or len(roots) + len(hinges) != len(kinds):
        raise MotionError("only a body with one free root and hinges makes a gesture scene")
    return roots[0], hinges


def _times(motion: Motion, rate: float) -> Array:
    if not np.isfinite(rate) or rate <= 0:
        raise MotionError(f"a rate must be above 0, got {rate}")
    return np.arange(int(motion.duration * rate * (1 + 1e-12)) + 1) / rate


def _postures(motion: Motion, root: int, hinges: list[int], rate: float) -> Array:
    """Root, its turn and the hinges, (T, 6 + hinges)."""
    first = int(motion.model.jnt_qposadr[root])
    bends = [int(motion.model.jnt_qposadr[hinge]) for hinge in hinges]
    times = _times(motion, rate)
    rows = np.empty((len(times), 6 + len(bends)))
    for row, t in zip(rows, times, strict=True):
        qpos, _, _ = motion.sample(t)
        row[:3], row[6:] = qpos[first : first + 3], qpos[bends]
        mujoco.mju_quat2Vel(row[3:6], qpos[first + 3 : first + 7], 1.0)
    return rows


def _floor(motion: Motion, root: int, rate: float) -> Array:
    """Centre of mass and ground reaction, (T, 6).

    The first three forces of the recursive Newton-Euler algorithm without contacts, at a free root,
    are what the world must add to gravity to move the whole body so.
    """
    model, data = motion.model, mujoco.MjData(motion.model)
    body, dof = int(model.jnt_bodyid[root]), int(model.jnt_dofadr[root])
    forces = np.empty(model.nv)
    times = _times(motion, rate)
    rows = np.empty((len(times), 6))
    for row, t in zip(rows, times, strict=True):
        data.qpos, data.qvel, data.qacc = motion.sample(t)
        mujoco.mj_fwdPosition(model, data)
        mujoco.mj_fwdVelocity(model, data)
        mujoco.mj_rne(model, data, 1, forces)
        row[:3], row[3:] = data.subtree_com[body], forces[dof : dof + 3]
    return rows
