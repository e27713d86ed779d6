"""The verbs of the command line that have to do with servos."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Annotated

import typer

from enpointe.console import Console
from enpointe.options import Json, Quiet

__all__ = ["servo_verbs"]

servo_verbs = typer.Typer()


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
