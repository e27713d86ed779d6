"""Whole scenes to files and back."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from enpointe.errors import FormatError, MotionError
from enpointe.files import atomic_path
from enpointe.motion.gesture.encoding import Encoding
from enpointe.motion.gesture.holding import Holding
from enpointe.motion.gesture.reader import GestureReader
from enpointe.motion.gesture.scene import Scene
from enpointe.motion.gesture.writer import GestureWriter

__all__ = ["read_scene", "write_scene"]

Array = NDArray[np.float64]
_BLOCK_BYTES = 2**20


def read_scene(path: str | Path, *, unsigned: bool = False) -> Scene:
    """The scene in a GST file; `GestureReader` also tells what was doubtful.

    Args:
        path: The file.
        unsigned: Whether its integers, if it has any, are unsigned.

    Raises:
        FormatError: No such file, or none that can be understood, with the byte.
    """
    with GestureReader(path, unsigned=unsigned) as reader:
        return reader.scene()


def write_scene(scene: Scene, path: str | Path, encoding: Encoding | None = None) -> None:
    """Write a scene, beside and renamed; units slower than the fastest have their samples held.

    Args:
        scene: What to write.
        path: Where to; what is there is replaced.
        encoding: How numbers are stored; float64 where None.

    Raises:
        FormatError: The file can't hold the scene, or its disk can't.
        EnpointeError: The file can't be written there.
    """
    rate = scene.rate
    holdings = [Holding.of(rate, unit.rate) for unit in scene.units]
    counts = [len(signal) for signal in scene.signals]
    pairs = list(zip(holdings, counts, strict=True))
    frames = max(holding.frames_for(count) for holding, count in pairs)
    plain = all(holding.samples_before(frames) == count for holding, count in pairs)
    try:
        with (
            atomic_path(path) as beside,
            GestureWriter(
                beside,
                scene.units,
                name=scene.name,
                encoding=encoding,
                flush_seconds=np.inf,
                counts=None if plain else counts,
            ) as writer,
        ):
            if frames > writer.most:
                raise MotionError(f"{frames} frames would pass 4 GiB, the most that a file holds")
            for block in _blocks(
                scene, holdings, frames, max(_BLOCK_BYTES // writer.width // 8, 1)
            ):
                writer.append(block)
    except MotionError as error:
        raise FormatError(str(error), path) from None
    except FormatError as error:
        raise FormatError(error.message, path) from None


def _blocks(scene: Scene, holdings: list[Holding], frames: int, size: int) -> Iterator[Array]:
    for first in range(0, frames, size):
        last = min(first + size, frames)
        yield np.hstack(
            [
                _held(signal, holding, first, last)
                for signal, holding in zip(scene.signals, holdings, strict=True)
            ]
        )


def _held(signal: Array, holding: Holding, first: int, last: int) -> Array:
    """(last - first, width): the unit in those frames, its last sample held; zeros for none."""
    if holding.frames == holding.samples and last <= len(signal):
        return signal[first:last]
    if not len(signal):
        return np.zeros((last - first, signal.shape[1]))
    return signal[np.minimum(holding.held(first, last), len(signal) - 1)]
