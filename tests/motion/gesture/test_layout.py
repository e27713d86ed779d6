"""A file is, byte for byte, what ENACTIVE D.RD3.3.1 §4.5.4 prints."""

from __future__ import annotations

import runpy
import struct
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from enpointe.errors import FormatError
from enpointe.motion.gesture import (
    Channel,
    Dimension,
    Encoding,
    Scene,
    Unit,
    Variable,
    read_scene,
    write_scene,
)

from .scenes import assert_same, keyboard, read_all

PRINTED_DIMENSIONS = {
    Dimension.SCALAR: 1,
    Dimension.X: 2,
    Dimension.Y: 3,
    Dimension.Z: 4,
    Dimension.XY: 5,
    Dimension.YZ: 6,
    Dimension.ZX: 7,
    Dimension.XYZ: 8,
}


def printed(data_type: int, scale: float, frames: bytes, frame_bytes: int) -> bytes:
    """The keyboard of two frames, each field of §4.5.4 in its order."""
    before_frames = (
        b"VERS" + struct.pack(">I", 4) + struct.pack(">HH", 0, 1),
        b"SCEN"
        + struct.pack(">I", 2 + 4 + 4 + 8 + 2 + 8 + 4)
        + struct.pack(">H", 4)  # sceneNameLength
        + b"keys"  # sceneName
        + struct.pack(">I", 2)  # nbFrame
        + struct.pack(">d", 4000.0)  # frequency
        + struct.pack(">H", data_type)
        + struct.pack(">d", scale)
        + struct.pack(">I", frame_bytes),  # blockSize, by default a frame's
        b"UNIT" + struct.pack(">I", 6) + struct.pack(">H", 4) + b"hand",
        b"CHAN" + struct.pack(">I", 8) + struct.pack(">H", 2) + b"PK" + struct.pack(">HH", 4, 0),
        # Three letters make nine bytes: a tenth is added, and counted.
        b"CHAN"
        + struct.pack(">I", 10)
        + struct.pack(">H", 3)
        + b"pad"
        + struct.pack(">HH", 5, 1)
        + b"\0",
        b"FRAM" + struct.pack(">I", 2 * frame_bytes) + frames,
    )
    content = b"GST " + b"".join(before_frames)
    return b"FORM" + struct.pack(">I", len(content)) + content


@pytest.mark.parametrize(
    ("encoding", "data_type", "scale", "letter"),
    [
        (Encoding("float32"), 1, 1.0, "f"),
        (Encoding("float64"), 2, 1.0, "d"),
        (Encoding("int32", 0.25), 3, 0.25, "i"),
    ],
    ids=["float32", "float64", "integers"],
)
def test_every_byte_of_a_file(
    encoding: Encoding, data_type: int, scale: float, letter: str, tmp_path: Path
) -> None:
    scene, path = keyboard(2), tmp_path / "keys.gst"
    write_scene(scene, path, encoding)
    numbers = [value / scale for value in scene.signals[0].ravel()]
    stored = [int(n) for n in numbers] if letter == "i" else numbers
    frames = struct.pack(f">6{letter}", *stored)
    assert path.read_bytes() == printed(data_type, scale, frames, len(frames) // 2)
    assert_same(read_scene(path), scene)


@pytest.mark.parametrize(("dimension", "code"), PRINTED_DIMENSIONS.items())
def test_the_codes_of_dimensions_and_their_tracks(
    dimension: Dimension, code: int, tmp_path: Path
) -> None:
    path = tmp_path / "one.gst"
    unit = Unit("unit", (Channel("ch", dimension=dimension),), 100.0)
    write_scene(Scene("", (unit,), (np.ones((3, dimension.width)),)), path)
    data = path.read_bytes()
    at = data.index(b"CHAN") + 8 + 2 + 2
    assert struct.unpack_from(">HH", data, at) == (code, 0)
    assert struct.unpack_from(">I", data, data.index(b"FRAM") + 4) == (3 * dimension.width * 8,)
    assert dimension.width == (1 if code < 5 else 2 if code < 8 else 3)
    assert read_scene(path).units == (unit,)


def test_an_integer_has_a_sign_unless_the_reader_is_told_otherwise(tmp_path: Path) -> None:
    path = tmp_path / "signed.gst"
    unit = Unit("unit", (Channel("ch", Variable.FORCE, Dimension.X),), 100.0)
    write_scene(Scene("", (unit,), (np.array([[-1.5], [2.0]]),)), path, Encoding("int32", 0.5))
    assert path.read_bytes().endswith(bytes.fromhex("fffffffd 00000004"))
    assert read_scene(path).signals[0].tolist() == [[-1.5], [2.0]]
    assert read_scene(path, unsigned=True).signals[0].tolist() == [[(2**32 - 3) / 2], [2.0]]


@pytest.mark.parametrize("encoding", [Encoding(), Encoding(order="little")], ids=["big", "little"])
def test_an_id_of_five_letters_as_it_is_printed_is_read(encoding: Encoding, tmp_path: Path) -> None:
    path = tmp_path / "five.gst"
    write_scene(keyboard(), path, encoding)
    path.write_bytes(path.read_bytes().replace(b"FRAM", b"FRAME"))
    scene, warnings = read_all(path)
    assert_same(scene, keyboard())
    assert any("five letters" in warning for warning in warnings)


def test_the_low_byte_first_is_read_and_said(tmp_path: Path) -> None:
    path = tmp_path / "little.gst"
    write_scene(keyboard(), path, Encoding("float32", order="little"))
    data = path.read_bytes()
    assert struct.unpack_from("<I", data, 4) == (len(data) - 8,)
    assert data[12:24] == b"VERS\4\0\0\0\0\0\1\0"
    scene, warnings = read_all(path)
    assert_same(scene, keyboard())
    assert any("low byte first" in warning for warning in warnings)


@pytest.mark.parametrize("block", [1, 7, 24, 512, 4096])
def test_frames_begin_and_the_file_ends_at_a_block(block: int, tmp_path: Path) -> None:
    path = tmp_path / "blocks.gst"
    write_scene(keyboard(), path, Encoding(block_size=block))
    data = path.read_bytes()
    start = data.index(b"FRAM") + 8
    assert start % block == 0
    assert len(data) % block == 0
    assert len(data) % 2 == 0
    assert struct.unpack_from(">I", data, 4) == (len(data) - 8,)
    scene, warnings = read_all(path)
    assert_same(scene, keyboard())
    assert not warnings


def test_without_a_block_size_nothing_is_filled(tmp_path: Path) -> None:
    write_scene(keyboard(), tmp_path / "plain.gst")
    assert b"    " not in (tmp_path / "plain.gst").read_bytes()


def test_what_version_0_1_holds_has_none_of_our_chunks(tmp_path: Path) -> None:
    write_scene(keyboard(), tmp_path / "plain.gst")
    data = (tmp_path / "plain.gst").read_bytes()
    assert b"MEAS" not in data
    assert b"RATE" not in data


@pytest.fixture(scope="module")
def five_units(root_dir: Path, tmp_path_factory: pytest.TempPathFactory) -> tuple[bytes, Scene]:
    """The file that the example makes, and the scene in it."""
    folder = tmp_path_factory.mktemp("example")
    with pytest.MonkeyPatch.context() as patch:
        patch.chdir(folder)
        made: dict[str, Any] = runpy.run_path(str(root_dir / "examples" / "gesture_scene.py"))
    scene = Scene("VR scene", made["units"], tuple(made["signals"]))
    return (folder / "five_units.gst").read_bytes(), scene


def test_the_five_units_of_the_document_field_by_field(five_units: tuple[bytes, Scene]) -> None:
    data, scene = five_units
    head = data[: data.index(b"FRAM")]
    names = [name_at(head, at) for at in places(head, b"UNIT")]
    assert names == ["Pianist gesture", "StickSource", "Light", "Dancer", "Juggler"]
    found = []
    for at in places(head, b"CHAN"):
        name = name_at(head, at)
        found.append((name, *struct.unpack_from(">HH", head, at + 10 + len(name))))
    keys = [(f"PK{i}", 4, 0) for i in range(1, 9)]
    points = [(f"DP{i}", 8, 0) for i in range(1, 17)]
    assert found == [*keys, ("SS", 8, 0), ("LS", 5, 1), *points, ("BL1", 8, 0), ("BL2", 8, 0)]
    frames, rate, kind, scale, block = struct.unpack_from(
        ">IdHdI", head, 24 + 8 + 2 + len("VR scene")
    )
    tracks = 8 + 3 + 2 + 16 * 3 + 2 * 3
    assert (frames, rate, kind, scale, block) == (4000, 4000.0, 2, 1.0, 8 * tracks)
    assert struct.unpack_from(">I", data, data.index(b"FRAM") + 4) == (4000 * 8 * tracks,)
    last = [signal[-1] for signal in scene.signals]
    assert data[-8 * tracks :] == np.concatenate(last).astype(">f8").tobytes()


def test_the_five_units_come_back_at_their_own_rates(
    five_units: tuple[bytes, Scene], tmp_path: Path
) -> None:
    path = tmp_path / "five.gst"
    path.write_bytes(five_units[0])
    scene, warnings = read_all(path)
    assert_same(scene, five_units[1])
    assert not warnings
    assert [unit.rate for unit in scene.units] == [1000, 200, 400, 120, 4000]


def test_a_reader_of_version_0_1_alone_sees_every_unit(
    five_units: tuple[bytes, Scene], tmp_path: Path
) -> None:
    """Our chunks under other names: left aside, with every unit at the file's one frequency."""
    path = tmp_path / "five.gst"
    path.write_bytes(five_units[0].replace(b"MEAS", b"XXXX").replace(b"RATE", b"YYYY"))
    scene, warnings = read_all(path)
    assert len(warnings) == 2
    assert [unit.rate for unit in scene.units] == [4000.0] * 5
    dancer = five_units[1].signals[3]
    held = np.floor(np.arange(4000) * 120 / 4000).astype(int)
    np.testing.assert_array_equal(scene.signals[3], dancer[held])
    assert scene.units[4].channels[1] == Channel("BL2", Variable.POSITION, Dimension.XYZ)


def test_a_gms_file_is_refused_by_name(tmp_path: Path) -> None:
    path = tmp_path / "later.gms"
    write_scene(keyboard(), path)
    path.write_bytes(path.read_bytes().replace(b"GST ", b"GMS "))
    with pytest.raises(FormatError, match="GMS") as caught:
        read_scene(path)
    assert caught.value.byte == 8


def places(data: bytes, chunk: bytes) -> list[int]:
    return [at for at in range(len(data)) if data.startswith(chunk, at)]


def name_at(data: bytes, chunk: int) -> str:
    (length,) = struct.unpack_from(">H", data, chunk + 8)
    return data[chunk + 10 : chunk + 10 + length].decode()
