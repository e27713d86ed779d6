"""Code is told apart by what is in it."""

from __future__ import annotations

from pathlib import Path

import pytest

from enpointe import sim
from enpointe.sim.fingerprint import code_digest


def test_a_changed_line_is_another_code(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def digest() -> str:
        return str(code_digest.__wrapped__())

    before = digest()
    assert before == code_digest()
    extra = tmp_path / "extra.py"
    extra.write_text("a = 1\n")
    monkeypatch.setattr(sim, "__path__", [*sim.__path__, str(tmp_path)])
    one = digest()
    extra.write_text("a = 2\n")
    assert len({before, one, digest()}) == 3
