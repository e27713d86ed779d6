"""`enpointe sweep`: figures, files, going on where it stopped, and refusals."""

from __future__ import annotations

import csv
import json
from collections.abc import Iterable, Iterator
from pathlib import Path

import pytest

from enpointe.cli import _run
from enpointe.sim import workers
from enpointe.sim.trial import Outcome, Trial

from .commands import one_object, refused


@pytest.fixture
def danced(monkeypatch: pytest.MonkeyPatch) -> list[int]:
    """Runs are danced here, backwards, instead of by other processes; returns their numbers."""
    numbers: list[int] = []

    def here(trial: Trial, runs: Iterable[int], processes: int) -> Iterator[Outcome]:
        for run in reversed([*runs]):
            yield trial.run(run)
            numbers.append(run)

    monkeypatch.setattr(workers, "on_processes", here)
    return numbers


def swept(score: Path, *options: str) -> int:
    return _run(["sweep", str(score), "--controller", "pd", "--out", "swept", *options])


def test_figures_files_and_the_first_line(
    short: Path, home: Path, danced: list[int], capfd: pytest.CaptureFixture[str]
) -> None:
    assert swept(short, "--runs", "3", "--disturb", "mass=0.05,push=0.5", "--json") == 0
    out, err = capfd.readouterr()
    assert err == ""
    figures = one_object(out)
    assert next(iter(figures)) == "disturbed_by"
    assert figures["runs"] == 3
    assert figures["completed_fraction"] == 1.0
    assert figures["failures"] == []
    assert figures["root_force_max"] == 0.0
    assert isinstance(figures["runs_per_second"], float)
    files = figures["files"]
    assert isinstance(files, dict)
    assert set(files) == {"report", "heat_map", "table", "summary", "journal"}
    assert Path(files["heat_map"]).read_bytes().startswith(b"\x89PNG")
    page = Path(files["report"]).read_text("utf-8")
    assert page.index("Disturbed on purpose") < page.index("<h1>")
    with Path(files["table"]).open(encoding="utf-8") as table:
        rows = [*csv.DictReader(table)]
    assert [row["run"] for row in rows] == ["0", "1", "2"]
    assert {row["push"] for row in rows} == {"0.5"}
    assert {row["friction"] for row in rows} == {""}
    assert len({row["mass_error"] for row in rows}) == 3
    stored = json.loads(Path(files["summary"]).read_text("utf-8"))
    assert stored["completed_fraction"] == 1.0


def test_a_sweep_goes_on_where_it_stopped(
    short: Path, home: Path, danced: list[int], capfd: pytest.CaptureFixture[str]
) -> None:
    assert swept(short, "--runs", "2", "--disturb", "mass", "-q") == 0
    alone = Path("swept/runs.csv").read_text("utf-8")
    journal = Path("swept/runs.jsonl")
    # Stopped while it wrote the last run down: the first in the file is run 1.
    journal.write_text(journal.read_text("utf-8")[:-20], "utf-8")
    danced.clear()
    assert swept(short, "--runs", "3", "--disturb", "mass", "-q") == 0
    assert danced == [2, 0]
    assert Path("swept/runs.csv").read_text("utf-8").startswith(alone)
    danced.clear()
    assert swept(short, "--runs", "3", "--disturb", "mass", "--json") == 0
    assert danced == []
    assert one_object(capfd.readouterr().out)["runs_per_second"] is None
    line = refused(
        capfd, "sweep", str(short), "--controller", "pd", "--out", "swept", "--seed", "1"
    )
    assert "another sweep" in line


def test_falls_are_answered_with_no_and_told(
    short: Path, home: Path, danced: list[int], capfd: pytest.CaptureFixture[str]
) -> None:
    assert swept(short, "--runs", "2", "--disturb", "push=100") == 1
    assert "2: runs 0, 1" in capfd.readouterr().out
    assert "Runs not completed" in Path("swept/report.html").read_text("utf-8")
    assert swept(short, "--runs", "2", "--disturb", "push=100", "--at-least", "0", "--json") == 0
    failures = one_object(capfd.readouterr().out)["failures"]
    assert isinstance(failures, list)
    assert [failure["run"] for failure in failures] == [0, 1]
    assert {"factors", "fell_at", "run"} <= set(failures[0])


def test_an_interrupted_sweep_keeps_what_was_finished(
    short: Path, home: Path, monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]
) -> None:
    def stopped(trial: Trial, runs: Iterable[int], processes: int) -> Iterator[Outcome]:
        yield trial.run(0)
        raise KeyboardInterrupt

    monkeypatch.setattr(workers, "on_processes", stopped)
    assert swept(short, "--runs", "3", "--disturb", "mass") in (2, 130)
    out, err = capfd.readouterr()
    assert (out, err.count("\n") <= 1) == ("", True)
    lines = Path("swept/runs.jsonl").read_text("utf-8").splitlines()
    assert [json.loads(line)["run"] for line in lines[1:]] == [0]


@pytest.mark.parametrize(
    "options",
    [
        ["--disturb", "wind"],
        ["--runs", "0"],
        ["--processes", "0"],
        ["--seed", "-1"],
        ["--controller", "kinematic"],
        ["--map", "push_at"],
        ["--map", "push_at,wind"],
    ],
)
def test_what_makes_no_sense_is_refused_before_anything_is_done(
    short: Path, home: Path, capfd: pytest.CaptureFixture[str], options: list[str]
) -> None:
    refused(capfd, "sweep", str(short), "--out", "swept", *options)
    assert [*home.iterdir()] == []
