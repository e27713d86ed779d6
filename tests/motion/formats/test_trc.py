"""TRC: as MOTEK, OpenSim and others write it, and as OpenSim's strict reader wants it."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings

from enpointe.errors import FormatError
from enpointe.motion.formats import MarkerMotion, Space, read
from enpointe.motion.formats.trc import read_trc, write_trc

from .making import marker_motion, marker_motions

HEAD = (
    "PathFileType\t4\t(X/Y/Z)\texample.trc\n"
    "DataRate\tCameraRate\tNumFrames\tNumMarkers\tUnits"
    "\tOrigDataRate\tOrigDataStartFrame\tOrigNumFrames\n"
)
BODY = HEAD + (
    "30\t30\t2\t2\tmm\t30\t1\t2\n"
    "Frame#\tTime\tbridge\t\t\tR.Heel\t\t\n"
    "\t\tX1\tY1\tZ1\tX2\tY2\tZ2\n\n"
    "1\t0.033333\t131.1524\t1630.935\t71.6937\t-1.246E+01\t7.13\t76.5239\n"
    "2\t0.066667\t131.2017\t1631.528\t71.7291\t\t\t\n"
)


def written(tmp_path: Path, text: str) -> Path:
    path = tmp_path / "file.trc"
    path.write_bytes(text.encode())
    return path


@pytest.mark.parametrize("ends", ["\n", "\r\n", "\r"])
def test_names_numbers_exponents_and_gaps(tmp_path: Path, ends: str) -> None:
    content = read_trc(written(tmp_path, BODY.replace("\n", ends)))
    motion = content.motion
    assert isinstance(motion, MarkerMotion)
    assert motion.names == ("bridge", "R.Heel")
    assert motion.rate == 30.0
    assert motion.start == 1
    assert motion.space.metres_per_unit == 0.001
    np.testing.assert_array_equal(motion.positions[0, 1], [-12.46, 7.13, 76.5239])
    assert np.isnan(motion.positions[1, 1]).all()
    assert motion.notes["PathFileType"] == "example.trc"


def test_blanks_instead_of_tabs(tmp_path: Path) -> None:
    lines = [" ".join(line.split()) for line in BODY.splitlines() if line.strip()][:-1]
    motion = read_trc(written(tmp_path, "\n".join(lines))).motion
    assert isinstance(motion, MarkerMotion)
    assert motion.positions.shape == (1, 2, 3)


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ("\t2\t2\tmm", "\t9\t2\tmm", "NumFrames says 9"),
        ("\t2\t2\tmm", "\t2\t7\tmm", "NumMarkers says 7"),
        ("30\t30\t2", "60\t30\t2", "DataRate"),
        ("\n2\t0.066667", "\n5\t0.066667", "count up by one"),
        ("\t\t\t\n", "\n", "end early"),
        ("71.7291\t\t\t", "71.7291\t5\t\t", "lack a coordinate"),
        ("\tmm\t", "\tcubits\t", "cubits"),
    ],
)
def test_a_file_that_disagrees_with_itself_is_told(
    tmp_path: Path, old: str, new: str, said: str
) -> None:
    assert old in BODY
    content = read_trc(written(tmp_path, BODY.replace(old, new)))
    assert any(said in warning for warning in content.warnings), content.warnings
    assert isinstance(content.motion, MarkerMotion)
    assert content.motion.frames == 2


@pytest.mark.parametrize(
    ("old", "new", "line"),
    [
        ("1630.935", "16x0.935", 7),
        ("1630.935", "inf", 7),
        ("1\t0.033333", "\t0.033333", 7),
        ("PathFileType", "FilePathType", 1),
        ("Frame#", "Frame", 4),
        ("30\t30\t2", "zero\t30\t2", 3),
        ("30\t30\t2", "-30\t30\t2", 3),
        ("bridge\t\t\tR.Heel", "", 4),
    ],
)
def test_nonsense_is_refused_with_its_line(tmp_path: Path, old: str, new: str, line: int) -> None:
    assert old in BODY
    with pytest.raises(FormatError) as caught:
        read_trc(written(tmp_path, BODY.replace(old, new)))
    assert caught.value.line == line


def test_columns_parted_by_commas_are_said_to_be(tmp_path: Path) -> None:
    with pytest.raises(FormatError, match="parted by tabs"):
        read_trc(written(tmp_path, BODY.replace("\t", ",")))


def test_a_last_row_that_was_cut_is_left_out(tmp_path: Path) -> None:
    content = read_trc(written(tmp_path, BODY[: BODY.index("1631.528")]))
    assert isinstance(content.motion, MarkerMotion)
    assert content.motion.frames == 1
    assert any("cut short" in warning for warning in content.warnings)
    content = read_trc(written(tmp_path, BODY.rstrip().rsplit("\n", 1)[0]))
    assert isinstance(content.motion, MarkerMotion)
    assert content.motion.frames == 1
    assert any("may be cut" in warning for warning in content.warnings)


def test_points_without_a_name_are_lost_and_told(tmp_path: Path) -> None:
    content = read_trc(written(tmp_path, BODY.replace("76.5239\n", "76.5239\t1\t2\t3\n")))
    assert content.lost == ("points without a name at the end of 1 rows",)


@settings(max_examples=40)
@given(marker_motions())
def test_what_is_written_reads_back_the_same(
    tmp_path_factory: pytest.TempPathFactory, motion: MarkerMotion
) -> None:
    path = tmp_path_factory.mktemp("trc") / "made.trc"
    write_trc(motion, path)
    again = read(path).motion
    assert isinstance(again, MarkerMotion)
    np.testing.assert_array_equal(again.positions, motion.positions)
    assert (again.names, again.rate, again.start) == (motion.names, motion.rate, motion.start)
    assert again.space.metres_per_unit == motion.space.metres_per_unit


def test_opensim_would_take_what_is_written(tmp_path: Path) -> None:
    """The rules of TRCFileAdapter.cpp: eight keys, names, X1 Y1 Z1, rows of their whole width."""
    motion = marker_motion(gaps=True)
    write_trc(motion, tmp_path / "made.trc")
    lines = (tmp_path / "made.trc").read_text().split("\n")
    assert lines[0].split()[0] == "PathFileType"
    assert lines[1] == HEAD.split("\n")[1]
    assert len([v for v in lines[2].split("\t") if v]) == 8
    names = [name for name in lines[3].split("\t") if name]
    assert names == ["Frame#", "Time", *motion.names]
    labels = [label for label in lines[4].split("\t") if label]
    assert labels == [f"{axis}{i}" for i in range(1, 5) for axis in "XYZ"]
    rows = lines[6:-1]
    assert lines[5] == lines[-1] == ""
    assert len(rows) == motion.frames
    for row in rows:
        fields = row.split("\t")
        assert len(fields) == 2 + 3 * len(motion.names)
        assert fields[-1] != ""


def test_what_trc_cannot_hold_is_told(tmp_path: Path) -> None:
    lost = write_trc(marker_motion(rich=True), tmp_path / "made.trc")
    for part in ("residuals", "cameras", "analog", "events", "SUBJECTS"):
        assert any(part in line for line in lost), part
    odd = MarkerMotion(("a",), 1.0, np.zeros((1, 1, 3)), Space(0.0123))
    with pytest.raises(FormatError, match="unit"):
        write_trc(odd, tmp_path / "odd.trc")


def test_real_files_read_and_write_back(data_dir: Path, tmp_path: Path) -> None:
    paths = sorted(data_dir.glob("trc*/*.trc"))
    assert paths
    for path in paths:
        motion = read(path).motion
        assert isinstance(motion, MarkerMotion)
        write_trc(motion, tmp_path / "again.trc")
        again = read(tmp_path / "again.trc").motion
        assert isinstance(again, MarkerMotion)
        np.testing.assert_array_equal(again.positions, motion.positions)
        assert again.notes == motion.notes


def test_a_t_pose_stands_upright(data_dir: Path) -> None:
    motion = read(data_dir / "trc" / "T.trc").motion
    assert isinstance(motion, MarkerMotion)
    head = motion.names.index("LFHD")
    height = motion.space.points(motion.positions)[:, head, 2]
    assert np.abs(height - 1.64).max() < 0.05
