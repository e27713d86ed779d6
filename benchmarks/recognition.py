"""How often a shaken pose is still called by its name, and what it is taken for otherwise.

Every position of the vocabulary is solved on the perfect and on the real dancer, to both sides.
Then every hinge is moved by noise, the root staying where it was, and the pose is named. Two kinds
of noise: uniform within 5 degrees, and normal with a standard deviation of 5 degrees. Beside each
rate stands what no reader of such noise can surpass: the share of the shaken poses that are still
nearest, hinge by hinge, to the pose that they were shaken from (the most likely one, for normal
noise) among the solved poses themselves.

    python benchmarks/recognition.py
    python benchmarks/recognition.py --repeats 20 --json
    python benchmarks/recognition.py --repeats 8 --write   # the tables of docs/reading-back.md
"""

from __future__ import annotations

import os

# Before numpy: a thread pool only slows problems of this size.
os.environ.setdefault("OMP_NUM_THREADS", "1")
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import argparse
import json
import re
from collections import Counter
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from time import perf_counter

import numpy as np
from numpy.typing import NDArray

from enpointe.models import KeyPoseSolver, Style, dancer_model, pose_target
from enpointe.models.recognition import Recogniser, Recognition
from enpointe.notation import Side, mirrored, names
from enpointe.posing import vocabulary_score

Array = NDArray[np.float64]
Noise = Callable[[np.random.Generator, int], Array]
PAGE = Path(__file__).resolve().parents[1] / "docs" / "reading-back.md"
MARKED = re.compile(
    r"(<!-- made by benchmarks/recognition\.py -->\n).*?(<!-- end -->)", flags=re.DOTALL
)
SEED = 20051122
AMOUNT = np.radians(5.0)
NOISES: Mapping[str, Noise] = {
    "uniform within 5°": lambda rng, n: rng.uniform(-AMOUNT, AMOUNT, n),
    "normal, σ 5°": lambda rng, n: rng.normal(0.0, AMOUNT, n),
}
_HINGES = {
    "feet": ("hip", "knee", "ankle", "toe"),
    "arms": ("shoulder", "elbow", "forearm"),
    "leg": ("hip", "knee", "ankle", "toe"),
    "pose": ("waist", "neck", "shoulder", "elbow", "forearm", "hip", "knee", "ankle", "toe"),
}
"""The hinges that a part of the vocabulary is a position of."""


@dataclass(frozen=True)
class Solved:
    """One solved position."""

    name: str
    side: Side
    qpos: Array

    @property
    def part(self) -> str:
        return self.name.split()[0]


def solve_vocabulary(solver: KeyPoseSolver) -> list[Solved]:
    """Every position, to both sides, on both dancers; those that no rule is broken in."""
    poses = []
    for name in names():
        score = vocabulary_score(name)
        assert score is not None
        for side in Side:
            frame = (score if side is Side.RIGHT else mirrored(score)).resolved()[0]
            for real in (False, True):
                found = solver.solve(pose_target(frame, solver.figure, Style(real=real)))
                if found.held:
                    poses.append(Solved(name, side, found.qpos))
    return poses


def called(found: Recognition, pose: Solved) -> str:
    """What the part of a pose that was asked for is taken for."""
    match = {
        "feet": found.feet,
        "arms": found.arms,
        "leg": found.legs.get(pose.side),
        "pose": found.pose,
    }[pose.part]
    return "nothing of the kind" if match is None else f"{pose.part} {match.name}"


def shake(
    poses: list[Solved], recogniser: Recogniser, noise: Noise, repeats: int
) -> dict[str, object]:
    """Name every pose shaken `repeats` times."""
    rng = np.random.default_rng(SEED)
    model = recogniser.model
    low, high = model.jnt_range[1:].T
    hinges = [model.joint(j).name for j in range(1, model.njnt)]
    index = {
        part: [i for i, name in enumerate(hinges) if any(word in name for word in words)]
        for part, words in _HINGES.items()
    }
    unshaken = {id(pose): recogniser.recognise(pose.qpos) for pose in poses}
    right: Counter[str] = Counter()
    possible: Counter[str] = Counter()
    tried: Counter[str] = Counter()
    taken: Counter[tuple[str, str]] = Counter()
    for pose in poses:
        rivals = [other for other in poses if other.part == pose.part]
        columns = index[pose.part]
        angles = np.array([other.qpos[7:][columns] for other in rivals])
        for _ in range(repeats):
            qpos = np.array(pose.qpos)
            qpos[7:] = np.clip(qpos[7:] + noise(rng, len(hinges)), low, high)
            found = recogniser.recognise(qpos)
            tried[pose.part] += 1
            if found.is_called(pose.name, pose.side):
                right[pose.part] += 1
            else:
                taken[pose.name, called(found, pose)] += 1
            nearest = rivals[int(np.argmin(np.sum((angles - qpos[7:][columns]) ** 2, axis=1)))]
            possible[pose.part] += unshaken[id(nearest)].is_called(pose.name, pose.side)
    return {
        "rate": sum(right.values()) / sum(tried.values()),
        "bound": sum(possible.values()) / sum(tried.values()),
        "parts": {
            part: {"rate": right[part] / n, "bound": possible[part] / n, "tried": n}
            for part, n in tried.items()
        },
        "confusions": [
            {"name": name, "taken_for": other, "share": n / _tries(poses, name, repeats)}
            for (name, other), n in taken.most_common()
        ],
    }


def report(repeats: int) -> dict[str, object]:
    """Everything that the table shows."""
    solver = KeyPoseSolver(dancer_model(flesh=False))
    poses = solve_vocabulary(solver)
    start = perf_counter()
    recogniser = Recogniser(solver.model)
    recogniser.recognise(next(pose.qpos for pose in poses if pose.part == "leg"))
    built = perf_counter() - start
    start = perf_counter()
    clean = [recogniser.recognise(pose.qpos).is_called(pose.name, pose.side) for pose in poses]
    each = (perf_counter() - start) / len(poses)
    return {
        "poses": len(poses),
        "clean": sum(clean) / len(clean),
        "reference_s": built,
        "recognise_ms": 1e3 * each,
        "repeats": repeats,
        "noise": {name: shake(poses, recogniser, noise, repeats) for name, noise in NOISES.items()},
    }


def table(found: Mapping[str, object]) -> str:
    """The report as Markdown."""
    noises = found["noise"]
    assert isinstance(noises, Mapping)
    lines = [
        f"{found['poses']} solved poses, each shaken {found['repeats']} times; unshaken "
        f"{found['clean']:.1%} called by their names",
        f"reference laid out in {found['reference_s']:.1f} s, one pose named in "
        f"{found['recognise_ms']:.0f} ms",
    ]
    for noise, result in noises.items():
        lines += ["", f"### {noise}", "", "| part | named right | possible | shaken |"]
        lines += ["| --- | --- | --- | --- |"]
        rows = {**result["parts"]}
        for part, row in rows.items():
            lines.append(f"| {part} | {row['rate']:.1%} | {row['bound']:.1%} | {row['tried']} |")
        lines.append(f"| **all** | **{result['rate']:.1%}** | **{result['bound']:.1%}** | |")
        lines += ["", "| position | taken for |", "| --- | --- |"]
        confused: dict[str, list[str]] = {}
        for each in result["confusions"]:
            if each["share"] >= 0.02:
                words = f"{each['taken_for'].removeprefix(each['name'].split()[0] + ' ')}"
                words += f" {each['share']:.0%}"
                confused.setdefault(each["name"], []).append(words)
        lines += [f"| {name} | {', '.join(others)} |" for name, others in confused.items()]
    return "\n".join(lines)


def _tries(poses: list[Solved], name: str, repeats: int) -> int:
    return repeats * sum(pose.name == name for pose in poses)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--repeats", type=int, default=10, help="shakes of each pose (default 10)")
    parser.add_argument("--json", action="store_true", help="one JSON object instead of the table")
    parser.add_argument("--write", action="store_true", help="put the tables into the docs")
    arguments = parser.parse_args()
    if arguments.repeats < 1:
        parser.error("--repeats must be at least 1")
    found = report(arguments.repeats)
    if arguments.write:
        page = PAGE.read_text(encoding="utf-8")
        tables = re.sub(r"^### (.*)$", r"**Noise: \1**", table(found), flags=re.MULTILINE)
        tables = re.sub(r"^reference laid out.*\n", "", tables, flags=re.MULTILINE)
        PAGE.write_text(MARKED.sub(lambda m: f"{m[1]}\n{tables}\n\n{m[2]}", page), encoding="utf-8")
    print(json.dumps(found, indent=2, ensure_ascii=False) if arguments.json else table(found))


if __name__ == "__main__":
    main()
