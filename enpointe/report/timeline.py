"""A checked movement over its own frames: feet, flights, turns, and where it needs help."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from enpointe.checking import Check
from enpointe.report.chart import COM, GREY, INK, LEFT, RIGHT, quiet, thinned, to_svg
from enpointe.sim.feet import FootState

__all__ = ["STRENGTH", "timeline_chart"]

STRENGTH: Mapping[FootState, float] = {
    FootState.FLAT: 0.3,
    FootState.DEMI_POINTE: 0.6,
    FootState.POINTE: 0.95,
    FootState.HEEL: 0.15,
}
"""How strongly a foot's bar is coloured: the more it rises the stronger."""
_NAMED = 0.012
"""A bar shorter than this share of the movement for each letter is too short for its name."""

_Bar = tuple[float, float, str, float]
"""Start and end in s, its name, and how strongly it is coloured."""


@quiet
def timeline_chart(check: Check, name: str) -> str:
    """Bars of what happens, over margins and help, along the file's frames and seconds."""
    figure = Figure(figsize=(8.25, 4.6))
    bars, margin, help_axes = figure.subplots(3, 1, sharex=True, height_ratios=(2.2, 1.3, 1.3))
    found = check.found
    rows: list[tuple[str, str, Sequence[_Bar]]] = [
        ("left foot", LEFT, _feet(check, "left")),
        ("right foot", RIGHT, _feet(check, "right")),
        (
            "in the air",
            INK,
            [(f.start, f.end, f"{1000 * f.height:.0f} mm", 0.25) for f in found.flights],
        ),
        ("turning", INK, [(t.start, t.end, f"{t.revolutions:+.2f}", 0.25) for t in found.turns]),
        ("impossible", COM, [(h.start, h.end, "", 0.8) for h in found.help]),
    ]
    _draw_bars(bars, check, rows)
    _draw_margin(margin, check)
    _draw_help(help_axes, check)
    help_axes.set_xlabel(f"frame, at {check.clock.rate:g} a second")
    help_axes.xaxis.set_major_locator(MaxNLocator(integer=True))
    seconds = bars.secondary_xaxis(
        "top",
        functions=(
            lambda frame: (frame - check.clock.first) / check.clock.rate,
            lambda second: second * check.clock.rate + check.clock.first,
        ),
    )
    seconds.set_xlabel("time, s")
    return to_svg(
        figure,
        name,
        "What the feet stand on, flights, turns and impossible times over the file's frames, with "
        "the margin of balance and the invisible help below",
    )


def _feet(check: Check, side: str) -> list[_Bar]:
    return [(c.start, c.end, str(c.on), STRENGTH[c.on]) for c in check.found.contacts[side]]


def _frames(check: Check, time: np.ndarray | float) -> np.ndarray:
    return np.asarray(time) * check.clock.rate + check.clock.first


def _draw_bars(axes: Axes, check: Check, rows: list[tuple[str, str, Sequence[_Bar]]]) -> None:
    whole = check.found.motion.duration
    for row, (_, colour, spans) in enumerate(reversed(rows)):
        for start, end, label, strength in spans:
            first, last = (float(_frames(check, moment)) for moment in (start, end))
            width = max(last - first, 1.0)
            axes.barh(row, width, 0.72, first, color=colour, alpha=strength, linewidth=0.0)
            if label and end - start > _NAMED * whole * len(label):
                ink = "white" if strength > 0.8 else INK
                middle = 0.5 * (first + last)
                axes.text(middle, row, label, ha="center", va="center", color=ink, fontsize=7.5)
    axes.set_ylim(-0.5, len(rows) - 0.5)
    axes.set_yticks(range(len(rows)), [label for label, _, _ in reversed(rows)])
    axes.tick_params(axis="y", length=0.0)
    axes.spines["left"].set_visible(False)
    axes.set_xlim(*(float(_frames(check, t)) for t in (0.0, whole)))


def _draw_margin(axes: Axes, check: Check) -> None:
    found = check.found
    for values, colour, width in ((found.zmp_margin, GREY, 0.7), (found.com_margin, COM, 1.2)):
        known = np.where(np.isfinite(values), 1000.0 * values, np.nan)
        axes.plot(*thinned(_frames(check, found.motion.time), known), color=colour, linewidth=width)
    axes.axhline(0.0, color=INK, linewidth=0.6)
    axes.set_ylim(-150.0, 150.0)
    axes.set_ylabel("mm inside")


def _draw_help(axes: Axes, check: Check) -> None:
    found = check.found
    share = 100.0 * found.root_wrench / found.weight
    axes.fill_between(
        _frames(check, found.root_wrench_time), share, color=COM, alpha=0.5, linewidth=0.0
    )
    axes.set_ylim(0.0, max(10.0, min(200.0, 1.1 * float(share.max(initial=0.0)))))
    axes.set_ylabel("help, % of\nbody weight")
