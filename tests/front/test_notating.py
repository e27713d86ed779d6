"""`enpointe notate`, and naming a pose from a file, at the command line."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

import enpointe
from enpointe.cli import _run
from enpointe.models import dancer_model
from enpointe.motion.npz import save_motion
from enpointe.notation import load_score, stave_svg

from ..motion.dancing import motion, solved


@pytest.fixture(scope="module")
def danced(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("danced") / "bras.npz"
    save_motion(motion("first-port-de-bras", "natural"), path)
    return path


def test_notate_writes_a_score_and_its_stave(
    danced: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert _run(["notate", str(danced), "--out", str(tmp_path), "--json", "--metre", "3/4"]) == 0
    figures = json.loads(capsys.readouterr().out)
    assert [frame["beat"] for frame in figures["frames"]] == [0, 1, 2, 3]
    assert "arms à la seconde" in figures["frames"][2]["name"]
    assert figures["frames"][2]["signs"]["left hand"]["depth"] == "front"
    assert figures["tempo_estimated"] is True
    score = load_score(figures["files"]["score"])
    assert score.metre == (3, 4)
    assert Path(figures["files"]["stave"]).read_text() == stave_svg(score)


def test_the_public_function_says_the_same(danced: Path) -> None:
    score = enpointe.notate(danced).score
    assert [frame.arms and frame.arms.name for frame in score.frames] == [
        "fifth en bas",
        "fifth en avant",
        "à la seconde",
        "fifth en bas",
    ]


@pytest.mark.parametrize("metre", ["4", "0/4", "4/3", "x/y"])
def test_a_metre_that_is_none_is_refused(
    metre: str, danced: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert _run(["notate", str(danced), "--metre", metre]) == 2
    assert "metre" in capsys.readouterr().err


def test_a_moment_of_a_motion_is_named(danced: Path, capsys: pytest.CaptureFixture[str]) -> None:
    at = motion("first-port-de-bras", "natural").key_events[2].time
    assert _run(["pose", f"{danced}@{at + 0.02:.2f}", "--json"]) == 0
    (pose,) = json.loads(capsys.readouterr().out)["poses"]
    assert pose["recognised_as"] == "feet fifth right front, arms à la seconde"
    assert pose["parts"][0]["alternatives"]


def test_a_pose_without_a_name_is_an_answer_of_no(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    model = dancer_model(flesh=False)
    qpos = np.array(model.key("standing").qpos)
    qpos[model.joint("left_elbow_bend").qposadr[0]] = 2.0
    np.save(tmp_path / "odd.npy", qpos)
    assert _run(["pose", str(tmp_path / "odd.npy")]) == 1
    assert "nearest to" in capsys.readouterr().out


def test_a_solved_pose_says_what_it_is_recognised_as() -> None:
    poses = enpointe.pose("arms fourth en haut")
    (figures,) = poses.summary()["poses"]
    assert figures["recognised_as"] == "feet first, arms fourth en haut right leads"
    assert enpointe.recognise(poses.key_poses[0].qpos).named


@pytest.mark.parametrize("bad", ["{}@-1", "{}@1e9", "{}@noon", "missing.npz@0", "missing.npy"])
def test_what_cannot_be_read_is_one_line(
    bad: str, danced: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert _run(["pose", bad.format(danced)]) == 2
    error = capsys.readouterr().err
    assert error.startswith("enpointe: ")
    assert error.count("\n") == 1


def test_a_configuration_of_another_body_is_refused(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    np.save(tmp_path / "short.npy", solved("first-port-de-bras").key_poses[0].qpos[:7])
    assert _run(["pose", str(tmp_path / "short.npy")]) == 2
    assert "shape" in capsys.readouterr().err
