"""The frames of a C3D file: points and analog samples, taken in pieces so that memory stays low."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, BinaryIO

import numpy as np
from numpy.typing import NDArray

from enpointe.motion.formats.c3d_parameters import Encoding

__all__ = ["Frames", "Layout", "read_frames"]

_PIECE = 1 << 18


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
        residuals: (T, M).
        cameras: (T, M), bit masks.
        analog: (T * per_frame, channels).
        discarded: Points marked as not valid that had coordinates.
    """

    positions: NDArray[np.float64]
    residuals: NDArray[np.float32]
    cameras: NDArray[np.uint8]
    analog: NDArray[np.float32]
    discarded: int


def read_frames(file: BinaryIO, layout: Layout, encoding: Encoding) -> Frames:
    """All frames. The caller has made sure that the file holds them."""
    shape = (layout.frames, layout.points)
    samples = layout.frames * layout.per_frame
    frames = Frames(
        np.empty((*shape, 3)),
        np.empty(shape, dtype=np.float32),
        np.empty(shape, dtype=np.uint8),
        np.empty((samples, layout.channels), dtype=np.float32),
        0,
    )
    discarded = 0
    file.seek(layout.start)
    step = max(_PIECE // layout.frame_bytes, 1)
    for first in range(0, layout.frames, step):
        last = min(first + step, layout.frames)
        raw = file.read((last - first) * layout.frame_bytes)
        numbers = encoding.reals(raw) if layout.scale < 0 else encoding.words(raw)
        table = numbers.reshape(last - first, layout.numbers)
        with np.errstate(all="ignore"):
            points = table[:, : 4 * layout.points].reshape(last - first, layout.points, 4)
            discarded += _take_points(points, layout, frames, slice(first, last))
            _take_analog(table[:, 4 * layout.points :], layout, frames, first, last)
    return Frames(frames.positions, frames.residuals, frames.cameras, frames.analog, discarded)


def _take_points(points: NDArray[Any], layout: Layout, frames: Frames, rows: slice) -> int:
    """The fourth word is -1, or cameras in its high byte and the residual in its low one."""
    positions = frames.positions[rows]
    if layout.scale < 0:
        positions[...] = points[..., :3]
        fourth = np.asarray(points[..., 3], dtype=np.float32)
        marks = np.where((fourth >= 0) & (fourth < 32768), fourth, -1).astype(np.int16)
        unseen = (marks < 0) | ~np.isfinite(positions).all(axis=2)
    else:
        np.multiply(points[..., :3], layout.scale, out=positions)
        marks = np.asarray(points[..., 3]).astype(np.int16)
        unseen = marks < 0
    discarded = int(((positions != 0).any(axis=2) & unseen).sum()) if unseen.any() else 0
    positions[unseen] = np.nan
    residuals = (marks & 0xFF).astype(np.float32) * np.float32(abs(layout.scale))
    residuals[unseen] = np.nan
    frames.residuals[rows] = residuals
    cameras = (marks >> 8).astype(np.uint8)
    cameras[unseen] = 0
    frames.cameras[rows] = cameras
    return discarded


def _take_analog(
    samples: NDArray[Any], layout: Layout, frames: Frames, first: int, last: int
) -> None:
    if not samples.size:
        return
    steps = samples.reshape(-1, layout.channels)
    if layout.unsigned and layout.scale > 0:
        steps = steps.view(steps.dtype.str.replace("i", "u"))
    rows = slice(first * layout.per_frame, last * layout.per_frame)
    frames.analog[rows] = (steps - layout.offsets) * layout.gains
