"""The Python that the docs show, and every example, runs."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from .pages import ROOT, Block, blocks, name_of

EXAMPLES = sorted((ROOT / "examples").glob("*.py"))


def runs(pages: dict[Path, list[Block]]) -> Iterator[Any]:
    """The quick blocks of each page, and all of them where some are marked slow."""
    for page, every in pages.items():
        # A block that shows an example is run as that example.
        found = [block for block in every if not block.mark.startswith("example")]
        quick = [block for block in found if block.mark != "slow"]
        if quick:
            yield pytest.param(quick, id=f"{page.name}-quick")
        if len(quick) < len(found):
            yield pytest.param(found, id=f"{page.name}-all", marks=pytest.mark.slow)


def python_by_page() -> dict[Path, list[Block]]:
    pages: dict[Path, list[Block]] = {}
    for block in blocks("python"):
        pages.setdefault(block.page, []).append(block)
    return pages


@pytest.mark.parametrize("found", list(runs(python_by_page())))
def test_every_python_block_runs(
    found: list[Block], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Blocks of a page share their names, as they would in a notebook."""
    monkeypatch.chdir(tmp_path)
    names: dict[str, Any] = {"__name__": "docs"}
    for block in found:
        exec(compile(block.text, str(block), "exec"), names)


@pytest.mark.parametrize("block", [b for b in blocks("python") if "example" in b.mark], ids=str)
def test_a_shown_example_is_the_example(block: Block) -> None:
    file = ROOT / "examples" / block.mark.removeprefix("example: ")
    _, _, code = file.read_text(encoding="utf-8").split('"""', 2)
    assert code.strip() == block.text.strip()
    assert len([line for line in block.text.splitlines() if line.strip()]) <= 10


@pytest.mark.slow
@pytest.mark.parametrize("example", EXAMPLES, ids=name_of)
def test_every_example_runs(example: Path, tmp_path: Path) -> None:
    done = subprocess.run(
        [sys.executable, "-P", str(example)],
        cwd=tmp_path,
        capture_output=True,
        text=True,
        timeout=300,
    )
    assert done.returncode == 0, done.stderr
    assert done.stdout.strip()


@pytest.mark.parametrize("example", EXAMPLES, ids=name_of)
def test_every_example_is_short_and_says_what_it_shows(example: Path) -> None:
    text = example.read_text(encoding="utf-8")
    assert text.startswith('"""')
    assert len([line for line in text.splitlines() if line.strip()]) <= 42
