"""BVH: Biovision's hierarchy of joints, one line of numbers a frame.

ENACTIVE D.RD3.3.1 section 2.2; J. Lander, "Working with motion capture file formats", Game
Developer, January 1998. A joint's rotations are multiplied in the order in which its channels
stand, the first outermost, and its positions stand in place of its offset. Lengths have no unit,
angles are degrees, y is up.
"""

from __future__ import annotations

import re
from contextlib import suppress
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from enpointe.errors import FormatError
from enpointe.motion.formats.content import Content, Format, Payload
from enpointe.motion.formats.convert import depth_first, plain
from enpointe.motion.formats.skeleton import Joint, Skeleton, SkeletonMotion
from enpointe.motion.formats.space import DEGREES, Space
from enpointe.motion.formats.text import (
    CUT,
    decoded,
    finite_number,
    number_block,
    read_raw,
    refuse_merge_marks,
    whole_number,
)
from enpointe.motion.formats.tree import Node, parsed_tree, unlike
from enpointe.motion.formats.units import guessed_unit
from enpointe.motion.formats.writing import (
    END_SITE,
    FRAME_TIME,
    frame_time,
    hierarchy_lines,
    number_lines,
    one_word,
    skeleton_of,
    unheld,
    write_lines,
)

__all__ = ["BVH"]

_BEGINS = re.compile(rb"^(?:\xef\xbb\xbf)?[ \t]*HIERARCHY\b", re.IGNORECASE | re.MULTILINE)
_MOTION = re.compile(rb"^[ \t]*MOTION\b", re.IGNORECASE | re.MULTILINE)
_SETTING = re.compile(r"\s*(frames|frame\s*time)\s*:?\s*(.*?)\s*$", re.IGNORECASE)


def _sniff(head: bytes) -> bool:
    return bool(_BEGINS.search(head)) and b"channel" in head.lower()


def _read(path: Path) -> Content:
    raw = read_raw(path)
    if b"\r" in raw and raw.count(b"\r") != raw.count(b"\r\n"):
        raw = raw.replace(b"\r\n", b"\n").replace(b"\r", b"\n")
    found = _MOTION.search(raw)
    head = decoded(raw[: found.start() if found else len(raw)])
    nodes = parsed_tree(head, path)
    line = 1 + head.count("\n")
    if found is None:
        raise FormatError("the file ends without MOTION: is it whole?", path, line=line)
    joints, warnings = _joints(nodes)
    width = sum(len(joint.channels) for joint in joints)
    if width == 0:
        raise FormatError("no joint has a channel: nothing moves", path, line=line)
    declared, time, start, line = _settings(raw, found.end(), line, path)
    values, repairs = _frames(raw, start, line, width, declared, path)
    unit, guess = guessed_unit(joints)
    notes = {FRAME_TIME: time} | {
        f"{END_SITE}{joint.name} {number}": name
        for joint, node in zip(joints, nodes, strict=True)
        for number, name in enumerate(node.end_names)
        if name.lower() != "site"
    }
    skeleton = Skeleton(joints, Space(unit))
    motion = SkeletonMotion(skeleton, 1 / float(time), values, notes=notes)
    return Content(motion, (*warnings, *repairs, guess))


def _joints(nodes: list[Node]) -> tuple[tuple[Joint, ...], list[str]]:
    names, warnings = unlike([node.name for node in nodes])
    return tuple(
        Joint(
            name,
            node.parent,
            node.offset or (0.0, 0.0, 0.0),
            node.channels or (),
            ends=tuple(node.ends),
        )
        for name, node in zip(names, nodes, strict=True)
    ), warnings


def _settings(raw: bytes, start: int, line: int, path: Path) -> tuple[int, str, int, int]:
    """Frames as declared, the time of one as written, and where (byte, line) the frames start."""
    found: dict[str, str] = {}
    rest, start = _next_line(raw, start)
    if rest.strip():
        raise FormatError(f"MOTION stands alone on its line, got {rest[:40]!r}", path, line=line)
    while len(found) < 2:
        if start >= len(raw):
            raise FormatError("Frames and Frame Time expected behind MOTION", path, line=line)
        line += 1
        text, start = _next_line(raw, start)
        if not text.strip():
            continue
        setting = _SETTING.match(text)
        if setting is None:
            refuse_merge_marks(text.strip(), path, line)
            raise FormatError(
                f"Frames or Frame Time expected, got {text.strip()[:40]!r}", path, line=line
            )
        key = FRAME_TIME if "t" in setting[1].lower() else "Frames"
        if key in found:
            raise FormatError(f"{key} for the second time", path, line=line)
        found[key] = setting[2]
        if key == FRAME_TIME:
            _check_time(setting[2], path, line)
        else:
            whole_number(setting[2], path, line, "Frames")
    return int(float(found["Frames"])), found[FRAME_TIME], start, line + 1


def _check_time(text: str, path: Path, line: int) -> None:
    time = finite_number(text, path, line, FRAME_TIME)
    if not 1e-6 <= time <= 1e6:
        raise FormatError(
            f"{FRAME_TIME} must be seconds above 0 (0.0333333 is 30 a second), got {text[:40]!r}",
            path,
            line=line,
        )


def _next_line(raw: bytes, start: int) -> tuple[str, int]:
    end = raw.find(b"\n", start)
    end = len(raw) if end < 0 else end
    return decoded(raw[start:end]), end + 1


def _frames(
    raw: bytes, start: int, line: int, width: int, declared: int, path: Path
) -> tuple[NDArray[np.float64], list[str]]:
    """The rows of numbers, and what had to be mended."""
    warnings = []
    try:
        values = number_block(raw, width, path, line, "a frame", start)
    except FormatError as problem:
        values, mended = _mended(raw, start, line, width, declared, problem)
        warnings.append(mended)
    else:
        if not raw.endswith(b"\n") and len(values) < declared:
            values = values[:-1]
            warnings.append("the file ends within its last line: that frame is left out")
        elif not raw.endswith(b"\n"):
            warnings.append(CUT)
    if not len(values):
        raise FormatError("there are no frames", path, line=line)
    if len(values) != declared:
        warnings.append(f"Frames says {declared}, the file has {len(values)}: these are taken")
    return values, warnings


def _mended(
    raw: bytes, start: int, line: int, width: int, declared: int, problem: FormatError
) -> tuple[NDArray[np.float64], str]:
    """Frames of a file whose frames go over lines, or whose last line is short: it was cut."""
    path = Path(problem.file)
    with suppress(FormatError):
        values = number_block(raw, width, path, line, "a frame", start, broken=True)
        if len(values) == declared:
            return values, "frames go over several lines: put together by their number of values"
    last = max(raw.rfind(b"\n", start, len(raw.rstrip())) + 1, start)
    if not raw.endswith(b"\n") and len(raw[last:].split()) < width:
        with suppress(FormatError):
            values = number_block(raw[:last], width, path, line, "a frame", start)
            return values, "the file ends within a frame: that frame is left out"
    raise problem


def _write(payload: Payload, path: Path) -> tuple[str, ...]:
    motion = depth_first(skeleton_of(payload, path, "BVH"))
    lost: tuple[str, ...] = ()
    skeleton = motion.skeleton
    if not _fits(skeleton):
        motion, lost = plain(motion)
        skeleton = motion.skeleton
    names, renamed = unlike([one_word(joint.name) for joint in skeleton.joints])
    lines = [*hierarchy_lines(skeleton, names, motion.notes), "MOTION", f"Frames: {motion.frames}"]
    lines.append(f"{FRAME_TIME}: {frame_time(motion)}")
    write_lines(path, lines, number_lines(motion.values, path))
    used = [FRAME_TIME, *(key for key in motion.notes if key.startswith(END_SITE))]
    lost += unheld(motion, used, first=0)
    if names != [joint.name for joint in skeleton.joints]:
        lost += ("blanks, braces and doubles in names", *renamed)
    unit = skeleton.space.metres_per_unit
    guessed, _ = guessed_unit(skeleton.joints)
    if abs(guessed / unit - 1) > 1e-9:
        lost += (f"the unit of length, {unit:g} m: a reader may guess {guessed:g} m",)
    return lost


def _fits(skeleton: Skeleton) -> bool:
    return (
        skeleton.positions_replace_offset
        and skeleton.space.up == "y"
        and skeleton.space.radians_per_unit == DEGREES
        and all(joint.plain and not joint.limits for joint in skeleton.joints)
    )


BVH = Format("BVH", (".bvh",), "skeleton", _sniff, _read, _write)
