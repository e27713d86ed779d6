"""What each servo of a rig can do at its joint: the datasheet's line, and the rig's own limits.

At the horn, with the dry friction f of the gears against the velocity w,

    I = (torque + f sign w) / k_t,        V = R I + k_e w,

and |V| is at most the supply: the torque-speed line of the datasheet, from stall torque at rest to
no torque at the no-load speed, for every direction of both. R, k_t and k_e are `ServoModel`'s.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from enpointe.errors import RigError
from enpointe.hardware.datasheet import ServoModel
from enpointe.hardware.demand import Demand
from enpointe.hardware.time_scale import Rows
from enpointe.hardware.units import PULSE

if TYPE_CHECKING:
    from enpointe.hardware.rig_file import Rig

__all__ = ["RESERVE", "JointLimit", "currents", "joint_rows", "limits_of"]

Array = NDArray[np.float64]
RESERVE = 0.05
"""Of the supply, kept for the servo's own regulator to correct with."""
_RESTING = 0.02
"""rad/s: a slower joint rests, and friction helps to hold it."""


@dataclass(frozen=True, slots=True)
class JointLimit:
    """A servo at a joint.

    Attributes:
        joint: Its name.
        model: Datasheet of its servo.
        lower: rad.
        upper: rad.
        speed: rad/s that the rig allows; None for as fast as the motor turns.
        current: A that the rig allows; None for the most that the servo can be set to.
        voltage: V of the supply; the datasheet's if None.
        reserve: Share of the supply that is not to be used.
    """

    joint: str
    model: ServoModel
    lower: float
    upper: float
    speed: float | None = None
    current: float | None = None
    voltage: float | None = None
    reserve: float = RESERVE

    @property
    def usable_voltage(self) -> float:
        """V."""
        supply = self.model.voltage if self.voltage is None else self.voltage
        return supply * (1.0 - self.reserve)

    @property
    def greatest_speed(self) -> float:
        """rad/s, the rig's limit or the speed without load at the usable voltage."""
        model = self.model
        idle = model.friction / model.torque_constant * model.resistance
        free = (self.usable_voltage - idle) / model.back_emf
        return free if self.speed is None else min(self.speed, free)

    @property
    def greatest_acceleration(self) -> float:
        """rad/s^2, the stall torque on the rotor alone: no servo gets faster quicker."""
        return self.model.stall_torque / self.model.armature

    @property
    def greatest_current(self) -> float:
        """A, the least of the rig's limit, what Current Limit can be, and the stall current."""
        model = self.model
        bounds = [model.stall_current]
        if self.current is not None:
            bounds.append(self.current)
        if model.current_limit is not None and model.current_unit is not None:
            bounds.append(model.current_limit * model.current_unit)
        return min(bounds)

    def torque_left(self, speed: float) -> float:
        """N m at the horn that the usable voltage gives at a speed in the torque's direction."""
        return self.model.torque_at(speed, self.usable_voltage)


def limits_of(
    rig: Rig, *, voltage: float | None = None, reserve: float = RESERVE
) -> tuple[JointLimit, ...]:
    """The joints of a rig, in its order.

    Args:
        rig: Whose range, speed and current are kept.
        voltage: V of its supply; each servo's recommended one if None.
        reserve: Share of the supply that is not to be used.

    Raises:
        RigError: A reserve that leaves nothing, or a voltage that a servo does not take.
    """
    if not 0.0 <= reserve < 1.0:
        raise RigError(f"a reserve is a share of the supply below 1, not {reserve:g}")
    for servo in rig.servos:
        low, high = servo.sheet.voltage_limits
        if voltage is not None and not low <= voltage <= high:
            raise RigError(f"a {servo.model} ({servo.joint}) takes {low:g} to {high:g} V")
    return tuple(
        JointLimit(
            servo.joint,
            servo.sheet,
            *servo.range,
            servo.top_speed,
            servo.current * 1e-3 or None,
            voltage,
            reserve,
        )
        for servo in rig.servos
    )


def currents(demand: Demand, limits: Sequence[JointLimit], speed: float = 1.0) -> Array:
    """(T, J), A that the motors need when a movement is danced at a share of its speed."""
    constants = _column(limits, "torque_constant")
    torque = demand.static + _friction(demand, limits) + speed**2 * demand.dynamic
    return np.asarray(torque / constants)


def joint_rows(demand: Demand, limits: Sequence[JointLimit]) -> list[Rows]:
    """What each joint must keep at each moment; of its range, to the pulse that a servo can tell.

    Args:
        demand: The movement.
        limits: In the order of its joints.
    """
    zero = np.zeros_like(demand.position)
    low, high = (np.array([getattr(x, n) for x in limits]) for n in ("lower", "upper"))
    half, middle = 0.5 * (high - low) + PULSE, 0.5 * (high + low)
    speed = np.array([x.greatest_speed for x in limits])
    rise = np.array([x.greatest_acceleration for x in limits])
    most = np.array([x.greatest_current for x in limits])
    volts = np.array([x.usable_voltage for x in limits])
    constant, resistance = _column(limits, "torque_constant"), _column(limits, "resistance")
    hold = (demand.static + _friction(demand, limits)) / constant
    move = demand.dynamic / constant
    back = _column(limits, "back_emf") * demand.velocity / volts
    drop = resistance / volts
    found = []
    for sign in (1.0, -1.0):
        found += [
            _rows("position", zero, zero, sign * (demand.position - middle) / half),
            _rows("speed", zero, sign * demand.velocity / speed, zero),
            _rows("acceleration", sign * demand.acceleration / rise, zero, zero),
            _rows("torque", sign * drop * move, sign * back, sign * drop * hold),
            _rows("current", sign * move / most, zero, sign * hold / most),
        ]
    return found


def _rows(kind: str, square: Array, linear: Array, constant: Array) -> Rows:
    samples, joints = np.indices(square.shape)
    terms = (square.ravel(), linear.ravel(), constant.ravel() - 1.0)
    return Rows(kind, joints.ravel(), samples.ravel(), *terms)


def _friction(demand: Demand, limits: Sequence[JointLimit]) -> Array:
    """(T, J), N m of dry friction, against the motion."""
    moving = np.abs(demand.velocity) > _RESTING
    return np.asarray(np.sign(demand.velocity) * moving * _column(limits, "friction"))


def _column(limits: Sequence[JointLimit], name: str) -> Array:
    return np.array([getattr(each.model, name) for each in limits])
