"""Real bodies and their stand-ins: servos on a bus, their registers and packets, the emulated bus.

Example:
    >>> from enpointe.hardware import control_table, datasheet
    >>> table = control_table(datasheet("XM430-W350").number)
    >>> table["Goal Position"].address
    116
"""

from __future__ import annotations

from enpointe.hardware.control_table import ControlTable, Register, control_table
from enpointe.hardware.datasheet import ServoModel, datasheet, datasheet_of, servo_models

__all__ = [
    "ControlTable",
    "Register",
    "ServoModel",
    "control_table",
    "datasheet",
    "datasheet_of",
    "servo_models",
]
