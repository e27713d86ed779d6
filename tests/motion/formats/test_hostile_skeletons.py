"""Whatever happened to a file, a reader says so in one line, or reads it whole."""

from __future__ import annotations

import random
import tracemalloc
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from enpointe.errors import FormatError
from enpointe.motion.formats import SkeletonMotion, formats
from enpointe.motion.formats.text import CUT

from .mutants import mutant
from .skeletons import BVA_DOCUMENT, BVH_DOCUMENT, HTR_DOCUMENT, small

DATA = Path(__file__).resolve().parents[4] / "shared" / "data"
READERS = {
    each.suffixes[0]: each.read
    for each in formats()
    if each.suffixes[0] in (".bvh", ".ask", ".amc", ".asf", ".bva", ".htr", ".gtr")
}


@pytest.fixture(scope="module")
def originals(tmp_path_factory: pytest.TempPathFactory) -> dict[str, list[bytes]]:
    """Whole files of each format, small enough to read thousands of times."""
    files = {
        suffix: [path.read_bytes()]
        for suffix, path in small(tmp_path_factory.mktemp("originals")).items()
    }
    files[".bvh"].append(BVH_DOCUMENT.encode())
    files[".bva"].append(BVA_DOCUMENT.encode())
    files[".htr"].append(HTR_DOCUMENT.encode())
    files[".gtr"].append(HTR_DOCUMENT.replace("FileType htr", "FileType gtr").encode())
    if DATA.is_dir():
        files[".bvh"] += [
            first_lines(DATA / "cmu_bvh_motionbuilder" / "05_14.bvh", 190, b"643", b"3"),
            first_lines(DATA / "bvh_various" / "131_01.bvh", 190, b"994", b"3"),
        ]
        files[".asf"].append((DATA / "cmu_05" / "05.asf").read_bytes())
    return files


def first_lines(path: Path, count: int, declared: bytes, kept: bytes) -> bytes:
    """The beginning of a real file, with as many frames declared as are left."""
    lines = path.read_bytes().split(b"\n")[:count]
    return b"\n".join(lines).replace(b"Frames: " + declared, b"Frames: " + kept) + b"\n"


def refused_or_read(suffix: str, raw: bytes, folder: Path) -> bool:
    """Whether a file was read; anything but a FormatError with a place in the file comes out."""
    path = folder / f"small{suffix}"
    path.write_bytes(raw)
    error, content = None, None
    try:
        content = READERS[suffix](path)
    except FormatError as raised:
        error = raised
    if error is not None:
        lines = 2 + raw.count(b"\n") + raw.count(b"\r")
        assert "\n" not in str(error)
        assert error.byte is not None or 1 <= (error.line or 0) <= lines
    if content is None:
        return False
    motion = content.motion
    assert isinstance(motion, SkeletonMotion)
    assert motion.frames
    assert not np.isinf(motion.values).any()
    assert suffix in (".htr", ".gtr") or np.isfinite(motion.values).all()
    return True


@pytest.mark.parametrize("suffix", sorted(READERS))
@settings(max_examples=150)
@given(seed=st.integers(0, 2**32))
def test_mutants_are_read_or_refused(
    originals: dict[str, list[bytes]],
    tmp_path_factory: pytest.TempPathFactory,
    suffix: str,
    seed: int,
) -> None:
    """A file to which one to three accidents happened."""
    folder = tmp_path_factory.getbasetemp() / "mutants"
    if not folder.is_dir():
        small(folder)
    dice = random.Random(seed)
    refused_or_read(suffix, mutant(dice.choice(originals[suffix]), dice), folder)


@pytest.mark.soak
@pytest.mark.slow
@pytest.mark.parametrize("suffix", sorted(READERS))
def test_many_mutants_are_read_or_refused(
    originals: dict[str, list[bytes]], tmp_path: Path, suffix: str
) -> None:
    """Twenty thousand of each format; some are still read, or the mutants are too wild."""
    small(tmp_path)
    dice = random.Random(11)
    read = sum(
        refused_or_read(suffix, mutant(dice.choice(originals[suffix]), dice), tmp_path)
        for _ in range(20_000)
    )
    assert 200 < read < 19_000


@pytest.mark.parametrize("suffix", [".bvh", ".bva", ".htr", ".amc"])
def test_every_cut_is_read_or_refused(
    originals: dict[str, list[bytes]], tmp_path: Path, suffix: str
) -> None:
    """A file that ends anywhere; what is read of it is what the whole file says, or is warned of.

    Where a file ends within its very last number, nothing but the missing line end shows it.
    """
    raw = originals[suffix][0]
    small(tmp_path)
    path = tmp_path / f"small{suffix}"
    whole = READERS[suffix](path).motion
    assert isinstance(whole, SkeletonMotion)
    for end in range(0, len(raw) - 1, 3):
        if refused_or_read(suffix, raw[:end], tmp_path):
            content = READERS[suffix](path)
            assert isinstance(content.motion, SkeletonMotion)
            values = content.motion.values
            other = values != whole.values[: len(values), : values.shape[1]]
            warned = any(CUT in warning for warning in content.warnings)
            assert other[:-1].sum() == 0
            assert other.sum() <= warned


@pytest.mark.parametrize(
    ("suffix", "old", "new"),
    [
        (".bvh", "Frames: 3", "Frames: 999999999"),
        (".bvh", "CHANNELS 3", "CHANNELS 999999999"),
        (".bva", "Frames: 3", "Frames: 999999999"),
        (".htr", "NumFrames 3", "NumFrames 999999999"),
        (".htr", "NumSegments", "NumSegments 99999999 #"),
    ],
)
def test_a_declared_count_takes_no_memory(tmp_path: Path, suffix: str, old: str, new: str) -> None:
    """Room is made for what is in a file, not for what it says is in it."""
    path = small(tmp_path)[suffix]
    text = path.read_text()
    assert old in text
    path.write_text(text.replace(old, new, 1))
    tracemalloc.start()
    try:
        READERS[suffix](path)
    except FormatError:
        pass
    finally:
        _, peak = tracemalloc.get_traced_memory()
        tracemalloc.stop()
    assert peak < 2_000_000


def test_memory_is_under_four_times_the_file(tmp_path: Path) -> None:
    """A BVH of 4 MB: its bytes, its numbers, and a block at a time."""
    path = tmp_path / "long.bvh"
    head, rows = BVH_DOCUMENT.split("0.033333\n")
    path.write_text(head.replace("Frames: 2", "Frames: 60000") + "0.033333\n" + rows * 30_000)
    tracemalloc.start()
    READERS[".bvh"](path)
    _, peak = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    assert peak < 4 * path.stat().st_size


def test_a_chain_of_thousands_of_joints(tmp_path: Path) -> None:
    """Depth is no recursion: 5000 joints, each on the last, are read."""
    path = tmp_path / "deep.bvh"
    joints = "".join(f"JOINT j{i}\n{{\nOFFSET 0 1 0\n" for i in range(5000))
    path.write_text(
        "HIERARCHY\nROOT r\n{\nOFFSET 0 0 0\nCHANNELS 1 Xrotation\n"
        + joints
        + "}\n" * 5001
        + "MOTION\nFrames: 1\nFrame Time: 0.1\n5\n"
    )
    motion = READERS[".bvh"](path).motion
    assert isinstance(motion, SkeletonMotion)
    assert len(motion.skeleton.joints) == 5001
