"""A movement laid on the clock of another that dances the same."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from enpointe.errors import MotionError
from enpointe.models.puppet import op3_model, puppet_model
from enpointe.motion import Event, Motion
from enpointe.motion.in_step import in_step

MODEL, OTHER = puppet_model(), op3_model()
MOMENTS = (0.4, 1.1, 1.9)


def nod(moments: tuple[float, ...] = MOMENTS) -> Motion:
    time = np.arange(0.0, 2.405, 0.01)
    qpos = np.tile(MODEL.key("standing").qpos, (len(time), 1))
    qpos[:, MODEL.joint("neck_turn").qposadr[0]] = np.sin(time)
    events = [Event(t, "key pose", f"beat {i}", float(i)) for i, t in enumerate(moments)]
    return Motion.from_qpos(MODEL, time, qpos, events=events, name="nod")


def elsewhere(moments: np.ndarray, duration: float) -> Motion:
    """Of another body, which stands and has its key poses at these moments."""
    qpos = np.tile(OTHER.key("standing").qpos, (2, 1))
    events = [Event(float(t), "key pose", "there") for t in moments]
    return Motion.from_qpos(OTHER, [0.0, duration], qpos, events=events, name="there")


@given(st.floats(0.3, 4.0), st.floats(0.0, 3.0))
def test_key_poses_come_together_and_the_way_is_the_same(scale: float, delay: float) -> None:
    motion = nod()
    led, found = in_step(motion, elsewhere(scale * np.array(MOMENTS) + delay, 12.0))
    assert found == pytest.approx(scale)
    np.testing.assert_allclose(
        [e.time for e in led.key_events], scale * np.array(MOMENTS) + delay, atol=1e-6
    )
    for t in (0.0, 0.7, 1.3, 2.4):
        here, there = motion.sample(t), led.sample(scale * t + delay)
        np.testing.assert_allclose(there[0], here[0], atol=1e-6)
    standing = led.sample(0.5 * delay)
    np.testing.assert_allclose(standing[0], motion.qpos[0], atol=1e-9)
    assert led.qvel[1:] == pytest.approx(motion.qvel[-len(led.time) + 1 :] / scale)


def test_without_key_poses_the_ends_come_together() -> None:
    led, scale = in_step(replace(nod(), events=()), elsewhere(np.array([]), 4.8))
    assert scale == pytest.approx(2.0)
    assert led.duration == pytest.approx(4.8)


@pytest.mark.parametrize(
    "moments",
    [(0.4, 1.1), (0.4, 1.4, 1.9), (1.9, 1.1, 0.4), (0.1, 0.8, 1.6)],
    ids=["fewer", "another rhythm", "backwards", "earlier than it can begin"],
)
def test_another_dance_is_refused(moments: tuple[float, ...]) -> None:
    with pytest.raises(MotionError, match="no dance of nod"):
        in_step(nod(), elsewhere(np.array(moments), 3.0))
