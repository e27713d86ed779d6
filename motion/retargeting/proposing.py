"""A map for a file that nobody has mapped."""

from __future__ import annotations

from enpointe.errors import MotionError
from enpointe.motion.formats.content import Content, Payload
from enpointe.motion.formats.markers import MarkerMotion
from enpointe.motion.formats.skeleton import SkeletonMotion
from enpointe.motion.retargeting.joint_map import END, JointMap
from enpointe.motion.retargeting.naming import map_markers_by_names, map_skeleton_by_names
from enpointe.motion.retargeting.structure import map_skeleton_by_structure

__all__ = ["point_names", "propose_map"]


def propose_map(content: Content | Payload) -> JointMap:
    """Which points of a movement are which landmarks: by names, and by structure where they fail.

    Args:
        content: What `enpointe.motion.formats.read` gave.

    Returns:
        A map, perhaps with landmarks missing (`JointMap.missing`): save it, mend it, load it.

    Raises:
        MotionError: A gesture scene, which has no body.
    """
    motion = content.motion if isinstance(content, Content) else content
    if isinstance(motion, MarkerMotion):
        return map_markers_by_names(motion.names)
    if not isinstance(motion, SkeletonMotion):
        raise MotionError("a gesture scene has no skeleton and no markers to map")
    named = map_skeleton_by_names(motion.skeleton)
    if not named.missing:
        return named
    world = motion.skeleton.space.points(motion.world()[0])
    built = map_skeleton_by_structure(motion.skeleton, world)
    return named if len(built.missing) >= len(named.missing) else built


def point_names(motion: Payload) -> tuple[str, ...]:
    """Every point that a map may name.

    Raises:
        MotionError: A gesture scene, which has no body.
    """
    if isinstance(motion, MarkerMotion):
        return motion.names
    if not isinstance(motion, SkeletonMotion):
        raise MotionError("a gesture scene has no skeleton and no markers to retarget")
    joints = motion.skeleton.joints
    return (*motion.skeleton.names, *(joint.name + END for joint in joints if joint.ends))
