"""Acclaim's two files, against CMU's captures and against others' conversions of them."""

from __future__ import annotations

import shutil
from pathlib import Path

import numpy as np
import pytest

from enpointe.errors import FormatError
from enpointe.motion.formats import Content, SkeletonMotion, read, write
from enpointe.motion.formats.amc import companion, read_amc

from .skeletons import made

ASF = """:version 1.10
:name two
:units
  mass 1.0
  length 0.45
  angle deg
:documentation
  A trunk and a head.
  To be nodded with.
:root
  order TX TY TZ RX RY RZ
  axis XYZ
  position 0 0 0
  orientation 0 0 0
:bonedata
  begin
    id 1
    name trunk
    direction 0 1 0
    length 5.5
    axis 0 0 20 XYZ
    dof rx rz
    limits (-20.0 45.0)
           (-inf inf)
    bodymass 12
  end
  begin
    id 2
    name neck
    direction 0 1 0
    length 0.5
    axis 0 0 0 XYZ
  end
  begin
    id 3
    name head
    direction 0.6 0.8 0
    length 2
    axis 0 0 0 XYZ
    dof rx ry rz
  end
:hierarchy
  begin
    root trunk
    trunk neck
    neck head
  end
"""
AMC = """# by hand
:FULLY-SPECIFIED
:DEGREES
1
root 1 2 3 10 20 30
trunk 5 -6
head 7 8 9
2
root 1 2 3 11 21 31
trunk 5.5 -6.5
head 7.5 8.5 9.5
3
root 1 2 3 12 22 32
trunk 6 -7
head 8 9 10
"""


def content(tmp_path: Path, amc: str = AMC, asf: str = ASF) -> tuple[Content, SkeletonMotion]:
    (tmp_path / "09.asf").write_text(asf, newline="")
    (tmp_path / "09_01.amc").write_text(amc, newline="")
    found = read(tmp_path / "09_01.amc")
    assert isinstance(found.motion, SkeletonMotion)
    return found, found.motion


def motion_of(path: Path) -> SkeletonMotion:
    found = read(path).motion
    assert isinstance(found, SkeletonMotion)
    return found


def equal(one: SkeletonMotion, other: SkeletonMotion) -> bool:
    return np.array_equal(one.values, other.values) and (
        one.skeleton,
        one.rate,
        one.start,
        one.notes,
    ) == (other.skeleton, other.rate, other.start, other.notes)


def test_cmu_reads_and_is_written_alike(data_dir: Path, tmp_path: Path) -> None:
    """Every number, limit, axis, note of 16 takes and four dancers survives being written."""
    files = [file for file in sorted(data_dir.glob("cmu_*/*.amc")) if "crlf" not in str(file)]
    assert len(files) == 16
    for file in files:
        first = motion_of(file)
        lost = write(first, tmp_path / "again.amc")
        assert lost == ()
        assert equal(motion_of(tmp_path / "again.amc"), first), file


def test_every_number_is_taken_by_its_bone(data_dir: Path) -> None:
    """Against a plain reading of the file, line by line."""
    file = data_dir / "cmu_05" / "05_16.amc"
    motion = motion_of(file)
    frame = -1
    for line in file.read_text().splitlines()[3:]:
        name, *numbers = line.split()
        if not numbers:
            frame += 1
            continue
        place = motion.skeleton.columns(motion.skeleton.names.index(name))
        assert motion.values[frame, place].tolist() == [float(number) for number in numbers]
    assert frame == motion.frames - 1


def test_the_quick_way_and_the_other_agree(data_dir: Path, tmp_path: Path) -> None:
    """Frames whose lines stand otherwise are read line by line, to the same numbers."""
    folder = data_dir / "cmu_05"
    text = (folder / "05_16.amc").read_text()
    lines = text.splitlines()
    lines[4], lines[5] = lines[5], lines[4]
    (tmp_path / "05_16.amc").write_text("\n".join(lines) + "\n")
    shutil.copy(folder / "05.asf", tmp_path)
    again = motion_of(tmp_path / "05_16.amc")
    assert np.array_equal(again.values, motion_of(folder / "05_16.amc").values)


def test_line_ends_do_not_matter(data_dir: Path) -> None:
    """05_03 with CRLF is 05_03 with LF."""
    skeleton = data_dir / "cmu_05" / "05.asf"
    crlf = read_amc(data_dir / "cmu_05_crlf" / "05_03.amc", skeleton).motion
    assert isinstance(crlf, SkeletonMotion)
    assert equal(crlf, motion_of(data_dir / "cmu_05" / "05_03.amc"))


@pytest.mark.parametrize(
    ("bone", "joint"),
    [
        (f"{side[0].lower()}{bone}", f"{side}{joint}")
        for side in ("Left", "Right")
        for bone, joint in (
            ("femur", "UpLeg"),
            ("tibia", "Leg"),
            ("foot", "Foot"),
            ("toes", "ToeBase"),
        )
    ],
)
def test_legs_are_where_others_have_them(data_dir: Path, bone: str, joint: str) -> None:
    """MotionBuilder's BVH of 05_14: hips, knees, ankles, toes within 2 mm in all 642 frames.

    Its frame 0 is a T-pose that the capture has not; units are the same, guessed and known.
    """
    captured = motion_of(data_dir / "cmu_05" / "05_14.amc")
    converted = motion_of(data_dir / "cmu_bvh_motionbuilder" / "05_14.bvh")
    ours = captured.skeleton.space.points(captured.world()[0])
    theirs = converted.skeleton.space.points(converted.world()[0])[1:]
    assert ours.shape[0] == theirs.shape[0] == 642
    own = ours[:, captured.skeleton.names.index(bone)]
    other = theirs[:, converted.skeleton.names.index(joint)]
    assert np.linalg.norm(own - other, axis=1).max() < 0.002


def test_as_bvh_each_joint_is_where_it_was(data_dir: Path, tmp_path: Path) -> None:
    """The axes are folded into the angles: places agree to a thousand-millionth of a unit."""
    first = motion_of(data_dir / "cmu_05" / "05_11.amc")
    lost = write(first, tmp_path / "a.bvh")
    again = motion_of(tmp_path / "a.bvh")
    assert np.abs(again.world()[0] - first.world()[0]).max() < 1e-9
    assert again.skeleton.names == first.skeleton.names
    assert again.rate == first.rate
    assert any("limits" in line for line in lost)


def test_the_unit_is_inches_over_length(data_dir: Path) -> None:
    """And the dancer comes out a person's size, standing."""
    motion = motion_of(data_dir / "cmu_05" / "05_14.amc")
    assert motion.skeleton.space.metres_per_unit == 0.0254 / 0.45
    head = motion.skeleton.space.points(motion.world()[0])[:, motion.skeleton.names.index("head")]
    assert 1.2 < np.median(head[:, 2]) < 1.7


def test_what_the_skeleton_says(tmp_path: Path) -> None:
    """Limits, axes, masses, words: kept, and in the file again."""
    found, motion = content(tmp_path)
    trunk = motion.skeleton.joints[1]
    assert trunk.limits == ((-20.0, 45.0), (-np.inf, np.inf))
    assert trunk.channels == ("Xrotation", "Zrotation")
    assert trunk.product == "ZX"
    assert motion.skeleton.joints[3].offset == (0.0, 0.5, 0.0)
    assert motion.skeleton.joints[3].ends == ((1.2, 1.6, 0.0),)
    assert motion.notes[":documentation"] == "A trunk and a head.\nTo be nodded with."
    assert any("120" in warning for warning in found.warnings)
    write(motion, tmp_path / "b.amc")
    text = (tmp_path / "b.asf").read_text()
    for line in ("To be nodded with.", "bodymass 12", "(-inf inf)", "direction 0.6 0.8 0"):
        assert line in text
    assert "# by hand" in (tmp_path / "b.amc").read_text()


def test_the_first_dof_turns_first(tmp_path: Path) -> None:
    """rx ry rz: x innermost. A head along y, rx 90 then rz 90, comes to z."""
    asf = ASF.replace("direction 0.6 0.8 0", "direction 0 1 0")
    rows = AMC.split("1\n")[0] + "1\nroot 0 0 0 0 0 0\ntrunk 0 0\nhead 90 0 90\n"
    _, motion = content(tmp_path, rows, asf)
    _, turns = motion.world()
    w, x, y, z = turns[0, 3]
    tip = np.array([2 * (x * y - w * z), 1 - 2 * (x * x + z * z), 2 * (y * z + w * x)])
    assert np.allclose(tip, [0, 0, 1], atol=1e-12)


@pytest.mark.parametrize(
    ("old", "new", "line", "says"),
    [
        ("trunk 5 -6\n", "trunk 5\n", 6, "needs 2 numbers, got 1"),
        ("trunk 5 -6\n", "trunk 5 nan\n", 6, "finite"),
        ("trunk 5 -6\n", "trunk 5 1_0\n", 6, "number"),
        ("trunk 5 -6\n", "tail 5 -6\n", 6, "no bone 'tail'"),
        ("trunk 5 -6\n", "root 1 2 3 4 5 6\n", 6, "twice"),
        ("trunk 5.5 -6.5\n", "", 8, "lacks 'trunk'"),
        ("\n3\n", "\n4\n", 12, "follows frame 2"),
        ("\n2\n", "\n", 8, "twice"),
        (":DEGREES\n1\n", ":DEGREES\n", 4, "frame's number"),
        ("head 7 8 9\n", "<<<<<<< HEAD\nhead 7 8 9\n", 7, "merge"),
    ],
)
def test_what_is_wrong_is_told_with_its_line(
    tmp_path: Path, old: str, new: str, line: int, says: str
) -> None:
    """In the movement."""
    assert old in AMC
    with pytest.raises(FormatError) as error:
        content(tmp_path, AMC.replace(old, new, 1))
    assert error.value.line == line, str(error.value)
    assert says in error.value.message


@pytest.mark.parametrize(
    ("old", "new", "line", "says"),
    [
        ("length 5.5", "length five", 20, "number"),
        ("direction 0 1 0\n    length 0.5", "direction 0 1\n    length 0.5", 30, "3 numbers"),
        ("dof rx rz", "dof rx rw", 22, "rw"),
        ("dof rx rz", "dof rx l", 22, "length"),
        ("limits (-20.0 45.0)\n           (-inf inf)", "limits (-20.0 45.0)", 23, "2 limits"),
        ("    neck head\n", "", 34, "does not hang"),
        ("    neck head\n", "    neck head tail\n", 46, "tail"),
        ("    neck head\n", "    neck head trunk\n", 46, "two bones"),
        ("    root trunk\n", "    head trunk\n", 16, "does not hang"),
        ("name neck", "name trunk", 27, "name of its own"),
        ("length 0.45", "length 0", 5, "above 0"),
        (":hierarchy", ":hierarch", 47, ":hierarchy"),
        ("axis 0 0 20 XYZ", "axis 0 0 20 XXZ", 21, "XXZ"),
    ],
)
def test_what_is_wrong_in_the_skeleton(
    tmp_path: Path, old: str, new: str, line: int, says: str
) -> None:
    """The ASF file is named, with its line."""
    assert old in ASF
    with pytest.raises(FormatError) as error:
        content(tmp_path, asf=ASF.replace(old, new, 1))
    assert error.value.file.endswith("09.asf")
    assert error.value.line == line, str(error.value)
    assert says in error.value.message


def test_the_skeleton_is_found(tmp_path: Path) -> None:
    """Its own name first, then the subject's, then the only one; else an error says what to do."""
    amc = tmp_path / "09_01.amc"
    amc.write_text(AMC)
    with pytest.raises(FormatError, match=r"put 09\.asf beside it \(there: none\)"):
        companion(amc)
    (tmp_path / "other.ASF").write_text(ASF)
    assert companion(amc).name == "other.ASF"
    (tmp_path / "third.asf").write_text(ASF)
    with pytest.raises(FormatError, match=r"other\.ASF, third\.asf"):
        companion(amc)
    (tmp_path / "09.asf").write_text(ASF)
    assert companion(amc).name == "09.asf"
    (tmp_path / "09_01.asf").write_text(ASF)
    assert companion(amc).name == "09_01.asf"


def test_a_skeleton_alone_is_one_frame_at_rest(tmp_path: Path) -> None:
    """With a warning that says where the movement is."""
    (tmp_path / "a.asf").write_text(ASF)
    found = read(tmp_path / "a.asf")
    assert isinstance(found.motion, SkeletonMotion)
    assert found.motion.frames == 1
    assert not found.motion.values.any()
    assert any("AMC" in warning for warning in found.warnings)


def test_bones_that_never_move_may_be_left_out(tmp_path: Path) -> None:
    """Files without lines for the hands: at rest, with a warning."""
    found, motion = content(
        tmp_path,
        AMC.replace("head 7 8 9\n", "")
        .replace("head 7.5 8.5 9.5\n", "")
        .replace("head 8 9 10\n", ""),
    )
    assert motion.frames == 3
    assert not motion.values[:, motion.skeleton.columns(3)].any()
    assert any("head" in warning for warning in found.warnings)


def test_radians(tmp_path: Path) -> None:
    """The movement's unit of angle is its own; limits follow it."""
    _, degrees = content(tmp_path)
    turned = np.array([line.split()[1:] for line in AMC.splitlines() if line[:4] == "head"], float)
    lines = iter(" ".join(map(repr, row)) for row in np.radians(turned).tolist())
    text = "\n".join(
        f"head {next(lines)}" if line.startswith("head") else line for line in AMC.splitlines()
    )
    _, radians = content(tmp_path, text.replace(":DEGREES", ":RADIANS") + "\n")
    assert radians.skeleton.space.radians_per_unit == 1.0
    assert np.allclose(radians.local()[1][:, 3], degrees.local()[1][:, 3], atol=1e-12)
    assert np.allclose(radians.skeleton.joints[1].limits[0], np.radians([-20, 45]))
    write(radians, tmp_path / "b.amc")
    assert equal(motion_of(tmp_path / "b.amc"), radians)


def test_any_skeleton_becomes_bones(tmp_path: Path) -> None:
    """Several children in several places get rigid bones; joints stay where they were."""
    for seed in range(30):
        first = made(seed)
        write(first, tmp_path / "a.amc")
        again = motion_of(tmp_path / "a.amc")
        names = {name: index for index, name in enumerate(again.skeleton.names)}
        ours = first.skeleton.space.points(first.world()[0])
        theirs = again.skeleton.space.points(again.world()[0])
        roots = sum(joint.parent < 0 for joint in first.skeleton.joints)
        for index, name in enumerate(first.skeleton.names):
            other = names["root" if index == 0 and roots == 1 else name]
            assert np.allclose(theirs[:, other], ours[:, index], atol=1e-9), (seed, name)


def test_a_movement_of_hardly_any_bone_is_refused(tmp_path: Path) -> None:
    """Bones without a line take room in every frame: a big skeleton would fill the memory."""
    bones = "".join(
        f"begin\nname b{i}\ndirection 0 1 0\nlength 1\ndof rx ry rz\nend\n" for i in range(40)
    )
    asf = ASF.replace(":hierarchy", bones + ":hierarchy").replace(
        "root trunk", "root trunk " + " ".join(f"b{i}" for i in range(40))
    )
    with pytest.raises(FormatError, match="hardly any bone"):
        content(tmp_path, AMC, asf)
