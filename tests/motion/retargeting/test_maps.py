"""Which points of a source are which landmarks."""

from __future__ import annotations

from pathlib import Path

import mujoco
import numpy as np
import pytest

from enpointe.errors import FormatError, MotionError
from enpointe.motion.formats import MarkerMotion, read
from enpointe.motion.retargeting import JointMap, propose_map, retarget

from .conftest import as_skeleton, step_sideways

NAMED = {
    "cmu_05/05_14.amc": ("lfemur", "lhand", "ltoes"),
    "cmu_bvh_daz/05_14.bvh": ("lThigh", "lHand", "lFoot:end"),
    "cmu_bvh_motionbuilder/05_14.bvh": ("LeftUpLeg", "LeftHand", "LeftToeBase"),
    "bvh_various/131_01.bvh": ("LeftHip", "lhand", "LeftToe"),
    "bvh_various/test_freebvh.bvh": (
        "mixamorig:LeftUpLeg",
        "mixamorig:LeftHand",
        "mixamorig:LeftToeBase",
    ),
    "bvh_various/test_mocapbank.bvh": ("LeftHip", "LeftWrist", "LeftAnkle:end"),
    "rokoko/jesse_dance.bvh": ("LeftUpLeg", "LeftHand", "LeftToeBase"),
}


@pytest.mark.parametrize("name", NAMED)
def test_families_are_known_by_their_names(name: str, data_dir: Path) -> None:
    path = data_dir / name
    if not path.exists():
        pytest.skip("no data here")
    found = propose_map(read(path))
    assert found.found == "names"
    assert not found.missing
    points = [found.points[f"left_{part}"][0] for part in ("hip", "wrist", "toe")]
    assert tuple(points) == NAMED[name]


@pytest.mark.parametrize(
    "name", ["trc/Gait.trc", "trc/T.trc", "csm/ThomasFechten.csm", "c3d_various/Qualisys.c3d"]
)
def test_marker_sets_are_known_by_their_names(name: str, data_dir: Path) -> None:
    path = data_dir / name
    if not path.exists():
        pytest.skip("no data here")
    assert not propose_map(read(path)).missing


SETS = {
    "BTS": (
        "c7, r should, l should, sacrum, r asis, r knee 1, r knee 2, r mall, r heel, r met,"
        " l asis, l knee 1, l knee 2, l mall, l heel, l met"
    ),
    "Helen Hayes of Motion Analysis": (
        "R.ASIS, L.ASIS, V.Sacral, R.Thigh.Upper, R.Knee.Lat, R.Knee.Med, L.Knee.Lat, L.Knee.Med,"
        " R.Ankle.Lat, R.Ankle.Med, L.Ankle.Lat, L.Ankle.Med, R.Heel, L.Heel, R.Toe.Tip, L.Toe.Tip,"
        " R.Toe.Lat, R.Toe.Med, L.Toe.Lat, L.Toe.Med, R.Acromium, L.Acromium, R.Elbow, L.Elbow,"
        " R.Wrist.Med, R.Wrist.Lat, L.Wrist.Med, L.Wrist.Lat"
    ),
    "condyles and malleoli": (
        "LASI, RASI, LPSI, RPSI, RLFC, RMFC, LLFC, LMFC, RLMAL, RMMAL, LLMAL, LMMAL, RCAL, LCAL,"
        " RTOE, RMT5, LTOE, LMT5, RACR, LACR, C7"
    ),
    "plug-in gait with a sacral wand": "LASI, RASI, VSAC, LKNE, RKNE, LANK, RANK, LTOE, RTOE",
}


@pytest.mark.parametrize("made", SETS)
def test_marker_sets_of_laboratories_are_known(made: str) -> None:
    names = tuple(SETS[made].split(", "))
    markers = MarkerMotion(names, 100.0, np.zeros((2, len(names), 3)))
    found = propose_map(markers)
    assert not found.missing
    for landmark, points in found.points.items():
        side = landmark.split("_")[0]
        if side in ("left", "right"):
            assert all(point.lower().startswith(side[0]) for point in points), landmark


def test_a_joint_between_two_markers_is_their_mean() -> None:
    names = tuple(SETS["Helen Hayes of Motion Analysis"].split(", "))
    found = propose_map(MarkerMotion(names, 100.0, np.zeros((2, len(names), 3))))
    assert set(found.points["left_knee"]) == {"L.Knee.Lat", "L.Knee.Med"}
    assert set(found.points["right_toe"]) == {"R.Toe.Lat", "R.Toe.Med"}


def test_a_skeleton_without_names_is_known_by_its_structure(model: mujoco.MjModel) -> None:
    motion = step_sideways(model, 1.0)
    plain = as_skeleton(motion)
    numbered = {name: f"bone{i}" for i, name in enumerate(plain.skeleton.names)}
    found = propose_map(as_skeleton(motion, names=numbered))
    named = propose_map(plain)
    assert found.found == "structure"
    assert not found.missing
    for side in ("left", "right"):
        for part in ("hip", "knee", "ankle", "toe", "shoulder", "elbow", "wrist"):
            (expected,) = named.points[f"{side}_{part}"]
            assert found.points[f"{side}_{part}"] == (numbered[expected],)


def test_a_map_is_read_as_it_was_written(model: mujoco.MjModel, tmp_path: Path) -> None:
    proposed = propose_map(as_skeleton(step_sideways(model, 1.0)))
    proposed.save(tmp_path / "map.toml")
    loaded = JointMap.load(tmp_path / "map.toml")
    assert loaded.points == proposed.points
    assert loaded.frames == proposed.frames


def test_what_is_missing_is_named(model: mujoco.MjModel) -> None:
    motion = as_skeleton(step_sideways(model, 1.0))
    points = dict(propose_map(motion).points)
    del points["left_knee"]
    with pytest.raises(MotionError, match="the map has no left_knee"):
        retarget(motion, model, mapping=JointMap(points))
    with pytest.raises(MotionError, match=r"left_knee is mapped to 'Bein'"):
        retarget(motion, model, mapping=JointMap(points | {"left_knee": ("Bein",)}))


@pytest.mark.parametrize(
    ("text", "line"),
    [
        ("[points\n", "no mapping file"),
        ("[joints]\na = 'b'\n", r"a table \[points\]"),
        ("[points]\nelbow = 'b'\n", "no landmark 'elbow'"),
        ("[points]\nleft_knee = 3\n", "must be a point's name"),
    ],
)
def test_a_bad_mapping_file_is_refused_in_one_line(tmp_path: Path, text: str, line: str) -> None:
    path = tmp_path / "map.toml"
    path.write_text(text)
    with pytest.raises(FormatError, match=line):
        JointMap.load(path)
