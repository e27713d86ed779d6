"""Fault scripts and bus descriptions as files, and what faults do to packets."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from enpointe.errors import FormatError, RigError
from enpointe.hardware.emulator import (
    BusDescription,
    Fault,
    FaultKind,
    FaultRun,
    bus_of,
    load_bus,
    load_faults,
)
from enpointe.hardware.packets import status_packet

from .rigs import Rig

SCRIPT = """
[[fault]]
kind = "drop"
ids = [3, 7]
at = [1.0, 9.0]
duration = 2.0
probability = 0.25

[[fault]]
kind = "brown-out"
amount = 6.5
"""
BUS = """
baud = 2000000
voltage = 11.1

[[servo]]
id = 4
model = "XH540-W270"
gravity = 0.5
settings = { "Return Delay Time" = 0 }

[[servo]]
id = 2
angle = 0.5
"""


def run_of(fault: Fault, seed: int = 0) -> FaultRun:
    return FaultRun([fault], np.random.default_rng(seed))


def test_a_script_is_read_with_its_defaults(tmp_path: Path) -> None:
    file = tmp_path / "faults.toml"
    file.write_text(SCRIPT)
    first, second = load_faults(file)
    assert first == Fault(FaultKind.DROP, (3, 7), (1.0, 9.0), (2.0, 2.0), 0.25)
    assert second.size == 6.5
    assert second.duration[0] == float("inf")


@pytest.mark.parametrize(
    ("text", "word"),
    [
        ('[[fault]]\nkind = "gremlin"', "gremlin"),
        ("[[fault]]\nids = [1]", "kind"),
        ('[[fault]]\nkind = "drop"\nwhen = 3', "kind"),
        ('[[fault]]\nkind = "drop"\nat = [3, 1]', "order"),
        ('[[fault]]\nkind = "drop"\nat = "soon"', "number"),
        ('[[fault]]\nkind = "drop"\nat = nan', "number"),
        ('[[fault]]\nkind = "drop"\nprobability = 2', "probability"),
        ('[[fault]]\nkind = "drop"\nids = [300]', "ids"),
        ('[[fault]]\nkind = "drop"\nids = [true]', "ids"),
        ('[[fault]]\nkind = "stall"\ninstructions = true', "instructions"),
        ('[[fault]]\nkind = "overheat"\namount = 900', "amount"),
        ("fault = 3", "fault"),
        ("[[fault", "TOML"),
    ],
)
def test_a_bad_script_is_refused_with_its_reason(tmp_path: Path, text: str, word: str) -> None:
    file = tmp_path / "faults.toml"
    file.write_text(text)
    with pytest.raises(FormatError, match=word) as caught:
        load_faults(file)
    assert "\n" not in str(caught.value)


def test_a_bus_is_read_and_built(tmp_path: Path) -> None:
    file = tmp_path / "bus.toml"
    file.write_text(BUS)
    bus = bus_of(load_bus(file))
    assert [(servo.id, servo.model.name) for servo in bus.servos] == [
        (4, "XH540-W270"),
        (2, "XM430-W350"),
    ]
    assert bus.line.baud == 2_000_000
    assert bus.supply.voltage == 11.1
    assert list(bus.plant.position()) == [0.0, 0.5]


@pytest.mark.parametrize(
    ("text", "word"),
    [
        ("baud = 1000000", "servo"),
        ("[[servo]]\nmodel = 'XM430-W350'", "id"),
        ("[[servo]]\nid = 1\nmodel = 'AX-12'", "AX-12"),
        ("[[servo]]\nid = 300", "300"),
        ("[[servo]]\nid = 1\ncolour = 'red'", "colour"),
        ("[[servo]]\nid = 1\nangle = nan", "angle"),
        ("[[servo]]\nid = 1\nsettings = { LED = 1 }", "LED"),
        ("[[servo]]\nid = 1\nsettings = { 'ID' = 'x' }", "settings"),
        ("baud = 12\n[[servo]]\nid = 1", "12"),
        ("strict = 1\n[[servo]]\nid = 1", "strict"),
    ],
)
def test_a_bad_bus_is_refused_with_its_reason(tmp_path: Path, text: str, word: str) -> None:
    file = tmp_path / "bus.toml"
    file.write_text(text)
    with pytest.raises(FormatError, match=word):
        load_bus(file)


def test_a_plant_of_another_size_is_refused() -> None:
    one = bus_of(BusDescription.alike(1, "XM430-W350"))
    with pytest.raises(RigError, match="joint"):
        bus_of(BusDescription.alike(2, "XM430-W350"), plant=one.plant)


def test_moments_are_drawn_within_their_span_and_by_seed() -> None:
    fault = Fault(FaultKind.STALL, at=(1.0, 9.0), duration=(0.1, 0.2))
    begins = [run_of(fault, seed).moments[0] for seed in range(50)]
    assert all(1.0 <= each.begin <= 9.0 and 0.1 <= each.end - each.begin <= 0.2 for each in begins)
    assert len({each.begin for each in begins}) == 50
    assert run_of(fault, 3).moments == run_of(fault, 3).moments


def test_a_share_of_packets_is_lost_spoilt_or_late() -> None:
    packet = status_packet(1, 0, bytes(range(10)))
    for kind in (FaultKind.DROP, FaultKind.CORRUPT, FaultKind.STUFFING, FaultKind.DELAY):
        run = run_of(Fault(kind, probability=0.1))
        fates = [run.answer(1, packet, 0.0) for _ in range(2000)]
        struck = [fate for fate in fates if fate != (packet, 0.0)]
        assert len(struck) == pytest.approx(200, abs=60)
        for data, late in struck:
            assert (data is None) is (kind is FaultKind.DROP)
            assert (late > 0) is (kind is FaultKind.DELAY)
            if kind is FaultKind.CORRUPT:
                assert data is not None
                assert sum(a != b for a, b in zip(data, packet, strict=True)) == 1
            if kind is FaultKind.STUFFING:
                assert data is not None
                assert len(data) == len(packet) + 3


def test_faults_keep_to_their_servos_and_their_time() -> None:
    run = run_of(Fault(FaultKind.DROP, ids=(2,), at=(1.0, 1.0), duration=(1.0, 1.0)))
    packet = status_packet(2, 0)
    assert run.answer(2, packet, 0.99) == (packet, 0.0)
    assert run.answer(2, packet, 1.0) == (None, 0.0)
    assert run.answer(3, packet, 1.5) == (packet, 0.0)
    assert run.answer(2, packet, 2.0) == (packet, 0.0)


def test_a_servo_that_comes_back_has_booted() -> None:
    rig = Rig(2, faults=[Fault(FaultKind.MISSING, (2,), (1.0, 1.0), (0.5, 0.5))])
    for number in rig.ids:
        rig.set("Torque Enable", 1, number)
    rig.wait(1.1)
    assert rig.packets.ping(rig.port, 2)[1] != 0
    assert rig.packets.ping(rig.port, 1)[1] == 0
    rig.wait(1.0)
    assert rig.get("Torque Enable", 1) == 1
    assert rig.get("Torque Enable", 2) == 0


def test_a_jammed_joint_stays_and_goes_on_when_it_is_freed() -> None:
    rig = Rig(2, faults=[Fault(FaultKind.STALL, (2,), (0.0, 0.0), (1.0, 1.0))])
    for number in rig.ids:
        rig.set("Torque Enable", 1, number)
    rig.writer([2300, 2300]).txPacket()
    rig.wait(0.9)
    assert rig.get("Present Position", 2) == 2048
    assert rig.get("Present Position", 1) == pytest.approx(2300, abs=5)
    rig.wait(1.0)
    assert rig.get("Present Position", 2) == pytest.approx(2300, abs=5)
