"""The emulated bus behind a pseudo-terminal, in real time, for programs that open a serial port.

The SDK reads in a busy loop, so that the bus belongs in a process of its own: `launch` starts one,
and `enpointe fake-bus` is one.
"""

from __future__ import annotations

import contextlib
import multiprocessing
import os
import select
import signal
from collections.abc import Callable, Iterator, Sequence
from multiprocessing.connection import Connection
from types import FrameType

import numpy as np

from enpointe.errors import RigError
from enpointe.hardware.clock import Clock, WallClock
from enpointe.hardware.emulator.bus import Bus
from enpointe.hardware.emulator.description import BusDescription, bus_of
from enpointe.hardware.emulator.fault_run import FaultRun
from enpointe.hardware.emulator.faults import Fault

__all__ = ["Terminal", "launch", "serve"]

_NAP = 0.005
"""s at most between two looks, so that the servos never have much to catch up with."""
_START = 20.0
_END = 5.0


class Terminal:
    """A pseudo-terminal with a bus behind it.

    Attributes:
        path: What a program opens as its serial port.

    Raises:
        RigError: This system has no pseudo-terminals.
    """

    def __init__(self, bus: Bus, clock: Clock) -> None:
        try:
            import termios
            import tty

            self._ours, self._theirs = os.openpty()
            tty.setraw(self._theirs)
        except (ImportError, OSError) as error:
            raise RigError(f"no pseudo-terminal can be opened here: {error}") from error
        self._termios = termios
        self.path = os.ttyname(self._theirs)
        os.set_blocking(self._ours, False)
        self._bus = bus
        self._clock = clock
        self._rates = {
            getattr(termios, name): int(name[1:])
            for name in dir(termios)
            if name[0] == "B" and name[1:].isdecimal()
        }

    def serve(self, keep_on: Callable[[], bool]) -> None:
        """Be the bus until told to stop, or the adapter is unplugged by a fault."""
        while keep_on():
            now = self._clock.now()
            if self._bus.faults is not None and self._bus.faults.unplugged(now):
                return
            self._bus.run_until(now)
            self._speak(now)
            ready, _, _ = select.select([self._ours], [], [], self._rest(now))
            if ready:
                self._listen()

    def close(self) -> None:
        """Take the port away."""
        for end in (self._ours, self._theirs):
            with contextlib.suppress(OSError):
                os.close(end)

    def _rest(self, now: float) -> float:
        event = self._bus.next_event()
        return _NAP if event is None else min(max(event - now, 0.0), _NAP)

    def _listen(self) -> None:
        try:
            data = os.read(self._ours, 4096)
        except (BlockingIOError, OSError):
            return
        rate = self._rates.get(self._termios.tcgetattr(self._theirs)[5])
        if rate:
            self._bus.line.baud = rate
        self._bus.send(data, self._clock.now())

    def _speak(self, now: float) -> None:
        data = self._bus.line.take_answered(now)
        # A program that reads nothing loses what doesn't fit, as with a real adapter.
        with contextlib.suppress(BlockingIOError):
            if data:
                os.write(self._ours, data)


def serve(
    description: BusDescription,
    faults: Sequence[Fault],
    seed: int,
    opened: Callable[[str], None],
) -> None:
    """Be a bus in this process until SIGINT or SIGTERM.

    Args:
        description: Of the bus.
        faults: What goes wrong.
        seed: Of the faults.
        opened: Called with the port's path when a program may open it.

    Raises:
        RigError: The description is wrong, or there are no pseudo-terminals.
    """
    stopped = False

    def stop(number: int, frame: FrameType | None) -> None:
        nonlocal stopped
        stopped = True

    run = FaultRun(faults, np.random.default_rng(seed)) if faults else None
    bus = bus_of(description, faults=run)
    terminal = Terminal(bus, WallClock())
    signals = (signal.SIGINT, signal.SIGTERM)
    before = [signal.signal(number, stop) for number in signals]
    try:
        opened(terminal.path)
        terminal.serve(lambda: not stopped)
    finally:
        terminal.close()
        for number, handler in zip(signals, before, strict=True):
            signal.signal(number, handler)


@contextlib.contextmanager
def launch(
    description: BusDescription, faults: Sequence[Fault] = (), seed: int = 0
) -> Iterator[str]:
    """A bus in a process of its own for the length of a `with`; gives the port's path.

    Args:
        description: Of the bus.
        faults: What goes wrong.
        seed: Of the faults.

    Raises:
        RigError: It did not start; says why.
    """
    context = multiprocessing.get_context("spawn")
    here, there = context.Pipe()
    process = context.Process(target=_child, args=(there, description, tuple(faults), seed))
    process.start()
    there.close()
    try:
        if not here.poll(_START):
            raise RigError(f"the emulated bus did not start within {_START:g} s")
        started, told = here.recv()
        if not started:
            raise RigError(told)
        yield told
    finally:
        process.terminate()
        process.join(_END)
        if process.is_alive():
            process.kill()
            process.join()
        here.close()


def _child(
    pipe: Connection, description: BusDescription, faults: tuple[Fault, ...], seed: int
) -> None:
    try:
        serve(description, faults, seed, lambda path: pipe.send((True, path)))
    except RigError as error:
        pipe.send((False, str(error)))
