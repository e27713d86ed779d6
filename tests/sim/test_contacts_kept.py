"""Stances that were planned and missed, and loads that nobody planned, are told."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from enpointe.controllers import PD, Recording, perform
from enpointe.models import dancer_model
from enpointe.motion import Motion
from enpointe.sim.body import SimulatedBody
from enpointe.sim.contacts_kept import contacts_kept
from enpointe.sim.feet import sole_sides


@pytest.fixture(scope="module")
def stood() -> Recording:
    """Half a second on two feet."""
    model = dancer_model()
    time = np.arange(0.0, 0.5, 0.004)
    motion = Motion.from_qpos(model, time, np.tile(model.key("standing").qpos, (len(time), 1)))
    return perform(motion, PD(motion), SimulatedBody.at_start_of(motion))


def with_load(
    recording: Recording, side: str, start: float, end: float, newtons: float
) -> Recording:
    """The recording with one foot's load overwritten for a while."""
    force = np.array(recording.channels["sole_force"], dtype=float)
    moments = (recording.time >= start) & (recording.time < end)
    samples, soles = np.ix_(moments, sole_sides(recording.model) == side)
    force[samples, soles, 2] = newtons
    return replace(recording, channels={**recording.channels, "sole_force": force})


def test_standing_keeps_both_stances(stood: Recording) -> None:
    kept = contacts_kept(stood)
    assert (kept.planned, kept.missed, kept.unplanned) == (2, (), ())


def test_a_foot_that_never_bears_is_missed(stood: Recording) -> None:
    kept = contacts_kept(with_load(stood, "left", 0.0, 9.0, 0.0))
    assert [(stance.side, stance.force) for stance in kept.missed] == [("left", 0.0)]


def test_a_foot_in_the_air_that_bears_is_unplanned(stood: Recording) -> None:
    lifted = stood.reference.qpos.copy()
    knee = stood.model.joint("left_knee_bend").qposadr[0]
    hip = stood.model.joint("left_hip_raise").qposadr[0]
    lifted[:, knee] += 1.2
    lifted[:, hip] += 0.6
    reference = Motion.from_qpos(stood.model, stood.reference.time, lifted)
    touched = with_load(with_load(stood, "left", 0.0, 9.0, 0.0), "left", 0.2, 0.3, 25.0)
    kept = contacts_kept(replace(touched, reference=reference))
    assert kept.planned == 1
    assert not kept.missed
    (stance,) = kept.unplanned
    assert stance.side == "left"
    assert stance.force == pytest.approx(6 * 25.0)
    assert stance.start == pytest.approx(0.2, abs=0.01)
    assert stance.end == pytest.approx(0.3, abs=0.01)


def test_chatter_shorter_than_a_fiftieth_of_a_second_is_not_told(stood: Recording) -> None:
    lifted = stood.reference.qpos.copy()
    lifted[:, 2] += 0.2
    flying = Motion.from_qpos(stood.model, stood.reference.time, lifted)
    still = with_load(with_load(stood, "left", 0.0, 9.0, 0.0), "right", 0.0, 9.0, 0.0)
    short = with_load(still, "left", 0.2, 0.21, 25.0)
    longer = with_load(still, "left", 0.2, 0.25, 25.0)
    assert contacts_kept(replace(short, reference=flying)).unplanned == ()
    assert len(contacts_kept(replace(longer, reference=flying)).unplanned) == 1
