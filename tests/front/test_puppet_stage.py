"""The puppet dances by herself: emulated servos through the SDK, gravity and a floor."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from enpointe.hardware.rig_file import load_rig
from enpointe.models.puppet import puppet_model
from enpointe.motion import Motion
from enpointe.motion.npz import load_motion, save_motion
from enpointe.puppet_stage import SETTLE, dance_on_stage
from enpointe.servoing import ServoPerformance, servo


@pytest.mark.slow
def test_she_stands_and_moves_her_arms_by_herself() -> None:
    """No force on the root, no fall, feet where they were, arms where they were asked to be."""
    model = puppet_model()
    time = np.arange(0.0, 1.0, 0.01)
    qpos = np.tile(model.key("standing").qpos, (len(time), 1))
    share = 0.5 - 0.5 * np.cos(np.pi * time / time[-1])
    for side in ("left", "right"):
        qpos[:, model.joint(f"{side}_shoulder_raise").qposadr[0]] = 0.3 + 0.6 * share
    danced = dance_on_stage(Motion.from_qpos(model, time, qpos), load_rig("puppet"))
    assert danced.fell is None
    assert danced.recording.fault is None
    assert danced.stage["time"][-1] > SETTLE + 0.9
    assert np.all(danced.stage["root_force"] == 0.0)
    error = np.degrees(danced.tracking_error)
    assert np.sqrt((error**2).mean()) < 2.0
    assert np.ptp(np.asarray(danced.stage["qpos"])[:, :2], axis=0).max() < 0.01


def nod(folder: Path) -> Path:
    """Three tenths of a second of the puppet's head."""
    model = puppet_model()
    time = np.arange(0.0, 0.305, 0.01)
    qpos = np.tile(model.key("standing").qpos, (len(time), 1))
    qpos[:, model.joint("neck_bend").qposadr[0]] = 0.1 * (1.0 - np.cos(10.0 * time))
    path = folder / "nod.npz"
    save_motion(Motion.from_qpos(model, time, qpos, name="nod"), path)
    return path


def simulated(folder: Path, *, stand: bool) -> ServoPerformance:
    return servo(nod(folder), port="simulated", stand=stand)


@pytest.mark.slow
def test_the_stage_is_said_first_and_what_was_seen_is_kept(tmp_path: Path) -> None:
    danced = simulated(tmp_path, stand=False)
    figures = danced.summary()
    assert next(iter(figures)) == "stage"
    assert "own feet" in figures["stage"]
    assert danced.completed
    assert figures["root_off_max"] is not None
    assert 0.0 < figures["root_off_max"] < 0.01
    seen = load_motion(danced.save(tmp_path)["seen"], puppet_model())
    assert np.ptp(seen.qpos[:, :3], axis=0).max() > 0.0


@pytest.mark.slow
def test_on_a_stand_it_hangs_and_is_parked(tmp_path: Path) -> None:
    danced = simulated(tmp_path, stand=True)
    figures = danced.summary()
    assert "stand" in figures["stage"]
    assert figures["ending"].startswith("parked")
    assert figures["root_off_max"] is None
    assert figures["tracking_rms_deg"] < 3.0


@pytest.mark.slow
def test_with_play_in_her_gears_she_still_stands_and_turns_less_exactly(tmp_path: Path) -> None:
    """Her waist, which no weight presses to one side, goes to and fro in its play."""
    waist = {}
    for backlash in (0.0, 0.5):
        danced = servo(nod(tmp_path), port="simulated", stand=False, backlash=backlash)
        assert danced.completed
        assert ("play" in danced.stage) is (backlash > 0.0)
        assert danced.staged is not None
        assert np.all(danced.staged.stage["root_force"] == 0.0)
        waist[backlash] = danced.tracking_by_joint()["waist_turn"]
    assert waist[0.0] < 0.1 < waist[0.5] < 0.5
