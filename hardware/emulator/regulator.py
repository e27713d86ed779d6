"""The loop inside a servo: goals and gains in, a share of the supply out.

Source of the structure and of the gains' divisors: e-manual, Position PID Gain(80, 82, 84),
Feedforward Gains(88, 90), Velocity PI Gain(76, 78), Operating Mode(11). The manual says neither
how often the loop runs nor in which unit a rate is; here it runs once a millisecond and rates are
counts a millisecond. P needs no such guess: 800 makes an XM430-W350 at 12 V as stiff as 19 N m/rad,
and mujoco_menagerie gives those of OP3 21.
"""

from __future__ import annotations

from enum import IntEnum

from enpointe.hardware.emulator.memory import Memory
from enpointe.hardware.emulator.motor import Motor
from enpointe.hardware.emulator.profile import Profile, velocity_step
from enpointe.hardware.units import ACCELERATION, FULL_PWM, PULSE, VELOCITY

__all__ = ["Mode", "Regulator"]

_VELOCITY = VELOCITY / PULSE
"""pulses/s a count of velocity."""
_ACCELERATION = ACCELERATION / PULSE
"""pulses/s^2 a count of acceleration."""
_TIME_BASED = 0x04
_MILLISECOND = 1e-3


class Mode(IntEnum):
    """Operating Mode(11)."""

    CURRENT = 0
    VELOCITY = 1
    POSITION = 3
    EXTENDED_POSITION = 4
    CURRENT_BASED_POSITION = 5
    PWM = 16

    @property
    def follows_position(self) -> bool:
        """Whether Goal Position is what it follows."""
        return self in (Mode.POSITION, Mode.EXTENDED_POSITION, Mode.CURRENT_BASED_POSITION)


class Regulator:
    """The loop of one servo, in the servo's own sense of rotation.

    Args:
        memory: Where goals, gains and limits are read.
        motor: Whose current the current modes rule.
    """

    def __init__(self, memory: Memory, motor: Motor) -> None:
        self._memory = memory
        self._motor = motor
        self.profile = Profile(0.0)
        self._integral = 0.0
        self._before = 0.0
        self._stopped = False

    def start(self, position: float) -> None:
        """Hold a position (pulses), with nothing remembered."""
        self.profile.stop_at(position)
        self._integral = self._before = 0.0
        self._stopped = False

    def stop(self, position: float) -> None:
        """Stand still as the bus watchdog asks, until a goal comes."""
        self.start(position)
        self._stopped = True

    def new_goal(self, register: str) -> None:
        """A goal register was written."""
        self._stopped = False
        memory = self._memory
        if register != "Goal Position":
            return
        goal = float(memory["Goal Position"])
        speed, rise = memory["Profile Velocity"], memory["Profile Acceleration"]
        if memory["Drive Mode"] & _TIME_BASED:
            self.profile.aim_in(goal, speed * _MILLISECOND, rise * _MILLISECOND)
        else:
            self.profile.aim(goal, speed * _VELOCITY, rise * _ACCELERATION)

    def duty(
        self,
        position: int,
        speed: float,
        supply: float,
        period: float,
        *,
        rotor: float | None = None,
    ) -> float:
        """The share of the supply for the next period, -1 to 1.

        Args:
            position: Present Position, pulses.
            speed: pulses/s.
            supply: V.
            period: s.
            rotor: Velocity of the motor's side of the gears, pulses/s; as the horn's if None. A
                current is regulated against what the motor's own turning takes of the voltage.
        """
        turning = speed if rotor is None else rotor
        mode = self._memory.values["Operating Mode"]
        if mode in (Mode.POSITION, Mode.EXTENDED_POSITION):
            return self._within_pwm(self._position(position, speed, period, FULL_PWM) / FULL_PWM)
        if mode == Mode.CURRENT_BASED_POSITION:
            limit = abs(self._memory["Goal Current"])
            return self._current(self._position(position, speed, period, limit), turning, supply)
        if mode == Mode.VELOCITY:
            return self._within_pwm(self._velocity(speed, period) / FULL_PWM)
        if self._stopped:
            return 0.0
        if mode == Mode.CURRENT:
            return self._current(self._memory["Goal Current"], turning, supply)
        return self._within_pwm(self._memory["Goal PWM"] / FULL_PWM)

    def _position(self, position: int, speed: float, period: float, limit: int) -> float:
        """PID with feed-forward on the profile, in counts of PWM or of current."""
        memory, profile = self._memory.values, self.profile
        earlier = profile.position
        profile.advance(period)
        rate = profile.position - earlier
        error = profile.position - position
        self._integral += error * memory["Position I Gain"] / 65_536
        self._integral = min(max(self._integral, -limit), limit)
        wanted = error * memory["Position P Gain"] / 128 + self._integral
        wanted += (rate - speed * period) * memory["Position D Gain"] / 16
        wanted += rate * memory["Feedforward 1st Gain"] / 4
        wanted += (rate - self._before) * memory["Feedforward 2nd Gain"] / 4
        self._before = rate
        return min(max(wanted, -limit), limit)

    def _velocity(self, speed: float, period: float) -> float:
        """PI on the ramp towards Goal Velocity, in counts of PWM."""
        memory, profile = self._memory.values, self.profile
        goal = 0.0 if self._stopped else memory["Goal Velocity"] * _VELOCITY
        profile.velocity = velocity_step(profile.velocity, goal, self._ramp(goal), period)
        error = (profile.velocity - speed) / _VELOCITY
        self._integral += error * memory["Velocity I Gain"] / 65_536
        self._integral = min(max(self._integral, -FULL_PWM), FULL_PWM)
        return error * memory["Velocity P Gain"] / 128 + self._integral

    def _ramp(self, goal: float) -> float:
        """pulses/s^2 of the velocity mode: a rate, or in the time-based profile a time to goal."""
        rise = 0 if self._stopped else self._memory["Profile Acceleration"]
        if self._memory["Drive Mode"] & _TIME_BASED:
            return abs(goal) / (rise * _MILLISECOND) if rise else 0.0
        return rise * _ACCELERATION

    def _current(self, counts: float, speed: float, supply: float) -> float:
        """The share of the supply that gives a current, within Goal PWM."""
        unit = self._motor.model.current_unit or 0.0
        return self._within_pwm(self._motor.duty_for(counts * unit, supply, speed * PULSE))

    def _within_pwm(self, duty: float) -> float:
        most = abs(self._memory.values["Goal PWM"]) / FULL_PWM
        return min(max(duty, -most), most)
