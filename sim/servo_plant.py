"""A body of servos on the simulated stage: torques in each millisecond, angles out.

What stands behind the horns of an emulated bus, in place of loads that know nothing of one another
(structurally a `Plant` of `enpointe.hardware.emulator`, which this room does not know): a MuJoCo
body on a free root, with gravity and contact and no other help. The motors' torques are all that is
put in; rotor inertia and the gears' friction are the model's own.
"""

from __future__ import annotations

import copy
from collections.abc import Sequence

import mujoco
import numpy as np
from numpy.typing import NDArray

from enpointe.errors import BodyError
from enpointe.sim.body import FALLEN, has_diverged, help_on_root, refuse_help
from enpointe.sim.contacts import ContactReader
from enpointe.sim.gear_play import rotor_of
from enpointe.sim.horns import Horns

__all__ = ["ServoPlant"]

Array = NDArray[np.float64]


class ServoPlant(Horns):
    """A MuJoCo body that servos turn.

    Until it is let go it is held as it stands, by hands that bear all of it, as a puppet is while
    its servos are switched on.

    Args:
        model: A body on a free root with a torque source at every hinge, and play in its gears if
            `with_play` gave it some; copied, never changed.
        qpos: (nq,), where it is at first, without the rotors.
        joints: The joint of each servo, in the order of the bus.
        signs: 1, or -1 where a servo turns the other way than its joint; all 1 without.
        offsets: rad that a servo has where its joint is at zero; all 0 without.
        period: s between samples of what is recorded, a multiple of the model's time step.

    Attributes:
        held: Whether it is still held.
        fault: "fell" or "the simulation diverged", or None.

    Raises:
        BodyError: A joint that the model lacks, a pose that isn't one, a model with help that a
            dancer must not have.
    """

    def __init__(
        self,
        model: mujoco.MjModel,
        qpos: Array,
        joints: Sequence[str],
        *,
        signs: Sequence[float] | None = None,
        offsets: Sequence[float] | None = None,
        period: float = 0.01,
    ) -> None:
        refuse_help(model)
        own = copy.copy(model)
        # A servo that is driven backwards brakes with more than its stall torque.
        own.actuator_forcelimited[:] = 0
        own.actuator_ctrllimited[:] = 0
        driven = model.actuator_trnid[:, 0].tolist()
        names = [model.joint(j).name for j in range(model.njnt)]
        missing = [joint for joint in joints if joint not in names]
        if missing or sorted(rotor_of(model, joint) for joint in joints) != sorted(driven):
            raise BodyError(
                f"{len(joints)} servos can't turn the {model.nu} joints of this body"
                + (f"; it has no {', '.join(missing)}" if missing else "")
            )
        super().__init__(own, joints, signs, offsets)
        geared = int(np.count_nonzero(self._rotors != self._dofs))
        self._nq, self._nv = model.nq - geared, model.nv - geared
        if np.shape(qpos) != (self._nq,) or not np.isfinite(qpos).all():
            raise BodyError(f"qpos must be {self._nq} numbers, got shape {np.shape(qpos)}")
        self.data.qpos[: self._nq] = qpos
        self._seat()
        self.held = True
        self.fault: str | None = None
        self._actuator = np.array([driven.index(rotor_of(model, joint)) for joint in joints])
        self._first_height = float(self.data.subtree_com[0, 2])
        self._contacts = ContactReader(self.model)
        self._every = round(period / model.opt.timestep)
        self._steps = 0
        self._root_force = np.zeros(6)
        self._tape: dict[str, list[NDArray[np.generic]]] = {}

    @classmethod
    def of(
        cls,
        model: mujoco.MjModel,
        qpos: Array,
        servos: Sequence[tuple[str, int, float]],
        *,
        period: float = 0.01,
    ) -> ServoPlant:
        """Of joints with their servos' signs and offsets (rad)."""
        joints, signs, offsets = zip(*servos, strict=True)
        return cls(model, qpos, joints, signs=signs, offsets=offsets, period=period)

    # What the bus sees

    def advance(self, torque: Sequence[float], period: float) -> None:
        """Go on by a period (s) under the motors' torques (N m)."""
        if self.held:
            return
        data = self.data
        data.ctrl[self._actuator] = self._joint_torque(torque)
        for _ in range(round(period / self.model.opt.timestep)):
            mujoco.mj_step(self.model, data)
            np.maximum(self._root_force, help_on_root(data), out=self._root_force)
            self._contacts.read(data)
            self._steps += 1
            if self._steps % self._every == 0:
                self._note()
        if self.fault is None:
            self._judge()

    # What the hall sees

    def let_go(self) -> None:
        """Hands off: from now on it stands or falls by itself. Its record begins."""
        self.held = False

    def recorded(self) -> dict[str, NDArray[np.generic]]:
        """What was noted since it was let go, one row a period.

        Returns:
            time (N,) s; qpos (N, nq) and qvel (N, nv) of the body without rotors; effort (N, nu)
            N m; com (N, 3) m; root_force (N, 6), the most that anything but floor and gravity did
            to the root, zero on an honest stage; and the channels of `ContactReader`.
        """
        return {name: np.array(rows) for name, rows in self._tape.items()}

    def _note(self) -> None:
        data = self.data
        row: dict[str, NDArray[np.generic]] = {
            "time": np.array(self._steps * self.model.opt.timestep),
            "qpos": data.qpos[: self._nq].copy(),
            "qvel": data.qvel[: self._nv].copy(),
            "effort": data.actuator_force.copy(),
            "com": data.subtree_com[0].copy(),
            "root_force": self._root_force.copy(),
            **self._contacts.observed(),
        }
        for name, value in row.items():
            self._tape.setdefault(name, []).append(value)
        self._root_force[:] = 0.0

    def _judge(self) -> None:
        if has_diverged(self.data):
            self.fault = "the simulation diverged"
        elif self._contacts.lies or self.data.subtree_com[0, 2] < FALLEN * self._first_height:
            self.fault = "fell"
