"""CSV files of ours: a column a channel, with its unit in its name.

A few lines that start with # say what a table can't (they are a comment to pandas and others), then
come the columns: `time [s]`, and `NAME.x [mm]`, `NAME.y [mm]`, `NAME.z [mm]` of each marker or
`NAME.Xrotation [deg]` of each joint. A file without the # lines is read as well.
"""

from __future__ import annotations

import csv
import io
import json
import re
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Literal, cast

import numpy as np
from numpy.typing import NDArray

from enpointe.errors import FormatError, MotionError
from enpointe.files import write_text
from enpointe.motion.formats.columns import (
    MOST_MARKERS,
    delimited_rows,
    number_text,
    plain_lines,
    settle_gaps,
)
from enpointe.motion.formats.content import Content, Format, Payload
from enpointe.motion.formats.guessing import UNITS, guessed_space, unit_name
from enpointe.motion.formats.holding import left_out, markers_of
from enpointe.motion.formats.markers import Label, MarkerMotion
from enpointe.motion.formats.skeleton import CHANNELS, Joint, Skeleton, SkeletonMotion
from enpointe.motion.formats.space import DEGREES, Space
from enpointe.motion.formats.text import decoded, read_raw
from enpointe.motion.gesture.scene import Scene

__all__ = ["CSV_JOINTS", "CSV_MARKERS", "read_csv", "write_csv"]

Array = NDArray[np.float64]
_FIRST = {"markers": "# enpointe motion 1: markers", "joints": "# enpointe motion 1: joints"}
_COLUMN = re.compile(r"(.*)\.([A-Za-z]+) ?(?:\[([^\]]*)\])?\s*")
_POINT = ("x", "y", "z")
_TURN = ("qw", "qx", "qy", "qz")
_ANGLES = {"deg": DEGREES, "rad": 1.0}
_UNEVEN = 1e-3
_LARGEST = 1e300


def read_csv(path: Path) -> Content:
    """Read a CSV file of markers or of joint angles.

    Joints come back without their hierarchy, which a table does not hold.

    Raises:
        FormatError: Columns that can't be told, or a row that is none.
    """
    raw = plain_lines(read_raw(path))
    head, at = _head(raw, path)
    told = _told(head, path)
    columns = _columns(head[at], path, at + 1)
    rows = delimited_rows(raw, at + 1, len(columns) + 1, ",", path, "a row", needed=1)
    if rows.longer:
        raise FormatError("some rows have more columns than there are names", path, line=at + 2)
    table = rows.table
    if not len(table):
        raise FormatError("there are no rows", path, line=at + 1)
    rate, warnings = _rate(table[:, 0], told, path)
    warnings += rows.warnings
    try:
        if any(column.channel in CHANNELS for column in columns):
            return _joints(columns, table, rate, told, warnings, path, at + 1)
        return _markers(columns, table, rows.shorter, rate, told, warnings)
    except MotionError as error:
        raise FormatError(str(error), path, line=at + 1) from None


def write_csv(payload: Payload, path: Path) -> tuple[str, ...]:
    """Write a CSV file with the numbers as they are.

    Returns:
        What a table can't hold.

    Raises:
        FormatError: A scene, no frames, or a unit that has no name.
    """
    if isinstance(payload, Scene):
        raise FormatError("CSV holds markers or joints, and this is a scene", path)
    space = payload.space if isinstance(payload, MarkerMotion) else payload.skeleton.space
    unit = unit_name(space.metres_per_unit)
    if unit is None:
        raise FormatError("CSV needs a unit with a name: mm, cm, m, in", path)
    if isinstance(payload, MarkerMotion):
        names, table, lost = _marker_table(markers_of(payload, path, "CSV"), unit)
    else:
        names, table, lost = _joint_table(payload, unit, path)
    told: dict[str, object] = {
        "rate": payload.rate,
        "start": payload.start,
        "up": space.up,
        "unit": unit,
        "notes": payload.notes,
    }
    if isinstance(payload, MarkerMotion):
        told["events"] = [[e.time, e.name, e.subject, e.context] for e in payload.labels]
    else:
        told["angle"] = _angle_name(space)
    text = io.StringIO()
    text.write(_FIRST["markers" if isinstance(payload, MarkerMotion) else "joints"] + "\n")
    for key, value in told.items():
        text.write(f"# {key}: {json.dumps(value, ensure_ascii=False)}\n")
    csv.writer(text, lineterminator="\n").writerow(["time [s]", *names])
    for index, row in enumerate(table.tolist()):
        time = number_text(round(index / payload.rate, 9))
        text.write(",".join([time, *map(number_text, row)]) + "\n")
    write_text(path, text.getvalue())
    return tuple(lost)


@dataclass(frozen=True, slots=True)
class _Column:
    name: str
    channel: str
    unit: str


def _head(raw: bytes, path: Path) -> tuple[list[str], int]:
    """The lines down to that of the columns, and its place."""
    lines: list[str] = []
    start = 0
    while start < len(raw):
        end = raw.find(b"\n", start)
        end = len(raw) if end < 0 else end
        lines.append(decoded(raw[start:end]))
        if lines[-1].strip() and not lines[-1].startswith("#"):
            return lines, len(lines) - 1
        start = end + 1
    raise FormatError("there is no line of columns", path, line=max(len(lines), 1))


def _told(lines: list[str], path: Path) -> dict[str, object]:
    told: dict[str, object] = {}
    ours = lines[0].strip() in _FIRST.values()
    for number, line in enumerate(lines[ours:], start=1 + ours):
        if not line.startswith("#"):
            break
        key, colon, value = line[1:].partition(":")
        if colon:
            try:
                told[key.strip()] = json.loads(value)
            except (ValueError, RecursionError):
                if ours:
                    problem = "a line with # must be 'key: JSON'"
                    raise FormatError(problem, path, line=number) from None
    return told


def _columns(line: str, path: Path, number: int) -> list[_Column]:
    if len(line) > 40 * MOST_MARKERS:
        raise FormatError(f"more than {MOST_MARKERS} columns", path, line=number)
    try:
        fields = next(csv.reader([line]))
    except (csv.Error, StopIteration):
        raise FormatError("the columns can't be told", path, line=number) from None
    if not fields[0].strip().lower().startswith("time"):
        raise FormatError("the first column must be the time", path, line=number)
    columns = []
    for field in fields[1:]:
        match = _COLUMN.fullmatch(field)
        if match is None:
            raise FormatError(
                f"a column must be NAME.x [unit], got {field[:40]!r}", path, line=number
            )
        columns.append(_Column(match[1].strip(), match[2], (match[3] or "").strip()))
    if not columns:
        raise FormatError("there is no column but the time", path, line=number)
    return columns


def _rate(times: Array, told: dict[str, object], path: Path) -> tuple[float, list[str]]:
    steps = np.diff(times)
    given = _finite(told.get("rate"))
    if given is not None and given > 0:
        rate = given
    elif len(steps) and (mean := float(np.mean(steps))) > 0:
        rate = round(1 / mean, 6) or 1 / mean
    else:
        raise FormatError("times must go forward", path, line=1)
    if not np.isfinite(rate):
        raise FormatError("times must go forward", path, line=1)
    if len(steps) and np.abs(steps * rate - 1).max() > _UNEVEN:
        return rate, [f"times are not even; {rate:g} frames a second are taken"]
    return rate, []


def _finite(value: object) -> float | None:
    if not isinstance(value, int | float) or abs(value) > _LARGEST:
        return None
    return float(value) if value == value else None


def _notes(told: dict[str, object]) -> dict[str, str]:
    notes = told.get("notes")
    return {str(k): str(v) for k, v in notes.items()} if isinstance(notes, dict) else {}


def _start(told: dict[str, object], usual: int) -> int:
    start = told.get("start")
    return start if isinstance(start, int) and abs(start) < 10**9 else usual


def _length_unit(
    columns: list[_Column], told: dict[str, object], warnings: list[str]
) -> float | None:
    units = {column.unit for column in columns if column.unit in UNITS}
    if len(units) > 1:
        warnings.append(f"several units of length ({', '.join(sorted(units))}); the first is taken")
    first = next((column.unit for column in columns if column.unit in UNITS), None)
    return UNITS.get(str(first or told.get("unit")))


def _space(
    told: dict[str, object], metres: float | None, positions: Array, warnings: list[str]
) -> Space:
    up = told.get("up")
    space, guesses = guessed_space(positions, "z", metres)
    if up in _POINT:
        warnings += guesses[1:]
        return Space(space.metres_per_unit, cast(Literal["x", "y", "z"], up))
    warnings += guesses
    return space


def _markers(
    columns: list[_Column],
    table: Array,
    shorter: int,
    rate: float,
    told: dict[str, object],
    warnings: list[str],
) -> Content:
    markers = _grouped(columns)
    found = {column.channel for column in columns}
    shape = (len(table), len(markers))
    positions = np.full((*shape, 3), np.nan)
    turns = np.full((*shape, 4), np.nan) if found & set(_TURN) else None
    residuals = np.full(shape, np.nan) if "residual" in found else None
    cameras = np.zeros(shape, dtype=np.uint8) if "cameras" in found else None
    for index, (_, at) in enumerate(markers):
        for channel, column in at.items():
            values = table[:, column]
            if channel in _POINT:
                positions[:, index, _POINT.index(channel)] = values
            elif channel in _TURN and turns is not None:
                turns[:, index, _TURN.index(channel)] = values
            elif channel == "residual" and residuals is not None:
                residuals[:, index] = values
            elif channel == "cameras" and cameras is not None:
                cameras[:, index] = np.clip(np.nan_to_num(values), 0, 255).astype(np.uint8)
    warnings += settle_gaps(positions, shorter)
    strange = sorted({c.channel for c in columns} - {*_POINT, *_TURN, "residual", "cameras"})
    motion = MarkerMotion(
        tuple(name for name, _ in markers),
        rate,
        positions,
        _space(told, _length_unit(columns, told, warnings), positions, warnings),
        _start(told, 1),
        orientations=turns,
        residuals=residuals,
        cameras=cameras,
        labels=tuple(_events(told)),
        notes=_notes(told),
    )
    return Content(motion, tuple(warnings), tuple(f"columns .{name}" for name in strange))


def _grouped(columns: list[_Column]) -> list[tuple[str, dict[str, int]]]:
    """Markers, and where each has which channel; a channel that comes again starts another."""
    markers: list[tuple[str, dict[str, int]]] = []
    for index, column in enumerate(columns, start=1):
        if not markers or column.name != markers[-1][0] or column.channel in markers[-1][1]:
            markers.append((column.name, {}))
        markers[-1][1][column.channel] = index
    return markers


def _events(told: dict[str, object]) -> list[Label]:
    events = told.get("events")
    found = []
    for event in events if isinstance(events, list) else []:
        time = _finite(event[0]) if isinstance(event, list) and len(event) == 4 else None
        if time is not None:
            found.append(Label(time, *map(str, event[1:])))
    return found


def _joints(
    columns: list[_Column],
    table: Array,
    rate: float,
    told: dict[str, object],
    warnings: list[str],
    path: Path,
    line: int,
) -> Content:
    strange = next((column for column in columns if column.channel not in CHANNELS), None)
    if strange is not None:
        raise FormatError(
            f"the column {strange.name}.{strange.channel} is no joint's", path, line=line
        )
    if np.isnan(table).any():
        row = int(np.isnan(table).any(axis=1).argmax())
        raise FormatError(f"row {row + 1} of joint angles has a gap", path, line=line)
    channels: dict[str, list[str]] = {}
    order: dict[str, list[int]] = {}
    for index, column in enumerate(columns, start=1):
        channels.setdefault(column.name, []).append(column.channel)
        order.setdefault(column.name, []).append(index)
    angles = {column.unit for column in columns if column.unit in _ANGLES}
    if len(angles) > 1:
        raise FormatError("some angles are in deg and some in rad", path, line=line)
    metres = _length_unit(columns, told, warnings)
    up = told.get("up")
    space = Space(
        1.0 if metres is None else metres,
        cast(Literal["x", "y", "z"], up) if up in _POINT else "y",
        _ANGLES.get("".join(angles) or str(told.get("angle")), DEGREES),
    )
    joints = tuple(Joint(name, -1, channels=tuple(own)) for name, own in channels.items())
    values = table[:, [index for own in order.values() for index in own]]
    motion = SkeletonMotion(
        Skeleton(joints, space), rate, values, _start(told, 0), notes=_notes(told)
    )
    return Content(motion, (*warnings, "a table has no hierarchy: every joint is a root"))


def _marker_table(motion: MarkerMotion, unit: str) -> tuple[list[str], Array, list[str]]:
    parts = [motion.positions]
    channels = [f"{axis} [{unit}]" for axis in _POINT]
    if motion.orientations is not None:
        parts.append(motion.orientations)
        channels += _TURN
    if motion.residuals is not None:
        parts.append(np.asarray(motion.residuals, dtype=float)[..., None])
        channels.append(f"residual [{unit}]")
    if motion.cameras is not None:
        parts.append(motion.cameras.astype(float)[..., None])
        channels.append("cameras")
    table = np.concatenate(parts, axis=2).reshape(motion.frames, -1)
    names = [" ".join(name.split()) for name in motion.names]
    columns = [f"{name}.{channel}" for name in names for channel in channels]
    held = ("orientations", "residuals", "cameras", "labels", "gaps")
    return columns, table, left_out(motion, *held)


def _angle_name(space: Space) -> str | None:
    sizes = _ANGLES.items()
    return next((name for name, size in sizes if np.isclose(size, space.radians_per_unit)), None)


def _joint_table(
    motion: SkeletonMotion, unit: str, path: Path
) -> tuple[list[str], Array, list[str]]:
    joints = motion.skeleton.joints
    if not motion.frames or not motion.skeleton.width:
        raise FormatError("CSV needs one frame and one channel at least", path)
    angle = _angle_name(motion.skeleton.space)
    if angle is None:
        raise FormatError("CSV needs angles in degrees or radians", path)
    units = {"position": f" [{unit}]", "rotation": f" [{angle}]", "scale": ""}
    columns = [
        f"{' '.join(joint.name.split())}.{channel}{units[channel[1:]]}"
        for joint in joints
        for channel in joint.channels
    ]
    return columns, motion.values, ["the hierarchy, offsets and axes of the joints"]


def _sniff(start: bytes, what: Literal["markers", "joints"]) -> bool:
    """By our first line, or else by the names of the columns."""
    lines = start.decode("utf-8-sig", errors="replace").splitlines()
    if lines and lines[0].strip() in _FIRST.values():
        return lines[0].strip() == _FIRST[what]
    columns = next((line for line in lines if line.strip() and not line.startswith("#")), "")
    if not columns.lower().lstrip('"').startswith("time") or "," not in columns:
        return False
    joints = re.search(r"\.[XYZ](rotation|position|scale)\b", columns) is not None
    return joints if what == "joints" else not joints and re.search(r"\.x\b", columns) is not None


CSV_MARKERS = Format(
    "CSV", (".csv",), "markers", partial(_sniff, what="markers"), read_csv, write_csv
)
CSV_JOINTS = Format(
    "CSV of joints", (".csv",), "skeleton", partial(_sniff, what="joints"), read_csv, write_csv
)
