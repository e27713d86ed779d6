"""A motion made danceable: planned contacts, a weight that the floor can carry, feet in place."""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from itertools import groupby

import mujoco
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from enpointe.controllers import Recording, WholeBody, perform
from enpointe.models import dancer_model
from enpointe.models.foot_positions import support_hull
from enpointe.motion import Motion
from enpointe.motion.arrival import danced_tempo
from enpointe.motion.contact_schedule import ON_FLOOR, SHORTEST, ContactSchedule, contact_schedule
from enpointe.motion.danceable import Danceable, make_danceable
from enpointe.motion.weight_plan import PLAN_RATE, WeightPlan, plan_weight
from enpointe.sim.balance import margin
from enpointe.sim.body import SimulatedBody
from enpointe.sim.feet import FootState, foot_states
from enpointe.sim.measures import measure

from .floor import dance

MOVING = ("temps-lie-grand-battement", "adage-developpe")
MODEL = dancer_model(flesh=False)


def standing(seconds: float = 1.0) -> Motion:
    time = np.arange(0.0, seconds + 0.002, 0.004)
    return Motion.from_qpos(MODEL, time, np.tile(MODEL.key("standing").qpos, (len(time), 1)))


@cache
def danceable(score: str) -> Danceable:
    return make_danceable(dance(score).motion)


def feet(contacts: ContactSchedule) -> dict[str, np.ndarray]:
    """(T,) whether each foot bears anything."""
    names = [MODEL.geom(int(g)).name for g in contacts.soles]
    return {
        side: np.asarray(contacts.bears[:, [n.startswith(side) for n in names]].any(axis=1))
        for side in ("left", "right")
    }


def test_a_standing_dancer_stands_on_all_her_soles() -> None:
    assert contact_schedule(standing()).bears.all()


def test_a_port_de_bras_stays_on_both_feet() -> None:
    assert contact_schedule(dance("third-port-de-bras").motion).bears.all()


@pytest.mark.parametrize("score", MOVING)
def test_a_toe_stretched_to_the_floor_is_not_stood_on(score: str) -> None:
    """Somebody always bears; on the counts of the grand battement and développé only one foot."""
    contacts = contact_schedule(dance(score).motion)
    bearing = feet(contacts)
    assert np.all(bearing["left"] | bearing["right"])
    alone = bearing["left"] ^ bearing["right"]
    assert 0.3 < alone.mean() < 0.95
    heights = contacts.points[:, :, 2]
    assert heights[contacts.bears].max() < ON_FLOOR + 0.02


@pytest.mark.parametrize("score", MOVING)
def test_contacts_do_not_chatter(score: str) -> None:
    contacts = contact_schedule(dance(score).motion)
    for bears in feet(contacts).values():
        edges = np.flatnonzero(np.diff(bears.astype(int)))
        assert np.all(np.diff(contacts.time[edges]) > 0.5 * SHORTEST)


def zmp_outside(plan: WeightPlan, contacts: ContactSchedule) -> float:
    """Farthest that the plan's own zero-moment point is outside the support, m, knot by knot."""
    worst = -np.inf
    for t, point in zip(plan.time, plan.zmp, strict=True):
        i = contacts.index(float(t))
        hull = support_hull(contacts.points[i, contacts.bears[i], :2])
        worst = max(worst, -margin(hull, point))
    return worst


@pytest.mark.parametrize("score", MOVING)
def test_the_floor_can_give_what_the_plan_needs(score: str) -> None:
    made = danceable(score)
    assert made.weight.outside.max() < 1e-4
    assert zmp_outside(made.weight, made.contacts) < 1e-4


@pytest.mark.parametrize("score", MOVING)
def test_the_plan_is_a_motion(score: str) -> None:
    """Velocity and acceleration are those of the place, and it begins and ends at rest."""
    plan = danceable(score).weight
    for rows, rates in ((plan.com, plan.velocity), (plan.velocity, plan.acceleration)):
        moved = np.diff(rows[:, :2], axis=0) * PLAN_RATE
        mean = 0.5 * (rates[1:, :2] + rates[:-1, :2])
        jerk = np.abs(np.diff(plan.acceleration[:, :2], axis=0)).max() * PLAN_RATE
        assert np.abs(moved - mean).max() < jerk / PLAN_RATE**1 / 4
    for end in (0, -1):
        assert np.abs(plan.velocity[end, :2]).max() < 1e-6
        assert np.abs(plan.acceleration[end, :2]).max() < 1e-6


def test_who_stands_in_the_middle_stays_there() -> None:
    motion = standing()
    plan = plan_weight(motion, contact_schedule(motion), motion)
    assert plan.shifted.max() < 0.03
    assert np.ptp(plan.com[:, :2], axis=0).max() < 0.02


@settings(max_examples=15)
@given(st.floats(0.4, 3.0))
def test_a_step_too_far_is_said_to_be_one(length: float) -> None:
    """From one foot to one far away with nothing in between: no floor can do it in no time."""
    motion = standing(0.6)
    contacts = contact_schedule(motion)
    late = contacts.time > 0.3
    names = [MODEL.geom(int(g)).name for g in contacts.soles]
    left = np.array([n.startswith("left") for n in names])
    points = contacts.points.copy()
    points[:, ~left, 1] -= length
    bears = np.where(late[:, None], ~left, left)
    plan = plan_weight(motion, replace(contacts, points=points, bears=bears), motion)
    assert plan.outside.max() > 0.05 * length


@pytest.mark.parametrize("score", MOVING)
def test_feet_that_bear_keep_their_places(score: str) -> None:
    made = danceable(score)
    before, after = made.contacts, contact_schedule(made.motion)
    moved = np.linalg.norm(after.points - before.points, axis=2)
    assert moved[before.bears].max() < 0.001


@pytest.mark.parametrize("score", MOVING)
def test_the_centre_of_mass_follows_the_plan(score: str) -> None:
    made = danceable(score)
    data = mujoco.MjData(MODEL)
    for k in range(0, len(made.weight.time), 5):
        data.qpos[:] = made.motion.sample(float(made.weight.time[k]))[0]
        mujoco.mj_kinematics(MODEL, data)
        mujoco.mj_comPos(MODEL, data)
        assert np.abs(data.subtree_com[0] - made.weight.com[k])[:2].max() < 0.005


@pytest.mark.parametrize("score", MOVING)
def test_it_is_still_the_same_dance(score: str) -> None:
    """The same beats; arms as they were; legs within what moving the weight takes."""
    asked, made = dance(score).motion, danceable(score).motion
    assert np.array_equal(asked.time, made.time)
    assert asked.events == made.events
    names = [MODEL.joint(j).name for j in range(1, MODEL.njnt)]
    arms = np.array([any(p in n for p in ("shoulder", "elbow", "wrist")) for n in names])
    apart = np.degrees(np.abs(made.qpos[:, 7:] - asked.qpos[:, 7:]))
    assert apart[:, arms].max() < 5.0
    assert apart.max() < 20.0


@pytest.mark.parametrize("score", MOVING)
def test_joints_stay_in_their_ranges(score: str) -> None:
    made = danceable(score).motion
    low, high = MODEL.jnt_range[1:].T
    assert np.all(made.qpos[:, 7:] >= low - np.radians(3.0))
    assert np.all(made.qpos[:, 7:] <= high + np.radians(3.0))


@cache
def performed(score: str) -> tuple[Recording, int]:
    """Danced on a free root, and how often the programme had no solution."""
    reference = danceable(score).motion
    controller = WholeBody(reference)
    recording = perform(reference, controller, SimulatedBody.at_start_of(reference))
    return recording, controller.workload.failures


@pytest.mark.slow
@pytest.mark.parametrize("score", [*MOVING, "releve"])
def test_it_is_danced_under_gravity(score: str) -> None:
    """On one leg and on two, on a free root, with the strength that a dancer has."""
    recording, failures = performed(score)
    measures = measure(recording)
    assert measures.fell_at is None
    assert measures.root_force_max == 0.0
    assert measures.other_contact_max == 0.0
    assert failures == 0
    assert measures.tracking_rms_deg < 1.0
    assert measures.slip_max < 0.010
    assert measures.torque_limit_fraction_max <= 1.0 + 1e-9


@pytest.mark.slow
def test_eight_releves_rise_and_come_down_in_time() -> None:
    """Both heels leave the floor eight times, the balls of the feet never, and beats are kept."""
    recording, _ = performed("releve")
    forces = np.asarray(recording.channels["sole_force"])[::5]
    states = [foot_states(MODEL, force) for force in forces]
    for side in ("left", "right"):
        seen = [key for key, _ in groupby(state[side] for state in states)]
        assert set(seen) == {FootState.FLAT, FootState.DEMI_POINTE}
        assert seen.count(FootState.DEMI_POINTE) == 8
    assert danced_tempo(recording.as_motion(), recording.reference)[1] < 0.04
