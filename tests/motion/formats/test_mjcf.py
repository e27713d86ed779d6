"""Motions as keyframes of MuJoCo."""

from __future__ import annotations

from pathlib import Path

import mujoco
import numpy as np
import pytest

from enpointe.errors import FormatError
from enpointe.motion import Motion
from enpointe.motion.formats.mjcf import read_keyframes, write_keyframes

BODY = """<mujoco><option timestep="0.002"/><worldbody>
  <body name="arm"><freejoint/><geom type="capsule" size=".05 .2"/>
    <body name="hand" pos="0 0 .3"><joint type="hinge" axis="0 1 0"/><geom size=".05"/></body>
  </body></worldbody>{}</mujoco>"""


def body() -> mujoco.MjModel:
    return mujoco.MjModel.from_xml_string(BODY.format(""))


@pytest.fixture
def swing() -> Motion:
    model = body()
    rng = np.random.default_rng(1)
    qpos = rng.normal(size=(6, model.nq))
    qpos[:, 3:7] /= np.linalg.norm(qpos[:, 3:7], axis=1, keepdims=True)
    return Motion.from_qpos(model, np.arange(6) * 0.01, qpos, name='a "b" & <c>')


def test_what_is_written_reads_back_the_same(swing: Motion, tmp_path: Path) -> None:
    lost = write_keyframes(swing, tmp_path / "keys.xml")
    assert any("accelerations" in line for line in lost)
    again = read_keyframes(tmp_path / "keys.xml", swing.model)
    for part in ("time", "qpos", "qvel"):
        np.testing.assert_array_equal(getattr(again, part), getattr(swing, part))
    assert again.name == swing.name


def test_mujoco_takes_what_is_written(swing: Motion, tmp_path: Path) -> None:
    """Included in the body's own file, each sample is a keyframe."""
    write_keyframes(swing, tmp_path / "keys.xml")
    whole = tmp_path / "whole.xml"
    whole.write_text(BODY.format('<include file="keys.xml"/>'))
    model = mujoco.MjModel.from_xml_path(str(whole))
    assert model.nkey == 6
    np.testing.assert_allclose(model.key_qpos, swing.qpos, atol=1e-12)
    np.testing.assert_allclose(model.key_qvel, swing.qvel, rtol=1e-12)
    np.testing.assert_allclose(model.key_time, swing.time, atol=1e-12)


def test_keyframes_without_velocities(swing: Motion, tmp_path: Path) -> None:
    path = tmp_path / "keys.xml"
    write_keyframes(swing, path)
    text = path.read_text()
    path.write_text(
        "".join(
            line.split(" qvel=")[0] + ("/>" if " qvel=" in line else "")
            for line in text.splitlines(keepends=True)
        )
    )
    again = read_keyframes(path, swing.model)
    np.testing.assert_allclose(again.qvel, swing.qvel, atol=1e-9)


@pytest.mark.parametrize(
    ("old", "new", "line"),
    [
        ('time="0.02"', 'time="soon"', 5),
        ('time="0.02"', 'time="nan"', 5),
        ("</keyframe>", "", 10),
        ('qpos="', 'qpos="1 ', 3),
        ("<mujoco", "<!DOCTYPE a [<!ENTITY b 'c'>]><mujoco", 1),
        ("<key ", "<clef ", 1),
    ],
)
def test_nonsense_is_refused_with_its_line(
    swing: Motion, tmp_path: Path, old: str, new: str, line: int
) -> None:
    path = tmp_path / "keys.xml"
    write_keyframes(swing, path)
    text = path.read_text()
    assert old in text
    path.write_text(text.replace(old, new))
    with pytest.raises(FormatError) as caught:
        read_keyframes(path, swing.model)
    assert caught.value.line == line


def test_keyframes_without_times_are_no_motion(swing: Motion, tmp_path: Path) -> None:
    path = tmp_path / "keys.xml"
    write_keyframes(swing, path)
    path.write_text(path.read_text().replace('time="', 'old="'))
    with pytest.raises(FormatError, match="increase"):
        read_keyframes(path, swing.model)
