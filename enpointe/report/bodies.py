"""One dance on several bodies, side by side: the dancer, what a rig was asked, what it danced."""

from __future__ import annotations

from contextlib import ExitStack
from pathlib import Path
from tempfile import TemporaryDirectory

from enpointe.comparing_bodies import DANCER, BodyComparison
from enpointe.figures import BodyFigures, ServoFigures
from enpointe.preparing import Progress
from enpointe.report.blocks import (
    Block,
    Cell,
    Chart,
    Film,
    Page,
    Row,
    Section,
    Table,
    data_uri,
)
from enpointe.report.effort_kept import effort_table
from enpointe.report.facing import in_front_of, seen_from
from enpointe.report.films import HALL, FilmFile, FilmSize, counter, some_poses
from enpointe.report.pictures import fitted_view
from enpointe.report.tracking import tracking_chart, worst_joints
from enpointe.report.words import DASH
from enpointe.sim.render import open_painter
from enpointe.sim.video import film, side_by_side

__all__ = ["draw_bodies"]

_DRAWN = 6
"""Joints of which there is a curve."""


def draw_bodies(
    shown: BodyComparison, video: bool, progress: Progress
) -> tuple[dict[str, tuple[str, bytes]], Page, str | None]:
    """The files beside the page by name, the page, and the warning about pictures."""
    figures = shown.summary()
    sections = [
        Section("figures", "What the arms did", (*_arms(figures["bodies"]), _apart(shown))),
        Section("effort", "What of the effort survives the servos", (effort_table(shown.timing),)),
        Section("joints", "What was asked of each joint, and what it did", _joints(shown)),
    ]
    if figures["servos"] is not None:
        sections.append(Section("bus", "Loop and bus", (_bus(figures["servos"]),)))
    parts: dict[str, tuple[str, bytes]] = {}
    warning = None
    if video:
        reel, warning = _film(shown, progress)
        caption = (
            f"At the same moments, each at the size of the picture. {seen_from(shown.asked)} What "
            "hangs on a stand, or does not feel where its trunk is, is shown with the trunk where "
            "it began."
        )
        block = Film(data_uri(reel.mime, reel.data), reel.mime, reel.size, "The bodies", caption)
        sections.insert(0, Section("film", "Side by side", (block,)))
        parts["video"] = (reel.name, reel.data)
    footer = (
        "Arms are measured from the shoulder, in each body's own torso and its own arm lengths, so "
        "that its size does not count."
    )
    page = Page(
        shown.asked.name,
        _verdict(shown),
        shown.completed,
        _facts(shown),
        warning,
        tuple(sections),
        footer,
    )
    return parts, page, warning


def _verdict(shown: BodyComparison) -> str:
    rig = shown.rig.name
    if shown.fault is not None:
        return f"{rig} stopped before the end: {shown.fault}."
    rms = next(each.joint_rms_deg for each in shown.gestures if each.first != DANCER)
    done = f"{rig} danced this to the end, its joints {rms:.2f}° from what was asked (rms)"
    if shown.time_scale is None or abs(shown.time_scale - 1.0) < 5e-4:
        return f"{done}, in the dancer's time." if shown.dancer is not None else f"{done}."
    return (
        f"{done}, in {shown.time_scale:.3f} times the dancer's time: she is shown as much slower."
    )


def _facts(shown: BodyComparison) -> tuple[tuple[str, str], ...]:
    performance = shown.performance
    stage = "a recording" if performance is None else performance.stage
    return (
        ("rig", f"{shown.rig.name}, {len(shown.rig.servos)} servos"),
        ("on", stage),
        ("danced", f"{shown.danced.duration:.2f} s of {shown.asked.duration:.2f} s"),
    )


def _film(shown: BodyComparison, progress: Progress) -> tuple[FilmFile, str | None]:
    """Bodies side by side, each as large as the others."""
    motions, front = shown.motions, in_front_of(shown.asked, HALL)
    size = FilmSize.of([motion.duration for motion in motions.values()])
    count = counter(motions.values(), size.fps, progress)
    with ExitStack() as open_, TemporaryDirectory() as folder:
        reels, warning = [], None
        for motion in motions.values():
            painter, warning = open_painter(motion.model, size.width, size.height)
            open_.enter_context(painter)
            view = fitted_view(motion.model, some_poses(motion), front)
            reels.append(film(motion.time, motion.qpos, painter, view, size.fps, progress=count))
        pictures = side_by_side(reels, list(motions))
        return size.write(Path(folder), pictures), warning


def _arms(bodies: dict[str, BodyFigures]) -> tuple[Table, ...]:
    rows = []
    for name, figures in bodies.items():
        fit = figures["logistic"]
        numbers = (None, None, None) if fit is None else (fit["b"], fit["x0"], fit["rms"])
        cells = tuple(
            Cell(DASH) if value is None else Cell(f"{value:.3f}", value) for value in numbers
        )
        rows.append(Row(name, cells))
    if all(figures["logistic"] is None for figures in bodies.values()):
        return ()
    heads = ("Body", "time, b", "weight, x0", "rms")
    caption = "The logistic that fits the wrists' ways best (Neagle 2005, eq. 5.2)"
    return (Table(caption, heads, tuple(rows)),)


def _apart(shown: BodyComparison) -> Table:
    rows = []
    for each in shown.gestures:
        reach, joints = each.reach_rms, each.joint_rms_deg
        cells = (
            Cell(DASH) if reach is None else Cell(f"{100 * reach:.1f} %", reach),
            Cell(DASH) if joints is None else Cell(f"{joints:.2f}°", joints),
        )
        rows.append(Row(f"{each.first} and {each.second}", cells))
    heads = ("Bodies", "wrists, of an arm's length", "joints")
    return Table("How far apart they are at equal times, rms", heads, tuple(rows))


def _joints(shown: BodyComparison) -> tuple[Block, ...]:
    errors = worst_joints(shown)
    rows = tuple(
        Row(each.joint, (Cell(f"{each.rms:.2f}°", each.rms), Cell(f"{each.most:.2f}°", each.most)))
        for each in errors
    )
    caption = f"{shown.rig.name} as danced beside as asked, at equal times; the worst at the top"
    drawn = [each.joint for each in errors[:_DRAWN]]
    curves = (
        "The joints that were farthest from what was asked. Left their angles, blue asked and red "
        "danced; right what lies between: while a joint moves, mostly its lag, and at rest its sag "
        "under the weight."
    )
    return (
        Chart(tracking_chart(shown.asked, shown.danced, drawn, "tracking"), curves),
        Table(caption, ("Joint", "rms apart", "at the most"), rows),
    )


def _bus(figures: ServoFigures) -> Table:
    def row(what: str, text: str, value: float | None = None) -> Row:
        return Row(what, (Cell(text, value),))

    faults = figures["faults"]
    rows = [
        row("rate, achieved", f"{figures['achieved_hz']:.1f} Hz", figures["achieved_hz"]),
        row("rate that the wires allow", f"{figures['bus_ceiling_hz']:.0f} Hz"),
        row("deadlines missed", f"{figures['deadline_misses']}"),
        row("answers lost", f"{100 * figures['frame_loss']:.2f} %", figures["frame_loss"]),
        row("left", figures["ending"]),
        row("faults", "; ".join(faults) if faults else "none"),
    ]
    if (off := figures["root_off_max"]) is not None:
        rows.append(row("root off its place, at most", f"{1000 * off:.1f} mm", off))
    return Table("As the loop and the bus saw it", ("", ""), tuple(rows), prose=True)
