"""One leg holds: the whole-body controller stands where PD falls, and takes a push."""

from __future__ import annotations

import numpy as np
import pytest

import enpointe
from enpointe.controllers import PD, Recording, WholeBody, perform
from enpointe.controllers.plant import Plant
from enpointe.controllers.wholebody import DEFAULT_TASKS
from enpointe.controllers.wholebody.tasks import CentreOfMass
from enpointe.models.foot_positions import support_hull
from enpointe.motion import Motion
from enpointe.notation import parse_score
from enpointe.sim.balance import room
from enpointe.sim.body import SimulatedBody
from enpointe.sim.measures import measure
from enpointe.sim.push import Push, PushedBody, largest_push

from ..controllers.wholebody_cases import (
    ARABESQUE_DEMI,
    DEVANT_POINTE,
    FIRST,
    RETIRE,
    RETIRE_DEMI,
    held,
)
from ..motion.dancing import written_score


def danced(motion: Motion, controller: WholeBody | PD | None = None) -> Recording:
    return perform(motion, controller or WholeBody(motion), SimulatedBody.at_start_of(motion))


def check(motion: Motion) -> None:
    controller = WholeBody(motion)
    recording = danced(motion, controller)
    figures = measure(recording)
    assert figures.fell_at is None
    assert figures.tracking_rms_deg < 0.5
    assert figures.joint_rms_deg.max() < 1.0
    assert figures.root_force_max == 0.0
    assert figures.other_contact_max == 0.0
    assert figures.torque_limit_fraction_max < 0.6
    assert figures.slip_max < 2e-3
    assert controller.workload.failures == 0
    assert controller.workload.commands == len(recording.time)


@pytest.mark.parametrize("pose", [RETIRE, ARABESQUE_DEMI, DEVANT_POINTE])
def test_one_leg_holds(pose: str) -> None:
    check(held(pose, 2.0))


@pytest.mark.slow
@pytest.mark.parametrize("pose", [FIRST, RETIRE, RETIRE_DEMI, ARABESQUE_DEMI, DEVANT_POINTE])
def test_ten_seconds_hold(pose: str) -> None:
    check(held(pose, 10.0))


def test_without_feedback_of_the_centre_of_mass_she_falls() -> None:
    motion = held(RETIRE_DEMI, 4.0)
    tasks = [task for task in DEFAULT_TASKS if not isinstance(task, CentreOfMass)]
    assert measure(danced(motion, WholeBody(motion, tasks=tasks))).fell_at is not None


def test_pd_falls_where_the_whole_body_stands() -> None:
    motion = held(RETIRE, 4.0)
    assert measure(danced(motion, PD(motion))).fell_at is not None


@pytest.mark.parametrize(
    ("pose", "share", "stands"), [(RETIRE, 0.7, True), (RETIRE, 2.0, False), (FIRST, 1.0, True)]
)
def test_a_push_to_the_left_is_taken_up_to_what_the_feet_can_take(
    pose: str, share: float, stands: bool
) -> None:
    motion = held(pose, 3.2)
    plant = Plant(motion.model)
    plant.place(motion.qpos[0])
    hull = support_hull(plant.data.geom_xpos[plant.soles_on_floor()][:, :2])
    left = room(hull, plant.com[:2], np.array([0.0, 1.0]))
    most = largest_push(left, plant.com[2], plant.mass, plant.gravity, 0.1)
    body = PushedBody([Push(0.2, (0.0, share * most, 0.0))], motion.model, motion.qpos[0])
    figures = measure(perform(motion, WholeBody(motion), body))
    assert (figures.fell_at is None) == stands
    assert figures.root_force_max == pytest.approx(share * most / 0.1)


STEPS = {
    "retiré": (
        "feet: fifth right front; arms: fifth en bas",
        "left leg: straight; right leg: retiré devant; arms: fifth en avant",
        "feet: fifth right front; arms: fifth en bas",
    ),
    "plié-relevé": (
        "feet: first; arms: fifth en bas",
        "feet: first, demi-plié",
        "feet: first, demi-pointe",
        "feet: first",
    ),
}


@pytest.mark.slow
@pytest.mark.parametrize("step", STEPS)
def test_a_step_is_danced_through(step: str) -> None:
    score = parse_score(written_score(*STEPS[step], tempo=30 if step == "retiré" else 60))
    dance = enpointe.perform(score, controller="wholebody")
    figures = dance.summary()
    assert figures["completed"]
    assert figures["qp_failures"] == 0
    assert figures["other_contact_max"] == 0.0
    assert figures["root_force_max"] == 0.0
    assert figures["tracking_rms_deg"] < 2.0


@pytest.mark.parametrize("duration", [0.0, 0.1, 0.4])
def test_the_bound_is_where_a_pendulum_just_does_not_topple(duration: float) -> None:
    """Against a linear inverted pendulum stepped with its pressure at the edge."""
    mass, height, gravity, edge = 54.0, 0.95, 9.81, 0.08
    most = largest_push(edge, height, mass, gravity, duration)
    omega, dt = np.sqrt(gravity / height), 1e-5
    for share, topples in ((0.98, False), (1.02, True)):
        place, speed = 0.0, share * most / mass if duration == 0.0 else 0.0
        for k in range(100_000):
            pushed = k * dt < duration
            force = share * most / duration if pushed else 0.0
            speed += dt * (omega**2 * (place - edge) + force / mass)
            place += dt * speed
        assert (place + speed / omega > edge) == topples
