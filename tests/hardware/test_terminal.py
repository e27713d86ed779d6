"""The emulated bus as a serial port in a process of its own, and the command that is one."""

from __future__ import annotations

import json
import signal
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest
from dynamixel_sdk import COMM_SUCCESS, GroupSyncRead, GroupSyncWrite, PacketHandler, PortHandler

from enpointe.errors import RigError
from enpointe.hardware.emulator import BusDescription, launch

from ..front.commands import refused

pytest.importorskip("pty", reason="no pseudo-terminals here")

COUNT = 8


@pytest.fixture(scope="module")
def port() -> Iterator[PortHandler]:
    with launch(BusDescription.alike(COUNT, "XM430-W350")) as path:
        handler = PortHandler(path)
        assert handler.openPort()
        yield handler
        handler.closePort()


def persistently(attempt: object) -> int:
    """A busy machine may keep the other process from answering in time; ask again."""
    assert callable(attempt)
    result = -1
    for _ in range(20):
        if (result := attempt()) == COMM_SUCCESS:
            break
    return result


def test_the_sdk_pings_writes_and_reads_through_the_port(port: PortHandler) -> None:
    packets = PacketHandler(2.0)
    for number in range(1, COUNT + 1):
        assert persistently(lambda number=number: packets.ping(port, number)[1]) == COMM_SUCCESS
        on = lambda number=number: packets.write1ByteTxRx(port, number, 64, 1)[0]  # noqa: E731
        assert persistently(on) == COMM_SUCCESS
    write = GroupSyncWrite(port, packets, 116, 4)
    read = GroupSyncRead(port, packets, 132, 4)
    goals = {number: 2048 + 20 * number for number in range(1, COUNT + 1)}
    for number, goal in goals.items():
        write.addParam(number, list(goal.to_bytes(4, "little")))
        read.addParam(number)
    assert write.txPacket() == COMM_SUCCESS

    def arrived() -> int:
        if read.fastSyncRead() != COMM_SUCCESS or read.txRxPacket() != COMM_SUCCESS:
            return -1
        found = {number: read.getData(number, 132, 4) for number in goals}
        return int(max(abs(found[number] - goal) for number, goal in goals.items()) > 10)

    for _ in range(400):
        if arrived() == 0:
            return
    pytest.fail("the servos did not come to their goals")


def test_the_port_follows_the_hosts_baud_rate(port: PortHandler) -> None:
    packets = PacketHandler(2.0)
    assert port.setBaudRate(57_600)
    assert packets.ping(port, 1)[1] != COMM_SUCCESS
    assert port.setBaudRate(1_000_000)
    assert persistently(lambda: packets.ping(port, 1)[1]) == COMM_SUCCESS


def test_the_bus_needs_no_physics_engine() -> None:
    """It starts in a process of its own, which must not wait for one."""
    code = "import sys, enpointe.hardware.emulator; print(*{'mujoco', 'casadi'} & set(sys.modules))"
    told = subprocess.run(
        [sys.executable, "-P", "-c", code], capture_output=True, text=True, check=True
    )
    assert told.stdout.strip() == ""


def test_a_bus_that_cannot_be_built_says_so() -> None:
    with (
        pytest.raises(RigError, match="12"),
        launch(BusDescription.alike(1, "XM430-W350", baud=12)),
    ):
        pass


def test_the_command_prints_its_port_and_ends_at_ctrl_c() -> None:
    command = [sys.executable, "-P", "-m", "enpointe", "fake-bus", "--servos", "2", "--json"]
    process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    try:
        assert process.stdout is not None
        told = json.loads(process.stdout.readline())
        assert told["ids"] == [1, 2]
        assert told["baud"] == 1_000_000
        handler = PortHandler(told["port"])
        assert handler.openPort()
        assert persistently(lambda: PacketHandler(2.0).ping(handler, 2)[1]) == COMM_SUCCESS
        handler.closePort()
        process.send_signal(signal.SIGINT)
        out, err = process.communicate(timeout=30)
        assert (out, err, process.returncode) == ("", "", 0)
    finally:
        process.kill()


@pytest.mark.parametrize(
    "arguments",
    [["--servos", "0"], ["--model", "AX-12"], ["--baud", "7"], ["nothing.toml"], ["--faults", "x"]],
)
def test_what_cannot_be_a_bus_is_refused_in_one_line(
    arguments: list[str],
    capfd: pytest.CaptureFixture[str],
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.chdir(tmp_path)
    refused(capfd, "fake-bus", *arguments)
