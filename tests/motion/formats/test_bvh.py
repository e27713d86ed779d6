"""BVH as its makers write it, and as they should not."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from enpointe.errors import FormatError
from enpointe.motion.formats import Content, SkeletonMotion, Space, read, write
from enpointe.motion.formats.skeleton import Joint
from enpointe.motion.formats.units import INCH, stature

from .skeletons import BVH_DOCUMENT, made


def content(tmp_path: Path, text: str) -> tuple[Content, SkeletonMotion]:
    path = tmp_path / "a.bvh"
    path.write_text(text, newline="")
    found = read(path)
    assert isinstance(found.motion, SkeletonMotion)
    return found, found.motion


def refusal(tmp_path: Path, text: str) -> FormatError:
    with pytest.raises(FormatError) as error:
        content(tmp_path, text)
    return error.value


def same(one: SkeletonMotion, other: SkeletonMotion) -> bool:
    return np.array_equal(one.values, other.values) and (
        one.skeleton,
        one.rate,
        one.start,
        one.notes,
    ) == (other.skeleton, other.rate, other.start, other.notes)


def test_all_there_is_reads_and_is_written_alike(data_dir: Path, tmp_path: Path) -> None:
    """Every number, name, offset, rate of all BVH files at hand survives being written."""
    files = sorted(data_dir.glob("*/*.bvh"))
    assert len(files) > 40
    for file in files:
        first = read(file)
        assert isinstance(first.motion, SkeletonMotion)
        assert write(first.motion, tmp_path / "again.bvh") == ()
        again = read(tmp_path / "again.bvh").motion
        assert isinstance(again, SkeletonMotion)
        assert same(again, first.motion), file
        numbers = file.read_text().partition("Frame Time")[2].split()[-first.motion.values.size :]
        assert np.array_equal(np.array(numbers, float), first.motion.values.ravel()), file


@pytest.mark.parametrize(
    ("file", "unit"),
    [
        ("cmu_bvh_motionbuilder/05_14.bvh", INCH / 0.45),
        ("bvh_various/131_01.bvh", INCH / 0.45),
        ("cmu_bvh_daz/05_14.bvh", 0.01),
        ("rokoko/jesse_dance.bvh", 0.01),
        ("bvh_various/walk01.bvh", 0.01),
        ("effort_bvh/walking_0_0_0_0.bvh", 1.0),
    ],
)
def test_the_unit_is_guessed(data_dir: Path, file: str, unit: float) -> None:
    """By the size of the figure; and a warning says so."""
    found = read(data_dir / file)
    assert isinstance(found.motion, SkeletonMotion)
    assert found.motion.skeleton.space == Space(unit)
    assert any("unit" in warning for warning in found.warnings)


@given(st.floats(-10.0, 10.0), st.floats(-10.0, 10.0))
def test_where_a_figure_stands_in_its_scene_does_not_make_it_taller(x: float, y: float) -> None:
    body = (
        Joint("hips", -1),
        Joint("spine", 0, (0.0, 0.5, 0.0), ends=((0.6, 0.0, 0.0),)),
        Joint("leg", 0, (0.1, -0.9, 0.0), ends=((0.0, 0.0, 0.2),)),
    )
    below = tuple(replace(joint, parent=joint.parent + 1) for joint in body)
    scene = (Joint("stage", -1), replace(below[0], offset=(x, y, 0.0)), *below[1:])
    assert stature(scene) == pytest.approx(stature(body))


def test_several_orders_in_one_file(data_dir: Path) -> None:
    """131_01 turns some joints by ZYX and others by ZXY."""
    motion = read(data_dir / "bvh_various" / "131_01.bvh").motion
    assert isinstance(motion, SkeletonMotion)
    assert {joint.product for joint in motion.skeleton.joints} == {"ZYX", "ZXY"}


def test_rotations_are_multiplied_as_they_stand(tmp_path: Path) -> None:
    """A quarter turn about z, then about the turned x: the end of a bone along y comes to z."""
    text = BVH_DOCUMENT.split("8.03")[0].replace("Frames: 2", "Frames: 1")
    _, motion = content(tmp_path, text + "0 0 0 90 90 0 0 0 0\n")
    places, _ = motion.world()
    assert np.allclose(places[0, 1], [0, 0, 5.21], atol=1e-12)


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("\n", "\r\n"),
        ("\n", "\r"),
        ("  ", "\t"),
        (" ", "  "),
        ("Frames: 2", "FRAMES:2"),
        ("Frame Time: 0.033333", "Frame Time:\t.033333"),
        ("HIERARCHY", "\ufeffHIERARCHY"),
        ("HIERARCHY", "\n\nhierarchy"),
        ("8.03 ", "8.03e0 "),
        ("8.03 ", "+80.3E-1 "),
        ("CHANNELS 3 Zrotation", "CHANNELS 3 ZROTATION"),
        ("ROOT Hips\n{", "ROOT Hips {"),
        ("\n7.81", "\n\n7.81"),
    ],
)
def test_manners_of_writing(tmp_path: Path, old: str, new: str) -> None:
    """Line ends, tabs, exponents, capitals and blank lines change nothing."""
    assert old in BVH_DOCUMENT
    _, plainly = content(tmp_path, BVH_DOCUMENT)
    _, other = content(tmp_path, BVH_DOCUMENT.replace(old, new))
    assert np.array_equal(other.values, plainly.values)
    assert other.skeleton == plainly.skeleton


@pytest.mark.parametrize(
    ("old", "new", "line", "says"),
    [
        ("8.03 ", "nan ", 23, "finite"),
        ("8.03 ", "inf ", 23, "finite"),
        ("8.03 ", "8,03 ", 23, "number"),
        ("35.10 ", "", 24, "9 numbers, got 8"),
        ("35.01 ", "", 23, "9 numbers, got 8"),
        ("35.01 ", "35.01 1 ", 23, "got 10"),
        ("8.03 ", "<<<<<<< HEAD\n8.03 ", 23, "merge"),
        ("HIERARCHY\n", "<<<<<<< HEAD\nHIERARCHY\n", 1, "merge"),
        ("Frame Time: 0.033333", "Frame Time: 0", 22, "above 0"),
        ("Frame Time: 0.033333", "Frame Time: nan", 22, "finite"),
        ("Frame Time: 0.033333", "Frame Time: -1", 22, "above 0"),
        ("Frame Time: 0.033333\n", "", 22, "Frame Time expected"),
        ("Frames: 2", "Frames: two", 21, "number"),
        ("Frames: 2", "Frames: 1e30", 21, "whole number"),
        ("OFFSET 0.00 5.21", "OFFSET 5.21", 8, "3 numbers"),
        ("CHANNELS 3 Z", "CHANNELS 4 Z", 9, "says 4"),
        ("CHANNELS 3 Zrotation", "CHANNELS 3 Wrotation", 9, "Wrotation"),
        ("CHANNELS 3 Zrotation", "CHANNELS 3 Xrotation", 9, "twice"),
        ("}\nMOTION", "MOTION", 18, "missing"),
        ("MOTION", "NOTION", 20, "NOTION"),
        ("  JOINT Chest", "  JOIN Chest", 6, "JOIN"),
    ],
)
def test_what_is_wrong_is_told_with_its_line(
    tmp_path: Path, old: str, new: str, line: int, says: str
) -> None:
    """Nothing is read of a file that is wrong, and the line is named."""
    assert old in BVH_DOCUMENT
    error = refusal(tmp_path, BVH_DOCUMENT.replace(old, new, 1))
    assert error.line == line, str(error)
    assert says in error.message


@pytest.mark.parametrize(("declared", "rows"), [(1, 2), (3, 2), (0, 2), (999_999_999, 2)])
def test_frames_that_disagree_with_the_rows(tmp_path: Path, declared: int, rows: int) -> None:
    """The rows that are there are taken, and a warning says so."""
    found, motion = content(tmp_path, BVH_DOCUMENT.replace("Frames: 2", f"Frames: {declared}"))
    assert motion.frames == rows
    assert any(f"Frames says {declared}" in warning for warning in found.warnings)


def test_a_file_cut_within_a_frame(tmp_path: Path) -> None:
    """Its whole frames are read, the last is left out, and two warnings say so."""
    found, motion = content(tmp_path, BVH_DOCUMENT[:-30])
    assert motion.frames == 1
    assert any("left out" in warning for warning in found.warnings)


def test_frames_over_several_lines(tmp_path: Path) -> None:
    """Where the number of values is right, the lines are put together, with a warning."""
    found, motion = content(tmp_path, BVH_DOCUMENT.replace(" -164.35 ", " -164.35\n"))
    assert refusal(tmp_path, BVH_DOCUMENT.replace(" -164.35 ", " -164.35\n1 ")).line == 23
    broken = BVH_DOCUMENT.replace(" 13.09 40", "\n13.09 40").replace(" 12.64 42", "\n12.64 42")
    found, motion = content(tmp_path, broken)
    assert np.array_equal(motion.values, content(tmp_path, BVH_DOCUMENT)[1].values)
    assert any("lines" in warning for warning in found.warnings)


def test_doubles_are_renamed(tmp_path: Path) -> None:
    """Two joints of one name get numbers, with a warning; neither takes a name that is there."""
    text = BVH_DOCUMENT.replace("JOINT Neck", "JOINT Chest").replace("ROOT Hips", "ROOT Chest_2")
    found, motion = content(tmp_path, text)
    assert motion.skeleton.names == ("Chest_2", "Chest", "Chest_3")
    assert any("Chest_3" in warning for warning in found.warnings)


def test_two_roots_and_names_with_blanks(tmp_path: Path) -> None:
    """Hierarchies one after the other; names are all that stands behind the word."""
    one = BVH_DOCUMENT.split("HIERARCHY\n")[1].split("MOTION")[0]
    other = one.replace("Hips", "Left Hand").replace("Chest", "b").replace("Neck", "c")
    rows = "MOTION\nFrames: 1\nFrame Time: .1\n" + "1 " * 18 + "\n"
    _, motion = content(tmp_path, "HIERARCHY\n" + one + other + rows)
    assert [joint.parent for joint in motion.skeleton.joints] == [-1, 0, 1, -1, 3, 4]
    lost = write(motion, tmp_path / "b.bvh")
    assert any("blanks" in line for line in lost)
    again = read(tmp_path / "b.bvh").motion
    assert isinstance(again, SkeletonMotion)
    assert again.skeleton.names[3] == "Left_Hand"


def test_end_sites_keep_their_names(tmp_path: Path) -> None:
    """A site that is called otherwise is called so again."""
    _, motion = content(tmp_path, BVH_DOCUMENT.replace("End Site", "End Crown"))
    write(motion, tmp_path / "b.bvh")
    assert "End Crown" in (tmp_path / "b.bvh").read_text()


def test_no_number_that_is_none_is_written(tmp_path: Path) -> None:
    """The writer refuses, names the frame, and leaves what was there."""
    motion = made(1)
    values = motion.values.copy()
    values[2, 0] = np.nan
    broken = SkeletonMotion(motion.skeleton, motion.rate, values)
    path = tmp_path / "a.bvh"
    path.write_text("before")
    with pytest.raises(FormatError, match="frame 2"):
        write(broken, path)
    assert path.read_text() == "before"
