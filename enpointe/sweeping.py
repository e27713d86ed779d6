"""`enpointe sweep`: one dance many times, each run disturbed in its own way."""

from __future__ import annotations

import csv
import hashlib
import io
import json
import os
from collections.abc import Generator, Mapping, Sequence
from contextlib import closing
from dataclasses import asdict, dataclass, field
from math import sqrt
from pathlib import Path
from time import perf_counter
from typing import TYPE_CHECKING

from enpointe.errors import EnpointeError
from enpointe.figures import SweepFigures
from enpointe.files import write_text
from enpointe.notation import Score, format_score, load_score
from enpointe.performing import has_qualities, reference
from enpointe.preparing import Progress, model_of, prepare, silent

if TYPE_CHECKING:
    from enpointe.models import Anthropometry, Style
    from enpointe.motion import Motion
    from enpointe.sim.disturbance import Disturbances
    from enpointe.sim.trial import Outcome, Trial

__all__ = ["Sweep", "sweep"]

MOST_RUNS = 1_000_000


@dataclass(frozen=True)
class Sweep:
    """What became of all runs.

    Attributes:
        title: Of the dance.
        duration: Of the dance, s.
        controller: What drove the dancer.
        disturbances: What was asked for.
        seed: What was drawn depends on it and on the run's number.
        outcomes: In the order of the runs.
        fresh: How many were danced now, and not taken from a journal.
        wall_time: s that those took, with the start of the processes.
        journal: File that had each run when it finished, or None.
    """

    title: str
    duration: float
    controller: str
    disturbances: Disturbances
    seed: int
    outcomes: tuple[Outcome, ...]
    fresh: int
    wall_time: float
    journal: Path | None = field(default=None, compare=False)

    @property
    def completed_fraction(self) -> float:
        """Share of the runs in which she got to the end, and stands there."""
        return sum(o.completed for o in self.outcomes) / len(self.outcomes)

    @property
    def completed_interval(self) -> tuple[float, float]:
        """95 % confidence interval of the completed fraction (Wilson 1927, z = 1.96)."""
        n, p, z = len(self.outcomes), self.completed_fraction, 1.96
        middle, spread = p + z * z / (2 * n), z * sqrt(p * (1 - p) / n + z * z / (4 * n * n))
        return (middle - spread) / (1 + z * z / n), (middle + spread) / (1 + z * z / n)

    @property
    def runs_per_second(self) -> float | None:
        """Of those danced now; None if all were there already."""
        return self.fresh / self.wall_time if self.fresh else None

    def summary(self) -> SweepFigures:
        """The figures that `--json` prints, SI units; the names are a promise to scripts."""
        forces = [o.root_force_max for o in self.outcomes if o.root_force_max is not None]
        return {
            "disturbed_by": self.disturbances.words() or ["nothing"],
            "title": self.title,
            "controller": self.controller,
            "duration": self.duration,
            "seed": self.seed,
            "runs": len(self.outcomes),
            "completed_fraction": self.completed_fraction,
            "completed_interval": list(self.completed_interval),
            "runs_per_second": self.runs_per_second,
            "root_force_max": max(forces, default=None),
            "failures": [
                {
                    "run": o.run,
                    "factors": dict(o.factors),
                    "fell_at": o.fell_at,
                    "fault": o.fault,
                }
                for o in self.outcomes
                if not o.completed
            ],
        }

    def table(self) -> str:
        """Every run as a line of a CSV table; the same for the same sweep, whoever danced it."""
        text = io.StringIO()
        rows = [_row(outcome) for outcome in self.outcomes]
        writer = csv.DictWriter(text, list(rows[0]), lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows)
        return text.getvalue()

    def save(self, folder: Path) -> dict[str, Path]:
        """Write `runs.csv` and `sweep.json`; returns the paths by name, the journal's too."""
        figures = json.dumps(self.summary(), indent=1, allow_nan=False)
        files = {
            "table": write_text(folder / "runs.csv", self.table()),
            "summary": write_text(folder / "sweep.json", figures + "\n"),
        }
        return files if self.journal is None else {**files, "journal": self.journal}


def _row(outcome: Outcome) -> dict[str, object]:
    figures = asdict(outcome)
    factors = figures.pop("factors")
    row = {"run": figures.pop("run"), **factors, **figures}
    return {name: int(v) if isinstance(v, bool) else v for name, v in row.items()}


def sweep(
    source: str | Path | Score,
    *,
    runs: int,
    seed: int = 0,
    controller: str = "wholebody",
    disturb: str | None = None,
    effort: str | None = None,
    tempo: float | None = None,
    processes: int | None = None,
    cluster: str | None = None,
    style: Style | None = None,
    dancer: Anthropometry | None = None,
    out: Path | None = None,
    progress: Progress = silent,
) -> Sweep:
    """Dance a score many times, the body, the floor and the senses changed each time.

    The score is solved once, and for the whole-body controller made danceable. Run k is the same
    whichever process dances it and however many runs there are. The controller is never told what
    was changed.

    Args:
        source: A shipped score's name, a `.bmn` file, or a score.
        runs: How many.
        seed: Of everything that is drawn.
        controller: "wholebody" or "pd".
        disturb: Names of disturbances, with amounts or ranges if they are to be unusual, as in
            "mass,push=8,friction=0.4:1"; "all", "none"; the usual ones if None.
        effort: As for `perform`.
        tempo: As for `perform`.
        processes: On this machine; as many as it has processors if None.
        cluster: Address of a Dask scheduler, instead of processes here.
        style: The method's amounts.
        dancer: Height, mass and sex; a dancer of 1.68 m and 54 kg if None.
        out: A folder that keeps every finished run, so that a sweep which was stopped goes on
            where it was; nothing is kept if None.
        progress: Told how far it is.

    Returns:
        The outcomes; `Sweep.summary` has their figures.

    Raises:
        EnpointeError: Anything that the caller can mend, in one line.

    Example:
        >>> import enpointe
        >>> swept = enpointe.sweep("third-port-de-bras", runs=20, processes=2)
        >>> 0.0 <= swept.completed_fraction <= 1.0
        True
    """
    score = source if isinstance(source, Score) else load_score(source)
    if not 1 <= runs <= MOST_RUNS:
        raise EnpointeError(f"a sweep has 1 to {MOST_RUNS} runs, not {runs}")
    if seed < 0:
        raise EnpointeError(f"a seed is a whole number from 0, not {seed}")
    if processes is not None and processes < 1:
        raise EnpointeError(f"a sweep needs at least 1 process, not {processes}")
    from enpointe.sim.disturbance import Disturbances
    from enpointe.sim.trial import CONTROLLERS, Trial

    if controller not in CONTROLLERS:
        raise EnpointeError(f"no controller {controller!r}; use {' or '.join(CONTROLLERS)}")
    disturbances = Disturbances.parse(disturb)
    asked = _Asked(score, effort, tempo, style, dancer)
    key = asked.key(controller, disturbances, seed)
    kept = None if out is None else Path(out) / f"reference-{key}.npz"
    trial = Trial(asked.motion(controller, kept, progress), controller, disturbances, seed)
    workers = processes or os.cpu_count() or 1
    journal = None if out is None else Path(out) / "runs.jsonl"
    outcomes, fresh, wall_time = _outcomes(trial, runs, key, journal, workers, cluster, progress)
    return Sweep(
        score.title,
        trial.motion.duration,
        controller,
        disturbances,
        seed,
        outcomes,
        fresh,
        wall_time,
        journal,
    )


@dataclass(frozen=True, slots=True)
class _Asked:
    """What is to be danced, before it is solved."""

    score: Score
    effort: str | None
    tempo: float | None
    style: Style | None
    dancer: Anthropometry | None

    def key(self, controller: str, disturbances: Disturbances, seed: int) -> str:
        """Sixteen hexadecimal digits that differ when anything does on which runs depend."""
        from enpointe.sim.fingerprint import code_digest

        configuration = {
            "score": format_score(self.score),
            "effort": self.effort,
            "tempo": self.tempo,
            "style": repr(self.style),
            "dancer": repr(self.dancer),
            "controller": controller,
            "disturbances": {name: list(r) for name, r in disturbances.ranges.items()},
            "seed": seed,
            "code": code_digest(),
        }
        text = json.dumps(configuration, sort_keys=True)
        return hashlib.sha256(text.encode()).hexdigest()[:16]

    def motion(self, controller: str, kept: Path | None, progress: Progress) -> Motion:
        """The reference, solved or as it was kept."""
        from enpointe.motion.npz import load_motion, save_motion

        if kept is not None and kept.exists():
            return load_motion(kept, model_of(self.score, self.dancer))
        motion = self._solved(controller, progress)
        if kept is not None:
            save_motion(motion, kept)
        return motion

    def _solved(self, controller: str, progress: Progress) -> Motion:
        from enpointe.motion import Interpolation, find_effort, interpolate, ways_of

        quality, preset_tempo, _ = find_effort(self.effort)
        choreography = prepare(
            self.score,
            tempo=self.tempo if self.tempo is not None else preset_tempo,
            style=self.style,
            dancer=self.dancer,
            progress=progress,
        )
        kind = Interpolation.EXPRESSIVE
        phrased = self.effort is None and has_qualities(self.score)
        ways = ways_of(choreography, quality, kind, phrased=phrased)
        motion = interpolate(choreography, quality, kind, ways=ways)
        return reference(motion, controller, progress)[0]


def _outcomes(
    trial: Trial,
    runs: int,
    key: str,
    path: Path | None,
    processes: int,
    cluster: str | None,
    progress: Progress,
) -> tuple[tuple[Outcome, ...], int, float]:
    """Outcomes of all runs in order, how many are new, and the time that these took."""
    from enpointe.sim.journal import Journal

    if path is None:
        start, found = perf_counter(), {}
        with closing(_danced(trial, range(runs), processes, cluster)) as outcomes:
            for outcome in outcomes:
                found[outcome.run] = outcome
                progress("runs", len(found), runs)
        return _ordered(found, runs), runs, perf_counter() - start
    journal = Journal(path, key)
    known = {o.run: o for o in journal.outcomes if o.run < runs}
    missing = [run for run in range(runs) if run not in known]
    progress("runs", len(known), runs)
    start = perf_counter()
    with journal, closing(_danced(trial, missing, processes, cluster)) as outcomes:
        for outcome in outcomes:
            journal.add(outcome)
            known[outcome.run] = outcome
            progress("runs", len(known), runs)
    return _ordered(known, runs), len(missing), perf_counter() - start


def _ordered(outcomes: Mapping[int, Outcome], runs: int) -> tuple[Outcome, ...]:
    return tuple(outcomes[run] for run in range(runs))


def _danced(
    trial: Trial, runs: Sequence[int], processes: int, cluster: str | None
) -> Generator[Outcome, None, None]:
    from enpointe.sim.workers import on_cluster, on_processes

    if not runs:
        return
    if cluster is not None:
        yield from on_cluster(trial, runs, cluster)
    else:
        yield from on_processes(trial, runs, min(processes, len(runs)))
