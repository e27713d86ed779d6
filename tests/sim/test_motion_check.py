"""A movement is looked at without dancing it: against cases whose answer is known."""

from __future__ import annotations

from collections.abc import Callable

import mujoco
import numpy as np
import pytest
from numpy.typing import NDArray

from enpointe.motion import Motion
from enpointe.sim.feet import FootState
from enpointe.sim.motion_check import MEANT_STILL, check_motion

from .test_body import FIRST_POSE, MODEL

Array = NDArray[np.float64]
WEIGHT = float(MODEL.body_mass.sum() * 9.81)
RATE = 100.0


def moved(seconds: float, change: Callable[[float, Array], None]) -> Motion:
    """First position, changed at each moment."""
    time = np.arange(0.0, seconds + 0.5 / RATE, 1.0 / RATE)
    poses = np.tile(FIRST_POSE, (len(time), 1))
    for t, pose in zip(time, poses, strict=True):
        change(float(t), pose)
    return Motion.from_qpos(MODEL, time, poses)


def unmoved(_t: float, _pose: Array) -> None:
    """As she stands."""


def test_standing_still_is_sound() -> None:
    found = check_motion(moved(0.5, unmoved))
    assert found.support_margin_min is not None
    assert found.support_margin_min > 0.05
    assert found.zmp_outside_fraction == 0.0
    np.testing.assert_allclose(found.zmp_margin, found.com_margin, atol=1e-6)
    np.testing.assert_allclose(found.stability_margin, found.com_margin, atol=1e-9)
    assert found.slip_max < 1e-9
    assert found.penetration_max < 1e-3
    assert found.overlap_max < 1e-3
    assert found.root_wrench_rms < 0.01 * WEIGHT
    assert (found.flights, found.turns, found.breaches) == ((), (), ())
    for contacts in found.contacts.values():
        assert [(c.start, c.end, c.on) for c in contacts] == [(0.0, 0.5, FootState.FLAT)]


@pytest.mark.parametrize("speed", [0.6 * MEANT_STILL, 2.0 * MEANT_STILL])
def test_a_foot_that_skates_is_measured(speed: float) -> None:
    """Slowly, so that it seems to stand, or faster: at just `MEANT_STILL` rounding would decide."""

    def skate(t: float, pose: Array) -> None:
        pose[0] += speed * t

    assert check_motion(moved(1.0, skate)).slip_max == pytest.approx(speed, abs=1e-6)


def test_what_sinks_is_measured() -> None:
    level = check_motion(moved(0.2, unmoved)).penetration_max

    def sink(_t: float, pose: Array) -> None:
        pose[2] -= 0.03

    assert check_motion(moved(0.2, sink)).penetration_max == pytest.approx(level + 0.03, abs=1e-6)


def test_nobody_hangs_in_the_air_without_help() -> None:
    def hang(_t: float, pose: Array) -> None:
        pose[2] += 0.5

    found = check_motion(moved(0.5, hang))
    assert found.root_wrench_rms == pytest.approx(WEIGHT, rel=0.2)
    assert found.support_margin_min is None
    assert found.zmp_outside_fraction is None
    assert found.contacts == {"left": (), "right": ()}


def test_a_jolt_is_told_as_a_jolt() -> None:
    """The trunk bows at a steady speed, and stops at once."""
    bend = MODEL.joint("waist_bend").qposadr[0]

    def bow(t: float, pose: Array) -> None:
        pose[bend] += 0.3 * min(t, 0.3)

    found = check_motion(moved(0.6, bow))
    whys = [each.why for each in found.help if abs(each.start - 0.3) < 0.03]
    assert whys == ["too sudden: something starts or stops at once"]


def test_a_fall_on_the_parabola_needs_none() -> None:
    def thrown(t: float, pose: Array) -> None:
        pose[2] += 0.5 + 1.5 * t - 0.5 * 9.81 * t * t

    found = check_motion(moved(0.3, thrown))
    # Differences at both ends and the hold after the end are not on the parabola.
    assert np.abs(found.root_wrench[2:-3]).max() < 0.01 * WEIGHT
    (flight,) = found.flights
    assert flight.start == 0.0
    assert flight.end == pytest.approx(0.3)
    assert flight.height == pytest.approx(1.5**2 / (2 * 9.81), abs=1e-3)


@pytest.mark.parametrize("revolutions", [-1.25, 0.5, 2.0])
def test_a_turn_is_counted_with_its_sign(revolutions: float) -> None:
    def turn(t: float, pose: Array) -> None:
        share = min(max((t - 0.2) / 1.0, 0.0), 1.0)
        angle = 2 * np.pi * revolutions * share
        whirl, turned = np.zeros(4), np.zeros(4)
        mujoco.mju_axisAngle2Quat(whirl, np.array([0.0, 0.0, 1.0]), angle)
        mujoco.mju_mulQuat(turned, whirl, pose[3:7])
        pose[3:7] = turned

    (found,) = check_motion(moved(1.5, turn)).turns
    assert found.revolutions == pytest.approx(revolutions, rel=0.01)
    assert found.start == pytest.approx(0.2, abs=0.02)
    assert found.end == pytest.approx(1.2, abs=0.02)


def test_a_joint_beyond_its_range_is_named() -> None:
    joint = MODEL.joint("left_elbow_bend")
    most = float(joint.range[1])

    def overbend(t: float, pose: Array) -> None:
        pose[joint.qposadr[0]] = most + np.radians(3.0) * np.sin(np.pi * t)

    (breach,) = check_motion(moved(1.0, overbend)).breaches
    assert breach.joint == "left_elbow_bend"
    assert breach.time == pytest.approx(0.5, abs=0.02)
    assert breach.beyond_deg == pytest.approx(3.0, abs=0.01)


def test_a_weight_thrown_sideways_takes_the_zmp_outside() -> None:
    """A rigid shove of the whole body by a: the ZMP is  a h / g  behind the centre of mass."""
    amplitude, frequency = 0.02, 2 * np.pi * 1.5

    def sway(t: float, pose: Array) -> None:
        pose[1] += amplitude * np.sin(frequency * t)

    found = check_motion(moved(1.0, sway))
    still = check_motion(moved(0.2, unmoved))
    assert still.support_margin_min is not None
    height = 0.94
    thrown = amplitude * frequency**2 * height / 9.81
    assert (thrown > still.support_margin_min) == (float(np.nanmin(found.zmp_margin)) < 0.0)
    assert found.zmp_outside_fraction is not None
    assert 0.0 < found.zmp_outside_fraction < 1.0
