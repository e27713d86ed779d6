"""Reading takes less memory than four times the file, whatever the format."""

from __future__ import annotations

import tracemalloc
from contextlib import suppress
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from enpointe.errors import FormatError
from enpointe.motion.formats import (
    Joint,
    MarkerMotion,
    Skeleton,
    SkeletonMotion,
    Space,
    read,
    write,
)
from enpointe.motion.formats.c3d import write_c3d

_SIX = tuple(f"{axis}{kind}" for kind in ("position", "rotation") for axis in "XYZ")


def peak_of_reading(path: Path) -> float:
    """Most memory that reading has at a time, in sizes of the file; read or refused."""
    with suppress(FormatError):
        read(path)
    tracemalloc.start()
    with suppress(FormatError):
        read(path)
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    return peak / path.stat().st_size


def captured_markers(frames: int) -> MarkerMotion:
    points = np.round(np.random.default_rng(5).normal(0, 600, (frames, 40, 3)) * 64) / 64
    return MarkerMotion(tuple(map(str, range(40))), 120.0, points, Space(0.001, "z"))


def captured_skeleton() -> SkeletonMotion:
    joints = [Joint("hips", -1, channels=_SIX)]
    joints += [Joint(f"bone {i}", i, (0.0, 9.0, 0.0), _SIX[3:]) for i in range(19)]
    values = np.round(np.random.default_rng(5).normal(0, 40, (3000, 63)), 4)
    return SkeletonMotion(Skeleton(tuple(joints), Space(0.01)), 120.0, values)


@pytest.mark.parametrize("suffix", [".aoa", ".brd", ".c3d", ".csm", ".csv", ".gst", ".trc"])
def test_markers(tmp_path: Path, suffix: str) -> None:
    path = tmp_path / f"markers{suffix}"
    write(captured_markers(600), path)
    assert peak_of_reading(path) < 4


@pytest.mark.parametrize("suffix", [".aoa", ".brd", ".csm", ".csv", ".trc"])
def test_markers_with_gaps_and_a_fault_far_down(tmp_path: Path, suffix: str) -> None:
    """Rows that only the slow reader can tell, and the line of the one that is none."""
    path = tmp_path / f"markers{suffix}"
    motion = captured_markers(600)
    motion.positions[::7, :9] = np.nan
    write(motion, path)
    lines = path.read_bytes().split(b"\n")
    fault = 4 * len(lines) // 5
    lines[fault] = lines[fault][:-1] + b"x"
    path.write_bytes(b"\n".join(lines))
    with pytest.raises(FormatError) as caught:
        read(path)
    assert caught.value.line == fault + 1
    assert peak_of_reading(path) < 4


@pytest.mark.parametrize("suffix", [".aoa", ".csm", ".csv", ".trc"])
def test_markers_with_gaps(tmp_path: Path, suffix: str) -> None:
    """All of the gaps come back, wherever a block of the file ends."""
    path = tmp_path / f"markers{suffix}"
    motion = captured_markers(600)
    motion.positions[::7, :9] = np.nan
    write(motion, path)
    again = read(path).motion
    assert isinstance(again, MarkerMotion)
    np.testing.assert_array_equal(again.positions, motion.positions)
    assert peak_of_reading(path) < 4


@pytest.mark.parametrize("suffix", [".amc", ".bvh", ".csv", ".gst"])
def test_skeletons(tmp_path: Path, suffix: str) -> None:
    path = tmp_path / f"skeleton{suffix}"
    write(captured_skeleton(), path)
    assert peak_of_reading(path) < 4


@pytest.mark.parametrize("suffix", [".bva", ".gtr", ".htr"])
def test_skeletons_whose_joints_all_have_places(tmp_path: Path, suffix: str) -> None:
    path = tmp_path / f"skeleton{suffix}"
    motion = captured_skeleton()
    few = SkeletonMotion(motion.skeleton, motion.rate, motion.values[:400])
    write(few, path)
    assert peak_of_reading(path) < 4


def test_integer_points_with_residuals_and_cameras(tmp_path: Path) -> None:
    """Eight bytes become 29: three float64, a float32 and a mask."""
    path = tmp_path / "measured.c3d"
    motion = captured_markers(3000)
    motion.positions[::5, :9] = np.nan
    residuals = np.where(motion.seen, np.float32(0.5), np.float32(np.nan))
    cameras = np.where(motion.seen, 5, 0).astype(np.uint8)
    write_c3d(replace(motion, residuals=residuals, cameras=cameras), path, scale=0.125)
    assert peak_of_reading(path) < 4
