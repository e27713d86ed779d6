"""Spoiled files: whatever is in them, a reader gives a movement or a FormatError with a place."""

from __future__ import annotations

import random
import warnings
from functools import cache
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from enpointe.errors import FormatError
from enpointe.motion.formats import (
    Format,
    Joint,
    MarkerMotion,
    Skeleton,
    SkeletonMotion,
    Space,
    formats,
)

from .making import marker_motion
from .mutants import binary_mutant, text_mutant

OURS = ("C3D", "TRC", "CSM", "AOA", "BRD", "CSV", "CSV of joints", "BAP")
ALL = {each.name: each for each in formats()}
FORMATS = {name: ALL[name] for name in OURS}
REAL = {
    "TRC": ("trc/T.trc", "trc/Gait.trc", "trc_opensim/exampleFormat.trc"),
    "CSM": ("csm/ThomasFechten.csm",),
    "C3D": ("c3d_org/sample02/DEC_INT.C3D", "c3d_org/sample02/sgi_real.c3d"),
}
SHORT = 30_000
SOAK = 20_000


def joints() -> SkeletonMotion:
    """A few channels that both tables of joints can hold."""
    hip = Joint("l_hip", 0, channels=("Xrotation", "Zrotation"))
    root = Joint("HumanoidRoot", -1, channels=("Xposition", "Yrotation"))
    values = np.arange(12, dtype=float).reshape(3, 4)
    return SkeletonMotion(Skeleton((root, hip), Space(0.001, "y", 1.0)), 25.0, values)


@cache
def made_files(name: str) -> list[bytes]:
    """What our own writer makes of plain, gappy and rich movements."""
    each, made = FORMATS[name], []
    assert each.write is not None
    plain = [marker_motion(), marker_motion(gaps=True), marker_motion(gaps=True, rich=True)]
    with TemporaryDirectory() as folder:
        path = Path(folder) / f"made{each.suffixes[0]}"
        for motion in plain if each.kind == "markers" else [joints()]:
            each.write(motion, path)
            made.append(path.read_bytes())
    return made


def taken_or_refused(each: Format, path: Path, raw: bytes) -> None:
    """Anything but a movement or a FormatError with a place fails, warnings as well."""
    path.write_bytes(raw)
    error = None
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        try:
            each.sniff(raw[:4096])
            content = each.read(path)
        except FormatError as refusal:
            error = refusal
    if error is None:
        assert isinstance(content.motion, MarkerMotion | SkeletonMotion)
        assert content.motion.frames > 0
        assert np.isfinite(content.motion.rate)
    else:
        assert error.line is not None or error.byte is not None
        assert "\n" not in str(error)


@pytest.mark.parametrize("name", FORMATS)
@settings(max_examples=60)
@given(seed=st.integers(0, 2**32))
def test_mutants_are_read_or_refused(
    tmp_path_factory: pytest.TempPathFactory, name: str, seed: int
) -> None:
    each, dice = FORMATS[name], random.Random(seed)
    mutant = binary_mutant if name == "C3D" else text_mutant
    raw = mutant(dice.choice(made_files(name)), dice)
    taken_or_refused(each, tmp_path_factory.getbasetemp() / "mutant", raw)


@pytest.mark.parametrize("name", FORMATS)
@given(noise=st.binary(max_size=2000) | st.text(max_size=500).map(str.encode))
def test_noise_is_read_or_refused(
    tmp_path_factory: pytest.TempPathFactory, name: str, noise: bytes
) -> None:
    taken_or_refused(FORMATS[name], tmp_path_factory.getbasetemp() / "noise", noise)


@pytest.mark.parametrize("name", ALL)
def test_no_such_file_and_empty_files(tmp_path: Path, name: str) -> None:
    """Nothing, a byte order mark alone, and blanks that only Unicode or Latin-1 has."""
    with pytest.raises(FormatError):
        ALL[name].read(tmp_path / "nowhere")
    with pytest.raises(FormatError):
        ALL[name].read(tmp_path)
    for raw in (b"", b"\xef\xbb\xbf\n", b"\xa0", "\u2003\n\x85\n".encode(), b"\x1c\x1d"):
        taken_or_refused(ALL[name], tmp_path / "empty", raw)


@pytest.mark.soak
@pytest.mark.slow
@pytest.mark.parametrize("name", FORMATS)
def test_twenty_thousand_mutants_of_real_and_made_files(
    data_dir: Path, tmp_path: Path, name: str
) -> None:
    each, dice = FORMATS[name], random.Random(20)
    seeds = list(made_files(name))
    seeds += [(data_dir / file).read_bytes()[:SHORT] for file in REAL.get(name, ())]
    mutant = binary_mutant if name == "C3D" else text_mutant
    for _ in range(SOAK):
        taken_or_refused(each, tmp_path / "mutant", mutant(dice.choice(seeds), dice))
