"""The ladder of reactions: what is borne, what parks, what lets go, and in which words."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from enpointe.hardware.dynamixel import SafetyLimits, Severity, Supervisor, Verdict
from enpointe.hardware.dynamixel.frames import Frame
from enpointe.hardware.hardware_error import HardwareError

LIMITS = SafetyLimits()
NAMES = ("7 (left_elbow_bend)", "9 (right_elbow_bend)")


def frame(**changed: Any) -> Frame:
    none = np.zeros(2, dtype=np.int64)
    values = {
        "current": none, "velocity": none, "position": none,
        "age": np.zeros(2), "fresh": np.ones(2, bool), "alert": np.zeros(2, bool),
    }  # fmt: skip
    return Frame(**{**values, **changed})


def health(errors: int = 0, temperature: float = 30.0) -> Any:
    status = np.array([errors, 0])
    return SimpleNamespace(
        status=status,
        errors=lambda place: HardwareError(int(status[place])) if status[place] else None,
        temperature=np.array([temperature, np.nan]),
        temperature_limit=np.array([80.0, 80.0]),
        loose=np.zeros(2, dtype=bool),
    )


def look(
    tested: Supervisor, now: float = 0.0, error: float = 0.0, well: Any = None, **changed: Any
) -> Verdict:
    away = np.array([error, 0.0])
    return tested.look(frame(**changed), well or health(), away, now)


def test_all_well_is_fine() -> None:
    assert look(Supervisor(NAMES, LIMITS)) == Verdict()


@pytest.mark.parametrize(
    ("error", "severity", "words"),
    [
        (HardwareError.INPUT_VOLTAGE, Severity.PARK, "supply is out of range"),
        (HardwareError.OVERHEATING, Severity.OFF, "too hot"),
        (HardwareError.OVERLOAD, Severity.OFF, "overloaded"),
        (HardwareError.ELECTRICAL_SHOCK | HardwareError.INPUT_VOLTAGE, Severity.OFF, "supply"),
        (HardwareError.ENCODER, Severity.OFF, "encoder"),
    ],
)
def test_an_alarm_names_the_joint_and_the_error(
    error: HardwareError, severity: Severity, words: str
) -> None:
    alert = np.array([True, False])
    found = look(Supervisor(NAMES, LIMITS), well=health(int(error)), alert=alert)
    assert found.severity is severity
    assert "left_elbow_bend" in found.reason
    assert words in found.reason


def test_an_alarm_whose_bit_is_lost_counts_as_well() -> None:
    found = look(Supervisor(NAMES, LIMITS), well=health(int(HardwareError.OVERLOAD)))
    assert found.severity is Severity.OFF


def test_an_alarm_that_does_not_say_which_is_not_borne_for_long() -> None:
    tested = Supervisor(NAMES, LIMITS)
    alert = np.array([True, False])
    assert look(tested, 0.0, alert=alert).severity is Severity.FINE
    assert look(tested, 0.05, alert=alert).severity is Severity.FINE
    assert look(tested, 0.11, alert=alert).severity is Severity.OFF


def test_silence_is_borne_up_to_a_limit() -> None:
    tested = Supervisor(NAMES, LIMITS)
    short, long = np.array([0.0, 0.09]), np.array([0.0, 0.11])
    assert look(tested, age=short).severity is Severity.FINE
    found = look(tested, age=long)
    assert found.severity is Severity.OFF
    assert "right_elbow_bend" in found.reason


def test_a_joint_held_off_its_goal_lets_go_after_a_while_and_a_quick_one_does_not() -> None:
    tested = Supervisor(NAMES, LIMITS)
    for k in range(24):
        assert look(tested, k * 0.01, error=0.7).severity is Severity.FINE
    assert look(tested, 0.24, error=0.1).severity is Severity.FINE
    for k in range(25, 50):
        assert look(tested, k * 0.01, error=-0.7).severity is Severity.FINE
    found = look(tested, 0.51, error=-0.7)
    assert found.severity is Severity.OFF
    assert "left_elbow_bend" in found.reason


def test_one_lost_answer_in_a_hundred_is_borne_and_every_third_is_not() -> None:
    half = np.array([True, False])
    rare, often = Supervisor(NAMES, LIMITS), Supervisor(NAMES, LIMITS)
    worst = Severity.FINE
    for k in range(1000):
        worst = max(worst, look(rare, fresh=half if k % 50 == 0 else np.ones(2, bool)).severity)
    assert worst is Severity.FINE
    for k in range(200):
        found = look(often, fresh=half if k % 3 else np.ones(2, bool))
    assert found.severity is Severity.PARK
    assert "%" in found.reason


def test_heat_parks_before_the_servo_shuts_down() -> None:
    assert look(Supervisor(NAMES, LIMITS), well=health(temperature=74.0)).severity is Severity.FINE
    assert look(Supervisor(NAMES, LIMITS), well=health(temperature=76.0)).severity is Severity.PARK


def test_the_gravest_is_told() -> None:
    tested = Supervisor(NAMES, LIMITS)
    found = look(tested, well=health(temperature=76.0), age=np.array([0.5, 0.0]))
    assert found.severity is Severity.OFF
