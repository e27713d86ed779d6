"""The command line: its figures, its exit codes, and one line for whatever is wrong."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
from collections.abc import Callable, Mapping
from pathlib import Path

import pytest

import enpointe
from enpointe.cli import _run
from enpointe.files import write_text
from enpointe.report.writing import ReportFiles

from ..motion.dancing import written_score
from .test_perform import PHYSICAL, SHORT, make_limp

HEAD = "benesh 1\ntitle: T\nmethod: Cecchetti\nmetre: 4/4\ntempo: 60\n"
START = HEAD + "beat 0:\n  feet: first\n  arms: first\n"


def second(line: str) -> str:
    return f"{START}beat 1:\n  {line}\n"


MALFORMED: dict[str, tuple[str | bytes, int]] = {
    "unknown sign": (second("left hand: 1 wide, 4 high, beside"), 10),
    "unknown part": (second("wing: erect"), 10),
    "beat going back": (second("head: erect") + "beat 1/2:\n  head: erect\n", 11),
    "beat twice": (START + "beat 0:\n", 9),
    "arm longer than it is": (second("left hand: 0.9 wide, 5.9 high, front"), 10),
    "width longer than an arm": (second("left hand: 1.5 wide, 4 high, level"), 10),
    "leg longer than it is": (second("left foot: 0.95 wide, 1.2 high, front"), 10),
    "no header": ("beat 0:\n  feet: first\n  arms: first\n", 1),
    "no metre": (START.replace("metre: 4/4\n", ""), 5),
    "wrong metre": (START.replace("4/4", "4/3"), 4),
    "binary": (bytes(range(256)) * 4, 1),
    "compressed": (b"PK\x03\x04\x14\x00\x00\x00\x08\x00", 1),
    "empty": ("", 1),
    "only blank lines": ("\n \n\t\n", 1),
    "50 MB": (b"# a line\n" * (50_000_000 // 9), 1),
    "unknown position": (second("arms: fifth en plein air"), 10),
    "contradictory signs": (second("arms: first\n  left hand: 1 wide, 4 high, level"), 11),
    "same sign twice": (second("head: erect\n  head: turn left 10"), 11),
    "not a number": (second("head: turn left nan"), 10),
    "huge number": (second("head: turn left 1e999"), 10),
    "tempo not a number": (START.replace("60", "nan"), 5),
    "no frames": (HEAD, 5),
    "no feet": (START.replace("  feet: first\n", ""), 6),
    "not UTF-8": (START.replace("title: T", "title: à").encode("latin-1"), 2),
    "one endless line": ("benesh 1 " + "x" * 5000, 1),
}
ALOFT = second("left leg: pointed devant\n  right leg: pointed derrière")
"""A frame with nobody on the floor, and no jump that leads there."""


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


def refused(capfd: pytest.CaptureFixture[str], *arguments: str) -> str:
    """The one line with which a command is refused."""
    assert _run(list(arguments)) == 2
    out, err = capfd.readouterr()
    assert out == ""
    assert err.endswith("\n")
    assert err.count("\n") == 1
    assert err.startswith("enpointe: ")
    assert "fault of ours" not in err
    return err


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


def test_a_pose_in_the_air_is_a_pose(
    home: Path,
    tmp_path: Path,
    plain_report: list[object],
    capfd: pytest.CaptureFixture[str],
) -> None:
    """Nothing holds her there, and nothing has to: a picture of a jump."""
    score = tmp_path / "aloft.bmn"
    score.write_text(ALOFT, "utf-8")
    assert _run(["pose", str(score), "--json"]) == 0
    poses = one_object(capfd.readouterr().out)["poses"]
    assert isinstance(poses, list)
    standing, aloft = ({rule["rule"] for rule in pose["rules"]} for pose in poses)
    assert "centre of mass over the support" in standing - aloft
    assert "left pointed foot" in aloft - standing


def test_a_malformed_score_does_not_wait_for_the_engines(tmp_path: Path) -> None:
    score = tmp_path / "bad.bmn"
    score.write_text(second("arms: fifth en plein air"))
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


@pytest.mark.skipif(os.geteuid() == 0, reason="root reads everything")
def test_a_score_nobody_may_read(
    short: Path, home: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    short.chmod(0)
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


def one_object(text: str) -> Mapping[str, object]:
    assert text.count("\n") == 1
    value = json.loads(text, parse_constant=lambda c: pytest.fail(f"{c} is no JSON"))
    assert isinstance(value, dict)
    return value


def test_perform_prints_one_object_and_writes_where_it_is_told(
    short: Path,
    home: Path,
    plain_report: list[object],
    capfd: pytest.CaptureFixture[str],
) -> None:
    assert _run(["perform", str(short), "--effort", "happy", "--json", "--out", "here/there"]) == 0
    out, err = capfd.readouterr()
    assert err == ""
    figures = one_object(out)
    assert set(PHYSICAL) | {"files"} <= set(figures)
    assert figures["completed"] is True
    files = figures["files"]
    assert isinstance(files, dict)
    assert {"report", "motion", "recording"} <= set(files)
    for path in files.values():
        assert Path(path).is_file()
        assert Path(path).parent == Path("here/there")
    assert [p.name for p in home.iterdir()] == ["here"]
    assert len(plain_report) == 1


def test_a_kinematic_performance_and_a_table(
    short: Path, home: Path, plain_report: list[object], capfd: pytest.CaptureFixture[str]
) -> None:
    assert _run(["perform", str(short), "--controller", "kinematic", "--no-video"]) == 0
    out, err = capfd.readouterr()
    assert err == ""
    assert "report: short/report.html" in out
    assert "completed" in out
    assert sorted(p.name for p in (home / "short").iterdir()) == ["motion.npz", "report.html"]


def test_quiet_is_quiet(
    short: Path, home: Path, plain_report: list[object], capfd: pytest.CaptureFixture[str]
) -> None:
    assert _run(["perform", str(short), "--controller", "kinematic", "-q"]) == 0
    assert _run(["pose", "arms first", "-q"]) == 0
    assert capfd.readouterr() == ("", "")


def test_a_fall_is_answered_with_one(
    short: Path,
    home: Path,
    plain_report: list[object],
    capfd: pytest.CaptureFixture[str],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    make_limp(monkeypatch)
    assert _run(["perform", str(short), "--tempo", "20", "--json"]) == 1
    figures = one_object(capfd.readouterr().out)
    assert figures["completed"] is False
    assert isinstance(figures["fell_at"], float)
    assert Path("short/recording.npz").is_file()


def test_compare_prints_every_variant(
    short: Path, home: Path, plain_report: list[object], capfd: pytest.CaptureFixture[str]
) -> None:
    assert _run(["compare", str(short), "--effort", "happy", "--json"]) == 0
    figures = one_object(capfd.readouterr().out)
    variants = figures["variants"]
    assert isinstance(variants, dict)
    assert list(variants) == ["slerp", "logistic", "expressive", "physical"]
    assert set(PHYSICAL) <= set(variants["physical"])
    assert {"wrist_path_rms", "joint_rms_deg"} <= set(figures["differences"][0])  # type: ignore[index]
    assert Path("short-compared/report.html").is_file()


def test_pose_prints_rules(
    home: Path, plain_report: list[object], capfd: pytest.CaptureFixture[str]
) -> None:
    assert _run(["pose", "arms fifth en haut", "--json"]) == 0
    figures = one_object(capfd.readouterr().out)
    (pose,) = figures["poses"]  # type: ignore[misc]
    assert {"name", "qpos", "rules", "solve_ms"} <= set(pose)
    assert Path("arms-fifth-en-haut/report.html").is_file()


def test_the_vocabulary_can_be_listed(home: Path, capfd: pytest.CaptureFixture[str]) -> None:
    assert _run(["pose", "--list", "--json"]) == 0
    listed = one_object(capfd.readouterr().out)["names"]
    assert _run(["pose", "--list"]) == 0
    assert capfd.readouterr().out.split("\n")[:-1] == listed
    assert "third-port-de-bras" in listed  # type: ignore[operator]
    assert list(home.iterdir()) == []


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


def test_line_ends_and_a_byte_order_mark_are_no_fault(
    short: Path, home: Path, plain_report: list[object], capfd: pytest.CaptureFixture[str]
) -> None:
    short.write_bytes(b"\xef\xbb\xbf" + SHORT.replace("\n", "\r\n").encode())
    assert _run(["perform", str(short), "--controller", "kinematic", "--json"]) == 0
    assert one_object(capfd.readouterr().out)["completed"] is True


@pytest.mark.parametrize("arguments", [["--help"], ["perform", "--help"], ["pose", "--help"]])
def test_help_is_given(arguments: list[str], capfd: pytest.CaptureFixture[str]) -> None:
    assert _run(arguments) == 0
    assert "Usage" in capfd.readouterr().out


def test_without_a_verb_help_is_given_and_nothing_more(capfd: pytest.CaptureFixture[str]) -> None:
    assert _run([]) == 2
    out, err = capfd.readouterr()
    assert "Usage" in out + err
    assert "enpointe: \n" not in err


def test_our_own_faults_are_one_line_too(
    home: Path, monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]
) -> None:
    def broken(*_: object, **__: object) -> None:
        raise ZeroDivisionError("two\nlines")

    monkeypatch.delenv("ENPOINTE_DEBUG", raising=False)
    monkeypatch.setitem(vars(enpointe), "load_score", broken)
    assert _run(["perform", "x"]) == 2
    out, err = capfd.readouterr()
    assert (out, err.count("\n")) == ("", 1)
    assert "a fault of ours, ZeroDivisionError: two lines" in err
    monkeypatch.setenv("ENPOINTE_DEBUG", "1")
    with pytest.raises(ZeroDivisionError):
        _run(["perform", "x"])


def test_a_stop_is_quiet(
    home: Path, monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]
) -> None:
    def stop(*_: object, **__: object) -> None:
        raise KeyboardInterrupt

    monkeypatch.setitem(vars(enpointe), "load_score", stop)
    # 130 is what a shell says of a program that was stopped from the keyboard.
    assert _run(["perform", "x"]) in (2, 130)
    out, err = capfd.readouterr()
    assert out == ""
    assert err.count("\n") <= 1


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


def console_script() -> list[str]:
    """The installed program, or the same entry point where none is installed."""
    script = shutil.which("enpointe", path=str(Path(sys.executable).parent))
    return (
        [script]
        if script
        else [sys.executable, "-P", "-c", "from enpointe.cli import main; main()"]
    )


@pytest.mark.slow
def test_the_program_from_end_to_end(tmp_path: Path) -> None:
    """The whole way through the house, as a person goes it."""
    (tmp_path / "short.bmn").write_text(SHORT, "utf-8")
    run = subprocess.run(
        [*console_script(), "perform", "short.bmn", "--no-video", "--json"],
        cwd=tmp_path,
        capture_output=True,
        text=True,
        check=False,
    )
    # Without OpenGL one line says how the pictures were drawn instead.
    assert run.returncode == 0, run.stderr
    assert run.stderr.count("\n") <= 1
    files = one_object(run.stdout)["files"]
    assert isinstance(files, dict)
    assert {"report", "motion", "recording"} <= set(files)
    for path in files.values():
        assert (tmp_path / path).stat().st_size > 0


def test_the_program_refuses_as_the_function_does(tmp_path: Path) -> None:
    (tmp_path / "bad.bmn").write_text(written_score("feet: first; arms: first", "arms: ninth"))
    run = subprocess.run(
        [*console_script(), "perform", "bad.bmn"],
        cwd=tmp_path,
        capture_output=True,
        text=True,
        check=False,
    )
    assert run.returncode == 2
    assert run.stdout == ""
    assert run.stderr.startswith("enpointe: bad.bmn:12:9: ")
    assert run.stderr.count("\n") == 1
    assert [p.name for p in tmp_path.iterdir()] == ["bad.bmn"]
