"""Whatever a scene is, writing and reading it gives it back."""

from __future__ import annotations

from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from enpointe.errors import FormatError
from enpointe.motion.gesture import (
    Channel,
    Dimension,
    Encoding,
    GestureReader,
    Scene,
    Unit,
    read_scene,
    write_scene,
)
from enpointe.motion.gesture.encoding import Order
from enpointe.motion.gesture.holding import Holding

from .scenes import ENCODINGS, RATES, assert_same, keyboard, read_all, scenes


@given(scenes(), ENCODINGS)
def test_floats_come_back_to_their_last_digit(scene: Scene, encoding: Encoding) -> None:
    with TemporaryDirectory() as folder:
        path = Path(folder) / "any.gst"
        write_scene(scene, path, encoding)
        found, warnings = read_all(path)
        data = path.read_bytes()
    if encoding.numbers == "float32":
        rounded = tuple(s.astype(np.float32).astype(np.float64) for s in scene.signals)
        scene = Scene(scene.name, scene.units, rounded)
    assert_same(found, scene)
    assert len(warnings) == (encoding.order == "little")
    assert len(data) % (encoding.block_size or 2) == 0


@given(scenes(), st.floats(1.0, 1e6), st.sampled_from(["big", "little"]))
def test_integers_come_back_within_half_a_step(scene: Scene, room: float, order: Order) -> None:
    largest = max((abs(s).max() for s in scene.signals if s.size), default=0.0) * room
    encoding = Encoding.integers(largest, order)
    with TemporaryDirectory() as folder:
        write_scene(scene, Path(folder) / "any.gst", encoding)
        found = read_scene(Path(folder) / "any.gst")
    assert_same(found, scene, within=0.5 * encoding.scale * (1 + 1e-6))


@given(scenes())
def test_a_file_read_and_written_again_is_the_same(scene: Scene) -> None:
    with TemporaryDirectory() as folder:
        first, second = Path(folder) / "first.gst", Path(folder) / "second.gst"
        write_scene(scene, first)
        write_scene(read_scene(first), second)
        assert first.read_bytes() == second.read_bytes()


@given(scenes(most_units=1, most_samples=30), st.integers(1, 40))
def test_blocks_are_the_frames_in_order(scene: Scene, size: int) -> None:
    with TemporaryDirectory() as folder:
        write_scene(scene, Path(folder) / "any.gst")
        with GestureReader(Path(folder) / "any.gst") as reader:
            blocks = list(reader.blocks(size))
    assert all(len(block) == size for block in blocks[:-1])
    if blocks:
        np.testing.assert_array_equal(np.vstack(blocks), scene.signals[0])
    else:
        assert len(scene.signals[0]) == 0


@given(RATES, RATES, st.integers(1, 300))
def test_every_sample_has_a_frame_of_its_own_and_is_held_until_the_next(
    one: float, other: float, count: int
) -> None:
    frequency, rate = max(one, other), min(one, other)
    holding = Holding.of(frequency, rate)
    frames = holding.frames_for(min(count, int(1 + 5000 * rate / frequency)))
    samples = holding.samples_before(frames)
    first = holding.first_frames(0, samples)
    held = holding.held(0, frames)
    assert (np.diff(first) >= 1).all()
    np.testing.assert_array_equal(held[first], np.arange(samples))
    assert set(np.diff(held)) <= {0, 1}
    # In time: no sample stands before its moment, and none a whole frame late.
    late = first / frequency - np.arange(samples) / rate
    assert (late > -1e-9).all()
    assert (late < 1 / frequency + 1e-9).all()


def test_what_was_not_seen_stays_so(tmp_path: Path) -> None:
    unit = Unit("unit", (Channel("ch"),), 100.0)
    values = np.array([[np.nan, 1.0, -np.inf], [0.0, -0.0, np.nan]])
    for numbers in ("float32", "float64"):
        encoding = Encoding("float32" if numbers == "float32" else "float64")
        write_scene(Scene("", (unit,), (values,)), tmp_path / "n.gst", encoding)
        found = read_scene(tmp_path / "n.gst").signals[0]
        np.testing.assert_array_equal(found, values)
        np.testing.assert_array_equal(np.signbit(found[1]), np.signbit(values[1]))


@pytest.mark.parametrize(
    ("encoding", "value"),
    [
        (Encoding("int32"), 2.0**31),
        (Encoding("int32"), -(2.0**31) - 1),
        (Encoding("int32"), np.nan),
        (Encoding("int32", 0.001), np.inf),
        (Encoding("float32"), 1e39),
    ],
)
def test_a_value_that_does_not_fit_is_refused_and_nothing_is_written(
    encoding: Encoding, value: float, tmp_path: Path
) -> None:
    scene = Scene(
        "", (Unit("u", (Channel("c", dimension=Dimension.X),), 1.0),), (np.array([[value]]),)
    )
    with pytest.raises(FormatError, match="can't hold"):
        write_scene(scene, tmp_path / "no.gst", encoding)
    assert not list(tmp_path.iterdir())


def test_a_scene_of_more_than_4_gib_is_refused_before_it_is_written(tmp_path: Path) -> None:
    """A unit of one sample in twelve days beside one of 4 kHz would be held for all of them."""
    channel = (Channel("c", dimension=Dimension.X),)
    units = (Unit("slow", channel, 1e-6), Unit("fast", channel, 4000.0))
    with pytest.raises(FormatError, match="4 GiB"):
        write_scene(Scene("", units, (np.zeros((2, 1)), np.zeros((4, 1)))), tmp_path / "no.gst")
    assert not list(tmp_path.iterdir())


def test_as_many_channels_as_a_reader_goes_through(tmp_path: Path) -> None:
    channels = tuple(Channel(f"c{i}", dimension=Dimension.X) for i in range(65_520))
    for count, fits in ((65_519, True), (65_520, False)):
        unit = Unit("u", channels[:count], 1.0)
        scene = Scene("", (unit,), (np.arange(float(count))[np.newaxis],))
        if fits:
            write_scene(scene, tmp_path / "wide.gst", Encoding("float32", block_size=512))
            assert_same(read_scene(tmp_path / "wide.gst"), scene)
        else:
            with pytest.raises(FormatError, match="a file holds 65520"):
                write_scene(scene, tmp_path / "wider.gst")


def test_a_file_that_is_there_is_replaced_whole(tmp_path: Path) -> None:
    path = tmp_path / "keys.gst"
    write_scene(keyboard(50), path)
    write_scene(keyboard(2), path)
    assert_same(read_scene(path), keyboard(2))
    assert [file.name for file in tmp_path.iterdir()] == ["keys.gst"]
