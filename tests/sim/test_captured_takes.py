"""What is known of captured takes (CMU's subject 05) is found in them."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import mujoco
import numpy as np
import pytest

from enpointe.checking import MEASURED
from enpointe.models import dancer_model
from enpointe.motion.formats import SkeletonMotion, read
from enpointe.motion.retargeting import Retargeted, retarget
from enpointe.motion.retargeting.holding import runs
from enpointe.sim.motion_check import MotionCheck, check_motion

pytestmark = pytest.mark.slow


@pytest.fixture(scope="module")
def model() -> mujoco.MjModel:
    return dancer_model(flesh=False)


def taken(folder: Path, take: str, model: mujoco.MjModel, frames: slice) -> Retargeted:
    """Some frames of a take on the dancer."""
    path = folder / "cmu_05" / f"{take}.amc"
    if not path.exists():
        pytest.skip("no data here")
    captured = read(path).motion
    assert isinstance(captured, SkeletonMotion)
    rate = captured.rate / (frames.step or 1)
    return retarget(replace(captured, values=captured.values[frames], rate=rate), model)


def looked_at(made: Retargeted) -> MotionCheck:
    return check_motion(made.motion, made.contacts, averaged_over=MEASURED)


def test_one_foot_is_always_planted(model: mujoco.MjModel, data_dir: Path) -> None:
    """05_12: arms and trunk over the right foot, and over the left before and after."""
    made = taken(data_dir, "05_12", model, slice(None, None, 4))
    soles = [model.geom(int(geom)).name for geom in made.contacts.soles]
    down = {
        side: np.asarray(made.contacts.bears[:, [s.startswith(side) for s in soles]].any(axis=1))
        for side in ("left", "right")
    }
    assert np.all(down["left"] | down["right"])
    stays = max(runs(down["right"]), key=lambda run: run.stop - run.start)
    assert made.motion.time[stays.start] < 1.5
    assert made.motion.time[stays.stop] > 8.5
    ball = [i for i, name in enumerate(soles) if name.startswith("right_ball")]
    places = made.contacts.points[stays, ball, :2].mean(axis=1)[5:-15]
    assert np.linalg.norm(places - places[0], axis=1).max() < 0.005
    assert looked_at(made).flights == ()


def test_two_turns_on_a_foot_that_stays_down(model: mujoco.MjModel, data_dir: Path) -> None:
    """05_11: a pirouette to the right on the left foot, between a spring into it and one out."""
    found = looked_at(taken(data_dir, "05_11", model, slice(None, None, 3)))
    assert sum(turn.revolutions for turn in found.turns) == pytest.approx(-2.0, abs=0.15)
    assert all(flight.end < 1.0 or flight.start > 2.2 for flight in found.flights)
    assert all(flight.end - flight.start < 0.35 for flight in found.flights)


def test_a_leap_keeps_to_its_parabola(model: mujoco.MjModel, data_dir: Path) -> None:
    """05_16: a grand jeté. The free path is from its time alone, so its height tells both."""
    found = looked_at(taken(data_dir, "05_16", model, slice(120, 290)))
    leap = max(found.ballistics, key=lambda flight: flight.end - flight.start)
    assert leap.end - leap.start == pytest.approx(0.5, abs=0.06)
    assert leap.rise_ratio == pytest.approx(1.0, abs=0.1)
    assert leap.fall == pytest.approx(9.81, rel=0.1)
