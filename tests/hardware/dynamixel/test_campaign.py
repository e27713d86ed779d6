"""A few runs of the fault campaign (benchmarks/faults.py), and a witness that does not sleep."""

from __future__ import annotations

import importlib
from collections.abc import Iterator
from pathlib import Path
from types import ModuleType

import numpy as np
import pytest

from enpointe.hardware.dynamixel import CommandGate
from enpointe.hardware.dynamixel import rig as driver
from enpointe.hardware.dynamixel.gate import Passed
from enpointe.hardware.emulator import FaultKind


@pytest.fixture(scope="module")
def campaign(root_dir: Path) -> Iterator[ModuleType]:
    with pytest.MonkeyPatch.context() as patch:
        patch.syspath_prepend(str(root_dir / "benchmarks"))
        yield importlib.import_module("faults")


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(2 * len(FaultKind)))
def test_every_fault_ends_well(campaign: ModuleType, seed: int) -> None:
    assert campaign.run(seed).wrong == ()


def test_the_witness_sees_a_gate_that_lets_everything_through(
    campaign: ModuleType, monkeypatch: pytest.MonkeyPatch
) -> None:
    def through(self: CommandGate, wanted: np.ndarray, time: float) -> Passed:
        none = np.zeros(len(wanted), dtype=bool)
        self._goal = np.clip(np.nan_to_num(wanted), 0, 4095).astype(np.int64)
        return Passed(self.goal, none, none, refused=False)

    monkeypatch.setattr(CommandGate, "pass_on", through)
    wrong = campaign.run(3).wrong
    assert any("faster than" in each for each in wrong)


def test_the_witness_sees_a_rig_that_never_lets_go(
    campaign: ModuleType, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(driver, "cut_torque", lambda *args: ())
    monkeypatch.setattr(driver, "watch_bus", lambda *args: None)
    wrong = [campaign.run(seed).wrong for seed in (6, 7)]
    assert any("driven" in each for found in wrong for each in found)
