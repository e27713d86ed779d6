"""`enpointe perform`: a score or a motion file, danced."""

from __future__ import annotations

from enum import StrEnum
from pathlib import Path
from typing import Annotated

import typer

import enpointe
from enpointe.captured import is_motion_file
from enpointe.console import rows
from enpointe.options import (
    DONE,
    NO,
    ControllerName,
    Effort,
    FileOptions,
    OutputOptions,
    StyledDancerOptions,
    Tempo,
    Video,
    unbundled,
)

__all__ = ["perform_verb"]

perform_verb = typer.Typer()


class BodyName(StrEnum):
    DANCER = "dancer"


@perform_verb.command()
@unbundled
def perform(
    source: Annotated[
        str,
        typer.Argument(
            help="A shipped score's name, a .bmn file, or a motion file of any format that convert"
            " reads."
        ),
    ],
    *,
    effort: Effort = None,
    tempo: Tempo = None,
    controller: Annotated[
        ControllerName | None,
        typer.Option(
            help="pd dances under gravity on two feet; wholebody balances on one as well; kinematic"
            " only moves. pd for scores and wholebody for motion files if left out."
        ),
    ] = None,
    hold: Annotated[
        float | None,
        typer.Option(
            help="Hold the last pose for so many seconds; INPUT may then be a single pose, named as"
            " for `enpointe pose`."
        ),
    ] = None,
    body: Annotated[BodyName, typer.Option(help="Who dances.")] = BodyName.DANCER,
    file: FileOptions,
    dancer: StyledDancerOptions,
    video: Video = True,
    output: OutputOptions,
) -> int:
    """Dance a score or a motion file under gravity, and write a report of it."""
    if is_motion_file(source):
        file.refuse_for_scores(source, effort=effort, tempo=tempo, hold=hold)
        chosen = controller or ControllerName.WHOLEBODY
        return _perform_file(source, chosen, file, dancer, video, output)
    file.refuse(source)
    from enpointe.posing import find_score
    from enpointe.sim.render import look_for_opengl

    console = output.console()
    with console.progress() as progress:
        score = enpointe.load_score(source) if hold is None else find_score(source)
        look_for_opengl()
        dance = enpointe.perform(
            score,
            effort=effort,
            tempo=tempo,
            controller=(controller or ControllerName.PD).value,
            hold=hold,
            style=dancer.style(),
            dancer=dancer.anthropometry(),
            progress=progress,
        )
        folder = output.folder(source)
        report = enpointe.write_report(dance, folder, video=video, progress=progress)
        files = {**report, **dance.save(folder)}
    console.warn(report.warning)
    console.show(dance.summary(), files, folder)
    return DONE if dance.completed and not dance.broken else NO


def _perform_file(
    source: str,
    controller: ControllerName,
    file: FileOptions,
    dancer: StyledDancerOptions,
    video: bool,
    output: OutputOptions,
) -> int:
    console = output.console()
    with console.progress() as progress:
        dance = enpointe.perform_file(
            source,
            span=file.span,
            speed=file.rate,
            controller=controller.value,
            dancer=dancer.anthropometry(),
            mapping=file.mapping,
            skeleton=file.skeleton,
            progress=progress,
        )
        folder = output.folder(f"{Path(source).stem}-danced")
        report = enpointe.write_report(dance, folder, video=video, progress=progress)
        files = {**report, **dance.save(folder)}
    console.warn(report.warning)
    if output.json:
        console.show(dance.summary(), files, folder)
    else:
        console.print(rows(dance.lines()))
        console.print(f"report: {files['report']}")
    return DONE if dance.completed else NO
