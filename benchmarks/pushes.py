"""How hard a standing dancer can be pushed at the pelvis, beside what her foot can take up.

Pushes of 0.1 s, forward, back, left and right, on two feet, one flat foot and one demi-pointe, by
the whole-body controller and by PD. The largest that she survives is found by halving, to 3 % of
the bound; she survives if she stands three seconds later. The bound is that of the extrapolated
centre of mass (Hof et al. 2005) for a body whose arms and trunk do not swing: see `largest_push`.

    python benchmarks/pushes.py
    python benchmarks/pushes.py --controller wholebody --rise demi-pointe
"""

from __future__ import annotations

import os

# Before numpy: a thread pool only slows problems of this size.
os.environ.setdefault("OMP_NUM_THREADS", "1")
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import argparse
import json
from dataclasses import asdict, dataclass

import numpy as np
from holds import pose_motion
from numpy.typing import NDArray

from enpointe.controllers import PD, WholeBody, perform
from enpointe.controllers.plant import Plant
from enpointe.models import KeyPoseSolver, dancer_model
from enpointe.models.foot_positions import support_hull
from enpointe.motion import Motion
from enpointe.sim.balance import room
from enpointe.sim.measures import measure
from enpointe.sim.push import Push, PushedBody, largest_push

Array = NDArray[np.float64]
STANCES = (("first", "flat"), ("retiré", "flat"), ("retiré", "demi-pointe"))
DIRECTIONS = {
    "forward": (1.0, 0.0),
    "back": (-1.0, 0.0),
    "left": (0.0, 1.0),
    "right": (0.0, -1.0),
}
START, SECONDS, DURATION = 0.3, 3.4, 0.1
MOST = 3.0
"""Times the bound: no push harder than this is tried."""
STEP = 0.03


@dataclass(frozen=True, slots=True)
class Survived:
    """The hardest push survived.

    Attributes:
        pose: Its name.
        rise: What of the foot stands.
        controller: "wholebody" or "pd".
        direction: Of the push.
        impulse: Survived, N s.
        bound: Of the extrapolated centre of mass, N s.
    """

    pose: str
    rise: str
    controller: str
    direction: str
    impulse: float
    bound: float


def bound(motion: Motion, direction: Array) -> float:
    """N s, for the first pose of a motion."""
    plant = Plant(motion.model)
    plant.place(motion.qpos[0])
    soles = plant.data.geom_xpos[plant.soles_on_floor()][:, :2]
    reach = room(support_hull(soles), plant.com[:2], direction)
    return largest_push(reach, plant.com[2], plant.mass, plant.gravity, DURATION)


def survives(motion: Motion, controller: str, impulse: Array) -> bool:
    """Whether she stands after a push (2,), N s."""
    driver = WholeBody(motion) if controller == "wholebody" else PD(motion)
    push = Push(START, (float(impulse[0]), float(impulse[1]), 0.0), DURATION)
    body = PushedBody([push], motion.model, motion.qpos[0])
    return measure(perform(motion, driver, body)).fell_at is None


def hardest(motion: Motion, controller: str, direction: Array, most: float) -> float:
    """The hardest push survived, as a share of `most` / `MOST`."""
    if not survives(motion, controller, 0.0 * direction):
        return 0.0
    low, high = 0.0, MOST
    while high - low > STEP:
        share = 0.5 * (low + high)
        if survives(motion, controller, share * most * direction):
            low = share
        else:
            high = share
    return low * most


def main() -> None:
    """Run and print."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--controller", choices=("wholebody", "pd"), action="append")
    parser.add_argument("--rise", choices=("flat", "demi-pointe"), action="append")
    parser.add_argument("--json", action="store_true")
    options = parser.parse_args()
    solver = KeyPoseSolver(dancer_model(flesh=False))
    rows = []
    for pose, rise in STANCES:
        if options.rise and rise not in options.rise:
            continue
        motion = pose_motion(solver, pose, rise, SECONDS)
        for controller in options.controller or ("wholebody", "pd"):
            for name, direction in DIRECTIONS.items():
                limit = bound(motion, np.array(direction))
                impulse = hardest(motion, controller, np.array(direction), limit)
                rows.append(Survived(pose, rise, controller, name, impulse, limit))
                if not options.json:
                    _print(rows[-1])
    if options.json:
        print(json.dumps([asdict(row) for row in rows]))


def _print(row: Survived) -> None:
    print(
        f"{row.pose:<8} {row.rise:<11} {row.controller:<9} {row.direction:<8}"
        f" {row.impulse:6.2f} N s  bound {row.bound:6.2f}  ratio {row.impulse / row.bound:5.2f}",
        flush=True,
    )


if __name__ == "__main__":
    main()
