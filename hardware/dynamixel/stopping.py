"""A person's wish to stop: the first asks the rig to park, the second to let go at once."""

from __future__ import annotations

import contextlib
import signal
from collections.abc import Iterator
from types import FrameType

__all__ = ["StopButton"]


class StopButton:
    """Counts how often it was pressed; pressing is safe in a signal handler."""

    def __init__(self) -> None:
        self._presses = 0
        self.why = "stopped by hand"

    @property
    def presses(self) -> int:
        """How often, up to now."""
        self.look()
        return self._presses

    def look(self) -> None:
        """See whether somebody pressed; nothing to see here."""

    def press(self, why: str = "stopped by hand") -> None:
        """Ask to stop."""
        if not self._presses:
            self.why = why
        self._presses += 1

    @contextlib.contextmanager
    def on_signals(self) -> Iterator[None]:
        """Let Ctrl-C and SIGTERM press it for the length of a `with`, in the main thread."""

        def pressed(number: int, frame: FrameType | None) -> None:
            self.press()

        numbers = (signal.SIGINT, signal.SIGTERM)
        before = [signal.signal(number, pressed) for number in numbers]
        try:
            yield
        finally:
            for number, handler in zip(numbers, before, strict=True):
                signal.signal(number, handler)
