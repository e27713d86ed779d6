"""A gesture is in the file while it goes on, and outlives the process that writes it."""

from __future__ import annotations

import signal
import subprocess
import sys
import tracemalloc
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.typing import ArrayLike

from enpointe.errors import FormatError, MotionError
from enpointe.motion.gesture import (
    Channel,
    Dimension,
    Encoding,
    GestureReader,
    GestureWriter,
    Unit,
    read_scene,
    write_scene,
)

from .scenes import assert_same, keyboard, read_all

HAND = keyboard().units
WRITER = """
import sys
import numpy as np
from enpointe.motion.gesture import Channel, Encoding, GestureWriter, Unit

unit = Unit("arm", tuple(Channel(f"P{i}") for i in range(33)), 4000.0)
writer = GestureWriter(
    sys.argv[1], [unit], name="killed", encoding=Encoding("float32"), flush_seconds=0.05
)
frame = 0
while True:
    writer.append(frame + np.arange(99.0))
    frame += 1
    if writer.flushed + 1 == frame:
        print(writer.flushed, flush=True)
    elif frame % 200 == 0:
        print(writer.flushed, flush=True)
"""


def test_a_stream_is_the_file_that_the_whole_scene_makes(tmp_path: Path) -> None:
    scene = keyboard(1000)
    write_scene(scene, tmp_path / "whole.gst")
    with GestureWriter(tmp_path / "stream.gst", scene.units, name="keys") as writer:
        for frame in scene.signals[0]:
            writer.append(frame)
    assert (tmp_path / "stream.gst").read_bytes() == (tmp_path / "whole.gst").read_bytes()


@given(st.lists(st.integers(0, 9), max_size=12), st.sampled_from([0.0, 0.001, 0.01, 1.0]))
def test_the_file_is_whole_after_every_flush(sizes: list[int], patience: float) -> None:
    with TemporaryDirectory() as folder:
        path = Path(folder) / "live.gst"
        rows = keyboard(sum(sizes)).signals[0]
        with GestureWriter(path, HAND, flush_seconds=patience) as writer:
            done = 0
            for size in sizes:
                writer.append(rows[done : done + size])
                done += size
                assert writer.frames == done
                assert writer.frames - writer.flushed <= patience * 4000
                found, warnings = read_all(path)
                assert not warnings
                np.testing.assert_array_equal(found.signals[0], rows[: writer.flushed])
        np.testing.assert_array_equal(read_scene(path).signals[0], rows)


@pytest.mark.parametrize("lines", [1, 40, 90])
def test_a_killed_writer_leaves_every_frame_that_it_had_flushed(lines: int, tmp_path: Path) -> None:
    path = tmp_path / "killed.gst"
    with subprocess.Popen(
        [sys.executable, "-P", "-c", WRITER, str(path)], stdout=subprocess.PIPE, text=True
    ) as process:
        assert process.stdout is not None
        flushed = [int(process.stdout.readline()) for _ in range(lines)][-1]
        process.send_signal(signal.SIGKILL)
    assert process.returncode == -signal.SIGKILL
    frames = read_scene(path).signals[0]
    assert len(frames) >= flushed
    expected = np.arange(len(frames))[:, np.newaxis] + np.arange(99.0)
    np.testing.assert_array_equal(frames, expected)


@pytest.mark.parametrize("whole", range(4))
def test_a_writer_stopped_between_its_head_and_its_frames_lost_only_those(
    whole: int, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The head is written first, so the file says more than it has, by some frames or parts."""
    path, scene = tmp_path / "stopped.gst", keyboard(6)
    writer = GestureWriter(path, HAND, name="keys", flush_seconds=0)
    writer.append(scene.signals[0][:2])
    put = writer._put

    def stopping(data: bytes, position: int = 0) -> None:
        if position:
            put(data[: whole * 24 + 5 * (whole < 4)], position)
            raise KeyboardInterrupt
        put(data, position)

    monkeypatch.setattr(writer, "_put", stopping)
    writer._patience = 4
    with pytest.raises(KeyboardInterrupt):
        writer.append(scene.signals[0][2:])
    found, warnings = read_all(path)
    np.testing.assert_array_equal(found.signals[0], scene.signals[0][: 2 + whole])
    assert len(warnings) == 1


def test_a_full_disk_leaves_what_was_flushed(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path, scene = tmp_path / "full.gst", keyboard(6)
    writer = GestureWriter(path, HAND, name="keys", flush_seconds=0)
    writer.append(scene.signals[0][0])
    put = writer._put

    def full(data: bytes, position: int = 0) -> None:
        if position:
            put(data[:10], position)
            raise FormatError("no space", path)
        put(data, position)

    monkeypatch.setattr(writer, "_put", full)
    with pytest.raises(FormatError, match="no space"):
        writer.append(scene.signals[0][1])
    found, warnings = read_all(path)
    np.testing.assert_array_equal(found.signals[0], scene.signals[0][:1])
    assert not warnings
    monkeypatch.undo()
    writer.append(scene.signals[0][2])
    writer.close()
    assert read_scene(path).signals[0].tolist() == scene.signals[0][[0, 2]].tolist()


def test_what_cannot_be_appended_leaves_the_file_as_it_was(tmp_path: Path) -> None:
    path = tmp_path / "keys.gst"
    with GestureWriter(path, HAND, encoding=Encoding("int32"), flush_seconds=0) as writer:
        writer.append([1, 2, 3])
        refused: tuple[tuple[ArrayLike, str], ...] = (
            ([1, 2], "must have shape"),
            ([[[1, 2, 3]]], "must have shape"),
            ([[4.0, 5.0, 6.0], [7.0, 8.0, 2.0**31]], "can't hold"),
        )
        for wrong, message in refused:
            with pytest.raises(MotionError, match=message):
                writer.append(wrong)
        room = writer.most
        writer.most = 2
        with pytest.raises(MotionError, match="4 GiB"):
            writer.append([[4, 5, 6], [7, 8, 9]])
        writer.most = room
    assert read_scene(path).signals[0].tolist() == [[1, 2, 3]]
    writer.close()
    with pytest.raises(MotionError, match="closed"):
        writer.append([1, 2, 3])


def test_a_file_has_room_for_what_its_sizes_can_say(tmp_path: Path) -> None:
    for block in (None, 512, 4097):
        path = tmp_path / f"{block}.gst"
        with GestureWriter(path, HAND, encoding=Encoding(block_size=block)) as writer:
            most = writer.most
        start = path.read_bytes().index(b"FRAM") + 8
        spare = 2**32 - 1 - (start + most * 24)
        assert 0 <= spare <= 2 * (block or 1) + 8 + 24


def test_a_recording_never_replaces_another(tmp_path: Path) -> None:
    (tmp_path / "old.gst").write_bytes(b"old")
    with pytest.raises(FormatError, match="already"):
        GestureWriter(tmp_path / "old.gst", HAND)
    assert (tmp_path / "old.gst").read_bytes() == b"old"
    with pytest.raises(FormatError, match="can't be written"):
        GestureWriter(tmp_path / "no" / "folder.gst", HAND)


def test_durable_frames_are_asked_of_the_disk(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    asked: list[int] = []
    monkeypatch.setattr("enpointe.motion.gesture.writer.os.fsync", asked.append)
    with GestureWriter(tmp_path / "d.gst", HAND, flush_seconds=0, durable=True) as writer:
        writer.append([[1, 2, 3], [4, 5, 6]])
        assert len(asked) == 2


def test_a_slower_unit_handed_again_is_read_once_a_sample(tmp_path: Path) -> None:
    """A recorder at 1 kHz beside a camera at 30 Hz: the tick hands over the latest of both."""
    stick = Unit("stick", (Channel("S", dimension=Dimension.X),), 1000.0)
    camera = Unit("camera", (Channel("C", dimension=Dimension.X),), 30.0)
    path = tmp_path / "both.gst"
    with GestureWriter(path, [stick, camera]) as writer:
        for tick in range(1000):
            writer.append([tick, tick * 30 // 1000])
    scene = read_scene(path)
    assert scene.units == (stick, camera)
    assert scene.signals[0][:, 0].tolist() == list(range(1000))
    assert scene.signals[1][:, 0].tolist() == list(range(30))


def test_memory_is_bounded_by_the_block_and_by_the_file(tmp_path: Path) -> None:
    path = tmp_path / "long.gst"
    unit = Unit("arm", tuple(Channel(f"P{i}") for i in range(33)), 4000.0)
    rows = np.random.default_rng(1).normal(size=(4000, 99))
    tracemalloc.start()
    with GestureWriter(path, [unit], encoding=Encoding("float32")) as writer:
        for _ in range(10):
            writer.append(rows)
    writing = tracemalloc.get_traced_memory()[1]
    size = path.stat().st_size
    assert size > 15_000_000
    assert writing < rows.nbytes + 3_000_000

    tracemalloc.reset_peak()
    with GestureReader(path) as reader:
        assert sum(len(block) for block in reader.blocks(400)) == 40_000
    assert tracemalloc.get_traced_memory()[1] < 1_500_000

    tracemalloc.reset_peak()
    scene = read_scene(path)
    assert tracemalloc.get_traced_memory()[1] < 2.5 * size
    tracemalloc.stop()
    assert scene.signals[0].shape == (40_000, 99)


def test_a_file_that_becomes_shorter_while_it_is_read(tmp_path: Path) -> None:
    path = tmp_path / "keys.gst"
    write_scene(keyboard(1000), path)
    with GestureReader(path) as reader:
        blocks = reader.blocks(10)
        next(blocks)
        with path.open("r+b") as file:
            file.truncate(20_000)
        with pytest.raises(FormatError, match="shorter") as caught:
            list(reader.blocks(1000))
    assert caught.value.byte == 20_000


def test_writing_a_stream_of_nothing(tmp_path: Path) -> None:
    with GestureWriter(tmp_path / "none.gst", HAND, name="keys") as writer:
        writer.flush()
    assert_same(read_scene(tmp_path / "none.gst"), keyboard(0))
