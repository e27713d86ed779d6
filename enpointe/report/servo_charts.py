"""Charts of a movement before its servos: when each joint is near a limit, and how far beyond."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import LinearSegmentedColormap, TwoSlopeNorm
from matplotlib.figure import Figure
from numpy.typing import NDArray

from enpointe.feasibility import Feasibility
from enpointe.hardware.limits import JointLimit
from enpointe.report.chart import COM, GREY, INK, LEFT, mark_beats, quiet, to_svg

__all__ = ["limits_chart", "torque_speed_chart"]

Array = NDArray[np.float64]
_COLOURS = LinearSegmentedColormap.from_list("used", ["#fbf8f2", "#b9cfe0", "#f6c9b0", COM])
_MOST = 2.0
"""Share of a limit from which the colour is the strongest."""
_COLUMNS = 600
_ABREAST = 3
_TALLEST = 2.5
"""Of the stall torque: what is higher is cut off, or the servo itself could not be seen."""


@quiet
def limits_chart(found: Feasibility, name: str) -> str:
    """Joints over time, coloured by the share of their tightest limit that they use as written."""
    assessment = found.assessment
    time, used = assessment.demand.time, assessment.used()
    stretch = max(1, len(time) // _COLUMNS)
    starts = np.arange(0, len(time), stretch)
    strongest = np.maximum.reduceat(used, starts, axis=0)
    order = np.argsort(-strongest.max(axis=0), kind="stable")
    figure = Figure(figsize=(8.25, 1.1 + 0.2 * len(order)))
    axes = figure.subplots()
    image = axes.imshow(
        strongest[:, order].T,
        aspect="auto",
        interpolation="nearest",
        cmap=_COLOURS,
        norm=TwoSlopeNorm(1.0, 0.0, _MOST),
        extent=(float(time[0]), float(time[-1]), len(order) - 0.5, -0.5),
    )
    axes.set_yticks(range(len(order)), [assessment.limits[i].joint for i in order])
    axes.tick_params(axis="y", length=0)
    axes.set_xlabel("time as written, s")
    mark_beats(axes, found.motion.key_events)
    bar = figure.colorbar(image, ax=axes, pad=0.01, fraction=0.03)
    bar.set_ticks([0.0, 0.5, 1.0, 1.5, 2.0], labels=["0", "50 %", "limit", "150 %", "200 %"])
    return to_svg(figure, name, "How much of its tightest limit each joint uses over time")


@quiet
def torque_speed_chart(found: Feasibility, joints: Sequence[str], name: str) -> str:
    """What joints need beside what their servos have, as written and slowed."""
    assessment = found.assessment
    rows = -(-len(joints) // _ABREAST)
    figure = Figure(figsize=(8.25, 2.9 * rows))
    grid = figure.subplots(rows, _ABREAST, squeeze=False)
    for axes in grid.flat[len(joints) :]:
        axes.set_visible(False)
    for axes, joint in zip(grid.flat, joints, strict=False):
        place = assessment.demand.joints.index(joint)
        _draw_line(axes, assessment.limits[place])
        _draw_way(axes, found, place, 1.0, COM, "as written")
        scale = found.time_scale or assessment.servo_scale
        if scale is not None and scale > 1.0:
            _draw_way(axes, found, place, scale, LEFT, f"× {scale:.2f}")
        most = _TALLEST * assessment.limits[place].model.stall_torque
        low, high = axes.get_ylim()
        axes.set_ylim(max(low, -most), min(high, most))
        axes.set_title(joint)
        axes.set_xlabel("speed, °/s")
    for row in grid:
        row[0].set_ylabel("torque, N m")
    handles, labels = grid[0][0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside upper left", ncols=3)
    return to_svg(figure, name, "Torque over speed of the joints that limit, and the servos' lines")


def _draw_line(axes: Axes, limit: JointLimit) -> None:
    """All that the servo can do, a parallelogram of voltage cut by the limits of speed and current.

    Turning forwards, torque can be as much forwards as the line gives, and backwards more.
    """
    top = limit.greatest_speed
    speeds = np.linspace(-top, top, 41)
    model = limit.model
    stall = model.torque_constant * limit.greatest_current
    friction = np.sign(speeds) * model.friction
    forwards = np.array([limit.torque_left(abs(s)) if s > 0 else _braked(limit, s) for s in speeds])
    highest = np.minimum(forwards, stall - friction)
    lowest = -highest[::-1]
    axes.fill_between(
        np.degrees(speeds),
        lowest,
        highest,
        color=GREY,
        alpha=0.18,
        linewidth=0.0,
        label="the servo",
    )


def _braked(limit: JointLimit, speed: float) -> float:
    """Most torque forwards while it turns backwards: back-EMF and friction help."""
    model = limit.model
    current = (limit.usable_voltage - model.back_emf * speed) / model.resistance
    return model.torque_constant * current + model.friction


def _draw_way(
    axes: Axes, found: Feasibility, joint: int, scale: float, colour: str, label: str
) -> None:
    demand = found.assessment.demand
    torque = demand.static[:, joint] + demand.dynamic[:, joint] / scale**2
    speed = np.degrees(demand.velocity[:, joint]) / scale
    axes.plot(speed, torque, color=colour, linewidth=1.0, label=label)
    axes.axhline(0.0, color=INK, linewidth=0.4, zorder=0)
    axes.axvline(0.0, color=INK, linewidth=0.4, zorder=0)
