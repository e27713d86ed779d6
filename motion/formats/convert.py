"""The same movement as another kind of skeleton: with plain channels, or with no hierarchy."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from enpointe.motion.formats.skeleton import IDENTITY, Joint, Skeleton, SkeletonMotion
from enpointe.motion.formats.space import DEGREES, Space

__all__ = ["angles_of", "depth_first", "flat", "is_flat", "plain", "upright", "y_up"]

Array = NDArray[np.float64]
_POSITIONS = ("Xposition", "Yposition", "Zposition")


def plain(motion: SkeletonMotion) -> tuple[SkeletonMotion, tuple[str, ...]]:
    """A movement as BVH can say it, every joint at the same place in the world.

    Joints come depth first, y is up, angles are degrees; a joint's channels are its whole rotation
    and stand in the order in which they are multiplied; frames at rest are the world's, so that
    all angles 0 give the file's rest pose; position channels replace the offset. Joints whose
    channels are so already keep their numbers.

    Returns:
        The movement, and what of it falls, one line each.
    """
    motion = depth_first(motion)
    skeleton = motion.skeleton
    turned = y_up(skeleton.space)
    rests = _rests(skeleton)
    translations, rotations = motion.local()
    joints, columns = [], []
    for index, joint in enumerate(skeleton.joints):
        above = turned * (rests[joint.parent] if joint.parent >= 0 else Rotation.identity())
        frame = turned * rests[index]
        moved = translations[:, index] if _positions(joint) else None
        channels, values = _places(joint, moved, above, motion, index)
        order, angles = _angles(joint, rotations[:, index], above, frame, motion, index)
        ends = tuple(_vector(_turn(frame, np.array(end))) for end in joint.ends)
        offset = _vector(_turn(above, np.array(joint.offset)))
        names = (*channels, *(f"{axis}rotation" for axis in order))
        joints.append(Joint(joint.name, joint.parent, offset, names, ends=ends))
        columns += [values, angles]
    space = Space(skeleton.space.metres_per_unit)
    whole = Skeleton(tuple(joints), space)
    lost = _fallen(skeleton, turned, rests)
    return replace(motion, skeleton=whole, values=np.concatenate(columns, axis=1)), lost


def flat(motion: SkeletonMotion, order: str = "ZXY") -> SkeletonMotion:
    """A movement in which every joint says by itself where in the world it is.

    Args:
        motion: Any movement.
        order: Order of the angles, the first outermost.

    Returns:
        Joints without parents, with three position and three rotation channels, X Y Z each.
    """
    if is_flat(motion.skeleton, order):
        return motion
    places, rotations = motion.world()
    channels = (*_POSITIONS, *(f"{axis}rotation" for axis in "XYZ"))
    joints, columns = [], []
    for index, joint in enumerate(motion.skeleton.joints):
        angles = angles_of(Rotation.from_quat(rotations[:, index], scalar_first=True), order)
        angles = angles[:, [order.index(axis) for axis in "XYZ"]]
        angles /= motion.skeleton.space.radians_per_unit
        columns += [places[:, index], angles]
        joints.append(Joint(joint.name, -1, channels=channels, order=order, ends=joint.ends))
    skeleton = Skeleton(tuple(joints), motion.skeleton.space)
    return replace(motion, skeleton=skeleton, values=np.concatenate(columns, axis=1))


def upright(motion: SkeletonMotion) -> tuple[SkeletonMotion, tuple[str, ...]]:
    """A flat movement with y up, and what of it falls."""
    skeleton = motion.skeleton
    turned = y_up(skeleton.space)
    if _is_none(turned):
        return motion, ()
    unit = skeleton.space.radians_per_unit
    columns = []
    _, rotations = motion.local()
    for index, joint in enumerate(skeleton.joints):
        own = motion.values[:, skeleton.columns(index)].copy()
        own[:, :3] = turned.apply(own[:, :3])
        turns = turned * Rotation.from_quat(rotations[:, index], scalar_first=True) * turned.inv()
        angles = angles_of(turns, joint.product)[:, [joint.product.index(axis) for axis in "XYZ"]]
        own[:, 3:6] = angles / unit
        columns.append(own)
    space = Space(skeleton.space.metres_per_unit, radians_per_unit=unit)
    lost = (f"{skeleton.space.up} as the upward axis (it is y now)",)
    turned_skeleton = replace(skeleton, space=space)
    values = np.concatenate(columns, axis=1)
    return replace(motion, skeleton=turned_skeleton, values=values), lost


def is_flat(skeleton: Skeleton, order: str) -> bool:
    """Whether every joint stands in the world by itself, with angles in that order."""
    return skeleton.positions_replace_offset and all(
        joint.parent < 0
        and joint.channels[:3] == _POSITIONS
        and joint.channels[3:6] == tuple(f"{axis}rotation" for axis in "XYZ")
        and joint.product == order
        and joint.axis == IDENTITY == joint.rest
        for joint in skeleton.joints
    )


def depth_first(motion: SkeletonMotion) -> SkeletonMotion:
    """The same movement with each joint's descendants right behind it."""
    skeleton = motion.skeleton
    waiting = [i for i, joint in enumerate(skeleton.joints) if joint.parent < 0][::-1]
    order: list[int] = []
    while waiting:
        order.append(waiting.pop())
        waiting += skeleton.children[order[-1]][::-1]
    if order == sorted(order):
        return motion
    new = {old: index for index, old in enumerate(order)} | {-1: -1}
    joints = tuple(
        replace(skeleton.joints[old], parent=new[skeleton.joints[old].parent]) for old in order
    )
    columns = [np.arange(motion.values.shape[1])[skeleton.columns(old)] for old in order]
    return replace(
        motion,
        skeleton=replace(skeleton, joints=joints),
        values=motion.values[:, np.concatenate(columns)],
    )


def y_up(space: Space) -> Rotation:
    """The turn from a file's axes to those with y up that face the same way."""
    return Rotation.from_matrix(Space(up="y").to_ours.T @ space.to_ours)


def _rests(skeleton: Skeleton) -> list[Rotation]:
    """Each joint's frame at rest, in the file's world."""
    rests: list[Rotation] = []
    for joint in skeleton.joints:
        own = Rotation.from_quat(joint.rest, scalar_first=True)
        rests.append(rests[joint.parent] * own if joint.parent >= 0 else own)
    return rests


def _places(
    joint: Joint, moved: Array | None, above: Rotation, motion: SkeletonMotion, index: int
) -> tuple[tuple[str, ...], Array]:
    if moved is None:
        return (), np.empty((motion.frames, 0))
    names = _positions(joint)
    kept = motion.skeleton.positions_replace_offset or joint.offset == (0.0, 0.0, 0.0)
    if kept and _is_none(above):
        own = motion.values[:, motion.skeleton.columns(index)]
        return names, own[:, [joint.channels.index(name) for name in names]]
    return _POSITIONS, _turn(above, moved)


def _angles(
    joint: Joint,
    local: Array,
    above: Rotation,
    frame: Rotation,
    motion: SkeletonMotion,
    index: int,
) -> tuple[str, Array]:
    unit = motion.skeleton.space.radians_per_unit
    if joint.axis == IDENTITY and _is_none(above) and _is_none(frame):
        own = motion.values[:, motion.skeleton.columns(index)]
        wanted = [joint.channels.index(f"{axis}rotation") for axis in joint.product]
        kept = own[:, wanted]
        return joint.product, kept if unit == DEGREES else np.degrees(kept * unit)
    turns = above * Rotation.from_quat(local, scalar_first=True) * frame.inv()
    if not joint.turning and np.allclose(turns.magnitude(), 0, atol=1e-15):
        return "", np.empty((motion.frames, 0))
    order = joint.product if len(set(joint.product)) == 3 else "ZXY"
    return order, np.degrees(angles_of(turns, order))


def angles_of(turns: Rotation, order: str) -> Array:
    """(T, 3) angles, rad, of R = R_first @ R_second @ R_third, without a break at the pole."""
    i, j, k = ("XYZ".index(axis) for axis in order)
    sign = 1.0 if (j - i) % 3 == 1 else -1.0
    matrix = turns.as_matrix().reshape(-1, 3, 3)
    cosine = np.hypot(matrix[:, i, i], matrix[:, i, j])
    middle = np.arctan2(sign * matrix[:, i, k], cosine)
    first = np.arctan2(-sign * matrix[:, j, k], matrix[:, k, k])
    # What is left after the first turn is the third's, also where the pole joins the two.
    c, s = np.cos(first), np.sin(first)
    third = np.arctan2(
        c * sign * matrix[:, j, i] + s * matrix[:, k, i],
        c * matrix[:, j, j] + s * sign * matrix[:, k, j],
    )
    angles: Array = np.stack([first, middle, third], axis=1)
    return angles


def _fallen(skeleton: Skeleton, turned: Rotation, rests: list[Rotation]) -> tuple[str, ...]:
    lost = []
    if any(joint.limits for joint in skeleton.joints):
        lost.append("the joints' limits")
    if any(c.endswith("scale") for joint in skeleton.joints for c in joint.channels):
        lost.append("the joints' scales")
    if any(joint.axis != IDENTITY for joint in skeleton.joints):
        lost.append("the axes in which the joints' channels turn (their rotations are kept)")
    if not all(_is_none(rest) for rest in rests):
        lost.append("the joints' frames at rest (the world's axes are theirs now)")
    if not _is_none(turned):
        lost.append(f"{skeleton.space.up} as the upward axis (it is y now)")
    return tuple(lost)


def _positions(joint: Joint) -> tuple[str, ...]:
    return tuple(channel for channel in joint.channels if channel.endswith("position"))


def _is_none(turn: Rotation) -> bool:
    return bool(np.array_equal(turn.as_matrix(), np.eye(3)))


def _turn(turn: Rotation, vectors: Array) -> Array:
    turned: Array = vectors if _is_none(turn) else turn.apply(vectors)
    return turned


def _vector(vector: Array) -> tuple[float, float, float]:
    return float(vector[0]), float(vector[1]), float(vector[2])
