"""Where a foot in the air is moved when the weight is not where it should be."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from enpointe.controllers.wholebody.goal import Goal
from enpointe.controllers.wholebody.instant import Instant, Observer
from enpointe.controllers.wholebody.reference import Reference
from enpointe.controllers.wholebody.step_adjustment import landing_shift

from .wholebody_cases import MODEL, RETIRE, Array, held

ASIDE = np.array([0.0, 1.0])


def standing() -> tuple[Instant, Goal]:
    observer = Observer(MODEL, 0.6)
    motion = held(RETIRE)
    goal = Reference(motion, observer).at(0.5)
    observer.place(motion.qpos[0], np.zeros(MODEL.nv))
    return observer.instant(np.arange(6)), goal


def off_by(place: Array, velocity: Array) -> tuple[Instant, Goal]:
    """The body where it is, and a goal that it is so far ahead of."""
    instant, goal = standing()
    places, rates = goal.places.copy(), goal.rates.copy()
    places[0, :2] = instant.com[:2] - place
    rates[0, :2] = instant.com_velocity[:2] - velocity
    return instant, goal._replace(places=places, rates=rates)


def test_a_body_that_is_where_it_should_be_steps_as_planned() -> None:
    instant, goal = off_by(np.array([0.004, 0.0]), np.array([0.0, 0.01]))
    np.testing.assert_array_equal(landing_shift(instant, goal, 0.3, ASIDE), 0.0)


def test_a_step_catches_a_pendulum_that_the_foot_alone_does_not() -> None:
    """A linear inverted pendulum beside its reference, its pressure moved by all of 1 cm that the
    foot has: where it lands is where its extrapolated centre of mass then is.
    """
    place, velocity, left = np.array([0.008, 0.0]), np.array([0.06, 0.0]), 0.25
    instant, goal = off_by(place, velocity)
    omega = np.sqrt(instant.gravity / instant.com[2])
    c, v, steps = place[0], velocity[0], 20000
    for _ in range(steps):
        v += omega**2 * (c - 0.01) * left / steps
        c += v * left / steps
    shift = landing_shift(instant, goal, left, ASIDE)
    assert shift[0] + place[0] == pytest.approx(c + v / omega - 0.01, abs=1e-4)
    assert shift[1] == pytest.approx(0.0, abs=1e-12)


@settings(max_examples=30, deadline=None)
@given(
    x=st.floats(-0.1, 0.1),
    y=st.floats(-0.1, 0.1),
    vx=st.floats(-1.0, 1.0),
    vy=st.floats(-1.0, 1.0),
    left=st.floats(0.0, 0.5),
)
def test_no_step_goes_far_or_across_the_other_foot(
    x: float, y: float, vx: float, vy: float, left: float
) -> None:
    instant, goal = off_by(np.array([x, y]), np.array([vx, vy]))
    moved = landing_shift(instant, goal, left, ASIDE) + np.array([x, y])
    if not np.allclose(moved, [x, y]):
        assert np.linalg.norm(moved) < 0.121
        assert moved @ ASIDE > -0.0301
