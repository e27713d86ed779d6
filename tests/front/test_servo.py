"""`enpointe servo`, `calibrate` and `doctor --port` from the front."""

from __future__ import annotations

import json
import os
import re
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from enpointe.cli import _run
from enpointe.errors import RigError
from enpointe.hardware.dynamixel import description_of
from enpointe.hardware.emulator import Fault, FaultKind, launch
from enpointe.hardware.rig_file import Rig, load_rig
from enpointe.models.puppet import op3_model
from enpointe.motion import Motion
from enpointe.motion.npz import save_motion
from enpointe.servoing import ServoPerformance, servo

from .commands import one_object, refused


@pytest.fixture(scope="module")
def wave(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Half a second of OP3's right arm."""
    model = op3_model()
    time = np.arange(0.0, 0.505, 0.01)
    qpos = np.tile(model.key("standing").qpos, (len(time), 1))
    qpos[:, int(model.joint("r_el").qposadr[0])] = 0.3 * np.sin(3.0 * time)
    path = tmp_path_factory.mktemp("motion") / "wave.npz"
    save_motion(Motion.from_qpos(model, time, qpos, name="wave"), path)
    return path


def op3() -> Rig:
    """Slower than it is, which leaves the machine time."""
    return load_rig("op3").at(rate=50.0)


@pytest.fixture(scope="module")
def danced(wave: Path) -> ServoPerformance:
    return servo(wave, rig=op3(), port="memory")


def test_a_dance_in_memory_follows_and_ends_parked(danced: ServoPerformance) -> None:
    figures = danced.summary()
    assert danced.completed
    assert figures["feasible"] is True
    assert figures["time_scale"] == 1.0
    assert figures["achieved_hz"] == pytest.approx(50.0)
    assert figures["deadline_misses"] == 0
    assert figures["tracking_rms_deg"] < 1.0
    assert set(figures["tracking_rms_deg_by_joint"]) == set(danced.rig.joints)
    assert figures["tracking_rms_deg_by_joint"]["r_el"] > 0.0


def test_its_figures_are_those_that_are_documented(
    danced: ServoPerformance, root_dir: Path
) -> None:
    text = (root_dir / "docs" / "figures.md").read_text(encoding="utf-8")
    table = text.split("<!-- fields: servo -->\n\n", 1)[1].split("\n\n", 1)[0]
    assert set(re.findall(r"^\| `(\w+)` \|", table, flags=re.MULTILINE)) == set(danced.summary())


def test_two_dances_in_memory_are_the_same_bit_for_bit(
    danced: ServoPerformance, wave: Path
) -> None:
    again = servo(wave, rig=op3(), port="memory")
    for name in ("time", "qpos", "qvel", "effort", "position", "age", "valid"):
        one, other = getattr(danced.recording, name), getattr(again.recording, name)
        assert one.tobytes() == other.tobytes(), name
    for name, values in danced.recording.channels.items():
        assert values.tobytes() == again.recording.channels[name].tobytes(), name


def test_a_dance_that_ended_at_once_has_no_effort_to_tell_of(danced: ServoPerformance) -> None:
    first = replace(danced.recording, time=danced.recording.time[:1], fault="servo 5 is silent")
    ended = replace(danced, recording=first)
    assert ended.timing is None
    assert not ended.completed


def test_a_recording_is_danced_again(danced: ServoPerformance, tmp_path: Path) -> None:
    files = danced.save(tmp_path)
    again = servo(files["recording"], rig=op3(), port="memory", as_written=True)
    assert again.completed
    assert again.motion.duration == pytest.approx(danced.recording.time[-1], abs=0.03)


def test_a_fault_is_told_and_the_recording_is_whole_up_to_it(wave: Path) -> None:
    gone = Fault(FaultKind.MISSING, (5,), at=(2.4, 2.4))
    danced = servo(wave, rig=op3(), port="memory", faults=[gone])
    assert not danced.completed
    assert "r_el" in danced.statistics.faults[0]
    assert danced.recording.fault == danced.statistics.faults[0]
    assert len(danced.recording.time) > 5
    assert np.all(np.diff(danced.recording.time) > 0.0)
    assert not danced.recording.valid[-1].all()


def test_the_command_prints_its_figures_and_writes_its_files(
    wave: Path, tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    words = ["servo", str(wave), "--rig", "op3", "--port", "memory", "--rate", "50"]
    assert _run([*words, "--out", str(tmp_path), "--json"]) == 0
    figures = one_object(capfd.readouterr().out)
    assert figures["completed"] is True
    assert {Path(path).name for path in figures["files"].values()} == {
        "feasibility.html",
        "motion.npz",
        "recording.npz",
    }
    assert all(Path(path).is_file() for path in figures["files"].values())


def test_a_dry_run_says_whether_and_dances_nothing(
    wave: Path, tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    words = ["servo", str(wave), "--rig", "op3", "--dry-run", "--out", str(tmp_path), "--json"]
    assert _run(words) == 0
    assert one_object(capfd.readouterr().out)["feasible"] is True
    assert [path.name for path in tmp_path.iterdir()] == ["feasibility.html"]


@pytest.mark.parametrize(
    ("arguments", "told"),
    [
        (("--rig", "nobody"), "no rig 'nobody'"),
        (("--rig", "op3", "--port", "/dev/nothing-here"), "no such port"),
        (("--rig", "op3", "--baud", "12"), "baud"),
        (("--rig", "op3", "--rate", "0"), "rate"),
    ],
)
def test_what_cannot_be_is_refused_in_a_line(
    wave: Path, arguments: tuple[str, ...], told: str, capfd: pytest.CaptureFixture[str]
) -> None:
    assert told in refused(capfd, "servo", str(wave), "--as-written", *arguments)


@pytest.mark.parametrize("words", [("servo", "wave", "--as-written"), ("doctor",)])
def test_a_port_that_another_program_has_is_refused_with_its_name(
    words: tuple[str, ...], wave: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    if not Path("/proc/self/fd").is_dir():
        pytest.skip("only Linux lists who has a port open")
    ours, theirs = os.openpty()
    port = os.ttyname(theirs)
    holds = "import os, sys; os.open(sys.argv[1], os.O_RDWR); print(1, flush=True); input()"
    arguments = [str(wave) if word == "wave" else word for word in words]
    command = [sys.executable, "-c", holds, port]
    with subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE) as program:
        assert program.stdout is not None
        program.stdout.readline()
        line = refused(capfd, *arguments, "--rig", "op3", "--port", port)
        program.communicate(b"\n")
    for end in (ours, theirs):
        os.close(end)
    assert f"(process {program.pid}) has {port} open" in line


def test_a_folder_that_cannot_be_is_known_before_the_dance(
    wave: Path, capfd: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("enpointe.servoing.servo", lambda *_, **__: pytest.fail("danced"))
    words = ["servo", str(wave), "--rig", "op3", "--port", "memory", "--out", str(wave / "out")]
    assert "is a file where a folder should be" in refused(capfd, *words)


def test_calibrate_wants_a_file_or_set_up(capfd: pytest.CaptureFixture[str]) -> None:
    assert "--out" in refused(capfd, "calibrate", "--port", "/dev/null")


@pytest.mark.slow
def test_a_dance_through_a_pseudo_terminal(tmp_path: Path, wave: Path) -> None:
    """In real time, with bus and loop in processes of their own; a busy machine may spoil one."""
    pytest.importorskip("pty", reason="no pseudo-terminals here")
    told = []
    for _ in range(6):
        try:
            danced = servo(wave, rig=op3().at(rate=20.0), port="emulated", as_written=True)
        except Exception as error:
            told.append(str(error))
            continue
        assert danced.statistics.ending.value != "running"
        if danced.completed:
            assert danced.summary()["achieved_hz"] == pytest.approx(20.0, rel=0.2)
            assert danced.summary()["tracking_rms_deg"] < 3.0
            return
        told += danced.statistics.faults
    pytest.fail("; ".join(told))


@pytest.mark.slow
def test_the_doctor_looks_at_a_rig_on_a_port(capfd: pytest.CaptureFixture[str]) -> None:
    pytest.importorskip("pty", reason="no pseudo-terminals here")
    with launch(description_of(load_rig("op3"))) as port:
        # A busy machine keeps servos from answering in time: each of them may be a finding then.
        code = _run(["doctor", "--rig", "op3", "--port", port, "--json"])
        findings = json.loads(capfd.readouterr().out)["rig"]
        assert code == int(bool(findings))
        assert _run(["doctor", "--rig", "puppet", "--port", port, "--json"]) == 1
        lines = json.loads(capfd.readouterr().out)["rig"]
    assert any("servo 21" in line or "no answer" in line for line in lines)


def test_gears_have_play_only_where_a_body_hangs_on_them() -> None:
    with pytest.raises(RigError, match="simulated"):
        servo("third-port-de-bras", port="memory", backlash=0.25)
    for backlash in (-0.1, 7.0, float("nan")):
        with pytest.raises(RigError, match="backlash"):
            servo("third-port-de-bras", port="simulated", backlash=backlash)
