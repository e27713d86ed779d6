"""Any movement as the kind that a format holds, where there is an honest way."""

from __future__ import annotations

from collections.abc import Collection
from typing import Literal

from enpointe.errors import MotionError
from enpointe.motion.formats.as_markers import markers_of_skeleton
from enpointe.motion.formats.content import Kind, Payload
from enpointe.motion.formats.markers import MarkerMotion
from enpointe.motion.formats.of_dancer import even_rate, skeleton_of_motion
from enpointe.motion.formats.scenes import markers_of_scene
from enpointe.motion.formats.skeleton import SkeletonMotion
from enpointe.motion.gesture.of_motion import scene_of_motion
from enpointe.motion.gesture.scene import Scene
from enpointe.motion.motion import Motion

__all__ = ["AnyKind", "Movement", "fitted", "kind_of"]

Movement = Motion | Payload
AnyKind = Literal["dancer"] | Kind

_WORDS: dict[AnyKind, str] = {
    "dancer": "the dancer's motion",
    "skeleton": "a skeleton's movement",
    "markers": "a set of markers",
    "scene": "a gesture scene",
}


def kind_of(movement: Movement) -> AnyKind:
    """What a movement is of."""
    if isinstance(movement, Motion):
        return "dancer"
    if isinstance(movement, SkeletonMotion):
        return "skeleton"
    return "markers" if isinstance(movement, MarkerMotion) else "scene"


def fitted(movement: Movement, kinds: Collection[AnyKind]) -> tuple[Movement, tuple[str, ...]]:
    """The movement as the first of these kinds that it can be, nearest to what it is.

    Markers become no skeleton and neither becomes the dancer's motion: that takes a body that moves
    so, and is retargeting. A skeleton becomes a scene, and so do markers, in the writers of scenes.

    Args:
        movement: What there is.
        kinds: What the formats in question hold.

    Returns:
        The movement, and what of it falls, one line each.

    Raises:
        MotionError: There is no way to any of them.
    """
    own = kind_of(movement)
    if own in kinds or (isinstance(movement, SkeletonMotion | MarkerMotion) and "scene" in kinds):
        return movement, ()
    if isinstance(movement, Motion) and "skeleton" in kinds:
        return skeleton_of_motion(movement)
    if isinstance(movement, Motion) and "scene" in kinds:
        return _scene(movement)
    if isinstance(movement, Motion) and "markers" in kinds:
        skeleton, first = skeleton_of_motion(movement)
        markers, second = markers_of_skeleton(skeleton)
        return markers, (*first, *second)
    if isinstance(movement, SkeletonMotion) and "markers" in kinds:
        return markers_of_skeleton(movement)
    if isinstance(movement, Scene) and "markers" in kinds:
        return markers_of_scene(movement)
    wanted = " or ".join(_WORDS[kind] for kind in kinds)
    captured = isinstance(movement, SkeletonMotion | MarkerMotion)
    way = "; put it on the dancer first (--on-dancer)" if captured else ""
    raise MotionError(f"{_WORDS[own]} does not become {wanted} by conversion{way}")


def _scene(motion: Motion) -> tuple[Scene, tuple[str, ...]]:
    rate = even_rate(motion)
    scene = scene_of_motion(motion) if rate is None else scene_of_motion(motion, position_rate=rate)
    lost = ["velocities, accelerations"]
    if motion.events:
        lost.append(f"{len(motion.events)} events (key poses, contacts)")
    return scene, (*lost, "masses and shapes of the body")
