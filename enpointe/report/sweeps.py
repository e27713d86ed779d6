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
    ("mass_error", "heavier, %", 100.0, 1),
    ("com_forward", "CoM forward, mm", 1000.0, 1),
    ("com_left", "left, mm", 1000.0, 1),
    ("friction", "friction", 1.0, 2),
    ("noise", "noise", 1.0, 2),
    ("delay", "delay, ms", 1000.0, 1),
    ("push", "push, N s", 1.0, 1),
    ("push_at", "pushed at, s", 1.0, 2),
    ("push_direction", "towards, °", 57.29577951308232, 0),
    ("rate", "rate, Hz", 1.0, 0),
    ("softness", "softness, ms", 1000.0, 1),
)
"""Factor, its head, what its SI values are multiplied by, and decimals."""


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
        sections.append(Section("failures", "Runs not completed", (_failures(sweep.outcomes),)))
    facts = (
        ("controller", sweep.controller),
        ("dance", f"{sweep.duration:.1f} s"),
        ("runs", str(len(sweep.outcomes))),
        ("seed", str(sweep.seed)),
    )
    footer = "Every run is a line of runs.csv, the same whichever process danced it."
    return Page(sweep.title, verdict, not fallen, facts, None, tuple(sections), footer)


def _failures(outcomes: Sequence[Outcome]) -> Table:
    """The runs that failed, with the factors that were not the same in all runs."""
    fallen = [o for o in outcomes if not o.completed]
    varied = [c for c in _COLUMNS if len({o.factors.get(c[0]) for o in outcomes}) > 1]
    rows = tuple(
        Row(
            str(outcome.run),
            (
                _cell(outcome.fell_at, 1.0, 2),
                *(_cell(outcome.factors.get(name), scale, n) for name, _, scale, n in varied),
                Cell(outcome.fault or "was falling at the end"),
            ),
        )
        for outcome in fallen[:LISTED_MAX]
    )
    more = f" (the first {LISTED_MAX})" if len(fallen) > LISTED_MAX else ""
    heads = ("Run", "fell at, s", *(head for _, head, _, _ in varied), "how it ended")
    note = "forward is to the audience, and directions count to her left from there"
    return Table(f"What was drawn for each{more}; {note}", heads, rows)


def _cell(value: float | None, scale: float, places: int) -> Cell:
    if value is None:
        return Cell(DASH)
    return Cell(f"{scale * value:.{places}f}".replace("-", "−"), value)
