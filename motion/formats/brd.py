"""BRD, LambSoft's files of the magnetic trackers Flock of Birds (ENACTIVE D.RD3.3.1 §2.7).

A row a marker: sample, marker, P, position, Q, quaternion, and perhaps the time in seconds and
microseconds. The bird's own order of a quaternion, q0 first, is taken for w x y z, and its unit,
the inch, where the points do not tell another (Ascension, Flock of Birds guide, QUATERNION).
"""

from __future__ import annotations

import io
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from enpointe.errors import FormatError
from enpointe.files import write_text
from enpointe.motion.formats.columns import (
    line_blocks,
    lines_table,
    number_text,
    plain_lines,
)
from enpointe.motion.formats.content import Content, Format, Payload
from enpointe.motion.formats.fields import loaded_table
from enpointe.motion.formats.guessing import guessed_space
from enpointe.motion.formats.holding import left_out, lost_notes, markers_of
from enpointe.motion.formats.markers import MarkerMotion
from enpointe.motion.formats.numbers import blocks, tokens
from enpointe.motion.formats.text import CUT, read_raw

__all__ = ["BRD", "read_brd", "write_brd"]

Array = NDArray[np.float64]
_TIMED, _UNTIMED = 13, 11
_LETTERS = [2, 6]
_NEEDED = 5
_USUAL_RATE = 30.0
_INCH = 0.0254
_FIRST_TIME = "time of the first sample"
_EMPTY_CELLS = 4
"""How many cells of the table of samples and markers may be empty for each that is not."""


def read_brd(path: Path) -> Content:
    """Read a BRD file. Markers are called by their numbers; the rate comes from the times.

    Raises:
        FormatError: No BRD file, a row that can't be told, or a marker twice in a sample.
    """
    raw = plain_lines(read_raw(path))
    cut = bool(raw[raw.rfind(b"\n") + 1 :].strip())
    table = _even_rows(raw)
    if table is None:
        table = _rows(raw, path)
    del raw
    timed = table.shape[1] == _TIMED - len(_LETTERS)
    _check(table, timed, path)
    samples, rows = np.unique(table[:, 0], return_inverse=True)
    markers, columns = np.unique(table[:, 1], return_inverse=True)
    cells = len(samples) * len(markers)
    if cells > (_EMPTY_CELLS + 1) * len(table) + 4096:
        raise FormatError(
            f"{len(table)} rows are too few for {len(samples)} samples of {len(markers)} markers",
            path,
            line=1,
        )
    taken = np.bincount(rows * len(markers) + columns, minlength=cells)
    if (taken > 1).any():
        sample = samples[int(taken.argmax()) // len(markers)]
        raise FormatError(f"a marker stands twice in sample {sample:g}", path, line=1)
    positions = np.full((len(samples), len(markers), 3), np.nan)
    orientations = np.full((len(samples), len(markers), 4), np.nan)
    positions[rows, columns] = table[:, 2:5]
    orientations[rows, columns] = table[:, 5:9]
    warnings: list[str] = []
    lost: list[str] = []
    if cut:
        warnings.append(CUT)
    if (np.diff(samples) != 1).any():
        warnings.append("sample numbers do not count up by one; the samples are taken in order")
    times = table[:, 9] + table[:, 10] * 1e-6 if timed else None
    rate = _rate(times, rows, warnings, lost)
    space, guesses = guessed_space(positions, "z", None, usual_metres=_INCH)
    names = tuple(str(int(marker)) for marker in markers)
    notes = {}
    if times is not None and times[0]:
        notes[_FIRST_TIME] = f"{int(table[0, 9])} {int(table[0, 10])}"
    motion = MarkerMotion(
        names, rate, positions, space, int(samples[0]), orientations=orientations, notes=notes
    )
    return Content(motion, (*warnings, *guesses), tuple(lost))


def write_brd(payload: Payload, path: Path) -> tuple[str, ...]:
    """Write a BRD file with the numbers as they are; a marker that was not seen has no row.

    Returns:
        What a BRD file can't hold.

    Raises:
        FormatError: No markers, or none that was ever seen.
    """
    motion = markers_of(payload, path, "BRD")
    if not motion.seen.any():
        raise FormatError("BRD needs a marker that was seen", path)
    lost = left_out(motion, "orientations", "gaps")
    numbers = _marker_numbers(motion.names)
    if numbers is None:
        lost.append("names of the markers")
        numbers = tuple(range(len(motion.names)))
    turned = motion.orientations
    if turned is None:
        turned = np.broadcast_to([1.0, 0.0, 0.0, 0.0], (*motion.positions.shape[:2], 4))
        lost.append("that the markers have no orientations; all are written as 1 0 0 0")
    if not motion.seen.any(axis=0).all() or not motion.seen.any(axis=1).all():
        lost.append("markers and samples of which nothing was seen")
    first = _microseconds(motion.notes.get(_FIRST_TIME, ""))
    lines = []
    for index in range(motion.frames):
        seconds, micro = divmod(first + round(index * 1e6 / motion.rate), 1_000_000)
        for number, point, turn, seen in zip(
            numbers, motion.positions[index], turned[index], motion.seen[index], strict=True
        ):
            if seen:
                place = " ".join(map(number_text, point.tolist()))
                way = " ".join(number_text(part) or "nan" for part in turn.tolist())
                lines.append(f"{motion.start + index} {number} P {place} Q {way} {seconds} {micro}")
    write_text(path, "\n".join(lines) + "\n")
    lost.append("the unit of length and the upward axis, which BRD does not name")
    return (*lost, *lost_notes(motion, _FIRST_TIME))


def _sniff(start: bytes) -> bool:
    first = start.lstrip(b"\xef\xbb\xbf \t\r\n").split(b"\n", 1)[0].split()
    return len(first) in (_TIMED, _UNTIMED) and first[2:3] == [b"P"] and first[6:7] == [b"Q"]


def _even_rows(raw: bytes) -> Array | None:
    """Numbers of all rows, the letters left out, block by block; None where rows differ in kind."""
    # A row has a byte and a blank for each word: never more room than there is text.
    most = min(raw.count(b"\n"), len(raw) // (2 * _UNTIMED)) + 1
    table, filled = np.empty((0, 0)), 0
    for block in blocks(raw):
        words = tokens(block)
        counts = words.per_line()
        counts = counts[counts > 0]
        if not len(counts):
            continue
        width = int(counts[0])
        if width not in (_TIMED, _UNTIMED) or (counts != width).any():
            return None
        if not filled:
            table = np.empty((most, width - len(_LETTERS)))
        letters = words.starts.reshape(-1, width)[:, _LETTERS]
        long = words.ends.reshape(-1, width)[:, _LETTERS] - letters != 1
        if long.any() or (words.data[letters] != list(b"PQ")).any():
            return None
        plain = words.data.copy()
        plain[letters] = ord(" ")
        part = loaded_table(io.BytesIO(plain.tobytes()), table.shape[1], None)
        if part is None or len(part) != len(counts) or np.isinf(part).any():
            return None
        if np.isnan(part[:, :_NEEDED]).any():
            return None
        table[filled : filled + len(part)] = part
        filled += len(part)
    return table[:filled] if filled else None


def _rows(raw: bytes, path: Path) -> Array:
    """Numbers of all rows, the letters left out, and of the times too where a row has none."""
    timed = True
    for first, lines in line_blocks(raw, 0, 1):
        for number, line in enumerate(lines, start=first):
            tokens = line.split()
            if tokens and (
                len(tokens) not in (_TIMED, _UNTIMED) or (tokens[2], tokens[6]) != ("P", "Q")
            ):
                raise FormatError(
                    "a row needs: sample marker P x y z Q w x y z, and perhaps the time",
                    path,
                    line=number,
                )
            timed &= not tokens or len(tokens) == _TIMED
    width = (_TIMED if timed else _UNTIMED) - len(_LETTERS)
    tables = [np.empty((0, width))]
    for first, lines in line_blocks(raw, 0, 1):
        rows = [" ".join(_numbers(line.split())[:width]) for line in lines]
        tables.append(lines_table(rows, width, path, first, "a row", needed=_NEEDED))
    table = np.concatenate(tables)
    if not len(table):
        raise FormatError("there are no rows", path, line=1)
    return table


def _numbers(tokens: list[str]) -> list[str]:
    return [token for index, token in enumerate(tokens) if index not in _LETTERS]


def _check(table: Array, timed: bool, path: Path) -> None:
    numbers = table[:, :2]
    if (numbers != np.floor(numbers)).any() or (np.abs(numbers) > 1e9).any():
        row = int(np.argmax((numbers != np.floor(numbers)).any(axis=1)))
        raise FormatError("samples and markers must have whole numbers", path, line=row + 1)
    if timed and (np.isnan(table[:, 9:]).any() or (np.abs(table[:, 9:]) > 1e12).any()):
        raise FormatError("a time must be seconds and microseconds", path, line=1)


def _rate(
    times: Array | None, rows: NDArray[np.intp], warnings: list[str], lost: list[str]
) -> float:
    """Samples per second: the roundest that gives all times to the microsecond."""
    if times is None or rows.max() == 0:
        if times is None or rows.max() > 0:
            warnings.append(f"the file has no times; {_USUAL_RATE:g} samples a second are taken")
        return _USUAL_RATE
    since, samples = times - times[rows == 0].min(), rows.astype(float)
    period = float(since @ samples) / float(samples @ samples)
    if not 1e-6 < period < 1e6:
        warnings.append(f"the times do not go forward; {_USUAL_RATE:g} samples a second are taken")
        return _USUAL_RATE
    for digits in range(7):
        rate = round(1 / period, digits)
        if rate > 0 and np.abs(since - samples / rate).max() <= 2e-6:
            return rate
    worst = float(np.abs(since - samples * period).max())
    lost.append(f"times that differ by up to {worst:.6f} s from even sampling")
    return 1 / period


def _marker_numbers(names: tuple[str, ...]) -> tuple[int, ...] | None:
    if not all(name.isdecimal() and len(name) < 10 for name in names):
        return None
    numbers = tuple(map(int, names))
    return numbers if len(set(numbers)) == len(numbers) else None


def _microseconds(text: str) -> int:
    parts = text.split()
    if len(parts) != 2 or not all(part.isdecimal() for part in parts):
        return 0
    return int(parts[0]) * 1_000_000 + int(parts[1])


BRD = Format("BRD", (".brd",), "markers", _sniff, read_brd, write_brd)
