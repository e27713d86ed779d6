"""What a movement asks of servos, as numbers: no engine, no bus.

Under a uniform time scale, every moment t coming at k t with k > 0, and with s = 1/k for the speed
that is left,

    velocity -> s velocity,  acceleration -> s^2 acceleration,  torque -> static + s^2 dynamic,

since weight does not depend on speed and every other term of the equation of motion is of second
degree in it (Hollerbach 1984, Trans. ASME J. Dyn. Syst. Meas. Control 106:102-106).
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import NDArray

from enpointe.errors import RigError

__all__ = ["Collision", "Demand", "GroundRows"]

Array = NDArray[np.float64]


@dataclass(frozen=True)
class GroundRows:
    """Something that the floor can't give, as inequalities  constant + dynamic s^2 <= 0.

    Attributes:
        kind: "balance", "friction", "push" or "flight".
        unit: Of both sides: "m" or "of weight".
        sample: (K,), which sample of the movement each row is of.
        constant: (K,).
        dynamic: (K,).
    """

    kind: str
    unit: str
    sample: NDArray[np.int64]
    constant: Array
    dynamic: Array


@dataclass(frozen=True, slots=True)
class Collision:
    """Two parts of a body in one another.

    Attributes:
        first: Name of a part.
        second: Name of the other.
        start: s.
        end: s.
        time: s, when it is worst.
        depth: m, then.
    """

    first: str
    second: str
    start: float
    end: float
    time: float
    depth: float


@dataclass(frozen=True)
class Demand:
    """A movement of T samples of J joints.

    Attributes:
        joints: Their names.
        time: (T,), s, increasing.
        position: (T, J), rad.
        velocity: (T, J), rad/s.
        acceleration: (T, J), rad/s^2.
        static: (T, J), N m at the horn to hold still there, dry friction not counted.
        dynamic: (T, J), N m beside that to move so, the rotor's own inertia counted.
        ground: What the floor must allow; nothing for a body that hangs on a stand.
        collisions: What of the body is in its way.
    """

    joints: tuple[str, ...]
    time: Array
    position: Array
    velocity: Array
    acceleration: Array
    static: Array
    dynamic: Array
    ground: tuple[GroundRows, ...] = field(default=(), repr=False)
    collisions: tuple[Collision, ...] = ()

    def __post_init__(self) -> None:
        """Check shapes.

        Raises:
            RigError: They don't fit one another, or times do not increase.
        """
        shape = (len(self.time), len(self.joints))
        for name in ("position", "velocity", "acceleration", "static", "dynamic"):
            if (found := getattr(self, name).shape) != shape:
                raise RigError(f"{name} must have shape {shape}, got {found}")
        if len(self.time) < 2 or not np.all(np.diff(self.time) > 0):
            raise RigError("times must increase, and be two at least")

    @property
    def torque(self) -> Array:
        """(T, J), N m at the horn as it is written."""
        return np.asarray(self.static + self.dynamic)

    def scaled(self, time_scale: float) -> Demand:
        """The same movement in `time_scale` times the time."""
        speed = 1.0 / time_scale
        return replace(
            self,
            time=self.time * time_scale,
            velocity=self.velocity * speed,
            acceleration=self.acceleration * speed**2,
            dynamic=self.dynamic * speed**2,
            ground=tuple(replace(g, dynamic=g.dynamic * speed**2) for g in self.ground),
            collisions=tuple(
                replace(
                    c, start=c.start * time_scale, end=c.end * time_scale, time=c.time * time_scale
                )
                for c in self.collisions
            ),
        )

    def of_joints(self, joints: tuple[str, ...]) -> Demand:
        """The same for some joints, in their order.

        Raises:
            RigError: A joint that the movement does not have.
        """
        missing = [joint for joint in joints if joint not in self.joints]
        if missing:
            raise RigError(f"the movement has no joint {', '.join(missing)}")
        order = [self.joints.index(joint) for joint in joints]
        names = ("position", "velocity", "acceleration", "static", "dynamic")
        return replace(self, joints=joints, **{n: getattr(self, n)[:, order] for n in names})
