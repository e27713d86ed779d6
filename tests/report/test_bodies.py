"""One dance on several bodies, side by side."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from enpointe.comparing_bodies import BodyComparison
from enpointe.hardware.rig_file import load_rig
from enpointe.models.dancer import dancer_model
from enpointe.models.puppet import puppet_model
from enpointe.motion import Event, Motion
from enpointe.report import write_report
from enpointe.report.tracking import worst_joints

from .pages import read, words_of

TIME = np.arange(0.0, 0.41, 0.02)
EVENTS = [Event(0.0, "key pose", "down", 0.0), Event(TIME[-1], "key pose", "up", 1.0)]


def arm(of: str, joint: str, late: float = 0.0) -> Motion:
    model = dancer_model(flesh=False) if of == "dancer" else puppet_model()
    qpos = np.tile(model.key("standing").qpos, (len(TIME), 1))
    share = np.clip((TIME - late) / TIME[-1], 0.0, 1.0)
    qpos[:, model.joint(joint).qposadr[0]] += 1.2 * share**2
    return Motion.from_qpos(model, TIME, qpos, events=EVENTS, name="arm")


def compared(fault: str | None = None, time_scale: float | None = 1.0) -> BodyComparison:
    asked = arm("puppet", "left_shoulder_raise")
    danced = arm("puppet", "left_shoulder_raise", late=0.05)
    dancer = None if time_scale is None else arm("dancer", "left_shoulder_raise")
    return BodyComparison(load_rig("puppet"), dancer, time_scale, asked, danced, fault, None)


def test_dancer_rig_as_asked_and_rig_as_danced_stand_side_by_side(tmp_path: Path) -> None:
    files = write_report(compared(), tmp_path)
    page = words_of(read(files["report"]))
    assert files["video"].stat().st_size > 1000
    for name in ("dancer and puppet, asked", "puppet, asked and puppet, danced"):
        assert name in page
    joints = page[page.index("puppet as danced beside as asked") :]
    assert joints.index("left_shoulder_raise") < joints.index("waist_turn")
    assert "to the end" in page
    assert "in the dancer's time" in page


@pytest.mark.parametrize(
    ("fault", "time_scale", "told"),
    [
        (None, 2.5, "in 2.500 times the dancer's time"),
        ("servo 3 is silent", 1.0, "stopped before the end: servo 3 is silent"),
    ],
)
def test_the_first_line_says_what_a_viewer_must_know(
    fault: str | None, time_scale: float, told: str, tmp_path: Path
) -> None:
    shown = compared(fault, time_scale)
    files = write_report(shown, tmp_path, video=False)
    assert "video" not in files
    assert told in words_of(read(files["report"]))
    assert shown.completed is (shown.fault is None)


def test_a_movement_of_the_rigs_own_stands_without_a_dancer(tmp_path: Path) -> None:
    shown = compared(time_scale=None)
    assert list(shown.motions) == ["puppet, asked", "puppet, danced"]
    assert "dancer and" not in words_of(read(write_report(shown, tmp_path, video=False)["report"]))


def test_the_joint_that_was_late_is_the_worst_by_what_it_was_late() -> None:
    worst, *others = worst_joints(compared())
    asked, danced = (np.clip((TIME - late) / TIME[-1], 0.0, 1.0) ** 2 for late in (0.0, 0.05))
    apart = np.degrees(1.2 * (asked - danced))
    assert worst.joint == "left_shoulder_raise"
    assert worst.most == pytest.approx(apart.max())
    assert worst.rms == pytest.approx(np.sqrt(np.mean(apart**2)))
    assert all(each.most == 0.0 for each in others)
