"""The ways between the stations of a dance: their curves, contacts and what is asked on them."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from enpointe.models.keypose import KeyPose, KeyPoseSolver
from enpointe.models.target import PoseTarget
from enpointe.motion.effort import Effort, logistic
from enpointe.motion.grounding import Contact
from enpointe.motion.inbetween import Passage, solve_passage
from enpointe.motion.kind import Interpolation
from enpointe.motion.slerp import slerp_poses
from enpointe.motion.stations import Station
from enpointe.notation import Side

__all__ = ["Way", "Ways"]

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Way:
    """From one station to the next.

    Attributes:
        curve: qpos (S, nq) at shares of the way (S,).
        contact: How a foot stands at a share.
        target: What is asked at a share; None where nothing is asked between the stations.
    """

    curve: Callable[[Array], Array]
    contact: Callable[[Side, float], Contact]
    target: Callable[[float], PoseTarget] | None = None


class Ways:
    """The ways between the stations of a dance, each solved when it is first asked for.

    A pair of poses that comes again in the same quality is solved once.

    Attributes:
        solver: Of the dancer.
        stations: What the dance goes through.
        efforts: The quality of each way, one fewer than stations.
        kind: How the stations are joined.
    """

    def __init__(
        self,
        solver: KeyPoseSolver,
        stations: Sequence[Station],
        efforts: Sequence[Effort],
        kind: Interpolation,
    ) -> None:
        self.solver, self.stations, self.efforts, self.kind = solver, stations, efforts, kind
        self._known: dict[tuple[bytes, bytes, Effort], Way] = {}

    def __getitem__(self, index: int) -> Way:
        """The way from the station `index` to the next."""
        start, end = self.stations[index : index + 2]
        effort = self.efforts[index]
        key = (start.pose.qpos.tobytes(), end.pose.qpos.tobytes(), effort)
        if key not in self._known:
            self._known[key] = self._make(start.pose, end.pose, end, effort)
        return self._known[key]

    def shares(self, index: int, phase: Array) -> Array:
        """Shares of that way at shares of its time, both (S,) in [0, 1]."""
        if self.kind is Interpolation.SLERP:
            return phase
        effort = self.efforts[index]
        law = self.stations[index + 1].law
        return law.share(phase, lambda moment: logistic(moment, effort.time, effort.weight))

    def _make(self, start: KeyPose, end: KeyPose, station: Station, effort: Effort) -> Way:
        solver = self.solver
        if self.kind is Interpolation.SLERP:
            return Way(
                lambda share: slerp_poses(solver.model, start.qpos, end.qpos, share),
                lambda side, share: None,
            )
        inflect = self.kind is Interpolation.EXPRESSIVE
        drawn = effort if inflect else replace(effort, space=1.0)
        passage: Passage = solve_passage(
            solver, start, end, drawn, inflect=inflect, com=_flown(station)
        )
        return Way(passage.curve(solver.model), passage.contact, passage.target)


def _flown(station: Station) -> Callable[[float], Array] | None:
    """The centre of mass on the way to a station, for one reached through the air."""
    if station.flight is None:
        return None
    flight, (first, last) = station.flight, station.span
    return lambda share: flight.at((1 - share) * first + share * last)
