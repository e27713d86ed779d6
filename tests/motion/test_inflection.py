"""The wrist leads and the hand follows: most in a light movement, least in a heavy one."""

from __future__ import annotations

from math import radians

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from enpointe.models.target import ArmTarget
from enpointe.motion import Effort
from enpointe.motion.arm_path import ArmPath
from enpointe.motion.inbetween import solve_passage
from enpointe.motion.inflection import inflected
from enpointe.notation import Side

from .dancing import sites, solved, solver, written_score

UP_AND_DOWN = written_score(
    "feet: first; arms: fifth en bas", "arms: fifth en avant", "arms: fifth en bas"
)
SIDEWAYS = written_score("feet: first; arms: fifth en bas", "arms: à la seconde")
weights = st.floats(0.3, 0.8)
headings = st.tuples(*[st.floats(-1, 1)] * 3).filter(lambda v: np.linalg.norm(v) > 0.1)


def resting_arm(side: Side = Side.LEFT) -> ArmTarget:
    return solved(UP_AND_DOWN).key_poses[0].target.arms[side]


def trail(heading: tuple[float, ...], k: float, weight: float) -> float:
    arm = resting_arm()
    bend, cross = inflected(arm, Side.LEFT, np.array(heading) / np.linalg.norm(heading), k, weight)
    return float(np.hypot(bend - arm.wrist_bend, cross - arm.wrist_cross))


@given(headings, weights)
def test_at_both_key_poses_the_hand_is_as_written(
    heading: tuple[float, ...], weight: float
) -> None:
    assert trail(heading, 0.0, weight) == pytest.approx(0.0, abs=1e-12)
    assert trail(heading, 1.0, weight) == pytest.approx(0.0, abs=1e-12)


@given(headings, st.floats(0.05, 0.95), st.floats(0.3, 0.75))
def test_a_light_hand_trails_more_than_a_heavy_one(
    heading: tuple[float, ...], k: float, weight: float
) -> None:
    assert trail(heading, k, weight) <= trail(heading, k, weight + 0.05) + 1e-12


@given(headings, st.floats(0, 1), weights, st.sampled_from(Side))
def test_no_wrist_bends_beyond_its_limits(
    heading: tuple[float, ...], k: float, weight: float, side: Side
) -> None:
    direction = np.array(heading) / np.linalg.norm(heading)
    bend, cross = inflected(resting_arm(side), side, direction, k, weight)
    assert abs(bend) <= radians(55.0)
    assert radians(-30.0) <= cross <= radians(20.0)


def test_a_hand_that_waits_is_not_bent() -> None:
    arm = resting_arm()
    assert inflected(arm, Side.LEFT, np.zeros(3), 0.5, 0.8) == (arm.wrist_bend, arm.wrist_cross)


def test_going_back_bends_the_other_way() -> None:
    arm, up = resting_arm(), np.array([0.0, 0.0, 1.0])
    there, back = (np.array(inflected(arm, Side.LEFT, s * up, 0.5, 0.5)) for s in (1, -1))
    written = np.array([arm.wrist_bend, arm.wrist_cross])
    np.testing.assert_allclose(there - written, written - back, atol=1e-12)
    assert np.linalg.norm(there - back) > radians(5.0)


@pytest.mark.parametrize(
    ("score", "index"),
    [(UP_AND_DOWN, 0), (UP_AND_DOWN, 1), (SIDEWAYS, 0)],
    ids=["up", "down", "side"],
)
@pytest.mark.parametrize("weight", [0.3, 0.8])
def test_the_fingertips_trail_behind_the_wrist_on_the_body(
    score: str, index: int, weight: float
) -> None:
    """On the solved dancer: raising, the fingertips are lower than in the plain arm, and so on."""
    start, end = solved(score).key_poses[index : index + 2]
    effort = Effort(-3.0, weight, 1.0)
    plain, bent = (
        solve_passage(solver(), start, end, effort, inflect=inflect) for inflect in (False, True)
    )
    for side in Side:
        way = ArmPath(solver().figure, side, start.target.arms[side], end.target.arms[side], 1.0)
        heading = way.heading(way.at_share(0.5))
        lags = []
        for passage in (plain, bent):
            middle = passage.poses[len(passage.poses) // 2].qpos[None]
            wrist, tips = sites(solver().model, middle, f"{side}_wrist", f"{side}_fingertips")[0]
            lags.append(float((wrist - tips) @ heading))
        assert lags[1] > lags[0] + 0.002
