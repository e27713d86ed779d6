"""`enpointe convert`: files in, files out, and what it refuses."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import enpointe
from enpointe.cli import _run
from enpointe.errors import EnpointeError
from enpointe.models import dancer_model
from enpointe.models.puppet import op3_model
from enpointe.motion import Motion
from enpointe.motion.formats import (
    Joint,
    MarkerMotion,
    Skeleton,
    SkeletonMotion,
    Space,
    formats,
    read,
    write,
)
from enpointe.motion.formats.mjcf import read_keyframes
from enpointe.motion.formats.mnm import write_names
from enpointe.motion.gesture import Scene
from enpointe.motion.npz import load_motion, save_motion

from ..motion.formats.making import marker_motion
from ..motion.formats.movements import body_places, writhing
from .commands import one_object, refused

FIELDS = {"read", "written", "frames", "rate", "channels", "warnings", "lost", "files"}
SIX = tuple(f"{a}position" for a in "XYZ") + tuple(f"{a}rotation" for a in "ZXY")


def leg() -> SkeletonMotion:
    """Hips at a metre's height and a knee that bends, in centimetres, as large as a person."""
    hips = Joint("hips", -1, channels=SIX, ends=((0.0, 165.0, 0.0),))
    knee = Joint("knee", 0, (0.0, -45.0, 0.0), ("Xrotation",), ends=((0.0, -45.0, 0.0),))
    values = np.zeros((31, 7))
    values[:, 1] = 100.0
    values[:, 6] = np.linspace(0.0, 90.0, 31)
    return SkeletonMotion(Skeleton((hips, knee), Space(0.01)), 30.0, values)


@pytest.fixture
def bvh(home: Path) -> Path:
    write(leg(), home / "leg.bvh")
    return home / "leg.bvh"


@pytest.fixture
def npz(home: Path) -> Path:
    save_motion(writhing(frames=21), home / "motion.npz")
    return home / "motion.npz"


def names_here() -> list[str]:
    return sorted(path.name for path in Path().iterdir())


def test_it_prints_one_object_and_writes_one_file(
    bvh: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    assert _run(["convert", str(bvh), "made/leg.htr", "--json"]) == 0
    out, err = capfd.readouterr()
    assert err == ""
    figures = one_object(out)
    assert set(figures) == FIELDS
    assert (figures["read"], figures["written"]) == ("BVH", "HTR")
    assert (figures["frames"], figures["rate"], figures["channels"]) == (31, 30.0, 7)
    assert figures["files"] == {"motion": "made/leg.htr"}
    assert [path.name for path in Path("made").iterdir()] == ["leg.htr"]
    assert any("no unit of length" in line for line in figures["warnings"])


def test_people_read_a_table_and_quiet_is_quiet(
    bvh: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    assert _run(["convert", str(bvh), "leg.trc"]) == 0
    text = " ".join(capfd.readouterr().out.split())
    assert "TRC, 31 frames at 30 a second" in text
    assert "lost the hierarchy and the rotations of the joints" in text
    assert _run(["convert", str(bvh), "leg.amc", "-q"]) == 0
    assert capfd.readouterr() == ("", "")
    assert {"leg.amc", "leg.asf"} <= set(names_here())


@pytest.mark.parametrize("suffix", [".trc", ".c3d", ".csv"])
def test_joints_become_markers_where_they_are(bvh: Path, suffix: str) -> None:
    """With the ends of bones; a table of markers is asked for by its name."""
    done = enpointe.convert(bvh, f"leg{suffix}", to="CSV" if suffix == ".csv" else None)
    found = read(done.files["motion"]).motion
    assert isinstance(found, MarkerMotion)
    assert found.names == ("hips", "knee", "hips end", "knee end")
    points = found.space.points(found.positions)
    assert np.allclose(points[0], [[0, 0, 1.0], [0, 0, 0.55], [0, 0, 2.65], [0, 0, 0.1]], atol=1e-6)
    assert np.allclose(points[-1, 3], [-0.45, 0, 0.55], atol=1e-6)


def test_a_scene_and_back_to_markers(bvh: Path) -> None:
    done = enpointe.convert(bvh, "leg.gst")
    scene = read(done.files["motion"]).motion
    assert isinstance(scene, Scene)
    assert (done.frames, done.rate) == (31, 30.0)
    back = enpointe.convert("leg.gst", "leg.csm", rate=60)
    assert (back.frames, back.rate) == (61, 60.0)
    assert any("angle" in line or "knee X" in line for line in back.lost)


@pytest.mark.parametrize("suffix", [".bvh", ".htr", ".amc", ".trc", ".c3d", ".csv", ".gst", ".glb"])
def test_the_dancers_motion_goes_everywhere(npz: Path, suffix: str) -> None:
    """Each file has its frames, says what falls, and is read again where there is a reader."""
    done = enpointe.convert(npz, f"out{suffix}")
    assert any("events" in line for line in done.lost)
    assert all(path.is_file() for path in done.files.values())
    if suffix != ".glb":
        read(done.files["motion"])
    if suffix != ".gst":
        assert (done.frames, done.rate) == (21, 100.0)


def test_the_dancers_bodies_stand_where_they_stood(npz: Path) -> None:
    """In centimetres, at half the rate."""
    enpointe.convert(npz, "out.bvh", rate=50, unit="cm")
    found = read("out.bvh").motion
    assert isinstance(found, SkeletonMotion)
    assert found.skeleton.space.metres_per_unit == 0.01
    places = found.skeleton.space.points(found.world()[0])
    assert np.allclose(places, body_places(writhing(frames=21))[::2], rtol=0, atol=1e-9)


def test_keyframes_and_back(npz: Path) -> None:
    enpointe.convert(npz, "keys.xml")
    model = dancer_model(flesh=False)
    keys = read_keyframes(Path("keys.xml"), model)
    enpointe.convert("keys.xml", "back.npz")
    back = load_motion(Path("back.npz"), model)
    assert np.array_equal(keys.qpos, back.qpos)
    assert np.array_equal(back.qpos, writhing(frames=21).qpos)


def test_a_puppets_motion_goes_to_ros(home: Path) -> None:
    """Points at its own rate, hinges alone, and it is said that the root stays behind."""
    model = op3_model()
    time = np.arange(0.0, 0.505, 0.01)
    qpos = np.tile(model.key("standing").qpos, (len(time), 1))
    qpos[:, int(model.joint("r_el").qposadr[0])] = 0.3 * np.sin(3.0 * time)
    save_motion(Motion.from_qpos(model, time, qpos, name="wave"), home / "wave.npz")
    done = enpointe.convert("wave.npz", "wave.yaml")
    assert done.written == "ros2"
    assert any("root" in line for line in done.lost)
    text = Path("wave.yaml").read_text(encoding="utf-8")
    assert text.count("time_from_start") == done.frames == 51
    assert "r_el" in text.split("points:")[0]
    bag = enpointe.convert("wave.npz", "wave.mcap", rate=25).files["motion"]
    assert bag.read_bytes().startswith(b"\x89MCAP")
    with pytest.raises(EnpointeError):
        enpointe.convert("wave.npz", "wave.bvh")


def test_rates_units_and_names(home: Path, bvh: Path) -> None:
    """A rate that the file has wrong, one to write, millimetres, and names from an MNM file."""
    write_names({"hips": "Pelvis", "knee": "Shin"}, home / "names.mnm")
    done = enpointe.convert(
        bvh, "leg.csv", source_rate=60, rate=120, unit="mm", names=home / "names.mnm"
    )
    assert (done.frames, done.rate) == (61, 120.0)
    found = read("leg.csv").motion
    assert isinstance(found, SkeletonMotion)
    assert found.skeleton.names == ("Pelvis", "Shin")
    assert found.values[0, 1] == 1000.0
    assert found.skeleton.space.metres_per_unit == 0.001


@pytest.mark.parametrize("suffix", [".trc", ".c3d", ".csv"])
def test_a_unit_without_a_name_becomes_millimetres(home: Path, suffix: str) -> None:
    """CMU's unit is inches / 0.45, which these formats can't name."""
    motion = leg()
    metres = 0.0254 / 0.45
    joints = [replace(j, offset=(0.0, 1.0, 0.0), ends=()) for j in motion.skeleton.joints]
    strange = replace(motion, skeleton=Skeleton(tuple(joints), Space(metres)))
    write(strange, home / "a.htr")
    done = enpointe.convert("a.htr", f"a{suffix}")
    assert any("in mm" in line for line in done.warnings)
    found = read(f"a{suffix}").motion
    if isinstance(found, MarkerMotion):
        assert found.space.points(found.positions)[0, 1, 2] == pytest.approx(101 * metres)
    else:
        assert isinstance(found, SkeletonMotion)
        # HTR adds the place to the offset, which a table does not hold.
        assert found.values[0, 1] == pytest.approx(99 * metres / 0.001)


def test_an_ending_can_be_overruled(bvh: Path) -> None:
    done = enpointe.convert(bvh, "leg.dat", to="gtr")
    assert done.written == "GTR"
    found = read("leg.dat").motion
    assert isinstance(found, SkeletonMotion)
    assert found.frames == 31


@pytest.mark.parametrize(
    ("source", "target", "says"),
    [
        ("third-port-de-bras", "a.bvh", "is a score: dance it first"),
        ("mine.bmn", "a.bvh", "is a score: dance it first"),
        ("missing.bvh", "a.htr", "missing.bvh: can't be read"),
        ("markers.trc", "a.bvh", "does not become a skeleton's movement"),
        ("leg.bvh", "a.npz", "does not become the dancer's motion"),
        ("leg.bvh", "a.glb", "does not become the dancer's motion"),
        ("leg.bvh", "a.xyz", ".trc .npz .gltf .glb .xml .yaml .yml .mcap"),
        ("leg.bvh", "a", "ends in ''"),
        ("leg.bvh", "leg.bvh", "is what is to be converted"),
        ("leg.bvh", "./there/../leg.bvh", "is what is to be converted"),
        ("leg.bvh", "same.bvh", "is what is to be converted"),
        ("leg.bvh", "there", "ends in ''"),
        ("cut.bvh", "a.htr", "cut.bvh:"),
        ("empty.bvh", "a.htr", "empty"),
    ],
)
def test_what_it_refuses(
    bvh: Path, capfd: pytest.CaptureFixture[str], source: str, target: str, says: str
) -> None:
    """One line, exit code 2, nothing written, the input as it was."""
    write(marker_motion(), Path("markers.trc"))
    Path("cut.bvh").write_bytes(bvh.read_bytes()[:150])
    Path("empty.bvh").touch()
    Path("there").mkdir()
    Path("same.bvh").symlink_to("leg.bvh")
    before, raw = names_here(), bvh.read_bytes()
    assert says in refused(capfd, "convert", source, target)
    assert names_here() == before
    assert bvh.read_bytes() == raw


@pytest.mark.parametrize(
    ("options", "says"),
    [
        (["--rate", "0"], "rate must be above 0"),
        (["--rate", "nan"], "rate must be above 0"),
        (["--rate", "1e15"], "frames at that rate"),
        (["--source-rate", "-3"], "rate must be above 0"),
        (["--unit", "ell"], "no unit of length is called 'ell'"),
        (["--to", "FBX"], "no motion format to write is called 'FBX'"),
        (["--names", "none.mnm"], "none.mnm"),
    ],
)
def test_options_that_are_wrong(
    bvh: Path, capfd: pytest.CaptureFixture[str], options: list[str], says: str
) -> None:
    assert says in refused(capfd, "convert", str(bvh), "a.htr", *options)
    assert names_here() == ["leg.bvh"]


def test_a_skeleton_beside_is_not_overwritten_either(
    home: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    """An AMC file is read with the ASF file beside it, and writing one writes both."""
    write(leg(), home / "05.amc")
    Path("05.amc").rename("05_01.amc")
    assert "05.asf is what is to be converted" in refused(capfd, "convert", "05_01.amc", "05.amc")
    assert _run(["convert", "05_01.amc", "other/05.amc", "-q"]) == 0
    Path("other/05.asf").rename("skeleton.asf")
    assert "05.asf" in refused(capfd, "convert", "other/05.amc", "a.bvh")
    assert _run(["convert", "other/05.amc", "a.bvh", "--skeleton", "skeleton.asf", "-q"]) == 0
    assert "only an AMC file" in refused(
        capfd, "convert", "a.bvh", "b.bvh", "--skeleton", "skeleton.asf"
    )


def test_any_skeleton_format_to_any(home: Path) -> None:
    """All pairs: the knee is where it was, but for a unit that was lost and is told so."""
    whole = [each for each in formats() if each.name in ("BVH", "AMC", "BVA", "HTR", "GTR")]
    expected = leg().skeleton.space.points(leg().world()[0])
    for one in whole:
        first = home / f"one{one.suffixes[0]}"
        write(leg(), first)
        for other in whole:
            target = home / f"{one.name}-to{other.suffixes[0]}"
            done = enpointe.convert(first, target)
            found = read(target).motion
            assert isinstance(found, SkeletonMotion)
            places = found.skeleton.space.points(found.world()[0])
            if any(line.startswith("the unit of length") for line in done.lost):
                places *= 0.01 / found.skeleton.space.metres_per_unit
            names = list(found.skeleton.names)
            assert np.allclose(places[:, names.index("knee")], expected[:, 1], atol=1e-9), target


@pytest.mark.parametrize(
    ("file", "target"), [("cmu_c3d/85_02.c3d", "her.bvh"), ("cmu_05/05_12.amc", "her.npz")]
)
def test_a_capture_is_put_on_the_dancer(home: Path, data_dir: Path, file: str, target: str) -> None:
    """Markers become a skeleton, and a skeleton her motion, by way of her body."""
    done = enpointe.convert(data_dir / file, target, on_dancer=True, rate=10)
    model = dancer_model(flesh=False)
    assert any("the captured body" in line for line in done.lost)
    if target.endswith(".npz"):
        motion = load_motion(Path(target), model)
        assert len(motion.time) == done.frames
        assert motion.name == "05_12"
        return
    found = read(target).motion
    assert isinstance(found, SkeletonMotion)
    assert found.frames == done.frames
    assert found.skeleton.names == tuple(model.body(i).name for i in range(1, model.nbody))


def test_her_own_motion_is_hers_already(npz: Path, capfd: pytest.CaptureFixture[str]) -> None:
    says = refused(capfd, "convert", str(npz), "a.bvh", "--on-dancer")
    assert "only a skeleton or markers are put on the dancer" in says


def test_python_raises_what_the_command_says(bvh: Path) -> None:
    with pytest.raises(EnpointeError, match="does not become the dancer's motion"):
        enpointe.convert(bvh, "a.npz")
