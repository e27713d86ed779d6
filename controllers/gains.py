"""Stiffness and damping of joints, from the inertia they move and the weight they carry.

A joint that only moves a limb gets a natural frequency: stiffness I w^2 and damping 2 z I w, with I
the inertia of everything beyond it. A joint between a foot on the floor and the trunk carries the
body, an inverted pendulum that topples unless the ankles' stiffness exceeds m g h in all: it gets
its share of what people standing quietly show, 1.5 m g h of stiffness (Peterka 2002, J.
Neurophysiol. 88:1097-1118, whose subjects' effective stiffness lies between 1.2 and 1.8 m g h).
"""

from __future__ import annotations

from dataclasses import dataclass

import mujoco
import numpy as np
from numpy.typing import NDArray

from enpointe.controllers.plant import Plant

__all__ = ["Gains"]

Array = NDArray[np.float64]
LIMB_FREQUENCY = 2 * np.pi * 3.0
"""rad/s. Natural frequencies of voluntarily stiffened arms are 2 to 5 Hz."""
LIMB_DAMPING_RATIO = 0.7
STANCE_STIFFNESS = 1.5
"""Of m g h, all feet together (Peterka 2002)."""
STANCE_DAMPING = 0.18
"""Of m g h, s, all feet together: half of what Peterka's subjects show (0.3 to 0.45 s), which
includes their delayed reflexes."""


@dataclass(frozen=True, slots=True)
class Gains:
    """Gains of every actuated joint.

    Attributes:
        stiffness: (nu,), N m/rad.
        damping: (nu,), N m s/rad.
    """

    stiffness: Array
    damping: Array

    @classmethod
    def suggested(cls, model: mujoco.MjModel, qpos: Array) -> Gains:
        """Gains for a body about to dance from `qpos` (nq,).

        Args:
            model: A free root and hinges driven by torques.
            qpos: Its first pose, with the feet that carry it on the floor.
        """
        plant = Plant(model)
        plant.place(qpos)
        inertia = plant.joint_inertia()
        stiffness = inertia * LIMB_FREQUENCY**2
        damping = 2 * LIMB_DAMPING_RATIO * inertia * LIMB_FREQUENCY
        feet = plant.standing_bodies()
        if feet:
            toppling = plant.mass * plant.gravity * plant.com[2] / len(feet)
            bearing = plant.bearing_actuators(feet)
            stiffness[bearing] = STANCE_STIFFNESS * toppling
            damping[bearing] = STANCE_DAMPING * toppling
        return cls(stiffness, damping)
