"""How warm a servo gets: one lump of metal and plastic in still air.

    C dT/dt = R I^2 - h A (T - T_air)

The model is ours: the specific heat of metal and plastic together 700 J/(kg K), h = 10 W/(m^2 K)
over the case's whole surface (textbook values for natural convection); an XM430-W350 stalled for
good reaches its limit of 80 C from 25 C in about two minutes.
"""

from __future__ import annotations

from dataclasses import dataclass

from enpointe.hardware.datasheet import ServoModel

__all__ = ["ROOM", "HeatLump"]

ROOM = 25.0
"""Degrees Celsius of the air."""
_SPECIFIC_HEAT = 700.0
_CONVECTION = 10.0


@dataclass(frozen=True, slots=True)
class HeatLump:
    """What a servo's case takes up and gives off.

    Attributes:
        capacity: C, J/K.
        loss: h A, W/K.
    """

    capacity: float
    loss: float

    @classmethod
    def of(cls, model: ServoModel) -> HeatLump:
        """A model's, from its mass and the size of its case."""
        width, height, depth = model.dimensions
        area = 2.0 * (width * height + height * depth + depth * width)
        return cls(_SPECIFIC_HEAT * model.mass, _CONVECTION * area)
