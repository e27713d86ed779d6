"""Limbs that jump to the other side of their line for a few frames are led over."""

from __future__ import annotations

from dataclasses import replace

import mujoco
import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from enpointe.motion.retargeting import propose_map
from enpointe.motion.retargeting.flips import mended
from enpointe.motion.retargeting.source import Source, source_of

from .conftest import RATE, as_skeleton, step_sideways

Array = NDArray[np.float64]
LEG = ("left_knee", "left_ankle", "left_toe")


@pytest.fixture(scope="module")
def source(model: mujoco.MjModel) -> Source:
    """A leg that is raised and set down again, with its knee bent meanwhile."""
    captured = as_skeleton(step_sideways(model, 2.0))
    return source_of(captured, propose_map(captured))


def flipped(source: Source, when: slice) -> Source:
    """The left leg turned half round about the line from hip to ankle."""
    hip, ankle = (source.points[f"left_{name}"][when] for name in ("hip", "ankle"))
    along = (ankle - hip) / np.linalg.norm(ankle - hip, axis=1, keepdims=True)
    half = Rotation.from_rotvec(np.pi * along)
    points, frames = dict(source.points), dict(source.frames)
    for name in LEG:
        points[name] = points[name].copy()
        points[name][when] = hip + half.apply(points[name][when] - hip)
    frames["left_foot"] = frames["left_foot"].copy()
    frames["left_foot"][when] = half.as_matrix() @ frames["left_foot"][when]
    return replace(source, points=points, frames=frames)


def fastest(source: Source) -> float:
    """rad/s, of the left thigh."""
    thigh = source.points["left_knee"] - source.points["left_hip"]
    thigh /= np.linalg.norm(thigh, axis=1, keepdims=True)
    chord = np.linalg.norm(np.diff(thigh, axis=0), axis=1)
    return float(2.0 * np.arcsin(0.5 * chord).max() * source.rate)


def test_what_does_not_jump_stays(source: Source) -> None:
    same = mended(source)
    assert same.warnings == source.warnings
    for name, place in source.points.items():
        np.testing.assert_array_equal(same.points[name], place)


def test_a_flip_is_as_if_it_had_not_been(source: Source) -> None:
    """Six frames on the other side, in a movement that turns by some degrees meanwhile."""
    when = slice(30, 36)
    spoiled = flipped(source, when)
    assert fastest(spoiled) > 40.0
    whole = mended(spoiled)
    for name in LEG:
        off = np.linalg.norm(whole.points[name] - source.points[name], axis=1)
        assert off.max() < 0.02
        outside = np.delete(off, np.r_[when.start - 2 : when.stop + 2])
        assert outside.max() == 0.0
    turned = Rotation.from_matrix(whole.frames["left_foot"]).inv() * Rotation.from_matrix(
        source.frames["left_foot"]
    )
    assert np.degrees(turned.magnitude().max()) < 5.0
    assert fastest(whole) < 1.2 * fastest(source)
    assert [line for line in whole.warnings if "left leg jumps" in line]


def test_a_leg_that_does_not_come_back_is_led_over(source: Source) -> None:
    """Which side is right nobody knows; but the way there takes its time."""
    there = mended(flipped(source, slice(30, len(source.time))))
    assert fastest(there) < 20.0
    hip, knee, ankle = (there.points[f"left_{name}"] for name in ("hip", "knee", "ankle"))
    for one, other in ((hip, knee), (knee, ankle)):
        length = np.linalg.norm(other - one, axis=1)
        assert np.ptp(length) < 0.02 * length.mean()


def test_noise_at_a_high_rate_is_no_jump(source: Source) -> None:
    """A centimetre at a thousand frames a second is faster than limbs are, and only noise."""
    rng = np.random.default_rng(0)
    points = {
        name: place + 0.005 * rng.uniform(-1.0, 1.0, place.shape)
        for name, place in source.points.items()
    }
    quick = replace(source, points=points, time=source.time * RATE / 1000.0)
    assert mended(quick).warnings == source.warnings
