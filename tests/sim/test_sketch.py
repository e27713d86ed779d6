"""The sketch painter never fails on a finite pose and puts in front what is in front."""

from __future__ import annotations

from typing import Any

import mujoco
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from enpointe.errors import RenderError
from enpointe.sim.camera import VIEWS, Overlays, Projection, View
from enpointe.sim.sketch import SketchPainter

HUMANOID = """
<mujoco>
  <asset>
    <material name="cloth" rgba=".6 .2 .3 1"/>
    <mesh name="foot" vertex="-.06 .03 0 -.06 -.03 0 .18 .03 0 .18 -.03 0 0 .02 .07 0 -.02 .07"/>
  </asset>
  <worldbody>
    <geom type="plane" size="4 4 .1"/>
    <body pos="0 0 1">
      <freejoint/>
      <geom type="ellipsoid" size=".1 .16 .3" pos="0 0 .2" material="cloth"/>
      <body pos="0 0 .6">
        <joint type="ball"/>
        <geom type="sphere" size=".11" pos="0 0 .1" rgba=".9 .7 .6 1"/>
      </body>
      <body pos="0 .2 .4">
        <joint type="ball"/>
        <geom type="capsule" fromto="0 0 0 0 .5 0" size=".04"/>
        <geom type="cylinder" size=".05 .03" pos="0 .55 0"/>
      </body>
      <body pos="0 -.1 -.1">
        <joint type="hinge" axis="0 1 0"/>
        <geom type="capsule" fromto="0 0 0 0 0 -.7" size=".06"/>
        <geom type="mesh" mesh="foot" pos="0 0 -.85"/>
        <geom type="box" size=".02 .02 .02" pos="0 .1 0"/>
      </body>
    </body>
  </worldbody>
</mujoco>
"""
MODEL = mujoco.MjModel.from_xml_string(HUMANOID)
PAINTER = SketchPainter(MODEL, 64, 48)
ANY = st.floats(allow_nan=False, allow_infinity=False)
NEAR = st.floats(-4.0, 4.0)
POSES = st.lists(ANY | NEAR, min_size=MODEL.nq, max_size=MODEL.nq)
VIEWPOINTS = st.builds(
    View,
    azimuth=st.floats(-360.0, 360.0),
    elevation=st.floats(-90.0, 90.0),
    distance=st.floats(0.01, 20.0),
    lookat=st.tuples(NEAR, NEAR, NEAR),
    fovy=st.floats(5.0, 150.0),
    follow=st.booleans(),
)


@settings(deadline=None, max_examples=60)
@given(qpos=POSES, view=VIEWPOINTS)
def test_any_finite_pose_is_painted(qpos: list[float], view: View) -> None:
    marks = Overlays(com=True, support=np.array([[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]]))
    assert PAINTER.paint(qpos, camera=view, overlays=marks).size == (64, 48)


@settings(deadline=None, max_examples=30)
@given(points=st.lists(st.tuples(NEAR, NEAR, NEAR), min_size=1, max_size=8), view=VIEWPOINTS)
def test_a_fitted_view_shows_every_point(
    points: list[tuple[float, float, float]], view: View
) -> None:
    fitted = view.fitted(points, aspect=1.5)
    projection = Projection(fitted, 300, 200)
    assert (projection.to_camera(points)[:, 2] > 0.0).all()
    pixels = projection.pixels(points)
    assert ((pixels > -1e-6) & (pixels < np.array([300.0, 200.0]) + 1e-6)).all()


def test_a_pose_is_painted_the_same_every_time() -> None:
    first, _, again = (
        np.asarray(PAINTER.paint(MODEL.qpos0, camera=View.named(name)))
        for name in ("audience", "above", "audience")
    )
    np.testing.assert_array_equal(first, again)


@pytest.mark.parametrize("name", VIEWS)
def test_the_dancer_is_in_the_picture(name: str) -> None:
    empty = SketchPainter(mujoco.MjModel.from_xml_string("<mujoco/>"), 96, 96)
    picture = np.asarray(
        SketchPainter(MODEL, 96, 96).paint(MODEL.qpos0, camera=View.named(name))
    ).astype(int)
    bare = np.asarray(empty.paint([], camera=View.named(name))).astype(int)
    changed = (np.abs(picture - bare) > 60).any(axis=2)
    assert 0.01 < changed.mean() < 0.5


@pytest.mark.parametrize("kind", ["sphere", "ellipsoid", "capsule", "cylinder", "box"])
def test_the_nearer_of_two_hides_the_other(kind: str) -> None:
    model = mujoco.MjModel.from_xml_string(
        f'<mujoco><worldbody><geom type="{kind}" size=".2 .2 .2" pos="1 0 1" rgba="1 0 0 1"/>'
        f'<geom type="{kind}" size=".2 .2 .2" pos="-1 0 1" rgba="0 0 1 1"/></worldbody></mujoco>'
    )
    painter = SketchPainter(model, 64, 64)
    for azimuth, nearer, farther in ((180.0, 0, 2), (0.0, 2, 0)):
        picture = painter.paint([], camera=View(azimuth=azimuth, elevation=0.0))
        pixel = picture.getpixel((32, 32))
        assert isinstance(pixel, tuple)
        assert pixel[nearer] > pixel[farther] + 60


@pytest.mark.parametrize(
    ("kind", "area"),
    [
        ('type="sphere" size=".004"', np.pi * 4.0**2),
        ('type="ellipsoid" size=".004 .008 .003"', np.pi * 8.0 * 3.0),
        ('type="capsule" size=".003 .005"', np.pi * 3.0**2 + 6.0 * 10.0),
        ('type="box" size=".004 .003 .005"', 6.0 * 10.0),
    ],
)
def test_what_is_small_and_far_keeps_its_shape(kind: str, area: float) -> None:
    """Millimetres, from six metres through a long lens."""
    model = mujoco.MjModel.from_xml_string(
        f'<mujoco><worldbody><geom {kind} pos="0 0 1" rgba="0 .9 0 1"/></worldbody></mujoco>'
    )
    view = View(elevation=0.0, distance=6.0, fovy=0.25)
    pixels = np.asarray(SketchPainter(model, 128, 128).paint([], camera=view)).astype(int)
    millimetre = Projection(view, 128, 128).focal * 1.0e-3 / 6.0
    drawn = (pixels[..., 2] < 140).sum() / millimetre**2
    assert drawn == pytest.approx(area, rel=0.06)


def test_the_shadow_under_a_jump_is_fainter() -> None:
    view = View(azimuth=180.0, elevation=-30.0, lookat=(0.0, 0.0, 0.3), distance=6.0)
    high = MODEL.qpos0.copy()
    high[2] += 0.8
    painter = SketchPainter(MODEL, 120, 120)
    x, y = Projection(view, 120, 120).pixels([0.25, 0.0, 0.0])
    near, far = (
        np.asarray(painter.paint(qpos, camera=view))[int(y), int(x)].astype(int).sum()
        for qpos in (MODEL.qpos0, high)
    )
    assert near < far


@pytest.mark.parametrize(
    ("support", "points", "forces"),
    [
        (np.zeros((3, 4)), None, None),
        (None, np.zeros((2, 3)), np.zeros((1, 3))),
    ],
)
def test_overlays_of_the_wrong_shape_are_errors(
    support: np.ndarray | None, points: np.ndarray | None, forces: np.ndarray | None
) -> None:
    marks = Overlays(support=support, force_points=points, forces=forces)
    with pytest.raises(RenderError, match=r"\(N, 2\)|\(K, 3\)"):
        PAINTER.paint(MODEL.qpos0, camera=View(), overlays=marks)


def test_a_view_that_makes_no_picture_is_an_error() -> None:
    impossible: tuple[dict[str, Any], ...]
    impossible = ({"distance": 0.0}, {"fovy": 180.0}, {"azimuth": float("nan")})
    for wrong in impossible:
        with pytest.raises(RenderError):
            View(**wrong)
    with pytest.raises(RenderError, match="audience, wings"):
        View.named("balcony")
