"""What a dance under gravity promised and did not keep: its beats and its contacts."""

from __future__ import annotations

from enpointe.figures import BeatFigures, PerformanceFigures, PhysicalFigures
from enpointe.report.blocks import Cell, Paragraph, Row, Section, Table
from enpointe.report.words import DASH

__all__ = ["contacts_section", "promises_sections"]


def promises_sections(figures: PerformanceFigures) -> tuple[Section, ...]:
    """The section of beats and contacts; none for a kinematic performance."""
    if "contacts_planned" not in figures:
        return ()
    beats = figures["beats_not_kept"]
    blocks: list[Paragraph | Table] = [Paragraph(f"{_beats(figures)} {_contacts(figures)}")]
    if beats:
        blocks.append(_beats_table(beats))
    blocks += _contacts_tables(figures)
    return (Section("promises", "Beats and contacts", tuple(blocks)),)


def contacts_section(figures: PhysicalFigures) -> Section:
    """The section of contacts alone, of a movement without beats."""
    said = Paragraph(_contacts(figures))
    return Section("promises", "Contacts", (said, *_contacts_tables(figures)))


def _beats(figures: PerformanceFigures) -> str:
    late = figures["lateness_max"]
    return (
        "Every key pose was reached within 40 ms of its time"
        + (f", {1000 * late:.0f} ms at most." if late is not None else ".")
        if not figures["beats_not_kept"]
        else "Beats that were not kept are listed: reached more than 40 ms early or late, or with "
        "weight that no floor under the planned feet could hold."
    )


def _contacts(figures: PhysicalFigures) -> str:
    planned, missed = figures["contacts_planned"], len(figures["contacts_missed"])
    feet = f"The feet took weight {planned - missed} of the {planned} times that were planned"
    other = len(figures["contacts_unplanned"])
    return f"{feet}, and {other or 'never'}{' times' if other > 1 else ''} besides."


def _beats_table(beats: list[BeatFigures]) -> Table:
    rows = tuple(
        Row(
            "start" if beat["beat"] is None else f"beat {beat['beat']:g}",
            (
                Cell(f"{beat['time']:.2f} s", beat["time"]),
                _lateness(beat["late"]),
                Cell(f"{1000 * beat['outside']:.0f} mm", beat["outside"]),
            ),
            "beats_not_kept",
        )
        for beat in beats
    )
    return Table("Beats not kept", ("", "at", "late", "weight outside the feet"), rows)


def _lateness(late: float | None) -> Cell:
    return (
        Cell("never reached", broken=True) if late is None else Cell(f"{1000 * late:.0f} ms", late)
    )


def _contacts_tables(figures: PhysicalFigures) -> list[Table]:
    missed, unplanned = figures["contacts_missed"], figures["contacts_unplanned"]
    if not (missed or unplanned):
        return []
    rows = tuple(
        Row(
            f"{stance['side']} foot, {kind}",
            (
                Cell(f"{stance['start']:.2f} s", stance["start"]),
                Cell(f"{stance['end']:.2f} s", stance["end"]),
                Cell(f"{stance['force']:.0f} N" if stance["force"] else DASH, stance["force"]),
            ),
        )
        for kind, stances in (("missed", missed), ("not planned", unplanned))
        for stance in stances
    )
    return [Table("Contacts not as planned", ("", "from", "to", "force at most"), rows)]
