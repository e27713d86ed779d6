"""Small rigs on emulated buses in memory, for the tests of what drives them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from enpointe.controllers.protocol import Command
from enpointe.hardware.dynamixel import Layout, Link, SafetyLimits, ServoRig, description_of
from enpointe.hardware.emulator import Bus, EmulatedPort, Fault, FaultRun, VirtualClock, bus_of
from enpointe.hardware.rig_file import Rig

QUICK = SafetyLimits(ramp=0.2, ramp_speed=3.0)


def small_rig(count: int = 3, **changed: Any) -> Rig:
    """Alike servos, IDs 1 up, half of them with a limit of current."""
    servos = [
        {
            "id": number,
            "model": "XM430-W350",
            "joint": f"joint_{number}",
            "sign": 1 if number % 2 else -1,
            "offset": 10.0 * number,
            "limits": (-60.0, 60.0),
            "speed": 120.0,
            "current": 800.0 if number % 2 else 0.0,
            "gains": (900, 0, 2000) if number % 2 else None,
        }
        for number in range(1, count + 1)
    ]
    rows = {"name": "small", "body": "puppet", "baud": 1_000_000, "rate": 100.0, "servo": servos}
    return Rig.model_validate({**rows, **changed})


@dataclass
class Bench:
    """A rig's bus, its clock and its link."""

    rig: Rig
    bus: Bus
    clock: VirtualClock
    port: EmulatedPort
    link: Link

    def servo(self, **rest: Any) -> ServoRig:
        """The rig as a body, quick on its way in and out."""
        return ServoRig(
            self.rig,
            self.link,
            Layout.bare(self.rig),
            self.clock,
            limits=rest.pop("limits", QUICK),
            **rest,
        )

    def torque(self) -> list[bool]:
        """Who holds."""
        return [servo.torque_on for servo in self.bus.servos]


def bench(
    rig: Rig | None = None,
    faults: Sequence[Fault] = (),
    *,
    settings: dict[str, int] | None = None,
    seed: int = 0,
    **rest: Any,
) -> Bench:
    """A rig on a bus, with its servos set up; `settings` are other on the first servo."""
    chosen = small_rig() if rig is None else rig
    described = description_of(chosen)
    if settings:
        first = described.servos[0]
        changed = replace(first, settings={**first.settings, **settings})
        described = replace(described, servos=(changed, *described.servos[1:]))
    described = replace(described, **rest)
    run = FaultRun(faults, np.random.default_rng(seed)) if faults else None
    bus, clock = bus_of(described, faults=run), VirtualClock()
    port = EmulatedPort(bus, clock)
    assert port.setBaudRate(chosen.baud)
    return Bench(chosen, bus, clock, port, Link(port))


def ask(position: NDArray[np.float64]) -> Command:
    """A command of positions alone."""
    none = np.zeros(len(position))
    return Command(position, none, none, none, none)


def swing(body: ServoRig, seconds: float, size: float = 0.3, pace: float = 4.0) -> None:
    """Dance a swing of all joints until its end or a fault."""
    for k in range(round(seconds / body.period)):
        if body.fault is not None:
            return
        angle = size * np.sin(pace * k * body.period)
        body.write(ask(np.full(len(body.rig.servos), angle)))
