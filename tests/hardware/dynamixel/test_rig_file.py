"""Rig files: those shipped, the refusal of wrong ones in a line, and writing them."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from enpointe.errors import FormatError, RigError
from enpointe.hardware.rig_file import Rig, load_rig, rig_text, save_rig, shipped_rigs
from enpointe.models.puppet import SERVOS, op3_model, puppet_model

from .benches import small_rig


@pytest.mark.parametrize("name", ["puppet", "op3"])
def test_a_shipped_rig_has_its_bodys_joints_servos_and_ranges(name: str) -> None:
    rig = load_rig(name)
    assert rig.body == name
    assert {servo.joint: servo.model for servo in rig.servos} == dict(SERVOS[name])
    model = puppet_model() if name == "puppet" else op3_model()
    for servo in rig.servos:
        low, high = model.joint(servo.joint).range
        assert servo.range[0] >= low - 1e-6, servo.joint
        assert servo.range[1] <= high + 1e-6, servo.joint
        assert servo.top_speed < servo.sheet.no_load_speed


def test_shipped_rigs_are_named() -> None:
    assert shipped_rigs() == ("op3", "puppet")


WRONG: list[tuple[dict[str, Any], str]] = [
    ({"id": 300}, "servo 2, id"),
    ({"id": 1}, "id 1 is there twice"),
    ({"joint": "joint_1"}, "joint joint_1 is there twice"),
    ({"model": "XM431"}, "no datasheet"),
    ({"sign": 0}, "sign"),
    ({"limits": (10.0, -10.0)}, "must rise"),
    ({"offset": 150.0}, "one turn"),
    ({"speed": 900.0}, "without any load"),
    ({"speed": -1.0}, "speed"),
    ({"current": 99_000.0}, "at most"),
    ({"current": 1.0}, "less than the servo can measure"),
    ({"model": "XL430-W250", "current": 100.0}, "can't limit its current"),
    ({"gains": (1, 2)}, "gains"),
    ({"gains": (1, 2, 99_999)}, "gains"),
    ({"offset": math.nan}, "offset"),
    ({"colour": "red"}, "colour"),
]


@pytest.mark.parametrize(("changed", "told"), WRONG)
def test_a_wrong_servo_is_refused_in_one_line(
    changed: dict[str, Any], told: str, tmp_path: Path
) -> None:
    rig = small_rig()
    text = rig_text(rig)
    second = rig.servos[1].model_copy(update=changed)
    wrong = rig.model_copy(update={"servos": (rig.servos[0], second, rig.servos[2])})
    path = tmp_path / "rig.toml"
    path.write_text(rig_text(wrong) if "colour" not in changed else text + 'colour = "red"\n')
    with pytest.raises(FormatError) as refusal:
        load_rig(path)
    assert told in str(refusal.value)
    assert "\n" not in str(refusal.value)


@pytest.mark.parametrize("text", ["", "name = ", "[[servo]]\nid = 1", "\x00"])
def test_what_is_no_rig_is_refused_in_one_line(text: str, tmp_path: Path) -> None:
    path = tmp_path / "rig.toml"
    path.write_text(text)
    with pytest.raises(FormatError) as refusal:
        load_rig(path)
    assert "\n" not in str(refusal.value)


def test_no_rig_of_that_name_says_which_there_are() -> None:
    with pytest.raises(RigError, match="op3, puppet"):
        load_rig("pupet")


@settings(max_examples=30)
@given(
    st.text(min_size=1, max_size=20).filter(lambda name: max(name) < "\ud800"),
    st.floats(-90.0, 90.0),
    st.sampled_from([-1, 1]),
)
def test_a_rig_reads_back_as_it_was_written(
    tmp_path_factory: pytest.TempPathFactory, name: str, offset: float, sign: int
) -> None:
    rig = small_rig(2)
    servo = rig.servos[0].model_copy(update={"offset": offset, "sign": sign})
    rig = rig.model_copy(update={"name": name, "servos": (servo, rig.servos[1])})
    path = tmp_path_factory.mktemp("rig") / "rig.toml"
    save_rig(rig, path, ["a comment"])
    assert load_rig(path) == rig


def test_limits_in_pulses_lie_within_those_in_degrees() -> None:
    for servo in load_rig("puppet").servos:
        low, high = servo.pulse_limits
        for pulses in (low, high):
            degrees = servo.sign * ((pulses - 2048) * 360.0 / 4096.0 - servo.offset)
            assert servo.limits[0] - 1e-9 <= degrees <= servo.limits[1] + 1e-9


def test_another_baud_rate_or_rate_is_checked() -> None:
    rig = small_rig()
    assert rig.at(4_000_000, 200.0).baud == 4_000_000
    assert rig.at() == rig
    with pytest.raises(RigError, match="baud"):
        rig.at(baud=12)
    with pytest.raises(RigError, match="rate"):
        rig.at(rate=-5.0)


def test_a_rig_is_what_the_file_says() -> None:
    with pytest.raises(ValueError, match="frozen"):
        small_rig().servos[0].id = 9
    assert isinstance(small_rig(), Rig)
