"""Where on its way a movement is at a moment, and the other way about."""

from __future__ import annotations

from dataclasses import dataclass

from enpointe.motion.effort import Effort, logistic, logistic_inverse

__all__ = ["Clock"]


@dataclass(frozen=True, slots=True)
class Clock:
    """The timing of a passage between two key poses; without an effort, way and time agree.

    Attributes:
        effort: Quality of the movement.
    """

    effort: Effort | None = None

    def moment(self, share: float) -> float:
        """Share of the time at which a share of the way is gone."""
        if self.effort is None:
            return share
        return float(logistic_inverse(share, self.effort.time, self.effort.weight))

    def share(self, moment: float) -> float:
        """Share of the way that is gone at a share of the time."""
        if self.effort is None:
            return moment
        return float(logistic(moment, self.effort.time, self.effort.weight))
