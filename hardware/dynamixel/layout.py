"""Where a rig's joints stand in the arrays of a model that the rig itself does not know."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from enpointe.errors import RigError
from enpointe.hardware.rig_file import Rig

__all__ = ["Layout"]

Places = NDArray[np.int64]


@dataclass(frozen=True, slots=True)
class Layout:
    """Places of the rig's servos, in the rig's order, in `State` and `Command`.

    Attributes:
        actuator: (n,) in command and effort.
        qpos: (n,) in qpos.
        dof: (n,) in qvel.
        nu: Number of actuators.
        nv: Of velocities.
        rest: (nq,) qpos with all that no servo measures where it is to be shown, the root included.
    """

    actuator: Places
    qpos: Places
    dof: Places
    nu: int
    nv: int
    rest: NDArray[np.float64]

    @classmethod
    def of(
        cls,
        rig: Rig,
        joints: Sequence[str],
        qpos: Sequence[int],
        dof: Sequence[int],
        rest: NDArray[np.float64],
        nv: int,
    ) -> Layout:
        """For a model whose actuators drive these joints.

        Args:
            rig: The servos.
            joints: Name of the joint of each actuator.
            qpos: Place of each in qpos.
            dof: Place of each in qvel.
            rest: (nq,).
            nv: Number of velocities.

        Raises:
            RigError: The rig has a joint that the model has not, or lacks one that it has.
        """
        lacking = [name for name in rig.joints if name not in joints]
        beyond = [name for name in joints if name not in rig.joints]
        if lacking or beyond:
            names = ", ".join([*lacking, *beyond][:5])
            who = "the movement's body" if lacking else f"the rig {rig.name!r}"
            raise RigError(f"{who} has no joint {names}; the movement must be of the rig's body")
        places = [list(joints).index(name) for name in rig.joints]
        return cls(
            actuator=np.array(places),
            qpos=np.array([qpos[place] for place in places]),
            dof=np.array([dof[place] for place in places]),
            nu=len(joints),
            nv=nv,
            rest=np.asarray(rest, dtype=float).copy(),
        )

    @classmethod
    def bare(cls, rig: Rig) -> Layout:
        """For a rig alone: qpos is its joints and nothing else."""
        numbers = list(range(len(rig.servos)))
        return cls.of(rig, rig.joints, numbers, numbers, np.zeros(len(numbers)), len(numbers))
