"""Writing C3D files: Intel numbers, as floats or as integers of a given step."""

from __future__ import annotations

import json
import struct
from collections.abc import Mapping
from dataclasses import dataclass, field
from math import floor
from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike, NDArray

from enpointe.errors import FormatError
from enpointe.files import atomic_path
from enpointe.motion.formats.c3d_parameters import BLOCK, KEY, LARGEST_INTEGER
from enpointe.motion.formats.content import Payload
from enpointe.motion.formats.guessing import unit_name
from enpointe.motion.formats.holding import left_out, markers_of
from enpointe.motion.formats.markers import MarkerMotion

__all__ = ["write_c3d"]

_MOST = 255
_MOST_POINTS = 65535
_LARGEST_PARAMETER = 32000
_PIECE = 1024
_SIDE = {"x": "+Y", "y": "+X", "z": "+X"}
_OURS = ("POINT", "ANALOG", "EVENT", "TRIAL")


def write_c3d(payload: Payload, path: Path, *, scale: float | None = None) -> tuple[str, ...]:
    """Write a C3D file.

    Args:
        payload: The markers; notes named "GROUP:NAME" become parameters again.
        path: Where to.
        scale: Size of a step, in which case coordinates and analog samples become integers of 16
            bits. 0 for floats. Otherwise as the note "POINT:SCALE" has it, or else floats.

    Returns:
        What the file can't hold.

    Raises:
        FormatError: No markers, a unit without a name, or a point too far away for the step.
    """
    motion = markers_of(payload, path, "C3D")
    unit = unit_name(motion.space.metres_per_unit)
    if unit is None:
        raise FormatError("C3D needs a unit with a name: mm, cm, m, in", path)
    if len(motion.names) > _MOST_POINTS:
        raise FormatError(f"C3D holds {_MOST_POINTS} markers, got {len(motion.names)}", path)
    lost = left_out(motion, "residuals", "cameras", "analog", "labels", "gaps")
    step = _step(motion, scale)
    points = _Points(motion, step, path)
    analog = _Analog(motion, step, lost)
    lost += points.lost
    parameters = _parameters(motion, unit, step, analog, lost)
    blocks = len(_section(parameters, [])) // BLOCK
    parameters["POINT:DATA_START"] = _integers(2 + blocks)
    section = _section(parameters, lost)
    with atomic_path(path) as beside, beside.open("wb") as file:
        file.write(_header(motion, step, analog, 2 + blocks))
        file.write(section)
        for first in range(0, motion.frames, _PIECE):
            rows = slice(first, min(first + _PIECE, motion.frames))
            file.write(np.hstack([points.rows(rows), analog.rows(rows)]).tobytes())
        file.write(b"\0" * (-file.tell() % BLOCK))
    return tuple(lost)


def _step(motion: MarkerMotion, scale: float | None) -> float:
    """Positive for integers, negative for floats; the size of a residual's step either way."""
    noted = _noted(motion, "POINT:SCALE")
    if scale is not None and scale > 0:
        return float(np.float32(scale))
    if isinstance(noted, float) and np.isfinite(noted) and noted:
        return float(np.float32(noted if scale is None else -abs(noted)))
    if motion.residuals is None:
        return -1.0
    largest = float(np.nanmax(motion.residuals, initial=0.0))
    return float(np.float32(-largest / _MOST)) or -1.0


def _noted(motion: MarkerMotion, name: str) -> object:
    try:
        found: object = json.loads(motion.notes.get(name, "null"))
    except ValueError:
        return None
    return found


def _noted_string(motion: MarkerMotion, name: str) -> str:
    found = _noted(motion, name)
    return str(found[0]) if isinstance(found, list) and len(found) == 1 else ""


class _Points:
    """Rows of points, four numbers each."""

    def __init__(self, motion: MarkerMotion, step: float, path: Path) -> None:
        self._motion, self._step = motion, step
        self.lost: list[str] = []
        if motion.residuals is not None:
            known = motion.residuals[motion.seen] / abs(step)
            if not np.allclose(np.clip(np.rint(known), 0, _MOST), known, atol=1e-3):
                self.lost.append(f"residuals are rounded to steps of {abs(step):g}, 255 at most")
        if step > 0:
            self._check_integers(path)
        elif (motion.positions.astype(np.float32) != motion.positions)[motion.seen].any():
            self.lost.append("coordinates are rounded to 32-bit floats")

    def _check_integers(self, path: Path) -> None:
        steps = self._motion.positions[self._motion.seen] / self._step
        if steps.size and np.abs(steps).max() > LARGEST_INTEGER:
            raise FormatError(
                f"a point is more than {LARGEST_INTEGER} steps of {self._step:g} away; "
                "choose a larger step or floats",
                path,
            )
        if not np.allclose(np.rint(steps), steps, rtol=0, atol=1e-3):
            self.lost.append(f"coordinates are rounded to steps of {self._step:g}")

    def rows(self, rows: slice) -> NDArray[np.generic]:
        motion, seen = self._motion, self._motion.seen[rows]
        size = 1.0 if self._step < 0 else self._step
        table = np.zeros((*seen.shape, 4))
        table[..., :3] = np.where(seen[..., None], motion.positions[rows] / size, 0.0)
        marks = np.zeros(seen.shape)
        if motion.residuals is not None:
            steps = np.nan_to_num(motion.residuals[rows] / abs(self._step))
            marks += np.clip(np.rint(steps), 0, _MOST)
        if motion.cameras is not None:
            marks += (motion.cameras[rows] & 0x7F) * 256.0
        table[..., 3] = np.where(seen, marks, -1.0)
        flat = table.reshape(len(table), -1)
        return flat.astype("<f4") if self._step < 0 else np.rint(flat).astype("<i2")


class _Analog:
    """Rows of analog samples; calibrated floats, or integers by the calibration in the notes."""

    def __init__(self, motion: MarkerMotion, step: float, lost: list[str]) -> None:
        self.channels = self.per_frame = 0
        self._whole = step > 0
        analog = motion.analog
        if analog is None:
            return
        per_frame = round(analog.rate / motion.rate)
        fits = per_frame >= 1 and per_frame * analog.values.shape[1] <= _MOST_POINTS
        if not fits or len(analog.values) != per_frame * motion.frames:
            lost.append("analog signals, whose samples do not divide among the frames")
            return
        self.channels, self.per_frame = analog.values.shape[1], per_frame
        self._values = analog.values
        self.general, self.scales = 1.0, np.ones(self.channels)
        self.offsets, self.unsigned = np.zeros(self.channels), False
        if self._whole:
            self._calibrate(motion, lost)

    def _calibrate(self, motion: MarkerMotion, lost: list[str]) -> None:
        """The file's own steps where it had them, else as fine as 16 bits allow."""
        scales = _numbers(_noted(motion, "ANALOG:SCALE"), self.channels)
        general = _numbers(_noted(motion, "ANALOG:GEN_SCALE"), 1)
        offsets = _numbers(_noted(motion, "ANALOG:OFFSET"), self.channels)
        if scales is not None and general is not None and (scales * general).all():
            self.unsigned = _noted(motion, "ANALOG:FORMAT") == ["UNSIGNED"]
            self.scales, self.general = scales, float(general[0])
            self.offsets = self.offsets if offsets is None else offsets
            self.offsets = self.offsets % 65536 if self.unsigned else self.offsets
        else:
            largest = np.abs(self._values).max(axis=0, initial=0.0) / LARGEST_INTEGER
            self.scales = np.where(largest > 0, largest, 1.0).astype(np.float32).astype(float)
        steps = self._steps(slice(None))
        if not np.allclose(np.rint(steps), steps, rtol=0, atol=0.02):
            lost.append("analog samples are rounded to their channels' steps")

    def _steps(self, rows: slice) -> NDArray[np.float64]:
        steps: NDArray[np.float64] = (
            self._values[rows] / (self.scales * self.general) + self.offsets
        )
        low, high = (0, 65535) if self.unsigned else (-LARGEST_INTEGER - 1, LARGEST_INTEGER)
        return np.clip(np.nan_to_num(steps), low, high)

    def rows(self, rows: slice) -> NDArray[np.generic]:
        count = rows.stop - rows.start
        if not self.channels:
            return np.empty((count, 0), dtype="<i2" if self._whole else "<f4")
        samples = slice(rows.start * self.per_frame, rows.stop * self.per_frame)
        if not self._whole:
            return self._values[samples].astype("<f4").reshape(count, -1)
        steps = np.rint(self._steps(samples)).astype(np.int64)
        return steps.astype("<u2" if self.unsigned else "<i2").view("<i2").reshape(count, -1)


def _numbers(value: object, count: int) -> NDArray[np.float64] | None:
    try:
        numbers = np.asarray(value, dtype=float).ravel()[:count]
    except (TypeError, ValueError):
        return None
    return numbers if len(numbers) == count and np.isfinite(numbers).all() else None


def _header(motion: MarkerMotion, step: float, analog: _Analog, data_block: int) -> bytes:
    first = min(max(motion.start, 0), 65535)
    last = min(max(motion.start, 0) + motion.frames - 1, 65535)
    gap = motion.notes.get("interpolated gap", "0")
    block = struct.pack(
        "<BB5HfHHf",
        2,
        KEY,
        len(motion.names),
        analog.channels * analog.per_frame,
        first,
        last,
        int(gap) if gap.isdecimal() and len(gap) < 5 else 0,
        step,
        data_block,
        analog.per_frame,
        motion.rate,
    )
    return block.ljust(BLOCK, b"\0")


@dataclass(frozen=True, slots=True)
class _Parameter:
    kind: int
    dimensions: tuple[int, ...]
    data: bytes = field(repr=False)


def _parameters(
    motion: MarkerMotion, unit: str, step: float, analog: _Analog, lost: list[str]
) -> dict[str, _Parameter]:
    """All by "GROUP:NAME"; those that describe this file stand before those in the notes."""
    last = max(motion.start, 0) + motion.frames - 1
    side, up = (_noted_string(motion, f"POINT:{axis}_SCREEN") for axis in "XY")
    found = {
        "POINT:USED": _integers(len(motion.names)),
        "POINT:SCALE": _reals(step),
        "POINT:RATE": _reals(motion.rate),
        "POINT:DATA_START": _integers(0),
        "POINT:FRAMES": _integers(min(motion.frames, 65535)),
        "POINT:UNITS": _string(unit),
        "POINT:X_SCREEN": _string(side or _SIDE[motion.space.up]),
        "POINT:Y_SCREEN": _string(
            up if up[1:].lower() == motion.space.up else f"+{motion.space.up.upper()}"
        ),
        "TRIAL:ACTUAL_START_FIELD": _integers([max(motion.start, 0) & 0xFFFF, motion.start >> 16]),
        "TRIAL:ACTUAL_END_FIELD": _integers([last & 0xFFFF, last >> 16]),
        "ANALOG:USED": _integers(analog.channels),
    }
    if motion.frames > 65535:
        found["POINT:LONG_FRAMES"] = _reals(motion.frames)
    found |= _strings("POINT:LABELS", motion.names)
    if analog.channels and motion.analog is not None:
        found |= _analog_parameters(motion, analog)
    if motion.labels:
        found |= _event_parameters(motion, lost)
    if motion.start < 0:
        lost.append(f"the first frame's number {motion.start} became 0")
    for name, text in motion.notes.items():
        parameter = _from_note(name, text)
        if parameter is not None:
            found.setdefault(name, parameter)
        elif name not in ("processor", "interpolated gap"):
            lost.append(f"the note {name!r}")
    return found


def _analog_parameters(motion: MarkerMotion, analog: _Analog) -> dict[str, _Parameter]:
    assert motion.analog is not None
    found = {
        "ANALOG:RATE": _reals(motion.rate * analog.per_frame),
        "ANALOG:GEN_SCALE": _reals(analog.general),
        "ANALOG:SCALE": _reals(analog.scales[:_MOST]),
        "ANALOG:OFFSET": _integers(analog.offsets[:_MOST].astype(np.int64)),
        "ANALOG:FORMAT": _string("UNSIGNED" if analog.unsigned else "SIGNED"),
    }
    found |= _strings("ANALOG:LABELS", motion.analog.names)
    return found | _strings("ANALOG:UNITS", motion.analog.units)


def _event_parameters(motion: MarkerMotion, lost: list[str]) -> dict[str, _Parameter]:
    labels = motion.labels[:_MOST]
    if len(labels) < len(motion.labels):
        lost.append(f"events after the {_MOST}th")
    minutes = [floor(label.time / 60) for label in labels]
    times = [(m, label.time - 60 * m) for m, label in zip(minutes, labels, strict=True)]
    return {
        "EVENT:USED": _integers(len(labels)),
        "EVENT:TIMES": _reals(np.array(times)),
        **_strings("EVENT:LABELS", tuple(label.name for label in labels)),
        **_strings("EVENT:CONTEXTS", tuple(label.context for label in labels)),
        **_strings("EVENT:SUBJECTS", tuple(label.subject for label in labels)),
    }


def _from_note(name: str, text: str) -> _Parameter | None:
    """A parameter out of JSON, as `read_c3d` keeps it."""
    _group, _, own = name.partition(":")
    if not own or not (0 < len(name.encode()) < 120):
        return None
    try:
        value = json.loads(text)
        if isinstance(value, list) and value and all(isinstance(item, str) for item in value):
            return next(iter(_strings(name, tuple(value)).values()))
        array = np.asarray(value)
    except (ValueError, RecursionError):
        return None
    if array.dtype.kind not in "if" or array.ndim > 7 or max(array.shape, default=0) > _MOST:
        return None
    small = array.dtype.kind == "i" and (not array.size or np.abs(array).max() <= 65535)
    parameter = _integers(array) if small else _reals(array)
    return parameter if len(parameter.data) <= _LARGEST_PARAMETER else None


def _integers(values: ArrayLike) -> _Parameter:
    array = np.asarray(values, dtype=np.int64)
    return _Parameter(2, array.shape[::-1], (array & 0xFFFF).astype("<u2").tobytes())


def _reals(values: ArrayLike) -> _Parameter:
    array = np.asarray(values, dtype="<f4")
    return _Parameter(4, array.shape[::-1], array.tobytes())


def _string(value: str) -> _Parameter:
    data = value.encode()
    return _Parameter(-1, (len(data),), data)


def _strings(name: str, values: tuple[str, ...]) -> dict[str, _Parameter]:
    """A parameter, and NAME2, NAME3 ... where one can't hold all."""
    encoded = [_cut(value) for value in values]
    width = max([1, *map(len, encoded)])
    count = min(_MOST, _LARGEST_PARAMETER // width)
    found = {}
    for part in range(0, max(len(encoded), 1), count):
        some = encoded[part : part + count]
        suffix = "" if not part else str(part // count + 1)
        data = b"".join(value.ljust(width) for value in some)
        found[name + suffix] = _Parameter(-1, (width, len(some)), data)
    return found


def _cut(value: str) -> bytes:
    data = value.encode()[:_MOST]
    return data.decode("utf-8", errors="ignore").encode()


def _section(parameters: Mapping[str, _Parameter], lost: list[str]) -> bytes:
    """The parameter blocks; what does not fit into 255 of them is left out."""
    names = dict.fromkeys((*_OURS, *(name.partition(":")[0] for name in parameters)))
    groups = {name: index for index, name in enumerate(list(names)[:127], start=1)}
    records: list[bytes] = [_record(name, -index, b"\0") for name, index in groups.items()]
    room = _MOST * BLOCK - 8 - sum(map(len, records))
    for name, parameter in parameters.items():
        group, _, own = name.partition(":")
        if group not in groups:
            lost.append(f"the parameter {name}, for there are too many groups")
            continue
        head = struct.pack("<bB", parameter.kind, len(parameter.dimensions))
        body = head + bytes(parameter.dimensions) + parameter.data + b"\0"
        record = _record(own, groups[group], body)
        if len(record) > room:
            lost.append(f"the parameter {name}, for want of room")
            continue
        room -= len(record)
        records.append(record)
    size = 4 + sum(map(len, records)) + 4
    blocks = -(-size // BLOCK)
    whole = bytearray(struct.pack("4B", 1, KEY, blocks, 84) + b"".join(records))
    return bytes(whole.ljust(blocks * BLOCK, b"\0"))


def _record(name: str, group: int, body: bytes) -> bytes:
    encoded = name.upper().encode()
    return (
        struct.pack("<bb", len(encoded), group) + encoded + struct.pack("<H", 2 + len(body)) + body
    )
