"""How often she completed the dance, over two of the things that were disturbed."""

from __future__ import annotations

import io
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import LinearSegmentedColormap
from matplotlib.figure import Figure
from numpy.typing import NDArray

from enpointe.errors import EnpointeError
from enpointe.report.chart import COM, GREY, INK, LEFT, quiet, to_svg
from enpointe.sim.trial import Outcome

__all__ = [
    "FACTORS",
    "count_runs",
    "find_factors",
    "heat_map_png",
    "heat_map_svg",
    "mapped_factors",
]

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class _Scale:
    """How a factor is written: its label, and what its SI values are multiplied by."""

    label: str
    factor: float = 1.0


FACTORS: Mapping[str, _Scale] = {
    "push_direction": _Scale("pushed towards"),
    "push_at": _Scale("pushed at, s"),
    "friction": _Scale("friction of the floor"),
    "mass_error": _Scale("heavier than the controller thinks, %", 100.0),
    "com_forward": _Scale("centre of mass farther forward, mm", 1000.0),
    "com_left": _Scale("centre of mass farther to her left, mm", 1000.0),
    "rate": _Scale("commands a second"),
    "softness": _Scale("time constant of contact, ms", 1000.0),
    "push": _Scale("push, N s"),
    "delay": _Scale("delay, ms", 1000.0),
    "noise": _Scale("noise, times 0.1° and 0.05 rad/s"),
}
"""Those that a map can have, the most telling first."""
_SIDES = ("the audience", "her left", "the back", "her right")
_EACH_CELL = 5.0
"""Runs that a cell should have on the average."""
_CELLS_MAX = 8
_COLOURS = LinearSegmentedColormap.from_list("completed", [COM, "#f4efe6", LEFT])


def mapped_factors(
    outcomes: Sequence[Outcome], asked: Sequence[str] | None = None
) -> tuple[str, ...]:
    """The factors along the axes: those asked for, or the first two that vary.

    Raises:
        EnpointeError: One that did not vary.
    """
    varied = tuple(name for name in FACTORS if len(set(_values(outcomes, name))) > 1)
    if asked is None:
        return varied[:2]
    for name in asked:
        if name not in varied:
            raise EnpointeError(
                f"{name!r} did not vary in this sweep; map two of {', '.join(varied) or 'nothing'}"
            )
    return tuple(asked)


def find_factors(text: str) -> tuple[str, ...]:
    """The two names in "push_at,friction".

    Raises:
        EnpointeError: Not two, or no factors.
    """
    names = tuple(name.strip() for name in text.split(","))
    if len(names) != 2 or names[0] == names[1] or not set(names) <= set(FACTORS):
        raise EnpointeError(f"{text!r} is no map; name two of {', '.join(FACTORS)}")
    return names


def heat_map_png(outcomes: Sequence[Outcome], factors: Sequence[str]) -> bytes:
    """The map as a PNG file; see `heat_map_svg`."""
    buffer = io.BytesIO()
    _draw_png(outcomes, factors, buffer)
    return buffer.getvalue()


@quiet
def _draw_png(outcomes: Sequence[Outcome], factors: Sequence[str], buffer: io.BytesIO) -> None:
    _map(outcomes, factors).savefig(buffer, format="png", dpi=160, facecolor="white")


@quiet
def heat_map_svg(outcomes: Sequence[Outcome], factors: Sequence[str], name: str) -> str:
    """The map as an SVG element.

    Args:
        outcomes: Of a sweep.
        factors: One or two names of `FACTORS`; the first along the bottom.
        name: Unique on the page.
    """
    return to_svg(_map(outcomes, factors), name, "Share of runs completed over two factors")


def count_runs(outcomes: Sequence[Outcome], factors: Sequence[str]) -> tuple[Array, Array]:
    """Runs completed and runs in all, by the cells of a map, each (up, across).

    Args:
        outcomes: Of a sweep.
        factors: One or two names of `FACTORS`; the first across.
    """
    across, up = _axes(outcomes, factors)
    count = np.zeros((up.cells, across.cells))
    completed = count.copy()
    np.add.at(count, (up.index, across.index), 1.0)
    np.add.at(completed, (up.index, across.index), [o.completed for o in outcomes])
    return completed, count


def _axes(outcomes: Sequence[Outcome], factors: Sequence[str]) -> tuple[_Bins, _Bins]:
    across = _Bins.of(outcomes, factors[0])
    return across, (
        _Bins.of(outcomes, factors[1]) if len(factors) > 1 else _Bins.single(len(outcomes))
    )


def _map(outcomes: Sequence[Outcome], factors: Sequence[str]) -> Figure:
    across, up = _axes(outcomes, factors)
    completed, count = count_runs(outcomes, factors)
    figure = Figure(figsize=(8.25, 1.3 + 0.45 * up.cells))
    axes = figure.subplots()
    share = np.divide(completed, count, out=np.full(count.shape, np.nan), where=count > 0)
    picture = axes.imshow(share, cmap=_COLOURS, vmin=0.0, vmax=1.0, origin="lower", aspect="auto")
    _write_counts(axes, completed, count, share)
    for axis, bins in ((axes.xaxis, across), (axes.yaxis, up)):
        axis.set_ticks(bins.ticks, bins.labels)
    axes.set_xlabel(across.name)
    axes.set_ylabel(up.name)
    axes.spines[:].set_visible(False)
    bar = figure.colorbar(picture, ax=axes, ticks=[0.0, 0.5, 1.0], fraction=0.06)
    bar.ax.set_yticklabels(["none", "half", "all"])
    bar.outline.set_visible(False)
    axes.set_title(f"completed, of {len(outcomes)} runs")
    return figure


def _write_counts(axes: Axes, completed: Array, count: Array, share: Array) -> None:
    for (row, column), runs in np.ndenumerate(count):
        strong = runs and abs(share[row, column] - 0.5) > 0.3
        text = f"{completed[row, column]:.0f} of {runs:.0f}" if runs else "no runs"
        colour = "white" if strong else INK if runs else GREY
        axes.text(column, row, text, ha="center", va="center", color=colour, fontsize=8)


@dataclass(frozen=True)
class _Bins:
    """Runs sorted along an axis.

    Attributes:
        name: Of the axis.
        index: (N,), the bin of each run.
        cells: How many bins there are.
        ticks: Where what is written stands.
        labels: What is written there.
    """

    name: str
    index: NDArray[np.int64]
    cells: int
    ticks: tuple[float, ...]
    labels: tuple[str, ...]

    @classmethod
    def single(cls, runs: int) -> _Bins:
        return cls("", np.zeros(runs, dtype=np.int64), 1, (), ())

    @classmethod
    def of(cls, outcomes: Sequence[Outcome], factor: str) -> _Bins:
        scale, values = FACTORS[factor], np.array(_values(outcomes, factor))
        if factor == "push_direction":
            # Quarters about each side of her.
            quarter = np.floor(values / (0.5 * np.pi) + 0.5).astype(np.int64) % 4
            return cls(scale.label, quarter, 4, (0.0, 1.0, 2.0, 3.0), _SIDES)
        wanted = round(float(np.sqrt(len(values) / _EACH_CELL)))
        cells = min(max(wanted, 2), _CELLS_MAX)
        edges = np.linspace(values.min(), values.max(), cells + 1)
        index = np.clip(np.searchsorted(edges, values, side="right") - 1, 0, cells - 1)
        places = max(1 - int(np.floor(np.log10(scale.factor * (edges[1] - edges[0])))), 0)
        shown = tuple(f"{scale.factor * e:.{places}f}".replace("-", "−") for e in edges)
        ticks = tuple(float(t) for t in np.arange(cells + 1) - 0.5)
        return cls(scale.label, index, cells, ticks, shown)


def _values(outcomes: Sequence[Outcome], factor: str) -> list[float]:
    found = [o.factors.get(factor) for o in outcomes]
    return [value for value in found if value is not None]
