"""Between joints in SI units and registers in counts, for one rig, all servos at once."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from enpointe.hardware.rig_file import Rig
from enpointe.hardware.units import CENTRE, PULSE, TENTH_VOLT, VELOCITY

__all__ = ["Codec"]

Array = NDArray[np.float64]
Counts = NDArray[np.int64]


@dataclass(frozen=True, slots=True)
class Codec:
    """servo angle = sign * joint angle + offset; 2048 pulses are a servo angle of zero.

    All arrays are in the order of the rig's servos.

    Attributes:
        sign: (n,), 1 or -1.
        offset: (n,), rad.
        low: (n,), least Goal Position within the joint's limits, pulses.
        high: (n,), most.
        ampere: (n,), A a count of Present Current; where a model has only Present Load, what a
            thousandth of full duty gives at standstill.
        torque: (n,), N m an ampere at the horn before friction.
    """

    sign: Array
    offset: Array
    low: Counts
    high: Counts
    ampere: Array
    torque: Array

    @classmethod
    def of(cls, rig: Rig) -> Codec:
        """For a rig's servos."""
        sheets = [servo.sheet for servo in rig.servos]
        return cls(
            sign=np.array([float(servo.sign) for servo in rig.servos]),
            offset=np.array([math.radians(servo.offset) for servo in rig.servos]),
            low=np.array([servo.pulse_limits[0] for servo in rig.servos]),
            high=np.array([servo.pulse_limits[1] for servo in rig.servos]),
            ampere=np.array([s.current_unit or s.stall_current * 1e-3 for s in sheets]),
            torque=np.array([s.torque_constant for s in sheets]),
        )

    def pulses(self, angle: Array) -> Array:
        """Goal Position of joint angles (rad), not rounded and not limited."""
        return CENTRE + (self.sign * angle + self.offset) / PULSE

    def angle(self, pulses: Array | Counts) -> Array:
        """Joint angles, rad, of Present or Goal Position."""
        return np.asarray(self.sign * ((pulses - CENTRE) * PULSE - self.offset))

    def degrees(self, place: int, pulses: int) -> float:
        """One joint's angle, for people."""
        return math.degrees(float(self.angle(np.full(len(self.sign), pulses))[place]))

    def velocity(self, counts: Counts) -> Array:
        """Joint velocities, rad/s, of Present Velocity."""
        return np.asarray(self.sign * counts * VELOCITY)

    def current(self, counts: Counts) -> Array:
        """A, in the joint's sense, of Present Current (or Present Load)."""
        return np.asarray(self.sign * counts * self.ampere)

    def effort(self, counts: Counts) -> Array:
        """Torques of the motors, N m, in the joint's sense, of Present Current (or Load)."""
        return self.current(counts) * self.torque

    @staticmethod
    def volts(counts: int) -> float:
        """V of Present Input Voltage."""
        return counts * TENTH_VOLT
