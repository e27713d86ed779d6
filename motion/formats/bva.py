"""BVA: Biovision's older format, each segment by itself in the world.

ENACTIVE D.RD3.3.1 section 2.2.2. The columns are X Y Z, the angles multiply as in BVH, Rz Rx Ry:
the section's two examples are one movement, and only so do they agree. A segment's scale is the
length of its bone, in the unit that the column names.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from math import hypot
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from enpointe.errors import FormatError
from enpointe.motion.formats.content import Content, Format, Payload
from enpointe.motion.formats.convert import flat, upright
from enpointe.motion.formats.skeleton import IDENTITY, Joint, Skeleton, SkeletonMotion
from enpointe.motion.formats.space import DEGREES, Space
from enpointe.motion.formats.text import (
    CUT,
    finite_number,
    number_table,
    read_text,
    refuse_merge_marks,
    whole_number,
)
from enpointe.motion.formats.tree import unlike
from enpointe.motion.formats.units import INCH
from enpointe.motion.formats.writing import (
    FRAME_TIME,
    frame_time,
    number_lines,
    skeleton_of,
    unheld,
    write_lines,
)

__all__ = ["BVA"]

_ORDER = "ZXY"
_SEGMENT = re.compile(rb"^[ \t]*Segment[ \t]*:", re.IGNORECASE | re.MULTILINE)
_KEY = re.compile(r"\s*(segment|frames|frame\s*time)\s*:\s*(.*?)\s*$", re.IGNORECASE)
_COLUMNS = {
    f"{axis}{short}": f"{axis}{long}"
    for short, long in (("TRAN", "position"), ("ROT", "rotation"), ("SCALE", "scale"))
    for axis in "XYZ"
}
_SHORT = {channel: column for column, channel in _COLUMNS.items()}
# The document prints INCCHES in one of its two tables.
_METRES = {
    **dict.fromkeys(("INCHES", "INCCHES", "INCH", "IN"), INCH),
    **dict.fromkeys(("METERS", "METRES", "METER", "METRE", "M"), 1.0),
    **dict.fromkeys(("CENTIMETERS", "CENTIMETRES", "CM"), 0.01),
    **dict.fromkeys(("MILLIMETERS", "MILLIMETRES", "MM"), 0.001),
    **dict.fromkeys(("FEET", "FOOT", "FT"), 12 * INCH),
}
_RADIANS = {**dict.fromkeys(("DEGREES", "DEGREE", "DEG"), DEGREES), "RADIANS": 1.0}
_NAMES = {INCH: "INCHES", 1.0: "METERS", 0.01: "CENTIMETERS", 0.001: "MILLIMETERS"}


@dataclass
class _Segment:
    name: str
    time: str
    channels: tuple[str, ...]
    units: tuple[str, ...]
    values: NDArray[np.float64]
    line: int


def _sniff(head: bytes) -> bool:
    return bool(_SEGMENT.search(head))


def _read(path: Path) -> Content:
    reader = _Reader(path, read_text(path).split("\n"))
    if reader.lines[-1]:
        reader.warnings.append(CUT)
    segments = reader.segments()
    first = segments[0]
    units = [reader.units(segment) for segment in segments]
    for segment, measure in zip(segments, units, strict=True):
        same = float(segment.time) == float(first.time) and measure == units[0]
        if len(segment.values) != len(first.values) or not same:
            raise FormatError(
                f"{segment.name[:40]!r} has {len(segment.values)} frames of {segment.time} s, "
                f"{first.name[:40]!r} {len(first.values)} of {first.time} s, or other units",
                path,
                line=segment.line,
            )
    names, warnings = unlike([segment.name for segment in segments])
    joints = tuple(
        Joint(name, -1, channels=segment.channels, order=_order(segment.channels))
        for name, segment in zip(names, segments, strict=True)
    )
    metres, radians = units[0]
    values = np.concatenate([segment.values for segment in segments], axis=1)
    skeleton = Skeleton(joints, Space(metres, radians_per_unit=radians))
    notes = {FRAME_TIME: first.time}
    motion = SkeletonMotion(skeleton, 1 / float(first.time), values, notes=notes)
    return Content(motion, (*warnings, *reader.warnings))


def _order(channels: tuple[str, ...]) -> str:
    turning = [channel[0] for channel in channels if channel.endswith("rotation")]
    return "".join(axis for axis in _ORDER if axis in turning)


class _Reader:
    """Takes a BVA file line by line."""

    def __init__(self, path: Path, lines: list[str]) -> None:
        self.path, self.lines, self.at = path, lines, 0
        self.warnings: list[str] = []

    def segments(self) -> list[_Segment]:
        found = []
        while self.skip_blank():
            found.append(self.segment())
        if not found:
            raise self.error("'Segment:' expected, and there is nothing but blanks", 1)
        return found

    def skip_blank(self) -> bool:
        while self.at < len(self.lines) and not self.lines[self.at].strip():
            self.at += 1
        return self.at < len(self.lines)

    def segment(self) -> _Segment:
        line = self.at + 1
        name = self.setting("segment")
        if not name:
            raise self.error("a segment needs a name", line)
        declared = whole_number(self.setting("frames"), self.path, self.at, "Frames")
        time = self.setting("frametime")
        if not 1e-6 <= finite_number(time, self.path, self.at, FRAME_TIME) <= 1e6:
            raise self.error(f"{FRAME_TIME} must be seconds above 0, got {time[:40]!r}", self.at)
        channels = self.columns()
        units = tuple(word.upper() for word in self.words())
        if len(units) != len(channels):
            raise self.error(f"{len(channels)} units expected, got {len(units)}", self.at)
        values = self.values(len(channels), name)
        if len(values) < declared and self.at == len(self.lines) and self.lines[-1]:
            raise self.error(f"the file ends within {name[:40]!r}", self.at)
        if len(values) != declared:
            self.warnings.append(
                f"{name[:40]!r}: Frames says {declared}, there are {len(values)}: these are taken"
            )
        return _Segment(name, time, channels, units, values, line)

    def setting(self, key: str) -> str:
        there = self.skip_blank()
        text = self.lines[self.at] if there else ""
        found = _KEY.match(text)
        self.at += 1
        if found is None or re.sub(r"\s", "", found[1]).lower() != key:
            line = min(self.at, len(self.lines))
            refuse_merge_marks(text.strip(), self.path, line)
            raise self.error(f"'{key}:' expected, got {text.strip()[:40]!r}", line)
        return found[2]

    def words(self) -> list[str]:
        words = self.lines[self.at].split() if self.skip_blank() else []
        self.at += 1
        return words

    def columns(self) -> tuple[str, ...]:
        words = self.words()
        line = min(self.at, len(self.lines))
        for word in words:
            if word.upper() not in _COLUMNS:
                raise self.error(f"no column is called {word[:40]!r}; {' '.join(_COLUMNS)}", line)
        channels = tuple(_COLUMNS[word.upper()] for word in words)
        if not channels or len(set(channels)) < len(channels):
            raise self.error("columns are missing, or one is there twice", line)
        return channels

    def values(self, width: int, name: str) -> NDArray[np.float64]:
        start = self.at
        while self.at < len(self.lines) and not _KEY.match(self.lines[self.at]):
            self.at += 1
        values = number_table(
            self.lines[start : self.at], width, self.path, start + 1, f"a frame of {name[:40]!r}"
        )
        if not len(values):
            raise self.error(f"{name[:40]!r} has no frames", start)
        return values

    def units(self, segment: _Segment) -> tuple[float, float]:
        metres: set[float] = set()
        radians: set[float] = set()
        for channel, unit in zip(segment.channels, segment.units, strict=True):
            known = _RADIANS if channel.endswith("rotation") else _METRES
            if unit not in known:
                raise self.error(f"no unit is called {unit[:40]!r}", segment.line + 4)
            (radians if channel.endswith("rotation") else metres).add(known[unit])
        if len(metres) > 1 or len(radians) > 1:
            raise self.error("lengths (or angles) of several units", segment.line + 4)
        return metres.pop() if metres else INCH, radians.pop() if radians else DEGREES

    def error(self, message: str, line: int) -> FormatError:
        return FormatError(message, self.path, line=max(line, 1))


def _write(payload: Payload, path: Path) -> tuple[str, ...]:
    motion = skeleton_of(payload, path, "BVA")
    lost: tuple[str, ...] = ()
    if not _fits(motion.skeleton):
        motion, lost = _flattened(motion)
    skeleton = motion.skeleton
    unit = _NAMES[skeleton.space.metres_per_unit]
    angle = "RADIANS" if skeleton.space.radians_per_unit == 1.0 else "DEGREES"
    time = frame_time(motion)
    rows: list[str] = []
    for index, joint in enumerate(skeleton.joints):
        rows.append(f"Segment: {joint.name}")
        rows += [f"Frames: {motion.frames}", f"{FRAME_TIME}: {time}"]
        rows.append(" ".join(_SHORT[channel] for channel in joint.channels))
        rows.append(
            " ".join(angle if channel.endswith("rotation") else unit for channel in joint.channels)
        )
        rows += number_lines(motion.values[:, skeleton.columns(index)], path)
    write_lines(path, rows)
    return (*lost, *unheld(motion, [FRAME_TIME], first=0))


def _fits(skeleton: Skeleton) -> bool:
    return (
        skeleton.space.up == "y"
        and skeleton.space.metres_per_unit in _NAMES
        and skeleton.positions_replace_offset
        and all(
            joint.parent < 0
            and joint.channels
            and joint.product == _order(joint.channels)
            and not joint.limits
            and not joint.ends
            and joint.axis == IDENTITY == joint.rest
            and joint.name == joint.name.strip()
            for joint in skeleton.joints
        )
    )


def _flattened(motion: SkeletonMotion) -> tuple[SkeletonMotion, tuple[str, ...]]:
    """Segments with their bones' lengths as scales, in a unit that has a name."""
    lengths = _lengths(motion.skeleton)
    hierarchy = any(joint.parent >= 0 for joint in motion.skeleton.joints)
    lost = ["which joint hangs on which, and their rest"] if hierarchy else []
    if any(joint.ends for joint in motion.skeleton.joints):
        lost.append("the directions of end sites (their lengths are kept as scales)")
    if any(joint.limits for joint in motion.skeleton.joints):
        lost.append("the joints' limits")
    if any(c.endswith("scale") for joint in motion.skeleton.joints for c in joint.channels):
        lost.append("the joints' scales (the bones' lengths stand there)")
    motion, turned = upright(flat(motion, _ORDER))
    lost += turned
    space = motion.skeleton.space
    metres = space.metres_per_unit if space.metres_per_unit in _NAMES else 0.01
    scale = space.metres_per_unit / metres
    joints, columns = [], []
    for index, joint in enumerate(motion.skeleton.joints):
        values = motion.values[:, motion.skeleton.columns(index)]
        sizes = np.full((motion.frames, 3), lengths[index] * scale)
        columns += [values[:, :3] * scale, values[:, 3:6], sizes]
        channels = tuple(_COLUMNS.values())
        joints.append(Joint(joint.name, -1, channels=channels, order=_ORDER))
    radians = 1.0 if space.radians_per_unit == 1.0 else DEGREES
    skeleton = Skeleton(tuple(joints), Space(metres, radians_per_unit=radians))
    values = np.concatenate(columns, axis=1)
    return SkeletonMotion(
        skeleton, motion.rate, values, start=motion.start, notes=motion.notes
    ), tuple(lost)


def _lengths(skeleton: Skeleton) -> list[float]:
    """From each joint to the first that hangs on it, or to its end."""
    return [
        hypot(*skeleton.joints[children[0]].offset)
        if children
        else hypot(*joint.ends[0])
        if joint.ends
        else 0.0
        for joint, children in zip(skeleton.joints, skeleton.children, strict=True)
    ]


BVA = Format("BVA", (".bva",), "skeleton", _sniff, _read, _write)
