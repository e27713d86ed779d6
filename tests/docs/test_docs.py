"""What the README and the docs point at is there: links, commands, tables and pictures."""

from __future__ import annotations

import importlib.util
import re
import shlex
from collections.abc import Iterator
from functools import cache
from itertools import pairwise
from pathlib import Path
from types import ModuleType
from typing import Any

import pytest

import enpointe
from enpointe.cli import app

from .pages import BLOCK, LINK, PAGES, ROOT, blocks, name_of


def headings(page: Path) -> set[str]:
    """The anchors of a page, as they are made from its headings."""
    text = BLOCK.sub("", page.read_text(encoding="utf-8"))
    titles = re.findall(r"^#+ (.*)$", text, flags=re.MULTILINE)
    return {re.sub(r"[^\w\- ]", "", title.lower()).strip().replace(" ", "-") for title in titles}


@pytest.mark.parametrize(
    "page", [*PAGES, ROOT / "CHANGELOG.md", ROOT / "CONTRIBUTING.md"], ids=name_of
)
def test_every_relative_link_leads_somewhere(page: Path) -> None:
    text = BLOCK.sub("", page.read_text(encoding="utf-8"))
    for link in LINK.findall(text):
        if re.match(r"[a-z]+:", link):
            continue
        target, _, anchor = link.partition("#")
        file = (page.parent / target).resolve() if target else page
        assert file.exists(), f"{page.name} links to {link}, which is not there"
        assert not anchor or anchor in headings(file), f"{page.name}: no heading #{anchor}"


def test_every_page_is_found_from_the_index() -> None:
    linked = set(LINK.findall((ROOT / "docs" / "index.md").read_text(encoding="utf-8")))
    pages = {page.name for page in PAGES if page.name not in ("README.md", "index.md")}
    assert pages <= linked


def commands() -> Iterator[tuple[str, list[str]]]:
    for block in blocks("bash"):
        for line in block.text.splitlines():
            words = shlex.split(line, comments=True)
            if words:
                yield block.page.name, words
    for page in PAGES:
        text = BLOCK.sub("", page.read_text(encoding="utf-8"))
        for code in re.findall(r"`(enpointe [^`]*|python [^`]*)`", text):
            yield page.name, shlex.split(code)


@cache
def options(verb: str) -> dict[str, Any]:
    """The options of a verb by every spelling, as the command line itself knows them."""
    import typer.main

    verbs = vars(typer.main.get_command(app))["commands"]
    command = verbs[verb]
    return {o: p for p in command.params for o in (*p.opts, *p.secondary_opts)}


@pytest.mark.parametrize(
    ("page", "words"), [pytest.param(p, w, id=f"{p}: {' '.join(w)}"[:60]) for p, w in commands()]
)
def test_every_command_exists(page: str, words: list[str]) -> None:
    if words[0] == "python":
        assert (ROOT / words[1]).is_file()
        return
    assert words[0] == "enpointe"
    verb, *rest = words[1:]
    known = options(verb)
    for word in rest:
        if word.startswith("-"):
            assert word in known, f"{page}: enpointe {verb} has no {word}"
    given = dict(pairwise(rest))
    if "--effort" in given:
        from enpointe.motion import find_effort

        find_effort(given["--effort"])
    motions = (".amc", ".bvh", ".npz") if verb in ("perform", "compare") else ()
    file = (".bmn", *motions)
    if verb in ("perform", "compare", "sweep") and rest and not rest[0].endswith(file):
        poses = enpointe.notation.names() if "--hold" in rest else ()
        assert rest[0] in (*enpointe.notation.shipped_scores(), *poses)


def load(file: Path) -> ModuleType:
    spec = importlib.util.spec_from_file_location(file.stem, file)
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


@pytest.fixture(scope="module")
def tables() -> ModuleType:
    return load(ROOT / "docs" / "make_tables.py")


@pytest.mark.parametrize("page", PAGES, ids=name_of)
def test_tables_are_what_the_code_says(page: Path, tables: ModuleType) -> None:
    text = page.read_text(encoding="utf-8")
    assert tables.filled(text) == text, "run python docs/make_tables.py"


def test_every_table_stands_somewhere(tables: ModuleType) -> None:
    used = {
        match[2]
        for page in PAGES
        for match in tables.MARKED.finditer(page.read_text(encoding="utf-8"))
    }
    assert used == set(tables.TABLES)


def test_pictures_are_small_and_used() -> None:
    linked = {
        (page.parent / link).resolve()
        for page in PAGES
        for link in LINK.findall(page.read_text(encoding="utf-8"))
        if link.endswith(".png")
    }
    pictures = set((ROOT / "docs" / "images").glob("*.png"))
    assert pictures == linked
    for picture in pictures:
        assert picture.stat().st_size < 300_000
