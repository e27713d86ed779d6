"""The painters agree with the camera, with each other, and with what the machine can do."""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Callable, Iterator
from dataclasses import replace

import mujoco
import numpy as np
import pytest
from PIL import Image

from enpointe.errors import RenderError
from enpointe.sim import render
from enpointe.sim.camera import VIEWS, Overlays, Projection, View
from enpointe.sim.render import GLPainter, Painter, gl_backend, look_for_opengl, open_painter
from enpointe.sim.sketch import SketchPainter

WIDTH, HEIGHT = 200, 160
MARK = (0.3, 0.6, 1.4)
STAGE = f"""
<mujoco>
  <visual><headlight ambient=".6 .6 .6" diffuse=".3 .3 .3"/></visual>
  <worldbody>
    <geom type="plane" size="5 5 .1" rgba=".9 .9 .9 1"/>
    <body name="trunk" pos="0 0 1">
      <freejoint/>
      <geom type="capsule" fromto="0 0 -.6 0 0 .4" size=".1" rgba=".3 .3 .35 1"/>
      <geom type="box" size=".5 .5 .5" group="3" rgba="0 1 0 1"/>
      <geom type="sphere" size=".07" pos="{MARK[0]} {MARK[1]} {MARK[2] - 1.0}" rgba="0 .9 0 1"
            mass="0.01"/>
    </body>
  </worldbody>
</mujoco>
"""
TETRAHEDRON = "0 0 .3  .3 0 -.2  -.2 .25 -.2  -.2 -.25 -.2"
SHAPES = {
    "sphere": 'type="sphere" size=".3"',
    "ellipsoid": 'type="ellipsoid" size=".15 .25 .4"',
    "capsule": 'type="capsule" size=".12 .3"',
    "cylinder": 'type="cylinder" size=".2 .3"',
    "box": 'type="box" size=".15 .25 .35"',
    "mesh": 'type="mesh" mesh="solid"',
}


def stage() -> mujoco.MjModel:
    return mujoco.MjModel.from_xml_string(STAGE)


def gl_painter(model: mujoco.MjModel, width: int, height: int) -> Painter:
    if gl_backend() is None:
        pytest.skip("this machine has no OpenGL")
    return GLPainter(model, width, height)


PAINTERS = [pytest.param(gl_painter, id="gl"), pytest.param(SketchPainter, id="sketch")]
Maker = Callable[[mujoco.MjModel, int, int], Painter]


def green(picture: Image.Image, excess: int = 50) -> np.ndarray:
    """The mask (H, W) of what is greener than it is anything else."""
    pixels = np.asarray(picture).astype(int)
    mask: np.ndarray = pixels[..., 1] > pixels[..., [0, 2]].max(axis=2) + excess
    return mask


def centre(mask: np.ndarray) -> np.ndarray:
    rows, columns = np.nonzero(mask)
    assert len(rows) > 0, "nothing green in the picture"
    return np.array([columns.mean() + 0.5, rows.mean() + 0.5])


@pytest.fixture
def fresh_probe(monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    gl_backend()
    monkeypatch.setenv("MUJOCO_GL", "")
    forget()
    yield
    monkeypatch.undo()
    forget()


def forget() -> None:
    render._find_backend.cache_clear()
    render._search.cache_clear()


@pytest.mark.parametrize("maker", PAINTERS)
@pytest.mark.parametrize("name", VIEWS)
def test_a_marker_lands_where_the_camera_says(maker: Maker, name: str) -> None:
    model, view = stage(), View.named(name)
    with maker(model, WIDTH, HEIGHT) as painter:
        picture = painter.paint(model.qpos0, camera=view)
    expected = Projection(view, WIDTH, HEIGHT).pixels(MARK)
    assert picture.size == painter.size == (WIDTH, HEIGHT)
    assert np.abs(centre(green(picture)) - expected).max() < 2.0


@pytest.mark.parametrize("maker", PAINTERS)
def test_nothing_is_mirrored(maker: Maker) -> None:
    """The marker is at the dancer's left hand: high, to her left, and a little to the front."""
    model = stage()
    with maker(model, WIDTH, HEIGHT) as painter:
        seen = {
            name: centre(green(painter.paint(model.qpos0, camera=View.named(name))))
            for name in VIEWS
        }
    assert seen["audience"][0] > WIDTH / 2 + 10, "her left is on the audience's right"
    assert seen["audience"][1] < HEIGHT / 2 - 10, "up is up"
    assert seen["wings"][0] > WIDTH / 2 + 5, "the audience is on the picture's right"
    assert seen["above"][0] > WIDTH / 2 + 10
    assert seen["above"][1] > HEIGHT / 2 + 5, "the audience is at the bottom"


@pytest.mark.parametrize("maker", PAINTERS)
def test_collision_geoms_are_hidden(maker: Maker) -> None:
    model = stage()
    with maker(model, WIDTH, HEIGHT) as painter:
        area = green(painter.paint(model.qpos0, camera=View.audience())).sum()
    assert 0 < area < 300


@pytest.mark.parametrize("maker", PAINTERS)
def test_following_keeps_a_travelling_dancer_in_place_but_shows_the_jump(maker: Maker) -> None:
    model, view = stage(), View.audience().following()
    far, high = model.qpos0.copy(), model.qpos0.copy()
    far[:2] += [-3.0, 2.0]
    high[2] += 0.3
    with maker(model, WIDTH, HEIGHT) as painter:
        home, away, up = (
            centre(green(painter.paint(qpos, camera=view))) for qpos in (model.qpos0, far, high)
        )
    assert np.abs(home - away).max() < 1.5
    assert up[1] < home[1] - 5


@pytest.mark.parametrize("maker", PAINTERS)
def test_overlays_are_drawn(maker: Maker) -> None:
    model = stage()
    corners = np.array([[0.9, -0.8], [0.9, 0.8], [0.6, 0.8], [0.6, -0.8]])
    view = replace(View.three_quarter(), distance=2.8, lookat=(0.0, 0.0, 0.4))
    push = Overlays(force_points=np.array([[0.0, -0.5, 0.3]]), forces=np.array([[0.0, 0.0, 900.0]]))
    with maker(model, WIDTH, HEIGHT) as painter:
        plain, dot, outline, arrow = (
            np.asarray(painter.paint(model.qpos0, camera=view, overlays=marks))
            for marks in (None, Overlays(com=True), Overlays(support=corners), push)
        )
    for marked in (dot, outline, arrow):
        assert (marked != plain).any(axis=2).sum() > 8


@pytest.mark.parametrize("maker", PAINTERS)
def test_a_closed_painter_and_a_wrong_pose_are_errors(maker: Maker) -> None:
    model = stage()
    painter = maker(model, 32, 32)
    with pytest.raises(RenderError, match=r"\(7,\), not \(3,\)"):
        painter.paint(np.zeros(3), camera=View())
    with pytest.raises(RenderError, match="finite"):
        painter.paint(np.full(7, np.nan), camera=View())
    painter.close()
    painter.close()
    with pytest.raises(RenderError, match="closed"):
        painter.paint(model.qpos0, camera=View())


@pytest.mark.parametrize("shape", SHAPES)
def test_the_sketch_has_the_outline_that_opengl_draws(shape: str) -> None:
    model = mujoco.MjModel.from_xml_string(
        f'<mujoco><visual><headlight ambient=".8 .8 .8" diffuse=".2 .2 .2"/></visual>'
        f'<asset><mesh name="solid" vertex="{TETRAHEDRON}"/></asset>'
        f'<worldbody><body pos="0 0 1"><freejoint/>'
        f'<geom {SHAPES[shape]} rgba="0 .9 0 1"/></body></worldbody></mujoco>'
    )
    view = replace(View.three_quarter(), distance=2.0)
    rng = np.random.default_rng(7)
    with (
        gl_painter(model, WIDTH, HEIGHT) as exact,
        SketchPainter(model, WIDTH, HEIGHT) as sketch,
    ):
        for _ in range(4):
            qpos = np.concatenate([[0.0, 0.1, 1.0], rng.normal(size=4)])
            one, other = (
                green(painter.paint(qpos, camera=view), 20) for painter in (exact, sketch)
            )
            # The inked rim is not green: allow for a pixel of it all around.
            assert (one & other).sum() > 0.85 * (one | other).sum()


def test_opengl_paints_larger_than_the_model_was_compiled_for_and_leaves_it_alone() -> None:
    model = stage()
    with gl_painter(model, 1000, 600) as painter:
        assert painter.paint(model.qpos0, camera=View(fovy=20.0)).size == (1000, 600)
    assert model.vis.global_.offwidth == 640
    assert model.vis.global_.fovy == 45.0


def test_fine_quality_adds_shadows() -> None:
    model = mujoco.MjModel.from_xml_string(
        STAGE.replace("<worldbody>", '<worldbody><light pos="1 1 4" dir="-.2 -.2 -1"/>')
    )
    gl_painter(model, 32, 32).close()
    with GLPainter(model, WIDTH, HEIGHT) as fast:
        plain = fast.paint(model.qpos0, camera=View.three_quarter())
    with GLPainter(model, WIDTH, HEIGHT, quality="fine") as fine:
        shaded = fine.paint(model.qpos0, camera=View.three_quarter())
    lower = slice(HEIGHT // 2, None)
    assert np.asarray(shaded)[lower].mean() < np.asarray(plain)[lower].mean()


@pytest.mark.usefixtures("fresh_probe")
def test_without_opengl_a_sketch_is_opened_and_one_line_says_what_to_install(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(render, "_draws", lambda backend: False)
    monkeypatch.setattr(sys, "platform", "linux")
    painter, warning = open_painter(stage(), 32, 32)
    assert isinstance(painter, SketchPainter)
    assert warning == (
        "no OpenGL: apt install libegl1 libgl1-mesa-dri (or libosmesa6); using the sketch renderer"
    )
    assert os.environ["MUJOCO_GL"] == "off"
    with pytest.raises(RenderError, match="no OpenGL"):
        GLPainter(stage(), 32, 32)


def noting_refusal(tried: list[str]) -> Callable[[str], bool]:
    """A stand-in for a backend's trial, that says which was tried and that it draws nothing."""

    def draws(backend: str) -> bool:
        tried.append(backend)
        return False

    return draws


@pytest.mark.usefixtures("fresh_probe")
def test_the_users_choice_is_the_only_one_tried(monkeypatch: pytest.MonkeyPatch) -> None:
    tried: list[str] = []
    monkeypatch.setattr(render, "_draws", noting_refusal(tried))
    monkeypatch.setenv("MUJOCO_GL", "OSMesa")
    assert gl_backend() is None
    assert gl_backend() is None
    assert tried == ["osmesa"]


@pytest.mark.usefixtures("fresh_probe")
def test_what_was_looked_for_ahead_is_not_looked_for_again(monkeypatch: pytest.MonkeyPatch) -> None:
    tried: list[str] = []
    monkeypatch.setattr(render, "_draws", noting_refusal(tried))
    monkeypatch.setenv("MUJOCO_GL", "egl")
    look_for_opengl()
    look_for_opengl()
    assert gl_backend() is None
    assert tried == ["egl"]


@pytest.mark.usefixtures("fresh_probe")
def test_opengl_switched_off_is_not_probed(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("MUJOCO_GL", "off")
    monkeypatch.setattr(render, "_draws", lambda backend: pytest.fail("probed"))
    look_for_opengl()
    painter, warning = open_painter(stage(), 32, 32)
    assert isinstance(painter, SketchPainter)
    assert warning is not None
    assert "MUJOCO_GL=off" in warning


def test_a_backend_that_cannot_load_is_found_out_in_a_real_process() -> None:
    """OSMesa told to use EGL's loader can't be imported, with the library or without it."""
    script = (
        "from enpointe.sim.render import open_painter\n"
        "import mujoco\n"
        "model = mujoco.MjModel.from_xml_string('<mujoco/>')\n"
        "painter, warning = open_painter(model, 16, 16)\n"
        "print(type(painter).__name__, '|', warning)\n"
    )
    done = subprocess.run(
        [sys.executable, "-P", "-c", script],
        env={**os.environ, "MUJOCO_GL": "osmesa", "PYOPENGL_PLATFORM": "egl"},
        capture_output=True,
        text=True,
        timeout=120,
        check=True,
    )
    assert done.stdout.startswith("SketchPainter | no OpenGL")
    assert done.stderr == ""


def test_an_unclosed_painter_is_silent_at_exit() -> None:
    if gl_backend() is None:
        pytest.skip("this machine has no OpenGL")
    script = (
        "from enpointe.sim.render import View, open_painter\n"
        "import mujoco\n"
        "model = mujoco.MjModel.from_xml_string('<mujoco/>')\n"
        "painter, warning = open_painter(model, 16, 16)\n"
        "painter.paint([], camera=View())\n"
    )
    done = subprocess.run(
        [sys.executable, "-P", "-c", script],
        capture_output=True,
        text=True,
        timeout=120,
        check=False,
    )
    assert (done.returncode, done.stdout, done.stderr) == (0, "", "")


@pytest.mark.parametrize("size", [(0, 100), (100, -1), (100_000, 100)])
def test_impossible_sizes_are_errors(size: tuple[int, int]) -> None:
    with pytest.raises(RenderError, match="pixels"):
        open_painter(stage(), *size)
