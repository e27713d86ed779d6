"""Any skeleton as HTR or GTR describes one, and the file."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from dataclasses import replace
from math import hypot
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from enpointe.motion.formats.content import Payload
from enpointe.motion.formats.convert import angles_of, flat
from enpointe.motion.formats.skeleton import IDENTITY, Skeleton, SkeletonMotion
from enpointe.motion.formats.space import DEGREES
from enpointe.motion.formats.tree import Vector, unlike
from enpointe.motion.formats.units import INCH
from enpointe.motion.formats.writing import (
    note_numbers,
    number_lines,
    one_word,
    skeleton_of,
    unheld,
    write_lines,
)

__all__ = ["write_gtr", "write_htr"]

_ORDER = "ZYX"
_PLACES = tuple(f"{axis}{kind}" for kind in ("position", "rotation") for axis in "XYZ")
_UNITS = {"mm": 0.001, "cm": 0.01, "m": 1.0, "in": INCH}
_GONE = 9999999.0
# Settings that a file may have beside those that are the movement's own.
_KEPT = ("FileVersion", "EulerRotationOrder", "CalibrationUnits", "BoneLengthAxis", "ScaleFactor")


def write_htr(payload: Payload, path: Path) -> tuple[str, ...]:
    """Writes an HTR file, and says what it can't hold."""
    motion = skeleton_of(payload, path, "HTR")
    return _write(motion, path, "htr")


def write_gtr(payload: Payload, path: Path) -> tuple[str, ...]:
    """Writes a GTR file, and says what it can't hold."""
    motion = skeleton_of(payload, path, "GTR")
    lost: tuple[str, ...] = ()
    if any(joint.parent >= 0 for joint in motion.skeleton.joints):
        lost = ("which joint hangs on which, and their rest",)
        lengths = [_length(motion.skeleton, i) for i in range(len(motion.skeleton.joints))]
        motion = flat(motion, _ORDER)
        joints = tuple(
            replace(joint, ends=((0.0, length, 0.0),))
            for joint, length in zip(motion.skeleton.joints, lengths, strict=True)
        )
        motion = replace(motion, skeleton=replace(motion.skeleton, joints=joints))
    return (*lost, *_write(motion, path, "gtr"))


def _write(motion: SkeletonMotion, path: Path, kind: str) -> tuple[str, ...]:
    lost = list(_fallen(motion.skeleton))
    order = _common_order(motion)
    if not _fits(motion.skeleton, order):
        motion = _added_to_rest(motion, order)
    skeleton = motion.skeleton
    names, renamed = unlike([one_word(joint.name) for joint in skeleton.joints])
    if names != [joint.name for joint in skeleton.joints]:
        lost += ["blanks and doubles in names", *renamed]
    scaled = [any(c.endswith("scale") for c in joint.channels) for joint in skeleton.joints]
    rows: list[str] = [*_head(motion, names, kind, order, any(scaled))]
    counts = np.arange(motion.start, motion.start + motion.frames, dtype=float)
    values = np.where(np.isnan(motion.values), _GONE, motion.values)
    for index, name in enumerate(names):
        rows.append(f"[{name}]")
        own = values[:, skeleton.columns(index)]
        if any(scaled) and not scaled[index]:
            own = np.column_stack([own, np.ones(motion.frames)])
        lines = number_lines(own, path)
        rows += (f"{count:.0f} {line}" for count, line in zip(counts, lines, strict=True))
    rows.append("[EndOfFile]")
    write_lines(path, rows)
    return (*lost, *unheld(motion, _KEPT, first=motion.start))


def _fallen(skeleton: Skeleton) -> Iterator[str]:
    if any(joint.limits for joint in skeleton.joints):
        yield "the joints' limits"
    if any(joint.axis != IDENTITY for joint in skeleton.joints):
        yield "the axes in which the joints' channels turn (their rotations are kept)"
    ends = [(i, end) for i, joint in enumerate(skeleton.joints) for end in joint.ends]
    bent = any(end[0] or end[2] for _, end in ends)
    if bent or any(skeleton.children[i] for i, _ in ends) or len({i for i, _ in ends}) < len(ends):
        yield "the directions of end sites (a bone's length is kept)"


def _common_order(motion: SkeletonMotion) -> str:
    counted = Counter(joint.product for joint in motion.skeleton.joints if len(joint.product) == 3)
    return counted.most_common(1)[0][0] if counted else _ORDER


def _fits(skeleton: Skeleton, order: str) -> bool:
    return not skeleton.positions_replace_offset and all(
        joint.channels[:6] == _PLACES
        and len(joint.channels) <= 7
        and joint.product == order
        and joint.axis == IDENTITY
        and not joint.limits
        for joint in skeleton.joints
    )


def _added_to_rest(motion: SkeletonMotion, order: str) -> SkeletonMotion:
    """The same movement as translations and rotations on top of each joint's rest."""
    moved, rotations = motion.local()
    joints, columns = [], []
    for index, joint in enumerate(motion.skeleton.joints):
        rest = Rotation.from_quat(joint.rest, scalar_first=True)
        turns = rest.inv() * Rotation.from_quat(rotations[:, index], scalar_first=True)
        columns += [moved[:, index] - np.array(joint.offset), _angles(motion, index, turns, order)]
        joints.append(replace(joint, channels=_PLACES, order=order, axis=IDENTITY, limits=()))
    skeleton = replace(motion.skeleton, joints=tuple(joints), positions_replace_offset=False)
    return replace(motion, skeleton=skeleton, values=np.concatenate(columns, axis=1))


def _angles(motion: SkeletonMotion, index: int, turns: Rotation, order: str) -> NDArray[np.float64]:
    """(T, 3) angles about X, Y, Z in the file's unit; the joint's own numbers where they serve."""
    joint = motion.skeleton.joints[index]
    if joint.axis == IDENTITY and joint.product == "".join(a for a in order if a in joint.product):
        own = motion.values[:, motion.skeleton.columns(index)]
        angles = np.zeros((motion.frames, 3))
        for axis in joint.product:
            angles[:, "XYZ".index(axis)] = own[:, joint.channels.index(f"{axis}rotation")]
        return angles
    found = angles_of(turns, order) / motion.skeleton.space.radians_per_unit
    return found[:, [order.index(axis) for axis in "XYZ"]]


def _head(
    motion: SkeletonMotion, names: list[str], kind: str, order: str, scaled: bool
) -> Iterator[str]:
    skeleton, notes = motion.skeleton, motion.notes
    unit, scale = _unit(skeleton.space.metres_per_unit, notes)
    degrees = skeleton.space.radians_per_unit == DEGREES
    yield "[Header]"
    yield f"FileType {kind}"
    yield f"DataType {kind.upper()}{'S' if scaled else ''}"
    yield f"FileVersion {notes.get('FileVersion', '1')}"
    yield f"NumSegments {len(names)}"
    yield f"NumFrames {motion.frames}"
    yield f"DataFrameRate {_short(motion.rate)}"
    yield f"EulerRotationOrder {order}"
    yield f"CalibrationUnits {unit}"
    yield f"RotationUnits {'Degrees' if degrees else 'Radians'}"
    yield f"GlobalAxisofGravity {skeleton.space.up.upper()}"
    yield f"BoneLengthAxis {notes.get('BoneLengthAxis', 'Y')}"
    yield f"ScaleFactor {scale}"
    yield "[SegmentNames&Hierarchy]"
    for name, joint in zip(names, skeleton.joints, strict=True):
        parent = names[joint.parent] if joint.parent >= 0 else "GLOBAL"
        yield f"{name}\t{parent}" if kind == "htr" else name
    yield "[BasePosition]"
    for index, name in enumerate(names):
        yield f"{name} {_base(motion, index, order)}"


def _base(motion: SkeletonMotion, index: int, order: str) -> str:
    """Translation, rotation and length of a segment at rest; as the file had them if they hold."""
    skeleton, joint = motion.skeleton, motion.skeleton.joints[index]
    radians = skeleton.space.radians_per_unit
    written = note_numbers(motion, f"bone {joint.name}")
    if len(written) == 7 and tuple(written[:3]) == joint.offset:
        angles = [radians * written[3 + "XYZ".index(axis)] for axis in order]
        same = Rotation.from_euler(order, angles).as_quat(scalar_first=True)
        if np.allclose(same, joint.rest, rtol=0, atol=1e-15):
            return motion.notes[f"bone {joint.name}"]
    turn = Rotation.from_quat(joint.rest, scalar_first=True)
    found = (angles_of(turn, order) / radians)[:, [order.index(axis) for axis in "XYZ"]][0]
    length = _length(skeleton, index)
    return " ".join(repr(float(value)) for value in (*joint.offset, *found, length))


def _length(skeleton: Skeleton, index: int) -> float:
    children = skeleton.children[index]
    reach: Vector = (0.0, 0.0, 0.0)
    if children:
        reach = skeleton.joints[children[0]].offset
    elif skeleton.joints[index].ends:
        reach = skeleton.joints[index].ends[0]
    return hypot(*reach)


def _unit(metres: float, notes: dict[str, str]) -> tuple[str, str]:
    """A unit's name and the scale that together are so many metres."""
    written, scale = notes.get("CalibrationUnits", ""), notes.get("ScaleFactor", "1")
    try:
        if _UNITS[written.lower()] * float(scale) == metres:
            return written, scale
    except (KeyError, ValueError):
        pass
    name = next((name for name, size in _UNITS.items() if size == metres), None)
    return (name, "1") if name else ("mm", repr(metres / 0.001))


def _short(value: float) -> str:
    return str(int(value)) if value == int(value) else repr(value)
