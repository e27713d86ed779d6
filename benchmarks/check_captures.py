"""What `enpointe check` says of captured takes: the table of docs/retargeting.md.

For each file: seconds; how far a bearing foot of the file slides, mm; revolutions of the pelvis, of
its turns of 3/8 and more; flights, each as its seconds, the millimetres that the centre of mass
rises and would rise in free fall, and what it falls with, m/s^2; the fastest joint, rad/s; and the
median and the root mean square of the invisible help, per cent of body weight.

    python benchmarks/check_captures.py ../shared/data/cmu_05/*.amc
    python benchmarks/check_captures.py FILE ... --json
"""

from __future__ import annotations

import os

os.environ.setdefault("OMP_NUM_THREADS", "1")
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import argparse
import json
from pathlib import Path

import numpy as np

import enpointe
from enpointe.checking import Check

TURN = 0.375


def row(found: Check) -> dict[str, object]:
    """One row of the table."""
    looked = found.found
    free = {flight.start: flight for flight in looked.ballistics}
    flights = []
    for flight in looked.flights:
        held = free.get(flight.start)
        said = f"{flight.start:.2f}-{flight.end:.2f}"
        if held is not None:
            rises = f"{1e3 * held.rise:.0f}/{1e3 * held.rise_free:.0f}"
            said += f" {rises} {held.fall:.1f}"
        flights.append(said)
    return {
        "take": found.name,
        "seconds": round(looked.motion.duration, 2),
        "slip_mm": round(1e3 * found.slip_max),
        "turns": [round(t.revolutions, 2) for t in looked.turns if abs(t.revolutions) >= TURN],
        "flights": flights,
        "fastest_rad_s": round(looked.speeds[0].speed, 1),
        "help_median": round(100 * float(np.median(looked.root_wrench)) / looked.weight),
        "help_rms": round(100 * looked.root_wrench_rms / looked.weight),
    }


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("files", nargs="+", type=Path)
    parser.add_argument("--json", action="store_true")
    asked = parser.parse_args()
    rows = []
    for path in asked.files:
        rows.append(row(enpointe.check(path)))
        if not asked.json:
            cells = rows[-1]
            if len(rows) == 1:
                print("| " + " | ".join(cells) + " |")
                print("| " + " | ".join("---" for _ in cells) + " |")
            said = [
                "; ".join(f"{v:+.2f}" if isinstance(v, float) else v for v in cell) or "–"
                if isinstance(cell, list)
                else str(cell)
                for cell in cells.values()
            ]
            print("| " + " | ".join(said) + " |", flush=True)
    if asked.json:
        print(json.dumps(rows, indent=2))


if __name__ == "__main__":
    main()
