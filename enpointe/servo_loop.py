"""The loop that drives a rig, here or in a process of its own.

In real time it has a process of its own: nobody else's Python delays it there, and nothing that
happens to the program around it leaves the servos without a master. That program forwards Ctrl-C;
if it dies, the loop parks the rig.
"""

from __future__ import annotations

import contextlib
import ctypes
import gc
import multiprocessing
import signal
import sys
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from multiprocessing.connection import Connection
from types import FrameType
from typing import Any

from enpointe.controllers import Follow, Recording, perform
from enpointe.controllers.plant import Plant
from enpointe.errors import EnpointeError, RigError
from enpointe.hardware.clock import Clock, WallClock
from enpointe.hardware.dynamixel import Layout, Link, SafetyLimits, ServoRig, Statistics, StopButton
from enpointe.hardware.dynamixel.link import PATIENCE
from enpointe.hardware.dynamixel.ports import latency_timer, open_port
from enpointe.hardware.rig_file import Rig
from enpointe.motion import Motion

__all__ = ["Danced", "dance_in_own_process", "dance_on", "layout_of"]

_TIMER_SLACK = 29
"""PR_SET_TIMERSLACK of Linux's prctl: how late a sleep may end, ns."""
_END = 60.0
Progress = Callable[[float, float], None]


@dataclass(frozen=True)
class Danced:
    """What a rig did.

    Attributes:
        recording: Sample by sample.
        statistics: Of loop, bus and ending.
    """

    recording: Recording
    statistics: Statistics


def layout_of(rig: Rig, motion: Motion) -> Layout:
    """Where the rig's joints stand in the arrays of a motion of its body.

    Raises:
        RigError: The motion is of another body.
    """
    model, plant = motion.model, Plant(motion.model)
    names = [model.joint(int(joint)).name for joint in model.actuator_trnid[:, 0]]
    qpos, dofs = plant.actuated_qpos, plant.actuated_dofs
    return Layout.of(rig, names, list(qpos), list(dofs), motion.qpos[0], model.nv)


def dance_on(
    link: Link,
    rig: Rig,
    motion: Motion,
    clock: Clock,
    *,
    stop: StopButton | None = None,
    limits: SafetyLimits | None = None,
    progress: Progress | None = None,
) -> Danced:
    """Dance a motion on a bus, from the checks to the servos' rest; the link is closed after it.

    Raises:
        RigError: The rig can't begin; once it dances, what happens stands in what is returned.
    """
    follow = Follow(motion)
    layout = layout_of(rig, motion)
    with ServoRig(rig, link, layout, clock, limits=limits, stop=stop) as body:
        body.start(follow.first_pose)
        recording = perform(motion, follow, body, progress=progress)
        body.finish()
    return Danced(recording, body.statistics)


def dance_in_own_process(
    rig: Rig,
    motion: Motion,
    port: str,
    *,
    patience: float | None = None,
    progress: Progress | None = None,
) -> Danced:
    """The same on a serial port, in a process that does nothing else.

    Args:
        rig: The servos.
        motion: Of the rig's body.
        port: Its path.
        patience: ms; that of the adapter if None (see `Link`).
        progress: Told how far it is.

    Raises:
        RigError: The rig can't begin, or its process died.
    """
    context = multiprocessing.get_context("spawn")
    here, there = context.Pipe()
    process = context.Process(target=_child, args=(there, rig, motion, port, patience))
    process.start()
    there.close()
    with _forwarding(here):
        try:
            return _listen(here, progress)
        finally:
            process.join(_END)
            if process.is_alive():
                process.kill()
                process.join()
            here.close()


def _listen(pipe: Connection, progress: Progress | None) -> Danced:
    while True:
        try:
            kind, told = pipe.recv()
        except (EOFError, ConnectionError):
            raise RigError(
                "the process that drives the rig has died; its servos stop by themselves and still"
                " hold: cut their power"
            ) from None
        if kind == "progress" and progress is not None:
            progress(*told)
        elif kind == "danced":
            assert isinstance(told, Danced)
            return told
        elif kind == "refused":
            raise RigError(told)


@contextlib.contextmanager
def _forwarding(pipe: Connection) -> Iterator[None]:
    """Ctrl-C goes to the loop, which knows what to do, and does not end this program."""

    def pressed(number: int, frame: FrameType | None) -> None:
        with contextlib.suppress(OSError):
            pipe.send("stop")

    numbers = (signal.SIGINT, signal.SIGTERM)
    before: list[Any] = []
    with contextlib.suppress(ValueError):  # not the main thread: somebody else has the signals
        before = [signal.signal(number, pressed) for number in numbers]
    try:
        yield
    finally:
        for number, handler in zip(numbers, before, strict=False):
            signal.signal(number, handler)


class _RemoteStop(StopButton):
    """Pressed through a pipe, and by its breaking."""

    def __init__(self, pipe: Connection) -> None:
        super().__init__()
        self._pipe = pipe

    def look(self) -> None:
        try:
            while self._pipe.poll():
                self._pipe.recv()
                self.press()
        except (EOFError, OSError):
            if not self._presses:
                self.press("the program that began the dance has gone")


def _child(pipe: Connection, rig: Rig, motion: Motion, port: str, patience: float | None) -> None:
    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, signal.SIG_IGN)
    _make_punctual()

    def told(done: float, total: float) -> None:
        with contextlib.suppress(OSError):
            pipe.send(("progress", (done, total)))

    try:
        held = float(latency_timer(port) or PATIENCE) if patience is None else patience
        link = Link(open_port(port, rig.baud), held)
        danced = dance_on(link, rig, motion, WallClock(), stop=_RemoteStop(pipe), progress=told)
        answer: tuple[str, object] = ("danced", danced)
    except EnpointeError as error:
        answer = ("refused", str(error))
    with contextlib.suppress(OSError):
        pipe.send(answer)
    pipe.close()


def _make_punctual() -> None:
    """No collector of garbage, and sleeps that end when they should."""
    gc.collect()
    gc.freeze()
    gc.disable()
    if sys.platform == "linux":
        with contextlib.suppress(OSError, AttributeError):
            ctypes.CDLL(None).prctl(_TIMER_SLACK, 1, 0, 0, 0)
