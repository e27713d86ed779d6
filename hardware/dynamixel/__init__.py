"""A rig of Dynamixel servos: the bus and its owner, codecs, checks, safety, the body."""

from __future__ import annotations

from typing import TYPE_CHECKING

from enpointe.lazy import lazy

if TYPE_CHECKING:
    from enpointe.hardware.dynamixel.checks import Finding as Finding
    from enpointe.hardware.dynamixel.checks import check_rig as check_rig
    from enpointe.hardware.dynamixel.emulated import description_of as description_of
    from enpointe.hardware.dynamixel.gate import CommandGate as CommandGate
    from enpointe.hardware.dynamixel.layout import Layout as Layout
    from enpointe.hardware.dynamixel.link import Link as Link
    from enpointe.hardware.dynamixel.link import PortLostError as PortLostError
    from enpointe.hardware.dynamixel.pacing import Lateness as Lateness
    from enpointe.hardware.dynamixel.pacing import Pacer as Pacer
    from enpointe.hardware.dynamixel.ports import open_port as open_port
    from enpointe.hardware.dynamixel.rig import Ending as Ending
    from enpointe.hardware.dynamixel.rig import ServoRig as ServoRig
    from enpointe.hardware.dynamixel.rig import Statistics as Statistics
    from enpointe.hardware.dynamixel.stopping import StopButton as StopButton
    from enpointe.hardware.dynamixel.supervisor import SafetyLimits as SafetyLimits
    from enpointe.hardware.dynamixel.supervisor import Severity as Severity
    from enpointe.hardware.dynamixel.supervisor import Supervisor as Supervisor
    from enpointe.hardware.dynamixel.supervisor import Verdict as Verdict

_HOMES = {
    "CommandGate": "enpointe.hardware.dynamixel.gate",
    "Ending": "enpointe.hardware.dynamixel.rig",
    "Finding": "enpointe.hardware.dynamixel.checks",
    "Lateness": "enpointe.hardware.dynamixel.pacing",
    "Layout": "enpointe.hardware.dynamixel.layout",
    "Link": "enpointe.hardware.dynamixel.link",
    "PortLostError": "enpointe.hardware.dynamixel.link",
    "Pacer": "enpointe.hardware.dynamixel.pacing",
    "SafetyLimits": "enpointe.hardware.dynamixel.supervisor",
    "ServoRig": "enpointe.hardware.dynamixel.rig",
    "Severity": "enpointe.hardware.dynamixel.supervisor",
    "Statistics": "enpointe.hardware.dynamixel.rig",
    "StopButton": "enpointe.hardware.dynamixel.stopping",
    "Supervisor": "enpointe.hardware.dynamixel.supervisor",
    "Verdict": "enpointe.hardware.dynamixel.supervisor",
    "check_rig": "enpointe.hardware.dynamixel.checks",
    "description_of": "enpointe.hardware.dynamixel.emulated",
    "open_port": "enpointe.hardware.dynamixel.ports",
}

__all__ = [
    "CommandGate",
    "Ending",
    "Finding",
    "Lateness",
    "Layout",
    "Link",
    "Pacer",
    "PortLostError",
    "SafetyLimits",
    "ServoRig",
    "Severity",
    "Statistics",
    "StopButton",
    "Supervisor",
    "Verdict",
    "check_rig",
    "description_of",
    "open_port",
]
__getattr__, __dir__ = lazy(__name__, _HOMES)
