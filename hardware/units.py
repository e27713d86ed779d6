"""What one count of a register is worth, in SI units.

Source of all: ROBOTIS e-manual, control tables of the X series (emanual.robotis.com/docs/en/dxl/x).
"""

from __future__ import annotations

import math

__all__ = [
    "ACCELERATION",
    "BAUD_RATES",
    "CENTRE",
    "FULL_PWM",
    "PULSE",
    "RETURN_DELAY",
    "REVOLUTION",
    "TENTH_VOLT",
    "VELOCITY",
    "WATCHDOG",
]

REVOLUTION = 4096
"""Pulses in one turn of the horn."""
CENTRE = 2048
"""Pulses where the horn's mark points up: the middle of one turn, taken as 0 rad."""
PULSE = 2.0 * math.pi / REVOLUTION
"""rad, of Present Position and Goal Position."""
VELOCITY = 0.229 * 2.0 * math.pi / 60.0
"""rad/s, of every velocity: 0.229 rev/min."""
ACCELERATION = 214.577 * 2.0 * math.pi / 3600.0
"""rad/s^2, of Profile Acceleration: 214.577 rev/min^2."""
FULL_PWM = 885
"""Counts of PWM at which the motor has the whole supply: 0.113 % each."""
TENTH_VOLT = 0.1
"""V, of voltages and their limits."""
RETURN_DELAY = 2e-6
"""s, of Return Delay Time."""
WATCHDOG = 0.020
"""s, of Bus Watchdog."""
BAUD_RATES = (9_600, 57_600, 115_200, 1_000_000, 2_000_000, 3_000_000, 4_000_000, 4_500_000)
"""bit/s, by the value of Baud Rate(8)."""
