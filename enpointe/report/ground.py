"""Balance, drawn: the support from above, and the margins over time."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import mujoco
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray

from enpointe.controllers import Recording
from enpointe.models.foot_positions import support_hull
from enpointe.report.chart import (
    COM,
    GREY,
    INK,
    LEFT,
    PALE,
    RIGHT,
    apart,
    mark_beats,
    quiet,
    thinned,
    to_svg,
)
from enpointe.sim import balance
from enpointe.sim.measures import Measures

__all__ = ["margin_chart", "support_at", "support_chart"]

Array = NDArray[np.float64]
_FLESH_HEIGHT = 0.03
"""Flesh of a foot below this height outlines its sole, m."""
_STEP = 0.01
"""A foot that has moved this far stands somewhere else, m."""
_PLACES_MAX = 8
_SIDES = (("left", LEFT), ("right", RIGHT))


def support_at(recording: Recording, sample: int) -> Array:
    """Support polygon of one sample, (H, 2), m."""
    channels = recording.channels
    points = np.asarray(channels["sole_point"][sample], dtype=float)
    forces = np.asarray(channels["sole_force"][sample], dtype=float)
    return balance.support(points, forces)


@quiet
def support_chart(recording: Recording, measures: Measures, name: str) -> str:
    """The feet from above with the audience at the bottom, and the path of the CoM larger."""
    figure = Figure(figsize=(8.25, 3.7))
    feet, close = figure.subplots(1, 2, width_ratios=(1.25, 1.0))
    places = _places(recording)
    for sample in places:
        _draw_support(feet, support_at(recording, sample))
    for order, sample in enumerate(places):
        _draw_soles(feet, recording, sample, labels=order == 0)
    path = 100.0 * measures.com[:, [1, 0]]
    pressure = 100.0 * measures.cop[:, [1, 0]]
    feet.plot(pressure[::5, 0], pressure[::5, 1], color=GREY, linewidth=0.6)
    feet.plot(path[::5, 0], path[::5, 1], color=COM, linewidth=1.6, zorder=4)
    feet.plot(path[0, 0], path[0, 1], "o", color=COM, markersize=4, zorder=4)
    feet.set_xlabel("cm to the dancer's left")
    feet.set_ylabel("cm to the audience")
    feet.set_title("the soles from above")
    feet.margins(0.12)
    feet.text(0.5, 0.01, "audience", transform=feet.transAxes, ha="center", va="bottom", color=GREY)
    _draw_close(close, recording, 10.0 * path)
    for axes in (feet, close):
        axes.set_aspect("equal", adjustable="datalim")
        axes.invert_yaxis()
    return to_svg(
        figure, name, "Path of the centre of mass over the soles and the support, from above"
    )


def _draw_close(axes: Axes, recording: Recording, com: Array) -> None:
    """The path in mm about where the CoM is on the average."""
    com = com - com.mean(axis=0)
    axes.plot(com[::5, 0], com[::5, 1], color=COM, linewidth=1.2)
    marked: list[Array] = []
    reach = float(np.ptp(com, axis=0).max()) or 1.0
    for event in recording.reference.key_events:
        if event.time > recording.time[-1] or event.beat is None:
            continue
        place = com[int(np.searchsorted(recording.time, event.time))]
        if any(np.linalg.norm(place - other) < 0.06 * reach for other in marked):
            continue
        marked.append(place)
        axes.plot(place[0], place[1], "o", color=COM, markersize=3.5)
        axes.annotate(
            f"{event.beat:g}",
            (float(place[0]), float(place[1])),
            (4, 4),
            textcoords="offset points",
            fontsize=8.5,
            color=INK,
        )
    axes.margins(0.12)
    axes.set_title("the centre of mass, with the beats")
    axes.set_xlabel("mm about its mean, to the dancer's left")
    axes.set_ylabel("mm to the audience")


def _places(recording: Recording) -> list[int]:
    """Samples at which a foot stands where none of the samples before had it."""
    points = np.asarray(recording.channels["sole_point"], dtype=float)
    samples = [min(1, len(points) - 1)]
    for event in recording.reference.key_events:
        sample = int(np.searchsorted(recording.time, event.time))
        if sample >= len(points) or len(samples) == _PLACES_MAX:
            continue
        moved = [np.abs(points[sample, :, :2] - points[s, :, :2]).max() for s in samples]
        if min(moved) > _STEP:
            samples.append(sample)
    return samples


def _draw_support(axes: Axes, hull: Array) -> None:
    if len(hull) > 2:
        axes.fill(100 * hull[:, 1], 100 * hull[:, 0], facecolor=PALE, alpha=0.45, edgecolor="none")
        ring = np.vstack([hull, hull[:1]])
        axes.plot(100 * ring[:, 1], 100 * ring[:, 0], color=GREY, linewidth=0.8, linestyle="--")


def _draw_soles(axes: Axes, recording: Recording, sample: int, *, labels: bool) -> None:
    data = mujoco.MjData(recording.model)
    data.qpos[:] = recording.qpos[sample]
    mujoco.mj_kinematics(recording.model, data)
    for side, colour in _SIDES:
        outline = 100.0 * _sole(recording.model, data, side)
        if len(outline) < 3:
            continue
        axes.fill(outline[:, 1], outline[:, 0], facecolor=colour, alpha=0.22, edgecolor="none")
        ring = np.vstack([outline, outline[:1]])
        axes.plot(ring[:, 1], ring[:, 0], color=colour, linewidth=1.2)
        if labels:
            middle = (outline.min(axis=0) + outline.max(axis=0)) / 2.0
            axes.text(
                middle[1], middle[0], side, ha="center", va="center", color=colour, weight="bold"
            )


def _sole(model: mujoco.MjModel, data: mujoco.MjData, side: str) -> Array:
    """Outline of the flesh near the floor of a foot and its toes, (H, 2), m."""
    cloud = [np.empty((0, 3))]
    for part in ("foot", "toe"):
        name = f"{side}_{part}_flesh"
        geom = mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_GEOM, name)
        mesh = int(model.geom_dataid[geom]) if geom >= 0 else -1
        if mesh < 0:
            continue
        first = int(model.mesh_vertadr[mesh])
        vertices = model.mesh_vert[first : first + int(model.mesh_vertnum[mesh])]
        cloud.append(vertices @ data.geom_xmat[geom].reshape(3, 3).T + data.geom_xpos[geom])
    points = np.concatenate(cloud)
    return support_hull(points[points[:, 2] < _FLESH_HEIGHT, :2])


_DEPTH = 3.0
"""How many times as far below the edge as above it is drawn; who is farther out has fallen."""


@quiet
def margin_chart(recording: Recording, measures: Measures, name: str) -> str:
    """How far inside the support the centre of mass is, and where it is heading, over time."""
    figure = Figure(figsize=(8.25, 2.6))
    axes = figure.subplots()
    margin, heading = (
        np.where(np.isfinite(m), 1000.0 * m, np.nan)
        for m in (measures.margin, measures.capture_margin)
    )
    mark_beats(axes, recording.as_motion().key_events)
    lines = (("extrapolated", heading, GREY, 0.9), ("centre of mass", margin, COM, 1.4))
    for _, values, colour, width in lines:
        axes.plot(*thinned(recording.time, values), color=colour, linewidth=width)
    axes.axhline(0.0, color=INK, linewidth=1.0)
    if np.any(np.isfinite(margin)):
        highest = max(1.15 * float(max(np.nanmax(margin), np.nanmax(heading))), 10.0)
        lowest = 1.15 * float(min(np.nanmin(margin), np.nanmin(heading), 0.0))
        axes.set_ylim(max(lowest, -_DEPTH * highest), highest)
        _mark_least(axes, recording.time, margin)
        for text, height, colour in _ends(axes, lines):
            place = (float(recording.time[-1]), height)
            axes.annotate(
                text, place, (4, 0), textcoords="offset points", va="center", color=colour
            )
    axes.set_xlim(0.0, float(recording.time[-1]))
    at_edge = axes.get_yaxis_transform()
    axes.text(0.006, 0.0, "edge of the support", transform=at_edge, va="bottom", color=GREY)
    axes.set_xlabel("time, s")
    axes.set_ylabel("inside the support, mm")
    return to_svg(figure, name, "Margins of balance over time")


def _ends(
    axes: Axes, lines: Sequence[tuple[str, Array, str, float]]
) -> Iterator[tuple[str, float, str]]:
    """Name, height and colour of the label at the end of each line."""
    low, high = axes.get_ylim()
    shown = [values[np.isfinite(values)] for _, values, _, _ in lines]
    last = [float(np.clip(values[-1], low, high)) if len(values) else low for values in shown]
    heights = apart(last, 0.13 * (high - low))
    for (text, _, colour, _), height in zip(lines, heights, strict=True):
        yield text, height, colour


def _mark_least(axes: Axes, time: Array, margin: Array) -> None:
    low = int(np.nanargmin(margin))
    place = (float(time[low]), max(float(margin[low]), axes.get_ylim()[0]))
    late = place[0] > 0.8 * float(time[-1])
    axes.plot(*place, "o", color=COM, markersize=4, clip_on=False)
    axes.annotate(
        f"least {margin[low]:.0f} mm".replace("-", "−"),
        place,
        (-6, 6) if late else (5, -11 if margin[low] > 0.0 else 2),
        textcoords="offset points",
        ha="right" if late else "left",
        color=COM,
    )
