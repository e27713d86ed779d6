"""The calibration wizard, with a person who moves the emulated horns."""

from __future__ import annotations

import math
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from enpointe.errors import RigError
from enpointe.hardware.calibration import Calibration
from enpointe.hardware.dynamixel import check_rig
from enpointe.hardware.emulator import Bus, Loads
from enpointe.hardware.rig_file import Rig, load_rig

from .benches import Bench, bench, small_rig


class Person:
    """Puts horns where the true rig has its zero, and moves them its positive way.

    Args:
        true: How the horns were really put on.
        bus: Whose joints are moved.
        clumsy: What else is done at each line.
    """

    def __init__(
        self, true: Rig, bus: Bus, clumsy: Callable[[str], None] = lambda line: None
    ) -> None:
        self._true, self._bus, self._clumsy = true, bus, clumsy
        self.lines: list[str] = []

    def ask(self, line: str) -> None:
        self.lines.append(line)
        for place, servo in enumerate(self._true.servos):
            angle = math.radians(servo.offset)
            if servo.joint in line:
                angle += servo.sign * math.radians(20.0)
            self.put(place, angle)
        self._clumsy(line)

    def put(self, place: int, angle: float) -> None:
        plant = self._bus.plant
        assert isinstance(plant, Loads)
        plant.turn_by_hand(place, angle)
        self._bus.servos[place].horn.move(angle, 0.0)


def believed(true: Rig) -> Rig:
    """The same rig before anybody has measured it."""
    servos = [servo.model_copy(update={"sign": 1, "offset": 0.0}) for servo in true.servos]
    return true.model_copy(update={"servos": tuple(servos)})


def new_bus(true: Rig) -> Bench:
    """Servos as they come, without their rig's settings."""
    return bench(true, settings={"Return Delay Time": 250, "Homing Offset": 700, "Drive Mode": 1})


def test_it_finds_signs_and_offsets_writes_them_and_the_rig_is_ready(tmp_path: Path) -> None:
    true = small_rig()
    made = new_bus(true)
    person = Person(true, made.bus)
    wizard = Calibration(believed(true), made.link, person.ask, lambda line: None)
    wizard.prepare()
    found = wizard.measure()
    wizard.verify()
    assert wizard.save(tmp_path / "mine.toml") == []
    for servo, wanted in zip(found.servos, true.servos, strict=True):
        assert servo.sign == wanted.sign
        assert servo.offset == pytest.approx(wanted.offset, abs=0.1)
    mine = load_rig(tmp_path / "mine.toml")
    assert mine == found
    assert check_rig(mine, made.link) == []


def test_torque_goes_before_anybody_is_asked_to_move_a_joint() -> None:
    made = bench()
    for servo in made.bus.servos:
        assert made.link.write(servo.id, servo.memory.table["Torque Enable"], 1) == 0
    Calibration(made.rig, made.link, lambda line: None, lambda line: None).prepare()
    assert made.torque() == [False, False, False]


def test_set_up_writes_what_is_wrong_and_nothing_twice() -> None:
    made = new_bus(small_rig())
    wizard = Calibration(made.rig, made.link, lambda line: None, lambda line: None)
    wizard.let_go()
    assert wizard.set_up() == 3
    assert wizard.set_up() == 0
    assert check_rig(made.rig, made.link) == []


def test_a_joint_that_is_not_moved_or_not_held_still_is_told(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    true = small_rig()
    made = bench(true)
    lazy = Calibration(true, made.link, lambda line: None, lambda line: None)
    lazy.prepare()
    with pytest.raises(RigError, match="joint_1 moved 0 degrees"):
        lazy.measure()

    made = bench(true)
    reads = made.link.read
    restless = Calibration(true, made.link, lambda line: None, lambda line: None)
    restless.prepare()

    def shaken(*asked: Any, **rest: Any) -> int | None:
        made.bus.servos[0].horn.move(made.clock.now() * 400.0 % 1.0, 0.0)
        return reads(*asked, **rest)

    monkeypatch.setattr(made.link, "read", shaken)
    with pytest.raises(RigError, match="hold it still"):
        restless.measure()


def test_a_horn_that_slips_is_found_by_the_verification() -> None:
    true = small_rig()
    made = bench(true)

    def slip(line: str) -> None:
        if "again" in line:
            person.put(1, math.radians(true.servos[1].offset + 15.0))

    person = Person(true, made.bus, slip)
    wizard = Calibration(true, made.link, person.ask, lambda line: None)
    wizard.prepare()
    wizard.measure(signs=False)
    with pytest.raises(RigError, match="servo 2"):
        wizard.verify()


def test_a_horn_put_on_half_a_turn_wrong_is_refused_with_what_to_do() -> None:
    true = small_rig(1)
    made = bench(true)

    def wrong(line: str) -> None:
        person.put(0, math.radians(170.0))

    person = Person(true, made.bus, wrong)
    wizard = Calibration(true, made.link, person.ask, lambda line: None)
    wizard.prepare()
    with pytest.raises(RigError, match="turn the horn on its axle"):
        wizard.measure(signs=False)


def test_a_missing_servo_is_told_before_anything_is_done() -> None:
    made = bench(small_rig(2))
    wizard = Calibration(small_rig(3), made.link, lambda line: None, lambda line: None)
    with pytest.raises(RigError, match=r"servo 3 \(joint_3\) does not answer"):
        wizard.let_go()
