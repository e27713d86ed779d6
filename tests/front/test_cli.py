"""The command line: its figures, its files and its exit codes."""

from __future__ import annotations

import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

import enpointe
from enpointe.cli import _run

from ..motion.dancing import written_score
from .commands import ALOFT, SHORT, one_object
from .test_perform import PHYSICAL, make_limp


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
    assert re.search(r"rules +\d+ of \d+ held throughout", out)
    assert not set("{[") & set(out)
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
    assert {"wrist_path_rms", "joint_rms_deg"} <= set(figures["differences"][0])
    assert Path("short-compared/report.html").is_file()


def test_pose_prints_rules(
    home: Path, plain_report: list[object], capfd: pytest.CaptureFixture[str]
) -> None:
    assert _run(["pose", "arms fifth en haut", "--json"]) == 0
    figures = one_object(capfd.readouterr().out)
    (pose,) = figures["poses"]
    assert {"name", "qpos", "rules", "cheats", "solve_ms"} <= set(pose)
    assert pose["cheats"] == []
    assert Path("arms-fifth-en-haut/report.html").is_file()


def test_a_real_dancer_s_cheats_are_listed(
    home: Path, plain_report: list[object], capfd: pytest.CaptureFixture[str]
) -> None:
    name = "leg arabesque derrière 90"
    assert _run(["pose", name, "--dancer", "real", "--json"]) == 0
    (pose,) = one_object(capfd.readouterr().out)["poses"]
    greatest = pose["cheats"][0]
    assert greatest["name"] == "pelvis tipped forward"
    assert greatest["unit"] == "deg"
    assert _run(["pose", name, "--dancer", "real"]) == 0
    text = " ".join(capfd.readouterr().out.split())
    assert f"cheats: pelvis tipped forward {greatest['value']:.0f} deg" in text
    assert f"all {len(pose['rules'])} rules held" in text
    for rule in pose["rules"]:
        assert rule["rule"] in text


def test_a_broken_rule_is_printed_with_how_much(
    home: Path, tmp_path: Path, plain_report: list[object], capfd: pytest.CaptureFixture[str]
) -> None:
    score = tmp_path / "deep.bmn"
    header = "benesh 1\ntitle: Deep\nmethod: Cecchetti\nmetre: 4/4\ntempo: 60\n"
    score.write_text(header + "beat 0:\n  feet: second, grand plié\n  arms: first\n", "utf-8")
    assert _run(["pose", str(score)]) == 1
    text = " ".join(capfd.readouterr().out.split())
    assert re.search(r"weight in the middle: broken, [45]\d\.\d mm \(at most 20\)", text)
    assert re.search(r"3\d of 37 rules held", text)


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


def test_the_vocabulary_can_be_listed(home: Path, capfd: pytest.CaptureFixture[str]) -> None:
    assert _run(["pose", "--list", "--json"]) == 0
    listed = one_object(capfd.readouterr().out)["names"]
    assert _run(["pose", "--list"]) == 0
    assert capfd.readouterr().out.split("\n")[:-1] == listed
    assert "third-port-de-bras" in listed
    assert list(home.iterdir()) == []


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


def test_it_runs_as_a_module_too(tmp_path: Path) -> None:
    """Where the command's folder is not on the path, `python -m enpointe` does the same."""
    said = subprocess.run(
        [sys.executable, "-m", "enpointe", "--help"],
        cwd=tmp_path,
        capture_output=True,
        text=True,
        check=True,
    )
    assert "perform" in said.stdout


@pytest.mark.slow
def test_a_position_is_held_by_its_name(home: Path, capfd: pytest.CaptureFixture[str]) -> None:
    arguments = ["perform", "pose first arabesque", "--controller", "wholebody", "--hold", "1"]
    assert _run([*arguments, "--no-video", "--json", "--out", "held"]) == 0
    figures = one_object(capfd.readouterr().out)
    assert figures["completed"] is True
    assert (home / "held" / "balance.csv").exists()


def test_the_command_line_starts_without_what_it_may_not_need(tmp_path: Path) -> None:
    heavy = ("numpy", "mujoco", "casadi", "matplotlib", "enpointe.servoing")
    code = f"import sys, enpointe.cli; print([m for m in {heavy} if m in sys.modules])"
    done = subprocess.run(
        [sys.executable, "-c", code],
        cwd=tmp_path,
        capture_output=True,
        text=True,
        check=True,
        timeout=60,
    )
    assert done.stdout.strip() == "[]"
