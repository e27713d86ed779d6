"""Feet of a file that skate are told, whatever is made of them."""

from __future__ import annotations

import mujoco
import numpy as np
import pytest

from enpointe.motion.retargeting import Retargeted, retarget

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
