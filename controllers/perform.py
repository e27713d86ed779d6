"""The one loop: a motion, a controller and a body make a performance."""

from __future__ import annotations

from collections.abc import Callable
from time import perf_counter

import numpy as np
from numpy.typing import NDArray

from enpointe.controllers.protocol import Body, Command, Controller, State
from enpointe.controllers.recording import Recording
from enpointe.motion import Motion

__all__ = ["perform"]


def perform(
    motion: Motion,
    controller: Controller,
    body: Body,
    *,
    progress: Callable[[float, float], None] | None = None,
) -> Recording:
    """Dance a motion.

    Simulated, servo and haptic performances differ only in the body handed in. Sample k is the
    state before command k and the command itself; what the body observed while it obeyed stands in
    the channels of the same sample.

    Args:
        motion: What is danced, from its start.
        controller: What drives the body.
        body: Placed at the start of the motion.
        progress: Called with (seconds danced, seconds in all) now and then.

    Returns:
        Everything that happened, up to the fault if there was one.
    """
    tape = _Tape()
    start = perf_counter()
    state = body.read()
    controller.reset(state)
    steps = round(motion.duration / body.period) + 1
    for k in range(steps):
        command = controller.command(k * body.period, state)
        body.write(command)
        tape.add(state, command, body.observe())
        state = body.read()
        if body.fault is not None:
            break
        if progress is not None and k % 100 == 0:
            progress(k * body.period, motion.duration)
    elapsed = perf_counter() - start
    if progress is not None:
        progress(motion.duration, motion.duration)
    return tape.recording(motion, body.fault, elapsed)


class _Tape:
    def __init__(self) -> None:
        self._states: list[State] = []
        self._commands: list[Command] = []
        self._observed: dict[str, list[NDArray[np.generic]]] = {}

    def add(self, state: State, command: Command, observed: dict[str, NDArray[np.generic]]) -> None:
        self._states.append(state)
        self._commands.append(command)
        for name, value in observed.items():
            self._observed.setdefault(name, []).append(value)

    def recording(self, reference: Motion, fault: str | None, wall_time: float) -> Recording:
        states, commands = self._states, self._commands
        return Recording(
            model=reference.model,
            reference=reference,
            time=np.array([s.time for s in states]),
            qpos=np.array([s.qpos for s in states]),
            qvel=np.array([s.qvel for s in states]),
            effort=np.array([s.effort for s in states]),
            position=np.array([c.position for c in commands]),
            torque=np.array([c.torque for c in commands]),
            age=np.array([s.age for s in states]),
            valid=np.array([s.valid for s in states]),
            channels={name: np.array(rows) for name, rows in self._observed.items()},
            fault=fault,
            wall_time=wall_time,
        )
