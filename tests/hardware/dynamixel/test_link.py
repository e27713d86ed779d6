"""Our traffic on the wire against the protocol's own examples, and the bus's one owner."""

from __future__ import annotations

import threading
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from enpointe.errors import RigError
from enpointe.hardware.control_table import control_table
from enpointe.hardware.dynamixel import PortLostError
from enpointe.hardware.dynamixel.registers import common
from enpointe.hardware.emulator import Fault, FaultKind
from enpointe.hardware.packets import Instruction, Packet, PacketReader, StatusError

from .benches import QUICK, Bench, bench, small_rig, swing

TABLE = control_table(1020)
GOAL = TABLE["Goal Position"]


def heard(made: Bench, monkeypatch: pytest.MonkeyPatch) -> list[bytes]:
    """Everything that is written to the port from now on."""
    sent: list[bytes] = []
    write = made.port.writePort

    def listening(packet: Any) -> int:
        sent.append(bytes(packet))
        return int(write(packet))

    monkeypatch.setattr(made.port, "writePort", listening)
    return sent


# E-manual, docs/en/dxl/protocol2: ping, read, write, reboot, sync read, fast sync read, sync write.
EXAMPLES = {
    "ping": "FF FF FD 00 01 03 00 01 19 4E",
    "read": "FF FF FD 00 01 07 00 02 84 00 04 00 1D 15",
    "write": "FF FF FD 00 01 09 00 03 74 00 00 02 00 00 CA 89",
    "reboot": "FF FF FD 00 01 03 00 08 2F 4E",
    "sync_read": "FF FF FD 00 FE 09 00 82 84 00 04 00 01 02 CE FA",
    "fast_sync_read": "FF FF FD 00 FE 0A 00 8A 84 00 04 00 03 07 04 20 F2",
    "sync_write": "FF FF FD 00 FE 11 00 83 74 00 04 00 01 96 00 00 00 02 AA 00 00 00 82 87",
}


@pytest.mark.parametrize("name", EXAMPLES)
def test_what_is_sent_is_the_manuals_example(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    made = bench(small_rig(7))
    sent = heard(made, monkeypatch)
    link = made.link
    ways: dict[str, Callable[[], object]] = {
        "ping": lambda: link.ping(1),
        "read": lambda: link.read(1, TABLE["Present Position"]),
        "write": lambda: link.write(1, GOAL, 512),
        "reboot": lambda: link.reboot(1),
        "sync_read": lambda: link.sync_read([1, 2], 132, 4),
        "fast_sync_read": lambda: link.fast_sync_read([3, 7, 4], 132, 4),
        "sync_write": lambda: link.sync_write(GOAL, [(1, 150), (2, 170)]),
    }
    ways[name]()
    assert sent[0].hex(" ").upper() == EXAMPLES[name]


def test_all_that_a_dance_sends_is_sound_and_of_few_kinds(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    made = bench()
    sent = heard(made, monkeypatch)
    with made.servo() as body:
        body.start(np.zeros(3))
        swing(body, 0.5)
        body.finish()
    packets: list[Packet] = []
    reader = PacketReader(strict=True)
    for data in sent:
        packets += reader.feed(data)
    assert len(packets) == len(sent)
    assert all(packet.sound for packet in packets)
    kinds = {Instruction(packet.instruction) for packet in packets}
    assert kinds == {
        Instruction.PING,
        Instruction.READ,
        Instruction.SYNC_READ,
        Instruction.FAST_SYNC_READ,
        Instruction.SYNC_WRITE,
    }


def test_answers_come_with_their_sign_and_errors() -> None:
    made = bench()
    assert made.link.ping(2) == 1020
    assert made.link.everybody() == {1: 1020, 2: 1020, 3: 1020}
    assert made.link.write(1, TABLE["Bus Watchdog"], 5) is StatusError.NONE
    assert made.link.read(1, TABLE["Homing Offset"]) == 0
    assert made.link.write(1, TABLE["Torque Enable"], 1) is StatusError.NONE
    assert made.link.write(1, TABLE["Homing Offset"], -100) is StatusError.ACCESS
    assert made.link.ping(99) is None
    assert made.link.read(99, GOAL) is None
    assert made.link.write(99, GOAL, 1) is None


def test_a_lost_answer_is_asked_for_again_so_often_and_no_more(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    made = bench(faults=[Fault(FaultKind.DROP, probability=0.5)], seed=3)
    found = [made.link.read(1, GOAL) for _ in range(60)]
    missed = found.count(None)
    assert 0 < missed < 25
    assert made.link.counts.retried > 0
    dead = bench(faults=[Fault(FaultKind.DROP)])
    sent = heard(dead, monkeypatch)
    assert dead.link.read(1, GOAL) is None
    assert len(sent) == 3


def test_bytes_that_the_sdk_would_send_bare_are_refused() -> None:
    made = bench()
    with pytest.raises(RigError, match="FF FF FD"):
        made.link.write(1, TABLE["Homing Offset"], -131_073)


def test_another_thread_is_refused() -> None:
    made, told = bench(), []

    def elsewhere() -> None:
        try:
            made.link.ping(1)
        except RigError as error:
            told.append(str(error))

    thread = threading.Thread(target=elsewhere)
    thread.start()
    thread.join()
    assert "one owner" in told[0]
    assert made.link.ping(1) == 1020


def test_a_port_that_is_gone_is_told_once_and_for_all() -> None:
    made = bench(faults=[Fault(FaultKind.UNPLUG, at=(0.0, 0.0), duration=(0.0, 0.0))])
    assert made.link.ping(1) == 1020
    gone = bench(small_rig(1), [Fault(FaultKind.UNPLUG, at=(0.01, 0.01))])
    gone.clock.sleep_until(0.02)
    for _ in range(2):
        with pytest.raises(PortLostError, match="gone"):
            gone.link.ping(1)
    assert gone.port.is_using is False


def test_models_that_share_no_address_cannot_share_a_rig() -> None:
    assert common([1020, 1220, 1060])["Goal Position"].address == 116
    assert "Goal Current" in common([1020, 1060])
    assert QUICK.watchdog == 0.1


def test_a_late_longer_answer_is_not_taken_for_a_shorter_one() -> None:
    """The SDK takes its first bytes: current and velocity would be heat and volts."""
    late = Fault(FaultKind.DELAY, (1,), duration=(0.002, 0.002), amount=0.012)
    made = bench(faults=[late])
    made.bus.servos[0].motor.current = 2.0
    assert made.link.sync_read([1], 126, 10) == {}
    data = made.link.read_bytes(1, 144, 3)
    assert data is not None
    assert list(data) == [120, 0, 25]
