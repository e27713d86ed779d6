"""C3D, the binary files of biomechanics: points, analog signals, events, and how they were made.

Our own reader: the C3D packages there are refuse a file whose header and parameters differ in one
number, or trust counts that the file can't hold. Here a count that the file can't hold is refused
or repaired with a warning before anything is allocated.
"""

from __future__ import annotations

import json
from pathlib import Path
from typing import BinaryIO

import numpy as np
from numpy.typing import NDArray

from enpointe.errors import FormatError
from enpointe.motion.formats.c3d_frames import Frames, Layout, read_frames
from enpointe.motion.formats.c3d_parameters import (
    BLOCK,
    KEY,
    Encoding,
    Header,
    Parameters,
    Value,
    processor,
    read_header,
    read_parameters,
)
from enpointe.motion.formats.c3d_writing import write_c3d
from enpointe.motion.formats.content import Content, Format
from enpointe.motion.formats.guessing import UNITS, guessed_space
from enpointe.motion.formats.markers import Analog, Label, MarkerMotion
from enpointe.motion.formats.space import Space

__all__ = ["C3D", "read_c3d", "write_c3d"]

_ELSEWHERE = frozenset(
    {
        *(f"POINT:{name}" for name in ("USED", "FRAMES", "LONG_FRAMES", "DATA_START", "RATE")),
        *(f"{group}:LABELS{n}" for group in ("POINT", "ANALOG") for n in ("", *range(2, 10))),
        *(f"ANALOG:{name}" for name in ("USED", "RATE", "UNITS")),
        *(f"EVENT:{name}" for name in ("USED", "TIMES", "LABELS", "CONTEXTS", "SUBJECTS")),
        "TRIAL:ACTUAL_START_FIELD",
        "TRIAL:ACTUAL_END_FIELD",
    }
)


def read_c3d(path: Path) -> Content:
    """Read a C3D file of any of the six encodings.

    Parameters that a `MarkerMotion` has no place for are kept as JSON in its notes, by
    "GROUP:NAME". Times of events count from frame 1 of the trial.

    Raises:
        FormatError: No C3D file, or one whose frames can't be found.
    """
    try:
        with path.open("rb") as file:
            return _read(file, path)
    except OSError as error:
        raise FormatError(f"can't be read ({error.strerror or error})", path) from None


def _sniff(start: bytes) -> bool:
    return len(start) >= BLOCK and start[1] == KEY and start[0] > 1


def _read(file: BinaryIO, path: Path) -> Content:
    size = file.seek(0, 2)
    file.seek(0)
    block = file.read(BLOCK)
    if not _sniff(block):
        raise FormatError(
            "a C3D file starts with a header of 512 bytes, the second 80", path, byte=0
        )
    header, parameters, encoding = _metadata(file, block, path)
    warnings, lost = list(parameters.warnings), []
    layout, rate = _layout(header, parameters, size, path, warnings)
    frames = read_frames(file, layout, encoding)
    if frames.discarded:
        lost.append(f"coordinates of {frames.discarded} points that are marked as not valid")
    if parameters.described:
        lost.append(f"descriptions of {parameters.described} parameters and groups")
    if any(name.startswith("ROTATION:") for name in parameters.values):
        lost.append("rotations of the ROTATION group")
    motion = _motion(header, parameters, encoding, layout, rate, frames, warnings)
    return Content(motion, tuple(warnings), tuple(lost))


def _metadata(file: BinaryIO, block: bytes, path: Path) -> tuple[Header, Parameters, Encoding]:
    start = (block[0] - 1) * BLOCK
    file.seek(start)
    section = file.read(4)
    encoding = processor(section[3]) if len(section) == 4 else None
    if encoding is None:
        raise FormatError("no parameters of an Intel, DEC or SGI processor", path, byte=start)
    section += file.read(max(section[2], 1) * BLOCK - 4)
    return (
        read_header(block, path, encoding),
        read_parameters(section, start, path, encoding),
        encoding,
    )


def _layout(
    header: Header, parameters: Parameters, size: int, path: Path, warnings: list[str]
) -> tuple[Layout, float]:
    rate = next(
        (r for r in (parameters.real("POINT:RATE"), header.rate) if r and 1e-6 < r < 1e6), None
    )
    if rate is None:
        raise FormatError("the header and POINT:RATE have no frame rate", path, byte=20)
    scale = parameters.real("POINT:SCALE") or header.scale
    if not np.isfinite(scale) or scale == 0:
        raise FormatError("the header and POINT:SCALE have no scale", path, byte=12)
    points = _agreed(parameters.whole("POINT:USED"), header.points, "points", warnings)
    per_frame = header.per_frame if header.analog else 0
    told = header.analog // per_frame if per_frame else 0
    used = parameters.whole("ANALOG:USED")
    channels = _agreed(used if per_frame else 0, told, "analog channels", warnings)
    gains, offsets = _calibration(parameters, channels)
    start = (header.data_block - 1) * BLOCK
    layout = Layout(
        start,
        0,
        points,
        channels,
        per_frame,
        scale,
        parameters.strings("ANALOG:FORMAT") == ("UNSIGNED",),
        gains,
        offsets,
    )
    if not layout.frame_bytes:
        raise FormatError("neither points nor analog channels", path, byte=2)
    if header.data_block < 2 or start >= size:
        raise FormatError(f"the frames should start at byte {start}", path, byte=16)
    held = (size - start) // layout.frame_bytes
    if not held:
        raise FormatError("the file ends within the first frame", path, byte=size)
    frames = _frame_count(header, parameters, held, warnings)
    return _with_frames(layout, frames), rate


def _with_frames(layout: Layout, frames: int) -> Layout:
    return Layout(
        layout.start,
        frames,
        layout.points,
        layout.channels,
        layout.per_frame,
        layout.scale,
        layout.unsigned,
        layout.gains,
        layout.offsets,
    )


def _agreed(parameter: int | None, header: int, what: str, warnings: list[str]) -> int:
    if parameter is None or parameter == header:
        return header
    warnings.append(f"the header says {header} {what}, the parameters {parameter}; these are taken")
    return parameter


def _calibration(
    parameters: Parameters, channels: int
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Units per step and steps at zero, one a channel."""
    general = parameters.real("ANALOG:GEN_SCALE")
    gains, offsets = np.ones(channels), np.zeros(channels)
    for name, target in (("ANALOG:SCALE", gains), ("ANALOG:OFFSET", offsets)):
        given = parameters.reals(name)[:channels]
        target[: len(given)] = given
    if parameters.strings("ANALOG:FORMAT") == ("UNSIGNED",):
        offsets %= 65536
    return gains * (1.0 if general is None else general), offsets


def _frame_count(header: Header, parameters: Parameters, held: int, warnings: list[str]) -> int:
    """The first of the file's own counts that the file can hold."""
    first = parameters.whole("TRIAL:ACTUAL_START_FIELD")
    last = parameters.whole("TRIAL:ACTUAL_END_FIELD")
    trial = last - first + 1 if first is not None and last is not None else None
    told = header.last - header.first + 1
    counts = [
        trial,
        parameters.whole("POINT:LONG_FRAMES"),
        told,
        parameters.whole("POINT:FRAMES"),
    ]
    known = [count for count in counts if count is not None]
    count = next((count for count in known if 1 <= count <= held), None)
    if count is None:
        warnings.append(f"the header says {told} frames, and the file holds {held}")
        return held
    if any(other != count for other in known if other < 65535):
        warnings.append(
            f"the counts of frames differ ({', '.join(map(str, known))}); {count} is taken"
        )
    return count


def _motion(
    header: Header,
    parameters: Parameters,
    encoding: Encoding,
    layout: Layout,
    rate: float,
    frames: Frames,
    warnings: list[str],
) -> MarkerMotion:
    start = parameters.whole("TRIAL:ACTUAL_START_FIELD")
    labels = parameters.strings("POINT:LABELS")[: layout.points]
    return MarkerMotion(
        _names(labels, layout.points, "marker"),
        rate,
        frames.positions,
        _space(parameters, frames.positions, warnings),
        header.first if start is None else start,
        residuals=frames.residuals,
        cameras=frames.cameras,
        analog=_analog(parameters, layout, rate, frames),
        labels=_labels(header, parameters),
        notes=_notes(header, parameters, encoding, layout),
    )


def _names(labels: tuple[str, ...], count: int, what: str) -> tuple[str, ...]:
    given = (*labels, *("",) * (count - len(labels)))
    return tuple(name or f"{what} {index}" for index, name in enumerate(given, start=1))


def _space(parameters: Parameters, positions: NDArray[np.float64], warnings: list[str]) -> Space:
    unit = "".join(parameters.strings("POINT:UNITS")[:1]).lower()
    metres = UNITS.get(unit)
    if unit and metres is None:
        warnings.append(f"the unit {unit[:20]!r} is not known")
    guess, lines = guessed_space(positions, "z", metres)
    screen = "".join(parameters.strings("POINT:Y_SCREEN")[:1]).upper()
    for axis in ("x", "y", "z"):
        # Some let the screen's second axis point down, and mean the same.
        if screen in (f"+{axis.upper()}", f"-{axis.upper()}"):
            warnings.extend(lines[1:])
            return Space(metres_per_unit=guess.metres_per_unit, up=axis)
    warnings.extend(lines)
    return guess


def _analog(parameters: Parameters, layout: Layout, rate: float, frames: Frames) -> Analog | None:
    if not layout.channels:
        return None
    units = parameters.strings("ANALOG:UNITS")[: layout.channels]
    return Analog(
        _names(parameters.strings("ANALOG:LABELS")[: layout.channels], layout.channels, "channel"),
        (*units, *("",) * (layout.channels - len(units))),
        rate * layout.per_frame,
        frames.analog,
    )


def _labels(header: Header, parameters: Parameters) -> tuple[Label, ...]:
    """The EVENT group's events, or the header's where there is no such group."""
    times = parameters.reals("EVENT:TIMES")
    if "EVENT:TIMES" not in parameters.values:
        found = [Label(time, name) for time, name in header.events]
        return tuple(sorted(found, key=lambda label: label.time))
    names, contexts, subjects = (
        parameters.strings(f"EVENT:{name}") for name in ("LABELS", "CONTEXTS", "SUBJECTS")
    )
    used = parameters.whole("EVENT:USED")
    count = len(times) // 2 if used is None else min(used, len(times) // 2)
    found = [
        Label(
            float(times[2 * i] * 60 + times[2 * i + 1]),
            "".join(names[i : i + 1]),
            "".join(subjects[i : i + 1]),
            "".join(contexts[i : i + 1]),
        )
        for i in range(count)
    ]
    kept = [label for label in found if np.isfinite(label.time)]
    return tuple(sorted(kept, key=lambda label: label.time))


def _notes(
    header: Header, parameters: Parameters, encoding: Encoding, layout: Layout
) -> dict[str, str]:
    notes = {
        name: json.dumps(_plain(value), ensure_ascii=False)
        for name, value in parameters.values.items()
        if name not in _ELSEWHERE
    }
    notes["POINT:SCALE"] = json.dumps(_plain(np.float32(layout.scale)))
    notes["processor"] = encoding.name
    if header.gap:
        notes["interpolated gap"] = str(header.gap)
    return notes


def _plain(value: Value | np.float32) -> object:
    """Lists of strings and numbers; a 32-bit float in its own shortest digits."""
    if isinstance(value, tuple):
        return list(value)
    if value.dtype.kind == "f":
        flat = [float(str(number)) for number in np.ravel(value)]
        return np.array(flat).reshape(np.shape(value)).tolist()
    return value.tolist()


C3D = Format("C3D", (".c3d",), "markers", _sniff, read_c3d, write_c3d)
