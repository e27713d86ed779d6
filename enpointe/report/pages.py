"""Which sections a report of each kind of dance has."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import mujoco
from PIL import Image

from enpointe.comparing import Comparison
from enpointe.models import KeyPose
from enpointe.motion import Effort, Motion
from enpointe.motion.wrist import LogisticFit, fit_logistic, wrist_profiles
from enpointe.notation import Frame, Score, Side
from enpointe.notation.writer import format_score, frame_lines
from enpointe.performing import Performance
from enpointe.posing import Poses
from enpointe.report import words
from enpointe.report.blocks import (
    Block,
    Cell,
    Chart,
    Folded,
    Gallery,
    Page,
    Paragraph,
    Picture,
    Row,
    Section,
    Stave,
    Table,
    Verbatim,
    data_uri,
)
from enpointe.report.certificates import certificate_tables, rules_sections
from enpointe.report.chart import GREY, LEFT, RIGHT
from enpointe.report.films import FilmFile
from enpointe.report.movements import Movement, danced_tempo, movements
from enpointe.report.pictures import jpeg
from enpointe.report.promises import promises_sections
from enpointe.report.shared import film_section, footer, physics_sections
from enpointe.report.wrists import MOVEMENTS_MAX, LineStyle, Series, wrist_chart

__all__ = [
    "PICTURE_WIDTH",
    "Material",
    "comparison_page",
    "performance_page",
    "poses_page",
]

PICTURE_WIDTH = 300
VARIANT_STYLES: dict[str, tuple[str, LineStyle, float, int]] = {
    "slerp": (GREY, (0.0, (6.0, 1.5, 1.0, 1.5)), 1.3, 5),
    "logistic": (RIGHT, (0.0, (4.0, 5.0)), 1.6, 4),
    "expressive": (LEFT, "-", 1.4, 3),
    "physical": ("#a9cdb8", "-", 5.0, 2),
}
"""Colour, line, width and height over the others: what lies below is wider, and shows."""
VARIANT_MEANINGS = {
    "slerp": "each joint turned along its shortest way at constant speed; no physics",
    "logistic": "the effort's timing on the direct path of the arm; no physics",
    "expressive": "the effort's timing on the ballet path, with space and wrist; no physics",
    "physical": "the expressive movement danced by a body with weight on its own feet",
}
_WRISTS = (
    "Share of the way that the wrist has gone, above, and its speed, below, against the share of "
    "the time between two key poses, as in Neagle 2005, figure 5.7; measured in the torso's frame. "
    "The dotted line is the logistic of the effort that was asked. Repeats of a movement are "
    "drawn over one another."
)


@dataclass(frozen=True, slots=True)
class Material:
    """What was drawn for a page before it is put together.

    Attributes:
        stave: SVG of the score.
        pictures: By key pose and then by view.
        views: Name of each view.
        film: The film, or None.
        warning: The line about pictures without OpenGL, or None.
    """

    stave: str
    pictures: Sequence[Sequence[Image.Image]]
    views: tuple[str, ...]
    film: FilmFile | None
    warning: str | None


def performance_page(performance: Performance, material: Material) -> Page:
    """The report of one performance."""
    text, good = words.verdict(performance)
    choreography, profiles = performance.choreography, wrist_profiles(performance.danced)
    ways = movements(choreography)
    sides: tuple[tuple[Side, str, LineStyle], ...] = (
        (Side.LEFT, LEFT, "-"),
        (Side.RIGHT, RIGHT, (0.0, (4.0, 2.0))),
    )
    series = [
        Series(
            f"{side} wrist",
            colour,
            line,
            1.5,
            tuple(p for p in profiles if p.side is side),
        )
        for side, colour, line in sides
    ]
    figures = performance.summary()
    sections = [
        Section("figures", "Figures", (words.figure_table(performance, figures),)),
        _score_section(
            choreography.score, material, tuple(choreography.key_times), choreography.tempo
        ),
        film_section(material.film, performance.measures is not None),
        _poses_section(choreography.score, choreography.key_poses, material),
        _wrist_section(ways, series, performance.effort),
        Section("effort", "Effort asked, and what came out", (_effort_table(performance),)),
        *promises_sections(figures),
        *physics_sections(performance),
        *rules_sections(performance.rules),
        _certificate_section(choreography.key_poses),
    ]
    return Page(
        choreography.score.title,
        text,
        good,
        _facts(performance),
        material.warning,
        tuple(s for s in sections if s is not None),
        footer(performance.motion.model),
    )


def comparison_page(comparison: Comparison, material: Material) -> Page:
    """The report of several performances of one score."""
    performances = comparison.performances
    first = next(iter(performances.values()))
    danced = {name: wrist_profiles(p.danced) for name, p in performances.items()}
    series = [
        Series(name, colour, line, width, danced[name], above)
        for name, (colour, line, width, above) in VARIANT_STYLES.items()
        if name in danced
    ]
    text = f"The same phrase danced {len(performances)} ways."
    goods = []
    for name, performance in performances.items():
        if performance.recording is not None:
            said, good = words.verdict(performance)
            goods.append(good)
            text += f" {name.capitalize()}: {said[0].lower()}{said[1:]}"
    text += " The other variants are without physics: they have no weight and cannot fall."
    summaries = {name: p.summary() for name, p in performances.items()}
    variants = Table(
        "How each moves",
        ("Variant", "How it moves"),
        tuple(Row(name, (Cell(VARIANT_MEANINGS.get(name, "")),)) for name in performances),
        prose=True,
    )
    sections = [
        Section("variants", "Variants", (variants,)),
        _score_section(
            first.score,
            material,
            tuple(first.choreography.key_times),
            first.choreography.tempo,
        ),
        film_section(material.film, True),
        _wrist_section(movements(first.choreography), series, first.effort),
        Section(
            "fits",
            "Speed profiles",
            (_fit_table(first.effort, {n: fit_logistic(p) for n, p in danced.items()}),),
        ),
        Section("figures", "Figures", (words.variant_table(summaries),)),
        Section("differences", "Differences", (words.difference_table(comparison.differences),)),
        _poses_section(first.score, first.choreography.key_poses, material),
        _certificate_section(first.choreography.key_poses),
    ]
    return Page(
        first.score.title,
        text,
        all(goods) if goods else None,
        _facts(first),
        material.warning,
        tuple(s for s in sections if s is not None),
        footer(first.motion.model),
    )


def poses_page(poses: Poses, material: Material, model: mujoco.MjModel) -> Page:
    """The report of key poses."""
    score = poses.score
    sections = (
        _score_section(score, material, ()),
        _poses_section(score, poses.key_poses, material),
        _certificate_section(poses.key_poses, opened=len(poses.key_poses) == 1),
    )
    return Page(
        score.title,
        f"{words.rules_sentence(poses.key_poses)} Nothing moves, and no physics is run.",
        poses.held,
        (("method", score.method), ("key poses", str(len(poses.key_poses)))),
        material.warning,
        sections,
        footer(model),
    )


def _facts(performance: Performance) -> tuple[tuple[str, str], ...]:
    score = performance.score
    return (
        ("effort", words.effort_words(performance)),
        ("tempo", f"{performance.choreography.tempo:g} pulses a minute"),
        ("metre", "/".join(str(n) for n in score.metre)),
        ("method", score.method),
    )


def _score_section(
    score: Score, material: Material, times: tuple[float, ...], tempo: float | None = None
) -> Section:
    seeks = material.film is not None and material.film.mime.startswith("video/")
    caption = "Seen from behind the dancer, as Benesh notation is; only what changes is written."
    if tempo is not None and tempo != score.tempo:
        caption += f" The tempo written is {score.tempo:g}; it is danced at {tempo:g}."
    if seeks and times:
        caption += " Select a frame to see the film there."
    stave = Stave(material.stave, caption, len(score.frames), times if seeks else ())
    text = Folded("The score as text", (Verbatim(format_score(score)),))
    return Section("stave", "Stave", (stave, text))


def _poses_section(score: Score, poses: Sequence[KeyPose], material: Material) -> Section:
    pictures = []
    for frame, pose, views in zip(score.frames, poses, material.pictures, strict=True):
        for number, (view, picture) in enumerate(zip(material.views, views, strict=True)):
            pictures.append(_picture(frame, pose, view, picture, lead=number == 0))
    views_each = len(material.views)
    gallery = Gallery(tuple(pictures), views_each if views_each > 1 else 0)
    said = Paragraph(words.rules_sentence(tuple(poses)))
    return Section("poses", "Key poses", (said, gallery))


def _picture(
    frame: Frame, pose: KeyPose, view: str, picture: Image.Image, *, lead: bool
) -> Picture:
    """A picture of a pose; its first one carries what is said of it, the others their view."""
    written = tuple(frame_lines(frame))
    size = (PICTURE_WIDTH, round(PICTURE_WIDTH * picture.height / picture.width))
    return Picture(
        data_uri("image/jpeg", jpeg(picture, PICTURE_WIDTH)),
        size,
        f"The dancer at {pose.name}, {view}: {'; '.join(written)}",
        pose.name if lead else view,
        written if lead else (),
        words.pose_verdict(pose) if lead else "",
        not pose.held,
    )


def _wrist_section(
    ways: tuple[Movement, ...], series: Sequence[Series], effort: Effort
) -> Section | None:
    svg = wrist_chart(ways, series, effort, "wrists")
    if svg is None:
        return None
    more = ""
    if len(ways) > MOVEMENTS_MAX:
        more = f" The first {MOVEMENTS_MAX} of the movements are drawn."
    return Section("wrists", "Distance and speed of the wrists", (Chart(svg, _WRISTS + more),))


def _effort_table(performance: Performance) -> Table:
    effort = performance.effort
    asked, danced = performance.asked_fit(), performance.danced_fit()
    motions: list[tuple[LogisticFit | None, Motion]] = [(asked, performance.motion)]
    columns = ["", "asked", "reference"]
    if performance.recording is not None:
        motions.append((danced, performance.danced))
        columns.append("danced")
    tempi = [danced_tempo(motion, performance.choreography) for _, motion in motions]
    times, weights, left = zip(*(_values(fit) for fit, _ in motions), strict=True)

    def row(
        head: str, asked: float | None, found: Sequence[float | None], name: str, places: int = 2
    ) -> Row:
        return Row(head, tuple(_figure(v, places) for v in (asked, *found)), name)

    return Table(
        "The logistic fitted to both wrists in all movements (Neagle 2005, eqs 5.2 and 5.4)",
        tuple(columns),
        (
            row("time b (sustained −2, sudden −4)", effort.time, times, "b"),
            row("weight x₀ (heavy 0.3, light 0.8)", effort.weight, weights, "x0"),
            row("space (indirect 0, direct 1)", effort.space, [None for _ in motions], "space"),
            row("rms of what the fit leaves", None, left, "rms"),
            row("tempo, pulses a minute", performance.choreography.tempo, tempi, "tempo", 1),
        ),
    )


def _fit_table(effort: Effort, fits: dict[str, LogisticFit | None]) -> Table:
    rows = [
        Row("asked", (_figure(effort.time), _figure(effort.weight), _figure(None)), "fit-asked")
    ]
    rows += [
        Row(
            name,
            tuple(_figure(value) for value in _values(fit)),
            f"fit-{name}",
        )
        for name, fit in fits.items()
    ]
    return Table(
        "The logistic that fits the wrists of each variant best (Neagle 2005, eqs 5.2 and 5.4)",
        ("Variant", "time b", "weight x₀", "rms of what the fit leaves"),
        tuple(rows),
    )


def _values(fit: LogisticFit | None) -> tuple[float | None, ...]:
    return (None, None, None) if fit is None else (fit.time, fit.weight, fit.rms)


def _figure(value: float | None, places: int = 2) -> Cell:
    if value is None:
        return Cell(words.DASH)
    text = f"{value:.4f}" if 0 < abs(value) < 0.1 else f"{value:.{places}f}"
    return Cell(text.replace("-", "−"), value)


def _certificate_section(poses: Sequence[KeyPose], *, opened: bool = False) -> Section:
    tables = certificate_tables(poses)
    solved = f"Solved in {sum(p.solve_ms for p in poses):.0f} ms in all."
    blocks: tuple[Block, ...] = tables
    if not opened:
        count = len(poses)
        blocks = (Folded(f"Every rule at each of {count} key poses", tables),)
    return Section("certificates", "Certificates", (Paragraph(solved), *blocks))
