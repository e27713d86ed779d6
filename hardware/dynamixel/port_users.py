"""Who else has a serial port open, and what to do about it.

Linux tells by the links under /proc, of one's own processes or of all to root; lsof and fuser,
which read the same, may not be installed. A bus has one owner: two programs on a port steal each
other's answers, and the kernel lets them unless one of them has locked it.
"""

from __future__ import annotations

import contextlib
import os
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path

__all__ = ["PortUser", "lurkers", "others_on", "users_of"]

_PROCESSES = Path("/proc")
_TERMINALS = range(136, 144)
"""Major numbers of pseudo-terminals: each mount has its own (Linux, admin-guide/devices.txt)."""
_LURKERS: Mapping[str, str] = {
    "ModemManager": "sudo systemctl disable --now ModemManager",
    "brltty": "sudo systemctl mask --now brltty-udev.service brltty.service",
}
"""Services that open, or take away, adapters that are not theirs; and what stops each."""
_LONGEST = 60


@dataclass(frozen=True, slots=True)
class PortUser:
    """A program that has a port open.

    Attributes:
        process: Its number.
        program: Its name, "ModemManager".
        command: How it was started, shortened.
    """

    process: int
    program: str
    command: str

    @property
    def end_it(self) -> str:
        """The command that ends it."""
        return _LURKERS.get(self.program, f"kill {self.process}")

    def __str__(self) -> str:
        return f"{self.command or self.program} (process {self.process})"


def users_of(port: str, processes: Path = _PROCESSES) -> tuple[PortUser, ...]:
    """The programs, as far as this user may look, that have a port open; not this one.

    Who is the other end of a pseudo-terminal is no user of it.

    Args:
        port: Its path; links are followed.
        processes: Where the kernel lists them.
    """
    try:
        wanted = Path(port).stat()
    except OSError:
        return ()
    return tuple(
        PortUser(number, _name(folder), _command(folder))
        for number, folder in _folders(processes)
        if number != os.getpid() and _has_open(folder, wanted, Path(port).resolve().name)
    )


def lurkers(processes: Path = _PROCESSES) -> tuple[str, ...]:
    """One line for each running service that is known to disturb serial ports, what stops it."""
    running = {_name(folder) for _, folder in _folders(processes)}
    return tuple(
        f"{name} is running, which opens serial adapters by itself: {mend}"
        for name, mend in _LURKERS.items()
        if name in running
    )


def others_on(port: str, processes: Path = _PROCESSES) -> str | None:
    """One line about the programs that have a port open and how to end them; None if none."""
    users = users_of(port, processes)
    if not users:
        return None
    names = " and ".join(map(str, users))
    have = "has" if len(users) == 1 else "have"
    mend = "; ".join(dict.fromkeys(user.end_it for user in users))
    return f"{names} {have} {port} open, and a bus has one owner; end it: {mend}"


def _folders(processes: Path) -> Iterator[tuple[int, Path]]:
    with contextlib.suppress(OSError):
        for folder in processes.iterdir():
            if folder.name.isdecimal():
                yield int(folder.name), folder


def _has_open(folder: Path, wanted: os.stat_result, name: str) -> bool:
    """Whether a process has a file open, and is not the other end of it."""
    found = False
    try:
        for link in (folder / "fd").iterdir():
            with contextlib.suppress(OSError):
                if link.readlink().name == "ptmx" and _end_of(folder, link.name) == name:
                    return False
                found = found or _same(link.stat(), wanted)
    except OSError:  # another user's, or gone
        return False
    return found


def _same(one: os.stat_result, other: os.stat_result) -> bool:
    if os.path.samestat(one, other):
        return True
    device = one.st_rdev
    return device != 0 and device == other.st_rdev and os.major(device) not in _TERMINALS


def _end_of(folder: Path, number: str) -> str | None:
    """Of which pseudo-terminal an open file is the other end."""
    for line in (folder / "fdinfo" / number).read_text().splitlines():
        key, _, value = line.partition(":")
        if key == "tty-index":
            return value.strip()
    return None


def _name(folder: Path) -> str:
    try:
        return (folder / "comm").read_text(errors="replace").strip()
    except OSError:
        return ""


def _command(folder: Path) -> str:
    try:
        words = (folder / "cmdline").read_bytes().decode(errors="replace").split("\0")
    except OSError:
        return ""
    line = " ".join([Path(words[0]).name, *words[1:]])
    line = "".join(letter if letter.isprintable() else " " for letter in line)
    line = " ".join(line.split())
    return line if len(line) <= _LONGEST else line[: _LONGEST - 1] + "…"
