"""Who dances does not matter; a journal remembers what was danced."""

from __future__ import annotations

import json
import multiprocessing
from dataclasses import asdict
from pathlib import Path

import pytest

from enpointe.errors import EnpointeError, FormatError
from enpointe.sim.journal import Journal
from enpointe.sim.trial import Outcome
from enpointe.sim.workers import on_cluster, on_processes

from .test_disturbance import trial

OUTCOME = Outcome(0, {"friction": 0.1 + 0.2}, True, None, None, 0.0, 0.01, 1 / 3, 0.0, 0.0, None)


def numbered(run: int) -> Outcome:
    return Outcome(**{**asdict(OUTCOME), "run": run})


@pytest.mark.slow
def test_one_process_two_processes_and_a_cluster_agree() -> None:
    distributed = pytest.importorskip("distributed")
    several = trial("all", 0.15, controller="wholebody")
    runs = range(5)

    def by_number(outcomes: list[Outcome]) -> list[Outcome]:
        return sorted(outcomes, key=lambda outcome: outcome.run)

    alone = by_number([*on_processes(several, runs, 1)])
    assert [o.run for o in alone] == [*runs]
    assert by_number([*on_processes(several, runs, 2)]) == alone
    assert multiprocessing.active_children() == []
    with distributed.LocalCluster(
        n_workers=2, threads_per_worker=1, dashboard_address=":0", protocol="tcp"
    ) as cluster:
        danced = on_cluster(several, runs, cluster.scheduler_address)
        assert by_number([*danced]) == alone


@pytest.mark.slow
def test_who_stops_listening_ends_the_processes() -> None:
    outcomes = on_processes(trial("none", 0.05), range(1000), 1)
    assert next(outcomes).run == 0
    outcomes.close()
    assert multiprocessing.active_children() == []


def test_a_cluster_that_is_not_there_is_one_line(monkeypatch: pytest.MonkeyPatch) -> None:
    pytest.importorskip("distributed")
    monkeypatch.setattr("enpointe.sim.workers.CONNECTING", 0.5)
    with pytest.raises(EnpointeError, match="no Dask scheduler answers"):
        [*on_cluster(trial("none"), [0], "tcp://127.0.0.1:9")]


def test_without_dask_it_says_what_to_install(monkeypatch: pytest.MonkeyPatch) -> None:
    def absent(name: str) -> None:
        raise ImportError(name)

    monkeypatch.setattr("enpointe.sim.workers.import_module", absent)
    with pytest.raises(EnpointeError, match=r"enpointe\[cluster\]"):
        [*on_cluster(trial("none"), [0], "tcp://127.0.0.1:9")]


# -- The journal -------------------------------------------------------------------------------


def written(path: Path, *runs: int, configuration: str = "a") -> Path:
    with Journal(path, configuration) as journal:
        for run in runs:
            journal.add(numbered(run))
    return path


def test_what_was_written_is_read_back_exactly(tmp_path: Path) -> None:
    path = written(tmp_path / "new" / "runs.jsonl", 3, 1)
    assert Journal(path, "a").outcomes == (numbered(3), numbered(1))
    written(path, 2)
    assert Journal(path, "a").outcomes == (numbered(3), numbered(1), numbered(2))


@pytest.mark.parametrize("kept", [1, 30, -1])
def test_a_line_cut_off_is_dropped_and_written_anew(tmp_path: Path, kept: int) -> None:
    path = written(tmp_path / "runs.jsonl", 0)
    path.write_text(path.read_text() + json.dumps(asdict(numbered(1)))[:kept], "utf-8")
    written(path, 2)
    assert Journal(path, "a").outcomes == (numbered(0), numbered(2))


def test_another_sweep_is_not_written_over(tmp_path: Path) -> None:
    path = written(tmp_path / "runs.jsonl", 0)
    before = path.read_bytes()
    with pytest.raises(EnpointeError, match="another sweep"):
        Journal(path, "b")
    assert path.read_bytes() == before


def test_an_empty_journal_stands_in_nobodys_way(tmp_path: Path) -> None:
    path = written(tmp_path / "runs.jsonl")
    written(path, 0, configuration="b")
    assert Journal(path, "b").outcomes == (numbered(0),)


@pytest.mark.parametrize("text", ["", "hello\n", "[]\n", '{"format": "x"}\n', "\udc80"])
def test_another_file_is_refused(tmp_path: Path, text: str) -> None:
    path = tmp_path / "runs.jsonl"
    path.write_bytes(text.encode("utf-8", "surrogateescape"))
    with pytest.raises(FormatError):
        Journal(path, "a")


@pytest.mark.parametrize("line", ["7", "{", '{"run": 1}'])
def test_a_damaged_line_is_named(tmp_path: Path, line: str) -> None:
    path = written(tmp_path / "runs.jsonl", 0)
    path.write_text(f"{path.read_text()}{line}\n{json.dumps(asdict(numbered(1)))}\n", "utf-8")
    with pytest.raises(FormatError, match=":3: "):
        Journal(path, "a")
