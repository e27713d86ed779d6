"""The page of a movement before a rig: which joints limit, when, by how much, and what to do."""

from __future__ import annotations

from pathlib import Path

from enpointe.feasibility import Feasibility, collision_words, excess_amount
from enpointe.files import write_bytes
from enpointe.hardware.feasibility import Excess
from enpointe.motion.joint_timing import TimingKept
from enpointe.report.blocks import Block, Cell, Chart, Page, Paragraph, Row, Section, Table
from enpointe.report.effort_kept import effort_table
from enpointe.report.page import render
from enpointe.report.servo_charts import limits_chart, torque_speed_chart

__all__ = ["feasibility_page", "write_feasibility"]

_DRAWN = 6
"""Joints whose torque is drawn over their speed."""


def write_feasibility(
    found: Feasibility, out: Path, *, timing: TimingKept | None = None
) -> dict[str, Path]:
    """Write `feasibility.html`; returns its path by name.

    Args:
        found: What `feasible` returned.
        out: The folder.
        timing: What of the effort came out of a run, if there was one.

    Raises:
        EnpointeError: A folder that can't be written to.
    """
    page = render(feasibility_page(found, timing)).encode("utf-8")
    return {"feasibility": write_bytes(out / "feasibility.html", page)}


def feasibility_page(found: Feasibility, timing: TimingKept | None = None) -> Page:
    """The report of a movement before a rig."""
    assessment, rig = found.assessment, found.rig
    joints = found.limiting_joints or tuple(e.joint for e in assessment.nearest)
    colours = (
        "Each row is a joint, the most loaded at the top. White: nothing of its tightest limit is "
        "used; at the limit the blue turns red."
    )
    lines = (
        "Grey: what the servo can give at each speed, from the torque-speed line of its datasheet "
        "at the usable voltage, and the rig's limits of speed and current. The movement must stay "
        "inside: red as written, blue in the time that is enough."
    )
    sections = [
        Section("limits", "What limits", _limits(found)),
        Section("time", "When", (Chart(limits_chart(found, "limits"), colours),)),
        Section(
            "torque",
            "Torque and speed",
            (Chart(torque_speed_chart(found, joints[:_DRAWN], "torque"), lines),),
        ),
        Section("nearest", "Every joint's tightest limit", (_nearest(found),)),
        Section("heat", "Heat", (_heat(found),)),
    ]
    if timing is not None:
        sections.append(Section("effort", "What of the effort survives", (effort_table(timing),)))
    duration = assessment.demand.time[-1] - assessment.demand.time[0]
    facts = (
        ("rig", f"{rig.name}, {len(rig.servos)} servos"),
        ("supply", f"{assessment.limits[0].usable_voltage:.2f} V usable"),
        ("length", f"{duration:.2f} s as written"),
        ("support", "on a stand" if found.stand else "on its own feet"),
    )
    footer = (
        "No servo was moved: loads by inverse dynamics of the rig's body, motors by their "
        "datasheets (ROBOTIS e-manual), rotor inertia, friction and heat by estimates that "
        "docs/feasibility.md names."
    )
    title, verdict = found.motion.name, _verdict(found)
    return Page(title, verdict, found.feasible, facts, None, tuple(sections), footer)


def _verdict(found: Feasibility) -> str:
    name = found.rig.name
    if found.feasible:
        return f"The servos of {name} can dance this as it is written."
    if found.time_scale is None:
        servos = found.assessment.servo_scale
        alone = (
            ""
            if servos is None
            else f" The servos alone could follow in {servos:.3f} times its time."
        )
        return f"{name} cannot dance this in any time: {found.reasons[0]}.{alone}"
    slower = (
        f"In {found.time_scale:.3f} times its time the servos of {name} can dance this, with every "
        "proportion of rhythm and effort as it was; as written they cannot."
    )
    decisive = found.assessment.decisive
    if decisive is None:
        return slower
    return f"{slower} What decides: {found.excess_words(decisive)}."


def _limits(found: Feasibility) -> tuple[Block, ...]:
    assessment = found.assessment
    if not found.reasons:
        return (Paragraph("Nothing: all joints stay within their limits at every moment."),)
    blocks: list[Block] = [Paragraph(collision_words(c)) for c in assessment.collisions]
    rows = tuple(
        Row(
            excess.joint or "the body",
            (
                Cell(excess.kind),
                _scale(excess),
                Cell(_beyond(excess)),
                Cell(f"{found.moment(excess.time)}: {excess_amount(excess)}", excess.used),
            ),
        )
        for excess in assessment.excesses
    )
    if rows:
        heads = ("Joint", "limit", "time enough", "beyond it for", "at its worst")
        blocks.append(Table("Every limit that is broken as written", heads, rows, prose=True))
    return tuple(blocks)


def _scale(excess: Excess) -> Cell:
    if excess.time_scale is None:
        return Cell("none", broken=True)
    return Cell(f"× {excess.time_scale:.3f}", excess.time_scale)


def _beyond(excess: Excess) -> str:
    """For how long in all, and how often."""
    seconds = sum(end - start for start, end in excess.spans)
    times = f", {len(excess.spans)} times" if excess.spans[1:] else ""
    return f"{seconds:.2f} s{times}"


def _nearest(found: Feasibility) -> Table:
    rows = tuple(
        Row(
            excess.joint,
            (
                Cell(excess.kind),
                Cell(f"{100 * excess.used:.0f} %", excess.used, broken=excess.used > 1.0),
                Cell(found.moment(excess.time), excess.time),
            ),
        )
        for excess in found.assessment.nearest
    )
    return Table("As written", ("Joint", "tightest limit", "used", "at"), rows)


def _heat(found: Feasibility) -> Table:
    assessment = found.assessment
    warmth = assessment.warmth
    hottest, repeats = warmth.after(assessment.repeats), warmth.repeats()
    rows = tuple(
        Row(
            assessment.limits[i].joint,
            (
                Cell(f"{hottest[i]:.1f} °C", float(hottest[i])),
                Cell(f"{warmth.room + warmth.limit[i]:.0f} °C"),
                Cell("any number" if repeats[i] is None else str(repeats[i])),
            ),
        )
        for i in sorted(range(len(hottest)), key=lambda i: -hottest[i])
    )
    scale = found.time_scale or assessment.servo_scale or 1.0
    danced = "danced once" if assessment.repeats == 1 else f"danced {assessment.repeats} times"
    caption = f"After it was {danced} at × {scale:.2f}, from {warmth.room:.0f} °C"
    return Table(caption, ("Joint", "at the most", "shuts down at", "dances in a row"), rows)
