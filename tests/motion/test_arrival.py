"""The tempo that is really kept, against motions whose delay is known."""

from __future__ import annotations

import numpy as np
import pytest

from enpointe.motion import Motion
from enpointe.motion.arrival import arrivals, danced_tempo

from .dancing import motion

ASKED = motion("first-port-de-bras", "angry")


def delayed(seconds: float, stretch: float = 1.0) -> Motion:
    """The same movement, later or slower."""
    times = (ASKED.time - 0.5 - seconds) / stretch + 0.5
    qpos = np.array([ASKED.sample(float(t))[0] for t in times])
    return Motion.from_qpos(ASKED.model, ASKED.time, qpos, events=ASKED.events)


def test_the_reference_is_never_late() -> None:
    tempo, lateness = danced_tempo(ASKED, ASKED)
    assert tempo == pytest.approx(79.0)
    assert lateness == 0.0


@pytest.mark.parametrize("seconds", [0.02, 0.06])
def test_who_is_late_keeps_the_tempo(seconds: float) -> None:
    tempo, lateness = danced_tempo(delayed(seconds), ASKED)
    assert tempo == pytest.approx(79.0, rel=0.02)
    assert lateness == pytest.approx(seconds, abs=0.015)


def test_who_is_slow_does_not() -> None:
    tempo, _ = danced_tempo(delayed(0.0, stretch=1.05), ASKED)
    assert tempo == pytest.approx(79.0 / 1.05, rel=0.02)


def test_who_never_arrives_has_no_tempo() -> None:
    waiting = np.tile(ASKED.qpos[0], (len(ASKED.time), 1))
    waits = Motion.from_qpos(ASKED.model, ASKED.time, waiting)
    assert np.isnan(arrivals(waits, ASKED)).any()
    assert np.isnan(danced_tempo(waits, ASKED)).all()
