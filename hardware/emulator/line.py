"""One pair of wires, on which only one can talk: when each byte passes, and what collides."""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass

from enpointe.hardware.packets import HEADER
from enpointe.hardware.wire import BITS_PER_BYTE

__all__ = ["Line"]


@dataclass(slots=True)
class _Sent:
    """Bytes of the host on their way."""

    start: float
    end: float
    data: bytearray


class Line:
    """The bus as wires: half duplex, ten bits a byte.

    While the host drives the line it does not listen, so that answers of that time are lost to it,
    and its own bytes suffer: a zero wins over a one.

    Args:
        baud: bit/s of the host.
        instant: Take no time for anything.
        latency: s by which an adapter holds back what the servos say.
    """

    def __init__(self, baud: int, *, instant: bool = False, latency: float = 0.0) -> None:
        self.baud = baud
        self._instant = instant
        self._latency = latency
        self._sent: deque[_Sent] = deque()
        self._answered: deque[tuple[float, int]] = deque()
        self._host_free = 0.0

    @property
    def byte_time(self) -> float:
        """s a byte."""
        return 0.0 if self._instant else BITS_PER_BYTE / self.baud

    def pause(self, seconds: float) -> float:
        """A wait of a servo, as long as this line takes it."""
        return 0.0 if self._instant else seconds

    def send(self, data: bytes, at: float) -> None:
        """The host hands over bytes, which follow on those that are still on their way."""
        for piece in _packets(data):
            start = max(at, self._host_free)
            end = start + len(piece) * self.byte_time
            sent = _Sent(start, end, bytearray(piece))
            self._host_free = end
            self._sent.append(sent)
            if not self._instant:
                kept = [each for each in self._answered if not self._collides(each, sent)]
                self._answered = deque(kept)

    def answer(self, data: bytes, at: float) -> float:
        """A servo talks; the time when it ends."""
        step = self.byte_time
        slots = [(at + (number + 1) * step, byte) for number, byte in enumerate(data)]
        if self._sent and not self._instant:
            slots = [slot for slot in slots if not any(self._collides(slot, s) for s in self._sent)]
        before = self._answered[-1][0] if self._answered else 0.0
        self._answered.extend(slots)
        if slots and slots[0][0] < before:
            # A late answer to an earlier question is still to come: bytes come by their times.
            self._answered = deque(sorted(self._answered, key=lambda slot: slot[0]))
        return at + len(data) * step

    def next_sent(self) -> float | None:
        """When the host's next packet is whole at the servos."""
        return self._sent[0].end if self._sent else None

    def take_sent(self) -> tuple[float, bytes]:
        """When it began, and its bytes as they came."""
        sent = self._sent.popleft()
        return sent.start, bytes(sent.data)

    def next_answered(self, count: int = 1) -> float | None:
        """When the host will have so many bytes; None if there are not so many on the way."""
        if len(self._answered) < count:
            return None
        return self._answered[count - 1][0] + self._latency

    def available(self, now: float) -> int:
        """Bytes that have come to the host."""
        count = 0
        for end, _ in self._answered:
            if end + self._latency > now:
                break
            count += 1
        return count

    def take_answered(self, now: float, most: int | None = None) -> bytes:
        """The bytes that have come to the host."""
        count = self.available(now)
        count = count if most is None else min(count, most)
        return bytes(self._answered.popleft()[1] for _ in range(count))

    def _collides(self, slot: tuple[float, int], sent: _Sent) -> bool:
        """Whether a servo's byte and the host's packet cross, in which case both are hurt."""
        end, byte = slot
        begin = end - self.byte_time
        if end <= sent.start + 1e-12 or begin >= sent.end - 1e-12:
            return False
        place = int((begin - sent.start) / self.byte_time)
        for index in (place, place + 1):
            if 0 <= index < len(sent.data):
                sent.data[index] &= byte
        return True


def _packets(data: bytes) -> list[bytes]:
    """Cut before each header, so that a packet is heard when it is whole."""
    pieces, begin = [], 0
    while (place := data.find(HEADER, begin + 1)) >= 0:
        pieces.append(data[begin:place])
        begin = place
    pieces.append(data[begin:])
    return pieces
