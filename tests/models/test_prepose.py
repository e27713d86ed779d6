"""Our positions beside Prepose's, whose file is read where it is at hand."""

from __future__ import annotations

import importlib.util
import re
import sys
from functools import cache
from pathlib import Path
from types import ModuleType

import pytest

ANGLE = re.compile(r"rotate your (?:(left|right) )?(\w+?)s? (\d+) degrees (?:to )?(?:your )?(\w+)")
PARTS = {"upper arm": "elbow", "forearm": "wrist", "arm": "arm", "leg": "leg"}
FURTHER = {
    "arms third": 25,
    "arms fifth en avant": 20,
    "arms fourth en avant": 20,
    "pose à la seconde": 20,
}
"""Positions that Prepose has lower, and by how many degrees ours may be wider (docs/positions.md);
the others agree within 14."""


@cache
def prepose(root: Path) -> ModuleType:
    path = root / "docs" / "prepose.py"
    spec = importlib.util.spec_from_file_location("prepose", path)
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    sys.modules["prepose"] = module
    spec.loader.exec_module(module)
    return module


def poses_of(text: str) -> dict[str, list[tuple[str, ...]]]:
    """The rotations of each pose, (side, bone's end, degrees, sense), comments left out."""
    found: dict[str, list[tuple[str, ...]]] = {}
    name = ""
    for line in text.splitlines():
        code = line.split("//")[0]
        if heading := re.search(r"POSE ([\w-]+)", code):
            name = heading[1]
            found.setdefault(name, [])
        found.setdefault(name, []).extend(match.groups("") for match in ANGLE.finditer(code))
    return found


def test_the_angles_beside_ours_are_those_of_prepose(root_dir: Path, data_dir: Path) -> None:
    """Each is in the pose that is named, for the same part and by as much."""
    path = data_dir / "ballet_positions_prepose" / "ballet.app"
    if not path.is_file():
        pytest.skip("no Prepose positions beside the checkout")
    poses = poses_of(path.read_text("utf-8-sig"))
    for claim in prepose(root_dir).CLAIMS:
        rotations = poses[claim.pose]
        wanted = (PARTS[claim.bone], f"{abs(claim.degrees):g}")
        assert wanted in {(part, degrees) for _, part, degrees, _ in rotations}, claim


def test_our_positions_are_prepose_s_seen_from_the_front(root_dir: Path) -> None:
    """The same way out or in, and within what the page says of each."""
    module = prepose(root_dir)
    for claim, ours in zip(module.CLAIMS, module.measured(), strict=True):
        assert ours * claim.degrees > 0, claim
        assert abs(ours - claim.degrees) < FURTHER.get(claim.position, 14), claim
