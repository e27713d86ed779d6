"""Segments add up to the body they were taken from and scale with it."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from enpointe.errors import ModelError
from enpointe.models import Anthropometry, Sex
from enpointe.models.anatomy import Skeleton

from .posing import measures

SINGLE = ("head", "upper_trunk", "middle_trunk", "lower_trunk")
PAIRED = ("upper_arm", "forearm", "hand", "thigh", "shank", "foot")


def total(body: Anthropometry) -> float:
    single = sum(body.segment(name).mass for name in SINGLE)
    return single + 2 * sum(body.segment(name).mass for name in PAIRED)


@given(measures())
def test_the_segments_weigh_what_the_body_weighs(body: Anthropometry) -> None:
    assert total(body) == pytest.approx(body.mass, rel=1e-12)


@given(measures())
def test_every_segment_is_a_possible_rigid_body(body: Anthropometry) -> None:
    """Positive mass and length, the centre within it, and moments that obey the triangle rule."""
    for name in SINGLE + PAIRED:
        segment = body.segment(name)
        assert segment.mass > 0
        assert 0 < segment.com < segment.length
        least, middle, most = sorted(segment.inertia)
        assert least > 0
        assert most <= least + middle


@given(measures(), st.floats(0.8, 1.25))
def test_lengths_scale_with_stature_and_masses_with_mass(
    body: Anthropometry, factor: float
) -> None:
    height = float(np.clip(body.height * factor, 1.3, 2.1))
    ratio = height / body.height
    scaled = Anthropometry(height, body.mass * ratio**2, body.sex)
    for name in SINGLE + PAIRED:
        old, new = body.segment(name), scaled.segment(name)
        assert new.length == pytest.approx(old.length * ratio)
        assert new.com == pytest.approx(old.com * ratio)
        assert new.mass == pytest.approx(old.mass * ratio**2)
        assert new.inertia == pytest.approx(np.array(old.inertia) * ratio**4)


def test_men_and_women_are_built_differently() -> None:
    """De Leva 1996: women carry more of their mass in the thighs and less in the chest."""
    woman, man = (Anthropometry(1.75, 65, sex) for sex in (Sex.FEMALE, Sex.MALE))
    assert woman.segment("thigh").mass > man.segment("thigh").mass
    assert woman.segment("upper_trunk").mass < man.segment("upper_trunk").mass
    assert woman.segment("thigh").length < man.segment("thigh").length


def test_the_mean_woman_has_the_table_s_own_lengths() -> None:
    """De Leva 1996, table 4."""
    mean = Anthropometry(1.735, 61.9, Sex.FEMALE)
    assert mean.segment("upper_arm").length == pytest.approx(0.2751)
    assert mean.segment("shank").com == pytest.approx(0.4416 * 0.4323)
    assert mean.segment("head").mass == pytest.approx(0.0668 * 61.9, rel=1e-3)


@given(measures())
def test_the_joints_stack_up_to_the_stature(body: Anthropometry) -> None:
    skeleton = Skeleton(body)
    crown = (
        skeleton.hip_height + skeleton.waist_height + skeleton.torso_length + skeleton.head_and_neck
    )
    assert crown == pytest.approx(body.height)
    assert skeleton.heel_back + skeleton.ball_forward < skeleton.foot_length
    assert 0 < skeleton.ankle_height < skeleton.shank


@pytest.mark.parametrize("sex", Sex)
def test_the_ankle_is_as_high_as_people_s(sex: Sex) -> None:
    """Lateral malleolus: about 0.039 of stature (Drillis and Contini 1966)."""
    body = Anthropometry(1.75, 65, sex)
    assert 0.03 < Skeleton(body).ankle_height / body.height < 0.055


@pytest.mark.parametrize(
    ("height", "mass"),
    [
        (168.0, 54.0),
        (0.0, 54.0),
        (-1.68, 54.0),
        (1.68, 0.0),
        (1.68, -54.0),
        (1.68, 540.0),
        (1.68, 54_000.0),
        (float("nan"), 54.0),
        (1.68, float("nan")),
        (float("inf"), 54.0),
        (1.68, float("inf")),
    ],
)
def test_absurd_measures_are_refused_in_one_line(height: float, mass: float) -> None:
    with pytest.raises(ModelError) as caught:
        Anthropometry(height, mass)
    message = str(caught.value)
    assert "\n" not in message
    assert "outside" in message


def test_an_unknown_segment_is_named_with_the_known_ones() -> None:
    with pytest.raises(ModelError, match=r"no segment 'tail'; there are .*forearm"):
        Anthropometry().segment("tail")


def test_an_unknown_sex_is_refused_in_one_line() -> None:
    with pytest.raises(ModelError, match="robot"):
        Anthropometry(sex="robot")  # type: ignore[arg-type]
