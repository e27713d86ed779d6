"""The dancer's motion as a skeleton's, for the files of animators."""

from __future__ import annotations

import mujoco
import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from enpointe.errors import MotionError
from enpointe.motion.formats.bodies import relative
from enpointe.motion.formats.convert import angles_of
from enpointe.motion.formats.shapes import surfaces
from enpointe.motion.formats.skeleton import Joint, Skeleton, SkeletonMotion
from enpointe.motion.formats.space import Space
from enpointe.motion.formats.winding import unwound
from enpointe.motion.motion import Motion

__all__ = ["ORDER", "even_rate", "skeleton_of_motion"]

Array = NDArray[np.float64]

ORDER = "ZXY"
"""Of all joints alike, as most BVH files have it and some readers take for granted."""

_POSITIONS = tuple(f"{axis}position" for axis in "XYZ")
_ROTATIONS = tuple(f"{axis}rotation" for axis in ORDER)
_STILL = 1e-9
_EVEN = 1e-6


def skeleton_of_motion(motion: Motion) -> tuple[SkeletonMotion, tuple[str, ...]]:
    """Bodies as joints, in metres, y up, facing z.

    All hinges between two bodies are one joint with three angles in degrees, which go on over half
    a turn; a body that moves in its parent has positions as well. With all angles 0 the figure
    stands as its model does. A body without children gets an end site at the far end of its shape.

    Args:
        motion: Of any body, its samples evenly spaced in time.

    Returns:
        The skeleton's movement, and what of the motion it does not hold, one line each.

    Raises:
        MotionError: Samples that are not evenly spaced.
    """
    rate = even_rate(motion)
    if rate is None:
        raise MotionError(f"{motion.name}: samples are not evenly spaced; give a rate")
    model = motion.model
    upright = Rotation.from_matrix(Space().to_ours.T)
    translations, rotations = relative(motion)
    parents = np.asarray(model.body_parentid)
    joints, columns = [], []
    for body in range(1, model.nbody):
        places = upright.apply(translations[:, body])
        turns = upright * Rotation.from_quat(rotations[:, body]) * upright.inv()
        moves = parents[body] == 0 or np.ptp(places, axis=0).max() > _STILL
        if moves:
            columns.append(places)
        columns.append(np.degrees(unwound(angles_of(turns, ORDER))))
        joints.append(
            Joint(
                model.body(body).name or f"body {body}",
                int(parents[body]) - 1,
                _vector(upright.apply(model.body_pos[body])),
                _POSITIONS + _ROTATIONS if moves else _ROTATIONS,
                ends=() if body in parents else _ends(model, body, upright),
            )
        )
    skeleton = Skeleton(tuple(joints), Space(1.0))
    whole = SkeletonMotion(skeleton, rate, np.concatenate(columns, axis=1))
    lost = ["each hinge by itself (their joints' rotations are kept)", "velocities, accelerations"]
    if motion.events:
        lost.append(f"{len(motion.events)} events (key poses, contacts)")
    return whole, (*lost, "masses and shapes of the body")


def even_rate(motion: Motion) -> float | None:
    """Samples a second, a whole number where they nearly are one; None if they come unevenly."""
    steps = np.diff(motion.time)
    rate = len(steps) / motion.duration
    if np.abs(steps * rate - 1).max() > _EVEN:
        return None
    return float(round(rate)) if abs(rate / max(round(rate), 1) - 1) < _EVEN else rate


def _ends(
    model: mujoco.MjModel, body: int, upright: Rotation
) -> tuple[tuple[float, float, float], ...]:
    """The far end of a body's shape, on the line from its joint through its middle."""
    points = [surface.points for surface in surfaces(model, body, hidden=True)]
    if not points:
        return ()
    cloud = np.concatenate(points)
    middle = cloud.mean(axis=0)
    length = float(np.linalg.norm(middle))
    if length < _STILL:
        return ()
    along = middle / length
    return (_vector(upright.apply(along * (cloud @ along).max())),)


def _vector(values: Array) -> tuple[float, float, float]:
    x, y, z = (float(value) for value in np.round(values, 12) + 0.0)
    return x, y, z
