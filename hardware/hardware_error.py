"""What a servo's Hardware Error Status(70) says, and its Shutdown(63) names."""

from __future__ import annotations

from enum import IntFlag

__all__ = ["HardwareError"]


class HardwareError(IntFlag):
    """Bits of both registers; source: e-manual, x/<model>, Shutdown(63)."""

    INPUT_VOLTAGE = 0x01
    OVERHEATING = 0x04
    ENCODER = 0x08
    ELECTRICAL_SHOCK = 0x10
    OVERLOAD = 0x20
