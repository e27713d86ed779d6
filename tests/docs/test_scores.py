"""Scores that the docs show are scores, and keep every rule."""

from __future__ import annotations

import re
import shlex
from pathlib import Path

import pytest
from typer.testing import CliRunner

import enpointe
from enpointe.cli import app
from enpointe.notation import (
    format_score,
    load_vocabulary,
    parse_score,
    score_from_json,
    score_to_json,
)

from .pages import BLOCK, ROOT, TWO_FRAMES, Block, blocks


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
