"""How every chart looks, and how it becomes an SVG element that can stand beside others."""

from __future__ import annotations

import functools
import io
import itertools
import re
from collections.abc import Callable, Sequence
from html import escape
from typing import Any, ParamSpec, TypeVar

import matplotlib
import numpy as np
from matplotlib.axes import Axes
from matplotlib.backends.backend_svg import FigureCanvasSVG
from matplotlib.figure import Figure
from numpy.typing import NDArray

from enpointe.motion import Event

__all__ = [
    "COM",
    "GREY",
    "INK",
    "LEFT",
    "PALE",
    "RIGHT",
    "apart",
    "mark_beats",
    "quiet",
    "thinned",
    "to_svg",
]

Array = NDArray[np.float64]
P = ParamSpec("P")
T = TypeVar("T")

INK, GREY, PALE = "#2b2626", "#7d756d", "#ddd6cb"
LEFT, RIGHT = "#0072b2", "#e08a00"
"""Blue and orange of Okabe and Ito's palette, the orange a little darker to be read as text."""
COM = "#d62828"
POINTS = 700
"""Points drawn of a long series: about one for each pixel."""
BEAT_LABELS_MAX = 24
_STYLE: dict[Any, Any] = {
    "font.family": "DejaVu Sans",
    "font.size": 8.5,
    "axes.labelsize": 8.5,
    "axes.titlesize": 9.0,
    "axes.titlelocation": "left",
    "axes.edgecolor": GREY,
    "axes.linewidth": 0.6,
    "axes.labelcolor": INK,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.facecolor": "none",
    "axes.unicode_minus": True,
    "figure.facecolor": "none",
    "figure.constrained_layout.use": True,
    "legend.frameon": False,
    "legend.handlelength": 2.6,
    "lines.linewidth": 1.4,
    "text.color": INK,
    # A name with a dollar sign in it is a name, not mathematics.
    "text.parse_math": False,
    "xtick.color": GREY,
    "ytick.color": GREY,
    "xtick.labelcolor": INK,
    "ytick.labelcolor": INK,
    "xtick.major.width": 0.6,
    "ytick.major.width": 0.6,
    "xtick.major.size": 3.0,
    "ytick.major.size": 3.0,
    "svg.fonttype": "path",
    "svg.hashsalt": "enpointe",
}
_METADATA = re.compile(r"<metadata>.*?</metadata>", re.DOTALL)
_STYLESHEET = re.compile(r"<style.*?</style>", re.DOTALL)
_ROOT = re.compile(r"<svg[^>]*>", re.DOTALL)
_VIEW_BOX = re.compile(r'viewBox="([^"]*)"')
_PATH = re.compile(r'\bd="[^"]*"')
_DECIMALS = re.compile(r"(\.\d\d)\d+")


def quiet(draw: Callable[P, T]) -> Callable[P, T]:
    """Draw in the report's style, whatever the user's matplotlib is set to."""

    @functools.wraps(draw)
    def styled(*args: P.args, **kwargs: P.kwargs) -> T:
        with matplotlib.rc_context():
            matplotlib.rcdefaults()
            matplotlib.rcParams.update(_STYLE)
            return draw(*args, **kwargs)

    return styled


def to_svg(figure: Figure, name: str, description: str) -> str:
    """The figure as an SVG element for a page that has others.

    Ids get the chart's name in front, since all ids of a page must differ; matplotlib's stylesheet
    goes, since it would hold for the whole page; so do metadata, which name web addresses.

    Args:
        figure: Drawn inside `quiet`.
        name: Unique on the page.
        description: For those who can't see it.
    """
    text = _saved(figure)
    text = text[text.index("<svg") :].strip()
    text = _STYLESHEET.sub("", _METADATA.sub("", text)).replace("<defs>\n  \n </defs>", "")
    box = _VIEW_BOX.search(text)
    assert box is not None
    root = (
        f'<svg xmlns="http://www.w3.org/2000/svg" class="plot" role="img" '
        f'viewBox="{box[1]}" aria-label="{escape(description)}" '
        'stroke-linejoin="round" stroke-linecap="butt">'
    )
    text = _ROOT.sub(lambda _: root, text, count=1)
    text = text.replace("xlink:href=", "href=")
    text = re.sub(r'\bid="', f'id="{name}-', text)
    text = text.replace('href="#', f'href="#{name}-').replace("url(#", f"url(#{name}-")
    return _PATH.sub(lambda path: _DECIMALS.sub(r"\1", path[0]), text)


def _saved(figure: Figure) -> str:
    """What `savefig` writes. It would draw everything once before, only to find the layout."""
    FigureCanvasSVG(figure)
    engine, dpi = figure.get_layout_engine(), figure.dpi
    if engine is not None:
        engine.execute(figure)
        figure.set_layout_engine("none")
    figure.dpi = dpi
    buffer = io.StringIO()
    figure.savefig(buffer, format="svg")
    return buffer.getvalue()


def thinned(time: Array, values: Array, points: int = POINTS) -> tuple[Array, Array]:
    """A series with fewer points, its least and its greatest in every stretch kept.

    Args:
        time: (N,).
        values: (N,), not-a-number where there is nothing to draw.
        points: To keep at most, about.
    """
    if len(time) <= points:
        return time, values
    kept = {0, len(time) - 1}
    for part in np.array_split(np.arange(len(time)), points // 2):
        drawn = values[part]
        gaps = np.flatnonzero(~np.isfinite(drawn))
        kept.update(int(part[g]) for g in gaps[:1])
        if len(gaps) < len(part):
            kept |= {int(part[np.nanargmin(drawn)]), int(part[np.nanargmax(drawn)])}
    order = np.array(sorted(kept))
    return time[order], values[order]


def mark_beats(axes: Axes, events: Sequence[Event], *, labels: bool = True) -> None:
    """Thin lines where the key poses fall, with the beats above."""
    step = -(-len(events) // BEAT_LABELS_MAX)
    for i, event in enumerate(events):
        axes.axvline(event.time, color=PALE, linewidth=0.8, zorder=0)
        if labels and event.beat is not None and i % step == 0:
            text = f"beat {event.beat:g}" if i == 0 else f"{event.beat:g}"
            axes.text(
                event.time,
                1.02,
                text,
                transform=axes.get_xaxis_transform(),
                ha="center",
                va="bottom",
                color=GREY,
                fontsize=8,
            )


def apart(heights: list[float], gap: float) -> list[float]:
    """Label heights moved apart so that none covers another."""
    order = sorted(range(len(heights)), key=lambda i: heights[i])
    placed = list(heights)
    for below, above in itertools.pairwise(order):
        placed[above] = max(placed[above], placed[below] + gap)
    return placed
