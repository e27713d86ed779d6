"""A folder to work in, a short score, and a report that costs nothing."""

from __future__ import annotations

from pathlib import Path

import pytest

import enpointe
from enpointe.files import write_text
from enpointe.report.writing import ReportFiles

from .commands import SHORT


@pytest.fixture
def home(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """An empty folder to work in; scores lie elsewhere."""
    folder = tmp_path / "home"
    folder.mkdir()
    monkeypatch.chdir(folder)
    return folder


@pytest.fixture
def short(tmp_path: Path) -> Path:
    file = tmp_path / "short.bmn"
    file.write_text(SHORT, "utf-8")
    return file


@pytest.fixture
def plain_report(monkeypatch: pytest.MonkeyPatch) -> list[object]:
    """A report of one word instead of pictures; returns what was reported."""
    reported: list[object] = []

    def write(what: object, folder: Path, **_: object) -> ReportFiles:
        reported.append(what)
        return ReportFiles({"report": write_text(folder / "report.html", "danced")}, None)

    monkeypatch.setitem(vars(enpointe), "write_report", write)
    return reported
