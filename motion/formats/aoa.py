"""AOA, marker files of Adaptive Optics Associates (ENACTIVE D.RD3.3.1 §2.5).

A comment, a line of counts, then a line a marker, frame after frame; markers have no names.
"""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from enpointe.errors import FormatError
from enpointe.files import write_text
from enpointe.motion.formats.columns import (
    column_table,
    number_text,
    plain_lines,
    settle_gaps,
)
from enpointe.motion.formats.content import Content, Format, Payload
from enpointe.motion.formats.fields import even_table
from enpointe.motion.formats.guessing import guessed_space
from enpointe.motion.formats.holding import left_out, lost_notes, markers_of
from enpointe.motion.formats.markers import MarkerMotion
from enpointe.motion.formats.text import CUT, decoded, finite_number, read_raw, whole_number

__all__ = ["AOA", "read_aoa", "write_aoa"]

_COUNTS = re.compile(
    r"\s*frames\s*=\s*(\S+)\s+n\w*markers\s*=\s*(\S+)\s+hz\s*=\s*(\S+)\s*", re.IGNORECASE
)
_COMMENT = "comment"


def read_aoa(path: Path) -> Content:
    """Read an AOA file. It names no unit, no axes and no markers, which are called 1, 2, ...

    Raises:
        FormatError: No AOA file, or one whose rows are no whole frames.
    """
    raw = plain_lines(read_raw(path))
    start = raw.find(b"\n", raw.find(b"\n") + 1) + 1 or len(raw)
    lines = decoded(raw[:start]).split("\n")
    counts = _COUNTS.fullmatch(lines[1]) if len(lines) > 1 else None
    if counts is None:
        raise FormatError(
            "the second line must say frames = ... nummarkers = ... hz = ...", path, line=2
        )
    declared = whole_number(counts[1], path, 2, "frames")
    markers = whole_number(counts[2], path, 2, "nummarkers")
    rate = finite_number(counts[3], path, 2, "hz")
    if not markers or rate <= 0:
        raise FormatError("nummarkers and hz must be above 0", path, line=2)
    comment = lines[0].strip()
    points = _rows(raw, start, path)
    whole, rest = divmod(len(points), markers)
    if not whole:
        last = 1 + raw.count(b"\n")
        raise FormatError(f"{len(points)} rows are no frame of {markers} markers", path, line=last)
    warnings: list[str] = []
    lost: list[str] = []
    if raw[raw.rfind(b"\n") + 1 :].strip():
        warnings.append(CUT)
    if whole != declared or rest:
        warnings.append(f"frames says {declared}, and there are {whole} whole ones")
    if rest:
        lost.append(f"{rest} markers of a frame that breaks off")
    positions = points[: whole * markers].reshape(whole, markers, 3)
    warnings += settle_gaps(positions)
    space, guesses = guessed_space(positions, "y", None, usual_metres=0.01)
    names = tuple(str(index) for index in range(1, markers + 1))
    notes = {_COMMENT: comment} if comment else {}
    motion = MarkerMotion(names, rate, positions, space, notes=notes)
    return Content(motion, (*warnings, *guesses), tuple(lost))


def _rows(raw: bytes, start: int, path: Path) -> NDArray[np.float64]:
    """The points below the head; line by line where there is something to tell."""
    even = even_table(raw, start, 3, None)
    if even is not None:
        return even
    return column_table(raw, 3, path, 3, "a marker", start=start)


def write_aoa(payload: Payload, path: Path) -> tuple[str, ...]:
    """Write an AOA file with the numbers as they are.

    Returns:
        What an AOA file can't hold.

    Raises:
        FormatError: No markers.
    """
    motion = markers_of(payload, path, "AOA")
    comment = " ".join(motion.notes.get(_COMMENT, "markers").split())
    head = (
        f"frames = {motion.frames} nummarkers = {len(motion.names)} hz = {number_text(motion.rate)}"
    )
    rows = (
        " ".join(number_text(coordinate) or "NaN" for coordinate in point)
        for frame in motion.positions.tolist()
        for point in frame
    )
    write_text(path, "\n".join([comment or "markers", head, *rows]) + "\n")
    lost = left_out(motion)
    lost.append("the unit of length and the upward axis, which AOA does not name")
    if motion.names != tuple(str(index) for index in range(1, len(motion.names) + 1)):
        lost.append("names of the markers")
    if motion.start != 1:
        lost.append(f"the first frame's number {motion.start}")
    return (*lost, *lost_notes(motion, _COMMENT))


def _sniff(start: bytes) -> bool:
    lines = start.decode("latin-1").replace("\r\n", "\n").replace("\r", "\n").split("\n")
    return len(lines) > 1 and _COUNTS.fullmatch(lines[1]) is not None


AOA = Format("AOA", (".aoa",), "markers", _sniff, read_aoa, write_aoa)
