"""The page of a checked movement: what an animator is to mend, and at which frames."""

from __future__ import annotations

from pathlib import Path

from enpointe.checking import Check
from enpointe.files import write_bytes
from enpointe.report.blocks import Block, Cell, Chart, Page, Paragraph, Row, Section, Table
from enpointe.report.page import render
from enpointe.report.timeline import timeline_chart
from enpointe.report.words import DASH

__all__ = ["check_page", "write_check"]


def write_check(check: Check, out: Path) -> dict[str, Path]:
    """Write `report.html`; returns its path by name.

    Raises:
        EnpointeError: A folder that can't be written to.
    """
    page = render(check_page(check)).encode("utf-8")
    return {"report": write_bytes(out / "report.html", page)}


def check_page(check: Check) -> Page:
    """The report of a checked movement."""
    found, clock = check.found, check.clock
    faults = check.faults
    verdict = f"{check.answer[0].upper()}{check.answer[1:]}"
    if not (faults or found.help):
        verdict += ": the floor under the standing feet gives all that it needs"
    caption = (
        "Red below: the centre of mass, dropped to the floor, inside the support (negative is "
        "outside); grey: the zero-moment point. Filled: force, or moment over 1 m, that nothing "
        "gives."
    )
    sections = [
        Section("timeline", "Over its frames", (Chart(timeline_chart(check, "line"), caption),)),
        Section("help", "Where it is impossible" if faults else "What to soften", (_help(check),)),
        Section("flights", "In the air", (_flights(check),)),
        Section("figures", "Figures", (_figures(check),)),
    ]
    if check.warnings:
        said = tuple(Paragraph(warning) for warning in check.warnings)
        sections.append(Section("warnings", "How the file was taken", said))
    facts = (
        ("frames", f"{clock.first}–{clock.frame(found.motion.duration)}"),
        ("rate", f"{clock.rate:g} a second"),
        ("length", f"{found.motion.duration:.2f} s"),
    )
    footer = "No physics is run: the movement is looked at as it is, on the dancer's body."
    return Page(check.name, f"{verdict}.", not faults, facts, None, tuple(sections), footer)


def _help(check: Check) -> Block:
    clock = check.clock
    if not check.found.help:
        return Paragraph("Nowhere: no more than a twentieth of body weight is ever missing.")
    rows = tuple(
        Row(
            f"{clock.frame(span.start)}–{clock.frame(span.end)}",
            (
                Cell(f"{span.start:.2f}–{span.end:.2f}", span.start),
                Cell(f"{span.most:.0f} N", span.most),
                Cell(span.why),
            ),
        )
        for span in check.found.help
    )
    return Table("What is missing, and why", ("Frames", "s", "help", "why"), rows, prose=True)


def _flights(check: Check) -> Block:
    clock = check.clock
    if not check.found.flights:
        return Paragraph("Never: one foot at least is on the floor throughout.")
    free = {flight.start: flight for flight in check.found.ballistics}
    rows = []
    for flight in check.found.flights:
        held = free.get(flight.start)
        cells = (
            Cell(f"{1000 * flight.height:.0f} mm", flight.height),
            Cell(DASH) if held is None else Cell(f"{1000 * held.rise_free:.0f} mm", held.rise_free),
            Cell(DASH) if held is None else Cell(f"{held.fall:.1f} m/s²", held.fall),
            Cell(DASH) if held is None else Cell(f"{1000 * held.off_path:.0f} mm", held.off_path),
            Cell(DASH)
            if held is None
            else Cell(f"{held.momentum_change:.1f}", held.momentum_change),
        )
        rows.append(Row(f"{clock.frame(flight.start)}–{clock.frame(flight.end)}", cells))
    heads = (
        "Frames",
        "rises",
        "free fall would",
        "falls with",
        "off its path",
        "spin changes, kg m²/s",
    )
    note = "a body in the air falls with 9.8 m/s², and its angular momentum does not change"
    return Table(f"Flights; {note}", heads, tuple(rows))


def _figures(check: Check) -> Table:
    rows = tuple(Row(what, (Cell(said),)) for what, said in check.lines())
    return Table("All that was found", ("", "is"), rows, prose=True)
