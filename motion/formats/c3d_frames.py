"""The frames of a C3D file: points and analog samples, taken in pieces so that memory stays low.

An integer point is 8 bytes in the file and 24 in float64, 29 with its residual and its cameras: 3.6
times the file. Hence pieces are small, and room for residuals and cameras is taken from the system
only where a file has some: numpy's zeros are not there until somebody writes on them.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, BinaryIO

import numpy as np
from numpy.typing import NDArray

from enpointe.motion.formats.c3d_parameters import Encoding

__all__ = ["Frames", "Layout", "read_frames"]

_PIECE = 1 << 15


@dataclass(frozen=True, slots=True)
class Layout:
    """Where and how the frames stand.

    Attributes:
        start: First byte.
        frames: How many; the file has that many.
        points: In a frame, four numbers each.
        channels: Analog channels.
        per_frame: Analog samples of each channel in a frame.
        scale: Size of an integer step; negative for floats.
        unsigned: Whether integer analog samples have no sign.
        gains: (channels,), units per step.
        offsets: (channels,), steps at zero.
    """

    start: int
    frames: int
    points: int
    channels: int
    per_frame: int
    scale: float
    unsigned: bool
    gains: NDArray[np.float64]
    offsets: NDArray[np.float64]

    @property
    def numbers(self) -> int:
        """In a frame."""
        return 4 * self.points + self.channels * self.per_frame

    @property
    def frame_bytes(self) -> int:
        """Size of a frame."""
        return self.numbers * (4 if self.scale < 0 else 2)


@dataclass(frozen=True, slots=True)
class Frames:
    """What the frames hold.

    Attributes:
        positions: (T, M, 3), NaN where a point is marked as not valid.
        residuals: (T, M), NaN where a point is marked as not valid; None where all are 0 and no
            camera is named.
        cameras: (T, M), bit masks; None where residuals are.
        analog: (T * per_frame, channels).
        discarded: Points marked as not valid that had coordinates.
    """

    positions: NDArray[np.float64]
    residuals: NDArray[np.float32] | None
    cameras: NDArray[np.uint8] | None
    analog: NDArray[np.float32]
    discarded: int


def read_frames(file: BinaryIO, layout: Layout, encoding: Encoding) -> Frames:
    """All frames. The caller has made sure that the file holds them."""
    points = _Points(layout)
    analog = np.empty((layout.frames * layout.per_frame, layout.channels), dtype=np.float32)
    file.seek(layout.start)
    step = max(_PIECE // layout.frame_bytes, 1)
    for first in range(0, layout.frames, step):
        last = min(first + step, layout.frames)
        raw = file.read((last - first) * layout.frame_bytes)
        numbers = encoding.reals(raw) if layout.scale < 0 else encoding.words(raw)
        table = numbers.reshape(last - first, layout.numbers)
        with np.errstate(all="ignore"):
            four = table[:, : 4 * layout.points].reshape(last - first, layout.points, 4)
            points.take(four, slice(first, last))
            rows = slice(first * layout.per_frame, last * layout.per_frame)
            _take_analog(table[:, 4 * layout.points :], layout, analog[rows])
    return points.with_analog(analog)


class _Points:
    """What the points of the frames taken so far are."""

    def __init__(self, layout: Layout) -> None:
        shape = (layout.frames, layout.points)
        self._scale = layout.scale
        self._positions = np.empty((*shape, 3))
        self._residuals = np.zeros(shape, dtype=np.float32)
        self._cameras = np.zeros(shape, dtype=np.uint8)
        self._measured = False
        self._discarded = 0

    def take(self, points: NDArray[Any], rows: slice) -> None:
        """The fourth word is -1, or cameras in its high byte and the residual in its low one."""
        positions = self._positions[rows]
        if self._scale < 0:
            positions[...] = points[..., :3]
            fourth = np.asarray(points[..., 3], dtype=np.float32)
            marks = np.where((fourth >= 0) & (fourth < 32768), fourth, -1).astype(np.int16)
            unseen = (marks < 0) | ~np.isfinite(positions).all(axis=2)
        else:
            np.multiply(points[..., :3], self._scale, out=positions)
            marks = points[..., 3].astype(np.int16)
            unseen = marks < 0
        gaps = bool(unseen.any())
        if gaps:
            self._discarded += int(((positions != 0).any(axis=2) & unseen).sum())
            positions[unseen] = np.nan
            marks[unseen] = 0
        if marks.any():
            self._measured = True
            self._residuals[rows] = (marks & 0xFF).astype(np.float32) * np.float32(abs(self._scale))
            self._cameras[rows] = marks >> 8
        if gaps:
            self._residuals[rows][unseen] = np.nan

    def with_analog(self, analog: NDArray[np.float32]) -> Frames:
        """All of it, with the analog samples."""
        return Frames(
            self._positions,
            self._residuals if self._measured else None,
            self._cameras if self._measured else None,
            analog,
            self._discarded,
        )


def _take_analog(samples: NDArray[Any], layout: Layout, taken: NDArray[np.float32]) -> None:
    if not samples.size:
        return
    steps = samples.reshape(-1, layout.channels)
    if layout.unsigned and layout.scale > 0:
        steps = steps.view(steps.dtype.str.replace("i", "u"))
    values = steps - layout.offsets
    values *= layout.gains
    taken[...] = values
