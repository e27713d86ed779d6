"""How fast marker files are read, and in how much memory, beside the packages that there are.

Every reading runs in a process of its own, the readers take turns, and the files are made here
(the same each time), with real ones beside the checkout where there are any. A reader that is not
installed is left out: `pip install c3d ezc3d pandas trc-data-reader`.

    python benchmarks/marker_formats.py
    python benchmarks/marker_formats.py --rounds 9 --json
"""

from __future__ import annotations

import os

os.environ.setdefault("OMP_NUM_THREADS", "1")
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import argparse
import importlib.util
import json
import subprocess
import sys
import warnings
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from tempfile import TemporaryDirectory
from time import perf_counter
from typing import Any

import numpy as np

from enpointe.motion.formats import Analog, MarkerMotion, Space

DATA = Path(__file__).resolve().parents[2] / "shared" / "data"
REAL = (
    "trc/Gait.trc",
    "csm/ThomasFechten.csm",
    "c3d_various/Qualisys.c3d",
    "cmu_c3d/85_02.c3d",
    "c3d_org/sample01/Eb015pi.c3d",
)
PEERS = {
    ".trc": {"enpointe": "enpointe", "pandas": "pandas", "trc-data-reader": "trc"},
    ".csm": {"enpointe": "enpointe", "pandas": "pandas"},
    ".c3d": {"enpointe": "enpointe", "c3d": "c3d", "ezc3d": "ezc3d"},
}
READS = 4


def moved(
    frames: int, markers: int, *, gaps: bool = False, channels: int = 0, measured: bool = False
) -> MarkerMotion:
    """Markers that walk about at random, the same each time; measured, with their residuals."""
    rng = np.random.default_rng(20)
    steps = rng.normal(0, 3, (frames, markers, 3))
    steps[0] += rng.uniform(-900, 900, (markers, 3))
    positions = np.round(np.cumsum(steps, axis=0), 5).astype(np.float32).astype(float)
    positions = np.round(positions, 5)
    if gaps:
        positions[rng.random((frames, markers)) < 0.1] = np.nan
    analog = None
    if channels:
        values = rng.normal(size=(9 * frames, channels)).astype(np.float32)
        names = tuple(f"A{i}" for i in range(channels))
        analog = Analog(names, ("V",) * channels, 1080.0, values)
    names = tuple(f"M{i}" for i in range(markers))
    motion = MarkerMotion(names, 120.0, positions, Space(0.001, "z"), analog=analog)
    if not measured:
        return motion
    units = rng.integers(1, 127, (2, frames, markers))
    residuals = np.where(motion.seen, units[0] * 0.125, np.nan).astype(np.float32)
    return replace(motion, residuals=residuals, cameras=(units[1] * motion.seen).astype(np.uint8))


def made(folder: Path) -> list[Path]:
    """Files of some 4 and 40 MB, and of sizes that reference figures of the peers are known for."""
    from enpointe.motion.formats.c3d import write_c3d
    from enpointe.motion.formats.csm import write_csm
    from enpointe.motion.formats.trc import write_trc

    write_trc(moved(2105, 44), folder / "2105x44.trc")
    write_trc(moved(2105, 44, gaps=True), folder / "2105x44 gaps.trc")
    write_trc(moved(29000, 44), folder / "29000x44.trc")
    write_csm(moved(2105, 44), folder / "2105x44.csm")
    write_c3d(moved(5920, 44), folder / "5920x44 real.c3d", scale=0.0)
    write_c3d(moved(59200, 44), folder / "59200x44 real.c3d", scale=0.0)
    write_c3d(moved(5920, 44), folder / "5920x44 integer.c3d", scale=0.125)
    measured = moved(5920, 44, gaps=True, measured=True)
    write_c3d(measured, folder / "5920x44 integer, residuals.c3d", scale=0.125)
    write_c3d(moved(1577, 74, channels=36), folder / "1577x74+36 real.c3d", scale=0.0)
    return sorted(folder.iterdir())


def ours(path: Path) -> object:
    """Read by its own reader, as `enpointe.motion.formats.read` does."""
    from enpointe.motion.formats import read

    return read(path)


def pandas(path: Path) -> object:
    """The rows alone, which is the least that a reader has to do."""
    import pandas as package

    with path.open() as file:
        head = [next(file) for _ in range(30)]
    first = next(i for i, line in enumerate(head) if line.split()[:1] in (["1"], ["0"]))
    sep = "\t" if path.suffix == ".trc" else r"\s+"
    names = range(400) if path.name == "Gait.trc" else None  # its rows differ in length
    return package.read_csv(path, sep=sep, skiprows=first, header=None, names=names)


def trc_data_reader(path: Path) -> object:
    """The package's own way."""
    from trc import TRCData

    data = TRCData()
    data.load(str(path))
    return data


def c3d(path: Path) -> object:
    """All frames as arrays."""
    import c3d as package

    with path.open("rb") as file:
        frames = list(package.Reader(file).read_frames())
    return np.array([points for _, points, _ in frames]), [analog for *_, analog in frames]


def ezc3d(path: Path) -> object:
    """All frames as arrays."""
    import ezc3d as package

    data = package.c3d(str(path))["data"]
    return data["points"], data["analogs"]


READERS: dict[str, Callable[[Path], object]] = {
    "enpointe": ours,
    "pandas": pandas,
    "trc-data-reader": trc_data_reader,
    "c3d": c3d,
    "ezc3d": ezc3d,
}


def peak_kb(*, reset: bool = False) -> int:
    """The most memory that this process has had, from now on where it is reset (Linux alone)."""
    if reset:
        Path("/proc/self/clear_refs").write_text("5")
    lines = Path("/proc/self/status").read_text().splitlines()
    return next(int(line.split()[1]) for line in lines if line.startswith("VmHWM"))


def one(reader: str, path: Path) -> dict[str, float]:
    """In this process: a first reading for the imports, then the shortest of some."""
    warnings.simplefilter("ignore")
    warm(reader, path.suffix)
    before = peak_kb(reset=True)
    times = []
    for _ in range(READS):
        start = perf_counter()
        READERS[reader](path)
        times.append(perf_counter() - start)
        if len(times) == 1:
            after = peak_kb()
    return {"seconds": min(times), "more_kb": after - before}


def warm(reader: str, suffix: str) -> None:
    """Loads the reader's modules on a small file of the kind."""
    from enpointe.motion.formats import write

    with TemporaryDirectory() as folder:
        small = Path(folder) / f"small{suffix}"
        write(moved(40, 2), small)
        READERS[reader](small)


def measured(path: Path, rounds: int) -> list[dict[str, Any]]:
    """All readers of a file in turns; the median of each."""
    readers = [
        reader
        for reader, module in PEERS[path.suffix.lower()].items()
        if importlib.util.find_spec(module) is not None
    ]
    found: dict[str, list[dict[str, float]]] = {reader: [] for reader in readers}
    for _ in range(rounds):
        for reader in readers:
            ran = subprocess.run(
                [sys.executable, __file__, "--one", reader, str(path)],
                capture_output=True,
                text=True,
                check=False,
            )
            if ran.returncode == 0:
                found[reader].append(json.loads(ran.stdout))
    rows = []
    size = path.stat().st_size
    for reader, runs in found.items():
        row: dict[str, Any] = {"file": path.name, "mb": size / 1e6, "reader": reader}
        if runs:
            row["ms"] = 1e3 * float(np.median([run["seconds"] for run in runs]))
            row["memory_of_file"] = 1024 * float(np.median([r["more_kb"] for r in runs])) / size
        rows.append(row)
    return rows


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("--json", action="store_true")
    parser.add_argument("--one", nargs=2, metavar=("READER", "FILE"), help=argparse.SUPPRESS)
    options = parser.parse_args()
    if options.one:
        print(json.dumps(one(options.one[0], Path(options.one[1]))))
        return
    with TemporaryDirectory() as folder:
        paths = made(Path(folder)) + [DATA / name for name in REAL if (DATA / name).is_file()]
        rows = [row for path in paths for row in measured(path, options.rounds)]
    if options.json:
        print(json.dumps({"readings": rows}))
        return
    print(
        "| file | MB | reader | ms | peak memory, times the file |\n| --- | --- | --- | --- | --- |"
    )
    for row in rows:
        figures = f"{row['ms']:.1f} | {row['memory_of_file']:.1f}" if "ms" in row else "fails | "
        print(f"| {row['file']} | {row['mb']:.2f} | {row['reader']} | {figures} |")


if __name__ == "__main__":
    main()
