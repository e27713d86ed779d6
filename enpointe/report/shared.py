"""Sections that reports of scores and of motion files share."""

from __future__ import annotations

import mujoco

import enpointe
from enpointe.danced import Danced
from enpointe.report.blocks import Chart, Film, Section, data_uri
from enpointe.report.facing import SEEN
from enpointe.report.films import FilmFile
from enpointe.report.forces import force_chart
from enpointe.report.ground import margin_chart, support_chart
from enpointe.report.joints import joint_chart, joint_rows

__all__ = ["film_section", "footer", "physics_sections"]


def film_section(film: FilmFile | None, physical: bool, seen: str = SEEN) -> Section | None:
    """The film, where there is one; `seen` says from where."""
    if film is None:
        return None
    caption = seen
    if physical:
        caption += (
            " On the floor under a dancer with weight, where the feet do not hide them: the "
            "support in blue and, in red, the place below the centre of mass."
        )
    block = Film(data_uri(film.mime, film.data), film.mime, film.size, "The dance, filmed", caption)
    return Section("film", "Film", (block,))


def physics_sections(performance: Danced) -> tuple[Section, ...]:
    """Balance, floor and joints of a dance under gravity."""
    recording, measures = performance.recording, performance.measures
    if recording is None or measures is None:
        return ()
    balance = (
        Chart(
            support_chart(recording, measures, "support"),
            "Left: the soles as they stand and the support that they span (dashed), with the paths "
            "of the centre of mass (red) and of the floor's pressure (grey). Right: the path of "
            "the centre of mass alone, larger, with the beats. The audience is at the bottom.",
        ),
        Chart(
            margin_chart(recording, measures, "margin"),
            "How far inside the edge of the support the centre of mass is (red), and the "
            "extrapolated centre of mass, where its speed is taking it (grey). While the grey line "
            "is above the edge the feet that stand can stop the fall; below it the dancer has to "
            "step or fall.",
        ),
        Chart(
            force_chart(recording, measures, "forces"),
            "What the floor gives back under each foot; together they are the body's weight when "
            "the dancer is still. Below, what each foot stands on: flat, demi-pointe, pointe or "
            "the heel alone, the stronger the higher; nothing is drawn while it is in the air.",
        ),
    )
    joints = Chart(
        joint_chart(joint_rows(recording, measures), "joints"),
        "How far each joint was behind what was asked of it, the worst at the top, and the "
        "greatest torque that it gave.",
    )
    return (
        Section("balance", "Balance and the floor", balance),
        Section("joints", "Joint by joint", (joints,)),
    )


def footer(model: mujoco.MjModel) -> str:
    """Who made the report, with what, of whom."""
    mass = float(model.body_mass.sum())
    return (
        f"Made by enpointe {enpointe.__version__} with MuJoCo {mujoco.__version__}; "
        f"the dancer weighs {mass:.1f} kg."
    )
