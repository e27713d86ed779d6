"""The columns of balance: what each foot stands on, and a file that reads back."""

from __future__ import annotations

import csv
from functools import cache
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray

from enpointe.controllers import Recording, WholeBody, perform
from enpointe.controllers.plant import Plant
from enpointe.models import dancer_model
from enpointe.sim.balance_table import COLUMNS, balance_table
from enpointe.sim.body import SimulatedBody
from enpointe.sim.feet import FootState, foot_states, ground_forces
from enpointe.sim.measures import measure

from ..controllers.wholebody_cases import ARABESQUE_DEMI, DEVANT_POINTE, FIRST, RETIRE, held

Array = NDArray[np.float64]
SHOD = dancer_model(flesh=False, pointe_shoes=True)
NAMES = [SHOD.geom(int(g)).name for g in Plant(SHOD).sole_geoms]


@cache
def standing(pose: str) -> Recording:
    motion = held(pose, 0.3)
    return perform(motion, WholeBody(motion), SimulatedBody.at_start_of(motion))


@pytest.mark.parametrize(
    ("loaded", "state"),
    [
        ((), FootState.AIR),
        (("heel_inner", "ball_outer"), FootState.FLAT),
        (("heel_inner", "heel_outer", "tip_inner"), FootState.FLAT),
        (("heel_outer",), FootState.HEEL),
        (("ball_inner", "tip_outer"), FootState.DEMI_POINTE),
        (("tip_inner", "tip_outer"), FootState.DEMI_POINTE),
        (("platform_under_inner", "platform_upper_inner", "tip_inner"), FootState.POINTE),
        (("platform_under_inner", "tip_inner"), FootState.DEMI_POINTE),
    ],
)
@pytest.mark.parametrize("side", ["left", "right"])
def test_what_a_foot_stands_on(loaded: tuple[str, ...], state: FootState, side: str) -> None:
    forces = np.zeros((len(NAMES), 3))
    for part in loaded:
        forces[NAMES.index(f"{side}_{part}"), 2] = 50.0
    states = foot_states(SHOD, forces)
    other = "right" if side == "left" else "left"
    assert states == {side: state, other: FootState.AIR}
    feet = ground_forces(SHOD, forces)
    assert feet[0 if side == "left" else 1, 2] == 50.0 * len(loaded)
    assert feet[:, 2].sum() == forces[:, 2].sum()


@pytest.mark.parametrize(
    ("pose", "left", "right"),
    [
        (FIRST, "flat", "flat"),
        (RETIRE, "flat", "air"),
        (ARABESQUE_DEMI, "demi-pointe", "air"),
        (DEVANT_POINTE, "pointe", "air"),
    ],
)
def test_a_standing_dancer_in_columns(pose: str, left: str, right: str) -> None:
    recording = standing(pose)
    columns = balance_table(recording).columns
    assert tuple(columns) == tuple(COLUMNS)
    assert all(len(column) == len(recording.time) for column in columns.values())
    settled = slice(100, None)
    assert set(columns["left_foot"][settled]) == {left}
    assert set(columns["right_foot"][settled]) == {right}
    assert not columns["airborne"].any()
    weight = recording.model.body_mass.sum() * 9.81
    numbers = {
        name: np.asarray(column, dtype=float)
        for name, column in columns.items()
        if name not in ("left_foot", "right_foot")
    }
    total = numbers["left_force_z"] + numbers["right_force_z"]
    np.testing.assert_allclose(total[settled], weight, rtol=0.01)
    for axis in "xy":
        place = numbers[f"com_{axis}"][settled]
        np.testing.assert_allclose(numbers[f"cop_{axis}"][settled], place, atol=2e-3)
        np.testing.assert_allclose(numbers[f"zmp_{axis}"][settled], place, atol=2e-3)
        np.testing.assert_allclose(numbers[f"xcom_{axis}"][settled], place, atol=1e-3)
    assert 0.0 < numbers["penetration"][settled].max() < 1e-3
    figures = measure(recording)
    np.testing.assert_allclose(numbers["com_margin"], figures.margin, atol=1e-4)
    assert numbers["support_area"][settled].min() > 1e-3


def test_a_table_reads_back(tmp_path: Path) -> None:
    table = balance_table(standing(RETIRE))
    table.save(tmp_path / "balance.csv")
    with (tmp_path / "balance.csv").open(newline="", encoding="utf-8") as file:
        rows = list(csv.reader(file))
    assert [head.partition(" [")[0] for head in rows[0]] == list(COLUMNS)
    assert rows[0][1] == "com_x [m]"
    assert len(rows) == 1 + len(table.columns["time"])
    heights = np.array([float(row[3]) for row in rows[1:]])
    np.testing.assert_allclose(heights, np.asarray(table.columns["com_z"], dtype=float), rtol=1e-8)
    assert [p.name for p in tmp_path.iterdir()] == ["balance.csv"]
