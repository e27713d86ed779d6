"""Whether the flights that `enpointe check` finds in captured takes are in the captures themselves.

For each flight, of the file's own body before any foot is pinned: how high the lower of the two toe
joints is over where it lies when that foot rests in the same take (least, median and most, mm); the
lowest ankle, mm; what the captured centre of mass falls with, m/s^2, and its vertical speeds at the
ends, m/s; and how far each toe joint travels, m. Nobody who stands on a foot moves it half a metre,
and nobody who stands falls.

    python benchmarks/flights.py ../shared/data/cmu_05/05_11.amc FILE ...
"""

from __future__ import annotations

import os

os.environ.setdefault("OMP_NUM_THREADS", "1")
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import argparse
from pathlib import Path

import numpy as np

import enpointe
from enpointe.models.anatomy import SIDES
from enpointe.motion.formats import read
from enpointe.motion.retargeting import propose_map
from enpointe.motion.retargeting.aloft import weight_centre
from enpointe.motion.retargeting.flips import mended
from enpointe.motion.retargeting.floor import levelled
from enpointe.motion.retargeting.source import Source, source_of

RESTS = 0.1
"""m/s: a foot whose ankle is slower rests."""


def rest(source: Source, side: str) -> float:
    """Height of a toe joint over the floor while its foot rests low, m."""
    ankle, toe = source.points[f"{side}_ankle"], source.points[f"{side}_toe"]
    speed = np.linalg.norm(np.gradient(ankle, source.time, axis=0), axis=1)
    low = ankle[:, 2] < np.percentile(ankle[:, 2], 50.0)
    return float(np.median(toe[(speed < RESTS) & low, 2]))


def said(source: Source, start: float, end: float) -> str:
    """One flight in figures."""
    first, last = (round(t * source.rate) for t in (start, end))
    rows = slice(first, last + 1)
    toes = {side: source.points[f"{side}_toe"] for side in SIDES}
    over = 1e3 * np.min([toes[side][rows, 2] - rest(source, side) for side in SIDES], axis=0)
    ankle = 1e3 * min(source.points[f"{side}_ankle"][rows, 2].min() for side in SIDES)
    height = weight_centre(source.points)[:, 2]
    speed = np.gradient(height, source.time)
    fall = -2.0 * np.polyfit(source.time[rows], height[rows], 2)[0]
    travels = [np.linalg.norm(toe[last, :2] - toe[first, :2]) for toe in toes.values()]
    return (
        f"{start:.2f}-{end:.2f} s: toes {over.min():.0f} {np.median(over):.0f} {over.max():.0f} mm,"
        f" ankle {ankle:.0f} mm, falls {fall:.1f} m/s2, {speed[first]:+.2f} to {speed[last]:+.2f}"
        f" m/s, toes travel {travels[0]:.2f} and {travels[1]:.2f} m"
    )


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("files", nargs="+", type=Path)
    for path in parser.parse_args().files:
        content = read(path).motion
        source = levelled(mended(source_of(content, propose_map(content))))
        for flight in enpointe.check(path).found.flights:
            print(path.stem, said(source, flight.start, flight.end), flush=True)


if __name__ == "__main__":
    main()
