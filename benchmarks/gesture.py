"""A gesture file written and read as it streams, beside numpy writing and reading the bare numbers.

A hundred channels of one track at 4 kHz, the fastest that ENACTIVE D.RD3.3.1 asks for. Ways are
timed one after another in each repeat, so that a busy moment hits all; rates are medians, and
beside each stands the median of its time over that of the floor in the same repeat: `np.save` for
writing, `np.fromfile` for reading. Files are in the temporary folder and in the page cache: this is
the time of the code and not of the disk.

    python benchmarks/gesture.py
    python benchmarks/gesture.py --seconds 60 --repeats 9 --json
"""

from __future__ import annotations

import os

# Before numpy: the machine's other cores are not what is measured.
os.environ.setdefault("OMP_NUM_THREADS", "1")
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import argparse
import json
from collections.abc import Callable
from pathlib import Path
from statistics import median
from tempfile import TemporaryDirectory
from time import perf_counter

import numpy as np
from numpy.typing import NDArray

from enpointe.motion.gesture import (
    Channel,
    Dimension,
    Encoding,
    GestureReader,
    GestureWriter,
    Unit,
    read_scene,
)

RATE, CHANNELS, BLOCK = 4000.0, 100, 40
UNIT = Unit("device", tuple(Channel(f"c{i}", dimension=Dimension.X) for i in range(CHANNELS)), RATE)
FLOORS = {"write": "np.save", "read": "np.fromfile"}
Array = NDArray[np.float64]


def writers(rows: Array, folder: Path) -> dict[str, Callable[[], None]]:
    """Ways to write, by name."""

    def stream(name: str, encoding: Encoding, size: int) -> None:
        path = folder / f"{name}.gst"
        path.unlink(missing_ok=True)
        with GestureWriter(path, [UNIT], encoding=encoding) as writer:
            for first in range(0, len(rows), size):
                writer.append(rows[first : first + size])

    return {
        "np.save": lambda: np.save(folder / "floor.npy", rows),
        "float64, 40 frames at a time": lambda: stream("float64", Encoding(), BLOCK),
        "float64, frame by frame": lambda: stream("single", Encoding(), 1),
        "float32, 40 frames at a time": lambda: stream("float32", Encoding("float32"), BLOCK),
        "integers, 40 frames at a time": lambda: stream("int32", Encoding("int32", 1e-6), BLOCK),
    }


def readers(folder: Path) -> dict[str, Callable[[], object]]:
    """Ways to read what the writers wrote, by name."""

    def blocks(name: str) -> None:
        with GestureReader(folder / f"{name}.gst") as reader:
            for _ in reader.blocks():
                pass

    return {
        "np.fromfile": lambda: np.fromfile(folder / "floor.npy"),
        "float64, in blocks": lambda: blocks("float64"),
        "float64, the whole scene": lambda: read_scene(folder / "float64.gst"),
        "float32, in blocks": lambda: blocks("float32"),
        "integers, in blocks": lambda: blocks("int32"),
    }


def timed(ways: dict[str, Callable[[], object]], repeats: int) -> dict[str, list[float]]:
    """s of each way in each repeat."""
    taken: dict[str, list[float]] = {name: [] for name in ways}
    for _ in range(repeats):
        for name, way in ways.items():
            start = perf_counter()
            way()
            taken[name].append(perf_counter() - start)
    return taken


def main() -> None:
    """Run and print."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--seconds", type=float, default=20.0, help="of the gesture")
    parser.add_argument("--repeats", type=int, default=5)
    parser.add_argument("--json", action="store_true")
    options = parser.parse_args()
    frames = int(options.seconds * RATE)
    rows = np.random.default_rng(0).normal(size=(frames, CHANNELS))
    found = []
    with TemporaryDirectory() as folder:
        for doing, ways in (
            ("write", writers(rows, Path(folder))),
            ("read", readers(Path(folder))),
        ):
            taken = timed(dict(ways), options.repeats)
            floor = taken[FLOORS[doing]]
            for name, times in taken.items():
                typical = median(times)
                size = 4 if name.startswith(("float32", "integers")) else 8
                found.append(
                    {
                        "doing": doing,
                        "way": name,
                        "mb_per_second": frames * CHANNELS * size / typical / 1e6,
                        "frames_per_second": frames / typical,
                        "times_real_time": options.seconds / typical,
                        "times_floor": median(t / f for t, f in zip(times, floor, strict=True)),
                    }
                )
    if options.json:
        print(json.dumps({"seconds": options.seconds, "repeats": options.repeats, "ways": found}))
        return
    print(f"{frames} frames of {CHANNELS} tracks, median of {options.repeats}")
    print("| | MB/s | frames/s | times real time | time over floor |")
    print("| --- | --- | --- | --- | --- |")
    for row in found:
        print(
            f"| {row['doing']}: {row['way']} | {row['mb_per_second']:.0f} "
            f"| {row['frames_per_second']:,.0f} | {row['times_real_time']:,.0f} "
            f"| {row['times_floor']:.2f} |"
        )


if __name__ == "__main__":
    main()
