"""Whether the feet took weight when they were meant to, and at no other time."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import binary_dilation, binary_opening, find_objects, label

from enpointe.controllers import Recording
from enpointe.motion.contact_schedule import ON_FLOOR, contact_schedule
from enpointe.sim.balance import LOADED
from enpointe.sim.feet import SIDES, sole_sides

__all__ = ["ContactsKept", "Stance", "contacts_kept"]

Mask = NDArray[np.bool_]
LEEWAY = 0.04
"""A foot may come or go this much earlier or later than planned, s, as key poses may."""
SHORTEST = 0.02
"""Loads shorter than this are the chatter of a foot that comes down, s."""


@dataclass(frozen=True, slots=True)
class Stance:
    """A time at which a foot bears weight.

    Attributes:
        side: "left" or "right".
        start: s.
        end: s.
        force: Largest vertical force meanwhile, N; 0 where it never came.
    """

    side: str
    start: float
    end: float
    force: float


@dataclass(frozen=True, slots=True)
class ContactsKept:
    """Planned stances beside those that happened.

    Attributes:
        planned: How many stances the reference has, of both feet.
        missed: Those in which the foot bore nothing.
        unplanned: Loads of a foot that the reference has in the air.
    """

    planned: int
    missed: tuple[Stance, ...]
    unplanned: tuple[Stance, ...]


def contacts_kept(recording: Recording) -> ContactsKept:
    """Compare the contacts of a simulated performance with its reference's.

    A stance is planned where `contact_schedule` lets a sole of the foot bear. A foot that only
    touches, as in a tendu, may bear or not; one that is off the floor may not, but for `LEEWAY`
    around the times when it is on it.

    Args:
        recording: With the channels that `SimulatedBody` observes; up to where it ended.
    """
    schedule = contact_schedule(recording.reference)
    sides = sole_sides(recording.model)
    rows = [schedule.index(float(t)) for t in recording.time]
    bears, near = schedule.bears[rows], schedule.points[rows, :, 2] < ON_FLOOR
    force = np.asarray(recording.channels["sole_force"], dtype=float)[:, :, 2]
    planned_count, missed, unplanned = 0, [], []
    for side in SIDES:
        mine = sides == side
        planned = np.asarray(bears[:, mine].any(axis=1))
        load = force[:, mine].sum(axis=1)
        for span in _spans(planned):
            planned_count += 1
            if not np.any(load[span] > LOADED):
                missed.append(_stance(side, span, recording, load))
        leeway = np.ones(2 * round(LEEWAY / recording.period) + 1, dtype=bool)
        allowed = binary_dilation(near[:, mine].any(axis=1) | planned, leeway)
        lasting = np.ones(max(round(SHORTEST / recording.period), 1), dtype=bool)
        strange = binary_opening((load > LOADED) & ~allowed, lasting)
        unplanned += [_stance(side, span, recording, load) for span in _spans(strange)]
    return ContactsKept(planned_count, tuple(missed), tuple(unplanned))


def _spans(mask: Mask) -> list[slice]:
    return [found[0] for found in find_objects(label(mask)[0]) if found is not None]


def _stance(side: str, span: slice, recording: Recording, load: NDArray[np.float64]) -> Stance:
    time = recording.time[span]
    largest = float(load[span].max())
    return Stance(side, float(time[0]), float(time[-1]), largest if largest > LOADED else 0.0)
