"""What the README and the docs say is so: links, commands, Python, tables and fields."""

from __future__ import annotations

import importlib.util
import json
import re
import shlex
import subprocess
import sys
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache
from itertools import pairwise
from pathlib import Path
from types import ModuleType
from typing import Any

import pytest
from typer.testing import CliRunner

import enpointe
from enpointe.cli import app
from enpointe.notation import (
    Score,
    format_score,
    load_vocabulary,
    parse_score,
    score_from_json,
    score_to_json,
)
from enpointe.sim.balance_table import COLUMNS

ROOT = Path(__file__).resolve().parents[2]
if not (ROOT / "docs" / "index.md").is_file():
    pytest.skip("not in a checkout", allow_module_level=True)

PAGES = (ROOT / "README.md", *sorted((ROOT / "docs").glob("*.md")))
EXAMPLES = sorted((ROOT / "examples").glob("*.py"))
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
    file = (".bmn", ".amc", ".bvh", ".npz") if verb == "perform" else (".bmn",)
    if verb in ("perform", "compare", "sweep") and rest and not rest[0].endswith(file):
        poses = enpointe.notation.names() if "--hold" in rest else ()
        assert rest[0] in (*enpointe.notation.shipped_scores(), *poses)


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


def whole_score(block: Block) -> str:
    """A part of a score, with what it lacks."""
    if block.mark == "header":
        frames = "".join(f"beat {beat}:\n  arms: first\n" for beat in range(1, 9))
        return f"benesh 1\n{block.text}beat 0:\n  feet: first\n  arms: fifth en bas\n{frames}"
    assert block.mark == "frame"
    return TWO_FRAMES[: TWO_FRAMES.index("beat 1:")] + block.text


@pytest.mark.parametrize("block", [b for b in blocks("bmn") if b.mark], ids=str)
def test_every_part_of_a_score_is_one(block: Block, tmp_path: Path) -> None:
    if block.mark == "vocabulary":
        (tmp_path / "mine.bmn").write_text(block.text, encoding="utf-8")
        assert load_vocabulary(tmp_path / "mine.bmn").macros
        return
    score = parse_score(whole_score(block), str(block))
    assert len(score.resolved()) == len(score.frames)
    assert parse_score(format_score(score)) == score == score_from_json(score_to_json(score))


@pytest.mark.parametrize("block", [b for b in blocks("json") if "frames" in b.text], ids=str)
def test_every_json_score_is_one(block: Block) -> None:
    score = score_from_json(block.text, str(block))
    assert score_from_json(score_to_json(score)) == score == parse_score(format_score(score))
    assert len(score.resolved()) == len(score.frames)


def test_the_parts_write_every_kind_of_line() -> None:
    """What the grammar allows under a beat is shown."""
    shown = "".join(block.text for block in blocks("bmn"))
    for word in (
        *("feet", "arms", "pose", "head", "body", "pelvis", "face", "place", "travel", "turn"),
        *("jump", "left hand", "right elbow", "right foot", "right knee", "left leg"),
        *("repeat", "phrase", "pickup", "define arms", "define leg", "define pose"),
    ):
        assert re.search(rf"^ *{word}\b", shown, flags=re.MULTILINE), word


@pytest.mark.slow
def test_the_first_score_is_posed_drawn_and_danced(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The ten minutes of notation.md, as the page has them: its own file and its own commands."""
    page = ROOT / "docs" / "notation.md"
    (whole,) = (block for block in blocks("bmn") if block.page == page and not block.mark)
    lines = next(b for b in blocks("bash") if b.page == page and "breath.bmn" in b.text).text
    monkeypatch.chdir(tmp_path)
    Path("breath.bmn").write_text(whole.text, encoding="utf-8")
    commands = [shlex.split(line)[1:] for line in lines.splitlines()]
    assert {words[0] for words in commands} == {"pose", "perform"}
    for words in commands:
        if words[0] == "pose" or "kinematic" in words:
            assert CliRunner().invoke(app, words).exit_code == 0, words
    for file in ("stave.svg", "report.html", "motion.npz"):
        assert (tmp_path / "breath" / file).stat().st_size > 1000, file


@pytest.mark.parametrize("block", [b for b in blocks("bmn") if not b.mark], ids=str)
def test_every_score_keeps_every_rule(block: Block) -> None:
    poses = enpointe.pose(parse_score(block.text, str(block)))
    assert poses.held, [str(p.certificate) for p in poses.key_poses]


def test_the_steps_of_the_first_score_make_the_whole() -> None:
    text = (ROOT / "docs" / "notation.md").read_text(encoding="utf-8")
    steps = text[: text.index("Here is the whole of it.")]
    parts = [match["text"] for match in BLOCK.finditer(steps) if not match["kind"]]
    (whole,) = (block for block in blocks("bmn") if not block.mark)
    assert parse_score("".join(parts)) == parse_score(whole.text)


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


def table(mark: str) -> str:
    """The table of figures.md after `<!-- fields: mark -->`."""
    text = (ROOT / "docs" / "figures.md").read_text(encoding="utf-8")
    return text.split(f"<!-- fields: {mark} -->\n\n", 1)[1].split("\n\n", 1)[0]


def fields(mark: str) -> set[str]:
    """The names in the first column of that table."""
    return set(re.findall(r"^\| `(\w+)` \|", table(mark), flags=re.MULTILINE))


@pytest.fixture(scope="module")
def phrase() -> Score:
    return parse_score(TWO_FRAMES)


def test_fields_of_a_kinematic_performance(phrase: Score) -> None:
    dance = enpointe.perform(phrase, controller="kinematic")
    assert set(dance.summary()) == fields("kinematic")


def test_fields_of_a_performance_of_a_file(phrase: Score, tmp_path: Path) -> None:
    drawn = enpointe.perform(phrase, controller="kinematic").save(tmp_path)["motion"]
    figures = enpointe.perform_file(drawn, controller="kinematic").summary()
    assert set(figures) == fields("kinematic") | fields("file")


def test_fields_of_a_check(phrase: Score) -> None:
    assert set(enpointe.check(phrase).summary()) == fields("check")


def test_fields_of_a_conversion(tmp_path: Path) -> None:
    source = tmp_path / "a.csv"
    source.write_text("time [s],a.x [m],a.y [m],a.z [m]\n0,0,0,1\n0.1,0,0,1\n")
    assert set(enpointe.convert(source, tmp_path / "a.trc").summary()) == fields("conversion")


def test_fields_of_a_sweep() -> None:
    from enpointe.models import dancer_model
    from enpointe.sim.disturbance import Disturbances, Factors
    from enpointe.sim.trial import Outcome

    model = dancer_model(flesh=False)
    factors = Factors().figures(model, model.qpos0)
    fallen = Outcome(0, factors, False, 1.0, "fell", 0.0, None, None, None, None, None)
    swept = enpointe.Sweep("T", 1.0, "pd", Disturbances.parse(None), 0, (fallen,), 1, 1.0)
    figures = swept.summary()
    assert set(figures) == fields("sweep")
    assert set(figures["failures"][0]["factors"]) == fields("factors")


@pytest.mark.slow
def test_fields_of_a_physical_performance_and_a_comparison(phrase: Score) -> None:
    comparison = enpointe.compare(phrase)
    figures = comparison.summary()
    physical = comparison.performances["physical"].summary()
    assert set(physical) == fields("kinematic") | fields("physical")
    assert fields("wholebody") == {"qp_failures"}
    assert set(figures) == {"variants", "differences"}
    for difference in figures["differences"]:
        assert set(difference) == fields("difference")


def test_columns_of_the_balance_table() -> None:
    assert fields("balance") == set(COLUMNS)


def test_fields_of_poses(phrase: Score) -> None:
    (row,) = re.findall(r"^\| `rules` \|.*$", table("pose"), flags=re.MULTILINE)
    for pose in enpointe.pose(phrase).summary()["poses"]:
        assert set(pose) == fields("pose")
        for rule in pose["rules"]:
            assert set(rule) == set(re.findall(r"`(\w+)`", row)) - {"rules", "mm", "deg"}
    json.dumps(enpointe.pose(phrase).summary())


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


@pytest.mark.slow
def test_the_readmes_figures_are_those_of_the_dance() -> None:
    """Rounded as the README rounds them."""
    figures = enpointe.perform("third-port-de-bras", effort="happy").summary()
    margin, fit = figures["support_margin_min"], figures["logistic"]
    assert margin is not None
    assert fit is not None
    said = dict(
        re.findall(
            r"^\| ([^|]*?) \| ([^|]*?) \|",
            (ROOT / "README.md").read_text(encoding="utf-8"),
            flags=re.MULTILINE,
        )
    )
    assert {
        "joints behind the score, rms": f"{figures['tracking_rms_deg']:.2f}°",
        "centre of mass inside the support, at least": f"{1000 * margin:.0f} mm",
        "feet slip, at most": f"{1000 * figures['slip_max']:.1f} mm",
        "force on the root from anything but gravity and floor": f"{figures['root_force_max']:g} N",
        "strength used, at most": f"{100 * figures['torque_limit_fraction_max']:.0f} %",
        "timing asked, and danced under gravity": (
            f"$b$ −2.42, −{-fit['b']:.2f}; $x_0$ 0.60, {fit['x0']:.2f}"
        ),
    }.items() <= said.items()
