"""Where a servo thinks its horn is: sense of rotation, turns counted, homing offset.

Source: e-manual, Drive Mode(10), Homing Offset(20), Present Position(132) and the notes on when it
is brought back within one turn. In the reverse sense the angle is mirrored about the middle of the
turn, 2048; the offset keeps its sign.
"""

from __future__ import annotations

import math

from enpointe.hardware.emulator.memory import Memory
from enpointe.hardware.units import CENTRE, PULSE, REVOLUTION

__all__ = ["Horn"]

_REVERSE = 0x01
_POSITION_MODE = 3
_NARROW = 1024
"""A homing offset beyond this is ignored in position mode."""


class Horn:
    """The position sensor of one servo.

    Attributes:
        sense: 1, or -1 in the reverse sense of rotation.
        speed: rad/s, in the plant's sense.
    """

    def __init__(self, memory: Memory) -> None:
        self._memory = memory
        self._angle = 0.0
        self._zero = 0.0
        self._homing = 0
        self.sense = 1
        self.speed = 0.0

    def settings_changed(self) -> None:
        """Look at mode, drive mode and offset again."""
        memory = self._memory
        self.sense = -1 if memory["Drive Mode"] & _REVERSE else 1
        offset = memory["Homing Offset"]
        narrow = memory["Operating Mode"] == _POSITION_MODE
        self._homing = 0 if narrow and abs(offset) > _NARROW else offset

    def move(self, angle: float, speed: float) -> None:
        """Where the plant has it, rad and rad/s."""
        self._angle, self.speed = angle, speed

    def within_one_turn(self) -> None:
        """Forget the turns made."""
        self._zero = REVOLUTION * math.floor(self._count() / REVOLUTION)

    @property
    def position(self) -> int:
        """Present Position, pulses."""
        return math.floor(self._count() - self._zero) + self._homing

    @property
    def rate(self) -> float:
        """pulses/s, in the servo's own sense."""
        return self.sense * self.speed / PULSE

    def _count(self) -> float:
        return CENTRE + self.sense * self._angle / PULSE
