"""The doctor answers on any machine, and says what to do about what is missing."""

from __future__ import annotations

import builtins
import importlib.metadata
import json
import os
import platform
import subprocess
import sys
from collections.abc import Callable, Mapping
from io import StringIO
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st
from rich.console import Console

from enpointe import doctor
from enpointe.doctor import Diagnosis, as_table, diagnose, examine
from enpointe.sim import render

REQUIRES = [
    "mujoco>=4.0",
    "numpy>=2.0",
    "lark",
    'av>=12.3; extra == "video"',
    'pytest>=8; extra == "dev"',
]


@pytest.fixture
def installed(monkeypatch: pytest.MonkeyPatch) -> Callable[[Mapping[str, str]], None]:
    """Pretends that exactly these distributions are installed."""

    def pretend(versions: Mapping[str, str]) -> None:
        def version(name: str) -> str:
            if name not in versions:
                raise importlib.metadata.PackageNotFoundError(name)
            return versions[name]

        monkeypatch.setattr(importlib.metadata, "version", version)
        monkeypatch.setattr(importlib.metadata, "requires", lambda _name: REQUIRES)

    return pretend


@pytest.fixture
def quick_opengl(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(render, "gl_backend", lambda: "egl")


@pytest.fixture
def without(monkeypatch: pytest.MonkeyPatch) -> Callable[[str], None]:
    """Makes a package impossible to import."""
    real_module, real_import = importlib.import_module, builtins.__import__

    def hide(hidden: str) -> None:
        def refuse(name: str) -> None:
            if name == hidden or name.startswith(f"{hidden}."):
                raise ModuleNotFoundError(f"No module named {name!r}", name=name)

        def import_module(name: str, package: str | None = None) -> Any:
            refuse(name)
            return real_module(name, package)

        def import_statement(name: str, *arguments: Any, **options: Any) -> Any:
            refuse(name)
            return real_import(name, *arguments, **options)

        monkeypatch.setattr(importlib, "import_module", import_module)
        monkeypatch.setattr(builtins, "__import__", import_statement)

    return hide


def in_a_terminal(diagnosis: Diagnosis) -> str:
    page = StringIO()
    Console(file=page, width=120).print(as_table(diagnosis))
    return page.getvalue()


def test_this_machine_is_told_as_data_that_json_can_hold() -> None:
    found = diagnose()
    assert json.loads(json.dumps(found, allow_nan=False)) == found
    assert set(found) == {"versions", "opengl", "encoder", "ports", "machine", "advice"}
    assert found["opengl"]["backend"] == render.gl_backend()
    assert found["encoder"]["container"] in {"mp4", "webm", "gif"}
    assert found["machine"]["cores"] >= 1
    assert {"name": "python", "found": platform.python_version()}.items() <= found["versions"][
        0
    ].items()


@pytest.mark.usefixtures("quick_opengl")
def test_the_table_shows_every_version_and_every_piece_of_advice(
    installed: Callable[[Mapping[str, str]], None],
) -> None:
    installed({"enpointe": "0.1.0", "mujoco": "3.9.0", "numpy": "2.10.1"})
    diagnosis = examine()
    shown = in_a_terminal(diagnosis)
    for version in diagnosis.versions:
        assert version.name in shown
    for line in diagnosis.advice:
        assert line.split(":")[0] in shown
    assert "egl" in shown


@pytest.mark.usefixtures("quick_opengl")
def test_versions_are_judged_by_the_floors_that_the_package_declares(
    installed: Callable[[Mapping[str, str]], None],
) -> None:
    installed({"enpointe": "0.1.0", "mujoco": "3.9.0", "numpy": "2.10.1"})
    diagnosis = examine()
    judged = {version.name: version for version in diagnosis.versions}
    assert set(judged) == {"python", "enpointe", "mujoco", "numpy", "lark", "av"}
    assert not judged["mujoco"].ok
    assert judged["numpy"].ok
    assert judged["lark"].found is None
    assert not judged["av"].needed
    assert "mujoco 3.9.0 is too old: pip install 'mujoco>=4.0'" in diagnosis.advice
    assert "lark is missing: pip install 'lark'" in diagnosis.advice
    assert not any("pytest" in line or "'av" in line for line in diagnosis.advice)


@pytest.mark.usefixtures("quick_opengl")
def test_a_source_tree_that_is_not_installed_is_said(
    installed: Callable[[Mapping[str, str]], None],
) -> None:
    installed({})
    assert any("make setup" in line for line in examine().advice)


@given(
    a=st.lists(st.integers(0, 30), min_size=1, max_size=4),
    b=st.lists(st.integers(0, 30), min_size=1, max_size=4),
    tail=st.sampled_from(["", "rc1", ".post1", "+cpu", ".dev0"]),
)
def test_versions_compare_by_number_and_zeros_at_the_end_say_nothing(
    a: list[int], b: list[int], tail: str
) -> None:
    here, wanted = (".".join(map(str, parts)) for parts in (a, b))
    padded = [parts + [0] * (4 - len(parts)) for parts in (a, b)]
    assert doctor._at_least(here + tail, wanted) == (padded[0] >= padded[1])
    assert doctor._at_least(here + ".0", here)
    assert doctor._at_least(here, here + ".0")


def test_no_opengl_is_one_plain_line(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(render, "gl_backend", lambda: None)
    diagnosis = examine()
    assert diagnosis.opengl.backend is None
    lines = [line for line in diagnosis.advice if line.startswith("no OpenGL: apt install libegl1")]
    assert len(lines) == 1
    assert "sketch renderer" in in_a_terminal(diagnosis)


def test_a_broken_renderer_does_not_silence_the_doctor(without: Callable[[str], None]) -> None:
    without("enpointe.sim.render")
    diagnosis = examine()
    assert diagnosis.opengl.backend is None
    assert any(line.startswith("no renderer: No module named") for line in diagnosis.advice)


@pytest.mark.usefixtures("quick_opengl")
def test_without_the_video_extra_it_is_gif_and_the_extra_is_named(
    without: Callable[[str], None],
) -> None:
    without("av")
    diagnosis = examine()
    assert diagnosis.encoder.container == "gif"
    assert any("enpointe[video]" in line for line in diagnosis.advice)


@pytest.mark.parametrize(
    ("codecs", "container"),
    [({"libx264", "libvpx-vp9"}, "mp4"), ({"libvpx-vp9"}, "webm"), (set[str](), "gif")],
)
def test_the_best_encoder_in_av_is_taken(
    monkeypatch: pytest.MonkeyPatch, codecs: set[str], container: str
) -> None:
    def codec(name: str, mode: str) -> None:
        assert mode == "w"
        if name not in codecs:
            raise ValueError(name)

    av = SimpleNamespace(codec=SimpleNamespace(Codec=codec))
    monkeypatch.setitem(__import__("sys").modules, "av", av)
    assert doctor._encoder().container == container


@pytest.fixture
def plugged_in(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> Path:
    """Two adapters: one with an FTDI latency timer, one without, under a made-up /sys."""
    list_ports = pytest.importorskip("serial.tools.list_ports")
    ports = []
    for name in ("ttyUSB0", "ttyACM0"):
        (tmp_path / name).touch()
        ports.append(SimpleNamespace(device=str(tmp_path / name), name=name, description="[U2D2]"))
    timer = tmp_path / "sys" / "bus" / "usb-serial" / "devices" / "ttyUSB0" / "latency_timer"
    timer.parent.mkdir(parents=True)
    timer.write_text("16\n")
    monkeypatch.setattr(list_ports, "comports", lambda: ports)
    return timer


def ports_of(timer: Path) -> dict[str, doctor.SerialPort]:
    ports = doctor._serial_ports(timer.parents[4])
    return {Path(port.device).name: port for port in ports}


def test_a_slow_latency_timer_is_told_with_the_command_that_mends_it(plugged_in: Path) -> None:
    ports = ports_of(plugged_in)
    assert ports["ttyUSB0"].latency_ms == 16
    assert f"echo 1 | sudo tee {plugged_in}" in str(ports["ttyUSB0"].note)
    assert ports["ttyACM0"].latency_ms is None
    assert ports["ttyACM0"].note is None


@pytest.mark.parametrize(("text", "latency"), [("1\n", 1), ("not a number", None), ("", None)])
def test_a_quick_or_unreadable_latency_timer_needs_no_advice(
    plugged_in: Path, text: str, latency: int | None
) -> None:
    plugged_in.write_text(text)
    port = ports_of(plugged_in)["ttyUSB0"]
    assert port.latency_ms == latency
    assert port.note is None


def test_a_port_that_another_program_has_is_said_with_its_name(plugged_in: Path) -> None:
    """Before its latency, which can wait."""
    port = next(path for path in ports_of(plugged_in))
    device = plugged_in.parents[5] / port
    holds = "import sys; port = open(sys.argv[1]); print('open', flush=True); sys.stdin.read()"
    command = [sys.executable, "-c", holds, str(device)]
    with subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE) as program:
        assert program.stdout is not None
        assert program.stdout.readline() == b"open\n"
        found = ports_of(plugged_in)[port]
        program.communicate()
    assert f"(process {program.pid})" in str(found.in_use)
    assert found.note == found.in_use
    assert ports_of(plugged_in)[port].in_use is None


def test_a_port_that_may_not_be_opened_is_said(
    plugged_in: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(os, "access", lambda _path, _mode: False)
    for port in ports_of(plugged_in).values():
        assert not port.usable
        assert "no leave to open" in str(port.note)


@pytest.mark.usefixtures("quick_opengl", "plugged_in")
def test_what_an_adapter_calls_itself_is_shown_letter_by_letter() -> None:
    assert "[U2D2]" in in_a_terminal(examine())


def test_thread_pools_are_mentioned_only_where_nothing_limits_them(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    for name in doctor.THREAD_VARIABLES:
        monkeypatch.delenv(name, raising=False)
    monkeypatch.setattr(doctor, "_cores", lambda: 8)
    assert "8 threads" in str(doctor._machine().note)
    monkeypatch.setenv("OMP_NUM_THREADS", "1")
    limited = doctor._machine()
    assert limited.note is None
    assert limited.threads == {"OMP_NUM_THREADS": "1"}
