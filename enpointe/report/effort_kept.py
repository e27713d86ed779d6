"""What of an effort is left when servos have danced it."""

from __future__ import annotations

from enpointe.motion.joint_timing import TimingKept
from enpointe.report.blocks import Cell, Row, Table
from enpointe.report.words import DASH

__all__ = ["effort_table"]


def effort_table(timing: TimingKept) -> Table:
    """The numbers of the effort, as asked and as they came out."""
    asked, done = timing.asked, timing.done

    def row(what: str, before: str, after: str) -> Row:
        return Row(what, (Cell(before), Cell(after)))

    rows = [
        row(
            "time, gradient b of the logistic",
            DASH if asked is None else f"{asked.time:.2f}",
            DASH if done is None else f"{done.time:.2f}",
        ),
        row(
            "weight, centroid x0",
            DASH if asked is None else f"{asked.weight:.3f}",
            DASH if done is None else f"{done.weight:.3f}",
        ),
        row("share of the way, rms apart", DASH, f"{100 * timing.distance_rms:.1f} %"),
        row("speed profiles, correlation", DASH, f"{timing.speed_correlation:.3f}"),
        row("greatest speed comes later by", DASH, f"{100 * timing.peak_shift:+.1f} % of the time"),
        row("all comes later by", DASH, f"{1000 * timing.lag:.0f} ms"),
    ]
    caption = f"Of {timing.ways} ways of joints between key poses, the delay of all taken out"
    return Table(caption, ("", "asked", "came out"), tuple(rows))
