"""One dance on several bodies, side by side."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from enpointe.models.dancer import dancer_model
from enpointe.models.puppet import puppet_model
from enpointe.motion import Event, Motion
from enpointe.report.bodies import write_bodies

TIME = np.arange(0.0, 0.21, 0.02)
EVENTS = [Event(0.0, "key pose", "down", 0.0), Event(TIME[-1], "key pose", "up", 1.0)]


def arm(of: str, joint: str, late: float = 0.0) -> Motion:
    model = dancer_model(flesh=False) if of == "dancer" else puppet_model()
    qpos = np.tile(model.key("standing").qpos, (len(TIME), 1))
    share = np.clip((TIME - late) / TIME[-1], 0.0, 1.0)
    qpos[:, model.joint(joint).qposadr[0]] += 1.2 * share**2
    return Motion.from_qpos(model, TIME, qpos, events=EVENTS, name="arm")


def test_dancer_puppet_and_servos_stand_side_by_side(tmp_path: Path) -> None:
    motions = {
        "dancer": arm("dancer", "left_shoulder_raise"),
        "puppet": arm("puppet", "left_shoulder_raise"),
        "servos": arm("puppet", "left_shoulder_raise", late=0.05),
    }
    files = write_bodies(motions, tmp_path)
    page = files["bodies"].read_text(encoding="utf-8")
    assert files["video"].stat().st_size > 1000
    for name in motions:
        assert page.count(name) >= 2
    assert "servos beside puppet" in page
    assert "puppet beside dancer" not in page
    joints = page[page.index("servos beside puppet") :]
    assert joints.index("left_shoulder_raise") < joints.index("waist_turn")
