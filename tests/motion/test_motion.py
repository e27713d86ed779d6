"""A motion refuses what is none, and its velocities are those of the movement."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import mujoco
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.typing import NDArray

from enpointe.errors import MotionError
from enpointe.motion import Event, Motion

from .dancing import tiny_model

Array = NDArray[np.float64]


def swinging(rate: float = 200.0, seconds: float = 2.0, spin: float = 1.3) -> Motion:
    """A trunk that turns and travels steadily, with an arm that swings."""
    time = np.arange(int(rate * seconds) + 1) / rate
    qpos = np.zeros((len(time), 8))
    qpos[:, 0], qpos[:, 2] = 0.3 * time, 1.0
    qpos[:, 3], qpos[:, 6] = np.cos(spin * time / 2), np.sin(spin * time / 2)
    qpos[:, 7] = np.sin(3.0 * time)
    events = (Event(0.0, "key pose", "first", 0.0), Event(1.0, "contact", "left foot"))
    return Motion.from_qpos(tiny_model(), time, qpos, events=events, name="swing")


def test_velocities_are_those_of_the_movement() -> None:
    motion = swinging()
    inner = slice(1, -1)
    np.testing.assert_allclose(motion.qvel[inner, 0], 0.3, atol=1e-9)
    np.testing.assert_allclose(motion.qvel[inner, 5], 1.3, atol=1e-9)
    np.testing.assert_allclose(motion.qvel[inner, 6], 3 * np.cos(3 * motion.time[inner]), atol=1e-3)
    inner = slice(3, -3)
    np.testing.assert_allclose(
        motion.qacc[inner, 6], -9 * np.sin(3 * motion.time[inner]), atol=5e-3
    )


def test_a_quaternion_may_change_its_sign() -> None:
    motion = swinging()
    flipped = motion.qpos.copy()
    flipped[::2, 3:7] *= -1
    again = Motion.from_qpos(motion.model, motion.time, flipped)
    np.testing.assert_allclose(again.qvel, motion.qvel, atol=1e-9)


@given(st.integers(0, 400))
def test_at_a_node_it_is_the_node(i: int) -> None:
    motion = swinging()
    qpos, qvel, qacc = motion.sample(float(motion.time[i]))
    np.testing.assert_allclose(qpos, motion.qpos[i], atol=1e-12)
    if i < 400:
        np.testing.assert_allclose(qvel, motion.qvel[i], atol=1e-9)
        np.testing.assert_allclose(qacc, motion.qacc[i], atol=1e-7)


@given(st.floats(0.0, 1.999))
def test_between_nodes_it_is_near_the_movement(t: float) -> None:
    qpos, _, _ = swinging().sample(t)
    assert np.linalg.norm(qpos[3:7]) == pytest.approx(1.0, abs=1e-12)
    assert qpos[7] == pytest.approx(np.sin(3 * t), abs=1e-4)
    assert qpos[0] == pytest.approx(0.3 * t, abs=1e-12)


@given(st.floats(2.0, 1e9) | st.just(float("inf")))
def test_after_the_end_it_holds_still(t: float) -> None:
    motion = swinging()
    qpos, qvel, qacc = motion.sample(t)
    np.testing.assert_array_equal(qpos, motion.qpos[-1])
    assert not qvel.any()
    assert not qacc.any()


@given(st.floats(-1e9, 0.0))
def test_before_the_start_it_waits_in_the_first_pose(t: float) -> None:
    motion = swinging()
    np.testing.assert_allclose(motion.sample(t)[0], motion.qpos[0], atol=1e-12)


def test_a_sample_is_the_askers_own() -> None:
    motion = swinging()
    for t in (-1.0, 0.0, 0.7, 5.0):
        for array in motion.sample(t):
            array += 1.0
    np.testing.assert_array_equal(motion.qpos, swinging().qpos)


def test_key_events_are_the_key_poses() -> None:
    motion = swinging()
    assert [e.name for e in motion.key_events] == ["first"]
    assert motion.duration == 2.0


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"qpos": np.zeros((401, 7))}, r"qpos must have shape \(401, 8\), got \(401, 7\)"),
        ({"qvel": np.zeros((400, 7))}, r"qvel must have shape \(401, 7\), got \(400, 7\)"),
        ({"qacc": np.zeros((401, 8))}, r"qacc must have shape \(401, 7\), got \(401, 8\)"),
        ({"qvel": np.full((401, 7), np.nan)}, "qvel of swing has values that are not numbers"),
        ({"qpos": np.full((401, 8), np.inf)}, "qpos of swing has values that are not numbers"),
        ({"time": np.zeros(401)}, "times must start at 0, increase"),
        ({"time": np.arange(401) + 1.0}, "times must start at 0, increase"),
        ({"time": -np.arange(401.0)}, "times must start at 0, increase"),
        ({"time": np.r_[0, np.full(400, np.nan)]}, "times must start at 0, increase"),
    ],
)
def test_what_is_no_motion_is_refused(changes: dict[str, Any], message: str) -> None:
    with pytest.raises(MotionError, match=message):
        replace(swinging(), **changes)


def test_one_frame_is_no_motion() -> None:
    motion = swinging()
    with pytest.raises(MotionError, match="two at least"):
        Motion(motion.model, motion.time[:1], motion.qpos[:1], motion.qvel[:1], motion.qacc[:1])


@pytest.mark.parametrize("shape", [(401,), (401, 7), (400, 8)])
def test_configurations_of_another_body_are_refused(shape: tuple[int, ...]) -> None:
    with pytest.raises(MotionError, match=r"qpos must have shape \(401, 8\)"):
        Motion.from_qpos(tiny_model(), np.arange(401) / 200, np.zeros(shape))


def test_the_model_moves_as_the_motion_says() -> None:
    """Integrating the velocities leads along the configurations."""
    motion = swinging()
    qpos = motion.qpos[1].copy()
    for i in range(1, 300):
        mujoco.mj_integratePos(motion.model, qpos, motion.qvel[i], 1 / 200)
    np.testing.assert_allclose(qpos, motion.qpos[300], atol=0.02)
