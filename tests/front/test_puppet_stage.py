"""The puppet dances by herself: emulated servos through the SDK, gravity and a floor."""

from __future__ import annotations

import numpy as np
import pytest

from enpointe.hardware.rig_file import load_rig
from enpointe.models.puppet import puppet_model
from enpointe.motion import Motion
from enpointe.puppet_stage import SETTLE, dance_on_stage


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
