"""Laban's effort as numbers: the logistic keeps what Neagle 2005 §5.5.2 says of it."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from enpointe.errors import MotionError
from enpointe.motion import PRESETS, Effort, find_effort, logistic
from enpointe.motion.effort import logistic_rate

times = st.floats(-4.0, -2.0)
weights = st.floats(0.3, 0.8)
shares = st.floats(0.0, 1.0)


@given(times, weights)
def test_the_way_begins_at_nothing_and_ends_at_all(b: float, x0: float) -> None:
    assert logistic(0.0, b, x0) == 0.0
    assert logistic(1.0, b, x0) == pytest.approx(1.0, abs=1e-14)


@given(times, weights)
def test_nobody_goes_backwards(b: float, x0: float) -> None:
    assert np.all(np.diff(logistic(np.linspace(0, 1, 301), b, x0)) > 0)


@given(times, weights, st.floats(1e-3, 1.0))
def test_it_is_the_printed_curve_with_the_asymptote_of_eq_5_4(
    b: float, x0: float, t: float
) -> None:
    a = 1 + (1 / x0) ** b
    assert float(logistic(t, b, x0)) == pytest.approx(a / (1 + (t / x0) ** b), rel=1e-12)


@given(times, weights)
def test_half_the_asymptote_is_reached_at_the_centroid(b: float, x0: float) -> None:
    assert 2 * float(logistic(x0, b, x0)) == pytest.approx(1 + (1 / x0) ** b, rel=1e-12)


@given(times, weights, st.floats(0.01, 0.99))
def test_the_rate_is_the_derivative(b: float, x0: float, t: float) -> None:
    h = 1e-5
    slope = (logistic(t + h, b, x0) - logistic(t - h, b, x0)) / (2 * h)
    assert float(logistic_rate(t, b, x0)) == pytest.approx(float(slope), rel=1e-5, abs=1e-6)


@given(times, weights, st.floats(0.001, 5.0))
def test_outside_the_movement_nothing_moves(b: float, x0: float, beyond: float) -> None:
    assert logistic(-beyond, b, x0) == 0.0
    assert float(logistic(1 + beyond, b, x0)) == pytest.approx(1.0, abs=1e-14)
    assert logistic_rate(-beyond, b, x0) == logistic_rate(1 + beyond, b, x0) == 0.0


@given(weights)
def test_a_sudden_movement_is_steeper_than_a_sustained_one(x0: float) -> None:
    t = np.linspace(0, 1, 500)
    assert logistic_rate(t, -4.0, x0).max() > logistic_rate(t, -2.0, x0).max()


@given(times, st.floats(0.3, 0.79))
def test_a_heavy_movement_is_ahead_of_a_light_one(b: float, x0: float) -> None:
    assert logistic(0.4, b, x0) > logistic(0.4, b, x0 + 0.01)


@given(times, weights, st.lists(shares, min_size=1, max_size=5))
def test_arrays_of_any_shape_go_through(b: float, x0: float, t: list[float]) -> None:
    column = np.array(t)[:, None]
    assert logistic(column, b, x0).shape == logistic_rate(column, b, x0).shape == column.shape


@given(times, weights, shares)
def test_every_effort_in_range_is_an_effort(b: float, x0: float, s: float) -> None:
    assert Effort(b, x0, s) == Effort(time=b, weight=x0, space=s)


@pytest.mark.parametrize(
    ("values", "message"),
    [
        ((-4.1, 0.5, 0.5), "effort time=-4.1 is outside -4..-2"),
        ((-1.9, 0.5, 0.5), "effort time=-1.9 is outside -4..-2"),
        ((-3.0, 0.29, 0.5), "effort weight=0.29 is outside 0.3..0.8"),
        ((-3.0, 0.81, 0.5), "effort weight=0.81 is outside 0.3..0.8"),
        ((-3.0, 0.5, -0.1), "effort space=-0.1 is outside 0..1"),
        ((-3.0, 0.5, 1.1), "effort space=1.1 is outside 0..1"),
        ((float("nan"), 0.5, 0.5), "effort time=nan is outside -4..-2"),
        ((-3.0, float("inf"), 0.5), "effort weight=inf is outside 0.3..0.8"),
    ],
)
def test_what_lies_outside_is_refused(values: tuple[float, float, float], message: str) -> None:
    with pytest.raises(MotionError) as refused:
        Effort(*values)
    assert str(refused.value) == message


@given(times, weights, shares)
def test_numbers_can_be_written(b: float, x0: float, s: float) -> None:
    text = f"weight={x0!r}, space={s!r},time={b!r}"
    assert find_effort(text) == (Effort(b, x0, s), None, text)


@pytest.mark.parametrize("name", PRESETS)
def test_a_preset_brings_its_tempo(name: str) -> None:
    preset = PRESETS[name]
    assert find_effort(f" {name.upper()} ") == (preset.effort, preset.tempo, name)


def test_what_is_left_out_is_neutral() -> None:
    natural = PRESETS["natural"].effort
    assert find_effort("time=-3.5")[0] == Effort(-3.5, natural.weight, natural.space)


@pytest.mark.parametrize("text", ["joyful", "", "time", "flow=1", "time=-3,"])
def test_an_unknown_effort_names_the_known_ones(text: str) -> None:
    with pytest.raises(MotionError) as refused:
        find_effort(text)
    assert str(refused.value) == (
        f"no effort {text!r}; use natural, happy, sad, angry, afraid"
        " or time=-3.5,weight=.41,space=1"
    )


def test_a_word_where_a_number_belongs() -> None:
    with pytest.raises(MotionError) as refused:
        find_effort("time=quick")
    assert str(refused.value) == "effort time needs a number, got 'quick'"


def test_presets_stand_in_the_order_of_table_5_3() -> None:
    def ranked(value: dict[str, float]) -> list[str]:
        return sorted((n for n in value if n != "natural"), key=value.__getitem__)

    assert ranked({n: p.tempo for n, p in PRESETS.items()}) == ["sad", "afraid", "angry", "happy"]
    gradients = {n: p.effort.time for n, p in PRESETS.items()}
    assert ranked(gradients) == ["angry", "happy", "afraid", "sad"]
    assert min(PRESETS.values(), key=lambda p: p.effort.weight).name == "angry"
    assert max(PRESETS.values(), key=lambda p: p.effort.weight).name == "happy"


def test_every_preset_says_where_it_is_from() -> None:
    assert all("table" in preset.source for preset in PRESETS.values())
    with pytest.raises(TypeError):
        PRESETS["bored"] = PRESETS["sad"]  # type: ignore[index]
