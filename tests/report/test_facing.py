"""From where a movement is best seen."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from enpointe.models.dancer import dancer_model
from enpointe.motion import Motion
from enpointe.report.facing import SEEN, in_front_of, seen_from
from enpointe.sim.camera import View

MODEL = dancer_model(flesh=False)


def facing(*degrees: float) -> Motion:
    qpos = np.tile(MODEL.key("standing").qpos, (len(degrees), 1))
    turns = Rotation.from_euler("Z", np.array(degrees)[:, None], degrees=True)
    qpos[:, 3:7] = turns.as_quat(scalar_first=True)
    return Motion.from_qpos(MODEL, 0.1 * np.arange(len(degrees)), qpos)


@given(st.floats(61.0, 180.0) | st.floats(-180.0, -61.0), st.floats(-8.0, 8.0))
def test_who_faces_elsewhere_is_seen_from_there(heading: float, sway: float) -> None:
    view = in_front_of(facing(heading - sway, heading, heading + sway), View())
    _, _, sight = view.axes()
    ahead = np.array([np.cos(np.radians(heading)), np.sin(np.radians(heading))])
    assert sight[:2] @ ahead < -0.98 * np.linalg.norm(sight[:2])


@pytest.mark.parametrize("headings", [(0.0, 10.0, 40.0), (-50.0, -50.0), (0.0, 90.0, 180.0, 270.0)])
def test_who_faces_the_audience_or_nowhere_is_seen_from_the_audience(
    headings: tuple[float, ...],
) -> None:
    assert in_front_of(facing(*headings), View.three_quarter()) == View.three_quarter()
    assert seen_from(facing(*headings)) == SEEN


def test_the_caption_says_so() -> None:
    assert "90° to the left" in seen_from(facing(90.0, 90.0))
    assert "120° to the right" in seen_from(facing(-120.0, -120.0))
