"""A file that is cut, strange or broken gives what is whole in it, or one error with its byte."""

from __future__ import annotations

import os
import struct
import tracemalloc
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from enpointe.errors import FormatError
from enpointe.motion.gesture import (
    Channel,
    Dimension,
    Encoding,
    GestureReader,
    Scene,
    Unit,
    Variable,
    read_scene,
    write_scene,
)
from enpointe.motion.gesture.encoding import Order

from .damaging import chunks_of, form_of, mutated
from .scenes import assert_same, keyboard, read_all, scenes

FRAME = 3 * 8


def stored(scene: Scene, folder: Path, encoding: Encoding | None = None) -> bytes:
    path = folder / "whole.gst"
    write_scene(scene, path, encoding)
    return path.read_bytes()


def rated() -> Scene:
    """Units of two rates, so that a file has all the chunks that there are."""
    keys = keyboard(8)
    points = (Channel("P1", measure="m"), Channel("P2", Variable.ANGLE, Dimension.RQF, "rad"))
    slow = Unit("dancer", points, 1500.0)
    return Scene("two", (keys.units[0], slow), (keys.signals[0], np.ones((3, 6))))


@pytest.mark.parametrize("block", [None, 64], ids=["plain", "in blocks"])
@pytest.mark.parametrize("order", ["big", "little"])
def test_a_file_cut_at_any_byte_gives_back_all_whole_frames(
    block: int | None, order: Order, tmp_path: Path
) -> None:
    scene, path = keyboard(), tmp_path / "cut.gst"
    encoding = Encoding(order=order, block_size=block)
    whole = stored(scene, tmp_path, encoding)
    start = whole.index(b"FRAM") + 8
    for size in range(len(whole)):
        path.write_bytes(whole[:size])
        if size < start:
            with pytest.raises(FormatError) as caught:
                read_scene(path)
            assert caught.value.byte is not None
            continue
        found, warnings = read_all(path)
        frames = min((size - start) // FRAME, 6)
        assert_same(found, Scene("keys", scene.units, (scene.signals[0][:frames],)))
        assert len(warnings) == (order == "little") + 1


def test_a_long_file_cut_anywhere_gives_back_all_whole_frames(tmp_path: Path) -> None:
    scene, path = keyboard(100_000), tmp_path / "cut.gst"
    whole = stored(scene, tmp_path)
    start = whole.index(b"FRAM") + 8
    for size in np.random.default_rng(5).integers(start, len(whole), 40).tolist():
        path.write_bytes(whole[:size])
        found, warnings = read_all(path)
        frames = (size - start) // FRAME
        np.testing.assert_array_equal(found.signals[0], scene.signals[0][:frames])
        assert warnings


def test_slower_units_of_a_cut_file_have_the_samples_that_begin_in_it(tmp_path: Path) -> None:
    scene, path = rated(), tmp_path / "cut.gst"
    whole = stored(scene, tmp_path)
    start, frame = whole.index(b"FRAM") + 8, 9 * 8
    for frames, samples in ((0, 0), (1, 1), (3, 1), (4, 2), (6, 2), (7, 3)):
        path.write_bytes(whole[: start + frames * frame + 5])
        found, _ = read_all(path)
        assert [len(signal) for signal in found.signals] == [frames, samples]


@pytest.mark.parametrize("order", ["big", "little"])
@pytest.mark.parametrize("content", [b"", b"\1", b"abc\0defg", b"x" * 9999], ids=len)
def test_an_unknown_chunk_at_any_place_is_left_aside_and_listed(
    content: bytes, order: Order, tmp_path: Path
) -> None:
    path, mark = tmp_path / "more.gst", ">" if order == "big" else "<"
    chunks = chunks_of(stored(rated(), tmp_path, Encoding(order=order)), mark)
    # By IFF's rule a byte that the size does not count makes an odd chunk even.
    note = b"NOTE" + struct.pack(mark + "I", len(content)) + content + bytes(len(content) % 2)
    for place in range(len(chunks) + 1):
        path.write_bytes(form_of([*chunks[:place], note, *chunks[place:]], mark))
        with GestureReader(path) as reader:
            found, warnings, lost = reader.scene(), reader.warnings, reader.lost
        assert_same(found, rated())
        assert len(lost) == 1
        assert f"'NOTE' of {len(content)} bytes" in lost[0]
        assert any("NOTE" in warning for warning in warnings)


def test_odd_chunks_are_read_by_either_rule(tmp_path: Path) -> None:
    """A name of three letters: IFF counts nine bytes and adds one, others forget the one."""
    path = tmp_path / "odd.gst"
    for filling in (b"\0", b""):
        chunks = chunks_of(stored(keyboard(), tmp_path))
        pad = next(i for i, chunk in enumerate(chunks) if b"pad" in chunk)
        chunks[pad] = b"CHAN" + struct.pack(">I", 9) + chunks[pad][8:17] + filling
        path.write_bytes(form_of(chunks))
        found, warnings = read_all(path)
        assert_same(found, keyboard())
        assert len(warnings) == 1
        assert "odd size" in warnings[0]


def changed(chunks: list[bytes], name: bytes, at: int, new: bytes) -> bytes:
    """The form with bytes of the first chunk of a name put in place of its own."""
    index = next(i for i, chunk in enumerate(chunks) if chunk.startswith(name))
    chunk = bytearray(chunks[index])
    chunk[at : at + len(new)] = new
    return form_of([*chunks[:index], bytes(chunk), *chunks[index + 1 :]])


AFTER_NAME = 8 + 2 + 4
REFUSED = {
    "version": (b"VERS", 8, struct.pack(">H", 1), "version 1.1", 20),
    "frequency 0": (b"SCEN", AFTER_NAME + 4, bytes(8), "frequency must be above 0", 42),
    "type of data": (b"SCEN", AFTER_NAME + 12, struct.pack(">H", 4), "type of data 4", 50),
    "length of a name": (b"SCEN", 8, struct.pack(">H", 999), "ends within the scene's name", 34),
    "dimension": (b"CHAN", 8 + 2 + 2, struct.pack(">H", 9), "dimension 9 of channel 'PK'", None),
}


@pytest.mark.parametrize("what", REFUSED)
def test_what_can_not_be_understood_is_refused_with_its_byte(what: str, tmp_path: Path) -> None:
    name, at, new, message, byte = REFUSED[what]
    path = tmp_path / "bad.gst"
    path.write_bytes(changed(chunks_of(stored(keyboard(), tmp_path)), name, at, new))
    with pytest.raises(FormatError, match=message) as caught:
        read_scene(path)
    expected = byte if byte is not None else path.read_bytes().index(b"CHAN") + at
    assert caught.value.byte == expected


def test_chunks_in_an_order_that_has_no_meaning_are_refused(tmp_path: Path) -> None:
    vers, scen, unit, key, pad, frames = chunks_of(stored(keyboard(), tmp_path))
    for chunks, message in (
        ([scen, unit, key, pad, frames], "no version"),
        ([vers, unit, key, pad, frames], "before their scene"),
        ([vers, scen, key, pad, frames], "before any unit"),
        ([vers, scen, unit, frames], "before any channel"),
        ([vers, scen, unit, key, frames, pad], "after the frames"),
        ([vers, scen, scen, unit, key, pad, frames], "second scene"),
        ([vers, scen, unit, key, pad, frames, frames], "second frame"),
        ([vers, scen, unit, key, pad], "before its frames"),
    ):
        (tmp_path / "bad.gst").write_bytes(form_of(chunks))
        with pytest.raises(FormatError, match=message) as caught:
            read_scene(tmp_path / "bad.gst")
        assert caught.value.byte is not None


def test_counts_that_disagree_are_repaired_with_a_warning(tmp_path: Path) -> None:
    path = tmp_path / "odd.gst"
    chunks = chunks_of(stored(keyboard(), tmp_path))
    whole = form_of(chunks)
    cases = {
        "scene counts more": changed(chunks, b"SCEN", AFTER_NAME, struct.pack(">I", 99)),
        "scene counts none": changed(chunks, b"SCEN", AFTER_NAME, bytes(4)),
        "the form is shorter": b"FORM" + bytes(4) + whole[8:],
        "the form is longer": b"FORM" + b"\xff" * 4 + whole[8:],
        "never finished": whole[: whole.index(b"FRAM") + 4]
        + b"\xff" * 4
        + whole[whole.index(b"FRAM") + 8 :],
    }
    for case, data in cases.items():
        path.write_bytes(data)
        found, warnings = read_all(path)
        assert_same(found, keyboard())
        assert len(warnings) == 1, case


def test_repairs_that_lose_nothing_of_the_frames(tmp_path: Path) -> None:
    path = tmp_path / "odd.gst"
    chunks = chunks_of(stored(keyboard(), tmp_path))
    empty = b"UNIT" + struct.pack(">IH", 6, 4) + b"none"
    cases = {
        "subversion": changed(chunks, b"VERS", 10, struct.pack(">H", 2)),
        "a scale of floats": changed(chunks, b"SCEN", AFTER_NAME + 14, struct.pack(">d", 3.0)),
        "a block elsewhere": changed(chunks, b"SCEN", AFTER_NAME + 22, struct.pack(">I", 4096)),
        "a unit of nothing": form_of([*chunks[:2], empty, *chunks[2:]]),
        "something behind": form_of(chunks) + b"behind",
    }
    for case, data in cases.items():
        path.write_bytes(data)
        found, warnings = read_all(path)
        assert_same(found, keyboard())
        assert len(warnings) == 1, case


def test_names_in_latin_1_and_with_a_closing_nul_are_read(tmp_path: Path) -> None:
    path = tmp_path / "name.gst"
    chunks = chunks_of(stored(keyboard(), tmp_path))
    path.write_bytes(changed(chunks, b"UNIT", 10, b"n\xe9e\0"))
    found, warnings = read_all(path)
    assert found.units[0].name == "née"
    assert len(warnings) == 1
    assert "Latin-1" in warnings[0]


def test_our_chunks_that_do_not_fit_are_left_aside(tmp_path: Path) -> None:
    path = tmp_path / "other.gst"
    chunks = chunks_of(stored(rated(), tmp_path))
    for name, at, new in (
        (b"RATE", 8, struct.pack(">d", 9999.0)),
        (b"RATE", 8, struct.pack(">d", np.nan)),
        (b"RATE", 4, struct.pack(">I", 8)),
        (b"MEAS", 8, struct.pack(">H", 60_000)),
        (b"MEAS", 10, b"XX(P)"),
    ):
        path.write_bytes(changed(chunks, name, at, new))
        if at == 4:
            index = next(i for i, chunk in enumerate(chunks) if chunk.startswith(name))
            short = b"RATE" + new + chunks[index][8:16]
            path.write_bytes(form_of([*chunks[:index], short, *chunks[index + 1 :]]))
        found, warnings = read_all(path)
        assert any(name.decode() in warning for warning in warnings)
        assert np.isfinite(found.signals[0]).all()
        np.testing.assert_array_equal(found.signals[0], rated().signals[0])


def test_sizes_that_lie_take_no_memory(tmp_path: Path) -> None:
    path = tmp_path / "liar.gst"
    chunks = chunks_of(stored(rated(), tmp_path))
    data = bytearray(changed(chunks, b"SCEN", 8 + 2 + 3, b"\xff" * 4))
    data[4:8] = b"\xff" * 4
    at = data.index(b"FRAM")
    data[at + 4 : at + 8] = b"\xff" * 4
    path.write_bytes(bytes(data))
    tracemalloc.start()
    found, _ = read_all(path)
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert len(found.signals[0]) == 8
    assert peak < 300_000


def test_a_million_tiny_chunks_are_refused(tmp_path: Path) -> None:
    path = tmp_path / "many.gst"
    chunks = chunks_of(stored(keyboard(), tmp_path))
    path.write_bytes(form_of([chunks[0], (b"NOTE" + bytes(4)) * 1_000_000, *chunks[1:]]))
    with pytest.raises(FormatError, match="more than 65536 chunks"):
        read_scene(path)


def test_no_file_at_all(tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "pipe.gst")
    for path in (tmp_path / "none.gst", tmp_path, tmp_path / "pipe.gst", Path("/dev/null")):
        with pytest.raises(FormatError, match="can't be read"):
            read_scene(path)
    (tmp_path / "empty.gst").touch()
    with pytest.raises(FormatError) as caught:
        read_scene(tmp_path / "empty.gst")
    assert caught.value.byte == 0


def read_or_refuse(path: Path) -> bool:
    """Whether it was read; anything but a FormatError with its byte is raised."""
    try:
        with GestureReader(path) as reader:
            scene = reader.scene()
            assert all(line.isprintable() or "\\" in line for line in reader.warnings)
    except FormatError as error:
        if error.byte is None or not 0 <= error.byte <= path.stat().st_size:
            raise AssertionError("an error without its byte") from error
        return False
    assert sum(signal.nbytes for signal in scene.signals) <= 4 * path.stat().st_size
    return True


@settings(max_examples=80, suppress_health_check=[HealthCheck.too_slow])
@given(scenes(most_samples=4), st.integers(0, 2**32), st.sampled_from(["big", "little"]))
def test_a_broken_file_is_read_or_refused_with_its_byte(
    scene: Scene, seed: int, order: Order
) -> None:
    rng = np.random.default_rng(seed)
    with TemporaryDirectory() as folder:
        whole = stored(scene, Path(folder), Encoding(order=order))
        for _ in range(20):
            (Path(folder) / "broken.gst").write_bytes(mutated(whole, rng))
            read_or_refuse(Path(folder) / "broken.gst")


@pytest.mark.soak
def test_a_million_broken_files(tmp_path: Path) -> None:
    rng = np.random.default_rng(20051122)
    whole = [
        stored(scene, tmp_path, encoding)
        for scene in (keyboard(), rated())
        for encoding in (
            Encoding(),
            Encoding("float32", order="little"),
            Encoding("int32", 0.5, block_size=64),
        )
    ]
    path = tmp_path / "broken.gst"
    read = 0
    for turn in range(1_000_000):
        path.write_bytes(mutated(whole[turn % len(whole)], rng))
        read += read_or_refuse(path)
    assert 100_000 < read < 900_000
