"""CSV of ours: columns with their units, for markers and for joints."""

from __future__ import annotations

import csv
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp

from enpointe.errors import FormatError
from enpointe.motion.formats import Joint, MarkerMotion, Skeleton, SkeletonMotion, Space, read
from enpointe.motion.formats.csv_table import read_csv, write_csv
from enpointe.motion.formats.skeleton import CHANNELS

from .making import marker_motion, marker_motions


@st.composite
def joint_motions(draw: st.DrawFn) -> SkeletonMotion:
    """Up to four joints with any channels, in degrees or radians."""
    names = draw(st.lists(st.text("abc,.\"' é", min_size=1, max_size=5), min_size=1, max_size=4))
    plain = dict.fromkeys(" ".join(name.split()) for name in names if name.strip())
    channels = st.lists(st.sampled_from(CHANNELS), min_size=1, max_size=6, unique=True)
    joints = tuple(Joint(name, -1, channels=tuple(draw(channels))) for name in plain or ["hip"])
    units = draw(st.sampled_from([np.pi / 180, 1.0]))
    skeleton = Skeleton(joints, Space(0.01, "y", units))
    shape = (draw(st.integers(1, 4)), skeleton.width)
    values = draw(hnp.arrays(float, shape, elements=st.floats(-1e9, 1e9)))
    return SkeletonMotion(skeleton, draw(st.sampled_from([30.0, 59.94, 120.0])), values, start=3)


@settings(max_examples=40)
@given(marker_motions())
def test_markers_come_back_the_same(
    tmp_path_factory: pytest.TempPathFactory, motion: MarkerMotion
) -> None:
    path = tmp_path_factory.mktemp("csv") / "made.csv"
    assert write_csv(motion, path) == ()
    again = read(path).motion
    assert isinstance(again, MarkerMotion)
    np.testing.assert_array_equal(again.positions, motion.positions)
    assert (again.names, again.rate, again.start) == (motion.names, motion.rate, motion.start)
    assert again.space == motion.space


@settings(max_examples=40)
@given(joint_motions())
def test_joints_come_back_the_same_but_for_their_hierarchy(
    tmp_path_factory: pytest.TempPathFactory, motion: SkeletonMotion
) -> None:
    path = tmp_path_factory.mktemp("csv") / "made.csv"
    assert write_csv(motion, path) == ("the hierarchy, offsets and axes of the joints",)
    again = read(path).motion
    assert isinstance(again, SkeletonMotion)
    np.testing.assert_array_equal(again.values, motion.values)
    assert [(j.name, j.channels) for j in again.skeleton.joints] == [
        (j.name, j.channels) for j in motion.skeleton.joints
    ]
    assert again.skeleton.space == motion.skeleton.space
    assert (again.rate, again.start) == (motion.rate, motion.start)


def test_residuals_cameras_events_and_notes_come_back(tmp_path: Path) -> None:
    motion = marker_motion(gaps=True, rich=True)
    assert write_csv(motion, tmp_path / "made.csv") == ("analog signals",)
    again = read(tmp_path / "made.csv").motion
    assert isinstance(again, MarkerMotion)
    np.testing.assert_array_equal(again.residuals, motion.residuals)
    np.testing.assert_array_equal(again.cameras, motion.cameras)
    assert again.labels == motion.labels
    assert again.notes == motion.notes


def test_any_spreadsheet_reads_what_is_written(tmp_path: Path) -> None:
    motion = marker_motion()
    write_csv(motion, tmp_path / "made.csv")
    lines = (tmp_path / "made.csv").read_text().splitlines()
    rows = list(csv.reader(line for line in lines if not line.startswith("#")))
    assert rows[0][:4] == ["time [s]", "C7.x [mm]", "C7.y [mm]", "C7.z [mm]"]
    assert [float(row[0]) for row in rows[1:]] == pytest.approx(np.arange(7) / 100.0)
    assert float(rows[3][2]) == motion.positions[2, 0, 1]


def test_a_table_of_somebody_else(tmp_path: Path) -> None:
    """No lines of ours: the rate comes from the times, the rest is guessed and told."""
    path = tmp_path / "theirs.csv"
    path.write_text("Time,A.x,A.y,A.z\n0.00,1,2,3\n0.02,4,,6\n0.04,7,8\n")
    content = read(path)
    motion = content.motion
    assert isinstance(motion, MarkerMotion)
    assert motion.rate == 50.0
    assert motion.seen.tolist() == [[True], [False], [False]]
    assert any("end early" in warning for warning in content.warnings)
    assert any("unit of length" in warning for warning in content.warnings)


@pytest.mark.parametrize(
    ("text", "line"),
    [
        ("time,A.x\n", 1),
        ("time\n1\n", 1),
        ("when,A.x\n1,2\n", 1),
        ("time,A\n1,2\n", 1),
        ("time,A.x\n0,1\n1,zwei\n", 3),
        ("time,A.x\n0,1,2\n", 2),
        ("time,A.x\n,1\n", 2),
        ("time,a.Xrotation [deg],b.Xrotation [rad]\n0,1,2\n1,2,3\n", 1),
        ("time,a.Xrotation [deg],b.other\n0,1,2\n1,2,3\n", 1),
        ("# enpointe motion 1: markers\n# rate: {\ntime,A.x\n0,1\n", 2),
        ("time,A.x\n1,1\n0,1\n", 1),
    ],
)
def test_nonsense_is_refused_with_its_line(tmp_path: Path, text: str, line: int) -> None:
    path = tmp_path / "bad.csv"
    path.write_text(text)
    with pytest.raises(FormatError) as caught:
        read_csv(path)
    assert caught.value.line == line
