"""Every fault of the thesis's dancer: absent in ours, as docs say, and noticed where it is made."""

from __future__ import annotations

import importlib.util
import re
import sys
from pathlib import Path
from types import ModuleType
from typing import Any

import pytest

ROOT = Path(__file__).resolve().parents[2]
if not (ROOT / "docs" / "make_faults.py").is_file():
    pytest.skip("not in a checkout", allow_module_level=True)


def load() -> ModuleType:
    spec = importlib.util.spec_from_file_location("make_faults", ROOT / "docs" / "make_faults.py")
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    sys.modules["make_faults"] = module
    spec.loader.exec_module(module)
    return module


made = load()
FAULTS = [pytest.param(f, id=f"{f.section}: {f.fault}") for f in made.FAULTS]


@pytest.mark.parametrize("fault", FAULTS)
def test_a_fault_is_cured(fault: Any) -> None:
    pose = made.solved(fault.pose, fault.real)
    assert pose.held, str(pose.certificate)
    assert fault.least <= fault.measured(pose) <= fault.most


@pytest.mark.parametrize("fault", FAULTS)
def test_a_fault_that_is_made_is_noticed(fault: Any) -> None:
    """By its rule, and where no rule answers for it by the measure."""
    wrong = made.put_wrong(fault)
    assert not wrong.held
    if fault.rule is not None:
        assert fault.rule in {result.rule for result in wrong.certificate.broken}
    else:
        measured = fault.measured(wrong)
        assert not fault.least <= measured <= fault.most


def test_the_page_has_the_figures_that_are_measured() -> None:
    """Each within what rounding and another machine's last digits move it."""
    page = (ROOT / "docs" / "faults.md").read_text(encoding="utf-8")
    rows = re.findall(r"^\| \d+ \| (.*?) \| (.*?) \|.*\*\*(.*?)(?: mm|°)\*\*", page, re.MULTILINE)
    assert [(section, fault) for section, fault, _ in rows] == [
        (f.section, f.fault) for f in made.FAULTS
    ]
    for fault, (_, _, said) in zip(made.FAULTS, rows, strict=True):
        measured = fault.measured(made.solved(fault.pose, fault.real))
        assert measured == pytest.approx(float(said), abs=2.0 if fault.unit == "mm" else 0.3)


def test_all_that_the_thesis_lists_is_there() -> None:
    """§4.5.3 a to h and §4.5.4 a to g, one by one; hands and feet stand with §4.5.2."""
    sections = " ".join(fault.section for fault in made.FAULTS)
    for letter in "abcdefgh":
        assert f"§4.5.3 {letter}" in sections
    for letter in "abcdefg":
        assert f"§4.5.4 {letter}" in sections
    for section in ("§4.5.2", "§4.7.2 c", "§4.7.2 f", "§4.7.3", "§4.8"):
        assert section in sections
