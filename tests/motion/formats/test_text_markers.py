"""CSM, AOA and BRD: the examples of ENACTIVE D.RD3.3.1, round trips and refusals."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings

from enpointe.errors import FormatError
from enpointe.motion.formats import MarkerMotion, formats, read
from enpointe.motion.formats.aoa import read_aoa, write_aoa
from enpointe.motion.formats.brd import read_brd, write_brd
from enpointe.motion.formats.csm import read_csm, write_csm

from .making import marker_motion, marker_motions

CSM = """$comments
This is a Character Studio 2.0 CSM File

$firstframe 1
$lastframe 2
$spinelinks 3
$rate 60

$order
C7 CLAV LANK

$points
1 980.6 -2365.8 1541.3 1030.6 -2239.9 1492.1 967.3 -2427.5 181.8
2\t979.8\t-2358.9\t1540.1\t1029.4\t-2232.4\t1489.5\t966.5\t-2426.7\t181.8
"""
AOA = """AOA file written by LambSoft Pro Motion
frames = 2 nummarkers = 3 hz = 30
131.1524 163.0935 71.6937
124.6823 71.3264 76.5239
121.2981 2.4109 75.0063
131.2017 163.1528 71.7291
124.6200 71.3926 76.5561
121.2042 2.5331 75.0017
"""
BRD = """0 0 P 55.9477 32.7718 -5.2410 Q 0.7569 0.3548 -0.4984 0.2299 0 000000
0 1 P 52.5374 26.9382 9.3167 Q -0.6740 -0.4260 -0.5366 0.2762 0 000000
1 14 P 43.0703 48.2499 -39.1160 Q 0.8875 -0.4361 0.1333 0.0660 0 16666
1 15 P 49.5336 30.1453 4.2165 Q -0.7198 -0.3039 -0.5944 0.1904 0 16666
2 0 P 57.7803 34.8796 -4.7169 Q 0.7569 0.3548 -0.4984 0.2299 0 33332
2 1 P 53.8193 29.2250 9.4211 Q -0.6740 -0.4260 -0.5366 0.2762 0 33332
"""
TEXTS = {"csm": CSM, "aoa": AOA, "brd": BRD}
WRITERS = {"csm": write_csm, "aoa": write_aoa, "brd": write_brd}
READERS = {"csm": read_csm, "aoa": read_aoa, "brd": read_brd}


def written(tmp_path: Path, ending: str, text: str) -> Path:
    path = tmp_path / f"file.{ending}"
    path.write_text(text)
    return path


def markers(path: Path) -> MarkerMotion:
    motion = read(path).motion
    assert isinstance(motion, MarkerMotion)
    return motion


def test_the_printed_csm(tmp_path: Path) -> None:
    motion = markers(written(tmp_path, "csm", CSM))
    assert motion.names == ("C7", "CLAV", "LANK")
    assert motion.rate == 60.0
    assert motion.space.metres_per_unit == 0.001
    assert motion.space.up == "z"
    np.testing.assert_array_equal(motion.positions[1, 2], [966.5, -2426.7, 181.8])
    assert motion.notes["comments"] == "This is a Character Studio 2.0 CSM File"
    assert motion.notes["spinelinks"] == "3"


def test_the_printed_aoa(tmp_path: Path) -> None:
    motion = markers(written(tmp_path, "aoa", AOA))
    assert motion.names == ("1", "2", "3")
    assert motion.rate == 30.0
    np.testing.assert_array_equal(motion.positions[1, 0], [131.2017, 163.1528, 71.7291])
    assert motion.notes == {"comment": "AOA file written by LambSoft Pro Motion"}


def test_the_printed_brd(tmp_path: Path) -> None:
    """Markers that a sample lacks were not seen; the times are those of 60 samples a second."""
    motion = markers(written(tmp_path, "brd", BRD))
    assert motion.names == ("0", "1", "14", "15")
    assert motion.rate == 60.0
    assert motion.start == 0
    assert motion.seen.tolist() == [[1, 1, 0, 0], [0, 0, 1, 1], [1, 1, 0, 0]]
    assert motion.orientations is not None
    np.testing.assert_array_equal(motion.orientations[1, 2], [0.8875, -0.4361, 0.1333, 0.0660])


def test_brd_times_that_are_uneven_are_lost_and_told(tmp_path: Path) -> None:
    content = read(written(tmp_path, "brd", BRD.replace("33332", "40000")))
    assert any("even sampling" in line for line in content.lost)


def test_csm_dropouts_are_gaps(tmp_path: Path) -> None:
    text = CSM.replace("1030.6 -2239.9 1492.1", "DROPOUT")
    assert markers(written(tmp_path, "csm", text)).seen.tolist() == [[1, 0, 1], [1, 1, 1]]


@pytest.mark.parametrize(
    ("ending", "old", "new", "line"),
    [
        ("csm", "1540.1", "15x", 14),
        ("csm", "\t181.8\n", "\n", 14),
        ("csm", "$points", "$pints", 15),
        ("csm", "$rate 60", "$rate none", 7),
        ("csm", "C7 CLAV LANK", "", 12),
        ("aoa", "nummarkers = 3", "nummarkers = 0", 2),
        ("aoa", "nummarkers = 3", "nummarkers = 99999999", 9),
        ("aoa", "hz = 30", "hz = -1", 2),
        ("aoa", "71.3264 ", "", 4),
        ("brd", "1 14 P", "1 14 X", 3),
        ("brd", "1 15 P", "1 14 P", 1),
        ("brd", "2 0 P", "2.5 0 P", 5),
    ],
)
def test_nonsense_is_refused_with_its_line(
    tmp_path: Path, ending: str, old: str, new: str, line: int
) -> None:
    assert old in TEXTS[ending]
    path = written(tmp_path, ending, TEXTS[ending].replace(old, new, 1))
    with pytest.raises(FormatError) as caught:
        READERS[ending](path)
    assert caught.value.line == line


@pytest.mark.parametrize(
    ("ending", "old", "new", "said"),
    [
        ("csm", "$lastframe 2", "$lastframe 9", "9 frames, and there are 2"),
        ("csm", "$firstframe 1", "$firstframe 4", "$FirstFrame says 4"),
        ("aoa", "frames = 2", "frames = 3", "frames says 3"),
        ("aoa", "121.2042 2.5331 75.0017\n", "", "1 whole ones"),
        ("brd", "\n2 ", "\n7 ", "count up by one"),
    ],
)
def test_a_file_that_disagrees_with_itself_is_told(
    tmp_path: Path, ending: str, old: str, new: str, said: str
) -> None:
    assert old in TEXTS[ending]
    content = read(written(tmp_path, ending, TEXTS[ending].replace(old, new)))
    assert any(said in warning for warning in content.warnings), content.warnings


def test_too_sparse_a_brd_is_refused_before_it_is_built(tmp_path: Path) -> None:
    """A row a marker and a sample each would be a table of ten thousand times ten thousand."""
    rows = (f"{i} {i} P 1 2 3 Q 1 0 0 0\n" for i in range(10_000))
    with pytest.raises(FormatError, match="too few"):
        read(written(tmp_path, "brd", "".join(rows)))


@pytest.mark.parametrize("ending", ["csm", "aoa", "brd"])
@settings(max_examples=30)
@given(motion=marker_motions())
def test_what_is_written_reads_back_the_same(
    tmp_path_factory: pytest.TempPathFactory, ending: str, motion: MarkerMotion
) -> None:
    path = tmp_path_factory.mktemp(ending) / f"made.{ending}"
    if ending == "brd" and not motion.seen.any():
        return
    WRITERS[ending](motion, path)
    again = markers(path)
    expected = motion.positions
    if ending == "brd":  # a marker or a sample of which nothing was seen has no row
        expected = expected[motion.seen.any(axis=1)][:, motion.seen.any(axis=0)]
    np.testing.assert_array_equal(again.positions, expected)
    if ending == "csm":
        assert again.names == motion.names
        assert (again.rate, again.start) == (motion.rate, motion.start)


def test_what_a_format_cannot_hold_is_told(tmp_path: Path) -> None:
    for ending, write in WRITERS.items():
        lost = write(marker_motion(rich=True), tmp_path / f"made.{ending}")
        for part in ("residuals", "cameras", "analog", "events", "unit of length", "SUBJECTS"):
            assert any(part in line for line in lost), (ending, part)


def test_the_real_csm_reads_and_writes_back(data_dir: Path, tmp_path: Path) -> None:
    motion = markers(data_dir / "csm" / "ThomasFechten.csm")
    assert motion.positions.shape == (2439, 43, 3)
    write_csm(motion, tmp_path / "again.csm")
    again = markers(tmp_path / "again.csm")
    np.testing.assert_array_equal(again.positions, motion.positions)
    assert (again.names, again.notes, again.rate) == (motion.names, motion.notes, motion.rate)


def test_every_format_is_told_by_its_content(tmp_path: Path) -> None:
    """Whatever a file is called."""
    motion = marker_motion()
    for each in formats():
        if each.kind == "markers" and each.write is not None:
            each.write(motion, tmp_path / f"made{each.suffixes[0]}")
            plain = (tmp_path / f"made{each.suffixes[0]}").rename(tmp_path / "made.txt")
            again = markers(plain)
            np.testing.assert_allclose(again.positions, motion.positions, rtol=1e-6)
