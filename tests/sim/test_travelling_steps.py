"""Steps that travel are danced under gravity: of a walk that is made up, and of captured ones."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import enpointe
from enpointe.controllers import WholeBody, perform
from enpointe.controllers.wholebody import STEPPING_TASKS
from enpointe.models import dancer_model
from enpointe.models.anatomy import SIDES
from enpointe.motion import Motion
from enpointe.motion.contact_schedule import ContactSchedule, contact_schedule
from enpointe.motion.danceable import Danceable, make_danceable
from enpointe.motion.foot_turns import turned_about
from enpointe.motion.settling import led, stances
from enpointe.sim.body import SimulatedBody
from enpointe.sim.measures import measure

MODEL = dancer_model(flesh=False)
RATE = 100.0
STEP = 0.3
"""m from foot to foot."""
LANDS = {"left": (1.5, 2.4), "right": (1.95,)}
"""s; the foot leaves .35 s before."""


def walk(strikes_early: float, turns: float) -> tuple[Motion, ContactSchedule]:
    """Three steps as they are captured: a heel that is yet on its way is seen on the floor some
    time before it rests, and a foot turns while it carries.
    """
    time = np.arange(round(4.4 * RATE) + 1) / RATE
    standing = np.array(MODEL.key("standing").qpos)
    qpos = np.tile(standing, (len(time), 1))
    share = np.clip((time - 1.1) / 1.4, 0.0, 1.0)
    qpos[:, 0] += 2 * STEP * share**2 * (3.0 - 2.0 * share)
    found = contact_schedule(Motion.from_qpos(MODEL, time, np.tile(standing, (len(time), 1))))
    points, bears = found.points.copy(), np.ones_like(found.bears)
    names = [MODEL.geom(int(geom)).name for geom in found.soles]
    for side in SIDES:
        foot = np.array([name.startswith(side) for name in names])
        heel = np.array(["heel" in name for name in names]) & foot
        gone = 0.0
        for lands in LANDS[side]:
            ahead = min(2 * STEP, gone + (STEP if lands == 1.5 else 2 * STEP)) - gone
            way = np.clip((time - lands + 0.35) / 0.35, 0.0, 1.0)
            points[:, foot, 0] += (ahead * way)[:, None]
            gone += ahead
            swings = (time > lands - 0.35) & (time < lands)
            bears[np.ix_(swings, foot)] = False
            bears[np.ix_(swings & (time >= lands - strikes_early), heel)] = True
            other = ~foot
            share = np.clip((time - lands + 0.35) / 0.35, 0.0, 1.0)
            centre = points[:, other, :2].mean(axis=1)
            points[:, other] = turned_about(points[:, other], centre, turns * share)
    return Motion.from_qpos(MODEL, time, qpos), ContactSchedule(time, found.soles, points, bears)


def danceable(strikes_early: float, turns: float) -> Danceable:
    motion, seen = walk(strikes_early, turns)
    return make_danceable(motion, contacts=led(stances(MODEL, seen)))


@pytest.mark.slow
@pytest.mark.parametrize(("strikes_early", "turns"), [(0.0, 0.0), (0.12, 0.4)])
def test_a_walk_is_danced_though_heels_strike_early_and_feet_turn(
    strikes_early: float, turns: float
) -> None:
    made = danceable(strikes_early, turns)
    driver = WholeBody(made.motion, contacts=made.contacts, tasks=STEPPING_TASKS)
    recording = perform(made.motion, driver, SimulatedBody.at_start_of(made.motion))
    measures = measure(recording)
    assert measures.fell_at is None
    assert measures.root_force_max == 0.0
    assert recording.qpos[-1, 0] - recording.qpos[0, 0] == pytest.approx(2 * STEP, abs=0.05)


@pytest.mark.slow
@pytest.mark.parametrize("take", ["05_01", "05_03"])
def test_the_steps_of_a_captured_dancer_are_danced(data_dir: Path, take: str) -> None:
    """A walk, and a turn step into an arabesque: she fell in both."""
    dance = enpointe.perform_file(data_dir / "cmu_05" / f"{take}.amc")
    assert dance.completed
    figures = dance.summary()
    assert figures["root_force_max"] == 0.0
    assert figures["tracking_rms_deg"] < 4.0
