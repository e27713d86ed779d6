"""A leg on its way: it meets both ends, keeps its turnout, and goes round what is in its way."""

from __future__ import annotations

from functools import cache

import mujoco
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.typing import NDArray

from enpointe.models.leg_target import LEG_JOINTS
from enpointe.motion.clock import Clock
from enpointe.motion.effort import Effort
from enpointe.motion.leg_swing import STRAIGHT, LegSwing, leg_angles, smooth
from enpointe.notation import Side

from .dancing import solver

Array = NDArray[np.float64]


def posed(**angles: float) -> Array:
    """Standing at rest with some of the left leg's angles, degrees."""
    model = solver().model
    qpos = np.array(model.key("standing").qpos)
    for name, angle in angles.items():
        qpos[model.joint(f"left_{name}").qposadr[0]] = np.radians(angle)
    return qpos


@cache
def front() -> Array:
    return posed(hip_raise=89, hip_cross=52, hip_turn=114, ankle_point=75)


@cache
def back() -> Array:
    return posed(hip_raise=-80, hip_cross=-38, hip_turn=90, ankle_point=75)


def swing(start: Array, end: Array, *, floor: bool = True) -> LegSwing:
    return LegSwing(solver().model, Side.LEFT, start, end, floor)


def test_it_meets_both_poses_without_speed() -> None:
    way = swing(front(), back())
    step = 1e-4
    for share, qpos in ((0.0, front()), (1.0, back())):
        ends = leg_angles(solver().model, qpos, Side.LEFT)
        assert way.at(share) == pytest.approx(ends, abs=1e-9)
        inside = abs(share - step)
        assert np.abs(way.at(inside) - ends).max() / step < 0.05


def test_a_way_that_is_free_has_no_detour() -> None:
    assert swing(front(), posed(hip_raise=60, hip_cross=40, hip_turn=90)).detour == STRAIGHT


def test_a_leg_that_swings_through_clears_floor_and_leg() -> None:
    model = solver().model
    way = swing(front(), back())
    assert way.detour != STRAIGHT
    data, ends = mujoco.MjData(model), np.empty(6)
    for share in np.linspace(0, 1, 41):
        data.qpos[:] = front()
        for joint, angle in zip(LEG_JOINTS, way.at(float(share)), strict=True):
            data.qpos[model.joint(f"left_{joint}").qposadr[0]] = angle
        mujoco.mj_kinematics(model, data)
        low = min(data.geom(f"left_{p}_{r}").xpos[2] for p in ("heel", "tip") for r in ("inner",))
        assert low > -0.02
        gap = mujoco.mj_geomDistance(
            model,
            data,
            model.geom("left_shank_limb").id,
            model.geom("right_shank_limb").id,
            0.1,
            ends,
        )
        assert gap > 0.0


def test_in_the_air_there_is_no_floor_to_clear() -> None:
    through = swing(front(), back(), floor=False)
    assert through.detour.bend < swing(front(), back()).detour.bend or not through.detour.flat


@given(st.floats(0, 1))
def test_easing_is_even_and_goes_forward(share: float) -> None:
    assert smooth(share) + smooth(1 - share) == pytest.approx(1)
    assert smooth(min(share + 0.01, 1.0)) >= smooth(share)


@given(st.floats(-4, -2), st.floats(0.3, 0.8), st.floats(0.01, 0.99))
def test_a_clock_knows_its_moments(time: float, weight: float, moment: float) -> None:
    clock = Clock(Effort(time, weight, 0.5))
    assert clock.moment(clock.share(moment)) == pytest.approx(moment, abs=1e-9)
    assert Clock().share(moment) == moment == Clock().moment(moment)
