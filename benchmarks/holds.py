"""Which key poses are held for ten seconds from rest, on how much of a foot, and how still.

Nine poses, each flat, on demi-pointe and on pointe, on one foot but for first and fifth, danced by
the whole-body controller or by PD. No force on the root, self-collision on, the model's torques. On
pointe she wears pointe shoes.

    python benchmarks/holds.py
    python benchmarks/holds.py --controller pd --rise flat --seconds 3
"""

from __future__ import annotations

import os

# Before numpy: a thread pool only slows problems of this size.
os.environ.setdefault("OMP_NUM_THREADS", "1")
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import argparse
import json
from collections.abc import Mapping
from dataclasses import asdict, dataclass

from enpointe.controllers import PD, WholeBody, perform
from enpointe.models import KeyPoseSolver, dancer_model, pose_target
from enpointe.motion import Motion
from enpointe.motion.hold import hold
from enpointe.notation import parse_score
from enpointe.sim import balance
from enpointe.sim.body import SimulatedBody
from enpointe.sim.measures import measure

HEAD = "benesh 1\ntitle: Hold\nmethod: Cecchetti\nmetre: 4/4\ntempo: 60\nbeat 0:\n"
POSES: Mapping[str, str] = {
    "first": "feet: first, {rise}\narms: fifth en bas",
    "fifth": "feet: fifth right front, {rise}\narms: fifth en bas",
    "retiré": "left leg: straight, {rise}\nright leg: retiré devant\narms: fifth en avant",
    "first arabesque": "pose: first arabesque on left\nleft leg: straight, {rise}",
    "second arabesque": "pose: second arabesque on left\nleft leg: straight, {rise}",
    "third arabesque": "pose: third arabesque on left\nleft leg: straight, {rise}",
    "attitude derrière": "pose: attitude derrière on left\nleft leg: straight, {rise}",
    "à la seconde 90": "left leg: straight, {rise}\nright leg: raised seconde 90\n"
    "arms: à la seconde",
    "devant 90": "left leg: straight, {rise}\nright leg: raised devant 90\narms: à la seconde",
}
RISES = ("flat", "demi-pointe", "pointe")


@dataclass(frozen=True, slots=True)
class Held:
    """How one hold went.

    Attributes:
        pose: Its name.
        rise: What of the foot stands.
        support_cm2: Area of the hull of the loaded soles, at the end.
        fell_at: s, or None.
        rms_deg: All joints and samples.
        worst_joint_rms_deg: Of the joint that strays most.
        margin_mm: Least of the centre of mass.
        slip_mm: Most.
        torque: Largest share of a joint's strength.
        other_force: Largest contact that was no sole, N.
        root_force: N.
        failures: Programmes without a solution.
        realtime: Seconds danced a second.
    """

    pose: str
    rise: str
    support_cm2: float
    fell_at: float | None
    rms_deg: float
    worst_joint_rms_deg: float
    margin_mm: float
    slip_mm: float
    torque: float
    other_force: float
    root_force: float
    failures: int
    realtime: float


def pose_motion(solver: KeyPoseSolver, pose: str, rise: str, seconds: float) -> Motion:
    """A pose of `POSES` held."""
    frame = parse_score(HEAD + POSES[pose].format(rise=rise) + "\n").resolved()[0]
    solved = solver.solve(pose_target(frame, solver.figure, name=pose))
    return hold(solver.model, solved.qpos, seconds, name=f"{pose}, {rise}")


def held(solver: KeyPoseSolver, pose: str, rise: str, seconds: float, controller: str) -> Held:
    """Hold one pose and measure it."""
    motion = pose_motion(solver, pose, rise, seconds)
    driver = WholeBody(motion) if controller == "wholebody" else PD(motion)
    recording = perform(motion, driver, SimulatedBody.at_start_of(motion))
    figures = measure(recording)
    hull = balance.support(
        recording.channels["sole_point"][-1],
        recording.channels["sole_force"][-1],
    )
    margin = figures.support_margin_min
    return Held(
        pose,
        rise,
        1e4 * balance.area(hull),
        figures.fell_at,
        figures.tracking_rms_deg,
        float(figures.joint_rms_deg.max()),
        1e3 * margin if margin is not None else float("nan"),
        1e3 * figures.slip_max,
        figures.torque_limit_fraction_max,
        figures.other_contact_max,
        figures.root_force_max,
        driver.workload.failures if isinstance(driver, WholeBody) else 0,
        recording.realtime_factor,
    )


def main() -> None:
    """Run and print."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--controller", choices=("wholebody", "pd"), default="wholebody")
    parser.add_argument("--rise", choices=RISES, action="append")
    parser.add_argument("--seconds", type=float, default=10.0)
    parser.add_argument("--json", action="store_true")
    options = parser.parse_args()
    soft, pointe = (
        KeyPoseSolver(dancer_model(flesh=False, pointe_shoes=shoes)) for shoes in (False, True)
    )
    rows = []
    for rise in options.rise or RISES:
        for pose in POSES:
            solver = pointe if rise == "pointe" else soft
            rows.append(held(solver, pose, rise, options.seconds, options.controller))
            if not options.json:
                _print(rows[-1], first=len(rows) == 1)
    if options.json:
        print(json.dumps([asdict(row) for row in rows]))


def _print(row: Held, *, first: bool) -> None:
    if first:
        print(
            "pose               on           cm2  held  rms deg worst deg margin mm slip mm"
            "  torque  other N  failures  x real time"
        )
    fell = "yes " if row.fell_at is None else f"{row.fell_at:.1f}s"
    print(
        f"{row.pose:<18} {row.rise:<11} {row.support_cm2:5.1f}  {fell}  {row.rms_deg:7.3f}"
        f" {row.worst_joint_rms_deg:9.3f} {row.margin_mm:9.1f} {row.slip_mm:7.2f}"
        f" {row.torque:7.2f} {row.other_force:8.1f} {row.failures:9d} {row.realtime:12.2f}",
        flush=True,
    )


if __name__ == "__main__":
    main()
