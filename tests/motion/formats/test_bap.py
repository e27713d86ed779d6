"""MPEG-4 body animation parameters: the standard's numbers, right-handed angles, masks."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp

from enpointe.errors import FormatError
from enpointe.motion.formats import SkeletonMotion, read
from enpointe.motion.formats.bap import PARAMETERS, write_bap

COUNT = 186


def written(tmp_path: Path, frames: list[tuple[list[int], list[int]]], count: int = COUNT) -> Path:
    path = tmp_path / "made.bap"
    lines = [f"2.1 made 25 {len(frames)}"]
    for number, (present, values) in enumerate(frames):
        lines.append(" ".join("1" if i in present else "0" for i in range(1, count + 1)))
        lines.append(" ".join(map(str, [number, *values])))
    path.write_text("\n".join(lines) + "\n")
    return path


def test_the_standards_numbers() -> None:
    """Known numbers of ISO/IEC 14496-2 table C: 1, 4, 47, 48, 122, 123, 170, 180 and 186."""
    assert len(PARAMETERS) == COUNT
    known = {
        1: "sacroiliac_tilt",
        4: "l_hip_flexion",
        47: "r_wrist_twisting",
        48: "skullbase_roll",
        122: "vl5_tilt",
        123: "l_pinky0_flexion",
        170: "r_index3_flexion",
        180: "r_thumb3_flexion",
        181: "HumanoidRoot_tr_vertical",
        186: "HumanoidRoot_rt_body_tilt",
    }
    for number, name in known.items():
        assert PARAMETERS[number - 1].name == name
    assert len({p.name for p in PARAMETERS}) == COUNT
    assert len({(p.joint, p.channel) for p in PARAMETERS}) == COUNT


def test_a_bent_knee_bends_back(tmp_path: Path) -> None:
    """Parameter 10, the left knee's flexion: the heel goes behind, about -x by the right hand."""
    motion = read(written(tmp_path, [([10], [157080])])).motion
    assert isinstance(motion, SkeletonMotion)
    _, turns = motion.world()
    knee = motion.skeleton.names.index("l_knee")
    np.testing.assert_allclose(turns[0, knee], [np.sqrt(0.5), -np.sqrt(0.5), 0, 0], atol=1e-5)


def test_a_parameter_that_a_frame_lacks_keeps_its_value(tmp_path: Path) -> None:
    content = read(written(tmp_path, [([2, 181], [7, 900]), ([181], [901]), ([2], [9])]))
    motion = content.motion
    assert isinstance(motion, SkeletonMotion)
    assert motion.values.tolist() == [[900, 7], [901, 7], [901, 9]]
    assert any("keeps its value" in warning for warning in content.warnings)


def test_extension_parameters_are_lost_and_told(tmp_path: Path) -> None:
    content = read(written(tmp_path, [([2, 190, 296], [7, 8, 9])], count=296))
    assert content.lost == ("2 extension parameters",)
    assert isinstance(content.motion, SkeletonMotion)
    assert content.motion.values.tolist() == [[7]]


@settings(max_examples=30)
@given(
    present=st.sets(st.integers(1, COUNT), min_size=1, max_size=9),
    values=hnp.arrays(int, (3, COUNT), elements=st.integers(-(2**31) + 1, 2**31 - 1)),
)
def test_what_is_written_reads_back_the_same(
    tmp_path_factory: pytest.TempPathFactory, present: set[int], values: np.ndarray
) -> None:
    folder = tmp_path_factory.mktemp("bap")
    rows = [(sorted(present), row[: len(present)].tolist()) for row in values]
    path = written(folder, rows)
    motion = read(path).motion
    assert isinstance(motion, SkeletonMotion)
    assert write_bap(motion, folder / "again.bap") == ()
    assert (folder / "again.bap").read_text() == path.read_text()


@pytest.mark.parametrize(
    ("old", "new", "line"),
    [
        ("0 7", "0 7 8", 3),
        ("0 7", "0 seven", 3),
        ("0 7", "0 7.5", 3),
        ("2.1 made 25 1", "2.1 made 0 1", 1),
        ("0 7\n", "", 2),
    ],
)
def test_nonsense_is_refused_with_its_line(tmp_path: Path, old: str, new: str, line: int) -> None:
    path = written(tmp_path, [([2], [7])])
    path.write_text(path.read_text().replace(old, new))
    with pytest.raises(FormatError) as caught:
        read(path)
    assert caught.value.line in (line, line + 1)
