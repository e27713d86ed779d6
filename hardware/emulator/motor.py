"""A DC motor behind gears: current from voltage and speed, torque from current, heat from current.

    I = (V - k_e w) / R        torque = k_t I

R, k_t and k_e follow from stall torque, stall current and no-load speed of the datasheet; how warm
it gets, from `HeatLump`.
"""

from __future__ import annotations

from enpointe.hardware.datasheet import ServoModel
from enpointe.hardware.heat import ROOM, HeatLump

__all__ = ["ROOM", "Motor"]


class Motor:
    """One servo's motor.

    Attributes:
        current: A through the winding; with the sign of the torque.
        torque: N m before the gears' friction.
        duty: Share of the supply that it has, -1 to 1.
        temperature: Degrees Celsius.
    """

    def __init__(self, model: ServoModel) -> None:
        self.model = model
        self.current = 0.0
        self.torque = 0.0
        self.duty = 0.0
        self.temperature = ROOM
        lump = HeatLump.of(model)
        self._loss, self._capacity = lump.loss, lump.capacity
        self._resistance = model.resistance
        self._torque_constant = model.torque_constant
        self._back_emf = model.back_emf

    def drive(self, duty: float, supply: float, speed: float, period: float) -> None:
        """Apply a share of the supply for one period.

        Args:
            duty: -1 to 1.
            supply: V.
            speed: Of the horn, rad/s.
            period: s.
        """
        self.duty = duty
        self.current = (duty * supply - self._back_emf * speed) / self._resistance
        self.torque = self._torque_constant * self.current
        self._heat(self.current**2 * self._resistance, period)

    def rest(self, period: float) -> None:
        """Let it run free for one period: an open circuit gives no torque."""
        self.duty = self.current = self.torque = 0.0
        self._heat(0.0, period)

    def duty_for(self, current: float, supply: float, speed: float) -> float:
        """The share of the supply that gives a current; what is beyond 1 can't be had."""
        if supply <= 0.0:
            return 0.0
        return (current * self._resistance + self._back_emf * speed) / supply

    @property
    def drawn(self) -> float:
        """A taken from the supply; what a braking motor gives back is burnt in the bridge."""
        return max(0.0, self.duty * self.current)

    def _heat(self, power: float, period: float) -> None:
        lost = self._loss * (self.temperature - ROOM)
        self.temperature += (power - lost) * period / self._capacity
