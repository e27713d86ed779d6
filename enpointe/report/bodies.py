"""One dance on several bodies, side by side: the dancer, the puppet, and what its servos did."""

from __future__ import annotations

import itertools
from collections.abc import Mapping
from contextlib import ExitStack
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np

from enpointe.files import write_bytes
from enpointe.motion import Motion, fit_logistic, wrist_profiles
from enpointe.preparing import Progress, silent
from enpointe.report.blocks import Block, Cell, Film, Page, Row, Section, Table, data_uri
from enpointe.report.films import FPS, FPS_SLOW, HEIGHT_SEVERAL, SMALLER, FilmFile
from enpointe.report.page import render
from enpointe.report.pictures import ASPECT, fitted_view
from enpointe.report.words import DASH
from enpointe.sim.camera import View
from enpointe.sim.render import gl_backend, open_painter
from enpointe.sim.video import can_write_mp4, film, side_by_side, write_gif, write_mp4

__all__ = ["film_bodies", "write_bodies"]

_FITTED_POSES = 40


def write_bodies(
    motions: Mapping[str, Motion], out: Path, *, video: bool = True, progress: Progress = silent
) -> dict[str, Path]:
    """Write `bodies.html`, and the film beside it; returns their paths by name.

    Args:
        motions: By caption; each of a body of its own, the first the one to compare with. What a
            rig did is `Recording.as_motion()`.
        out: The folder.
        video: Whether to paint a film.
        progress: Told how far it is.

    Raises:
        EnpointeError: A folder that can't be written to.
    """
    progress("film", 0, 1)
    reel = film_bodies(motions) if video else None
    progress("film", 1, 1)
    title = next(iter(motions.values())).name
    sections = [Section("figures", "What the wrists did", (_wrists(motions),))]
    if same := _same_bodies(motions):
        sections.append(Section("joints", "What was asked and what was done", same))
    files = {}
    if reel is not None:
        caption = (
            "At the same moments; each at the size of the picture. A rig does not feel where its "
            "trunk is: it is shown with the trunk where it began."
        )
        block = Film(data_uri(reel.mime, reel.data), reel.mime, reel.size, "The bodies", caption)
        sections.insert(0, Section("film", "Side by side", (block,)))
        files["video"] = write_bytes(out / reel.name, reel.data)
    verdict = f"The same dance on {len(motions)} bodies: {', '.join(motions)}."
    footer = "Wrists are measured in each body's own torso, so that its size does not count."
    facts = tuple((name, f"{motion.duration:.2f} s") for name, motion in motions.items())
    page = Page(title, verdict, None, facts, None, tuple(sections), footer)
    return {"bodies": write_bytes(out / "bodies.html", render(page).encode("utf-8")), **files}


def film_bodies(motions: Mapping[str, Motion]) -> FilmFile:
    """Film bodies side by side, each from the audience and as large as the others."""
    mp4, sketched = can_write_mp4(), gl_backend() is None
    height = HEIGHT_SEVERAL if mp4 and not sketched else int(SMALLER * HEIGHT_SEVERAL)
    width = round(ASPECT * height)
    fps = FPS if mp4 and not sketched else FPS_SLOW
    with ExitStack() as open_, TemporaryDirectory() as folder:
        reels = []
        for motion in motions.values():
            painter, _ = open_painter(motion.model, width, height)
            open_.enter_context(painter)
            reels.append(film(motion.time, motion.qpos, painter, _view(motion), fps))
        pictures = side_by_side(reels, list(motions))
        first = next(pictures)
        write = write_mp4 if mp4 else write_gif
        name = "bodies.mp4" if mp4 else "bodies.gif"
        data = write(Path(folder) / name, itertools.chain([first], pictures), fps).read_bytes()
    return FilmFile(name, data, "video/mp4" if mp4 else "image/gif", first.size)


def _view(motion: Motion) -> View:
    some = np.unique(np.linspace(0, len(motion.time) - 1, _FITTED_POSES).astype(int))
    return fitted_view(motion.model, list(motion.qpos[some]), View(elevation=-9.0))


def _wrists(motions: Mapping[str, Motion]) -> Table:
    rows = []
    for name, motion in motions.items():
        fit = fit_logistic(wrist_profiles(motion)) if _has_wrists(motion) else None
        numbers = (None, None, None) if fit is None else (fit.time, fit.weight, fit.rms)
        cells = tuple(
            Cell(DASH) if value is None else Cell(f"{value:.3f}", value) for value in numbers
        )
        rows.append(Row(name, cells))
    heads = ("Body", "time, b", "weight, x0", "rms")
    return Table(
        "The logistic that fits their ways best (Neagle 2005, eq. 5.2)", heads, tuple(rows)
    )


def _has_wrists(motion: Motion) -> bool:
    names = {motion.model.site(i).name for i in range(motion.model.nsite)}
    bodies = {motion.model.body(i).name for i in range(motion.model.nbody)}
    return {"left_wrist", "right_wrist"} <= names and "torso" in bodies


def _same_bodies(motions: Mapping[str, Motion]) -> tuple[Block, ...]:
    """Joint by joint, of every two that are of one body."""
    tables = []
    for (first, asked), (second, done) in itertools.combinations(motions.items(), 2):
        if asked.model.nq != done.model.nq or asked.model.njnt != done.model.njnt:
            continue
        moments = asked.time[asked.time <= done.duration]
        wanted = np.array([asked.sample(float(t))[0] for t in moments])
        came = np.array([done.sample(float(t))[0] for t in moments])
        rows = []
        for joint in range(1, asked.model.njnt):
            place = asked.model.jnt_qposadr[joint]
            error = np.degrees(came[:, place] - wanted[:, place])
            rms, most = float(np.sqrt(np.mean(error**2))), float(np.abs(error).max())
            cells = (Cell(f"{rms:.2f}°", rms), Cell(f"{most:.2f}°", most))
            rows.append((rms, Row(asked.model.joint(joint).name, cells)))
        rows.sort(key=lambda row: -row[0])
        caption = f"{second} beside {first}, at equal times"
        heads = ("Joint", "rms apart", "at the most")
        tables.append(Table(caption, heads, tuple(row for _, row in rows)))
    return tuple(tables)
