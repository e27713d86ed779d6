"""The formats of the document's chapter that are rare now."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from enpointe.errors import FormatError
from enpointe.motion.formats import Content, MarkerMotion, SkeletonMotion, read, write
from enpointe.motion.formats.mnm import read_names, renamed, write_names
from enpointe.motion.formats.units import INCH

from .skeletons import BVA_DOCUMENT, BVH_DOCUMENT, HTR_DOCUMENT, made


def content(tmp_path: Path, name: str, text: str) -> tuple[Content, SkeletonMotion]:
    path = tmp_path / name
    path.write_text(text, newline="")
    found = read(path)
    assert isinstance(found.motion, SkeletonMotion)
    return found, found.motion


def test_bva_and_bvh_of_the_document_are_one_movement(tmp_path: Path) -> None:
    """The chest of its BVA stands where the BVH's hips carry it, to the digits printed."""
    _, bva = content(tmp_path, "a.bva", BVA_DOCUMENT)
    _, bvh = content(tmp_path, "a.bvh", BVH_DOCUMENT)
    assert bva.skeleton.space.metres_per_unit == INCH
    assert np.allclose(bva.world()[0], bvh.world()[0][:, :2], atol=0.011)
    one = Rotation.from_quat(bva.world()[1][:, 0], scalar_first=True)
    other = Rotation.from_quat(bvh.world()[1][:, 0], scalar_first=True)
    assert (one * other.inv()).magnitude().max() < 1e-12


def test_a_bva_file_is_written_as_it_was(tmp_path: Path) -> None:
    """Numbers, units, scales; the misprinted unit in its right spelling."""
    found, motion = content(tmp_path, "a.bva", BVA_DOCUMENT)
    assert found.warnings == ()
    assert write(motion, tmp_path / "b.bva") == ()
    text = (tmp_path / "b.bva").read_text()
    ours, theirs = text.split(), BVA_DOCUMENT.replace("INCCHES", "INCHES").split()
    assert len(ours) == len(theirs)
    assert all(a == b or float(a) == float(b) for a, b in zip(ours, theirs, strict=True))


def test_a_bones_length_is_its_scale(tmp_path: Path) -> None:
    """As in the document: the hips' is the chest's offset, the last one's its end site's."""
    _, motion = content(tmp_path, "a.bvh", BVH_DOCUMENT)
    write(motion, tmp_path / "a.bva")
    bva = read(tmp_path / "a.bva").motion
    assert isinstance(bva, SkeletonMotion)
    unit = motion.skeleton.space.metres_per_unit / bva.skeleton.space.metres_per_unit
    assert np.allclose(bva.values[0, 6::9], np.array([5.21, 18.65, 5.45]) * unit)


@pytest.mark.parametrize(
    ("old", "new", "line", "says"),
    [
        ("8.33 40.04", "8.33", 14, "needs 9 numbers"),
        ("8.33 ", "nan ", 14, "finite"),
        ("Segment: Chest\nFrames: 2", "Segment: Chest", 10, "'frames:'"),
        ("XTRAN YTRAN ZTRAN", "XTRAN YTRAN WTRAN", 5, "WTRAN"),
        ("INCCHES INCCHES INCCHES DEGREES", "INCCHES INCCHES YARDS DEGREES", 6, "YARDS"),
        (" 8.15 40.16 87.63 -31.12 175.58 -4.08 18.65 18.65 18.65\n", "", 9, "1 frames"),
        ("Frame Time: 0.033333", "Frame Time: 0", 4, "above 0"),
    ],
)
def test_what_is_wrong_in_a_bva_file(
    tmp_path: Path, old: str, new: str, line: int, says: str
) -> None:
    """Told with its line."""
    assert old in BVA_DOCUMENT
    with pytest.raises(FormatError) as error:
        content(tmp_path, "a.bva", BVA_DOCUMENT.replace(old, new, 1))
    assert error.value.line == line, str(error.value)
    assert says in error.value.message


def test_htr_adds_to_its_base(tmp_path: Path) -> None:
    """Place: base and frame in the parent's frame. Rotation: base @ Rz Ry Rx of the frame."""
    found, motion = content(tmp_path, "a.htr", HTR_DOCUMENT)
    assert found.warnings == ()
    assert found.lost == ("comments",)
    assert motion.start == 1
    assert motion.skeleton.space.metres_per_unit == 0.001
    world, turns = motion.world()
    root = Rotation.from_euler("ZYX", [-10.34, -7.70, 18.03], degrees=True)
    assert np.allclose(world[0, 0], [263.72, 816.20, -2874.77])
    assert np.allclose(world[0, 1], world[0, 0] + root.apply([0, 200, 0]))
    base = Rotation.from_euler("ZYX", [0.35, 0, -1.38], degrees=True)
    own = Rotation.from_euler("ZYX", [8.59, -17.38, 8.33], degrees=True)
    chest = Rotation.from_quat(turns[0, 1], scalar_first=True)
    assert ((root * base * own) * chest.inv()).magnitude() < 1e-12
    assert motion.skeleton.joints[1].ends == ((0.0, 286.95, 0.0),)


def test_an_htr_file_is_written_as_it_was(tmp_path: Path) -> None:
    """Its base positions in their own digits, its settings, every number."""
    _, motion = content(tmp_path, "a.htr", HTR_DOCUMENT)
    assert write(motion, tmp_path / "b.htr") == ()
    bare = [line.split("#")[0].split() for line in HTR_DOCUMENT.splitlines()]
    ours = [line.split() for line in (tmp_path / "b.htr").read_text().splitlines()]
    for line in filter(None, bare):
        match = [
            other
            for other in ours
            if len(other) == len(line)
            and all(a == b or _number(a) == _number(b) for a, b in zip(line, other, strict=True))
        ]
        assert match, line


def _number(word: str) -> float | str:
    try:
        return float(word)
    except ValueError:
        return word


def test_lost_segments_are_no_places(tmp_path: Path) -> None:
    """9999999 is no number, with a warning; it is written so again, and not into a BVH."""
    text = HTR_DOCUMENT.replace("2 264.42   812.41", "2 9999999 9999999")
    found, motion = content(tmp_path, "a.htr", text)
    assert np.isnan(motion.values[1, :2]).all()
    assert any("lost" in warning for warning in found.warnings)
    write(motion, tmp_path / "b.htr")
    again = read(tmp_path / "b.htr").motion
    assert isinstance(again, SkeletonMotion)
    assert np.array_equal(again.values, motion.values, equal_nan=True)
    with pytest.raises(FormatError, match="frame 1"):
        write(motion, tmp_path / "b.bvh")


@pytest.mark.parametrize(
    ("old", "new", "line", "says"),
    [
        ("RTHIGH         LOWERTORSO", "RTHIGH  LOWERTORS", 18, "LOWERTORS"),
        ("LOWERTORSO    GLOBAL", "LOWERTORSO UPPERTORSO", 16, "hangs on itself"),
        (" 2 0.00     0.00   0.00   8.71", " 3 0.00     0.00   0.00   8.71", 27, "one by one"),
        ("[RTHIGH]\n", "[LTHIGH]\n", 30, "LTHIGH"),
        ("EulerRotationOrder ZYX", "EulerRotationOrder ZZX", 8, "ZZX"),
        ("EulerRotationOrder ZYX", "", 1, "lacks"),
        ("CalibrationUnits mm", "CalibrationUnits ell", 9, "ell"),
        ("DataFrameRate   30", "DataFrameRate 0", 7, "above 0"),
        ("FileType htr", "FileType htr2", 2, "htr2"),
        ("-6.15   0.00  176.17", "-6.15   nan  176.17", 23, "finite"),
    ],
)
def test_what_is_wrong_in_an_htr_file(
    tmp_path: Path, old: str, new: str, line: int, says: str
) -> None:
    """Told with its line."""
    assert old in HTR_DOCUMENT
    with pytest.raises(FormatError) as error:
        content(tmp_path, "a.htr", HTR_DOCUMENT.replace(old, new, 1))
    assert error.value.line == line, str(error.value)
    assert says in error.value.message


def test_gtr_is_htr_in_the_world(tmp_path: Path) -> None:
    """The same joints, none on another."""
    _, motion = content(tmp_path, "a.htr", HTR_DOCUMENT)
    lost = write(motion, tmp_path / "a.gtr")
    found = read(tmp_path / "a.gtr").motion
    assert isinstance(found, SkeletonMotion)
    assert all(joint.parent < 0 for joint in found.skeleton.joints)
    assert np.allclose(found.world()[0], motion.world()[0], atol=1e-9)
    assert any("hangs" in line for line in lost)


def test_ask_offsets_are_in_the_world(tmp_path: Path) -> None:
    """What BVH adds up, ASK says outright; and it says nothing of the movement."""
    text = BVH_DOCUMENT.split("MOTION")[0].replace("18.65", "23.86").replace("5.45", "29.31")
    bare = "\n".join(line for line in text.splitlines() if "CHANNELS" not in line)
    found, motion = content(tmp_path, "a.ask", bare)
    assert [joint.offset[1] for joint in motion.skeleton.joints] == [0.0, 5.21, 23.86 - 5.21]
    assert motion.frames == 1
    assert any("no movement" in warning for warning in found.warnings)
    assert write(motion, tmp_path / "b.ask") == ()
    assert (tmp_path / "b.ask").read_text().split() == bare.replace("0.00", "0.0").split()
    (tmp_path / "a.sdl").write_text("DEFINITION")
    assert any("a.sdl" in line for line in read(tmp_path / "a.ask").lost)


def test_ask_says_what_falls(tmp_path: Path) -> None:
    """All of the movement."""
    assert any("movement" in line for line in write(made(2), tmp_path / "a.ask"))


@pytest.mark.parametrize(
    "text",
    [
        "Hips = Bip01\nChest = Bip01 Spine\n",
        "Hips\tBip01\nChest\tBip01 Spine\n",
        "; by hand\r\nHips    Bip01\r\n\r\nChest   Bip01 Spine\r\n",
        "Bip01 = Hips\nBip01 Spine = Chest\n",
    ],
)
def test_mnm_renames(tmp_path: Path, text: str) -> None:
    """In columns or about an equals sign, and from whichever side the movement knows."""
    (tmp_path / "a.mnm").write_text(text, newline="")
    names = read_names(tmp_path / "a.mnm")
    _, motion = content(tmp_path, "a.bvh", BVH_DOCUMENT)
    other, warnings = renamed(motion, names)
    assert isinstance(other, SkeletonMotion)
    assert other.skeleton.names == ("Bip01", "Bip01 Spine", "Neck")
    assert warnings == ()
    write_names(names, tmp_path / "b.mnm")
    assert read_names(tmp_path / "b.mnm") == names


def test_mnm_renames_markers_and_says_what_is_missing() -> None:
    """A marker that is not there, and a name that another has."""
    markers = MarkerMotion(("LeftShoulder", "b"), 30.0, np.zeros((1, 2, 3)))
    other, warnings = renamed(markers, {"LeftShoulder": "LSHO", "x": "y"})
    assert isinstance(other, MarkerMotion)
    assert other.names == ("LSHO", "b")
    assert any("'x'" in warning for warning in warnings)
    other, warnings = renamed(markers, {"LeftShoulder": "b"})
    assert isinstance(other, MarkerMotion)
    assert other.names == ("LeftShoulder", "b")
    assert len(warnings) == 1


@pytest.mark.parametrize(
    ("text", "line"), [("a = b\na = c\n", 2), ("a = b\nc = b\n", 2), ("a\n", 1), ("a=b=c\n", 1)]
)
def test_what_is_wrong_in_an_mnm_file(tmp_path: Path, text: str, line: int) -> None:
    """Told with its line."""
    (tmp_path / "a.mnm").write_text(text)
    with pytest.raises(FormatError) as error:
        read_names(tmp_path / "a.mnm")
    assert error.value.line == line
