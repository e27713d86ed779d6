"""Bars along time that say what is so from when to when: a foot's stances, flights, turns."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from matplotlib.axes import Axes

from enpointe.report.chart import INK
from enpointe.sim.feet import FootState

__all__ = ["STRENGTH", "Bar", "draw_bar", "label_rows"]

STRENGTH: Mapping[FootState, float] = {
    FootState.FLAT: 0.3,
    FootState.DEMI_POINTE: 0.6,
    FootState.POINTE: 0.95,
    FootState.HEEL: 0.15,
}
"""How strongly a foot's bar is coloured: the more it rises the stronger."""
_DARK = 0.8
"""A bar coloured more strongly has its name in white."""


@dataclass(frozen=True, slots=True)
class Bar:
    """Something that lasts.

    Attributes:
        start: In what the axes count along.
        end: Likewise.
        name: What is written on it where there is room.
        strength: Of its colour, from 0 to 1.
    """

    start: float
    end: float
    name: str
    strength: float


def draw_bar(axes: Axes, row: int, bar: Bar, colour: str, *, letter: float) -> None:
    """One bar in a row, with its name if that fits.

    Args:
        axes: To draw on.
        row: How many rows there are below it.
        bar: What to draw.
        colour: At full strength.
        letter: Room that a letter needs, in what the axes count along.
    """
    width = bar.end - bar.start
    axes.barh(row, width, 0.75, bar.start, color=colour, alpha=bar.strength, linewidth=0.0)
    if bar.name and width > letter * len(bar.name):
        ink = "white" if bar.strength > _DARK else INK
        middle = 0.5 * (bar.start + bar.end)
        axes.text(middle, row, bar.name, ha="center", va="center", color=ink, fontsize=7.5)


def label_rows(axes: Axes, names: list[str]) -> None:
    """The names of the rows, from the lowest, instead of an axis of numbers."""
    axes.set_ylim(-0.5, len(names) - 0.5)
    axes.set_yticks(range(len(names)), names)
    axes.tick_params(axis="y", length=0.0)
    axes.spines["left"].set_visible(False)
