"""The command line: each verb a thin shell over the public function of the same name."""

from __future__ import annotations

import os
import sys
from dataclasses import asdict
from pathlib import Path
from typing import Annotated

import typer

import enpointe
from enpointe.compare_verb import compare_verb
from enpointe.console import rows
from enpointe.errors import EnpointeError
from enpointe.options import (
    BAD_INPUT,
    DONE,
    NO,
    CaptureOptions,
    ControllerName,
    ConversionOptions,
    DancerOptions,
    Effort,
    OutputOptions,
    Score,
    SeededOutputOptions,
    SpeechOptions,
    StyledDancerOptions,
    Tempo,
    find_metre,
    unbundled,
)
from enpointe.perform_verb import perform_verb
from enpointe.servo_verbs import servo_verbs

__all__ = ["app", "main"]

app = typer.Typer(
    name="enpointe",
    help="A virtual ballet dancer that obeys gravity.",
    no_args_is_help=True,
    add_completion=False,
    pretty_exceptions_enable=False,
)
app.add_typer(compare_verb)
app.add_typer(perform_verb)
app.add_typer(servo_verbs)


@app.command()
@unbundled
def pose(
    source: Annotated[
        str | None,
        typer.Argument(
            help="A position ('arms fifth en haut'), a shipped score, or a .bmn file; or, to be"
            " named, a pose (FILE.npy) or a moment of a motion (FILE.npz@SECONDS)."
        ),
    ] = None,
    *,
    names: Annotated[bool, typer.Option("--list", help="List the vocabulary.")] = False,
    dancer: StyledDancerOptions,
    output: OutputOptions,
) -> int:
    """Solve key poses; say which rules of ballet each keeps and breaks."""
    console = output.console()
    if names:
        from enpointe.notation import names as vocabulary
        from enpointe.notation import shipped_scores

        console.list([*vocabulary(), *shipped_scores()])
        return DONE
    if source is None:
        raise EnpointeError("name a position, a score or a .bmn file, or use --list")
    from enpointe.notating import is_seen, see

    if is_seen(source):
        seen = see(source, dancer=dancer.anthropometry())
        if output.json:
            console.print_json(seen.summary())
        else:
            console.print(f"{seen.name}: {seen.recognition.name}")
        return DONE if seen.recognition.named else NO
    with console.progress() as progress:
        poses = enpointe.pose(source, style=dancer.style(), dancer=dancer.anthropometry())
        folder = output.folder(source)
        files = enpointe.write_report(poses, folder, progress=progress)
    console.warn(files.warning)
    console.show(poses.summary(), files, folder)
    return DONE if poses.held else NO


@app.command()
@unbundled
def notate(
    motion: Annotated[str, typer.Argument(help="A motion file (.npz, as perform writes it).")],
    *,
    tempo: Annotated[
        float | None, typer.Option(help="Beats a minute; estimated if left out.")
    ] = None,
    metre: Annotated[str, typer.Option(help="Beats in a bar, and their note value.")] = "4/4",
    dancer: DancerOptions,
    output: OutputOptions,
) -> int:
    """Read a motion back into a score, and draw its stave."""
    console = output.console()
    notation = enpointe.notate(
        motion, tempo=tempo, metre=find_metre(metre), dancer=dancer.anthropometry()
    )
    folder = output.folder(motion)
    files = notation.save(folder, Path(motion).stem)
    if output.json:
        console.show(notation.summary(), files, folder)
    else:
        for each in notation.notated.frames:
            console.print(f"beat {each.frame.beat}: {each.recognition.name}")
        console.print(f"score: {files['score']}")
    return DONE


@app.command()
@unbundled
def check(
    source: Annotated[
        str,
        typer.Argument(
            help="A motion file of any format that convert reads, put on the dancer first; a motion"
            " or a recording of hers (.npz); a shipped score's name, or a .bmn file."
        ),
    ],
    *,
    effort: Effort = None,
    tempo: Tempo = None,
    correct: Annotated[
        bool,
        typer.Option(
            help="Also write corrected.bvh: the same movement with its weight where the feet can"
            " hold it."
        ),
    ] = False,
    capture: CaptureOptions,
    dancer: StyledDancerOptions,
    output: OutputOptions,
) -> int:
    """Look at balance and foot contact of a movement, without dancing it."""
    from enpointe.report.checks import write_check

    console = output.console()
    folder = output.folder(f"{Path(source).stem}-checked")
    with console.progress() as progress:
        found = enpointe.check(
            source,
            effort=effort,
            tempo=tempo,
            style=dancer.style(),
            dancer=dancer.anthropometry(),
            mapping=capture.mapping,
            skeleton=capture.skeleton,
            progress=progress,
        )
        files = write_check(found, folder)
        if correct:
            files["corrected"] = found.save_corrected(folder / "corrected.bvh", progress)
    if output.json:
        console.show(found.summary(), files, folder)
    else:
        console.print(rows(found.lines()))
        console.print(f"report: {files['report']}")
    return NO if found.faults else DONE


@app.command()
@unbundled
def convert(
    source: Annotated[Path, typer.Argument(metavar="IN", help="A motion file of any format.")],
    target: Annotated[Path, typer.Argument(metavar="OUT", help="Its ending names the format.")],
    *,
    conversion: ConversionOptions,
    dancer: DancerOptions,
    speech: SpeechOptions,
) -> int:
    """Write a motion file in another format, and say what that can't hold."""
    console = speech.console()
    converted = enpointe.convert(
        source, target, dancer=dancer.anthropometry(), **asdict(conversion)
    )
    if speech.json:
        console.print_json(converted.summary())
    else:
        console.print(rows(converted.lines()))
    return DONE


@app.command()
@unbundled
def sweep(
    source: Score,
    *,
    runs: Annotated[int, typer.Option(help="How many runs.")] = 40,
    disturb: Annotated[
        str | None,
        typer.Option(
            help="What is disturbed: mass, com, friction, noise, delay, push, rate, softness; each"
            " with an amount or a range if it is to be unusual (push=8,friction=0.4:1); all; none."
            " The first six if left out."
        ),
    ] = None,
    controller: Annotated[
        ControllerName, typer.Option(help="wholebody or pd.")
    ] = ControllerName.WHOLEBODY,
    effort: Effort = None,
    tempo: Tempo = None,
    processes: Annotated[
        int | None, typer.Option(help="Processes on this machine; one a processor if left out.")
    ] = None,
    cluster: Annotated[
        str | None,
        typer.Option(metavar="ADDRESS", help="Of a Dask scheduler, instead of processes here."),
    ] = None,
    factors: Annotated[
        str | None,
        typer.Option("--map", help="Two factors for the heat map, as in push_at,friction."),
    ] = None,
    at_least: Annotated[
        float, typer.Option(help="Share of runs to be completed for the answer to be yes.")
    ] = 0.95,
    dancer: StyledDancerOptions,
    output: SeededOutputOptions,
) -> int:
    """Dance a score many times, disturbed in as many ways; started again, it goes on."""
    from enpointe.report.heatmap import find_factors
    from enpointe.report.sweeps import write_sweep

    console = output.console()
    mapped = None if factors is None else find_factors(factors)
    folder = output.folder(f"{Path(source).stem}-swept")
    with console.progress() as progress:
        swept = enpointe.sweep(
            source,
            runs=runs,
            seed=output.seed,
            controller=controller.value,
            disturb=disturb,
            effort=effort,
            tempo=tempo,
            processes=processes,
            cluster=cluster,
            style=dancer.style(),
            dancer=dancer.anthropometry(),
            out=folder,
            progress=progress,
        )
        files = {**write_sweep(swept, folder, mapped), **swept.save(folder)}
    console.show(swept.summary(), files, folder)
    return DONE if swept.completed_fraction >= at_least else NO


def main() -> None:
    """Run the command line; the one place where an error becomes a line and an exit code."""
    # Before numpy is there to read it. A body's matrices are too small to be shared by threads,
    # which wait for each other at full speed.
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
    sys.exit(_run(sys.argv[1:]))


def _run(arguments: list[str]) -> int:
    try:
        code = app(args=arguments, standalone_mode=False)
    except EnpointeError as error:
        return _refuse(str(error))
    except (typer.Abort, KeyboardInterrupt):
        return _refuse("stopped")
    except BrokenPipeError:
        # Whoever read our output has gone; pointing it elsewhere keeps the exit quiet.
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return DONE
    except Exception as error:
        # Typer carries its own copy of click, whose usage errors have no importable base class.
        if callable(explain := getattr(error, "format_message", None)):
            return _refuse(explain())
        if os.environ.get("ENPOINTE_DEBUG"):
            raise
        return _refuse(
            f"a fault of ours, {type(error).__name__}: {' '.join(str(error).split())}"
            " (set ENPOINTE_DEBUG=1 and run again to see where, and please report it)"
        )
    return code if isinstance(code, int) else DONE


def _refuse(message: str) -> int:
    # With no arguments at all the help has been printed and there is nothing to add.
    if message.strip():
        print(f"enpointe: {' '.join(message.split())}", file=sys.stderr)
    return BAD_INPUT
