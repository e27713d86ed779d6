"""The report of a motion file that was danced: what of it, what not, and what came of it."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from PIL import Image

from enpointe.comparing import Difference
from enpointe.comparing_file import FileComparison
from enpointe.performing_file import FilePerformance
from enpointe.preparing import Progress
from enpointe.report import words
from enpointe.report.blocks import (
    Cell,
    Gallery,
    Page,
    Paragraph,
    Picture,
    Row,
    Section,
    Table,
    data_uri,
)
from enpointe.report.facing import in_front_of, seen_from
from enpointe.report.films import HALL, film_of
from enpointe.report.pages import PICTURE_WIDTH
from enpointe.report.pictures import contact_sheet, fitted_view, jpeg, stills
from enpointe.report.promises import contacts_section
from enpointe.report.shared import film_section, footer, physics_sections
from enpointe.sim.camera import View

__all__ = ["draw_file"]

MOMENTS = 6
"""Moments of which there are pictures."""


def draw_file(
    shown: FilePerformance | FileComparison, video: bool, progress: Progress
) -> tuple[dict[str, tuple[str, bytes]], Page, str | None]:
    """The files beside the page by name, the page, and the warning about pictures."""
    if isinstance(shown, FileComparison):
        dance, filmed, apart = shown.physical, shown.performances, shown.differences
    else:
        dance, filmed, apart = shown, {"": shown}, ()
    times = np.linspace(0.0, dance.danced.duration, MOMENTS)
    asked = [dance.captured.motion.sample(dance.eased.source_time(float(t)))[0] for t in times]
    danced = [dance.danced.sample(float(t))[0] for t in times]
    model = dance.motion.model
    progress("pictures", 0, 1)
    front = in_front_of(dance.motion, View.three_quarter())
    view = fitted_view(model, [*asked, *danced], front, follow=True)
    drawn, warning = stills(model, [*asked, *danced], [view])
    progress("pictures", 1, 1)
    pairs = [[drawn[i][0], drawn[i + MOMENTS][0]] for i in range(MOMENTS)]
    film = film_of(filmed, progress, in_front_of(dance.motion, HALL)) if video else None
    titles = [_moment(dance, float(t)) for t in times]
    sheet = contact_sheet(pairs, titles, [("left the file, right danced", False)] * MOMENTS)
    parts = {"moments": ("moments.png", sheet)}
    if film is not None:
        parts["video"] = (film.name, film.data)
    figures = dance.summary()
    sections = [
        Section("figures", "Figures", (words.figure_table(dance, figures),)),
        _spans_section(dance),
        film_section(film, dance.recording is not None, seen_from(dance.motion)),
        _moments_section(pairs, titles),
        _differences_section(apart) if apart else None,
        *((contacts_section(figures),) if dance.recording is not None else ()),
        *physics_sections(dance),
    ]
    if dance.captured.warnings:
        said = tuple(Paragraph(line) for line in dance.captured.warnings)
        sections.append(Section("warnings", "How the file was taken", said))
    page = Page(
        dance.captured.path.name,
        dance.verdict,
        None if dance.recording is None else dance.completed,
        _facts(dance),
        warning,
        tuple(section for section in sections if section is not None),
        footer(model),
    )
    return parts, page, warning


def _differences_section(apart: Sequence[Difference]) -> Section:
    table = words.difference_table(apart)
    meaning = Paragraph(
        "The file as it is drawn, on the dancer and at the same clock, beside what she danced."
    )
    return Section("differences", "The file and the dance", (meaning, table))


def _facts(dance: FilePerformance) -> tuple[tuple[str, str], ...]:
    captured = dance.captured
    return (
        ("frames", f"{captured.clock.first}–{captured.clock.frame(captured.motion.duration)}"),
        ("rate", f"{captured.clock.rate:g} a second"),
        ("length", f"{captured.motion.duration:.2f} s"),
        ("controller", dance.controller),
    )


def _moment(dance: FilePerformance, t: float) -> str:
    shown = dance.eased.source_time(t)
    return f"frame {dance.captured.clock.frame(shown)}, {shown:.2f} s"


def _spans_section(dance: FilePerformance) -> Section:
    parts = [(dance.stretch, "danced")]
    parts += [(each, "could be danced: choose it with --span") for each in dance.others]
    rows = [(each.start, each.end, said) for each, said in parts]
    rows += [(each.start, each.end, f"not danced: {each.why}") for each in dance.obstacles]
    table = Table(
        "The file in parts",
        ("Frames", "s", ""),
        tuple(
            Row(
                f"{dance.captured.clock.frame(start)}–{dance.captured.clock.frame(end)}",
                (Cell(f"{start:.2f}–{end:.2f}", start), Cell(said)),
            )
            for start, end, said in sorted(rows)
        ),
        prose=True,
    )
    ends = Paragraph(
        "A body on its own feet starts from standing. Where the file is under way at an end of "
        "what is danced, the same way through the same poses is begun from rest and brought to "
        "rest: the first and the last half second take a second each, with half a second of "
        "standing."
    )
    led = Paragraph(
        "A capture is put on the dancer's body, and its weight led to where the standing feet can "
        "hold it; the dancer's own motions go as scores do."
    )
    return Section("parts", "What of the file is danced", (table, ends, led))


def _moments_section(pairs: list[list[Image.Image]], titles: list[str]) -> Section:
    pictures = []
    for title, pair in zip(titles, pairs, strict=True):
        for picture, what in zip(pair, ("the file", "danced"), strict=True):
            size = (PICTURE_WIDTH, round(PICTURE_WIDTH * picture.height / picture.width))
            pictures.append(
                Picture(
                    data_uri("image/jpeg", jpeg(picture, PICTURE_WIDTH)),
                    size,
                    f"The dancer at {title}: {what}",
                    f"{title}: {what}",
                    (),
                    "",
                )
            )
    return Section("moments", "The file beside the dance", (Gallery(tuple(pictures), 4),))
