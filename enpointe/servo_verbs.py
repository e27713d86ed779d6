"""The verbs of the command line that have to do with servos."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from enpointe.console import Console, rows
from enpointe.errors import RigError
from enpointe.files import refuse_unwritable
from enpointe.options import (
    Effort,
    Json,
    OutputOptions,
    Quiet,
    SpeechOptions,
    StyledDancerOptions,
    Tempo,
    unbundled,
)

if TYPE_CHECKING:
    from enpointe.feasibility import Feasibility

__all__ = ["servo_verbs"]

servo_verbs = typer.Typer()

RigFile = Annotated[str, typer.Option("--rig", help="puppet, op3, or a TOML file of yours.")]


@servo_verbs.command("servo")
@unbundled
def servo(
    source: Annotated[
        str,
        typer.Argument(
            help="A shipped score's name, a .bmn file, a motion or recording (.npz) of the dancer"
            " or of the rig's own body, or a motion file of any format that convert reads."
        ),
    ],
    *,
    rig: RigFile = "puppet",
    port: Annotated[
        str,
        typer.Option(
            help="A serial port; emulated for a bus in a process of its own; memory for one with a"
            " clock of its own, the same bit for bit each time; simulated for that with the rig's"
            " body behind it, on a stand or, with --free, on its own feet."
        ),
    ] = "emulated",
    effort: Effort = None,
    tempo: Tempo = None,
    baud: Annotated[int | None, typer.Option(help="bit/s; the rig file's if left out.")] = None,
    rate: Annotated[float | None, typer.Option(help="Hz; the rig file's if left out.")] = None,
    stand: Annotated[
        bool, typer.Option("--stand/--free", help="The puppet hangs on a stand, or must balance.")
    ] = True,
    dry_run: Annotated[
        bool, typer.Option("--dry-run", help="Say whether the rig can dance it, and dance nothing.")
    ] = False,
    as_written: Annotated[
        bool, typer.Option("--as-written", help="Don't slow down what servos can't follow.")
    ] = False,
    faults: Annotated[
        Path | None, typer.Option(help="What goes wrong on an emulated bus, in TOML.")
    ] = None,
    backlash: Annotated[
        float,
        typer.Option(help="Degrees of play in the gears of a simulated rig; XM and XH have 0.25."),
    ] = 0.0,
    dancer: StyledDancerOptions,
    output: OutputOptions,
) -> int:
    """Dance on a rig of Dynamixel servos. Ctrl-C parks it; a second one lets go at once."""
    from enpointe.hardware.emulator import load_faults
    from enpointe.hardware.rig_file import load_rig
    from enpointe.report.feasibility import write_feasibility
    from enpointe.servoing import servo as dance
    from enpointe.servoing import would

    console = output.console()
    chosen = load_rig(rig).at(baud, rate)
    folder = output.folder(f"{Path(source).stem}-{chosen.name}")
    script = () if faults is None else load_faults(faults)
    if dry_run:
        found = would(
            source,
            chosen,
            effort=effort,
            tempo=tempo,
            style=dancer.style(),
            dancer=dancer.anthropometry(),
            stand=stand,
        )
        return _say(console, found, write_feasibility(found, folder), output)
    refuse_unwritable(folder / "recording.npz")
    with console.progress() as progress:
        danced = dance(
            source,
            rig=chosen,
            port=port,
            effort=effort,
            tempo=tempo,
            style=dancer.style(),
            dancer=dancer.anthropometry(),
            stand=stand,
            as_written=as_written,
            faults=script,
            seed=output.seed,
            backlash=backlash,
            progress=progress,
        )
        files = danced.save(folder)
        if danced.feasibility is not None:
            files |= write_feasibility(danced.feasibility, folder, timing=danced.timing)
    console.show(danced.summary(), files, folder)
    for fault in danced.statistics.faults:
        console.warn(fault)
    return 0 if danced.completed else 1


def _say(
    console: Console, found: Feasibility, files: dict[str, Path], output: OutputOptions
) -> int:
    if output.json:
        paths = {name: str(path) for name, path in files.items()}
        console.print_json({**found.summary(), "files": paths})
    else:
        console.print(rows(found.lines()))
        console.print(f"report: {files['feasibility']}")
    return 0 if found.feasible else 1


@servo_verbs.command("calibrate")
@unbundled
def calibrate(
    *,
    rig: RigFile = "puppet",
    port: Annotated[str, typer.Option(help="A serial port.")],
    out: Annotated[
        Path | None, typer.Option(help="The file to write; needed unless --set-up.")
    ] = None,
    set_up: Annotated[
        bool, typer.Option("--set-up", help="Only write the servos' settings, measure nothing.")
    ] = False,
    signs: Annotated[bool, typer.Option(help="Ask for each joint's positive way.")] = True,
    speech: SpeechOptions,
) -> int:
    """Measure how a rig's horns were put on, and write its file. All joints go limp."""
    from enpointe.hardware.calibration import Calibration
    from enpointe.hardware.dynamixel.link import Link
    from enpointe.hardware.dynamixel.ports import open_port
    from enpointe.hardware.rig_file import load_rig

    if out is None and not set_up:
        raise RigError("say with --out which file to write, or use --set-up")
    console = speech.console()
    chosen = load_rig(rig)
    link = Link(open_port(port, chosen.baud))
    try:
        wizard = Calibration(chosen, link, _asked, console.print)
        if not typer.confirm("all joints go limp now: is the puppet held?", err=True):
            return 1
        wizard.prepare()
        if out is None:
            count = wizard.set_up()
            if speech.json:
                console.print_json({"settings": count})
            else:
                console.print(f"{count} settings written")
            return 0
        wizard.measure(signs=signs)
        wizard.verify()
        findings = wizard.save(out)
    finally:
        link.close()
    if speech.json:
        console.print_json({"rig": str(out), "findings": [str(each) for each in findings]})
    else:
        console.print(f"written: {out}")
        for finding in findings:
            console.print(str(finding))
    return 1 if findings else 0


def _asked(line: str) -> None:
    typer.prompt(f"{line}; then press Enter", default="", show_default=False, err=True)


@servo_verbs.command("fake-bus")
def fake_bus(
    source: Annotated[
        Path | None,
        typer.Argument(help="A bus described in TOML; servos all alike if left out."),
    ] = None,
    *,
    servos: Annotated[int, typer.Option(help="How many, from ID 1.")] = 25,
    model: Annotated[str, typer.Option(help="Of the servos.")] = "XM430-W350",
    baud: Annotated[int, typer.Option(help="Of the servos, bit/s.")] = 1_000_000,
    faults: Annotated[
        Path | None, typer.Option(help="What goes wrong, a fault script in TOML.")
    ] = None,
    json: Json = False,
    quiet: Quiet = False,
    seed: Annotated[int, typer.Option(help="Seed of the faults.")] = 0,
) -> int:
    """Be a bus of Dynamixel servos on a pseudo-terminal, until Ctrl-C."""
    from enpointe.hardware.emulator import BusDescription, load_bus, load_faults
    from enpointe.hardware.emulator.terminal import serve

    console = Console(json=json, quiet=quiet)
    alike = BusDescription.alike
    bus = alike(servos, model, baud=baud) if source is None else load_bus(source)
    script = () if faults is None else load_faults(faults)

    def opened(port: str) -> None:
        ids = [servo.id for servo in bus.servos]
        if json:
            console.print_json({"port": port, "baud": bus.baud, "ids": ids})
        else:
            console.print(f"{port}: {len(ids)} servos at {bus.baud} bit/s; Ctrl-C ends it")
        sys.stdout.flush()

    serve(bus, script, seed, opened)
    return 0


@servo_verbs.command()
def doctor(
    *,
    json: Json = False,
    quiet: Quiet = False,
    port: Annotated[
        str | None, typer.Option(help="Look at the servos on this serial port as well.")
    ] = None,
    rig: RigFile = "puppet",
) -> int:
    """Say what this machine can do: OpenGL, encoder, serial ports, versions; and a rig's state."""
    from enpointe.doctor import as_table, diagnose, examine, examine_rig

    console = Console(json=json, quiet=quiet)
    findings = None if port is None else examine_rig(rig, port)
    if json:
        console.print_json({**diagnose(), "rig": findings})
    else:
        console.print(as_table(examine(), findings))
    return 1 if findings else 0
