"""A skeleton's joints as markers, and a movement in another unit of length."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from enpointe.motion.formats.markers import MarkerMotion
from enpointe.motion.formats.skeleton import Joint, SkeletonMotion

__all__ = ["in_unit", "markers_of_skeleton"]


def markers_of_skeleton(motion: SkeletonMotion) -> tuple[MarkerMotion, tuple[str, ...]]:
    """A marker at each joint and at each end of a bone, where these are in the file's world.

    Returns:
        The markers, and what of the movement they do not hold, one line each.
    """
    places, turns = motion.world()
    names, columns = list(motion.skeleton.names), [*np.moveaxis(places, 1, 0)]
    for index, joint in enumerate(motion.skeleton.joints):
        for number, end in enumerate(joint.ends):
            tip = "end" if len(joint.ends) == 1 else f"end {number + 1}"
            names.append(f"{joint.name} {tip}")
            columns.append(places[:, index] + _turned(turns[:, index], np.array(end)))
    markers = MarkerMotion(
        tuple(names),
        motion.rate,
        np.stack(columns, axis=1),
        motion.skeleton.space,
        start=max(motion.start, 1),
    )
    lost = ["the hierarchy and the rotations of the joints (their places are kept)"]
    if motion.notes:
        lost.append(f"{len(motion.notes)} notes")
    return markers, tuple(lost)


def in_unit(
    movement: SkeletonMotion | MarkerMotion, metres: float
) -> tuple[SkeletonMotion | MarkerMotion, tuple[str, ...]]:
    """The same movement with all lengths in another unit, and what falls.

    Args:
        movement: A skeleton's or a marker set's.
        metres: Of the unit.
    """
    if isinstance(movement, MarkerMotion):
        factor = movement.space.metres_per_unit / metres
        if factor == 1.0:
            return movement, ()
        space = replace(movement.space, metres_per_unit=metres)
        residuals = None if movement.residuals is None else movement.residuals * factor
        points = movement.positions * factor
        return replace(movement, space=space, positions=points, residuals=residuals), ()
    skeleton = movement.skeleton
    factor = skeleton.space.metres_per_unit / metres
    if factor == 1.0:
        return movement, ()
    lengths = [c.endswith("position") for joint in skeleton.joints for c in joint.channels]
    scaled = replace(
        skeleton,
        joints=tuple(_scaled(joint, factor) for joint in skeleton.joints),
        space=replace(skeleton.space, metres_per_unit=metres),
    )
    values = np.where(lengths, movement.values * factor, movement.values)
    # Notes with lengths, in words only their format knows, would be of the old unit.
    notes = {key: note for key, note in movement.notes.items() if not key.startswith("bone ")}
    scales = any(c.endswith("scale") for joint in skeleton.joints for c in joint.channels)
    lost = ("scales of joints are not converted: they stay as they are",) if scales else ()
    return replace(movement, skeleton=scaled, values=values, notes=notes), lost


def _scaled(joint: Joint, factor: float) -> Joint:
    limits = tuple(
        (low * factor, high * factor) if channel.endswith("position") else (low, high)
        for channel, (low, high) in zip(joint.channels, joint.limits, strict=False)
    )
    ends = tuple(_times(end, factor) for end in joint.ends)
    return replace(joint, offset=_times(joint.offset, factor), ends=ends, limits=limits)


def _times(vector: tuple[float, float, float], factor: float) -> tuple[float, float, float]:
    x, y, z = vector
    return x * factor, y * factor, z * factor


def _turned(turns: NDArray[np.float64], vector: NDArray[np.float64]) -> NDArray[np.float64]:
    turned: NDArray[np.float64] = Rotation.from_quat(turns, scalar_first=True).apply(vector)
    return turned
