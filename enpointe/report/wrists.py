"""Distance and speed of the wrists, drawn as in Neagle 2005 figure 5.7."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from enpointe.motion import Effort, logistic
from enpointe.motion.effort import logistic_rate
from enpointe.motion.wrist import Profile
from enpointe.report.chart import GREY, INK, quiet, thinned, to_svg
from enpointe.report.movements import Movement

__all__ = ["MOVEMENTS_MAX", "Series", "wrist_chart"]

MOVEMENTS_MAX = 12
_COLUMNS = 3
_POINTS = 120
LineStyle = Literal["-"] | tuple[float, tuple[float, ...]]


@dataclass(frozen=True, slots=True)
class Series:
    """Profiles that are drawn alike.

    Attributes:
        label: What they are.
        colour: Of the line.
        line: Style of the line.
        width: Of the line, points.
        profiles: Of any movement.
        above: Height over other series.
    """

    label: str
    colour: str
    line: LineStyle
    width: float
    profiles: tuple[Profile, ...]
    above: int = 2


@quiet
def wrist_chart(
    ways: Sequence[Movement], series: Sequence[Series], effort: Effort, name: str
) -> str | None:
    """Share of the way and speed over share of the time, a column for each movement.

    Args:
        ways: The movements; at most `MOVEMENTS_MAX` are drawn.
        series: What to overlay.
        effort: Whose logistic is drawn as asked.
        name: Of the chart, unique on the page.

    Returns:
        An SVG element, or None where no wrist moves.
    """
    moving = [m for m in ways if any(m.of(s.profiles) for s in series)][:MOVEMENTS_MAX]
    if not moving:
        return None
    top = max(float(p.speed.max()) for m in moving for s in series for p in m.of(s.profiles))
    columns = min(_COLUMNS, len(moving))
    bands = -(-len(moving) // columns)
    figure = Figure(figsize=(2.75 * max(columns, 2), 0.45 + 3.9 * bands))
    grid = figure.subplots(2 * bands, columns, squeeze=False, sharex=True)
    for i, movement in enumerate(moving):
        band, column = divmod(i, columns)
        upper, lower = grid[2 * band, column], grid[2 * band + 1, column]
        _column(upper, lower, movement, series, effort, top)
        upper.set_title(f"{movement.title}\n", fontsize=8.8)
        upper.text(0.0, 1.03, movement.beats, transform=upper.transAxes, color=GREY, fontsize=7.8)
        if column == 0:
            upper.set_ylabel("share of the way")
            lower.set_ylabel(f"speed (1 is {top:.2f} m/s)")
        lower.set_xlabel("share of the time")
        lower.tick_params(labelbottom=True)
    for i in range(len(moving), bands * columns):
        band, column = divmod(i, columns)
        grid[2 * band, column].set_visible(False)
        grid[2 * band + 1, column].set_visible(False)
    handles = [
        Line2D([], [], color=s.colour, linestyle=s.line, linewidth=s.width, label=s.label)
        for s in series
    ]
    handles.append(Line2D([], [], color=INK, linestyle=":", linewidth=1.2, label="asked"))
    figure.legend(handles=handles, loc="outside upper left", ncols=len(handles))
    what = ", ".join(s.label for s in series)
    return to_svg(
        figure,
        name,
        f"Distance and speed of the wrists over each movement: {what}, and the logistic asked",
    )


def _column(
    upper: Axes,
    lower: Axes,
    movement: Movement,
    series: Sequence[Series],
    effort: Effort,
    top: float,
) -> None:
    for s in series:
        for profile in movement.of(s.profiles):
            for axes, values in ((upper, profile.distance), (lower, profile.speed / top)):
                axes.plot(
                    *thinned(profile.phase, values, _POINTS),
                    color=s.colour,
                    linestyle=s.line,
                    linewidth=s.width,
                    zorder=s.above,
                )
    profiles = [p for s in series for p in movement.of(s.profiles)]
    mean_speed = float(np.mean([p.length / p.seconds for p in profiles]))
    phase = np.linspace(0.0, 1.0, _POINTS)
    rate = logistic_rate(phase, effort.time, effort.weight) * mean_speed / top
    for axes, asked in ((upper, logistic(phase, effort.time, effort.weight)), (lower, rate)):
        axes.plot(phase, asked, color=INK, linestyle=":", linewidth=1.1, zorder=6)
    for axes in (upper, lower):
        axes.set_xlim(0.0, 1.0)
        axes.set_ylim(0.0, 1.06)
        axes.set_xticks([0.0, 0.5, 1.0], ["0", "½", "1"])
        axes.set_yticks([0.0, 0.5, 1.0], ["0", "½", "1"])
