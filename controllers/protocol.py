"""What a body and a controller say to each other."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol, runtime_checkable

import numpy as np
from numpy.typing import NDArray

__all__ = ["Body", "Command", "Controller", "State"]

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class State:
    """What a body knows of itself at one moment.

    Attributes:
        time: s from the start of the performance.
        qpos: (nq,). A body without a root sensor leaves the root where its model has it.
        qvel: (nv,).
        effort: (nu,) torques that the joints give, N m.
        age: (nu,) s since each joint was really read; zero for a simulated body.
        valid: (nu,) whether each joint's reading can be trusted.
    """

    time: float
    qpos: Array
    qvel: Array
    effort: Array
    age: Array
    valid: NDArray[np.bool_]


@dataclass(frozen=True, slots=True)
class Command:
    """What a controller asks of the joints: a target, a stiffness towards it, and a torque besides.

    A body realises  tau = torque + stiffness (position - q) + damping (velocity - v),  within its
    limits, at its own inner rate: muscles and servos alike are springs with a moving rest length.

    Attributes:
        position: (nu,) joint targets, rad.
        velocity: (nu,) joint velocity targets, rad/s.
        torque: (nu,) feed-forward, N m.
        stiffness: (nu,) N m/rad.
        damping: (nu,) N m s/rad.
    """

    position: Array
    velocity: Array
    torque: Array
    stiffness: Array
    damping: Array


@runtime_checkable
class Controller(Protocol):
    """What drives a body."""

    def reset(self, state: State) -> None:
        """Begin a performance from `state`."""

    def command(self, t: float, state: State) -> Command:
        """The command to hold until the next period, at `t` seconds."""


@runtime_checkable
class Body(Protocol):
    """What is driven: simulated, of servos, or haptic.

    Attributes:
        period: s between two commands.
        fault: Why the body can't go on (fallen, diverged, a servo's alarm), or None.
    """

    period: float
    fault: str | None

    def read(self) -> State:
        """The state now."""

    def write(self, command: Command) -> None:
        """Take a command and let one period pass."""

    def observe(self) -> dict[str, NDArray[np.generic]]:
        """What else the body noticed during the last period, the same keys and shapes each time."""
