"""What the servos say, frame by frame: every sample with its age, its validity and its alarm.

A frame is one sync read of everybody: Present Current, Velocity and Position, ten neighbouring
bytes that all X models have at the same place. Fast reads come whole or not at all, so that one
servo gone silences all; after two lost frames everybody is asked for an answer of his own, and
whoever silences those after him is asked last from then on, until all have answered for a while.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from enpointe.hardware.clock import Clock
from enpointe.hardware.dynamixel.link import Link
from enpointe.hardware.packets import ALERT

__all__ = ["FRAME", "Frame", "FrameReader"]

FRAME = (126, 10)
"""Address and size of what is read in every cycle."""
_FEW = 2
_LONG = 50
Counts = NDArray[np.int64]


@dataclass(frozen=True, slots=True)
class Frame:
    """The newest that is known of everybody.

    Attributes:
        current: (n,) counts of Present Current, or Present Load.
        velocity: (n,) counts.
        position: (n,) pulses.
        age: (n,) s since each was read; infinite if never.
        fresh: (n,) whether it came in this very frame.
        alert: (n,) whether the servo said that its Hardware Error Status is not zero.
    """

    current: Counts
    velocity: Counts
    position: Counts
    age: NDArray[np.float64]
    fresh: NDArray[np.bool_]
    alert: NDArray[np.bool_]

    @property
    def whole(self) -> bool:
        """Whether everybody answered."""
        return bool(self.fresh.all())


class FrameReader:
    """Reads frames and remembers what came when.

    Args:
        link: The bus.
        ids: In the rig's order.
        clock: Of the ages.
        fast: Whether all may answer in one packet.
    """

    def __init__(self, link: Link, ids: Sequence[int], clock: Clock, *, fast: bool) -> None:
        self.frames = 0
        self.lost = 0
        self._link = link
        self._ids = tuple(ids)
        self._order = list(ids)
        self._clock = clock
        self._fast = fast
        self._values = np.zeros((3, len(ids)), dtype=np.int64)
        self._alert = np.zeros(len(ids), dtype=bool)
        self._read_at = np.full(len(ids), -np.inf)
        self._silent = 0
        self._careful = 0

    def read(self) -> Frame:
        """Ask everybody once.

        Raises:
            PortLostError: The port is gone.
        """
        found = self._asked()
        now = self._clock.now()
        fresh = np.zeros(len(self._ids), dtype=bool)
        for place, servo in enumerate(self._ids):
            if servo not in found:
                continue
            error, data = found[servo]
            self._values[:, place] = _decoded(data)
            self._alert[place] = bool(error & ALERT)
            self._read_at[place] = now
            fresh[place] = True
        self._count(bool(fresh.all()))
        current, velocity, position = self._values.copy()
        return Frame(current, velocity, position, now - self._read_at, fresh, self._alert.copy())

    @property
    def loss(self) -> float:
        """Share of frames that did not come whole."""
        return self.lost / self.frames if self.frames else 0.0

    def _asked(self) -> dict[int, tuple[int, bytes]]:
        if self._fast and not self._careful:
            return self._link.fast_sync_read(self._ids, *FRAME)
        found = self._link.sync_read(self._order, *FRAME)
        silent = next((servo for servo in self._order if servo not in found), None)
        if silent is not None:
            self._order.remove(silent)
            self._order.append(silent)
        return found

    def _count(self, whole: bool) -> None:
        self.frames += 1
        self.lost += not whole
        self._silent = 0 if whole else self._silent + 1
        if self._silent >= _FEW:
            self._careful = _LONG
        elif whole and self._careful:
            self._careful -= 1


def _decoded(data: bytes) -> tuple[int, int, int]:
    return (
        int.from_bytes(data[0:2], "little", signed=True),
        int.from_bytes(data[2:6], "little", signed=True),
        int.from_bytes(data[6:10], "little", signed=True),
    )
