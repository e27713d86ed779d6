"""What a report writes, and that work that fails leaves things as they were."""

from __future__ import annotations

import os
from pathlib import Path

import pytest
from PIL import Image

import enpointe.sim.render
from enpointe.comparing import Comparison
from enpointe.errors import EnpointeError
from enpointe.performing import Performance
from enpointe.posing import Poses
from enpointe.report import ReportFiles, write_report

from .pages import read, words_of


def test_film_is_in_the_page_and_beside_it(
    physical: Performance, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("enpointe.report.films.FPS", 5.0)
    told: list[tuple[str, float, float]] = []
    files = write_report(physical, tmp_path, progress=lambda *args: told.append(args))
    page = read(files["report"])
    assert files["video"].stat().st_size > 1000
    section = next(s for s in page.iter("section") if s.attrib["id"] == "film")
    sources = [e.attrib["src"] for e in section.iter() if "src" in e.attrib]
    assert len(sources) == 1
    assert sources[0].startswith(("data:video/mp4;base64,", "data:image/gif;base64,"))
    films = [(done, total) for task, done, total in told if task == "film"]
    assert films
    assert films[-1][0] == films[-1][1]


def test_gif_where_mp4_cannot_be_written(
    comparison: Comparison, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("enpointe.report.films.can_write_mp4", lambda: False)
    monkeypatch.setattr("enpointe.report.films.FPS_SLOW", 5.0)
    files = write_report(comparison, tmp_path)
    assert files["video"].name == "dance.gif"
    with Image.open(files["video"]) as film:
        assert film.format == "GIF"
        assert film.width > 2 * film.height
    assert "<video" not in files["report"].read_text(encoding="utf-8")


def test_without_opengl_one_line_says_so(
    poses: Poses, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    line = "no OpenGL here; using the sketch renderer"
    monkeypatch.setattr(enpointe.sim.render, "_find_backend", lambda: (None, line))
    files = write_report(poses, tmp_path, video=False)
    assert files.warning == line
    page = read(files["report"])
    assert [words_of(e) for e in page.iter() if e.attrib.get("id") == "warning"] == [line]


def test_with_opengl_nothing_is_said(
    reports: dict[str, ReportFiles],
) -> None:
    if enpointe.sim.render.gl_backend() is None:
        pytest.skip("this machine has no OpenGL")
    for files in reports.values():
        assert files.warning is None
        assert 'id="warning"' not in files["report"].read_text(encoding="utf-8")


def test_a_file_on_the_way_is_one_line_and_nothing_is_left(poses: Poses, tmp_path: Path) -> None:
    (tmp_path / "taken").write_text("mine", encoding="utf-8")
    with pytest.raises(EnpointeError) as caught:
        write_report(poses, tmp_path / "taken" / "deeper")
    assert "\n" not in str(caught.value)
    assert [p.name for p in tmp_path.iterdir()] == ["taken"]
    assert (tmp_path / "taken").read_text(encoding="utf-8") == "mine"


@pytest.mark.skipif(
    not hasattr(os, "geteuid") or os.geteuid() == 0, reason="the superuser may write anywhere"
)
def test_a_folder_without_leave_is_one_line(poses: Poses, tmp_path: Path) -> None:
    locked = tmp_path / "locked"
    locked.mkdir(mode=0o555)
    with pytest.raises(EnpointeError) as caught:
        write_report(poses, locked / "out")
    assert "\n" not in str(caught.value)
    assert not list(locked.iterdir())


def _break(*_: object, **__: object) -> None:
    raise EnpointeError("the painter fainted")


@pytest.mark.parametrize("existed", [False, True])
def test_work_that_fails_leaves_nothing_behind(
    poses: Poses,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    existed: bool,
) -> None:
    out = tmp_path if existed else tmp_path / "new" / "folder"
    monkeypatch.setattr("enpointe.report.writing.stills", _break)
    with pytest.raises(EnpointeError, match="fainted"):
        write_report(poses, out)
    assert not list(tmp_path.iterdir())


def test_an_older_report_survives_work_that_fails(
    poses: Poses, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    write_report(poses, tmp_path)
    before = {p.name: p.read_bytes() for p in tmp_path.iterdir()}
    monkeypatch.setattr("enpointe.report.writing.render", _break)
    with pytest.raises(EnpointeError, match="fainted"):
        write_report(poses, tmp_path)
    assert {p.name: p.read_bytes() for p in tmp_path.iterdir()} == before
