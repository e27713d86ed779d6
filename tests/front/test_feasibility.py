"""A movement before a rig: the verdict, what it says, and the page."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import mujoco
import numpy as np
import pytest
from numpy.typing import NDArray

import enpointe
from enpointe.errors import MotionError, RigError
from enpointe.feasibility import Feasibility, feasible
from enpointe.models.puppet import op3_model, puppet_model
from enpointe.motion import Event, Motion
from enpointe.motion.joint_timing import timing_kept
from enpointe.motion.slowing import slowed
from enpointe.report.feasibility import write_feasibility

Array = NDArray[np.float64]
OP3 = op3_model()
KEYS = ((0.5, "stand"), (1.0, "kick"), (1.5, "close"))
KICK = "r_hip_pitch"


def kick(degrees: float, model: mujoco.MjModel = OP3, joint: str = KICK) -> Motion:
    """A leg up and down again, a second in all, from 0.5 s on."""
    time = np.arange(0.0, 2.0, 0.01)
    phase = np.clip(time - 0.5, 0.0, 1.0)
    qpos = np.tile(model.key("standing").qpos, (len(time), 1))
    up = 0.5 * (1.0 - np.cos(2.0 * np.pi * phase))
    qpos[:, model.joint(joint).qposadr[0]] += np.radians(degrees) * up
    events = [Event(t, "key pose", name, float(i)) for i, (t, name) in enumerate(KEYS)]
    return Motion.from_qpos(model, time, qpos, events=events, name="kick")


@pytest.fixture(scope="module")
def fast() -> Feasibility:
    return feasible(kick(65.0), "op3", stand=True, voltage=10.0)


def test_a_small_kick_is_feasible_as_written() -> None:
    found = feasible(kick(15.0), "op3", stand=True)
    assert (found.feasible, found.time_scale, found.reasons) == (True, 1.0, ())
    assert found.slowed is found.motion


def test_a_kick_too_fast_names_joint_moment_and_time(fast: Feasibility) -> None:
    assert not fast.feasible
    assert fast.time_scale is not None
    assert fast.time_scale > 1.0
    assert fast.limiting_joints == (KICK,)
    worst = fast.assessment.excesses[0]
    assert 0.5 < worst.time < 1.5
    assert any(KICK in line and "stand to kick" in line for line in fast.reasons)
    figures = json.loads(json.dumps(fast.summary()))
    assert figures["feasible"] is False
    assert figures["time_scale"] == fast.time_scale
    assert figures["limiting_joints"][0]["joint"] == KICK


def test_in_that_time_it_is_feasible_with_its_rhythm(fast: Feasibility) -> None:
    slow = fast.slowed
    again = feasible(slow, "op3", stand=True, voltage=10.0)
    assert again.feasible
    scale = fast.time_scale
    assert scale is not None
    tighter = slowed(fast.motion, scale / 1.02)
    assert not feasible(tighter, "op3", stand=True, voltage=10.0).feasible
    times = [event.time for event in slow.key_events]
    np.testing.assert_allclose(times, [scale * t for t, _ in KEYS])
    kept = timing_kept(fast.motion, fast.motion, [KICK])
    same = timing_kept(slow, slow, [KICK])
    assert kept.asked is not None
    assert same.asked is not None
    assert same.asked.time == pytest.approx(kept.asked.time, abs=1e-2)
    assert same.asked.weight == pytest.approx(kept.asked.weight, abs=1e-3)


def test_on_its_own_feet_a_body_that_leans_out_is_told(fast: Feasibility) -> None:
    found = feasible(fast.motion, "op3")
    assert found.time_scale is None
    assert any(excess.kind == "balance" for excess in found.assessment.hopeless)
    assert any("support" in line for line in found.reasons)
    with pytest.raises(MotionError, match="no time is enough"):
        _ = found.slowed


def test_limbs_in_the_way_are_told() -> None:
    found = feasible(kick(-20.0, puppet_model(), "left_hip_cross"), "puppet", stand=True)
    assert found.time_scale is None
    (hit,) = found.assessment.collisions
    assert {hit.first, hit.second} == {"left_hand", "left_thigh"}
    assert any("in one another" in line for line in found.reasons)


def test_a_movement_of_another_body_is_refused() -> None:
    with pytest.raises(MotionError, match="put it on the body"):
        feasible(kick(10.0), "puppet")


@pytest.mark.parametrize("supply", [{"voltage": 30.0}, {"reserve": 1.0}])
def test_a_supply_that_servos_do_not_take_is_refused(supply: dict[str, Any]) -> None:
    with pytest.raises(RigError):
        feasible(kick(10.0), "op3", stand=True, **supply)


def test_it_is_there_for_the_public() -> None:
    assert enpointe.feasible is feasible


def test_the_page_names_joints_and_moments(fast: Feasibility, tmp_path: Path) -> None:
    files = write_feasibility(fast, tmp_path, timing=timing_kept(fast.motion, fast.slowed, [KICK]))
    page = files["feasibility"].read_text(encoding="utf-8")
    for word in (KICK, "torque", "stand to kick", f"× {fast.time_scale:.3f}", "What of the effort"):
        assert word in page
    assert page.count("<svg") == 2


def late(motion: Motion, delay: float, blur: float) -> Motion:
    """As servos do it: later, and rounded off."""
    qpos = np.empty_like(motion.qpos)
    for i, t in enumerate(motion.time):
        moments = t - delay + blur * np.linspace(-1.0, 1.0, 21)
        qpos[i] = np.mean([motion.sample(float(m))[0] for m in moments], axis=0)
    return Motion.from_qpos(motion.model, motion.time, qpos, events=motion.events)


def test_a_delay_is_told_apart_from_a_change_of_timing(fast: Feasibility) -> None:
    same = timing_kept(fast.motion, late(fast.motion, 0.08, 0.0), [KICK])
    assert same.lag == pytest.approx(0.08, abs=0.006)
    assert same.distance_rms < 0.01
    assert same.speed_correlation > 0.995
    other = timing_kept(fast.motion, late(fast.motion, 0.08, 0.2), [KICK])
    assert other.distance_rms > 2.0 * same.distance_rms
    assert other.speed_correlation < same.speed_correlation
