"""The floor, drawn: the force under each foot over time, and what each foot stands on."""

from __future__ import annotations

import itertools

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray

from enpointe.controllers import Recording
from enpointe.report.bars import STRENGTH, Bar, draw_bar, label_rows
from enpointe.report.chart import (
    GREY,
    INK,
    LEFT,
    RIGHT,
    apart,
    mark_beats,
    quiet,
    thinned,
    to_svg,
)
from enpointe.sim.feet import FootState, foot_states
from enpointe.sim.measures import Measures

__all__ = ["force_chart"]

Array = NDArray[np.float64]
_LETTER = 0.01375
"""Room that a letter of a bar's name needs, as a share of the dance."""


@quiet
def force_chart(recording: Recording, measures: Measures, name: str) -> str:
    """Vertical force under each foot over time with the body's weight, and the feet below it."""
    figure = Figure(figsize=(8.25, 3.3))
    axes, strip = figure.subplots(2, 1, sharex=True, height_ratios=(4.2, 1.0))
    model = recording.model
    weight = float(model.body_mass.sum() * -model.opt.gravity[2])
    mark_beats(axes, recording.as_motion().key_events)
    total = measures.foot_force.sum(axis=1)
    end = float(recording.time[-1])
    lines = [
        ("left foot", measures.foot_force[:, 0], LEFT, "-"),
        ("right foot", measures.foot_force[:, 1], RIGHT, "-"),
        ("both", total, INK, "-"),
    ]
    for _, force, colour, style in lines:
        axes.plot(*thinned(recording.time, force), color=colour, linestyle=style, linewidth=1.1)
    axes.axhline(weight, color=GREY, linewidth=0.8, linestyle="--")
    axes.text(
        0.008 * end,
        0.94 * weight,
        f"body weight {weight:.0f} N",
        va="top",
        color=GREY,
        fontsize=8,
    )
    tail = slice(-max(len(total) // 20, 1), None)
    highest = 1.12 * max(weight, float(np.percentile(total, 99.9)))
    heights = apart([float(np.mean(force[tail])) for _, force, _, _ in lines], 0.07 * highest)
    for (label, _, colour, _), height in zip(lines, heights, strict=True):
        axes.annotate(
            label, (end, height), (4, 0), textcoords="offset points", va="center", color=colour
        )
    axes.set_xlim(0.0, end)
    axes.set_ylim(0.0, highest)
    axes.set_ylabel("up from the floor, N")
    _draw_feet(strip, recording)
    strip.set_xlabel("time, s")
    return to_svg(
        figure, name, "Vertical force of the floor on each foot over time, and what it stands on"
    )


def _draw_feet(axes: Axes, recording: Recording) -> None:
    """A bar for each foot, as long as it stands in one way."""
    forces = np.asarray(recording.channels["sole_force"], dtype=float)
    states = [foot_states(recording.model, force) for force in forces]
    end = float(recording.time[-1])
    sides = (("right", RIGHT), ("left", LEFT))
    for row, (side, colour) in enumerate(sides):
        begun = 0
        for state, stretch in itertools.groupby(state[side] for state in states):
            start, begun = begun, begun + len(list(stretch))
            if state is FootState.AIR:
                continue
            since, until = (float(recording.time[min(i, len(states) - 1)]) for i in (start, begun))
            bar = Bar(since, until, state, STRENGTH[state])
            draw_bar(axes, row, bar, colour, letter=_LETTER * end)
    label_rows(axes, [side for side, _ in sides])
