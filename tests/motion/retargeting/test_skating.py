"""Feet of a file that skate are told, whatever is made of them."""

from __future__ import annotations

import mujoco
import numpy as np
import pytest

from enpointe.motion.retargeting import Retargeted, retarget
from enpointe.motion.retargeting.body import BALL, NONE, TIP
from enpointe.motion.retargeting.floor import Steps, _lasting
from enpointe.motion.retargeting.skating import slides

from .conftest import RATE, as_skeleton, step_sideways


def worst(made: Retargeted) -> float:
    return max(float(far.max()) for far in made.slides.values())


def test_feet_that_stand_do_not_slide(model: mujoco.MjModel) -> None:
    assert worst(retarget(as_skeleton(step_sideways(model, 1.5)), model)) < 0.005


def test_a_skate_is_told_in_the_files_own_size(model: mujoco.MjModel) -> None:
    captured = as_skeleton(step_sideways(model, 1.5), scale=1.2)
    across = 0.06 * np.arange(captured.frames) / RATE
    captured.values[:, 0] += 100.0 * across
    made = retarget(captured, model)
    # On one foot after the other: each slides for as long as it bears.
    assert 0.03 < worst(made) < 0.1


@pytest.mark.parametrize("side", ["left", "right"])
def test_nothing_slides_in_the_air(model: mujoco.MjModel, side: str) -> None:
    made = retarget(as_skeleton(step_sideways(model, 1.5)), model)
    names = [model.geom(int(geom)).name for geom in made.contacts.soles]
    mine = [i for i, name in enumerate(names) if name.startswith(side)]
    high = made.contacts.points[:, mine, 2].min(axis=1) > 0.05
    assert high.any()
    assert np.all(made.slides[side][high] == 0.0)


def a_foot(kind: int, across: np.ndarray, *, still: bool = True) -> Steps:
    """A foot that touches in one way all the time, and where."""
    count = len(across)
    place = np.column_stack([across, np.zeros((count, 2))])
    return Steps(
        np.full(count, kind, dtype=np.int8),
        np.full(count, still),
        np.tile(np.eye(3), (count, 1, 1)),
        np.zeros(count),
        np.zeros(count),
        {kind: (place,)} if kind != NONE else {},
    )


@pytest.mark.parametrize(("beside", "far"), [(BALL, 0.0), (NONE, 0.1)])
def test_toes_drawn_beside_a_standing_foot_do_not_skate(beside: int, far: float) -> None:
    time = np.arange(61) / 60.0
    steps = {"left": a_foot(TIP, 0.1 * time), "right": a_foot(beside, 0.0 * time)}
    assert slides(steps, time)["left"].max() == pytest.approx(far)


def test_a_foot_does_not_flicker_from_toes_to_ball() -> None:
    """What is shorter than anybody shifts weight in is as what was before it."""
    kind = np.array([NONE] * 5 + [BALL] + [TIP] * 20 + [BALL, NONE] + [TIP] * 20, dtype=np.int8)
    for down in (kind != NONE, np.arange(len(kind)) > 4):
        found = _lasting(kind, down, 1 / 120)
        np.testing.assert_array_equal(found, np.where(down, TIP, NONE))
