"""Time on the wire: the arithmetic, and that the emulated bus takes it."""

from __future__ import annotations

import pytest
from dynamixel_sdk import GroupSyncRead

from enpointe.hardware.wire import BusCycle

from .rigs import Rig

# Bytes counted by hand from the packets' fields, for 20 servos, 4 bytes written and 10 read.
WRITE = 4 + 1 + 2 + 1 + 4 + 20 * (1 + 4) + 2
ASK = 4 + 1 + 2 + 1 + 4 + 20 + 2
EACH = 20 * (4 + 1 + 2 + 1 + 1 + 10 + 2)
AS_ONE = 4 + 1 + 2 + 1 + 20 * (1 + 1 + 10 + 2)


@pytest.mark.parametrize(
    ("fast", "delay", "baud", "expected"),
    [
        (False, 0, 1_000_000, 5.68e-3),
        (True, 0, 1_000_000, 4.36e-3),
        (False, 250, 1_000_000, 15.68e-3),
        (True, 250, 1_000_000, 4.86e-3),
        (False, 0, 4_000_000, 1.42e-3),
        (True, 0, 4_000_000, 1.09e-3),
        (True, 0, 57_600, 436 * 10 / 57_600),
    ],
)
def test_a_cycle_takes_the_time_of_its_bytes(
    fast: bool, delay: int, baud: int, expected: float
) -> None:
    cycle = BusCycle(20, fast=fast, return_delay=delay * 2e-6)
    assert cycle.length == WRITE + ASK + (AS_ONE if fast else EACH)
    assert cycle.duration(baud) == pytest.approx(expected, rel=1e-12)
    assert cycle.ceiling(baud) == pytest.approx(1.0 / expected, rel=1e-12)


@pytest.mark.parametrize("fast", [False, True])
@pytest.mark.parametrize(
    ("baud", "delay"),
    # At 57 600 with delays the SDK itself gives up before the last servo has spoken.
    [(57_600, 0), (1_000_000, 0), (1_000_000, 250), (3_000_000, 250), (4_000_000, 0)],
)
def test_the_emulated_bus_takes_exactly_that_time(baud: int, fast: bool, delay: int) -> None:
    codes = {57_600: 1, 1_000_000: 3, 3_000_000: 5, 4_000_000: 6}
    settings = {"Baud Rate": codes[baud], "Return Delay Time": delay}
    rig = Rig(20, settings=settings, baud=baud)
    assert rig.port.setBaudRate(baud)
    start = rig.clock.now()
    assert rig.writer([2048] * 20).txPacket() == 0
    group = GroupSyncRead(rig.port, rig.packets, 126, 10)
    for number in rig.ids:
        group.addParam(number)
    assert (group.fastSyncRead() if fast else group.txRxPacket()) == 0
    expected = BusCycle(20, fast=fast, return_delay=delay * 2e-6).duration(baud)
    assert rig.clock.now() - start == pytest.approx(expected, abs=1e-9)


def test_a_bus_without_wire_time_takes_none() -> None:
    rig = Rig(5, settings={"Return Delay Time": 250}, wire_time=False)
    assert rig.reader().txRxPacket() == 0
    assert rig.clock.now() == 0.0


def test_a_slow_adapter_holds_answers_back() -> None:
    rig = Rig(latency=0.004)
    assert rig.packets.ping(rig.port, 1) == (1020, 0, 0)
    assert rig.clock.now() == pytest.approx(0.004 + 24e-5, abs=1e-9)


def test_who_talks_while_a_servo_answers_hears_nothing_of_it() -> None:
    """Half duplex: a second request that is sent at once crosses the first one's answer."""
    rig = Rig(2)
    ping = rig.packets
    packet = bytes.fromhex("FF FF FD 00 01 03 00 01 19 4E")
    rig.port.writePort(packet)
    rig.port.writePort(packet)
    rig.wait(0.01)
    assert rig.port.getBytesAvailable() < 2 * 14
    assert ping.ping(rig.port, 2) == (1020, 0, 0)
