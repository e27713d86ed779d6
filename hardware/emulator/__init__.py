"""A bus of Dynamixel servos that isn't there, faithful enough for the real dynamixel-sdk."""

from __future__ import annotations

from enpointe.hardware.clock import Clock, VirtualClock, WallClock
from enpointe.hardware.emulator.bus import Bus, Supply, Written
from enpointe.hardware.emulator.description import (
    BusDescription,
    ServoDescription,
    bus_of,
    load_bus,
)
from enpointe.hardware.emulator.fault_run import FaultRun
from enpointe.hardware.emulator.faults import Fault, FaultKind, faults_from, load_faults
from enpointe.hardware.emulator.plant import GearedPlant, Load, Loads, Plant
from enpointe.hardware.emulator.port import EmulatedPort
from enpointe.hardware.emulator.servo import Servo
from enpointe.hardware.emulator.terminal import launch

__all__ = [
    "Bus",
    "BusDescription",
    "Clock",
    "EmulatedPort",
    "Fault",
    "FaultKind",
    "FaultRun",
    "GearedPlant",
    "Load",
    "Loads",
    "Plant",
    "Servo",
    "ServoDescription",
    "Supply",
    "VirtualClock",
    "WallClock",
    "Written",
    "bus_of",
    "faults_from",
    "launch",
    "load_bus",
    "load_faults",
]
