"""Parts of a report on their own: series thinned, movements grouped, charts drawn, views fitted."""

from __future__ import annotations

import re
from xml.etree import ElementTree

import matplotlib
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from matplotlib.figure import Figure

from enpointe.motion import Effort
from enpointe.motion.wrist import Profile
from enpointe.notation import Side
from enpointe.performing import Performance
from enpointe.report.chart import quiet, thinned, to_svg
from enpointe.report.movements import Movement, danced_tempo, movements
from enpointe.report.pictures import ASPECT, fitted_view
from enpointe.report.wrists import MOVEMENTS_MAX, Series, wrist_chart
from enpointe.sim.camera import Projection, View


@given(st.lists(st.floats(-1e6, 1e6), min_size=1, max_size=400), st.integers(10, 60))
def test_a_thinned_series_keeps_its_ends_and_extremes(values: list[float], points: int) -> None:
    series = np.array(values)
    time, kept = thinned(np.arange(len(series), dtype=float) * 0.1, series, points)
    assert len(kept) <= max(points + 4, 4)
    assert (kept.min(), kept.max()) == (series.min(), series.max())
    assert (time[0], time[-1]) == (0.0, 0.1 * (len(series) - 1))
    assert np.all(np.diff(time) > 0)


def test_a_thinned_series_keeps_its_gaps() -> None:
    series = np.ones(1000)
    series[400:600] = np.nan
    time, kept = thinned(np.arange(1000.0), series, 50)
    assert np.isnan(kept[(time > 410) & (time < 590)]).all()
    assert np.isfinite(kept[(time < 390) | (time > 610)]).all()


@quiet
def _drawing(name: str, description: str = "a line") -> str:
    figure = Figure(figsize=(3, 2))
    axes = figure.subplots()
    axes.plot([0, 1], [0, 1])
    axes.set_title("costs $5 and $6")
    return to_svg(figure, name, description)


def test_two_charts_share_no_id() -> None:
    first, second = _drawing("one"), _drawing("two")
    ids = [set(re.findall(r'\bid="([^"]+)"', svg)) for svg in (first, second)]
    assert ids[0]
    assert not ids[0] & ids[1]


def test_a_chart_is_the_same_every_time_whatever_matplotlib_is_set_to() -> None:
    first = _drawing("one")
    with matplotlib.rc_context({"axes.facecolor": "black", "font.size": 30, "svg.hashsalt": "x"}):
        assert _drawing("one") == first
        assert matplotlib.rcParams["font.size"] == 30


def test_a_description_cannot_leave_its_attribute() -> None:
    root = ElementTree.fromstring(_drawing("one", '"><script>'))
    assert root.attrib["aria-label"] == '"><script>'


def test_movements_and_tempo_of_a_dance(physical: Performance) -> None:
    [way] = movements(physical.choreography)
    assert way.title == "fifth en bas to à la seconde"
    assert way.starts == (physical.choreography.key_poses[0].name,)
    assert danced_tempo(physical.danced, physical.choreography) is None


def _profile(start: str) -> Profile:
    phase = np.linspace(0.0, 1.0, 20)
    return Profile(Side.LEFT, start, "next", phase, phase, np.ones(20), 0.5, 1.0)


@pytest.mark.parametrize("count", [1, 4, MOVEMENTS_MAX + 3])
def test_wrists_are_drawn_for_any_number_of_movements(count: int) -> None:
    ways = [Movement(f"way {i}", f"beats {i}", (f"beat {i}",)) for i in range(count)]
    series = Series("left", "#000000", "-", 1.0, tuple(_profile(f"beat {i}") for i in range(count)))
    svg = wrist_chart(ways, [series], Effort(-3.0, 0.5, 1.0), "wrists")
    assert svg is not None
    ElementTree.fromstring(svg)


def test_wrists_that_do_not_move_are_not_drawn() -> None:
    way = Movement("a wait", "beats 0–1", ("beat 0",))
    series = Series("left", "#000000", "-", 1.0, ())
    assert wrist_chart([way], [series], Effort(-3.0, 0.5, 1.0), "wrists") is None


def test_who_travels_is_no_smaller_for_it(physical: Performance) -> None:
    """Key poses are shown where they are danced, with the camera beside them."""
    import mujoco

    model = physical.motion.model
    near = [pose.qpos for pose in physical.choreography.key_poses]
    far = [qpos.copy() for qpos in near]
    far[-1][:2] += [-3.0, 4.0]
    here, there = (fitted_view(model, poses, View(), follow=True) for poses in (near, far))
    assert there.distance == pytest.approx(here.distance)
    assert fitted_view(model, far, View()).distance > 1.5 * here.distance
    data = mujoco.MjData(model)
    for qpos in far:
        data.qpos[:] = qpos
        mujoco.mj_kinematics(model, data)
        mujoco.mj_comPos(model, data)
        aimed = there.aimed(data.subtree_com[0])
        seen = Projection(aimed, 400, 500).pixels(data.xpos[1:])
        assert np.all((seen > 0) & (seen < [400, 500]))


def test_the_dancer_is_in_the_picture_in_every_pose(physical: Performance) -> None:
    model = physical.motion.model
    poses = [pose.qpos for pose in physical.choreography.key_poses]
    view = fitted_view(model, poses, View(elevation=-9.0))
    import mujoco

    data = mujoco.MjData(model)
    width, height = 400, 500
    assert width / height == ASPECT
    for qpos in poses:
        data.qpos[:] = qpos
        mujoco.mj_kinematics(model, data)
        seen = Projection(view, width, height).pixels(data.xpos[1:])
        assert np.all((seen > 0) & (seen < [width, height]))
