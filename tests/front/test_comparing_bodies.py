"""`enpointe compare --rig`: the dancer, what a rig was asked, and what it danced."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest

import enpointe
from enpointe import EnpointeError
from enpointe.cli import _run
from enpointe.comparing_bodies import DANCER, BodyComparison, compare_bodies
from enpointe.models import dancer_model
from enpointe.models.puppet import op3_model
from enpointe.motion import Event, Motion
from enpointe.motion.npz import save_motion

from .commands import one_object, refused

ASKED, DANCED = "op3, asked", "op3, danced"


def wave(path: Path, body: str = "dancer", *, beats: tuple[float, ...] = (0.1, 0.9)) -> Path:
    """A second of the right arm, from the elbow."""
    model = dancer_model(flesh=False) if body == "dancer" else op3_model()
    time = np.arange(0.0, 1.005, 0.01)
    qpos = np.tile(model.key("standing").qpos, (len(time), 1))
    joint = "right_elbow_bend" if body == "dancer" else "r_el"
    qpos[:, model.joint(joint).qposadr[0]] += 0.3 * (1.0 - np.cos(2.0 * np.pi * time))
    events = [Event(t, "key pose", f"beat {i}", float(i)) for i, t in enumerate(beats)]
    save_motion(Motion.from_qpos(model, time, qpos, events=events, name="wave"), path)
    return path


@pytest.fixture(scope="module")
def source(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return wave(tmp_path_factory.mktemp("wave") / "wave.npz")


@pytest.fixture(scope="module")
def shown(source: Path) -> BodyComparison:
    return compare_bodies(source, rig="op3", port="memory")


def test_the_dancer_is_shown_at_the_clock_of_the_rig(shown: BodyComparison) -> None:
    assert list(shown.motions) == [DANCER, ASKED, DANCED]
    assert shown.dancer is not None
    assert shown.time_scale is not None
    here = [event.time for event in shown.dancer.key_events]
    assert here == pytest.approx([event.time for event in shown.asked.key_events])
    assert here[-1] - here[0] == pytest.approx(0.8 * shown.time_scale)


def test_figures_tell_of_every_two_bodies(shown: BodyComparison) -> None:
    figures = shown.summary()
    assert figures["completed"] is True
    assert figures["servos"] is not None
    assert set(figures["bodies"]) == set(shown.motions)
    apart = {tuple(each["between"]): each for each in figures["differences"]}
    assert apart[DANCER, ASKED]["joint_rms_deg"] is None
    own = apart[ASKED, DANCED]["joint_rms_deg"]
    assert own is not None
    assert own == pytest.approx(figures["servos"]["tracking_rms_deg"], rel=0.1)
    reach = apart[ASKED, DANCED]["reach_rms"]
    assert reach is not None
    assert 0.0 < reach < 0.05


def test_its_figures_are_those_that_are_documented(shown: BodyComparison, root_dir: Path) -> None:
    text = (root_dir / "docs" / "figures.md").read_text(encoding="utf-8")
    table = text.split("<!-- fields: bodies -->\n\n", 1)[1].split("\n\n", 1)[0]
    assert set(re.findall(r"^\| `(\w+)` \|", table, flags=re.MULTILINE)) == set(shown.summary())


def test_a_recording_is_set_beside_the_dancer_and_nothing_is_danced(
    shown: BodyComparison, source: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    assert shown.performance is not None
    files = shown.performance.save(tmp_path)
    monkeypatch.setattr("enpointe.comparing_bodies.servo", lambda *_, **__: pytest.fail("danced"))
    again = compare_bodies(source, rig="op3", recording=files["recording"])
    assert again.performance is None
    assert again.completed
    assert again.gestures == shown.gestures
    assert again.summary()["servos"] is None


def test_a_recording_of_another_dance_is_refused(
    shown: BodyComparison, tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    assert shown.performance is not None
    recording = shown.performance.save(tmp_path)["recording"]
    other = wave(tmp_path / "other.npz", beats=(0.1, 0.4, 0.9))
    words = ["compare", str(other), "--rig", "op3", "--recording", str(recording)]
    assert "no dance of wave" in refused(capfd, *words)


def test_a_movement_of_the_rigs_own_has_no_dancer(tmp_path: Path) -> None:
    own = compare_bodies(wave(tmp_path / "own.npz", "op3"), rig="op3", port="memory")
    assert list(own.motions) == [ASKED, DANCED]
    assert own.time_scale is None


def test_the_command_writes_its_report(
    source: Path,
    home: Path,
    plain_report: list[object],
    capfd: pytest.CaptureFixture[str],
) -> None:
    words = ["compare", str(source), "--rig", "op3", "--port", "memory", "--no-video", "--json"]
    assert _run(words) == 0
    figures = one_object(capfd.readouterr().out)
    assert isinstance(plain_report[0], BodyComparison)
    assert figures["rig"] == "op3"
    assert Path(figures["files"]["report"]).is_file()


@pytest.mark.parametrize(
    ("options", "told"),
    [
        (("--port", "memory"), "--port is for a rig"),
        (("--free",), "--free is for a rig"),
        (("--recording", "r.npz"), "--recording is for a rig"),
        (("--rig", "op3", "--span", "0", "1"), "--span is for motion files"),
        (("--rig", "op3", "--recording", "r.npz", "--free"), "already danced"),
        (("--rig", "op3", "--recording", "r.npz"), "r.npz"),
        (("--rig", "op3", "--port", "memory", "--backlash", "0.3"), "gears have play"),
        (("--rig", "nobody"), "no rig 'nobody'"),
        (("--rig", "op3", "--tempo", "60"), "tempo is for scores"),
    ],
)
def test_what_does_not_go_together_is_refused_in_a_line(
    source: Path, options: tuple[str, ...], told: str, capfd: pytest.CaptureFixture[str]
) -> None:
    assert told in refused(capfd, "compare", str(source), *options)


def test_it_is_there_for_the_public() -> None:
    assert enpointe.compare_bodies is compare_bodies
    with pytest.raises(EnpointeError):
        enpointe.compare_bodies("no-such-score", rig="op3")
