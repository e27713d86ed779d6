"""A rig of Dynamixel servos: the bus and its owner, codecs, checks, safety, and the body of it all."""

from __future__ import annotations

from enpointe.hardware.dynamixel.checks import Finding, check_rig
from enpointe.hardware.dynamixel.gate import CommandGate
from enpointe.hardware.dynamixel.layout import Layout
from enpointe.hardware.dynamixel.link import Link, Lost
from enpointe.hardware.dynamixel.pacing import Lateness, Pacer
from enpointe.hardware.dynamixel.rig import Ending, ServoRig, Statistics
from enpointe.hardware.dynamixel.stopping import StopButton
from enpointe.hardware.dynamixel.supervisor import SafetyLimits, Severity, Supervisor, Verdict

__all__ = [
    "CommandGate",
    "Ending",
    "Finding",
    "Lateness",
    "Layout",
    "Link",
    "Lost",
    "Pacer",
    "SafetyLimits",
    "ServoRig",
    "Severity",
    "Statistics",
    "StopButton",
    "Supervisor",
    "Verdict",
    "check_rig",
]
