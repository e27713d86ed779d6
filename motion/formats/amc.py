"""AMC: Acclaim's movement of a skeleton that an ASF file beside it describes.

ENACTIVE D.RD3.3.1 section 2.6.4. A frame is its number on a line and a line for each bone that
moves, with its angles in the order of its `dof`. The rate is nowhere in the file.
"""

from __future__ import annotations

from array import array
from collections.abc import Iterator
from dataclasses import dataclass, replace
from math import isfinite
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from enpointe.errors import FormatError
from enpointe.motion.formats.asf import Figure, read_figure
from enpointe.motion.formats.asf_writing import as_figure, asf_lines, held
from enpointe.motion.formats.content import Content, Format, Payload
from enpointe.motion.formats.numbers import Spelled, blocks, parsed, tokens
from enpointe.motion.formats.skeleton import Skeleton, SkeletonMotion
from enpointe.motion.formats.space import DEGREES
from enpointe.motion.formats.text import CUT, decoded, finite_number, read_raw, refuse_merge_marks
from enpointe.motion.formats.writing import skeleton_of, unheld, write_lines

__all__ = ["AMC", "RATE", "companion", "read_amc"]

RATE = 120.0
"""Frames a second of most of CMU's captures, which their files do not say."""

_HEADER = ":amc"
_DEGREES, _RADIANS = ":degrees", ":radians"
_LARGEST_FRAME = 10**9
_LONGEST_NAME = 64
# Bones without a line take room in every frame; a file of nothing else would fill the memory.
_SPARSEST = 8


@dataclass(frozen=True)
class _Pattern:
    """How the lines of a frame follow one another: names, and how many numbers each has."""

    names: tuple[str, ...]
    counts: tuple[int, ...]

    @property
    def words(self) -> int:
        """Words of a frame, its number included."""
        return 1 + sum(1 + count for count in self.counts)


def _sniff(head: bytes) -> bool:
    words = [line.strip().lower() for line in head.split(b"\n")]
    flags = (b":fully-specified", b":degrees", b":radians")
    return any(word in flags for word in words)


def companion(path: Path) -> Path:
    """The ASF file that belongs to an AMC file.

    Its name with another ending, the subject's ("05.asf" to "05_14.amc"), or the only one there.

    Raises:
        FormatError: There is none, or there are several of other names.
    """
    try:
        beside = sorted(each for each in path.parent.iterdir() if each.suffix.lower() == ".asf")
    except OSError:
        beside = []
    for stem in (path.stem, path.stem.partition("_")[0]):
        for each in beside:
            if each.stem.lower() == stem.lower():
                return each
    if len(beside) == 1:
        return beside[0]
    there = ", ".join(each.name for each in beside[:5]) or "none"
    raise FormatError(
        f"needs its skeleton: put {path.stem.partition('_')[0]}.asf beside it (there: {there})",
        path,
        line=1,
    )


def _read(path: Path) -> Content:
    return read_amc(path, companion(path))


def read_amc(path: Path, skeleton: Path, rate: float | None = None) -> Content:
    """Reads a movement of a skeleton that lies anywhere.

    Args:
        path: The AMC file.
        skeleton: The ASF file.
        rate: Frames a second; None takes `RATE` and warns.

    Raises:
        FormatError: One of them is not whole, or they don't belong together; with the line.
    """
    found = read_figure(skeleton)
    raw = read_raw(path)
    if b"\r" in raw and raw.count(b"\r") != raw.count(b"\r\n"):
        raw = raw.replace(b"\r\n", b"\n").replace(b"\r", b"\n")
    flags, start, line = _header(raw, path)
    warnings = list(found.warnings)
    if rate is None:
        warnings.append(f"no rate in the file: {RATE:g} frames a second taken")
    body = _Body(found.skeleton, raw, start, line, path)
    values, first, more = body.read()
    posed = _with_angles(found, flags)
    notes = {**found.notes, _HEADER: "\n".join(flags)}
    motion = SkeletonMotion(posed, rate or RATE, values, start=first, notes=notes)
    return Content(motion, (*warnings, *more), found.lost)


def _with_angles(found: Figure, flags: list[str]) -> Skeleton:
    """The skeleton with its angles in the movement's unit, which may be another than its own."""
    words = [flag.lower() for flag in flags]
    own = found.notes.get(":units angle", "deg").lower()
    skeleton = found.skeleton
    radians = _RADIANS in words or (_DEGREES not in words and own.startswith("rad"))
    if not radians:
        return skeleton
    scale = 1.0 if own.startswith("rad") else DEGREES
    joints = tuple(
        replace(joint, limits=tuple((low * scale, high * scale) for low, high in joint.limits))
        for joint in skeleton.joints
    )
    return replace(skeleton, joints=joints, space=replace(skeleton.space, radians_per_unit=1.0))


def _header(raw: bytes, path: Path) -> tuple[list[str], int, int]:
    """Comments and flags, and where (byte, line) the first frame starts."""
    flags: list[str] = []
    start = line = 0
    while start < len(raw):
        line += 1
        end = raw.find(b"\n", start)
        end = len(raw) if end < 0 else end
        text = decoded(raw[start:end]).strip()
        if text and not text.startswith(("#", ":")):
            refuse_merge_marks(text, path, line)
            return flags, start, line
        if text:
            flags.append(text)
        start = end + 1
    raise FormatError("there are no frames", path, line=max(line, 1))


class _Body:
    """The frames of an AMC file."""

    def __init__(self, skeleton: Skeleton, raw: bytes, start: int, line: int, path: Path) -> None:
        self.skeleton, self.raw, self.start = skeleton, raw, start
        self.line, self.path = line, path
        self.places = {
            joint.name: skeleton.columns(index)
            for index, joint in enumerate(skeleton.joints)
            if joint.channels
        }

    def read(self) -> tuple[NDArray[np.float64], int, list[str]]:
        """(T, width) values, the first frame's number, and warnings."""
        warnings: list[str] = []
        names = self.first_names()
        if self.skeleton.width > _SPARSEST * max(1, sum(names.values())):
            raise self.error(
                "hardly any bone of the skeleton has a line: is it another's?", self.line
            )
        quick = self.quickly(names)
        table, first = quick if quick is not None else self.line_by_line(warnings)
        absent = [name for name in self.places if name not in names]
        if absent and len(table) == 1:
            line = self.line + self.raw.count(b"\n", self.start)
            raise self.error(f"the only frame lacks {absent[0]!r}: is the file whole?", line)
        if absent:
            warnings.append(f"bones at rest that have no line: {' '.join(absent)[:200]}")
        if not self.raw.endswith(b"\n") and len(table) > 1:
            table = table[:-1]
            warnings.append("the file ends within a line: its last frame is left out")
        elif not self.raw.endswith(b"\n"):
            warnings.append(CUT)
        return table, first, warnings

    def first_names(self) -> dict[str, int]:
        """Names of the first frame's lines and how many numbers each has."""
        names: dict[str, int] = {}
        for number, (_, words) in enumerate(self.lines()):
            if number and len(words) == 1:
                break
            if number and words[0] not in names:
                names[words[0]] = len(words) - 1
            if number > len(self.places):
                break
        return names

    def lines(self) -> Iterator[tuple[int, list[str]]]:
        start, line = self.start, self.line
        while start < len(self.raw):
            end = self.raw.find(b"\n", start)
            end = len(self.raw) if end < 0 else end
            words = decoded(self.raw[start:end]).split()
            if words and not words[0].startswith("#"):
                yield line, words
            start = end + 1
            line += 1

    def quickly(self, names: dict[str, int]) -> tuple[NDArray[np.float64], int] | None:
        """All frames, where each has the same lines as the first; else None."""
        if (
            not names
            or max(map(len, names)) > _LONGEST_NAME
            or any(name not in self.places for name in names)
            or any(
                self.places[name].stop - self.places[name].start != count
                for name, count in names.items()
            )
        ):
            return None
        pattern = _Pattern(tuple(names), tuple(names.values()))
        table = _quick_table(self.raw, self.start, pattern)
        if table is None:
            return None
        numbers = table[:, 0]
        if not 0 <= numbers[0] <= _LARGEST_FRAME or not np.array_equal(
            numbers, np.arange(len(numbers)) + int(numbers[0])
        ):
            return None
        columns = [np.arange(self.places[name].start, self.places[name].stop) for name in names]
        values = np.zeros((len(table), self.skeleton.width))
        values[:, np.concatenate(columns)] = table[:, 1:]
        return values, int(numbers[0])

    def line_by_line(self, warnings: list[str]) -> tuple[NDArray[np.float64], int]:
        """All frames, however their lines stand, or where they are wrong."""
        kept, row = array("d"), [0.0] * self.skeleton.width
        expected: set[str] | None = None
        seen: set[str] = set()
        first = number = -1
        began = self.line
        for line, words in self.lines():
            if len(words) > 1 or words[0] in self.places:
                if number < 0:
                    raise self.error(f"a frame's number expected, got {words[0][:40]!r}", line)
                self.take(words, row, seen, line)
                continue
            if number >= 0:
                expected = self.checked(seen, expected, began, number)
                kept.extend(row)
            following = self.number(words[0], number, line)
            first = following if number < 0 else first
            number, began = following, line
            row, seen = [0.0] * self.skeleton.width, set()
        if expected is not None and not expected <= seen:
            warnings.append(f"the file ends within frame {number}: it is left out")
        else:
            self.checked(seen, expected, began, number)
            kept.extend(row)
        return np.array(kept).reshape(-1, self.skeleton.width), first

    def take(self, words: list[str], row: list[float], seen: set[str], line: int) -> None:
        name = words[0]
        refuse_merge_marks(name, self.path, line)
        if name not in self.places:
            raise self.error(f"the skeleton has no bone {name[:40]!r} that moves", line)
        if name in seen:
            raise self.error(f"{name!r} twice in a frame", line)
        place = self.places[name]
        if len(words) - 1 != place.stop - place.start:
            raise self.error(
                f"{name!r} needs {place.stop - place.start} numbers, got {len(words) - 1}", line
            )
        try:
            values = [float(word) for word in words[1:]]
        except ValueError:
            values = [float("nan")]
        if not all(map(isfinite, values)) or any("_" in word for word in words[1:]):
            for word in words[1:]:
                finite_number(word, self.path, line, f"an angle of {name}")
        row[place] = values
        seen.add(name)

    def number(self, word: str, before: int, line: int) -> int:
        if not word.isascii() or not word.isdigit() or len(word) > 10:
            refuse_merge_marks(word, self.path, line)
            raise self.error(f"a frame's number expected, got {word[:40]!r}", line)
        if before >= 0 and int(word) != before + 1:
            raise self.error(f"frame {word} follows frame {before}", line)
        return int(word)

    def checked(
        self, seen: set[str], expected: set[str] | None, line: int, number: int
    ) -> set[str]:
        if expected is None:
            if not seen:
                raise self.error(f"frame {number} has no bone", line)
            return seen
        if seen != expected:
            name = min(seen ^ expected)
            what = "lacks" if name in expected else "has, unlike the first,"
            raise self.error(f"frame {number} {what} {name!r}", line)
        return expected

    def error(self, message: str, line: int) -> FormatError:
        return FormatError(message, self.path, line=line)


def _quick_table(raw: bytes, start: int, pattern: _Pattern) -> NDArray[np.float64] | None:
    """(T, 1 + values) of frames that all follow a pattern: the number of each, then its values."""
    per_line = np.array([1, *(1 + count for count in pattern.counts)])
    is_name = np.zeros(pattern.words, np.bool_)
    is_name[np.cumsum(per_line)[:-1]] = True
    which = np.cumsum(is_name) - 1
    spelled = Spelled.of([name.encode() for name in pattern.names])
    done_words = done_lines = filled = 0
    width = pattern.words - len(pattern.names)
    frames = min(raw.count(b"\n", start) // len(per_line), (len(raw) - start) // pattern.words) + 1
    table = np.empty(frames * width)
    for block in blocks(raw, start):
        words = tokens(block)
        lines = words.per_line()
        lines = lines[lines > 0]
        expected = per_line[(done_lines + np.arange(len(lines))) % len(per_line)]
        if not np.array_equal(lines, expected):
            return None
        places = (done_words + np.arange(len(words.starts))) % pattern.words
        names = np.flatnonzero(is_name[places])
        if not words.are(names, spelled, which[places[names]]):
            return None
        values, bad = parsed(words, np.flatnonzero(~is_name[places]))
        if bad is not None:
            return None
        table[filled : filled + len(values)] = values
        filled += len(values)
        done_words += len(places)
        done_lines += len(lines)
    if not done_words or done_words % pattern.words:
        return None
    return table[:filled].reshape(-1, width)


def _write(payload: Payload, path: Path) -> tuple[str, ...]:
    motion, lost = as_figure(skeleton_of(payload, path, "AMC"))
    skeleton = motion.skeleton
    lost += unheld(motion, filter(held, motion.notes), first=motion.start)
    if motion.rate != RATE:
        lost += (f"the rate, {motion.rate:g} frames a second",)
    moving = [
        (joint.name, skeleton.columns(index))
        for index, joint in enumerate(skeleton.joints)
        if joint.channels
    ]
    if not np.isfinite(motion.values).all():
        row = int(np.flatnonzero(~np.isfinite(motion.values).all(axis=1))[0])
        raise FormatError(f"frame {row} (from 0) has a value that is no finite number", path)

    def frames() -> Iterator[str]:
        for number, row in enumerate(motion.values.tolist(), start=motion.start):
            yield str(number)
            for name, place in moving:
                yield f"{name} {' '.join(map(repr, row[place]))}"

    write_lines(path.with_suffix(".asf"), asf_lines(motion))
    write_lines(path, _flags(motion), frames())
    return lost


def _flags(motion: SkeletonMotion) -> list[str]:
    unit = _RADIANS if motion.skeleton.space.radians_per_unit == 1.0 else _DEGREES
    kept = motion.notes.get(_HEADER, "").split("\n")
    fits = unit in [line.lower() for line in kept]
    return kept if fits else [":FULLY-SPECIFIED", unit.upper()]


AMC = Format("AMC", (".amc",), "skeleton", _sniff, _read, _write, companion=".asf")
