"""CSM, Character Studio's marker files (ENACTIVE D.RD3.3.1 §2.10).

Sections that start with $: the first and last frame, the rate, the order of the markers, and the
points, a row a frame. The word DROPOUT stands for the three numbers of a marker that was not seen:
so assimp reads it (code/AssetLib/CSM/CSMLoader.cpp), after the format's own document.
"""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from enpointe.errors import FormatError
from enpointe.files import write_text
from enpointe.motion.formats.columns import (
    MOST_MARKERS,
    column_table,
    number_text,
    plain_lines,
    settle_gaps,
)
from enpointe.motion.formats.content import Content, Format, Payload
from enpointe.motion.formats.fields import even_table
from enpointe.motion.formats.guessing import guessed_space
from enpointe.motion.formats.holding import left_out, markers_of, plain_names
from enpointe.motion.formats.markers import MarkerMotion
from enpointe.motion.formats.numbers import blocks
from enpointe.motion.formats.text import (
    CUT,
    decoded,
    finite_number,
    number_block,
    read_raw,
    whole_number,
)

__all__ = ["CSM", "read_csm", "write_csm"]

_NAME = re.compile(r"[A-Za-z]+")
_KEY = re.compile(r"\$([A-Za-z]+)[ \t]*(.*)")
_USUAL_RATE = 30.0
_TOLD = frozenset({"firstframe", "lastframe", "rate", "order", "points"})
_DROPOUT = re.compile(rb"\bdropout\b", re.IGNORECASE)
_GAP = re.compile(rb"dropout|nan", re.IGNORECASE)
_POINTS = re.compile(rb"^[ \t]*\$points[^\n]*\n?", re.IGNORECASE | re.MULTILINE)


def read_csm(path: Path) -> Content:
    """Read a CSM file. It names no unit and no axes: they are guessed from the points.

    Raises:
        FormatError: No CSM file, or one with a row that does not fit its markers.
    """
    raw = plain_lines(read_raw(path))
    points = _POINTS.search(raw)
    head = decoded(raw[: points.end()] if points else raw).split("\n")
    sections, at = _sections(head, path)
    order = " ".join(sections.get("order", (0, []))[1])
    if len(order) > 40 * MOST_MARKERS:
        raise FormatError(f"more than {MOST_MARKERS} markers", path, line=at)
    names = tuple(order.split())
    if not names:
        raise FormatError("no markers after $Order", path, line=at)
    table = _table(raw, at, 1 + 3 * len(names), path)
    if not len(table):
        raise FormatError("no points after $Points", path, line=at)
    rate, warnings = _rate(sections, path)
    if not raw.endswith(b"\n"):
        warnings.append(CUT)
    warnings += _doubts(sections, table[:, 0], path)
    if not table[0, 0].is_integer() or abs(table[0, 0]) > 1e9:
        raise FormatError("a frame's number must be whole", path, line=at + 1)
    positions = table[:, 1:].reshape(len(table), len(names), 3)
    warnings += settle_gaps(positions)
    space, guesses = guessed_space(positions, "z", None)
    kept = {key: _said(said) for key, (_, said) in sections.items() if key not in _TOLD}
    notes = {key: value for key, value in kept.items() if value}
    motion = MarkerMotion(names, rate, positions, space, int(table[0, 0]), notes=notes)
    return Content(motion, (*warnings, *guesses))


def write_csm(payload: Payload, path: Path) -> tuple[str, ...]:
    """Write a CSM file with the numbers as they are.

    Returns:
        What a CSM file can't hold.

    Raises:
        FormatError: No markers.
    """
    motion = markers_of(payload, path, "CSM")
    names, changed = plain_names(motion.names, _name)
    lines = []
    for key, value in motion.notes.items():
        if _NAME.fullmatch(key) and key.lower() not in _TOLD:
            lines += _section(key, value)
        else:
            changed.append(f"the note {key!r}")
    lines += [
        f"$FirstFrame {motion.start}",
        f"$LastFrame {motion.start + motion.frames - 1}",
        f"$Rate {number_text(motion.rate)}",
        "",
        "$Order",
        " ".join(names),
        "",
        "$Points",
    ]
    for index, frame in enumerate(motion.positions.tolist(), start=motion.start):
        points = (
            "DROPOUT" if _gap(point) else " ".join(map(number_text, point)) for point in frame
        )
        lines.append(f"{index}\t" + "\t".join(points))
    write_text(path, "\n".join(lines) + "\n")
    lost = [line.replace("NaN", "DROPOUT") if "gaps" in line else line for line in left_out(motion)]
    lost.append("the unit of length and the upward axis, which CSM does not name")
    return (*lost, *changed)


def _sniff(start: bytes) -> bool:
    lower = start.lower()
    return lower.lstrip(b"\xef\xbb\xbf \t\r\n").startswith(b"$") and (
        b"$order" in lower or b"$firstframe" in lower or b"$points" in lower
    )


def _sections(lines: list[str], path: Path) -> tuple[dict[str, tuple[int, list[str]]], int]:
    """What stands behind and below each key before $Points, and the line of the first point."""
    found: dict[str, tuple[int, list[str]]] = {}
    said: list[str] = []
    for number, line in enumerate(lines, start=1):
        key = _KEY.match(line.strip())
        if key is None:
            if number == 1 or not found:
                if line.strip():
                    raise FormatError(
                        "a CSM file starts with a key like $Comments", path, line=number
                    )
                continue
            said.append(line.strip())
            continue
        name = key[1].lower()
        if name == "points":
            return found, number
        said = [key[2].strip()]
        found[name] = (number, said)
    raise FormatError("there is no $Points", path, line=len(lines))


def _table(raw: bytes, skipped: int, width: int, path: Path) -> NDArray[np.float64]:
    """The rows, with three gaps for each dropout."""
    start = 0
    for _ in range(skipped):
        start = raw.find(b"\n", start) + 1 or len(raw)
    table = even_table(raw, start, width, None)
    if table is not None and np.isfinite(table).all():
        return table
    if not _GAP.search(raw, start):
        return number_block(raw, width, path, skipped + 1, "a frame", start)
    tables, line = [np.empty((0, width))], skipped + 1
    for block in blocks(raw, start):
        rows = _DROPOUT.sub(b" nan nan nan ", block)
        tables.append(column_table(rows, width, path, line, "a frame", needed=1))
        line += block.count(b"\n")
    return np.concatenate(tables)


def _rate(sections: dict[str, tuple[int, list[str]]], path: Path) -> tuple[float, list[str]]:
    if "rate" not in sections:
        return _USUAL_RATE, [f"the file names no rate; {_USUAL_RATE:g} frames a second are taken"]
    line, said = sections["rate"]
    rate = finite_number(_said(said), path, line, "$Rate")
    if rate <= 0:
        raise FormatError(f"$Rate must be above 0, got {rate:g}", path, line=line)
    return rate, []


def _doubts(
    sections: dict[str, tuple[int, list[str]]], numbers: NDArray[np.float64], path: Path
) -> list[str]:
    found = []
    told = {
        key: whole_number(_said(sections[key][1]), path, sections[key][0], f"${key}")
        for key in ("firstframe", "lastframe")
        if key in sections
    }
    first, last = (told.get(key) for key in ("firstframe", "lastframe"))
    if first is not None and first != numbers[0]:
        found.append(f"$FirstFrame says {first}, the first row {numbers[0]:g}; the row is taken")
    if first is not None and last is not None and last - first + 1 != len(numbers):
        found.append(f"$LastFrame says {last - first + 1} frames, and there are {len(numbers)}")
    if (np.diff(numbers) != 1).any():
        found.append("frame numbers do not count up by one; the rows are taken in their order")
    return found


def _said(said: list[str]) -> str:
    return "\n".join(said).strip()


def _section(key: str, value: str) -> list[str]:
    """A value of one line stands behind its key, a longer one below it."""
    plain = ["_" + line if line.startswith("$") else line for line in value.split("\n")]
    return [f"${key} {plain[0]}"] if len(plain) == 1 else [f"${key}", *plain, ""]


def _name(name: str) -> str:
    return "_".join(name.replace("$", "_").split())


def _gap(point: list[float]) -> bool:
    return not all(coordinate == coordinate for coordinate in point)


CSM = Format("CSM", (".csm",), "markers", _sniff, read_csm, write_csm)
