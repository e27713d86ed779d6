"""How many captured frames a second `retarget` puts on the dancer, and how true they are.

For each file: frames, frames a second of processor time, so that other work on the machine counts
for little (the median of the repeats, maps and residuals included), how
far the ball of a standing foot goes from where it came to stand, how high a sole that bears is and
how deep any is, mm, and the mean over thighs, shanks, upper arms and forearms of the median angle
between the captured direction and the dancer's, and of its 95th percentile, degrees.

    python benchmarks/retarget.py ../shared/data/cmu_05/*.amc
    python benchmarks/retarget.py FILE ... --repeats 5 --json
"""

from __future__ import annotations

import os

# Before numpy: the machine's other cores are not what is measured.
os.environ.setdefault("OMP_NUM_THREADS", "1")
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import argparse
import json
from pathlib import Path
from statistics import mean, median
from time import process_time

import numpy as np

from enpointe.models import dancer_model
from enpointe.motion.formats import read
from enpointe.motion.retargeting import Retargeted, retarget
from enpointe.motion.retargeting.holding import runs

LIMBS = ("thigh", "shank", "upper_arm", "forearm")


def slip(made: Retargeted) -> float:
    """m, of the ball of a foot while it stands."""
    names = [made.motion.model.geom(int(geom)).name for geom in made.contacts.soles]
    away = [0.0]
    for side, standing in made.standing.items():
        ball = [i for i, name in enumerate(names) if name.startswith(f"{side}_ball")]
        places = made.contacts.points[:, ball, :2].mean(axis=1)
        for run in runs(standing & made.contacts.bears[:, ball].all(axis=1)):
            away.append(float(np.linalg.norm(places[run] - places[run][0], axis=1).max()))
    return max(away)


def measured(path: Path, repeats: int) -> dict[str, object]:
    """One row of the table."""
    content, times = read(path), []
    for _ in range(repeats):
        start = process_time()
        made = retarget(content)
        times.append(process_time() - start)
    heights = made.contacts.points[:, :, 2]
    limbs = [value for name, value in made.residuals.items() if name.endswith(LIMBS)]
    return {
        "file": path.name,
        "frames": len(made.motion.time),
        "frames_per_second": round(len(made.motion.time) / median(times)),
        "slip_mm": round(1e3 * slip(made), 2),
        "height_mm": round(1e3 * float(heights[made.contacts.bears].max(initial=0.0)), 2),
        "depth_mm": round(-1e3 * float(heights.min()), 2),
        "median_deg": round(mean(limb.median for limb in limbs), 2),
        "p95_deg": round(mean(limb.p95 for limb in limbs), 2),
        "warnings": list(made.warnings),
    }


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("files", nargs="+", type=Path)
    parser.add_argument("--repeats", type=int, default=1)
    parser.add_argument("--json", action="store_true")
    asked = parser.parse_args()
    dancer_model()
    rows = []
    for path in asked.files:
        rows.append(measured(path, asked.repeats))
        if not asked.json:
            row = {key: value for key, value in rows[-1].items() if key != "warnings"}
            if len(rows) == 1:
                print(" ".join(f"{key:>17}" for key in row))
            print(" ".join(f"{value:>17}" for value in row.values()), flush=True)
    if asked.json:
        print(json.dumps(rows, indent=2))


if __name__ == "__main__":
    main()
