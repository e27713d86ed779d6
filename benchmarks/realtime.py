"""How much faster than the music a dance is simulated, by what, and how long a held pose takes.

The first seconds of a shipped score are danced by the whole-body controller and by PD at 500 Hz,
and beside them MuJoCo alone takes the same steps with the same torques. The three take turns, so
that a busy moment hits all of them, and medians are given. PD has no balance and falls in an
adage; its rate is that up to there. Last, the command line solves a pose, holds it for a second
and writes its report, from start to end.

    python benchmarks/realtime.py
    python benchmarks/realtime.py --seconds 3 --repeats 3 --json
"""

from __future__ import annotations

import argparse
import json
import os
import subprocess
import sys
import tempfile
from dataclasses import asdict, dataclass
from statistics import median
from time import perf_counter, process_time

import mujoco
import numpy as np

import enpointe
from enpointe.controllers import PD, Command, Controller, WholeBody, perform
from enpointe.motion import Motion
from enpointe.performing import reference
from enpointe.sim.body import SimulatedBody

POSE = "pose first arabesque"


@dataclass(frozen=True, slots=True)
class Danced:
    """One dance, or the bare steps of one.

    Attributes:
        way: Who danced.
        seconds: Danced.
        rate: Seconds danced in one of the wall clock.
        core_rate: Seconds danced in one of a core, which a busy machine does not make wait.
        assembly: Share of the time in which the programme was written down.
        solution: In which it was solved.
        physics: In which the bare steps alone would have been taken.
        other: All the rest: watching, recording, reading the state.
    """

    way: str
    seconds: float
    rate: float
    core_rate: float
    assembly: float
    solution: float
    physics: float
    other: float


@dataclass(frozen=True, slots=True)
class Posed:
    """A pose from the command line, held a second and reported.

    Attributes:
        wall: s.
        cpu: s of all its threads.
    """

    wall: float
    cpu: float


class Noting(SimulatedBody):
    """A body that remembers its commands."""

    def write(self, command: Command) -> None:
        """Take a command and keep it."""
        if not hasattr(self, "commands"):
            self.commands: list[Command] = []
        self.commands.append(command)
        super().write(command)


def opening(name: str, seconds: float, whole_body: bool) -> Motion:
    """The first seconds of a score as a controller is asked for them."""
    motion = enpointe.perform(name, controller="kinematic").motion
    if whole_body:
        motion, _ = reference(motion, "wholebody")
    first = motion.time <= seconds
    parts = (motion.time, motion.qpos, motion.qvel, motion.qacc)
    time, qpos, qvel, qacc = (part[first] for part in parts)
    return Motion(motion.model, time, qpos, qvel, qacc, name=name)


def bare(body: Noting, motion: Motion) -> tuple[float, float]:
    """s by the wall and of a core that MuJoCo alone takes for the steps of a performance."""
    again = SimulatedBody.at_start_of(motion)
    model, data = again.model, again.data
    substeps = round(again.period / model.opt.timestep)
    controls = [c.torque + c.stiffness * c.position + c.damping * c.velocity for c in body.commands]
    start, core = perf_counter(), process_time()
    for command, control in zip(body.commands, controls, strict=True):
        model.actuator_biasprm[:, 1] = -command.stiffness
        model.actuator_biasprm[:, 2] = -command.damping
        data.ctrl[:] = control
        for _ in range(substeps):
            mujoco.mj_step(model, data)
    taken = perf_counter() - start, process_time() - core
    if not np.array_equal(data.qpos, body.data.qpos):
        raise SystemExit("the bare steps are not those of the dance")
    return taken


def dance(way: str, motion: Motion, controller: Controller) -> tuple[Danced, Danced]:
    """A dance, and its bare steps right after it."""
    body = Noting.at_start_of(motion)
    core = process_time()
    recording = perform(motion, controller, body)
    core = process_time() - core
    wall, seconds = recording.wall_time, len(recording.time) * body.period
    alone, alone_core = bare(body, motion)
    assembly = solution = 0.0
    if isinstance(controller, WholeBody):
        assembly, solution = controller.workload.building, controller.workload.solving
    other = wall - alone - assembly - solution
    shares = (assembly / wall, solution / wall, alone / wall, other / wall)
    return (
        Danced(way, seconds, seconds / wall, seconds / core, *shares),
        Danced(
            f"bare steps of {way}",
            seconds,
            seconds / alone,
            seconds / alone_core,
            0.0,
            0.0,
            1.0,
            0.0,
        ),
    )


def posed() -> Posed:
    """The command line on a pose, in an empty folder."""
    with tempfile.TemporaryDirectory() as folder:
        command = [sys.executable, "-m", "enpointe", "perform", POSE, "--hold", "1"]
        start, before = perf_counter(), os.times()
        subprocess.run(
            [*command, "--controller", "wholebody"], cwd=folder, check=True, capture_output=True
        )
        after = os.times()
        cpu = after.children_user + after.children_system
        cpu -= before.children_user + before.children_system
        return Posed(perf_counter() - start, cpu)


def typical(runs: list[Danced]) -> Danced:
    """Median of each figure."""
    names = ("rate", "core_rate", "assembly", "solution", "physics", "other")
    return Danced(
        runs[0].way, runs[0].seconds, *(median(getattr(r, name) for r in runs) for name in names)
    )


def main() -> None:
    """Run and print."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--score", default="adage-developpe")
    parser.add_argument("--seconds", type=float, default=5.0, help="danced of the score")
    parser.add_argument("--repeats", type=int, default=5)
    parser.add_argument("--json", action="store_true")
    options = parser.parse_args()
    planned = opening(options.score, options.seconds, whole_body=True)
    plain = opening(options.score, options.seconds, whole_body=False)
    runs: list[Danced] = []
    poses: list[Posed] = []
    for _ in range(options.repeats):
        runs += dance("whole body", planned, WholeBody(planned))
        runs += dance("PD", plain, PD(plain))
        poses.append(posed())
    ways = list(dict.fromkeys(run.way for run in runs))
    rows = [typical([run for run in runs if run.way == way]) for way in ways]
    pose = Posed(median(p.wall for p in poses), median(p.cpu for p in poses))
    if options.json:
        print(json.dumps({"danced": [asdict(row) for row in rows], "pose": asdict(pose)}))
        return
    print(f"{'':26s} {'s':>5s} {'x wall':>8s} {'x core':>8s}  assembly solution physics other")
    for row in rows:
        shares = (row.assembly, row.solution, row.physics, row.other)
        print(
            f"{row.way:26s} {row.seconds:5.2f} {row.rate:8.2f} {row.core_rate:8.2f}  "
            + "  ".join(f"{100 * share:6.0f} %" for share in shares)
        )
    print(f"{POSE!r} held 1 s from the command line: {pose.wall:.1f} s, {pose.cpu:.1f} s of CPU")


if __name__ == "__main__":
    main()
