"""TRC, Motion Analysis' marker files, as OpenSim, MOTEK and others write them.

ENACTIVE D.RD3.3.1 §2.9 prints one. Real files part their columns by tabs and leave gaps blank.
What we write has the eight keys and the exact columns that OpenSim's strict reader asks for
(TRCFileAdapter.cpp of opensim-core).
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from enpointe.errors import FormatError
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
from enpointe.motion.formats.holding import left_out, lost_notes, markers_of, plain_names
from enpointe.motion.formats.markers import MarkerMotion
from enpointe.motion.formats.text import decoded, finite_number, read_raw

__all__ = ["TRC", "read_trc", "write_trc"]

Array = NDArray[np.float64]
_KEYS = (
    "DataRate",
    "CameraRate",
    "NumFrames",
    "NumMarkers",
    "Units",
    "OrigDataRate",
    "OrigDataStartFrame",
    "OrigNumFrames",
)
_HEADER_WITHIN = 12
_LABEL = re.compile(r"[XYZ]\d+", re.IGNORECASE)
_TIME_TOLERANCE = 0.02
_FIRST_TIME = "time of the first frame"


def read_trc(path: Path) -> Content:
    """Read a TRC file.

    Names, not NumMarkers, say how many markers there are; rows, not NumFrames, how many frames.

    Raises:
        FormatError: No TRC file, or one with a line that can't be told.
    """
    raw = plain_lines(read_raw(path))
    lines = decoded(b"\n".join(raw.split(b"\n", _HEADER_WITHIN)[:_HEADER_WITHIN])).split("\n")
    head = _head(lines, path)
    warnings, lost = list(head.warnings), []
    rows = delimited_rows(
        raw, head.first_row, head.width, head.delimiter, path, "a frame", needed=2
    )
    table = rows.table
    if rows.longer:
        lost.append(f"points without a name at the end of {rows.longer} rows")
    if not len(table):
        raise FormatError("there are no frames after the header", path, line=head.first_row)
    warnings += _doubts(table, head)
    positions = table[:, 2:].reshape(len(table), len(head.names), 3)
    warnings += [*rows.warnings, *settle_gaps(positions, rows.shorter)]
    space, guesses = guessed_space(positions, "y", head.metres)
    start = _start(table[0, 0], path, head.first_row + 1)
    notes = dict(head.notes)
    if not np.isclose(table[0, 1] * head.rate, start - 1, atol=0.5):
        notes[_FIRST_TIME] = number_text(table[0, 1])
    motion = MarkerMotion(head.names, head.rate, positions, space, start, notes=notes)
    return Content(motion, (*warnings, *guesses), tuple(lost))


def write_trc(payload: Payload, path: Path) -> tuple[str, ...]:
    """Write a TRC file with the numbers as they are.

    Returns:
        What a TRC file can't hold.

    Raises:
        FormatError: No markers, or a unit that has no name.
    """
    motion = markers_of(payload, path, "TRC")
    unit = unit_name(motion.space.metres_per_unit)
    if unit is None:
        raise FormatError("TRC needs a unit with a name: mm, cm, m, in", path)
    names, changed = plain_names(motion.names, lambda name: " ".join(name.split()))
    lines = [*_written_head(motion, names, unit, path.name), ""]
    first = float(motion.notes.get(_FIRST_TIME, (motion.start - 1) / motion.rate))
    for index, row in enumerate(motion.positions.reshape(motion.frames, -1).tolist()):
        time = number_text(round(first + index / motion.rate, 9))
        fields = [str(motion.start + index), time, *map(number_text, row)]
        # Readers that drop blanks at a line's end would find it too short.
        fields[-3:] = [field or "NaN" for field in fields[-3:]]
        lines.append("\t".join(fields))
    write_text(path, "\n".join(lines) + "\n")
    notes = lost_notes(motion, "PathFileType", _FIRST_TIME, *_KEYS)
    return (*left_out(motion, "gaps"), *changed, *notes)


def _sniff(start: bytes) -> bool:
    return start.lstrip(b"\xef\xbb\xbf \t\r\n").startswith(b"PathFileType")


@dataclass(frozen=True, slots=True)
class _Head:
    names: tuple[str, ...]
    rate: float
    metres: float | None
    delimiter: str | None
    first_row: int
    notes: dict[str, str]
    warnings: tuple[str, ...]
    frames: int | None

    @property
    def width(self) -> int:
        return 2 + 3 * len(self.names)


def _head(lines: list[str], path: Path) -> _Head:
    if lines[0].split()[:1] != ["PathFileType"]:
        parted = lines[0].startswith("PathFileType")
        why = "columns must be parted by tabs" if parted else "a TRC file starts with PathFileType"
        raise FormatError(why, path, line=1)
    at = next(
        (i for i, line in enumerate(lines[:_HEADER_WITHIN]) if line.split()[:1] == ["Frame#"]), None
    )
    if at is None or at < 2:
        raise FormatError(
            "no line of names, which starts with Frame#", path, line=min(len(lines), 4)
        )
    values = _values(lines[at - 2], lines[at - 1], path, at)
    names = _names(lines[at], path, at + 1)
    first_row = at + 1
    while first_row < len(lines) and _is_label_row(lines[first_row]):
        first_row += 1
    warnings = []
    declared = values.get("NumMarkers")
    if declared is not None and declared != str(len(names)):
        warnings.append(f"NumMarkers says {declared}, and {len(names)} markers have names")
    rate = finite_number(values.get("DataRate", ""), path, at, "DataRate")
    if rate <= 0:
        raise FormatError(f"DataRate must be above 0, got {rate:g}", path, line=at)
    unit = values.get("Units", "")
    metres = UNITS.get(unit.lower())
    if unit and metres is None:
        warnings.append(f"the unit {unit[:20]!r} is not known")
    frames = values.get("NumFrames", "")
    return _Head(
        names,
        rate,
        metres,
        "\t" if "\t" in lines[at] else None,
        first_row,
        _notes(lines[0], values),
        tuple(warnings),
        int(frames) if frames.isdecimal() and len(frames) < 12 else None,
    )


def _values(keys: str, values: str, path: Path, line: int) -> dict[str, str]:
    names, tokens = keys.split(), values.split()
    if len(tokens) < len(names):
        raise FormatError(f"{len(names)} keys have {len(tokens)} values", path, line=line)
    return dict(zip(names, tokens, strict=False))


def _names(line: str, path: Path, number: int) -> tuple[str, ...]:
    if line.count("\t") > 3 * MOST_MARKERS or len(line) > 40 * MOST_MARKERS:
        raise FormatError(f"more than {MOST_MARKERS} markers", path, line=number)
    fields = line.split("\t") if "\t" in line else line.split()
    names = tuple(field.strip() for field in fields[2:] if field.strip())
    if not names:
        raise FormatError("no marker has a name", path, line=number)
    return names


def _is_label_row(line: str) -> bool:
    """X1 Y1 Z1 ..., or nothing."""
    tokens = line.split()
    return all(_LABEL.fullmatch(token) for token in tokens)


def _notes(first: str, values: dict[str, str]) -> dict[str, str]:
    parts = first.split("\t") if "\t" in first else first.split(None, 3)
    named = {"PathFileType": " ".join(part.strip() for part in parts[3:]).strip()}
    kept = ("CameraRate", "OrigDataRate", "OrigDataStartFrame", "OrigNumFrames")
    named |= {key: values[key] for key in kept if key in values}
    return {key: value for key, value in named.items() if value}


def _doubts(table: Array, head: _Head) -> list[str]:
    found = []
    if head.frames is not None and head.frames != len(table):
        found.append(f"NumFrames says {head.frames}, and there are {len(table)} rows")
    if len(table) > 1:
        if (np.diff(table[:, 0]) != 1).any():
            found.append("frame numbers do not count up by one; the rows are taken in their order")
        steps = np.diff(table[:, 1]) * head.rate
        if abs(float(np.mean(steps)) - 1) > _TIME_TOLERANCE:
            found.append(f"times do not go by DataRate {head.rate:g}; DataRate is taken")
    return found


def _start(number: float, path: Path, line: int) -> int:
    if not number.is_integer() or abs(number) > 1e9:
        raise FormatError(f"a frame's number must be whole, got {number:g}", path, line=line)
    return int(number)


def _written_head(motion: MarkerMotion, names: tuple[str, ...], unit: str, file: str) -> list[str]:
    rate, count = number_text(motion.rate), str(motion.frames)
    values = {
        "DataRate": rate,
        "CameraRate": motion.notes.get("CameraRate", rate),
        "NumFrames": count,
        "NumMarkers": str(len(names)),
        "Units": unit,
        "OrigDataRate": motion.notes.get("OrigDataRate", rate),
        "OrigDataStartFrame": motion.notes.get("OrigDataStartFrame", str(motion.start)),
        "OrigNumFrames": motion.notes.get("OrigNumFrames", count),
    }
    labels = [f"{axis}{i}" for i in range(1, len(names) + 1) for axis in "XYZ"]
    return [
        "\t".join(["PathFileType", "4", "(X/Y/Z)", motion.notes.get("PathFileType", file)]),
        "\t".join(_KEYS),
        "\t".join(values[key] for key in _KEYS),
        "\t".join(["Frame#", "Time", "\t\t\t".join(names)]) + "\t\t",
        "\t".join(["", "", *labels]),
    ]


TRC = Format("TRC", (".trc",), "markers", _sniff, read_trc, write_trc)
