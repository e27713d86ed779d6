"""`enpointe check`: files and scores in, figures and an answer out."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import enpointe
from enpointe.cli import _run
from enpointe.motion import Motion
from enpointe.motion.formats import SkeletonMotion, read, write
from enpointe.motion.npz import save_motion
from enpointe.report.checks import check_page
from enpointe.sim.impossible import Help

from .commands import one_object, refused

FIELDS = {
    "support_margin_min",
    "zmp_outside_fraction",
    "contacts",
    "slip_max",
    "penetration_max",
    "flights",
    "turns",
    "joint_limit_violations",
    "root_wrench_rms",
    "impossible",
    "ballistics",
}


def test_a_score_a_motion_and_a_recording_of_it_are_sound(
    short: Path, home: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    dance = enpointe.perform(enpointe.load_score(short))
    files = dance.save(home)
    for source in (short, files["motion"], files["recording"]):
        assert _run(["check", str(source), "--out", "looked", "--json"]) == 0
        figures = one_object(capfd.readouterr().out)
        assert set(figures) >= FIELDS
        assert figures["faults"] == []
        assert figures["joint_limit_violations"] == []
        assert figures["slip_max"] < 0.005
        assert figures["impossible"] == []
    assert [p.name for p in (home / "looked").iterdir()] == ["report.html"]


def test_the_answer_does_not_contradict_the_moments_under_it(short: Path, home: Path) -> None:
    """Without a fault, moments in which something is missing are told in the answer."""
    looked = enpointe.check(enpointe.load_score(short))
    assert looked.answer == "a body could do this"
    assert "the floor under" in check_page(looked).verdict
    assert "Where it is impossible" not in titles(looked)
    jolts = (Help(0.5, 0.5, 100.0, "too sudden"), Help(1.0, 1.0, 90.0, "too sudden"))
    jolted = replace(looked, found=replace(looked.found, help=jolts))
    assert jolted.faults == ()
    assert "but for 2 moments" in jolted.answer
    assert "the floor under" not in check_page(jolted).verdict
    assert "What to soften" in titles(jolted)
    sinking = replace(jolted, found=replace(jolted.found, penetration_max=0.1))
    assert sinking.answer.startswith("no body could do this")
    assert "Where it is impossible" in titles(sinking)


def titles(looked: enpointe.Check) -> list[str]:
    return [section.title for section in check_page(looked).sections]


def test_a_movement_nobody_can_do_is_answered_with_no(
    short: Path, home: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    motion = enpointe.perform(enpointe.load_score(short), controller="kinematic").motion
    lifted = motion.qpos + np.eye(motion.model.nq)[2]
    save_motion(Motion.from_qpos(motion.model, motion.time, lifted), home / "lifted.npz")
    assert _run(["check", "lifted.npz"]) == 1
    out, err = capfd.readouterr()
    assert err == ""
    assert "invisible help" in out
    assert "in the air, and not falling as bodies fall" in " ".join(out.split())
    assert "never on the floor" in out


def test_what_is_no_motion_is_refused(home: Path, capfd: pytest.CaptureFixture[str]) -> None:
    assert "no such file" in refused(capfd, "check", "nothing.npz")
    np.savez(home / "other.npz", format=np.array("a diary"))
    assert "expected" in refused(capfd, "check", "other.npz")
    (home / "text.npz").write_text("hello")
    assert "no motion file that is known" in refused(capfd, "check", "text.npz")


def test_an_amc_is_checked_with_a_skeleton_from_elsewhere(
    data_dir: Path, home: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    take = data_dir / "cmu_05" / "05_14.amc"
    if not take.exists():
        pytest.skip("no data here")
    (home / "alone.amc").write_text(take.read_text().partition("\n61\n")[0] + "\n")
    assert "asf" in refused(capfd, "check", "alone.amc").lower()
    skeleton = str(data_dir / "cmu_05" / "05.asf")
    assert _run(["check", "alone.amc", "--skeleton", skeleton, "--json"]) in (0, 1)
    assert one_object(capfd.readouterr().out)["duration"] == pytest.approx(59 / 120)
    said = refused(capfd, "check", "first-port-de-bras", "--skeleton", skeleton)
    assert "no map or skeleton applies" in said


@pytest.mark.parametrize(
    ("take", "frames"), [("05_14", (230, 360)), ("05_11", (160, 280)), ("05_16", (180, 290))]
)
def test_a_capture_is_corrected(
    take: str,
    frames: tuple[int, int],
    data_dir: Path,
    home: Path,
    capfd: pytest.CaptureFixture[str],
) -> None:
    """At its own rate, frame for frame."""
    source = data_dir / "cmu_05" / f"{take}.amc"
    if not source.exists():
        pytest.skip("no data here")
    captured = read(source).motion
    assert isinstance(captured, SkeletonMotion)
    values = captured.values[slice(*frames, 4)]
    write(replace(captured, values=values, rate=captured.rate / 4), home / "piece.bvh")
    assert _run(["check", "piece.bvh", "--out", "looked", "--correct", "--json"]) in (0, 1)
    figures = one_object(capfd.readouterr().out)
    corrected = read(home / "looked" / "corrected.bvh").motion
    assert isinstance(corrected, SkeletonMotion)
    assert corrected.frames == len(values)
    assert corrected.rate == pytest.approx(captured.rate / 4, rel=1e-4)
    assert np.isfinite(corrected.values).all()
    assert {slide["foot"] for slide in figures["slides"]} == {"left", "right"}
