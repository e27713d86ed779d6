"""ASK: Alias's skeleton, BVH's hierarchy without channels and with offsets in the world.

ENACTIVE D.RD3.3.1 section 2.3; J. Lander's page on ASK and SDL at the University of Wisconsin
(1998). The movement that belongs to it is part of a scene in Alias's description language (SDL),
for whose curves no public description was found: an SDL file is neither read nor written.
"""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np

from enpointe.errors import FormatError
from enpointe.motion.formats.content import Content, Format, Payload
from enpointe.motion.formats.convert import depth_first, plain
from enpointe.motion.formats.skeleton import Joint, Skeleton, SkeletonMotion
from enpointe.motion.formats.space import Space
from enpointe.motion.formats.text import read_text
from enpointe.motion.formats.tree import Node, Vector, parsed_tree, unlike
from enpointe.motion.formats.units import guessed_unit
from enpointe.motion.formats.writing import (
    hierarchy_lines,
    note_numbers,
    one_word,
    skeleton_of,
    unheld,
    write_lines,
)

__all__ = ["ASK"]

_BEGINS = re.compile(rb"^(?:\xef\xbb\xbf)?[ \t]*HIERARCHY\b", re.IGNORECASE | re.MULTILINE)
_RATE = 30.0
_NOTE = "bone "
_CHANNELS = tuple(f"{axis}rotation" for axis in "ZXY")


def _sniff(head: bytes) -> bool:
    return bool(_BEGINS.search(head)) and b"channel" not in head.lower()


def _read(path: Path) -> Content:
    nodes = parsed_tree(read_text(path), path)
    moving = next((node for node in nodes if node.channels), None)
    if moving is not None:
        raise FormatError(
            "a skeleton with channels and no MOTION: a BVH file cut short?", path, line=moving.line
        )
    names, warnings = unlike([node.name for node in nodes])
    joints = tuple(_joint(name, node, nodes) for name, node in zip(names, nodes, strict=True))
    unit, guess = guessed_unit(joints)
    skeleton = Skeleton(joints, Space(unit))
    notes = {
        f"{_NOTE}{name}": " ".join(map(repr, [*_place(node), *np.ravel(node.ends).tolist()]))
        for name, node in zip(names, nodes, strict=True)
    }
    motion = SkeletonMotion(skeleton, _RATE, np.zeros((1, skeleton.width)), notes=notes)
    alone = "an ASK file holds no movement: one frame at rest"
    scene = path.with_suffix(".sdl")
    lost = (f"the movement in {scene.name}: SDL is not read",) if scene.is_file() else ()
    return Content(motion, (*warnings, guess, alone), lost)


def _joint(name: str, node: Node, nodes: list[Node]) -> Joint:
    here = _place(node)
    above = _place(nodes[node.parent]) if node.parent >= 0 else (0.0, 0.0, 0.0)
    ends = tuple(_minus(end, here) for end in node.ends)
    return Joint(name, node.parent, _minus(here, above), _CHANNELS, ends=ends)


def _place(node: Node) -> Vector:
    return node.offset or (0.0, 0.0, 0.0)


def _write(payload: Payload, path: Path) -> tuple[str, ...]:
    motion = depth_first(skeleton_of(payload, path, "ASK"))
    lost: tuple[str, ...] = ()
    if not all(joint.plain for joint in motion.skeleton.joints) or motion.skeleton.space.up != "y":
        motion, lost = plain(motion)
    skeleton = motion.skeleton
    places: list[Vector] = []
    joints = []
    for joint in skeleton.joints:
        above = places[joint.parent] if joint.parent >= 0 else (0.0, 0.0, 0.0)
        place, ends = _written(joint, above, note_numbers(motion, f"{_NOTE}{joint.name}"))
        places.append(place)
        joints.append(Joint(joint.name, joint.parent, place, ends=ends))
    names, renamed = unlike([one_word(joint.name) for joint in joints])
    write_lines(path, hierarchy_lines(Skeleton(tuple(joints)), names, {}))
    lost += ("the movement: an ASK file holds a skeleton alone",) if motion.values.any() else ()
    return (*lost, *renamed, *unheld(motion, (), first=0))


def _written(
    joint: Joint, above: Vector, numbers: list[float]
) -> tuple[Vector, tuple[Vector, ...]]:
    """Where a joint and its ends stand, in the digits of the file that it came from."""
    if len(numbers) == 3 + 3 * len(joint.ends):
        vectors = [(x, y, z) for x, y, z in np.reshape(numbers, (-1, 3)).tolist()]
        place, ends = vectors[0], tuple(vectors[1:])
        same = tuple(_minus(end, place) for end in ends) == joint.ends
        if _minus(place, above) == joint.offset and same:
            return place, ends
    place = _plus(above, joint.offset)
    return place, tuple(_plus(place, end) for end in joint.ends)


def _plus(one: Vector, other: Vector) -> Vector:
    return one[0] + other[0], one[1] + other[1], one[2] + other[2]


def _minus(one: Vector, other: Vector) -> Vector:
    return one[0] - other[0], one[1] - other[1], one[2] - other[2]


ASK = Format("ASK", (".ask",), "skeleton", _sniff, _read, _write)
