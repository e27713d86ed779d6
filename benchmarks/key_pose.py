"""How fast key poses are solved, and what differential IK alone leaves broken.

Every shipped key pose and every position of the vocabulary, the latter on the perfect and the real
dancer, is solved cold, from standing: differential IK (mink) finds a seed, the
nonlinear programme polishes it and every rule is certified. Beside it, in the same run and pose by
pose, mink alone on the same tasks: for as many steps as bring feet and wrists within 2 mm, and for
the 40 steps of the seed. Run it on a quiet machine:

    python benchmarks/key_pose.py
    python benchmarks/key_pose.py --sources vocabulary
    python benchmarks/key_pose.py --repeats 9 --json
"""

from __future__ import annotations

import os

# Before numpy: a thread pool only slows problems of this size.
os.environ.setdefault("OMP_NUM_THREADS", "1")
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import argparse
import json
import platform
from collections.abc import Callable, Iterator
from dataclasses import asdict, dataclass
from importlib.metadata import version
from pathlib import Path
from statistics import median
from time import perf_counter
from typing import Any

import numpy as np
from _mink_alone import steps_until_near
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from enpointe.models import Certificate, KeyPoseSolver, PoseTarget, Style, dancer_model, pose_target
from enpointe.models.keypose import PoseProblem
from enpointe.models.rules import Kind, rules_for
from enpointe.models.seed import SEED_STEPS, differential_ik
from enpointe.models.stances import StanceTracker
from enpointe.notation import load_score, names, shipped_scores
from enpointe.posing import vocabulary_score

BUILDS = 3
"""How often the problem of each structure is built."""


@dataclass(frozen=True, slots=True)
class Timing:
    """Milliseconds of one way to a pose: over poses, the median of each pose's repeats."""

    median: float
    worst: float


@dataclass(frozen=True, slots=True)
class Leftover:
    """What a way to a pose leaves broken, over all poses.

    Attributes:
        poses_held: Poses with every rule held.
        rules_held: Rules held.
        rules: Rules certified.
        largest_mm: Largest residual of the rules that the solver treats as equations, mm.
        largest_deg: The same of those in degrees.
    """

    poses_held: int
    rules_held: int
    rules: int
    largest_mm: float
    largest_deg: float


@dataclass(slots=True)
class Pose:
    """One key pose and what was measured on it; times in ms."""

    name: str
    target: PoseTarget
    problem: PoseProblem
    steps: int | None
    whole: list[float]
    polish: list[float]
    seed: list[float]
    near: list[float]
    iterations: int = 0


def named(solver: KeyPoseSolver, sources: str) -> Iterator[tuple[str, PoseTarget]]:
    """Names and targets: every key pose that is shipped, every position on both dancers, or all."""
    if sources in ("shipped", "all"):
        for name in shipped_scores():
            tracker = StanceTracker(solver.figure, Style().turnout_deg)
            for frame in load_score(name).resolved():
                ground = tracker.follow(frame)
                yield (
                    f"{name}, beat {frame.beat}",
                    pose_target(frame, solver.figure, ground=ground),
                )
    if sources in ("vocabulary", "all"):
        for name in names():
            score = vocabulary_score(name)
            assert score is not None
            for style in (Style(), Style(real=True)):
                dancer = "real" if style.real else "perfect"
                target = pose_target(score.resolved()[0], solver.figure, style)
                yield f"{name}, {dancer}", target


def poses_of(solver: KeyPoseSolver, sources: str) -> Iterator[Pose]:
    """What is timed."""
    for name, target in named(solver, sources):
        yield Pose(
            name=name,
            target=target,
            problem=solver.problem(target),
            steps=steps_until_near(solver.model, target),
            whole=[],
            polish=[],
            seed=[],
            near=[],
        )


def milliseconds(work: Callable[..., object], *arguments: object, **named: object) -> float:
    start = perf_counter()
    work(*arguments, **named)
    return 1e3 * (perf_counter() - start)


def measure(solver: KeyPoseSolver, poses: list[Pose], repeats: int) -> None:
    """Time all ways to every pose, one after the other, so that a noisy moment hits them all."""
    model = solver.model
    for repeat in range(-1, repeats):
        for pose in poses:
            seed = differential_ik(model, pose.target)
            times = {
                "whole": milliseconds(solver.solve, pose.target),
                "seed": milliseconds(differential_ik, model, pose.target),
                "polish": milliseconds(solver.solve, pose.target, guess=seed),
            }
            if pose.steps is not None:
                times["near"] = milliseconds(differential_ik, model, pose.target, steps=pose.steps)
            if repeat < 0:  # the first round only warms the caches
                pose.iterations = solver.solve(pose.target).iterations
                continue
            for way, time in times.items():
                getattr(pose, way).append(time)


def timing(poses: list[Pose], way: str) -> Timing | None:
    each = [median(times) for pose in poses if (times := getattr(pose, way))]
    return Timing(median(each), max(each)) if each else None


def certificate_of(pose: Pose, qpos: NDArray[np.float64]) -> Certificate:
    """Every rule of the pose, measured at any configuration."""
    upright = Rotation.from_euler("z", pose.target.facing)
    turned = upright.inv() * Rotation.from_quat(qpos[3:7], scalar_first=True)
    unknowns = np.concatenate([qpos[:3], turned.as_rotvec(), qpos[7:]])
    return pose.problem.certify(unknowns, pose.problem.parameters(pose.target))


def leftover(poses: list[Pose], certificates: list[Certificate]) -> Leftover:
    results = [result for certificate in certificates for result in certificate.results]
    largest = {"mm": 0.0, "deg": 0.0}
    for pose, certificate in zip(poses, certificates, strict=True):
        for rule, result in zip(pose.problem.rules, certificate.results, strict=True):
            if rule.kind is Kind.EQUAL:
                largest[result.unit] = max(largest[result.unit], result.value)
    return Leftover(
        poses_held=sum(certificate.held for certificate in certificates),
        rules_held=sum(result.held for result in results),
        rules=len(results),
        largest_mm=largest["mm"],
        largest_deg=largest["deg"],
    )


def commonly_broken(certificates: list[Certificate]) -> dict[str, int]:
    """How many poses break each rule, sides taken together, most first."""
    counts: dict[str, int] = {}
    for certificate in certificates:
        rules = {r.rule.removeprefix("left ").removeprefix("right ") for r in certificate.broken}
        for rule in rules:
            counts[rule] = counts.get(rule, 0) + 1
    return dict(sorted(counts.items(), key=lambda item: -item[1]))


def build_times(solver: KeyPoseSolver, poses: list[Pose]) -> list[float]:
    """Building and compiling the problem of each structure among the poses, ms."""
    targets = {pose.target.structure: pose.target for pose in poses}
    return [
        milliseconds(PoseProblem, solver.model, rules_for(target))
        for target in targets.values()
        for _ in range(BUILDS)
    ]


def machine() -> str:
    cpu = platform.processor() or platform.machine()
    info = Path("/proc/cpuinfo")
    if info.is_file():
        names = [line for line in info.read_text().splitlines() if line.startswith("model name")]
        cpu = names[0].split(":", 1)[1].strip() if names else cpu
    return f"{os.cpu_count()} x {cpu}, {platform.system()}"


def report(repeats: int, sources: str) -> dict[str, object]:
    solver = KeyPoseSolver(dancer_model())
    poses = list(poses_of(solver, sources))
    builds = build_times(solver, poses)
    measure(solver, poses, repeats)
    reached = [(pose, pose.steps) for pose in poses if pose.steps is not None]
    solved = [solver.solve(pose.target).certificate for pose in poses]
    seeds = [certificate_of(pose, differential_ik(solver.model, pose.target)) for pose in poses]
    near = [
        certificate_of(pose, differential_ik(solver.model, pose.target, steps=steps))
        for pose, steps in reached
    ]
    steps = [steps for _, steps in reached]

    def ratio(other: str) -> float:
        pairs: list[float] = [
            whole / part
            for pose in poses
            for whole, part in zip(pose.whole, getattr(pose, other), strict=False)
        ]
        return median(pairs)

    def time(way: str) -> dict[str, float] | None:
        found = timing(poses, way)
        return asdict(found) if found else None

    return {
        "machine": machine(),
        "versions": {name: version(name) for name in ("mujoco", "casadi", "mink", "daqp")},
        "python": platform.python_version(),
        "sources": sources,
        "poses": len(poses),
        "repeats": repeats,
        "build_ms": {
            "structures": len(builds) // BUILDS,
            "median": median(builds),
            "worst": max(builds),
        },
        "seed_and_certified_ms": time("whole"),
        "polish_and_certify_ms": time("polish"),
        "iterations": {
            "median": median(p.iterations for p in poses),
            "worst": max(p.iterations for p in poses),
        },
        "slowest_pose": max(poses, key=lambda p: median(p.whole)).name,
        "mink_40_steps_ms": time("seed"),
        "mink_until_near_ms": time("near"),
        "mink_steps_until_near": {
            "median": median(steps) if steps else None,
            "worst": max(steps, default=None),
            "never": sum(pose.steps is None for pose in poses),
        },
        "ratio_to_mink_40_steps": ratio("seed"),
        "ratio_to_mink_until_near": ratio("near") if steps else None,
        "left_by_solver": asdict(leftover(poses, solved)),
        "left_by_mink_40_steps": asdict(leftover(poses, seeds)),
        "left_by_mink_until_near": asdict(leftover([pose for pose, _ in reached], near)),
        "broken_by_mink_40_steps": commonly_broken(seeds),
        "broken_by_mink_until_near": commonly_broken(near),
    }


def table(found: dict[str, Any]) -> str:
    """The report for people, in plain text."""
    steps = found["mink_steps_until_near"]
    rows = [
        ("seed + certified NLP", "seed_and_certified_ms", "left_by_solver"),
        (f"mink alone, {SEED_STEPS} steps", "mink_40_steps_ms", "left_by_mink_40_steps"),
        ("mink alone, until < 2 mm", "mink_until_near_ms", "left_by_mink_until_near"),
    ]
    lines = [
        f"{found['poses']} key poses ({found['sources']}), cold, {found['repeats']} repeats each; "
        f"{found['machine']}",
        ", ".join(f"{name} {number}" for name, number in found["versions"].items())
        + f", Python {found['python']}",
        "",
        f"{'':26}{'median ms':>10}{'worst ms':>10}{'poses held':>12}{'rules held':>14}"
        f"{'largest residual':>24}",
    ]
    for title, way, left in rows:
        times, kept = found[way], found[left]
        if times is None:
            lines.append(f"{title:26}never gets there")
            continue
        worst = f"{kept['largest_mm']:.4f} mm, {kept['largest_deg']:.4f} deg"
        lines.append(
            f"{title:26}{times['median']:10.1f}{times['worst']:10.1f}"
            f"{kept['poses_held']:>12}{kept['rules_held']:>8}/{kept['rules']:<5}{worst:>24}"
        )
    polish, build = found["polish_and_certify_ms"], found["build_ms"]
    broken = {
        way: ", ".join(f"{rule} in {n} poses" for rule, n in found[way].items()) or "none"
        for way in ("broken_by_mink_40_steps", "broken_by_mink_until_near")
    }
    until = found["ratio_to_mink_until_near"]
    lines += [
        "",
        f"of that, polish and certify: median {polish['median']:.1f} ms, worst "
        f"{polish['worst']:.1f} ms; interior-point iterations: median "
        f"{found['iterations']['median']:g}, worst {found['iterations']['worst']}",
        f"slowest pose: {found['slowest_pose']}",
        f"mink's steps until feet and wrists < 2 mm: median {steps['median']}, worst "
        f"{steps['worst']}, never {steps['never']}",
        "time against mink alone, median of pairs: "
        f"{found['ratio_to_mink_40_steps']:.2f} x its {SEED_STEPS} steps"
        + (f", {until:.2f} x its steps until < 2 mm" if until else ""),
        f"broken after mink's {SEED_STEPS} steps: {broken['broken_by_mink_40_steps']}",
        f"broken where mink reaches < 2 mm: {broken['broken_by_mink_until_near']}",
        f"building a problem, once a structure: median {build['median']:.0f} ms, worst "
        f"{build['worst']:.0f} ms ({build['structures']} structures)",
    ]
    return "\n".join(lines)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--repeats", type=int, default=5, help="timings of each pose (default 5)")
    parser.add_argument("--json", action="store_true", help="one JSON object instead of the table")
    parser.add_argument(
        "--sources",
        choices=("shipped", "vocabulary", "all"),
        default="all",
        help="which poses (default all)",
    )
    arguments = parser.parse_args()
    if arguments.repeats < 1:
        parser.error("--repeats must be at least 1")
    found = report(arguments.repeats, arguments.sources)
    print(json.dumps(found, indent=2) if arguments.json else table(found))


if __name__ == "__main__":
    main()
