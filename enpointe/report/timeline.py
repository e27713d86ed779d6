"""A checked movement over its own frames: feet, flights, turns, and where it needs help."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from enpointe.checking import Check
from enpointe.report.bars import STRENGTH, Bar, draw_bar, label_rows
from enpointe.report.chart import COM, GREY, INK, LEFT, RIGHT, quiet, thinned, to_svg

__all__ = ["timeline_chart"]

_LETTER = 0.012
"""Room that a letter of a bar's name needs, as a share of the movement."""


@quiet
def timeline_chart(check: Check, name: str) -> str:
    """Bars of what happens, over margins and help, along the file's frames and seconds."""
    figure = Figure(figsize=(8.25, 4.6))
    bars, margin, help_axes = figure.subplots(3, 1, sharex=True, height_ratios=(2.2, 1.3, 1.3))
    found = check.found
    rows: list[tuple[str, str, Sequence[Bar]]] = [
        ("left foot", LEFT, _feet(check, "left")),
        ("right foot", RIGHT, _feet(check, "right")),
        (
            "in the air",
            INK,
            [Bar(f.start, f.end, f"{1000 * f.height:.0f} mm", 0.25) for f in found.flights],
        ),
        ("turning", INK, [Bar(t.start, t.end, f"{t.revolutions:+.2f}", 0.25) for t in found.turns]),
        ("impossible", COM, [Bar(h.start, h.end, "", 0.8) for h in found.help]),
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


def _feet(check: Check, side: str) -> list[Bar]:
    return [Bar(c.start, c.end, str(c.on), STRENGTH[c.on]) for c in check.found.contacts[side]]


def _frames(check: Check, time: np.ndarray | float) -> np.ndarray:
    return np.asarray(time) * check.clock.rate + check.clock.first


def _draw_bars(axes: Axes, check: Check, rows: list[tuple[str, str, Sequence[Bar]]]) -> None:
    whole = check.found.motion.duration
    letter = _LETTER * whole * check.clock.rate
    for row, (_, colour, spans) in enumerate(reversed(rows)):
        for bar in spans:
            first, last = (float(_frames(check, moment)) for moment in (bar.start, bar.end))
            shown = replace(bar, start=first, end=max(last, first + 1.0))
            draw_bar(axes, row, shown, colour, letter=letter)
    label_rows(axes, [name for name, _, _ in reversed(rows)])
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
