"""A dancer who is pushed: the one force from outside that a performance may have, and shows."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import mujoco
import numpy as np
from numpy.typing import NDArray

from enpointe.controllers import Command
from enpointe.sim.body import CONTROL_PERIOD, SimulatedBody

__all__ = ["Push", "PushedBody", "largest_push"]

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class Push:
    """A constant force for a short time.

    Attributes:
        start: s.
        impulse: (3,), N s in the world; the force is impulse / duration.
        duration: s.
        body: Name of the body whose centre of mass it acts on.
    """

    start: float
    impulse: tuple[float, float, float]
    duration: float = 0.1
    body: str = "pelvis"


class PushedBody(SimulatedBody):
    """A simulated body that is pushed.

    The push is measured as `root_force` like any other help or hindrance.

    Args:
        pushes: Those that act.
        model: The dancer.
        qpos: (nq,), where it starts.
        qvel: (nv,), at rest if None.
        period: s between commands.
    """

    def __init__(
        self,
        pushes: Sequence[Push],
        model: mujoco.MjModel,
        qpos: Array,
        qvel: Array | None = None,
        *,
        period: float = CONTROL_PERIOD,
    ) -> None:
        super().__init__(model, qpos, qvel, period=period)
        self._pushes = tuple((push, self.model.body(push.body).id) for push in pushes)

    def write(self, command: Command) -> None:
        """Take a command and let one period pass, pushed at its whole length or not at all."""
        now = self.read().time + 0.5 * self.period
        self.data.xfrc_applied[:] = 0.0
        for push, body in self._pushes:
            if push.start <= now < push.start + push.duration:
                self.data.xfrc_applied[body, :3] += np.array(push.impulse) / push.duration
        super().write(command)


def largest_push(
    distance: float, height: float, mass: float, gravity: float, duration: float
) -> float:
    """The largest impulse that fixed feet can take up without swinging arms or trunk, N s.

    The extrapolated centre of mass xi obeys  xi' = omega (xi - p) + F / (m omega)  with the centre
    of pressure p inside the foot and omega = sqrt(g / height) (Hof et al. 2005). With p at the edge
    from the first moment, xi ends a push of T seconds at the edge, beyond which nothing helps, for

        J = m omega distance * omega T / (1 - exp(-omega T)).

    Args:
        distance: From the centre of mass to the edge in the push's direction, m.
        height: Of the centre of mass, m.
        mass: kg.
        gravity: m/s^2.
        duration: T, s; 0 is a blow.
    """
    omega = float(np.sqrt(gravity / height))
    blow = mass * omega * distance
    lasting = omega * duration
    return blow * (lasting / (1.0 - float(np.exp(-lasting))) if lasting > 0.0 else 1.0)
