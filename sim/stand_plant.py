"""A body of servos hung by its trunk on a stand: how a puppet is first tried, feet off the floor.

What stands behind the horns of an emulated bus (structurally a `Plant` of
`enpointe.hardware.emulator`, which this room does not know). The trunk is held upright and still by
the stand, gravity and every limb's inertia are there, a floor is not.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import mujoco
import numpy as np
from numpy.typing import NDArray

from enpointe.errors import BodyError
from enpointe.sim.gear_play import with_play
from enpointe.sim.horns import Horns

__all__ = ["StandPlant"]

Array = NDArray[np.float64]


class StandPlant(Horns):
    """A MuJoCo body without its free root.

    Args:
        spec: A body on a free root with hinges; copied, never changed.
        angles: rad at first, of each joint.
        joints: The joint of each servo, in the order of the bus.
        signs: 1, or -1 where a servo turns the other way than its joint; all 1 without.
        offsets: rad that a servo has where its joint is at zero; all 0 without.
        play: rad of play in the gears, by joint; none without (see `with_play`).

    Raises:
        BodyError: A joint that the body lacks, a play that is none, or no free root.
    """

    def __init__(
        self,
        spec: mujoco.MjSpec,
        angles: Array,
        joints: Sequence[str],
        *,
        signs: Sequence[float] | None = None,
        offsets: Sequence[float] | None = None,
        play: Mapping[str, float] | None = None,
    ) -> None:
        model = with_play(_hung(spec), play or {})
        known = [model.joint(j).name for j in range(model.njnt)]
        if missing := [joint for joint in joints if joint not in known]:
            raise BodyError(f"the body has no joint {', '.join(missing)}")
        super().__init__(model, joints, signs, offsets)
        self.data.qpos[self._qpos] = angles
        self._seat()

    def advance(self, torque: Sequence[float], period: float) -> None:
        """Go on by a period (s) under the motors' torques (N m)."""
        self.data.qfrc_applied[self._rotors] = self._joint_torque(torque)
        for _ in range(round(period / self.model.opt.timestep)):
            mujoco.mj_step(self.model, self.data)


def _hung(spec: mujoco.MjSpec) -> mujoco.MjSpec:
    hung = spec.copy()
    roots = [joint for joint in hung.joints if joint.type == mujoco.mjtJoint.mjJNT_FREE]
    if len(roots) != 1:
        raise BodyError(f"a body on a stand has one free root, not {len(roots)}")
    hung.delete(roots[0])
    for key in list(hung.keys):
        hung.delete(key)
    for geom in hung.geoms:
        if geom.type == mujoco.mjtGeom.mjGEOM_PLANE:
            geom.contype = geom.conaffinity = 0
    return hung
