"""The README and the pages of docs, and the blocks of code in them."""

from __future__ import annotations

import re
from dataclasses import dataclass
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
if not (ROOT / "docs" / "index.md").is_file():
    pytest.skip("not in a checkout", allow_module_level=True)

PAGES = (ROOT / "README.md", *sorted((ROOT / "docs").glob("*.md")))
BLOCK = re.compile(
    r"(?:<!-- (?P<mark>[^\n]*) -->\n)?^[ ]*```(?P<kind>\w*)\n(?P<text>.*?)^[ ]*```$",
    flags=re.DOTALL | re.MULTILINE,
)
LINK = re.compile(r"!?\[[^\]]*\]\(([^)\s]+)\)")
TWO_FRAMES = """benesh 1
title: Up
method: Cecchetti
metre: 4/4
tempo: 60
beat 0:
  feet: first
  arms: fifth en bas
beat 1:
  arms: fifth en avant
"""


@dataclass(frozen=True)
class Block:
    page: Path
    kind: str
    mark: str
    text: str

    def __str__(self) -> str:
        return f"{self.page.name}: {self.text.strip().splitlines()[0][:50]}"


def name_of(page: Path) -> str:
    return page.name


def blocks(kind: str) -> list[Block]:
    found = []
    for page in PAGES:
        for match in BLOCK.finditer(page.read_text(encoding="utf-8")):
            if match["kind"] == kind:
                found.append(Block(page, kind, match["mark"] or "", match["text"]))
    return found
