"""Rules as tables: the certificates of key poses, and each rule over a whole movement."""

from __future__ import annotations

from collections.abc import Sequence

from enpointe.models import KeyPose
from enpointe.models.certificate import RuleResult
from enpointe.motion import RuleKept
from enpointe.report.blocks import Cell, Paragraph, Row, Section, Table
from enpointe.report.words import DASH

__all__ = ["certificate_tables", "kept_table", "rules_sections"]

POSES_MAX = 10
"""Columns of one table."""


def certificate_tables(poses: Sequence[KeyPose]) -> tuple[Table, ...]:
    """Every rule of every pose, ten poses a table."""
    parts = [poses[i : i + POSES_MAX] for i in range(0, len(poses), POSES_MAX)]
    return tuple(_table(part) for part in parts)


def rules_sections(rules: Sequence[RuleKept]) -> tuple[Section, ...]:
    """The rules over a whole movement; no section where none was measured."""
    if not rules:
        return ()
    whole = sum(kept.held == 1.0 for kept in rules)
    told = Paragraph(
        f"{whole} of {len(rules)} rules hold at every moment at which they apply. They are "
        "measured fifty times a second on the movement that was to be danced, against what is "
        "asked at that moment of the way from one pose to the next. A leg on its way and a weight "
        "that passes from foot to foot have rules of their own."
    )
    return (Section("rules", "Rules over the whole movement", (told, kept_table(rules))),)


def kept_table(rules: Sequence[RuleKept]) -> Table:
    """Every rule over a whole movement: the worst of it, where, and how much of the time it held.

    Rules that do not hold all the time stand first, the least held at the top.
    """
    ordered = sorted(rules, key=lambda kept: kept.held)
    return Table(
        "Each rule over the whole movement, in between key poses too",
        ("Rule", "holds", "worst", "at", "between", "held", "applies"),
        tuple(_kept_row(kept) for kept in ordered),
    )


def _kept_row(kept: RuleKept) -> Row:
    first, last = (name.removeprefix("beat ") for name in kept.between)
    whole = kept.held == 1.0
    return Row(
        kept.rule,
        (
            Cell(_bound([kept])),
            Cell(f"{_number(kept.worst)}{_unit(kept)}", kept.worst),
            Cell(f"{kept.at:.2f} s", kept.at),
            Cell(f"beats {first} and {last}"),
            Cell("always" if whole else f"{100 * kept.held:.1f} %", kept.held, not whole),
            Cell(f"{100 * kept.applies:.0f} %", kept.applies),
        ),
    )


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


def _bound(results: Sequence[RuleResult | RuleKept]) -> str:
    """A residual holds up to its bound, a margin from its bound on."""
    return f"{'≥' if results[0].at_least else '≤'} {results[0].bound:g}{_unit(results[0])}"


def _cell(result: RuleResult | None) -> Cell:
    if result is None:
        return Cell(DASH)
    text = _number(result.value)
    return Cell(text if result.held else f"{text} broken", result.value, not result.held)


def _number(value: float) -> str:
    if abs(value) < 0.005:
        return "0"
    return f"{value:.2g}" if abs(value) < 10 else f"{value:.0f}"


def _unit(result: RuleResult | RuleKept) -> str:
    return "°" if result.unit == "deg" else f" {result.unit}"
