"""Emulated buses for the tests, with the real SDK on them."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from dynamixel_sdk import GroupSyncRead, GroupSyncWrite, PacketHandler

from enpointe.hardware import control_table, datasheet
from enpointe.hardware.emulator import (
    Bus,
    EmulatedPort,
    Fault,
    FaultRun,
    Load,
    Loads,
    Servo,
    Supply,
    VirtualClock,
)

READY = {"Baud Rate": 3, "Return Delay Time": 0}
TABLE = control_table(1020)


class Rig:
    """Servos on an emulated bus, and the SDK's packet handler on its port."""

    def __init__(
        self,
        count: int = 1,
        model: str = "XM430-W350",
        *,
        settings: dict[str, int] | None = None,
        loads: Sequence[Load] | None = None,
        faults: Sequence[Fault] = (),
        seed: int = 0,
        volts: float | None = None,
        **rest: Any,
    ) -> None:
        sheet = datasheet(model)
        chosen = {**READY, **(settings or {})}
        self.servos = [Servo(sheet, number + 1, settings=chosen) for number in range(count)]
        run = FaultRun(faults, np.random.default_rng(seed)) if faults else None
        plant = Loads(loads or [Load.of(sheet)] * count)
        supply = Supply(sheet.voltage if volts is None else volts)
        self.bus = Bus(self.servos, plant, supply=supply, faults=run, **rest)
        self.clock = VirtualClock()
        self.port = EmulatedPort(self.bus, self.clock)
        self.packets = PacketHandler(2.0)
        self.ids = range(1, count + 1)
        assert self.port.openPort()

    def write(self, name: str, value: int, servo: int = 1) -> tuple[int, int]:
        """Through the SDK; the result of the transfer and the status error."""
        register = self.servos[0].memory.table[name]
        data = list(register.encode(value))
        found = self.packets.writeTxRx(self.port, servo, register.address, register.size, data)
        return int(found[0]), int(found[1])

    def set(self, name: str, value: int, servo: int = 1) -> None:
        """Write what must be taken."""
        assert self.write(name, value, servo) == (0, 0)

    def get(self, name: str, servo: int = 1) -> int:
        """Through the SDK, with its sign."""
        register = self.servos[0].memory.table[name]
        found = self.packets.readTxRx(self.port, servo, register.address, register.size)
        assert found[1] == 0
        return register.decode(bytes(found[0]))

    def wait(self, seconds: float) -> None:
        """Let the servos live."""
        self.clock.sleep_until(self.clock.now() + seconds)
        self.bus.run_until(self.clock.now())

    def reader(self, name: str = "Present Position", size: int | None = None) -> GroupSyncRead:
        """A sync read of everybody."""
        register = TABLE[name]
        group = GroupSyncRead(self.port, self.packets, register.address, size or register.size)
        for number in self.ids:
            group.addParam(number)
        return group

    def writer(self, goals: Sequence[int]) -> GroupSyncWrite:
        """A sync write of Goal Position."""
        register = TABLE["Goal Position"]
        group = GroupSyncWrite(self.port, self.packets, register.address, register.size)
        for number, goal in zip(self.ids, goals, strict=True):
            group.addParam(number, list(register.encode(goal)))
        return group
