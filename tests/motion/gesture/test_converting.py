"""Markers, skeletons and dances become scenes, and points become markers again."""

from __future__ import annotations

from pathlib import Path

import mujoco
import numpy as np
import pytest

from enpointe.errors import EnpointeError, FormatError, MotionError
from enpointe.motion import Motion, formats
from enpointe.motion.formats import Analog, Joint, MarkerMotion, Skeleton, SkeletonMotion, Space
from enpointe.motion.formats.gst import GST
from enpointe.motion.formats.scenes import markers_of_scene, scene_of_markers, scene_of_skeleton
from enpointe.motion.gesture import (
    Channel,
    Dimension,
    Scene,
    Unit,
    Variable,
    read_scene,
    scene_of_motion,
)

from ..dancing import tiny_model
from ..test_motion import swinging
from .scenes import assert_same, keyboard

MILLIMETRES = Space(0.001, up="y")


def markers(space: Space = MILLIMETRES) -> MarkerMotion:
    positions = np.random.default_rng(2).normal(scale=900.0, size=(5, 3, 3))
    positions[2, 1] = np.nan
    return MarkerMotion(("LHEE", "RHEE", "SACR"), 120.0, positions, space)


@pytest.mark.parametrize(
    ("space", "measure"),
    [
        (MILLIMETRES, "mm"),
        (Space(1.0, up="z"), "m"),
        (Space(0.0254, up="x"), "in"),
        (Space(0.05644444444444444, up="y"), "0.05644444444444444 m"),
    ],
    ids=["mm", "m", "in", "odd"],
)
def test_markers_there_and_back(space: Space, measure: str) -> None:
    motion = markers(space)
    scene, lost = scene_of_markers(motion, "walk")
    assert not lost
    assert {c.measure for c in scene.units[0].channels} == {measure}
    back, lost = markers_of_scene(scene)
    assert not lost
    assert (back.names, back.rate, back.space.up) == (motion.names, motion.rate, "z")
    assert back.space.metres_per_unit == space.metres_per_unit
    ours = motion.space.points(motion.positions)
    np.testing.assert_allclose(back.space.points(back.positions), ours, rtol=1e-15, atol=0)


def test_what_a_scene_of_markers_does_not_hold_is_listed() -> None:
    analog = Analog(("Fz", "EMG"), ("N", "mV"), 1000.0, np.arange(8.0).reshape(4, 2))
    full = markers()
    motion = MarkerMotion(
        full.names,
        full.rate,
        full.positions,
        full.space,
        start=7,
        residuals=np.zeros((5, 3)),
        analog=analog,
        notes={"by": "us"},
    )
    scene, lost = scene_of_markers(motion)
    force, values = scene.channel("analog", "Fz")
    assert force.tolist() == [0, 0.001, 0.002, 0.003]
    assert values.ravel().tolist() == [0, 2, 4, 6]
    assert scene.units[1].channels == (Channel("Fz", Variable.FORCE, Dimension.SCALAR, "N"),)
    assert len(lost) == 4
    for what in ("EMG", "residuals", "1 notes", "first frame, 7"):
        assert any(what in line for line in lost), what


def test_points_among_other_things_are_the_markers() -> None:
    channels = (Channel("A", measure="m"), Channel("f", Variable.FORCE, Dimension.XYZ, "N"))
    one = Unit("one", channels, 100.0)
    other = Unit("other", (Channel("A", measure="cm"),), 100.0)
    values = np.arange(12.0).reshape(2, 6)
    scene = Scene("", (one, other), (values, values[:, :3]))
    motion, lost = markers_of_scene(scene)
    assert motion.names == ("one:A", "other:A")
    assert motion.space.metres_per_unit == 1.0
    np.testing.assert_allclose(motion.positions[1], [[6.0, 7.0, 8.0], [0.06, 0.07, 0.08]])
    assert len(lost) == 1
    assert "f [IV(F), 3Dxyz]" in lost[0]


def test_scenes_that_are_no_markers_say_why() -> None:
    point = Channel("A", measure="m")
    values = np.zeros((2, 3))
    slow, fast = Unit("slow", (point,), 50.0), Unit("fast", (point,), 100.0)
    with pytest.raises(MotionError, match="no 3D positions"):
        markers_of_scene(keyboard())
    with pytest.raises(MotionError, match="2 at 50 Hz, 2 at 100 Hz"):
        markers_of_scene(Scene("", (slow, fast), (values, values)))
    with pytest.raises(MotionError, match="no known length"):
        markers_of_scene(Scene("", (Unit("u", (Channel("A", measure="apples"),), 1.0),), (values,)))


def arm() -> SkeletonMotion:
    joints = (
        Joint("root", -1, (0, 0, 0), ("Xposition", "Yposition", "Zposition", "Zrotation")),
        Joint("hand", 0, (0, 2, 0), ("Zrotation", "Xrotation", "Yrotation")),
        Joint("tip", 1, (1, 0, 0)),
    )
    values = np.array([[0, 1, 0, 0, 0, 0, 0], [3, 1, 2, 90, 10, 20, 30]], dtype=float)
    return SkeletonMotion(Skeleton(joints, Space(0.01, up="y")), 60.0, values)


def test_a_skeleton_gives_points_and_angles_joint_by_joint() -> None:
    motion = arm()
    scene, lost = scene_of_skeleton(motion, "arm")
    unit, signal = scene.unit("skeleton")
    labels = [channel.label for channel in unit.channels]
    assert labels == [
        "root [EV(P), 3Dxyz]",
        "root Z [EV(A), 1Dz]",
        "hand [EV(P), 3Dxyz]",
        "hand ZXY [EV(A), 3Dxyz]",
        "tip [EV(P), 3Dxyz]",
    ]
    assert [channel.measure for channel in unit.channels] == ["cm", "deg", "cm", "deg", "cm"]
    # The file's x is our y, its y our z and its z our x; a turn about z takes its y to -x.
    np.testing.assert_allclose(signal[1, :4], [2, 3, 1, 90], atol=1e-12)
    np.testing.assert_allclose(signal[1, 4:7], [2, 3 - 2, 1], atol=1e-12)
    np.testing.assert_allclose(signal[1, 7:10], [20, 30, 10], atol=1e-12)
    assert lost == ("the hierarchy and its offsets",)
    points, _ = markers_of_scene(scene)
    world, _ = motion.world()
    np.testing.assert_allclose(
        points.space.points(points.positions), motion.skeleton.space.points(world), atol=1e-15
    )


def test_a_dance_has_positions_and_forces_at_their_own_rates() -> None:
    motion = swinging()
    scene = scene_of_motion(motion, position_rate=50, force_rate=2000)
    assert [(u.name, u.rate, len(s)) for u, s in zip(scene.units, scene.signals, strict=True)] == [
        ("dancer", 50, 101),
        ("floor", 2000, 4001),
    ]
    time, bent = scene.channel("dancer", "hinge")
    np.testing.assert_allclose(bent[:, 0], np.sin(3 * time), atol=1e-12)
    np.testing.assert_allclose(scene.channel("dancer", "root")[1][:, 0], 0.3 * time, atol=1e-12)
    turn = scene.channel("dancer", "root turn")[1]
    np.testing.assert_allclose(np.exp(1j * turn[:, 2]), np.exp(1.3j * time), atol=1e-9)
    np.testing.assert_allclose(turn[:, :2], 0, atol=1e-12)


def test_the_floor_gives_what_moves_the_centre_of_mass() -> None:
    """F = m (a - g), the acceleration by differences of the centre of mass itself."""
    model = tiny_model()
    time = np.arange(2001) / 1000
    qpos = np.zeros((len(time), 8))
    qpos[:, 2], qpos[:, 3] = 1 + 0.1 * np.sin(2 * time), 1.0
    qpos[:, 7] = np.sin(3 * time)
    motion = Motion.from_qpos(model, time, qpos, name="bob")
    scene = scene_of_motion(motion, force_rate=1000)
    _, weight = scene.channel("floor", "centre of mass")
    _, force = scene.channel("floor", "ground reaction")
    mass = float(model.body_mass.sum())
    acceleration = np.gradient(np.gradient(weight, time, axis=0), time, axis=0)
    expected = mass * (acceleration - model.opt.gravity)
    inner = slice(10, -10)
    np.testing.assert_allclose(force[inner], expected[inner], atol=2e-3)
    assert np.ptp(force[inner, 2]) > 0.1


def test_standing_still_the_floor_gives_the_weight() -> None:
    model = tiny_model()
    qpos = np.tile([0, 0, 1, 1, 0, 0, 0, 0.5], (11, 1))
    motion = Motion.from_qpos(model, np.arange(11) / 10, qpos)
    _, force = scene_of_motion(motion).channel("floor", "ground reaction")
    weight = -float(model.body_mass.sum()) * model.opt.gravity
    np.testing.assert_allclose(force, np.tile(weight, (len(force), 1)), atol=1e-9)


def test_a_body_without_a_free_root_makes_no_scene() -> None:
    model = mujoco.MjModel.from_xml_string(
        "<mujoco><worldbody><body><joint name='h'/><geom size='.1'/></body></worldbody></mujoco>"
    )
    motion = Motion.from_qpos(model, [0.0, 1.0], np.zeros((2, 1)))
    with pytest.raises(MotionError, match="free root"):
        scene_of_motion(motion)
    with pytest.raises(MotionError, match="above 0"):
        scene_of_motion(swinging(), force_rate=0)


def test_the_format_writes_every_kind_and_reads_scenes(tmp_path: Path) -> None:
    path = tmp_path / "any.gst"
    assert GST.write is not None
    for motion, lost in (
        (keyboard(), ()),
        (markers(), ()),
        (arm(), ("the hierarchy and its offsets",)),
    ):
        assert GST.write(motion, path) == lost
        assert GST.sniff(path.read_bytes()[:4096])
        content = GST.read(path)
        assert isinstance(content.motion, Scene)
        assert not content.warnings
    assert not GST.sniff(b"FORM\0\0\0\0AIFF")
    GST.write(keyboard(), path)
    assert_same(read_scene(path), keyboard())


def test_a_scene_goes_by_the_list_of_formats_and_no_other_format_takes_it(tmp_path: Path) -> None:
    formats.write(keyboard(), tmp_path / "keys.gst")
    formats.write(markers(), tmp_path / "walk.gst")
    content = formats.read(tmp_path / "keys.gst")
    assert isinstance(content.motion, Scene)
    assert_same(content.motion, keyboard())
    for ending in sorted({s for f in formats.formats() if f is not GST for s in f.suffixes}):
        with pytest.raises(EnpointeError):
            formats.write(keyboard(), tmp_path / f"keys{ending}")
    assert sorted(file.name for file in tmp_path.iterdir()) == ["keys.gst", "walk.gst"]


def test_the_format_refuses_with_the_files_name(tmp_path: Path) -> None:
    assert GST.write is not None
    nobody = MarkerMotion((), 100.0, np.zeros((2, 0, 3)))
    with pytest.raises(FormatError, match=r"any\.gst: unit 'markers' needs one channel"):
        GST.write(nobody, tmp_path / "any.gst")
    assert not list(tmp_path.iterdir())
