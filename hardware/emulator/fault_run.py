"""Faults at work: their moments drawn, and what they do to packets, power and joints."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from enpointe.hardware.emulator.faults import Fault, FaultKind

__all__ = ["FaultRun", "Moment"]

_MARK = b"\xff\xff\xfd"


@dataclass(frozen=True, slots=True)
class Moment:
    """A fault with its time drawn.

    Attributes:
        fault: Which.
        begin: s.
        end: s.
    """

    fault: Fault
    begin: float
    end: float

    def holds(self, time: float, servo: int | None = None) -> bool:
        """Whether it is on, for a servo if one is given."""
        concerned = servo is None or not self.fault.ids or servo in self.fault.ids
        return concerned and self.begin <= time < self.end


class FaultRun:
    """One run of a fault script: the same generator state gives the same faults.

    Args:
        faults: The script.
        rng: Draws moments first, in the script's order, and then each packet's fate.
    """

    def __init__(self, faults: Sequence[Fault], rng: np.random.Generator) -> None:
        self._rng = rng
        self.moments = tuple(_drawn(fault, rng) for fault in faults)
        self._heating = [m for m in self.moments if m.fault.kind is FaultKind.OVERHEAT]

    def missing(self, servo: int, time: float) -> bool:
        """Whether a servo is off the bus."""
        return any(m.holds(time, servo) for m in self._of(FaultKind.MISSING))

    def jammed(self, servo: int, time: float) -> bool:
        """Whether a joint is stuck."""
        return any(m.holds(time, servo) for m in self._of(FaultKind.STALL))

    def unplugged(self, time: float) -> bool:
        """Whether the host's adapter is gone."""
        return any(m.holds(time) for m in self._of(FaultKind.UNPLUG))

    def supply(self, servo: int, time: float, volts: float) -> float:
        """V that a servo has, given those of the supply."""
        for moment in self._of(FaultKind.BROWN_OUT):
            if moment.holds(time, servo):
                volts = min(volts, moment.fault.size)
        return volts

    def heated(self, time: float) -> list[Fault]:
        """Faults of heat that have begun since this was asked last."""
        begun = [moment for moment in self._heating if moment.begin <= time]
        self._heating = [moment for moment in self._heating if moment.begin > time]
        return [moment.fault for moment in begun]

    def instruction(self, data: bytes, time: float) -> bytes:
        """The host's bytes as the servos hear them; fates of one servo alone don't apply."""
        for moment in self.moments:
            fault = moment.fault
            if fault.instructions and moment.holds(time) and self._strikes(fault):
                data = b"" if fault.kind is FaultKind.DROP else self._corrupt(data)
        return data

    def answer(self, servo: int, data: bytes, time: float) -> tuple[bytes | None, float]:
        """A servo's bytes as the host hears them, None if never, and how late they are, s."""
        late = 0.0
        changed: bytes | None = data
        for moment in self.moments:
            fault = moment.fault
            if fault.instructions or not moment.holds(time, servo):
                continue
            if fault.kind not in _OF_PACKETS or not self._strikes(fault):
                continue
            if fault.kind is FaultKind.DELAY:
                late += fault.size
            elif changed is not None:
                changed = self._changed(fault.kind, changed)
        return changed, late

    def _changed(self, kind: FaultKind, data: bytes) -> bytes | None:
        if kind is FaultKind.DROP:
            return None
        if kind is FaultKind.STUFFING:
            place = int(self._rng.integers(len(data)))
            return data[:place] + _MARK + data[place:]
        return self._corrupt(data)

    def _corrupt(self, data: bytes) -> bytes:
        if not data:
            return data
        place = int(self._rng.integers(len(data)))
        other = data[place] ^ int(self._rng.integers(1, 256))
        return data[:place] + bytes([other]) + data[place + 1 :]

    def _strikes(self, fault: Fault) -> bool:
        return fault.probability >= 1.0 or bool(self._rng.random() < fault.probability)

    def _of(self, kind: FaultKind) -> Iterator[Moment]:
        return (moment for moment in self.moments if moment.fault.kind is kind)


_OF_PACKETS = (FaultKind.DROP, FaultKind.CORRUPT, FaultKind.DELAY, FaultKind.STUFFING)


def _drawn(fault: Fault, rng: np.random.Generator) -> Moment:
    begin = _between(fault.at, rng)
    return Moment(fault, begin, begin + _between(fault.duration, rng))


def _between(span: tuple[float, float], rng: np.random.Generator) -> float:
    low, high = span
    return low if low == high else float(rng.uniform(low, high))
