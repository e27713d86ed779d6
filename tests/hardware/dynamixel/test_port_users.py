"""A port that another program has open: who it is, and what ends it."""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

from enpointe.errors import RigError
from enpointe.hardware.dynamixel import open_port
from enpointe.hardware.dynamixel.port_users import lurkers, others_on, users_of
from enpointe.hardware.emulator import BusDescription, launch

if not Path("/proc/self/fd").is_dir():
    pytest.skip("only Linux lists who has a port open", allow_module_level=True)

_HOLDS = """
import fcntl, os, sys
port = os.open(sys.argv[1], os.O_RDWR | os.O_NOCTTY)
if sys.argv[2] == "locked":
    fcntl.flock(port, fcntl.LOCK_EX)
print("open", flush=True)
sys.stdin.read()
"""

Hold = Callable[[str, str], int]


@pytest.fixture
def hold() -> Iterator[Hold]:
    """Starts programs that open a port, locked or not; gives their numbers."""
    running = []

    def start(port: str, how: str) -> int:
        program = subprocess.Popen(
            [sys.executable, "-c", _HOLDS, port, how], stdin=subprocess.PIPE, stdout=subprocess.PIPE
        )
        running.append(program)
        assert program.stdout is not None
        assert program.stdout.readline() == b"open\n"
        return program.pid

    yield start
    for program in running:
        program.communicate()


@pytest.fixture
def terminal() -> Iterator[str]:
    """A real pseudo-terminal, whose other end is ours."""
    ours, theirs = os.openpty()
    yield os.ttyname(theirs)
    os.close(ours)
    os.close(theirs)


@pytest.mark.parametrize("how", ["locked", "shared"])
def test_a_busy_port_is_refused_in_one_line_that_says_what_to_do(
    how: str, hold: Hold, terminal: str
) -> None:
    process = hold(terminal, how)
    with pytest.raises(RigError) as refused:
        open_port(terminal, 1_000_000)
    line = str(refused.value)
    assert "\n" not in line
    assert terminal in line
    assert f"(process {process})" in line
    assert f"kill {process}" in line


def test_two_programs_are_both_named(hold: Hold, terminal: str) -> None:
    processes = {hold(terminal, "shared"), hold(terminal, "shared")}
    assert {user.process for user in users_of(terminal)} == processes
    assert " have " in str(others_on(terminal))


def test_a_port_is_free_again_when_its_user_ends(terminal: str) -> None:
    command = [sys.executable, "-c", _HOLDS, terminal, "locked"]
    subprocess.run(command, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, check=True)
    assert others_on(terminal) is None
    open_port(terminal, 1_000_000).closePort()


def test_who_is_the_other_end_of_a_terminal_is_no_user_of_it() -> None:
    """An emulated bus keeps its own port open; it must not be told to end."""
    with launch(BusDescription.alike(1, "XM430-W350")) as path:
        assert others_on(path) is None
        open_port(path, 1_000_000).closePort()


def made_up(folder: Path, number: int, name: str, command: bytes, port: Path | None) -> None:
    """A process as the kernel would list it."""
    (folder / str(number) / "fd").mkdir(parents=True)
    (folder / str(number) / "comm").write_text(f"{name}\n")
    (folder / str(number) / "cmdline").write_bytes(command)
    if port is not None:
        (folder / str(number) / "fd" / "7").symlink_to(port)


def test_notorious_services_are_stopped_for_good_and_not_killed(tmp_path: Path) -> None:
    """Killed, they are started again."""
    port, processes = tmp_path / "ttyUSB0", tmp_path / "proc"
    port.touch()
    made_up(processes, 812, "ModemManager", b"/usr/sbin/ModemManager\0", port)
    made_up(processes, 900, "brltty", b"/usr/bin/brltty\0--no-daemon\0", None)
    made_up(processes, 901, "bash", b"-bash\0", None)
    line = str(others_on(str(port), processes))
    assert line.startswith(f"ModemManager (process 812) has {port} open")
    assert "systemctl disable --now ModemManager" in line
    assert "kill" not in line
    told = lurkers(processes)
    assert [each.split()[0] for each in told] == ["ModemManager", "brltty"]


def test_a_long_or_odd_command_stays_one_short_line(tmp_path: Path) -> None:
    port, processes = tmp_path / "ttyUSB0", tmp_path / "proc"
    port.touch()
    made_up(processes, 5, "python3", b"/usr/bin/python3\0-c\0print(\n\x1b[31m1)" + b"x" * 500, port)
    made_up(processes, 6, "kworker", b"", port)
    first, second = users_of(str(port), processes)
    assert len(str(first)) < 80
    assert str(first).isprintable()
    assert str(second) == "kworker (process 6)"


def test_no_port_and_no_list_of_processes_is_nobody(tmp_path: Path) -> None:
    assert users_of(str(tmp_path / "none")) == ()
    (tmp_path / "port").touch()
    assert users_of(str(tmp_path / "port"), tmp_path / "proc") == ()
    assert lurkers(tmp_path / "proc") == ()
