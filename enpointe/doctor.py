"""What this machine can do: versions, OpenGL, video, serial ports, cores and threads.

`examine` looks and returns a `Diagnosis`; `diagnose` returns the same as plain data for JSON;
`as_table` dresses it for a terminal. Nothing here raises because something is missing: that a
thing is missing is the answer.
"""

from __future__ import annotations

import importlib
import importlib.metadata
import os
import platform
import re
from collections.abc import Iterator
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

from rich.console import Group, RenderableType
from rich.table import Table
from rich.text import Text

from enpointe.hardware.dynamixel.port_users import lurkers, others_on

__all__ = [
    "Diagnosis",
    "Encoder",
    "Machine",
    "OpenGL",
    "SerialPort",
    "Version",
    "as_table",
    "diagnose",
    "examine",
    "examine_rig",
]

THREAD_VARIABLES = ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS")

# The FTDI driver holds bytes back for 16 ms unless told otherwise, longer than a control period.
_SLOW_LATENCY_MS = 1

_PYTHON_FLOOR = "3.11"


@dataclass(frozen=True, slots=True)
class Version:
    """One piece of software.

    Attributes:
        name: Its name in the package index, or `python`.
        found: The version here; None where it is not installed.
        floor: The oldest version that will do; None where any will.
        needed: False for what only an extra asks for.
        ok: Whether what is found will do.
    """

    name: str
    found: str | None
    floor: str | None
    needed: bool
    ok: bool


@dataclass(frozen=True, slots=True)
class OpenGL:
    """How pictures are drawn.

    Attributes:
        backend: The `MUJOCO_GL` that works here, `egl` or `osmesa`; None for the sketch renderer.
        note: What to do where there is none.
    """

    backend: str | None
    note: str | None


@dataclass(frozen=True, slots=True)
class Encoder:
    """How moving pictures are written.

    Attributes:
        codec: `libx264`, `libvpx-vp9` or `gif`.
        container: `mp4`, `webm` or `gif`.
        note: What to install for something better.
    """

    codec: str
    container: str
    note: str | None


@dataclass(frozen=True, slots=True)
class SerialPort:
    """A port that servos could hang on.

    Attributes:
        device: Its path.
        description: What the adapter calls itself; empty where it doesn't say.
        latency_ms: The FTDI latency timer in milliseconds; None where the port has none.
        usable: Whether this user may read and write it.
        in_use: Which other programs have it open and how to end them; None where none are seen.
        note: What to do about it.
    """

    device: str
    description: str
    latency_ms: int | None
    usable: bool
    in_use: str | None
    note: str | None


@dataclass(frozen=True, slots=True)
class Machine:
    """The computer.

    Attributes:
        system: Operating system and processor.
        cores: Cores that this process may use.
        memory: Memory in bytes; None where the system doesn't say.
        memory_available: What of it is free to use, in bytes; None where the system doesn't say.
        threads: The thread variables that are set, by name.
        note: What the thread settings mean for long runs.
    """

    system: str
    cores: int
    memory: int | None
    memory_available: int | None
    threads: dict[str, str]
    note: str | None


@dataclass(frozen=True, slots=True)
class Diagnosis:
    """All of it, and `advice`: one line for each thing that somebody could mend."""

    versions: tuple[Version, ...]
    opengl: OpenGL
    encoder: Encoder
    ports: tuple[SerialPort, ...]
    machine: Machine
    advice: tuple[str, ...]


def diagnose() -> dict[str, Any]:
    """Looks at this machine and returns what `examine` does, as data that JSON can hold."""
    found = asdict(examine())
    return {key: list(value) if isinstance(value, tuple) else value for key, value in found.items()}


def examine() -> Diagnosis:
    """Looks at this machine. Takes seconds: OpenGL is tried in processes of its own."""
    versions = tuple(_versions())
    opengl = _opengl()
    encoder = _encoder()
    ports = tuple(_serial_ports(Path("/sys")))
    machine = _machine()
    advice = [_mend(version) for version in versions if version.needed and not version.ok]
    notes = (opengl.note, encoder.note, *(port.note for port in ports), machine.note)
    advice += [note for note in notes if note is not None]
    if ports:
        advice += lurkers()
    return Diagnosis(versions, opengl, encoder, ports, machine, tuple(advice))


def examine_rig(rig: str, port: str) -> list[str]:
    """What keeps a rig from moving: the checks that come before every dance, and nothing moves.

    Args:
        rig: A shipped rig's name, or a TOML file.
        port: The serial port that it is on.

    Returns:
        One line for each finding, with what to do about it.

    Raises:
        EnpointeError: There is no such rig or port.
    """
    from enpointe.hardware.dynamixel import Link, check_rig, open_port
    from enpointe.hardware.rig_file import load_rig

    described = load_rig(rig)
    link = Link(open_port(port, described.baud))
    try:
        return [str(finding) for finding in check_rig(described, link)]
    finally:
        link.close()


def as_table(diagnosis: Diagnosis, findings: list[str] | None = None) -> RenderableType:
    """Dresses a diagnosis for a terminal, by rich; and what was found of a rig, if it was asked."""
    software = Table("software", "here", "needs", title_justify="left")
    for version in diagnosis.versions:
        found = version.found or ("missing" if version.needed else "not installed (extra)")
        style = "" if version.ok else "red" if version.needed else "dim"
        floor = f"{version.floor} or newer" if version.floor else "any"
        software.add_row(version.name, Text(found, style=style), floor)

    machine = diagnosis.machine
    abilities = Table("this machine", "")
    abilities.add_row("system", machine.system)
    abilities.add_row("cores", str(machine.cores))
    abilities.add_row("memory", _gibibytes(machine.memory, machine.memory_available))
    threads = ", ".join(f"{name}={value}" for name, value in machine.threads.items())
    abilities.add_row("threads", threads or "not limited")
    abilities.add_row("pictures", diagnosis.opengl.backend or "sketch renderer")
    abilities.add_row("video", f"{diagnosis.encoder.container} ({diagnosis.encoder.codec})")
    for port in diagnosis.ports:
        latency = "" if port.latency_ms is None else f", latency timer {port.latency_ms} ms"
        # Text, because an adapter may call itself something that rich takes for markup.
        abilities.add_row("serial port", Text(f"{port.device} {port.description}{latency}"))
    if not diagnosis.ports:
        abilities.add_row("serial port", "none")
    if findings is not None:
        abilities.add_row("rig", f"{len(findings)} findings" if findings else "ready")
    advice = (*diagnosis.advice, *(findings or ()))
    return Group(software, abilities, *(Text(line) for line in advice))


def _versions() -> Iterator[Version]:
    python = platform.python_version()
    yield Version("python", python, _PYTHON_FLOOR, True, _at_least(python, _PYTHON_FLOOR))
    own = _installed("enpointe")
    yield Version("enpointe", own, None, True, own is not None)
    if own is None:
        return
    for requirement in importlib.metadata.requires("enpointe") or ():
        extra = re.search(r"extra\s*==\s*['\"](\w+)['\"]", requirement)
        if extra and extra[1] == "dev":
            continue
        name = re.split(r"[\s\[<>=!~;]", requirement, maxsplit=1)[0]
        lowest = re.search(r">=\s*([\w.]+)", requirement.split(";")[0])
        floor = lowest[1] if lowest else None
        found = _installed(name)
        yield Version(name, found, floor, extra is None, _at_least(found, floor))


def _installed(name: str) -> str | None:
    try:
        return importlib.metadata.version(name)
    except importlib.metadata.PackageNotFoundError:
        return None


def _at_least(found: str | None, floor: str | None) -> bool:
    """Compares the leading numbers of two versions: 3.10 is newer than 3.9, and 2.0 is 2.0.0."""
    if found is None:
        return False
    here, wanted = _numbers(found), _numbers(floor or "0")
    length = max(len(here), len(wanted))
    return here + [0] * (length - len(here)) >= wanted + [0] * (length - len(wanted))


def _numbers(version: str) -> list[int]:
    leading = re.match(r"\d+(?:\.\d+)*", version)
    return [int(part) for part in leading[0].split(".")] if leading else []


def _mend(version: Version) -> str:
    if version.name == "python":
        return f"Python {version.found} is too old: install {version.floor} or newer"
    if version.name == "enpointe":
        return "enpointe is not installed, so what it needs is unknown: run make setup"
    wanted = f"{version.name}>={version.floor}" if version.floor else version.name
    state = f"{version.found} is too old" if version.found else "is missing"
    return f"{version.name} {state}: pip install '{wanted}'"


def _opengl() -> OpenGL:
    # Here and not above: the doctor must answer where mujoco itself can't be imported.
    try:
        from enpointe.sim.render import NO_OPENGL, gl_backend
    except ImportError as problem:
        return OpenGL(None, f"no renderer: {' '.join(str(problem).split())}")
    backend = gl_backend()
    return OpenGL(backend, None if backend else NO_OPENGL)


def _encoder() -> Encoder:
    try:
        av = importlib.import_module("av")
    except ImportError:
        return Encoder("gif", "gif", "no video encoder, GIF instead: pip install 'enpointe[video]'")
    for codec, container in (("libx264", "mp4"), ("libvpx-vp9", "webm")):
        try:
            av.codec.Codec(codec, "w")
        except ValueError:
            continue
        return Encoder(codec, container, None)
    return Encoder("gif", "gif", "this av has neither H.264 nor VP9, GIF instead: upgrade av")


def _serial_ports(system: Path) -> Iterator[SerialPort]:
    """The serial ports, with latency timers as the kernel has them under `system`."""
    try:
        list_ports = importlib.import_module("serial.tools.list_ports")
    except ImportError:
        return
    for port in sorted(list_ports.comports(), key=lambda port: str(port.device)):
        timer = system / "bus" / "usb-serial" / "devices" / port.name / "latency_timer"
        latency = _read_int(timer)
        usable = os.access(port.device, os.R_OK | os.W_OK)
        in_use = others_on(port.device)
        note = in_use
        if not usable:
            note = f"{port.device}: no leave to open it; add yourself to the group that owns it"
        elif not in_use and latency is not None and latency > _SLOW_LATENCY_MS:
            note = (
                f"{port.device}: the latency timer of {latency} ms slows every read; "
                f"echo {_SLOW_LATENCY_MS} | sudo tee {timer}"
            )
        description = "" if port.description in (None, "n/a") else str(port.description)
        yield SerialPort(port.device, description, latency, usable, in_use, note)


def _read_int(path: Path) -> int | None:
    try:
        return int(path.read_text())
    except (OSError, ValueError):
        return None


def _machine() -> Machine:
    cores = _cores()
    threads = {name: os.environ[name] for name in THREAD_VARIABLES if name in os.environ}
    note = None
    if cores > 1 and not threads:
        note = (
            f"numpy may start {cores} threads in every process: "
            "set OPENBLAS_NUM_THREADS=1 where many processes run side by side"
        )
    system = f"{platform.system()} {platform.machine()}"
    return Machine(system, cores, _memory(), _memory_available(), threads, note)


def _cores() -> int:
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1


def _memory() -> int | None:
    try:
        return os.sysconf("SC_PHYS_PAGES") * os.sysconf("SC_PAGE_SIZE")
    except (AttributeError, ValueError, OSError):
        return None


def _memory_available() -> int | None:
    try:
        lines = Path("/proc/meminfo").read_text()
    except OSError:
        return None
    kibibytes = re.search(r"^MemAvailable:\s+(\d+) kB", lines, re.MULTILINE)
    return int(kibibytes[1]) * 1024 if kibibytes else None


def _gibibytes(memory: int | None, available: int | None) -> str:
    if memory is None:
        return "unknown"
    text = f"{memory / 2**30:.1f} GiB"
    return text if available is None else f"{text}, {available / 2**30:.1f} GiB of it free"
