"""`enpointe perform` on motion files: what of them is danced, what not and why."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import enpointe
from enpointe import EnpointeError
from enpointe.cli import _run
from enpointe.models import dancer_model
from enpointe.motion import Motion
from enpointe.motion.npz import save_motion

from .commands import one_object, refused

MODEL = dancer_model(flesh=False)


@pytest.fixture
def still(home: Path) -> Path:
    """Three seconds in which she bends and stretches an elbow, begun and ended under way."""
    time = np.arange(0.0, 3.0 + 0.005, 0.01)
    qpos = np.tile(MODEL.key("standing").qpos, (len(time), 1))
    qpos[:, MODEL.joint("left_elbow_bend").qposadr[0]] += 0.5 + 0.3 * np.sin(4.0 * time + 0.5)
    save_motion(Motion.from_qpos(MODEL, time, qpos), home / "still.npz")
    return home / "still.npz"


def lifted(source: Path, start: float, end: float) -> Path:
    """The same with her in the air for a time."""
    from enpointe.motion.npz import load_motion

    motion = load_motion(source, MODEL)
    qpos = motion.qpos.copy()
    qpos[(motion.time >= start) & (motion.time <= end), 2] += 0.1
    target = source.with_name("lifted.npz")
    save_motion(Motion.from_qpos(MODEL, motion.time, qpos), target)
    return target


def test_our_own_dance_performed_again_is_the_same_dance(short: Path, home: Path) -> None:
    score = enpointe.load_score(short)
    drawn = enpointe.perform(score, controller="kinematic").save(home)["motion"]
    again = enpointe.perform_file(drawn, controller="pd")
    once = enpointe.perform(score, controller="pd")
    assert again.recording is not None
    assert once.recording is not None
    np.testing.assert_array_equal(again.recording.qpos, once.recording.qpos)
    assert again.completed
    assert again.physical_figures()["lateness_max"] == once.physical_figures()["lateness_max"]


def test_a_file_under_way_is_danced_from_rest_to_rest(
    still: Path, plain_report: list[object], capfd: pytest.CaptureFixture[str]
) -> None:
    assert _run(["perform", str(still), "--controller", "pd", "--json", "--out", "out"]) == 0
    figures = one_object(capfd.readouterr().out)
    assert figures["completed"] is True
    assert figures["root_force_max"] == 0.0
    assert figures["duration"] == pytest.approx(3.0 + 2 * 1.0, abs=0.02)
    assert figures["danced"]["first_frame"] == 0
    assert figures["danced"]["last_frame"] == 300
    assert figures["not_danced"] == []
    assert {Path(p).name for p in figures["files"].values()} >= {"motion.npz", "recording.npz"}


def test_a_flight_is_left_out_and_told(
    still: Path, plain_report: list[object], capfd: pytest.CaptureFixture[str]
) -> None:
    """The answer is no, since not all of it is danced; what could be instead is offered."""
    source = lifted(still, 1.2, 1.5)
    assert _run(["perform", str(source), "--controller", "pd", "--json"]) == 1
    figures = one_object(capfd.readouterr().out)
    assert figures["completed"] is False
    assert figures["fell_at"] is None
    (flight,) = figures["not_danced"]
    assert "in the air" in flight["why"]
    assert flight["start"] == pytest.approx(1.2, abs=0.06)
    assert flight["last_frame"] == pytest.approx(150, abs=6)
    assert figures["danced"]["start"] > 1.4
    (other,) = figures["could_be_danced"]
    assert other["end"] < 1.3
    dance = plain_report[0]
    assert isinstance(dance, enpointe.FilePerformance)
    assert "The rest is not danced: in the air" in dance.verdict


def test_a_span_is_all_that_is_asked_for(still: Path) -> None:
    source = lifted(still, 1.2, 1.5)
    dance = enpointe.perform_file(source, span=(0.0, 1.0), controller="pd")
    assert dance.completed
    assert dance.obstacles == ()
    assert dance.summary()["asked"] == [0.0, 1.0]
    slow = enpointe.perform_file(source, span=(0.0, 1.0), speed=0.5, controller="kinematic")
    assert slow.motion.duration == pytest.approx(2.0)
    assert "No physics" in slow.verdict


def test_a_file_is_compared_with_its_dance(
    still: Path, plain_report: list[object], capfd: pytest.CaptureFixture[str]
) -> None:
    """The same moments of the file, drawn and danced; an arm that moves slowly is all but kept."""
    assert _run(["compare", str(still), "--span", "0", "1", "--json"]) == 0
    figures = one_object(capfd.readouterr().out)
    drawn, danced = figures["variants"]["file"], figures["variants"]["physical"]
    assert drawn["duration"] == pytest.approx(danced["duration"])
    assert drawn["controller"] == "kinematic"
    assert danced["root_force_max"] == 0.0
    (apart,) = figures["differences"]
    assert apart["between"] == ["file", "physical"]
    assert 0.0 < apart["joint_rms_deg"] < 5.0
    said = refused(capfd, "compare", str(still), "--effort", "sad")
    assert "--effort is for scores" in said
    assert "is for motion files" in refused(capfd, "compare", "first-port-de-bras", "--speed", "2")


def test_the_report_of_a_compared_file_has_the_differences(still: Path, home: Path) -> None:
    files = enpointe.write_report(
        enpointe.compare_file(still, span=(0.0, 1.0)), home / "out", video=False
    )
    page = files["report"].read_text()
    assert "The file and the dance" in page
    assert "file and physical" in page


def test_a_file_of_flight_alone_is_refused(still: Path, capfd: pytest.CaptureFixture[str]) -> None:
    source = lifted(still, 0.0, 3.0)
    assert "in the air" in refused(capfd, "perform", str(source), "--out", "out")
    assert not Path("out").exists()


@pytest.mark.parametrize(
    ("options", "said"),
    [
        (["--tempo", "60"], "--tempo is for scores"),
        (["--effort", "sad"], "--effort is for scores"),
        (["--hold", "3"], "--hold is for scores"),
        (["--span", "2", "1"], "from one second to a later one"),
        (["--span", "nan", "1"], "from one second to a later one"),
        (["--span", "1", "9"], "is 3.00 s long"),
        (["--speed", "0"], "a speed of 0"),
        (["--map", "joints.toml"], "the dancer's own motion"),
    ],
)
def test_what_a_file_can_not_have_is_refused(
    still: Path, options: list[str], said: str, capfd: pytest.CaptureFixture[str]
) -> None:
    assert said in refused(capfd, "perform", str(still), *options, "--out", "out")
    assert not Path("out").exists()


@pytest.mark.parametrize("option", [["--span", "0", "1"], ["--speed", "2"], ["--map", "a.toml"]])
def test_what_a_score_can_not_have_is_refused(
    home: Path, option: list[str], capfd: pytest.CaptureFixture[str]
) -> None:
    assert "is for motion files" in refused(capfd, "perform", "first-port-de-bras", *option)


def test_a_damaged_file_is_refused_as_a_motion(
    home: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    (home / "bad.bvh").write_text("HIERARCHY\nROOT hips\n{\n")
    assert "bad.bvh" in refused(capfd, "perform", "bad.bvh")
    with pytest.raises(EnpointeError, match="perform_file"):
        enpointe.perform(home / "bad.bvh")
    assert [p.name for p in home.iterdir()] == ["bad.bvh"]


def made_to_fall(
    monkeypatch: pytest.MonkeyPatch, falls: Callable[[int, Motion], float | None]
) -> list[Motion]:
    """Files are taken as captures, and she falls as often as is said; what she tried."""
    from enpointe import captured, danced, performing_file

    def as_capture(path: Path, **_: object) -> captured.Captured:
        return replace(captured.read_captured(path), stored=False)

    tried: list[Motion] = []

    def run(motion: Motion, *given: object) -> danced.Physics:
        tried.append(motion)
        physics = danced.run_physics(motion, "pd")
        fell = falls(len(tried), motion)
        return replace(physics, measures=replace(physics.measures, fell_at=fell))

    monkeypatch.setattr(performing_file, "read_captured", as_capture)
    monkeypatch.setattr(performing_file, "run_physics", run)
    return tried


@pytest.mark.slow
def test_a_fall_is_told_and_danced_without(still: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """She is made to fall once: 2.7 s after the start are 1.7 s of the file."""
    tried = made_to_fall(monkeypatch, lambda count, _: 2.7 if count == 1 else None)
    dance = enpointe.perform_file(still, controller="pd")
    assert len(tried) == 2
    assert dance.stood
    assert not dance.completed
    (fall,) = dance.obstacles
    assert fall.start == pytest.approx(1.2, abs=0.02)
    assert fall.end == pytest.approx(2.2, abs=0.02)
    assert dance.stretch.end <= fall.start
    assert dance.others[0].start >= fall.end
    assert "The rest is not danced: she falls there" in dance.verdict


@pytest.mark.slow
def test_after_the_last_fall_only_what_was_danced_is_danced_again(
    home: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Made to fall early each time, she tries what comes after; at last, what she danced before."""
    time = np.arange(0.0, 14.005, 0.02)
    qpos = np.tile(MODEL.key("standing").qpos, (len(time), 1))
    qpos[:, MODEL.joint("left_elbow_bend").qposadr[0]] += 0.5 + 0.3 * np.sin(4.0 * time + 0.5)
    save_motion(Motion.from_qpos(MODEL, time, qpos), home / "long.npz")
    tried = made_to_fall(
        monkeypatch, lambda count, motion: 0.2 * motion.duration if count < 5 else None
    )
    dance = enpointe.perform_file(home / "long.npz", controller="pd")
    assert len(tried) == 5
    assert dance.stood
    ends = [each.start for each in dance.obstacles]
    assert any(dance.stretch.end == pytest.approx(end, abs=0.03) for end in ends)
    assert dance.stretch.length < max(each.length for each in dance.others)
    assert "she falls there" in dance.verdict


@pytest.mark.slow
def test_a_dancer_stands_on_one_leg_as_she_was_captured(data_dir: Path) -> None:
    """CMU's 05_12 from 4 to 6 s: on the right leg alone."""
    take = data_dir / "cmu_05" / "05_12.amc"
    dance = enpointe.perform_file(take, span=(4.0, 6.0))
    figures = dance.summary()
    assert dance.completed
    assert figures["root_force_max"] == 0.0
    assert figures["tracking_rms_deg"] < 3.0
    assert figures["slip_max"] < 0.01
    assert figures["contacts_missed"] == []
    assert figures["danced"]["first_frame"] == 1 + round(4.0 * 120)
