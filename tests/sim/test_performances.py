"""Every shipped score in every preset, danced under gravity: honest, whole, and as asked."""

from __future__ import annotations

import numpy as np
import pytest

from enpointe.controllers import PD, perform
from enpointe.motion import PRESETS
from enpointe.motion.arrival import danced_tempo
from enpointe.motion.wrist import fit_logistic, wrist_profiles
from enpointe.sim.body import SimulatedBody

from ..motion.dancing import EFFORTS, PORTS_DE_BRAS, danced, motion

QUICK = {("third-port-de-bras", "happy"), ("first-port-de-bras", "angry")}
DANCES = [
    pytest.param(score, preset, marks=() if (score, preset) in QUICK else pytest.mark.slow)
    for score in PORTS_DE_BRAS
    for preset in EFFORTS
]


@pytest.mark.parametrize(("score", "preset"), DANCES)
def test_a_performance_is_honest_and_good(score: str, preset: str) -> None:
    dance = danced(score, preset)
    recording, figures, watch = dance.recording, dance.measures, dance.watch

    # Honesty: nobody but gravity, the floor and her own joints.
    assert watch.steps >= 2 * len(recording.time)
    assert watch.applied == watch.pulled == watch.root_actuation == 0.0
    assert recording.model.neq == recording.model.nmocap == 0
    assert watch.over_limit <= 1e-9
    assert np.all(np.abs(recording.effort) <= recording.model.actuator_forcerange[:, 1] + 1e-9)
    assert watch.strangers == set()
    assert not np.any(recording.channels["other_contacts"])
    assert figures.root_force_max == 0.0

    # The numbers of the issue.
    assert recording.fault is None
    assert figures.fell_at is None
    assert figures.slip_max <= 0.005
    assert figures.tracking_rms_deg <= 2.0
    assert figures.support_margin_min is not None
    assert figures.support_margin_min > 0.01
    assert figures.flights == ()
    assert figures.torque_limit_fraction_max <= 1.0

    # Tempo and effort as asked.
    tempo, lateness = danced_tempo(recording.as_motion(), dance.motion)
    assert tempo == pytest.approx(PRESETS[preset].tempo, rel=0.01)
    assert lateness < 0.05
    fit, effort = fit_logistic(wrist_profiles(recording.as_motion())), PRESETS[preset].effort
    assert fit is not None
    assert fit.time == pytest.approx(effort.time, abs=0.4)
    assert fit.weight == pytest.approx(effort.weight, abs=0.06)


def test_the_same_dance_twice_is_the_same_bit_for_bit() -> None:
    reference = motion("first-port-de-bras", "angry")
    again = perform(reference, PD(reference), SimulatedBody.at_start_of(reference))
    recording = danced("first-port-de-bras", "angry").recording
    for name in ("time", "qpos", "qvel", "effort", "position", "torque"):
        np.testing.assert_array_equal(getattr(again, name), getattr(recording, name))
    for name, channel in recording.channels.items():
        np.testing.assert_array_equal(again.channels[name], channel)


def test_floor_and_gravity_explain_all_movement() -> None:
    """Newton: m a = sum of forces under the soles + m g, from the recording's own figures."""
    dance = danced("third-port-de-bras", "happy")
    recording, period = dance.recording, dance.recording.period
    mass = float(recording.model.body_mass.sum())
    acceleration = np.gradient(np.gradient(dance.measures.com, period, axis=0), period, axis=0)
    force = np.asarray(recording.channels["sole_force"]).sum(axis=1)
    left = force + mass * np.array([0, 0, -9.81]) - mass * acceleration
    moving = slice(100, -100)
    width = 10
    smooth = np.stack(
        [np.convolve(left[moving, i], np.ones(width) / width, "valid") for i in range(3)], axis=1
    )
    assert np.abs(smooth).max() < 0.01 * mass * 9.81
    assert np.abs(mass * acceleration[moving]).max() > 0.02 * mass * 9.81


def test_the_floor_never_pulls_and_rubs_within_its_friction() -> None:
    force = np.asarray(danced("third-port-de-bras", "happy").recording.channels["sole_force"])
    assert force[:, :, 2].min() >= 0.0
    sideways = np.linalg.norm(force[:, :, :2], axis=2)
    assert np.all(sideways <= 1.0 * force[:, :, 2] + 1e-6)
