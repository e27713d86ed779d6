"""The model of §4.5.1: scenes of units of channels of tracks."""

from __future__ import annotations

import numpy as np
import pytest

from enpointe.errors import MotionError
from enpointe.motion.gesture import (
    Channel,
    Dimension,
    Encoding,
    Scene,
    Track,
    Unit,
    Variable,
    merged,
)

from .scenes import keyboard


def test_forces_alone_are_intensive() -> None:
    assert [v for v in Variable if not v.extensive] == [Variable.FORCE]


def test_labels_are_the_document_s() -> None:
    assert Channel("PK1", dimension=Dimension.Z).label == "PK1 [EV(P), 1Dz]"
    assert Channel("LS", Variable.FORCE, Dimension.XY).label == "LS [IV(F), 2Dxy]"
    assert Channel("BL2", Variable.ANGLE, Dimension.RQF).label == "BL2 [EV(A), 3Drqf]"


@pytest.mark.parametrize("dimension", Dimension)
def test_a_dimension_has_as_many_tracks_as_its_name_says(dimension: Dimension) -> None:
    said = 1 if dimension is Dimension.SCALAR else int(dimension.value[0])
    assert dimension.width == len(dimension.axes) == said


def test_a_unit_s_tracks_stand_in_the_order_of_its_channels() -> None:
    unit = Unit("u", (Channel("a", dimension=Dimension.ZX), Channel("b")), 10.0)
    assert unit.width == 5
    assert unit.tracks == (
        Track("a", "z", 0),
        Track("a", "x", 1),
        Track("b", "x", 2),
        Track("b", "y", 3),
        Track("b", "z", 4),
    )
    assert unit.columns("b") == slice(2, 5)


def test_a_channel_is_found_with_its_times() -> None:
    scene = keyboard(4)
    time, values = scene.channel("hand", "pad")
    assert time.tolist() == [0, 1 / 4000, 2 / 4000, 3 / 4000]
    assert values.tolist() == [[2, 3], [5, 6], [8, 9], [11, 12]]
    for unit, channel in (("hand", "no"), ("no", "pad")):
        with pytest.raises(MotionError, match="called 'no'"):
            scene.channel(unit, channel)
    twice = Unit("u", (Channel("a"), Channel("a")), 1.0)
    with pytest.raises(MotionError, match="two channels"):
        twice.columns("a")


def test_two_scenes_merge_into_one_at_their_own_rates() -> None:
    slow = keyboard(2, rate=100.0)
    both = merged("both", keyboard(4), slow)
    assert both.rate == 4000
    assert both.duration == 2 / 100
    assert [len(signal) for signal in both.signals] == [4, 2]
    with pytest.raises(MotionError, match="two units"):
        both.unit("hand")


def test_what_makes_no_sense_is_refused() -> None:
    channel = Channel("c")
    for make, message in (
        (lambda: Channel("a\0b"), "without NUL"),
        (lambda: Channel("x" * 65536), "under 65536"),
        (lambda: Channel("\ud800"), "characters that are none"),
        (lambda: Unit("u", (), 1.0), "one channel at least"),
        (lambda: Unit("u", (channel,), 0.0), "above 0"),
        (lambda: Unit("u", (channel,), float("nan")), "above 0"),
        (lambda: Scene("s", (), ()), "one unit at least"),
        (lambda: Scene("s", (Unit("u", (channel,), 1.0),), (np.zeros((3, 2)),)), r"\(T, 3\)"),
        (lambda: Encoding("int16"), "no such numbers"),  # type: ignore[arg-type]
        (lambda: Encoding("float32", 2.0), "only integers"),
        (lambda: Encoding("int32", 0.0), "loses the signal"),
        (lambda: Encoding("int32", float("nan")), "loses the signal"),
        (lambda: Encoding(block_size=0), "a block must"),
        (lambda: Encoding.integers(float("inf")), "finite"),
    ):
        with pytest.raises(MotionError, match=message):
            make()
