"""Whatever is wrong with what a person wrote: one line, exit code 2, nothing written."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest

from ..notation.texts import HEAD, START, frame
from .commands import ALOFT, refused

MALFORMED: dict[str, tuple[str | bytes, int]] = {
    "unknown sign": (frame("  left hand: 1 wide, 4 high, beside"), 10),
    "unknown part": (frame("  wing: erect"), 10),
    "beat going back": (frame("  head: erect") + "beat 1/2:\n  head: erect\n", 11),
    "beat twice": (START + "beat 0:\n", 9),
    "arm longer than it is": (frame("  left hand: 0.9 wide, 5.9 high, front"), 10),
    "width longer than an arm": (frame("  left hand: 1.5 wide, 4 high, level"), 10),
    "leg longer than it is": (frame("  left foot: 0.95 wide, 1.2 high, front"), 10),
    "no header": ("beat 0:\n  feet: first\n  arms: first\n", 1),
    "no metre": (START.replace("metre: 4/4\n", ""), 5),
    "wrong metre": (START.replace("4/4", "4/3"), 4),
    "binary": (bytes(range(256)) * 4, 1),
    "compressed": (b"PK\x03\x04\x14\x00\x00\x00\x08\x00", 1),
    "empty": ("", 1),
    "only blank lines": ("\n \n\t\n", 1),
    "50 MB": (b"# a line\n" * (50_000_000 // 9), 1),
    "unknown position": (frame("  arms: fifth en plein air"), 10),
    "contradictory signs": (frame("  arms: first\n  left hand: 1 wide, 4 high, level"), 11),
    "same sign twice": (frame("  head: erect\n  head: turn left 10"), 11),
    "not a number": (frame("  head: turn left nan"), 10),
    "huge number": (frame("  head: turn left 1e999"), 10),
    "tempo not a number": (START.replace("60", "nan"), 5),
    "no frames": (HEAD, 5),
    "no feet": (START.replace("  feet: first\n", ""), 6),
    "not UTF-8": (START.replace("title: T", "title: à").encode("latin-1"), 2),
    "one endless line": ("benesh 1 " + "x" * 5000, 1),
}


@pytest.mark.parametrize("verb", ["perform", "compare", "pose"])
@pytest.mark.parametrize("name", MALFORMED)
def test_a_malformed_score_is_one_line_with_its_place(
    name: str, verb: str, home: Path, tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    text, line = MALFORMED[name]
    score = tmp_path / "bad.bmn"
    score.write_bytes(text if isinstance(text, bytes) else text.encode())
    message = refused(capfd, verb, str(score), "--json")
    file, at, column, _ = message.removeprefix("enpointe: ").split(":", 3)
    assert file == str(score)
    assert int(at) == line
    assert int(column) >= 1
    assert list(home.iterdir()) == []


@pytest.mark.parametrize("verb", ["perform", "compare"])
def test_nobody_stays_in_the_air_without_a_jump(
    verb: str, home: Path, tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    score = tmp_path / "aloft.bmn"
    score.write_text(ALOFT, "utf-8")
    message = refused(capfd, verb, str(score), "--json")
    assert message.startswith(f"enpointe: {score}:9:1: ")
    assert "write 'jump: off ..., on ...'" in message
    assert list(home.iterdir()) == []


def test_a_malformed_score_does_not_wait_for_the_engines(tmp_path: Path) -> None:
    score = tmp_path / "bad.bmn"
    score.write_text(frame("  arms: fifth en plein air"))
    code = (
        "import sys\nfrom enpointe.cli import _run\n"
        "assert _run(['perform', sys.argv[1]]) == 2\n"
        "assert not {'mujoco', 'casadi', 'mink'} & set(sys.modules)\n"
    )
    run = subprocess.run(
        [sys.executable, "-P", "-c", code, str(score)], capture_output=True, text=True, check=False
    )
    assert run.returncode == 0, run.stderr


@pytest.mark.parametrize("verb", ["perform", "compare"])
@pytest.mark.parametrize("source", ["nope", "nope.bmn", ".", "", "a\nb", "a\0b", "/dev/null"])
def test_what_is_no_file_is_one_line(
    verb: str, source: str, home: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    refused(capfd, verb, source)
    assert list(home.iterdir()) == []


def test_a_misspelt_shipped_score_is_corrected(
    home: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    assert "did you mean third-port-de-bras" in refused(capfd, "perform", "third-port-de-bra")


def test_a_score_nobody_can_read(
    short: Path, home: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    """A link to itself: the system refuses it to everybody, root too."""
    short.unlink()
    short.symlink_to(short)
    assert "can't be read" in refused(capfd, "perform", str(short))


@pytest.mark.parametrize(
    "arguments",
    [
        [],
        ["--effort", "joyful"],
        ["--effort", "time=-9"],
        ["--tempo", "0"],
        ["--tempo", "nan"],
        ["--tempo", "quick"],
        ["--controller", "telepathy"],
        ["--body", "puppet-on-a-string"],
        ["--height", "9"],
        ["--mass", "-54"],
        ["--sex", "maybe"],
        ["--turnout", "180"],
        ["--seed", "x"],
        ["--bogus"],
    ],
)
def test_bad_options_are_one_line(
    arguments: list[str], short: Path, home: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    source = [str(short)] if arguments else []
    refused(capfd, "perform", *source, *arguments)
    assert list(home.iterdir()) == []


@pytest.mark.parametrize("arguments", [["pose"], ["pose", "arms sixth"], ["dance"], ["--version-"]])
def test_bad_commands_are_one_line(
    arguments: list[str], home: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    refused(capfd, *arguments)


@pytest.mark.parametrize("block", [lambda p: p.write_text("a file"), lambda p: p.symlink_to(p)])
def test_a_folder_that_cannot_be_written_is_one_line(
    block: Callable[[Path], object],
    short: Path,
    home: Path,
    plain_report: list[object],
    capfd: pytest.CaptureFixture[str],
) -> None:
    block(home / "taken")
    refused(capfd, "perform", str(short), "--controller", "kinematic", "--out", "taken")
    assert [p.name for p in home.iterdir()] == ["taken"]


LIMITED = """
import resource, sys
resource.setrlimit(resource.RLIMIT_AS, (3 << 30, 3 << 30))
from enpointe.cli import _run
sys.exit(_run(sys.argv[1:]))
"""


@pytest.mark.slow
def test_a_score_too_long_to_dance_is_refused_as_such(tmp_path: Path) -> None:
    score = tmp_path / "long.bmn"
    score.write_text(START + "beat 99999:\n  head: turn left 20\n")
    run = subprocess.run(
        [sys.executable, "-P", "-c", LIMITED, "perform", str(score), "--tempo", "1", "--json"],
        cwd=tmp_path,
        capture_output=True,
        text=True,
        check=False,
    )
    assert run.returncode == 2
    assert run.stderr.count("\n") == 1
    assert "fault of ours" not in run.stderr
