"""How fast a rig of 25 servos dances on a bus with wire time on, beside what the bus allows.

Each row dances a swing of all joints: through a pseudo-terminal, with the emulated bus and the loop
in processes of their own and in real time, or in memory, where the computer takes no time and only
the wires do. The ceiling is that of packet lengths (`BusCycle`): a sync write of goals, a fast sync
read of ten bytes each, and in between one servo's alarm or heat, which the ceiling leaves out.

    python benchmarks/servo_rates.py                 # real time: run it when nothing else runs
    python benchmarks/servo_rates.py --port memory
    python benchmarks/servo_rates.py --motion motion.npz --json
"""

from __future__ import annotations

import argparse
import json
import os
import sys

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

from pathlib import Path

import numpy as np

from enpointe.errors import EnpointeError
from enpointe.hardware.rig_file import Rig, load_rig
from enpointe.motion import Motion
from enpointe.motion.npz import save_motion
from enpointe.rig_motion import body_of
from enpointe.servoing import EMULATED, servo

CASES = ((1_000_000, 100.0), (2_000_000, 125.0), (4_000_000, 200.0))
"""bit/s and Hz."""
_SWING, _PACE = 0.25, 3.0
"""Share of a joint's range, and rad/s."""


def swing(rig: Rig, seconds: float) -> Motion:
    """All joints at once, to and fro about the place nearest zero that leaves them room."""
    model = body_of(rig)
    time = np.arange(0.0, seconds, 0.01)
    qpos = np.tile(model.key("standing").qpos, (len(time), 1))
    for described in rig.servos:
        low, high = described.range
        size = min(_SWING * (high - low), described.top_speed / _PACE) / 2.0
        centre = min(max(0.0, low + size), high - size)
        place = int(model.joint(described.joint).qposadr[0])
        qpos[:, place] = centre + size * np.sin(_PACE * time)
    return Motion.from_qpos(model, time, qpos, name="swing")


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--rig", default="puppet")
    parser.add_argument("--port", default=EMULATED, help="emulated or memory, or a serial port")
    parser.add_argument("--seconds", type=float, default=10.0)
    parser.add_argument("--motion", type=Path, help="of the rig's body, instead of the swing")
    parser.add_argument("--cases", type=int, default=len(CASES), help="how many of them")
    parser.add_argument("--json", action="store_true")
    options = parser.parse_args()
    rig = load_rig(options.rig)
    path = options.motion
    if path is None:
        path = Path(f"swing-{rig.name}.npz")
        save_motion(swing(rig, options.seconds), path)
    rows = []
    for baud, rate in CASES[: options.cases]:
        try:
            danced = servo(path, rig=rig.at(baud, rate), port=options.port, as_written=True)
        except EnpointeError as error:
            print(f"{baud} bit/s at {rate:g} Hz did not begin: {error}", file=sys.stderr)
            continue
        rows.append(danced.summary())
    if options.motion is None:
        path.unlink()
    if options.json:
        print(json.dumps(rows))
        return 0
    names = "bit/s | asked Hz | ceiling Hz | got Hz | misses | frames lost | late p99 ms | rms deg"
    print(f"| {names} | ended |")
    print("|" + " --- |" * 9)
    for row in rows:
        late = 1e3 * row["lateness"]["p99"]
        print(
            f"| {row['baud']} | {row['rate']:g} | {row['bus_ceiling_hz']:.0f}"
            f" | {row['achieved_hz']:.1f} | {row['deadline_misses']} | {row['frame_loss']:.2%}"
            f" | {late:.2f} | {row['tracking_rms_deg']:.2f} | {row['ending']} |"
        )
    if rows:
        print(
            "\n| joint | rms deg at " + " | at ".join(f"{row['rate']:g} Hz" for row in rows) + " |"
        )
        print("|" + " --- |" * (1 + len(rows)))
        for joint in rows[0]["tracking_rms_deg_by_joint"]:
            values = (f"{row['tracking_rms_deg_by_joint'][joint]:.2f}" for row in rows)
            print(f"| {joint} | " + " | ".join(values) + " |")
    return 0


if __name__ == "__main__":
    sys.exit(main())
