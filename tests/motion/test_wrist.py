"""What came of an effort: profiles of the wrists, and the logistic read back out of them."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from enpointe.motion import PRESETS, fit_logistic, logistic, wrist_profiles
from enpointe.motion.wrist import Profile
from enpointe.notation import Side

from .dancing import EFFORTS, PORTS_DE_BRAS, choreography, danced, motion
from .floor import dance


def profile(b: float, x0: float, samples: int, noise: np.ndarray | float = 0.0) -> Profile:
    phase = np.linspace(0, 1, samples)
    return Profile(
        Side.LEFT, "a", "b", phase, logistic(phase, b, x0) + noise, np.zeros(samples), 0.5, 1.0
    )


@settings(max_examples=40)
@given(st.floats(-6.0, -1.2), st.floats(0.2, 0.9), st.integers(30, 400))
def test_the_fit_finds_what_was_put_in(b: float, x0: float, samples: int) -> None:
    fit = fit_logistic([profile(b, x0, samples)])
    assert fit is not None
    assert fit.time == pytest.approx(b, abs=1e-3)
    assert fit.weight == pytest.approx(x0, abs=1e-3)
    assert fit.rms < 1e-6
    assert fit.profiles == 1


@settings(max_examples=20)
@given(st.floats(-4.0, -2.0), st.floats(0.3, 0.8), st.integers(0, 2**31))
def test_noise_is_left_over_and_not_fitted(b: float, x0: float, seed: int) -> None:
    noise = 0.01 * np.random.default_rng(seed).normal(size=400)
    fit = fit_logistic([profile(b, x0, 400, noise)])
    assert fit is not None
    assert fit.time == pytest.approx(b, abs=0.15)
    assert fit.weight == pytest.approx(x0, abs=0.03)
    assert fit.rms == pytest.approx(0.01, rel=0.3)


def test_every_profile_counts_alike() -> None:
    """A slow passage has more samples than a quick one, and not more say."""
    one, other = (-2.0, 0.4), (-4.0, 0.6)
    even = fit_logistic([profile(*one, 200), profile(*other, 200)])
    uneven = fit_logistic([profile(*one, 2000), profile(*other, 200)])
    assert even is not None
    assert uneven is not None
    assert uneven.time == pytest.approx(even.time, abs=0.05)
    assert uneven.weight == pytest.approx(even.weight, abs=0.01)


def test_nothing_moves_nothing_is_fitted() -> None:
    assert fit_logistic([]) is None


def test_profiles_run_from_nought_to_one() -> None:
    reference = motion("third-port-de-bras", "happy")
    profiles = wrist_profiles(reference)
    keys = choreography("third-port-de-bras", "happy").key_times
    # The arms wait on counts 2 and 6, while the head goes to the other side.
    assert len(profiles) == 2 * 6
    for p in profiles:
        assert p.distance[0] == 0.0
        assert p.distance[-1] == 1.0
        assert p.phase[0] == pytest.approx(0.0, abs=0.01)
        assert p.phase[-1] == pytest.approx(1.0, abs=0.01)
        assert np.all(np.diff(p.distance) >= 0)
        assert p.seconds == pytest.approx(60 / 80)
        assert 0.2 < p.length < 1.5
        assert np.trapezoid(p.speed, p.phase) * p.seconds == pytest.approx(p.length, rel=0.02)
    assert {p.side for p in profiles} == set(Side)
    assert len(keys) == 9


@pytest.mark.slow
@pytest.mark.parametrize("preset", EFFORTS)
@pytest.mark.parametrize("score", PORTS_DE_BRAS)
def test_the_expressive_wrist_has_the_effort_that_was_asked(score: str, preset: str) -> None:
    fit, effort = fit_logistic(wrist_profiles(motion(score, preset))), PRESETS[preset].effort
    assert fit is not None
    assert fit.time == pytest.approx(effort.time, abs=0.05)
    assert fit.weight == pytest.approx(effort.weight, abs=0.01)


@pytest.mark.slow
@pytest.mark.parametrize("score", ["adage-developpe", "temps-lie-grand-battement"])
def test_legs_do_not_change_the_effort_of_the_arms(score: str) -> None:
    fit, effort = fit_logistic(wrist_profiles(dance(score).motion)), PRESETS["natural"].effort
    assert fit is not None
    assert fit.time == pytest.approx(effort.time, abs=0.1)
    assert fit.weight == pytest.approx(effort.weight, abs=0.02)


@pytest.mark.slow
@pytest.mark.parametrize("score", PORTS_DE_BRAS)
def test_danced_under_gravity_the_presets_stay_in_order(score: str) -> None:
    """Table 5.3's order in tempo and time, and natural where its own numbers put it."""
    fits, seconds = {}, {}
    for preset in EFFORTS:
        profiles = wrist_profiles(danced(score, preset).recording.as_motion())
        fits[preset], seconds[preset] = fit_logistic(profiles), float(profiles[0].seconds)
    gradient = {name: fit.time for name, fit in fits.items() if fit is not None}
    assert sorted(gradient, key=gradient.__getitem__) == [
        "angry",
        "natural",
        "happy",
        "afraid",
        "sad",
    ]
    assert sorted(seconds, key=seconds.__getitem__) == [
        "happy",
        "angry",
        "natural",
        "afraid",
        "sad",
    ]
