"""C3D: six encodings that read equal, signals and events kept, counts never believed unseen."""

from __future__ import annotations

import importlib
import struct
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from enpointe.errors import FormatError
from enpointe.motion.formats import MarkerMotion, read
from enpointe.motion.formats.c3d import read_c3d, write_c3d
from enpointe.motion.formats.c3d_parameters import Encoding

from .making import marker_motion, marker_motions

SIX = ("DEC_INT.C3D", "Dec_real.c3d", "pc_int.c3d", "pc_real.c3d", "sgi_int.c3d", "sgi_real.c3d")


def markers(path: Path) -> MarkerMotion:
    motion = read(path).motion
    assert isinstance(motion, MarkerMotion)
    return motion


def same_nan(a: Any, b: Any) -> bool:
    return (a is None and b is None) or np.array_equal(a, b, equal_nan=True)


def test_one_motion_in_six_encodings(data_dir: Path) -> None:
    """sample02: equal to the step of the integers, and the three real files to the bit."""
    folder = data_dir / "c3d_org" / "sample02"
    motions = {name: markers(folder / name) for name in SIX}
    first = motions["pc_real.c3d"]
    step = 0.28118187
    for name, motion in motions.items():
        assert motion.names == first.names
        assert motion.rate == 50.0
        assert motion.space == first.space
        assert same_nan(motion.seen, first.seen)
        assert np.nanmax(np.abs(motion.positions - first.positions)) <= step * 1.001, name
        assert motion.analog is not None
        assert first.analog is not None
        np.testing.assert_array_equal(motion.analog.values, first.analog.values)
        assert same_nan(motion.residuals, first.residuals)
    for name in ("Dec_real.c3d", "sgi_real.c3d"):
        np.testing.assert_array_equal(motions[name].positions, first.positions)
    np.testing.assert_array_equal(motions["pc_int.c3d"].positions, motions["sgi_int.c3d"].positions)
    assert [label.name for label in first.labels[:3]] == ["RHS", "STRT", "RMS"]


@pytest.mark.parametrize("package", ["c3d", "ezc3d"])
def test_other_readers_agree(data_dir: Path, package: str) -> None:
    peer = pytest.importorskip(package)
    for path in sorted(p for p in data_dir.rglob("*") if p.suffix.lower() == ".c3d"):
        if package == "ezc3d" and path.name.startswith("sgi"):
            continue  # it knows no SGI numbers
        motion = markers(path)
        theirs = peer_positions(peer, path)
        assert np.nanmax(np.abs(theirs - motion.positions)) < 2e-4, path
        np.testing.assert_array_equal(np.isfinite(theirs).all(axis=2), motion.seen)


@pytest.mark.parametrize("package", ["c3d", "ezc3d"])
@pytest.mark.parametrize("scale", [0.0, 0.125])
def test_other_readers_take_what_is_written(tmp_path: Path, package: str, scale: float) -> None:
    peer = pytest.importorskip(package)
    motion = marker_motion(rich=True, gaps=True)
    write_c3d(motion, tmp_path / "made.c3d", scale=scale)
    theirs = peer_positions(peer, tmp_path / "made.c3d")
    assert np.nanmax(np.abs(theirs - motion.positions)) <= max(scale / 2, 1e-4) * 1.001
    np.testing.assert_array_equal(np.isfinite(theirs).all(axis=2), motion.seen)


def peer_positions(peer: Any, path: Path) -> Any:
    if peer.__name__ == "ezc3d":
        return peer.c3d(str(path))["data"]["points"][:3].transpose(2, 1, 0)
    with path.open("rb") as file, np.errstate(all="ignore"):
        importlib.import_module("warnings").simplefilter("ignore")
        frames = np.array([points for _, points, _ in peer.Reader(file).read_frames()])
    return np.where(frames[..., 3:4] < 0, np.nan, frames[..., :3])


def test_real_files_read_and_write_back(data_dir: Path, tmp_path: Path) -> None:
    """Integer files as integers, real ones as floats, with signals, events, marks and notes."""
    paths = sorted(p for p in data_dir.rglob("*") if p.suffix.lower() == ".c3d")
    assert len(paths) >= 10
    for path in paths:
        content = read(path)
        motion = content.motion
        assert isinstance(motion, MarkerMotion)
        assert all(line.startswith("descriptions of") for line in content.lost)
        assert write_c3d(motion, tmp_path / "again.c3d") == ()
        again = markers(tmp_path / "again.c3d")
        for part in ("positions", "residuals", "cameras"):
            assert same_nan(getattr(again, part), getattr(motion, part)), (path, part)
        assert again.labels == motion.labels
        assert (again.names, again.rate, again.start) == (motion.names, motion.rate, motion.start)
        assert again.space == motion.space
        if motion.analog is not None:
            assert again.analog is not None
            np.testing.assert_array_equal(again.analog.values, motion.analog.values)
            assert again.analog.units == motion.analog.units
        changed = {k for k in motion.notes if again.notes.get(k) != motion.notes[k]}
        assert changed <= {"processor", "ANALOG:SCALE", "ANALOG:OFFSET", "ANALOG:GEN_SCALE"}


def test_everything_that_can_be_held_comes_back(tmp_path: Path) -> None:
    motion = marker_motion(rich=True, gaps=True)
    assert write_c3d(motion, tmp_path / "made.c3d") == (
        *(line for line in write_c3d(motion, tmp_path / "made.c3d") if "rounded" in line),
    )
    again = markers(tmp_path / "made.c3d")
    np.testing.assert_array_equal(again.positions, motion.positions)
    np.testing.assert_array_equal(again.cameras, motion.cameras)
    assert motion.residuals is not None
    assert again.residuals is not None
    np.testing.assert_allclose(again.residuals, motion.residuals, atol=0.07)
    assert again.labels == motion.labels
    assert again.analog is not None
    assert motion.analog is not None
    np.testing.assert_array_equal(again.analog.values, motion.analog.values)
    assert (again.analog.names, again.analog.units, again.analog.rate) == (
        motion.analog.names,
        motion.analog.units,
        motion.analog.rate,
    )
    assert again.notes["SUBJECTS:NAMES"] == motion.notes["SUBJECTS:NAMES"]
    assert again.notes["SUBJECTS:AGES"] == motion.notes["SUBJECTS:AGES"]


@settings(max_examples=40)
@given(motion=marker_motions(), scale=st.sampled_from([0.0, 100.0]))
def test_any_movement_comes_back_to_the_step(
    tmp_path_factory: pytest.TempPathFactory, motion: MarkerMotion, scale: float
) -> None:
    path = tmp_path_factory.mktemp("c3d") / "made.c3d"
    write_c3d(motion, path, scale=scale)
    again = markers(path)
    assert (again.names, again.start, again.space) == (motion.names, motion.start, motion.space)
    assert again.rate == np.float32(motion.rate)
    if scale:
        close = np.abs(again.positions - motion.positions) <= scale / 2 * (1 + 1e-6)
        assert (close | ~motion.seen[..., None]).all()
    else:
        np.testing.assert_array_equal(again.positions, motion.positions.astype(np.float32))


def test_a_point_too_far_for_the_step_is_refused(tmp_path: Path) -> None:
    with pytest.raises(FormatError, match="larger step"):
        write_c3d(marker_motion(), tmp_path / "far.c3d", scale=0.001)
    assert not (tmp_path / "far.c3d").exists()


def test_seventy_thousand_frames_and_three_hundred_markers(tmp_path: Path) -> None:
    """Counts beyond 16 bits, and more labels than one parameter holds."""
    positions = np.arange(70000 * 3, dtype=float).reshape(70000, 1, 3)
    write_c3d(MarkerMotion(("a",), 100.0, positions), tmp_path / "long.c3d")
    assert markers(tmp_path / "long.c3d").frames == 70000
    names = tuple(f"marker number {i} with a long name" for i in range(300))
    write_c3d(MarkerMotion(names, 100.0, np.zeros((2, 300, 3))), tmp_path / "wide.c3d")
    assert markers(tmp_path / "wide.c3d").names == names


@given(st.floats(-(2.0**90), 2.0**90, width=32))
def test_dec_floats(value: float) -> None:
    """A VAX float of a number, made by its definition, is that number."""
    expected = np.float32(value)
    bits = struct.unpack("<I", struct.pack("<f", float(expected)))[0]
    exponent = (bits >> 23) & 0xFF
    if exponent == 0:
        return
    vax = (bits & 0x807FFFFF) | ((exponent + 2) << 23)
    raw = struct.pack("<HH", vax >> 16, vax & 0xFFFF)
    assert Encoding("DEC").reals(raw)[0] == expected


@pytest.fixture
def made(tmp_path: Path) -> Path:
    path = tmp_path / "made.c3d"
    write_c3d(marker_motion(200), path, scale=0.0)
    return path


def patched(path: Path, at: int, data: bytes) -> Path:
    raw = path.read_bytes()
    path.write_bytes(raw[:at] + data + raw[at + len(data) :])
    return path


def test_a_file_cut_short_gives_its_whole_frames(made: Path) -> None:
    raw = made.read_bytes()
    made.write_bytes(raw[: len(raw) // 2])
    content = read_c3d(made)
    assert isinstance(content.motion, MarkerMotion)
    assert 0 < content.motion.frames < 200
    assert any("the file holds" in warning for warning in content.warnings)


@pytest.mark.parametrize(
    ("at", "data", "byte"),
    [
        (0, b"\0", 0),
        (1, b"Q", 0),
        (0, b"\xff", 254 * 512),
        (16, b"\xff\xff", 16),
        (16, b"\0\0", 16),
    ],
)
def test_a_header_that_makes_no_sense_is_refused_with_its_byte(
    made: Path, at: int, data: bytes, byte: int
) -> None:
    with pytest.raises(FormatError) as caught:
        read_c3d(patched(made, at, data))
    assert caught.value.byte == byte


def test_header_and_parameters_that_differ_are_told(made: Path) -> None:
    content = read_c3d(patched(made, 2, b"\xff\xff"))
    assert isinstance(content.motion, MarkerMotion)
    assert content.motion.frames == 200
    assert any("65535 points" in warning for warning in content.warnings)


def test_huge_counts_allocate_nothing(made: Path) -> None:
    """Thousands of millions of frames in a file of a few: the file's own size decides."""
    raw = made.read_bytes()
    frames = raw.find(b"FRAMES") + len(b"FRAMES") + 4
    last = raw.find(b"ACTUAL_END_FIELD") + len(b"ACTUAL_END_FIELD") + 5
    patched(made, frames, b"\xff\xff")
    patched(made, last, b"\xff\xff\xff\xff")
    patched(made, 8, b"\xff\xff")
    content = read_c3d(made)
    assert isinstance(content.motion, MarkerMotion)
    assert 200 <= content.motion.frames < 220
    assert any("the file holds" in warning for warning in content.warnings)
