"""The dancer on the simulated stage: gravity, contact, muscles with limits, and nothing else.

No force acts on the root but gravity and the floor: the body applies joint torques only, and looks
at every step that nobody else applied anything either.
"""

from __future__ import annotations

import copy
from typing import Self

import mujoco
import numpy as np
from numpy.typing import NDArray

from enpointe.controllers import Command, State
from enpointe.errors import BodyError
from enpointe.motion import Motion
from enpointe.motion.gravity import GRAVITY
from enpointe.sim.contacts import ContactReader

__all__ = [
    "CONTROL_PERIOD",
    "FALLEN",
    "SimulatedBody",
    "has_diverged",
    "help_on_root",
    "refuse_help",
]

CONTROL_PERIOD = 0.002
"""s between commands: 500 Hz."""
FALLEN = 0.6
"""A dancer whose centre of mass is below this share of its first height has fallen."""
_COMMANDED = ("position", "velocity", "torque", "stiffness", "damping")
_WARNINGS = mujoco.mjtWarning
_DIVERGED = [
    int(warning)
    for warning in (_WARNINGS.mjWARN_BADQPOS, _WARNINGS.mjWARN_BADQVEL, _WARNINGS.mjWARN_BADQACC)
]


class SimulatedBody:
    """A MuJoCo body as a `Body`.

    Joints realise  tau = torque + K (position - q) + D (velocity - v)  as affine actuators within
    the model's force ranges, so that the integrator takes the springs' and dampers' derivatives
    into account (`implicitfast`).

    Args:
        model: The dancer; copied, never changed.
        qpos: (nq,), where it starts.
        qvel: (nv,), at rest if None.
        period: s between commands, a multiple of the model's time step.

    Raises:
        BodyError: The period is no multiple of the time step, or the model has help a dancer must
            not have (mocap bodies, equality constraints, disabled gravity or contact).
    """

    def __init__(
        self,
        model: mujoco.MjModel,
        qpos: NDArray[np.float64],
        qvel: NDArray[np.float64] | None = None,
        *,
        period: float = CONTROL_PERIOD,
    ) -> None:
        refuse_help(model)
        self._substeps = round(period / model.opt.timestep) if np.isfinite(period) else 0
        if self._substeps < 1 or abs(self._substeps * model.opt.timestep - period) > 1e-9:
            raise BodyError(
                f"the control period {period:g} s must be a multiple of the time step"
                f" {model.opt.timestep:g} s"
            )
        self.period = period
        self.fault: str | None = None
        self.model = _with_affine_actuators(model)
        self.data = mujoco.MjData(self.model)
        self.data.qpos[:] = _checked("qpos", qpos, model.nq)
        self.data.qvel[:] = 0.0 if qvel is None else _checked("qvel", qvel, model.nv)
        mujoco.mj_forward(self.model, self.data)
        self._first_com_height = float(self.data.subtree_com[0, 2])
        self._contacts = ContactReader(self.model)
        self._root_force = np.zeros(6)
        self._steps = 0
        self._fresh = np.zeros(self.model.nu)
        self._valid = np.ones(self.model.nu, dtype=bool)

    @classmethod
    def at_start_of(cls, motion: Motion, *, period: float = CONTROL_PERIOD) -> Self:
        """A body standing in a motion's first pose, at rest."""
        return cls(motion.model, motion.qpos[0], period=period)

    def read(self) -> State:
        """The state now; a simulated body knows all of it at once."""
        return State(
            time=self._steps * self.model.opt.timestep,
            qpos=self.data.qpos.copy(),
            qvel=self.data.qvel.copy(),
            effort=self.data.actuator_force.copy(),
            age=self._fresh,
            valid=self._valid,
        )

    def write(self, command: Command) -> None:
        """Take a command and let one period pass.

        Raises:
            BodyError: A command of the wrong shape, or with values that are not numbers.
        """
        self._check(command)
        model, data = self.model, self.data
        model.actuator_biasprm[:, 1] = -command.stiffness
        model.actuator_biasprm[:, 2] = -command.damping
        data.ctrl[:] = (
            command.torque
            + command.stiffness * command.position
            + command.damping * command.velocity
        )
        self._root_force[:] = 0.0
        self._steps += self._substeps
        for _ in range(self._substeps):
            mujoco.mj_step(model, data)
            if _is_helped(data):
                np.maximum(self._root_force, help_on_root(data), out=self._root_force)
        self._contacts.read(data)
        self._judge()

    def observe(self) -> dict[str, NDArray[np.generic]]:
        """Contacts and root force over the last period; see `ContactReader` for the shapes."""
        return {
            **self._contacts.observed(),
            "com": self.data.subtree_com[0].copy(),
            "root_force": self._root_force.copy(),
        }

    def _check(self, command: Command) -> None:
        values = [getattr(command, name) for name in _COMMANDED]
        shape = self._fresh.shape
        whole = all(np.shape(value) == shape for value in values)
        if not whole or not np.isfinite(np.concatenate(values)).all():
            for name, value in zip(_COMMANDED, values, strict=True):
                _checked(f"command {name}", value, self.model.nu)

    def _judge(self) -> None:
        if has_diverged(self.data):
            self.fault = "the simulation diverged"
        elif self._contacts.lies or self.data.subtree_com[0, 2] < FALLEN * self._first_com_height:
            self.fault = "fell"


def _checked(name: str, value: NDArray[np.float64], length: int) -> NDArray[np.float64]:
    array = np.asarray(value, dtype=float)
    if array.shape != (length,):
        raise BodyError(f"{name} must have shape ({length},), got {array.shape}")
    if not np.all(np.isfinite(array)):
        raise BodyError(f"{name} has values that are not numbers")
    return array


def has_diverged(data: mujoco.MjData) -> bool:
    """Whether the simulation has; MuJoCo then begins again by itself and leaves a warning."""
    return bool(data.warning.number[_DIVERGED].any())


def _is_helped(data: mujoco.MjData) -> bool:
    """Whether `help_on_root` is not zero: hardly ever, and far quicker to see than to add up."""
    return bool(
        np.count_nonzero(data.qfrc_applied[:6])
        or np.count_nonzero(data.qfrc_actuator[:6])
        or np.count_nonzero(data.qfrc_passive[:6])
        or np.count_nonzero(data.xfrc_applied)
    )


def help_on_root(data: mujoco.MjData) -> NDArray[np.float64]:
    """Force and moment on the root from anything but gravity, floor and the dancer's own limbs."""
    direct = np.abs(data.qfrc_applied[:6]) + np.abs(data.qfrc_actuator[:6])
    passive = np.abs(data.qfrc_passive[:6])
    pulls = np.abs(data.xfrc_applied).sum(axis=0)
    return np.asarray(direct + passive + pulls)


def refuse_help(model: mujoco.MjModel) -> None:
    """Raise `BodyError` if a stage would hold a dancer up by more than a floor."""
    if model.nmocap or model.neq:
        raise BodyError("a dancer has no mocap bodies and no equality constraints to hold on to")
    forbidden = mujoco.mjtDisableBit.mjDSBL_GRAVITY | mujoco.mjtDisableBit.mjDSBL_CONTACT
    earth = np.allclose(model.opt.gravity, [0.0, 0.0, -GRAVITY], atol=0.05)
    if model.opt.disableflags & forbidden or not earth:
        raise BodyError("gravity and contact must be on and the earth's; this stage has no others")
    if np.any(model.body_gravcomp) or np.any(model.dof_damping[:6]):
        raise BodyError("gravity compensation or a damped root would carry the dancer")


def _with_affine_actuators(model: mujoco.MjModel) -> mujoco.MjModel:
    """A copy whose torque sources take stiffness and damping with each command."""
    own = copy.copy(model)
    own.actuator_biastype[:] = mujoco.mjtBias.mjBIAS_AFFINE
    own.actuator_ctrllimited[:] = 0
    return own
