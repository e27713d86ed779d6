"""HTR and GTR: Motion Analysis's skeletons, and the variant in which each segment is global.

ENACTIVE D.RD3.3.1 section 2.8; J. Lander's page on HTR at the University of Wisconsin (1998). A
segment's place in its parent's frame is its base translation plus the frame's; its rotation is
base @ frame; "ZYX" multiplies Rz Ry Rx. ScaleFactor scales all lengths; a segment's scale, the
length of its bone along BoneLengthAxis. Motion Analysis writes 9999999 where it lost a segment.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Literal, cast

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from enpointe.errors import FormatError
from enpointe.motion.formats.content import Content, Format
from enpointe.motion.formats.htr_writing import write_gtr, write_htr
from enpointe.motion.formats.skeleton import IDENTITY, Joint, Skeleton, SkeletonMotion
from enpointe.motion.formats.space import DEGREES, Space
from enpointe.motion.formats.text import (
    CUT,
    finite_number,
    number_block,
    read_text,
    refuse_merge_marks,
    whole_number,
)
from enpointe.motion.formats.units import INCH

__all__ = ["GTR", "HTR"]

_GLOBAL = "global"
_COMMENT = re.compile(r"#[^\n]*")
_SECTION = re.compile(r"^[^\S\n]*\[([^\n]*)\][^\S\n]*$", re.MULTILINE)
_UNITS = {
    "mm": 0.001,
    "millimeters": 0.001,
    "cm": 0.01,
    "centimeters": 0.01,
    "dm": 0.1,
    "m": 1.0,
    "meters": 1.0,
    "in": INCH,
    "inch": INCH,
    "inches": INCH,
    "ft": 12 * INCH,
    "feet": 12 * INCH,
}
_LOST = 9e6
_NEEDED = ("eulerrotationorder", "datatype")
_TOOK = {
    "filetype",
    "datatype",
    "numsegments",
    "numframes",
    "dataframerate",
    "rotationunits",
    "globalaxisofgravity",
}


def _sniff_htr(head: bytes) -> bool:
    return _file_type(head) == b"htr"


def _sniff_gtr(head: bytes) -> bool:
    return _file_type(head) == b"gtr"


def _file_type(head: bytes) -> bytes:
    if b"[header]" not in head.lower():
        return b""
    words = head.lower().split()
    place = words.index(b"filetype") + 1 if b"filetype" in words else len(words)
    return words[place][:3] if place < len(words) else b""


def _read(path: Path) -> Content:
    return _Reader(path, read_text(path)).content()


@dataclass(frozen=True, slots=True)
class _Section:
    """A section's name, and where what is in it stands: characters, and the line of the first."""

    name: str
    start: int
    end: int
    line: int

    def __len__(self) -> int:
        return self.end - self.start


@dataclass
class _Base:
    line: int
    words: list[str]
    numbers: list[float] = field(default_factory=list)


class _Reader:
    """Takes an HTR or GTR file section by section.

    The text stays in one piece: a list of its lines would be several times as large.
    """

    def __init__(self, path: Path, text: str) -> None:
        self.path = path
        self.lost = ("comments",) if "#" in text else ()
        self.text = _COMMENT.sub("", text) if self.lost else text
        self.sections = self.split()
        self.warnings: list[str] = []

    def split(self) -> dict[str, _Section]:
        """The sections by name."""
        starts = self.starts()
        found: dict[str, _Section] = {}
        for each in starts:
            key = _plain(each.name)
            if key == "endoffile":
                break
            key = key if key in ("header", "segmentnames&hierarchy", "baseposition") else each.name
            if key in found:
                raise self.error(f"[{each.name[:40]}] for the second time", each.line - 1)
            found[key] = each
        self.whole = _plain(starts[-1].name) == "endoffile"
        return found

    def starts(self) -> list[_Section]:
        """Every section, in the file's order."""
        found: list[_Section] = []
        marks = list(_SECTION.finditer(self.text))
        before = _Section("", 0, marks[0].start() if marks else len(self.text), 1)
        for line, text in self.lines_of(before):
            refuse_merge_marks(text, self.path, line)
            raise self.error(f"[Header] expected, got {text[:40]!r}", line)
        if not marks:
            raise self.error("[Header] expected, and there is nothing but comments", 1)
        at, line = 0, 2
        ends = [mark.start() for mark in marks[1:]] + [len(self.text)]
        for mark, end in zip(marks, ends, strict=True):
            line += self.text.count("\n", at, mark.start())
            at = mark.start()
            found.append(_Section(mark[1].strip(), min(mark.end() + 1, end), end, line))
        return found

    def lines_of(self, section: _Section | None) -> Iterator[tuple[int, str]]:
        """Number and text of each line of a section that is not blank."""
        if section is not None:
            text = self.text[section.start : section.end]
            for number, line in enumerate(text.split("\n"), start=section.line):
                if line.strip():
                    yield number, line.strip()

    def content(self) -> Content:
        header = self.header()
        bases = self.bases()
        parents = self.parents(header, bases)
        declared = whole_number(*self.value(header, "numsegments", "0"), "NumSegments")
        if declared != len(parents):
            self.warnings.append(f"NumSegments says {declared}, there are {len(parents)}")
        if not self.whole:
            self.warnings.append(f"no [EndOfFile]: {CUT}")
        space, notes = self.space(header)
        order = self.order(header)
        long_axis = notes.get("BoneLengthAxis", "Y").upper()
        if long_axis not in ("X", "Y", "Z"):
            raise self.error(f"BoneLengthAxis is X, Y or Z, got {long_axis[:40]!r}", 1)
        channels = self.channels(header, long_axis)
        values, start = self.motion(list(parents), len(channels), header)
        joints = self.joints(parents, bases, channels, order, space, "XYZ".index(long_axis), notes)
        rate = self.rate(header)
        skeleton = Skeleton(joints, space, positions_replace_offset=False)
        motion = SkeletonMotion(skeleton, rate, values, start=start, notes=notes)
        return Content(motion, tuple(self.warnings), self.lost)

    def header(self) -> dict[str, tuple[str, str, int]]:
        """Name as written, value and line of each setting, by its name in small letters."""
        found: dict[str, tuple[str, str, int]] = {}
        for line, text in self.lines_of(self.sections.get("header")):
            words = text.split()
            refuse_merge_marks(words[0], self.path, line)
            if words[0].lower() in found:
                raise self.error(f"{words[0][:40]} for the second time", line)
            found[words[0].lower()] = (words[0], " ".join(words[1:]), line)
        for key in _NEEDED:
            if key not in found:
                raise self.error(f"[Header] lacks {key}: is the file whole?", 1)
        return found

    def value(
        self, header: dict[str, tuple[str, str, int]], key: str, default: str
    ) -> tuple[str, Path, int]:
        _, text, line = header.get(key, (key, default, 1))
        return text, self.path, line

    def bases(self) -> dict[str, _Base]:
        found: dict[str, _Base] = {}
        for line, text in self.lines_of(self.sections.get("baseposition")):
            words = text.replace(",", " ").split()
            name = " ".join(words[:-7])
            if not name or name in found:
                raise self.error("a segment's name, unlike the others, and 7 numbers", line)
            base = _Base(line, words[-7:])
            base.numbers = [
                finite_number(word, self.path, line, "a base position") for word in words[-7:]
            ]
            if max(map(abs, base.numbers)) > 1e12:
                raise self.error("a base position that no body could have", line)
            found[name] = base
        return found

    def parents(
        self, header: dict[str, tuple[str, str, int]], bases: dict[str, _Base]
    ) -> dict[str, str]:
        """Each segment's parent ("" for none), a parent before its children."""
        given: dict[str, tuple[str, int]] = {}
        hierarchical = self.file_type(header) != "gtr"
        for line, text in self.lines_of(self.sections.get("segmentnames&hierarchy")):
            words = text.split("\t") if text.count("\t") == 1 else text.split()
            if len(words) not in ((2,) if hierarchical else (1, 2)):
                raise self.error(f"a segment and its parent expected, got {text[:40]!r}", line)
            name = words[0].strip()
            if name in given:
                raise self.error(f"{name[:40]!r} for the second time", line)
            parent = words[1].strip() if len(words) == 2 and hierarchical else _GLOBAL
            given[name] = ("" if parent.lower() == _GLOBAL else parent, line)
        if not given and not hierarchical:
            named = [key for key in self.sections if key not in ("header", "baseposition")]
            given = dict.fromkeys(bases or named, ("", 1))
        return self.ordered(given)

    def ordered(self, given: dict[str, tuple[str, int]]) -> dict[str, str]:
        children: dict[str, list[str]] = {}
        for name, (parent, line) in given.items():
            if parent and parent not in given:
                raise self.error(f"no segment is called {parent[:40]!r}", line)
            children.setdefault(parent, []).append(name)
        ordered: dict[str, str] = {}
        waiting = children.get("", [])[::-1]
        while waiting:
            name = waiting.pop()
            ordered[name] = given[name][0]
            waiting += children.get(name, [])[::-1]
        loose = next((name for name in given if name not in ordered), None)
        if loose is not None:
            raise self.error(f"{loose[:40]!r} hangs on itself", given[loose][1])
        if not ordered:
            raise self.error("there are no segments", 1)
        return ordered

    def file_type(self, header: dict[str, tuple[str, str, int]]) -> str:
        text, _, line = self.value(header, "filetype", "htr")
        if text.lower() not in ("htr", "gtr"):
            raise self.error(f"FileType htr or gtr expected, got {text[:40]!r}", line)
        return text.lower()

    def space(self, header: dict[str, tuple[str, str, int]]) -> tuple[Space, dict[str, str]]:
        text, _, line = self.value(header, "calibrationunits", "mm")
        if text.lower() not in _UNITS:
            raise self.error(f"no unit is called {text[:40]!r}; {' '.join(_UNITS)}", line)
        scale = finite_number(*self.value(header, "scalefactor", "1"), "ScaleFactor")
        if not 1e-9 < scale < 1e9:
            raise self.error("ScaleFactor must be above 0", header["scalefactor"][2])
        up, _, line = self.value(header, "globalaxisofgravity", "Y")
        if up.lower() not in ("x", "y", "z"):
            raise self.error(f"GlobalAxisofGravity is X, Y or Z, got {up[:40]!r}", line)
        turn, _, line = self.value(header, "rotationunits", "Degrees")
        if turn.lower()[:3] not in ("deg", "rad"):
            raise self.error(f"RotationUnits are Degrees or Radians, got {turn[:40]!r}", line)
        radians = DEGREES if turn.lower().startswith("deg") else 1.0
        axis = cast(Literal["x", "y", "z"], up.lower())
        notes = {name: value for key, (name, value, _) in header.items() if key not in _TOOK}
        return Space(_UNITS[text.lower()] * scale, axis, radians), notes

    def order(self, header: dict[str, tuple[str, str, int]]) -> str:
        text, _, line = self.value(header, "eulerrotationorder", "ZYX")
        if sorted(text.upper()) != ["X", "Y", "Z"]:
            raise self.error(f"an order such as ZYX expected, got {text[:40]!r}", line)
        return text.upper()

    def rate(self, header: dict[str, tuple[str, str, int]]) -> float:
        rate = finite_number(*self.value(header, "dataframerate", ""), "DataFrameRate")
        if not 1e-6 <= rate <= 1e6:
            raise self.error("DataFrameRate must be above 0", header["dataframerate"][2])
        return rate

    def channels(self, header: dict[str, tuple[str, str, int]], long_axis: str) -> tuple[str, ...]:
        text, _, line = self.value(header, "datatype", "HTRS")
        if text.upper() not in ("HTRS", "HTR", "GTRS", "GTR"):
            raise self.error(f"DataType HTRS or GTRS expected, got {text[:40]!r}", line)
        kinds = ("position", "rotation")
        channels = tuple(f"{axis}{kind}" for kind in kinds for axis in "XYZ")
        return (*channels, f"{long_axis}scale") if text.upper().endswith("S") else channels

    def motion(
        self, names: list[str], width: int, header: dict[str, tuple[str, str, int]]
    ) -> tuple[NDArray[np.float64], int]:
        known = {*names, "header", "segmentnames&hierarchy", "baseposition"}
        for name, own in self.sections.items():
            if name not in known:
                raise self.error(f"no segment is called {name[:40]!r}", own.line - 1)
        for name in names:
            if name not in self.sections:
                last = 1 + self.text.count("\n")
                raise self.error(f"{name[:40]!r} has no section: is the file whole?", last)
        numbers, values = np.empty(0), np.empty((0, 0))
        for index, name in enumerate(names):
            own = self.sections[name]
            table = self.table(own, 1 + width)
            if index == 0:
                # No room for a table of more frames than the shortest section could hold.
                shortest = min((self.sections[name] for name in names), key=_Section.__len__)
                if 2 * len(table) * (1 + width) > len(shortest) + 1:
                    self.table(shortest, 1 + width)  # which says better what is wrong with a line
                    raise self.uneven(shortest)
                numbers = np.arange(len(table)) + table[:1, 0]
                values = np.empty((len(table), width * len(names)))
            if not len(table) or not np.array_equal(table[:, 0], numbers):
                raise self.uneven(own)
            values[:, width * index : width * (index + 1)] = table[:, 1:]
        if not 0 <= numbers[0] <= 1e9 or numbers[0] != int(numbers[0]):
            line = self.sections[names[0]].line - 1
            raise self.error("frames are counted from a whole number", line)
        declared = whole_number(*self.value(header, "numframes", "0"), "NumFrames")
        if declared != len(numbers):
            self.warnings.append(f"NumFrames says {declared}, there are {len(numbers)}")
        gone = (values > _LOST) | (values < -_LOST)
        if gone.any():
            values[gone] = np.nan
            self.warnings.append(f"lost segments (9999999) in {int(gone.any(axis=1).sum())} frames")
        return values, int(numbers[0])

    def table(self, own: _Section, width: int) -> NDArray[np.float64]:
        rows = self.text[own.start : own.end].encode()
        return number_block(rows, width, self.path, own.line, f"a frame of {own.name[:40]!r}")

    def uneven(self, own: _Section) -> FormatError:
        return self.error(
            f"the frames of {own.name[:40]!r} are not those of the first segment, one by one",
            own.line - 1,
        )

    def joints(
        self,
        parents: dict[str, str],
        bases: dict[str, _Base],
        channels: tuple[str, ...],
        order: str,
        space: Space,
        long_axis: int,
        notes: dict[str, str],
    ) -> tuple[Joint, ...]:
        places = {name: index for index, name in enumerate(parents)} | {"": -1}
        inner = set(parents.values())
        joints = []
        for name, parent in parents.items():
            base = bases.get(name, _Base(0, [], [0.0] * 7))
            x, y, z, *turns, length = base.numbers
            end = [0.0, 0.0, 0.0]
            end[long_axis] = length
            ends = ((end[0], end[1], end[2]),) if base.words and name not in inner else ()
            rest = _rest(turns, order, space.radians_per_unit)
            if base.words:
                notes[f"bone {name}"] = " ".join(base.words)
            joints.append(
                Joint(name, places[parent], (x, y, z), channels, order, rest=rest, ends=ends)
            )
        return tuple(joints)

    def error(self, message: str, line: int) -> FormatError:
        return FormatError(message, self.path, line=max(line, 1))


def _rest(turns: list[float], order: str, radians: float) -> tuple[float, float, float, float]:
    if turns == [0.0, 0.0, 0.0]:
        return IDENTITY
    angles = [radians * turns["XYZ".index(axis)] for axis in order]
    w, x, y, z = Rotation.from_euler(order, angles).as_quat(scalar_first=True)
    return float(w), float(x), float(y), float(z)


def _plain(name: str) -> str:
    return name.replace(" ", "").lower()


HTR = Format("HTR", (".htr",), "skeleton", _sniff_htr, _read, write_htr)
GTR = Format("GTR", (".gtr",), "skeleton", _sniff_gtr, _read, write_gtr)
