"""The certificates of key poses as tables: a row for each rule, a column for each pose."""

from __future__ import annotations

from collections.abc import Sequence

from enpointe.models import KeyPose
from enpointe.models.certificate import RuleResult
from enpointe.report.blocks import Cell, Row, Table
from enpointe.report.words import DASH

__all__ = ["certificate_tables"]

POSES_MAX = 10
"""Columns of one table."""


def certificate_tables(poses: Sequence[KeyPose]) -> tuple[Table, ...]:
    """Every rule of every pose, ten poses a table."""
    parts = [poses[i : i + POSES_MAX] for i in range(0, len(poses), POSES_MAX)]
    return tuple(_table(part) for part in parts)


def _table(poses: Sequence[KeyPose]) -> Table:
    by_pose = [{result.rule: result for result in pose.certificate.results} for pose in poses]
    rules = list(dict.fromkeys(rule for results in by_pose for rule in results))
    rows = []
    for rule in rules:
        found = [results.get(rule) for results in by_pose]
        some = [result for result in found if result is not None]
        rows.append(
            Row(rule, (Cell(_bound(some)), *(_cell(r) for r in found), Cell(some[0].source)))
        )
    names = [pose.name.removeprefix("beat ") if len(poses) > 1 else pose.name for pose in poses]
    beats = len(poses) > 1 and all(pose.name.startswith("beat ") for pose in poses)
    caption = "Each rule measured at each key pose" + (", columns by beat" if beats else "")
    columns = names if beats else [pose.name for pose in poses]
    return Table(caption, ("Rule", "holds", *columns, "source"), tuple(rows), prose=True)


def _bound(results: Sequence[RuleResult]) -> str:
    """A residual holds up to its bound, a margin from its bound on."""
    return f"{'≥' if results[0].at_least else '≤'} {results[0].bound:g}{_unit(results[0])}"


def _cell(result: RuleResult | None) -> Cell:
    if result is None:
        return Cell(DASH)
    small = abs(result.value) < 0.005
    text = (
        "0" if small else f"{result.value:.2g}" if abs(result.value) < 10 else f"{result.value:.0f}"
    )
    return Cell(text if result.held else f"{text} broken", result.value, not result.held)


def _unit(result: RuleResult) -> str:
    return "°" if result.unit == "deg" else f" {result.unit}"
