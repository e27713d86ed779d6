"""The figures of a dance under gravity, and which of its beats and contacts were kept."""

from __future__ import annotations

from math import isfinite
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from enpointe.figures import BeatFigures, PhysicalFigures, StanceFigures

if TYPE_CHECKING:
    from enpointe.controllers import Recording
    from enpointe.motion import Event, Motion
    from enpointe.motion.weight_plan import WeightPlan
    from enpointe.sim.contacts_kept import Stance
    from enpointe.sim.measures import Measures

__all__ = ["beats_not_kept", "physical_figures"]

OUTSIDE = 0.001
"""m: a plan that leaves the feet by less is only the solver's rounding."""


def physical_figures(
    recording: Recording, measures: Measures, shortfall: float | None, weight: WeightPlan | None
) -> PhysicalFigures:
    """Everything that a performance under gravity prints besides the kinematic figures."""
    from enpointe.motion.arrival import lateness, tempo_kept
    from enpointe.sim.contacts_kept import contacts_kept

    reference = recording.reference
    lateness_at = lateness(recording.as_motion(), reference)
    kept, late = tempo_kept(lateness_at, reference)
    contacts = contacts_kept(recording)
    return {
        "tempo_danced": kept if isfinite(kept) else None,
        "lateness_max": late if isfinite(late) else None,
        "beats_not_kept": beats_not_kept(reference, lateness_at, weight),
        "contacts_planned": contacts.planned,
        "contacts_missed": [_stance_figures(stance) for stance in contacts.missed],
        "contacts_unplanned": [_stance_figures(stance) for stance in contacts.unplanned],
        "fell_at": measures.fell_at,
        "shortfall_max": shortfall,
        "fault": recording.fault,
        "steps": len(recording.time),
        "root_force_max": measures.root_force_max,
        "other_contact_max": measures.other_contact_max,
        "tracking_rms_deg": measures.tracking_rms_deg,
        "support_margin_min": measures.support_margin_min,
        "slip_max": measures.slip_max,
        "flights": [
            {"start": f.start, "end": f.end, "height": f.height, "turn_deg": f.turn_deg}
            for f in measures.flights
        ],
        "torque_limit_fraction_max": measures.torque_limit_fraction_max,
        "realtime_factor": recording.realtime_factor,
    }


def beats_not_kept(
    reference: Motion, late: NDArray[np.float64], weight: WeightPlan | None
) -> list[BeatFigures]:
    """Key poses that were not reached in time, or whose weight no floor can hold, in order.

    Args:
        reference: What was asked.
        late: Of each key pose but the first, (K - 1,), s; NaN where it was never reached.
        weight: The plan of the centre of mass, where one was made.
    """
    from enpointe.motion.arrival import KEPT

    events = reference.key_events
    lost: list[BeatFigures] = []
    for i, event in enumerate(events):
        by = float(late[i - 1]) if i > 0 else 0.0
        outside = _outside(weight, reference, i)
        if not abs(by) <= KEPT or outside > OUTSIDE:
            lost.append(
                {
                    "beat": event.beat,
                    "time": event.time,
                    "late": by if isfinite(by) else None,
                    "outside": outside,
                }
            )
    return lost


def _outside(weight: WeightPlan | None, reference: Motion, key: int) -> float:
    """How far outside the feet the plan is between the middles of the ways to and from a pose."""
    if weight is None:
        return 0.0
    events: tuple[Event, ...] = reference.key_events
    start = 0.5 * (events[key - 1].time + events[key].time) if key > 0 else 0.0
    last = key + 1 == len(events)
    end = reference.duration if last else 0.5 * (events[key].time + events[key + 1].time)
    near = (weight.time >= start) & (weight.time <= end)
    return max(float(np.max(weight.outside[near], initial=0.0)), 0.0)


def _stance_figures(stance: Stance) -> StanceFigures:
    return {
        "side": stance.side,
        "start": stance.start,
        "end": stance.end,
        "force": stance.force,
    }
