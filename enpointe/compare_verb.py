"""`enpointe compare`: one movement by several means, or on several bodies."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

import enpointe
from enpointe.captured import is_motion_file
from enpointe.options import (
    DONE,
    NO,
    Effort,
    FileOptions,
    OutputOptions,
    RigOptions,
    StyledDancerOptions,
    Tempo,
    Video,
    unbundled,
)

if TYPE_CHECKING:
    from enpointe.preparing import Progress

    Compared = enpointe.Comparison | enpointe.FileComparison | enpointe.BodyComparison

__all__ = ["compare_verb"]

compare_verb = typer.Typer()


@compare_verb.command()
@unbundled
def compare(
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
    file: FileOptions,
    rig: RigOptions,
    dancer: StyledDancerOptions,
    video: Video = True,
    output: OutputOptions,
) -> int:
    """Side by side: a score by slerp, by expression and by physics; a file and its dance; or, with
    --rig, the dancer, what a rig of servos was asked, and what it danced."""
    rig.refuse_without()
    console = output.console()
    with console.progress() as progress:
        comparison = _compared(source, effort, tempo, file, rig, dancer, progress)
        folder = output.folder(f"{Path(source).stem}-compared")
        files = enpointe.write_report(comparison, folder, video=video, progress=progress)
    console.warn(files.warning)
    console.show(comparison.summary(), files, folder)
    return DONE if comparison.completed else NO


def _compared(
    source: str,
    effort: str | None,
    tempo: float | None,
    file: FileOptions,
    rig: RigOptions,
    dancer: StyledDancerOptions,
    progress: Progress,
) -> Compared:
    if rig.rig is not None:
        file.refuse(source, "dances on a rig")
        return enpointe.compare_bodies(
            source,
            rig=rig.rig,
            port=rig.where,
            effort=effort,
            tempo=tempo,
            style=dancer.style(),
            dancer=dancer.anthropometry(),
            stand=rig.stand is not False,
            as_written=rig.as_written,
            backlash=rig.backlash,
            recording=rig.recording,
            progress=progress,
        )
    if is_motion_file(source):
        file.refuse_for_scores(source, effort=effort, tempo=tempo)
        return enpointe.compare_file(
            source,
            span=file.span,
            speed=file.rate,
            dancer=dancer.anthropometry(),
            mapping=file.mapping,
            skeleton=file.skeleton,
            progress=progress,
        )
    file.refuse(source)
    return enpointe.compare(
        enpointe.load_score(source),
        effort=effort,
        tempo=tempo,
        style=dancer.style(),
        dancer=dancer.anthropometry(),
        progress=progress,
    )
