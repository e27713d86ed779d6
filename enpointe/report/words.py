"""The figures of a dance in words that a dancer reads, with units."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

from enpointe.comparing import Difference
from enpointe.danced import HELD_UP, Danced
from enpointe.models import KeyPose
from enpointe.performing import Performance
from enpointe.report.blocks import Cell, Row, Table

__all__ = [
    "DASH",
    "difference_table",
    "effort_words",
    "figure_table",
    "pose_verdict",
    "rules_sentence",
    "variant_table",
    "verdict",
]

DASH = "–"


def _millimetres(value: float) -> str:
    millimetres = 1000.0 * value
    return f"{millimetres:.2f} mm" if abs(millimetres) < 10 else f"{millimetres:.0f} mm"


def _degrees(value: float) -> str:
    return f"{value:.2f}°"


@dataclass(frozen=True, slots=True)
class _Figure:
    name: str
    label: str
    shown: Callable[[float], str]
    meaning: str


_FIGURES = (
    _Figure(
        "duration",
        "Duration",
        lambda v: f"{v:.2f} s",
        "With the count-in and the last hold, or up to the fall.",
    ),
    _Figure("tempo", "Tempo", lambda v: f"{v:g} a minute", "Pulses in a minute."),
    _Figure(
        "fell_at",
        "Fell at",
        lambda v: f"{v:.2f} s",
        "The last moment at which the weight was over the feet.",
    ),
    _Figure(
        "root_force_max",
        "Help on the root",
        lambda v: f"{v:.3g} N",
        "Any force on the pelvis but gravity and the dancer's own; 0 is an honest dance.",
    ),
    _Figure(
        "support_margin_min",
        "Least margin of balance",
        _millimetres,
        "From the centre of mass to the nearest edge of the support, seen from above.",
    ),
    _Figure("slip_max", "Greatest slip", _millimetres, "That a sole slid while it bore weight."),
    _Figure(
        "tracking_rms_deg",
        "Behind the reference",
        _degrees,
        "Root mean square over all joints and moments.",
    ),
    _Figure(
        "torque_limit_fraction_max",
        "Hardest worked joint",
        lambda v: f"{100 * v:.0f} %",
        "Greatest torque as a share of what that joint can give.",
    ),
    _Figure(
        "other_contact_max",
        "Other contact",
        lambda v: f"{v:.3g} N",
        "Greatest force where anything but a sole met the floor, or limbs met.",
    ),
    _Figure(
        "realtime_factor",
        "Computed",
        lambda v: f"{v:.1f} × real time",
        "Seconds danced for each second of computing.",
    ),
)


def verdict(performance: Danced) -> tuple[str, bool | None]:
    """What a performance honestly is, and whether that is good news (None for neither)."""
    recording, measures = performance.recording, performance.measures
    if recording is None or measures is None:
        return (
            "No physics: a kinematic movement. The dancer is drawn in each pose, has no weight "
            "and cannot fall; nothing here says that a body could dance it.",
            None,
        )
    if measures.root_force_max > HELD_UP:
        root = (
            f"This is not an honest dance: something held the pelvis "
            f"with up to {measures.root_force_max:.3g} N."
        )
    else:
        root = "Nothing held the dancer up: the force on the root was 0 N throughout."
    if performance.stood:
        text = (
            f"A physical dance under gravity, completed: {performance.danced.duration:.1f} s "
            f"on the dancer's own feet. {root}"
        )
        return text, measures.root_force_max <= HELD_UP
    left = f"her weight left her feet at {measures.fell_at or 0.0:.2f} s"
    stopped = f"{float(recording.time[-1]):.2f} s"
    if recording.fault is None:
        happened = f"the dancer was falling at the end; {left}"
    elif recording.fault == "fell":
        happened = f"the dancer fell: {left} and she was down at {stopped}"
    else:
        happened = f"{recording.fault} at {stopped}; {left}"
    whole = performance.motion.duration
    return (
        f"A physical dance under gravity, not completed: {happened}, "
        f"in a dance of {whole:.1f} s. {root}",
        False,
    )


def effort_words(performance: Performance) -> str:
    """The effort that was asked."""
    effort = performance.effort
    numbers = f"time {effort.time:g}, weight {effort.weight:g}, space {effort.space:g}"
    name = performance.effort_name
    words = numbers if "=" in name else f"{name}: {numbers}"
    return words.replace("-", "−")


def pose_verdict(pose: KeyPose) -> str:
    """What the certificate of a pose says, in a line."""
    return str(pose.certificate)


def rules_sentence(poses: tuple[KeyPose, ...]) -> str:
    """How many poses keep every rule."""
    broken = [pose.name for pose in poses if not pose.held]
    if not broken:
        poses_keep = "The pose keeps" if len(poses) == 1 else f"All {len(poses)} key poses keep"
        return f"{poses_keep} every rule that applies."
    return f"{len(broken)} of {len(poses)} key poses break a rule: {', '.join(broken)}."


def figure_table(performance: Danced, summary: Mapping[str, object]) -> Table:
    """The figures of one performance with their meaning."""
    rows = [
        Row(f.label, (_cell(f, summary), Cell(f.meaning)), f.name)
        for f in _FIGURES
        if _number(summary.get(f.name)) is not None
    ]
    if performance.measures is not None:
        flights = performance.measures.flights
        shown = "; ".join(
            f"{f.start:.2f} to {f.end:.2f} s, {100 * f.height:.0f} cm, {f.turn_deg:.0f}°"
            for f in flights
        )
        if flights:
            meaning = Cell("Both feet off the floor: when, how high, how far round.")
            rows.append(Row("Flights", (Cell(shown, float(len(flights))), meaning), "flights"))
    return Table("What came of it", ("Figure", "Value", "What it means"), tuple(rows), prose=True)


def variant_table(summaries: Mapping[str, Mapping[str, object]]) -> Table:
    """The figures of several performances, a column each."""
    rows = []
    for figure in _FIGURES:
        cells = tuple(_cell(figure, summary) for summary in summaries.values())
        if any(cell.value is not None for cell in cells):
            rows.append(Row(figure.label, cells, figure.name))
    return Table("Figures of each variant", ("Figure", *summaries), tuple(rows))


def difference_table(differences: Sequence[Difference]) -> Table:
    """How far apart the variants are."""
    rows = tuple(
        Row(
            f"{d.first} and {d.second}",
            (
                *(Cell(f"{1000.0 * value:.1f} mm", value) for value in d.wrist_path_rms.values()),
                Cell(f"{d.joint_rms_deg:.2f}°", d.joint_rms_deg),
            ),
            f"difference-{d.first}-{d.second}",
        )
        for d in differences
    )
    sides = [f"{side} wrist" for side in differences[0].wrist_path_rms]
    return Table(
        "Between the variants, at equal times, root mean square",
        ("Between", *sides, "all joints"),
        rows,
    )


def _number(value: object) -> float | None:
    if isinstance(value, bool) or not isinstance(value, int | float):
        return None
    return float(value)


def _cell(figure: _Figure, summary: Mapping[str, object]) -> Cell:
    value = _number(summary.get(figure.name))
    return Cell(DASH) if value is None else Cell(figure.shown(value), value)
