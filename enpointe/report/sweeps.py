"""The page of a sweep: what was disturbed, how many runs were completed, and which were not."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from enpointe.files import write_bytes
from enpointe.report.blocks import Block, Cell, Chart, Page, Paragraph, Row, Section, Table
from enpointe.report.heatmap import heat_map_png, heat_map_svg, mapped_factors
from enpointe.report.page import render
from enpointe.report.words import DASH
from enpointe.sim.trial import Outcome
from enpointe.sweeping import Sweep

__all__ = ["sweep_page", "write_sweep"]

LISTED_MAX = 100
"""Failures in the table; all are in the file of the runs."""
_COLUMNS = (
    ("mass_error", "heavier, %", 100.0),
    ("com_forward", "CoM forward, mm", 1000.0),
    ("com_left", "CoM left, mm", 1000.0),
    ("friction", "friction", 1.0),
    ("noise", "noise", 1.0),
    ("delay", "delay, ms", 1000.0),
    ("push", "push, N s", 1.0),
    ("push_at", "at, s", 1.0),
    ("push_direction", "towards, ° left of forward", 57.29577951308232),
    ("rate", "rate, Hz", 1.0),
    ("softness", "softness, ms", 1000.0),
)


def write_sweep(sweep: Sweep, out: Path, factors: Sequence[str] | None = None) -> dict[str, Path]:
    """Write `report.html` and `heat-map.png`; returns the paths by name.

    Args:
        sweep: What `enpointe.sweep` returned.
        out: The folder; made if it isn't there.
        factors: The two that the heat map has; the first two that varied if None.

    Raises:
        EnpointeError: No such factors, or a folder that can't be written to.
    """
    mapped = mapped_factors(sweep.outcomes, factors)
    page = render(sweep_page(sweep, mapped)).encode("utf-8")
    files = {"report": write_bytes(out / "report.html", page)}
    if mapped:
        picture = heat_map_png(sweep.outcomes, mapped)
        files["heat_map"] = write_bytes(out / "heat-map.png", picture)
    return files


def sweep_page(sweep: Sweep, mapped: Sequence[str]) -> Page:
    """The report of a sweep."""
    fallen = [o for o in sweep.outcomes if not o.completed]
    low, high = sweep.completed_interval
    asked = "; ".join(sweep.disturbances.words()) or "nothing"
    verdict = (
        f"Disturbed on purpose, by {asked}. {len(sweep.outcomes) - len(fallen)} of"
        f" {len(sweep.outcomes)} runs were completed ({100 * sweep.completed_fraction:.1f} %, with"
        f" 95 % confidence between {100 * low:.1f} and {100 * high:.1f} %)."
    )
    forces = [o.root_force_max for o in sweep.outcomes if o.root_force_max is not None]
    blocks: list[Block] = [
        Paragraph(
            "The controller was not told what was changed. Apart from the push, the largest force"
            f" on the root from anything but gravity and floor was {max(forces, default=0.0):g} N."
        )
    ]
    if mapped:
        caption = "Runs completed, of those in each cell."
        blocks.append(Chart(heat_map_svg(sweep.outcomes, mapped, "map"), caption))
    sections = [Section("map", "Where she falls", tuple(blocks))]
    if fallen:
        sections.append(Section("failures", "Runs not completed", (_failures(fallen),)))
    facts = (
        ("controller", sweep.controller),
        ("dance", f"{sweep.duration:.1f} s"),
        ("runs", str(len(sweep.outcomes))),
        ("seed", str(sweep.seed)),
    )
    footer = "Every run is a line of runs.csv, the same whichever process danced it."
    return Page(sweep.title, verdict, not fallen, facts, None, tuple(sections), footer)


def _failures(fallen: Sequence[Outcome]) -> Table:
    drawn = [c for c in _COLUMNS if any(o.factors.get(c[0]) is not None for o in fallen)]
    rows = tuple(
        Row(
            f"run {outcome.run}",
            (
                _cell(outcome.fell_at, 1.0),
                *(_cell(outcome.factors.get(name), factor) for name, _, factor in drawn),
                Cell(outcome.fault or "was falling at the end"),
            ),
        )
        for outcome in fallen[:LISTED_MAX]
    )
    more = f" (the first {LISTED_MAX})" if len(fallen) > LISTED_MAX else ""
    heads = ("Run", "fell at, s", *(head for _, head, _ in drawn), "ended because she")
    return Table(f"What was drawn for each{more}", heads, rows)


def _cell(value: float | None, factor: float) -> Cell:
    if value is None:
        return Cell(DASH)
    return Cell(f"{factor * value:.3g}".replace("-", "−"), value)
