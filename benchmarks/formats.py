"""How long reading motion files takes, and how much memory, beside peers on the same files.

    python benchmarks/formats.py [--data ../shared/data] [--repeats 5] [--json]

Files of 4 and 40 MB are made by repeating the frames of a real BVH and a real AMC take. Each
reader runs in a process of its own that imports it, reads the file once to time it, and tells the
peak of its memory; readers take turns, and the best of the repeats counts. The floor is pandas
reading only the block of numbers, as fast as C does. Peers that are not installed are left out.
"""

from __future__ import annotations

import argparse
import json
import re
import subprocess
import sys
import tempfile
from importlib.util import find_spec
from pathlib import Path

_PROBE = """
import resource, sys, time
path = sys.argv[1]
{prepare}
before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
started, worked = time.perf_counter(), time.process_time()
{read}
taken, work = time.perf_counter() - started, time.process_time() - worked
peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
print(taken, work, peak / 1024, (peak - before) / 1024)
"""
_OURS = ("from enpointe.motion.formats import read", "read(path)")
_PANDAS = """
import pandas
with open(path, "rb") as file:
    skipped = 1
    for line in file:
        if line.startswith(b"Frame Time"):
            break
        skipped += 1
"""
_FLOOR = 'pandas.read_csv(path, sep=" ", header=None, skiprows=skipped, engine="c").to_numpy()'
_PYBVH = ("import pybvh", "pybvh.read_bvh_file(path)")
_LOADTXT = (
    "import numpy\nskipped = 1 + [line[:10] for line in open(path)].index('Frame Time')",
    "numpy.loadtxt(path, skiprows=skipped)",
)
_ASFAMC = ("import asfamcparser", "asfamcparser.ParseAMC(path)")
_PLAIN_AMC = (
    "",
    """
frames = []
for line in open(path):
    name, *numbers = line.split()
    if not numbers and name.isdigit():
        frames.append({})
    elif frames:
        frames[-1][name] = [float(number) for number in numbers]
""",
)
_READERS = {
    "bvh": {
        "enpointe": _OURS,
        "pybvh": _PYBVH,
        "numpy.loadtxt, numbers only": _LOADTXT,
        "pandas, numbers only": (_PANDAS, _FLOOR),
    },
    "amc": {"enpointe": _OURS, "asfamc-parser": _ASFAMC, "float and split": _PLAIN_AMC},
}
_NEEDS = {"pybvh": "pybvh", "pandas, numbers only": "pandas", "asfamc-parser": "asfamcparser"}
_SIZES = {"4 MB": 4e6, "40 MB": 40e6}


def made_bvh(source: Path, size: float, folder: Path) -> Path:
    """A BVH of that many bytes: a real one with its frames repeated, in its own digits."""
    raw = source.read_bytes().replace(b"\r\n", b"\n")
    start = raw.index(b"\n", raw.index(b"Frame Time")) + 1
    rows = b"".join(b" ".join(line.split()) + b"\n" for line in raw[start:].strip().split(b"\n"))
    times = max(1, round(size / len(rows)))
    count = rows.count(b"\n") * times
    before, _, after = raw[:start].partition(b"Frames:")
    head = before + b"Frames: %d\n" % count + after.split(b"\n", 1)[1]
    path = folder / f"{size / 1e6:.0f}.bvh"
    path.write_bytes(head + rows * times)
    return path


def made_amc(source: Path, size: float, folder: Path) -> Path:
    """An AMC of that many bytes, its frames counted on, its skeleton beside it.

    Comments above the flags are left out: asfamc-parser can't read a file that has some.
    """
    head, *poses = re.split(r"^\d+\n", source.read_text(), flags=re.MULTILINE)
    count = max(1, round(size / (sum(map(len, poses)) / len(poses))))
    path = folder / f"{size / 1e6:.0f}.amc"
    with path.open("w") as file:
        file.writelines(line for line in head.splitlines(keepends=True) if line[0] != "#")
        file.writelines(f"{i + 1}\n{poses[i % len(poses)]}" for i in range(count))
    path.with_suffix(".asf").write_bytes((source.parent / "05.asf").read_bytes())
    return path


def probed(path: Path, prepare: str, read: str) -> dict[str, float]:
    """Seconds by the clock and of the processor, peak MB, and MB that reading added to it."""
    code = _PROBE.format(prepare=prepare, read=read)
    ran = subprocess.run(
        [sys.executable, "-c", code, str(path)], capture_output=True, text=True, check=True
    )
    names = ("seconds", "cpu_seconds", "peak_mb", "added_mb")
    return dict(zip(names, map(float, ran.stdout.split()), strict=True))


def measured(path: Path, repeats: int) -> dict[str, dict[str, float]]:
    """Best time and least memory of each reader, taken in turns."""
    readers = {
        name: code
        for name, code in _READERS[path.suffix[1:]].items()
        if name not in _NEEDS or find_spec(_NEEDS[name]) is not None
    }
    runs: dict[str, list[dict[str, float]]] = {name: [] for name in readers}
    for _ in range(repeats):
        for name, (prepare, read) in readers.items():
            runs[name].append(probed(path, prepare, read))
    return {
        name: {key: min(run[key] for run in found) for key in found[0]}
        for name, found in runs.items()
    }


def main() -> None:
    """Makes the files, measures, prints a table or JSON."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    root = Path(__file__).resolve().parents[1]
    parser.add_argument("--data", type=Path, default=root.parent / "shared" / "data")
    parser.add_argument("--repeats", type=int, default=5)
    parser.add_argument("--json", action="store_true")
    options = parser.parse_args()
    bvh = options.data / "rokoko" / "jesse_dance.bvh"
    amc = options.data / "cmu_05" / "05_18.amc"
    table = {}
    with tempfile.TemporaryDirectory() as name:
        for size, count in _SIZES.items():
            for make, source in ((made_bvh, bvh), (made_amc, amc)):
                path = make(source, count, Path(name))
                table[f"{path.suffix[1:].upper()} {size}"] = measured(path, options.repeats)
                path.unlink()
    if options.json:
        print(json.dumps(table, indent=2))
        return
    print("| file | reader | s | s of processor | peak, MB | of these for the file |")
    print("| --- | --- | --- | --- | --- | --- |")
    for file, readers in table.items():
        for reader, found in readers.items():
            print(
                f"| {file} | {reader} | {found['seconds']:.3f} "
                f"| {found['cpu_seconds']:.3f} | {found['peak_mb']:.0f} "
                f"| {found['added_mb']:.0f} |"
            )


if __name__ == "__main__":
    main()
