"""Pieces that bodies of servos are put together from: hinges, cases, soles, limbs, the stage."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

import mujoco
import numpy as np
from numpy.typing import NDArray

from enpointe.models.contact_geometry import FLOOR, SOLE_CLASS, add_floor
from enpointe.models.puppet.gearmotor import GEARMOTORS, Gearmotor

__all__ = [
    "ALUMINIUM",
    "DARK",
    "TIMESTEP",
    "Workbench",
    "quat_to",
]

Vec = Sequence[float] | NDArray[np.float64]
TIMESTEP = 0.001
"""Physics step, s: that of the emulated servos' own loop."""
DARK = (0.16, 0.16, 0.18, 1.0)
ALUMINIUM = (0.66, 0.68, 0.71, 1.0)
_FLOOR_CLASS, _LIMB_CLASS = 1, 4
_DRAWN, _TOUCHING, _MARKS = 1, 3, 4
_FRICTION = (1.0, 0.005, 0.0001)
_SOLREF = (0.005, 1.0)
"""Half the dancer's time constant: a body of a third of her height moves faster."""
_SOLIMP = (0.95, 0.99, 0.0005, 0.5, 2.0)


@dataclass
class Workbench:
    """A model under construction.

    Attributes:
        spec: The model.
        motors: Of each joint so far, in the order in which they were added.
    """

    spec: mujoco.MjSpec
    motors: dict[str, Gearmotor] = field(default_factory=dict)

    @classmethod
    def named(cls, name: str) -> Workbench:
        """An empty stage with a floor, gravity and light."""
        spec = mujoco.MjSpec()
        spec.modelname = name
        spec.option.timestep = TIMESTEP
        spec.option.integrator = mujoco.mjtIntegrator.mjINT_IMPLICITFAST
        spec.option.cone = mujoco.mjtCone.mjCONE_ELLIPTIC
        # MuJoCo 4.0.0 gives Newton a wrong Hessian when the constraint Jacobian is sparse.
        spec.option.jacobian = mujoco.mjtJacobian.mjJAC_DENSE
        spec.compiler.degree = False
        spec.visual.headlight.ambient = [0.42, 0.41, 0.40]
        spec.visual.headlight.diffuse = [0.34, 0.34, 0.34]
        spec.visual.headlight.specular = [0.0, 0.0, 0.0]
        spec.visual.map.shadowclip = 1.5
        spec.visual.global_.offwidth = 1920
        spec.visual.global_.offheight = 1080
        add_floor(spec)
        spec.material("boards").texrepeat = [6, 6]
        spec.geom(FLOOR).solref = _SOLREF
        spec.geom(FLOOR).solimp = _SOLIMP
        return cls(spec)

    def hinge(
        self, body: mujoco.MjsBody, name: str, axis: Vec, degrees: tuple[float, float], servo: str
    ) -> None:
        """A servo's axis: its rotor's inertia and its gears' friction are the joint's."""
        motor = GEARMOTORS[servo]
        body.add_joint(
            name=name,
            type=mujoco.mjtJoint.mjJNT_HINGE,
            axis=axis,
            range=np.deg2rad(degrees),
            limited=mujoco.mjtLimited.mjLIMITED_TRUE,
            armature=motor.armature,
            frictionloss=motor.friction,
        )
        self.motors[name] = motor

    def add_motors(self) -> None:
        """A torque source at every hinge, bounded by the servo's stall torque."""
        for name, motor in self.motors.items():
            limit = motor.stall_torque
            actuator = self.spec.add_actuator(
                name=name,
                target=name,
                trntype=mujoco.mjtTrn.mjTRN_JOINT,
                forcerange=[-limit, limit],
                forcelimited=mujoco.mjtLimited.mjLIMITED_TRUE,
                ctrlrange=[-limit, limit],
                ctrllimited=mujoco.mjtLimited.mjLIMITED_TRUE,
            )
            actuator.set_to_motor()

    def case(
        self, body: mujoco.MjsBody, joint: str, servo: str, pos: Vec, axis: Vec, along: Vec
    ) -> None:
        """The case of a joint's servo, in the body that carries it.

        Args:
            body: What it is screwed to.
            joint: Whose servo it is.
            servo: Its model.
            pos: Centre of the case.
            axis: Of its horn.
            along: Its long side.
        """
        motor = GEARMOTORS[servo]
        width, height, depth = motor.dimensions
        self.box(
            body,
            f"{joint}_servo",
            motor.mass,
            pos,
            (width, height, depth),
            DARK,
            quat=quat_to(axis, along),
        )

    def box(
        self,
        body: mujoco.MjsBody,
        name: str,
        mass: float,
        pos: Vec,
        size: Vec,
        rgba: Vec,
        *,
        quat: Vec = (1.0, 0.0, 0.0, 0.0),
    ) -> None:
        """A drawn box with a mass; `size` is its full width, height and depth."""
        self._part(
            body, name, mass, rgba, mujoco.mjtGeom.mjGEOM_BOX,
            pos=pos, quat=quat, size=0.5 * np.asarray(size),
        )  # fmt: skip

    def ball(
        self, body: mujoco.MjsBody, name: str, mass: float, pos: Vec, size: Vec, rgba: Vec
    ) -> None:
        """A drawn ellipsoid of half axes `size` with a mass."""
        self._part(body, name, mass, rgba, mujoco.mjtGeom.mjGEOM_ELLIPSOID, pos=pos, size=size)

    def bar(
        self,
        body: mujoco.MjsBody,
        name: str,
        mass: float,
        start: Vec,
        end: Vec,
        radius: float,
        rgba: Vec,
    ) -> None:
        """A drawn capsule with a mass."""
        self._part(
            body, name, mass, rgba, mujoco.mjtGeom.mjGEOM_CAPSULE,
            fromto=[*start, *end], size=[radius, 0, 0],
        )  # fmt: skip

    def _part(
        self,
        body: mujoco.MjsBody,
        name: str,
        mass: float,
        rgba: Vec,
        kind: mujoco.mjtGeom,
        **shape: object,
    ) -> None:
        body.add_geom(
            name=name, type=kind, mass=mass, rgba=rgba, group=_DRAWN,
            contype=0, conaffinity=0, **shape,
        )  # fmt: skip

    def sole(self, body: mujoco.MjsBody, name: str, pos: Vec, radius: float) -> None:
        """A stud that meets the floor and nothing else."""
        body.add_geom(
            name=name,
            type=mujoco.mjtGeom.mjGEOM_SPHERE,
            size=[radius, 0, 0],
            pos=pos,
            mass=0.0,
            contype=SOLE_CLASS,
            conaffinity=_FLOOR_CLASS,
            condim=3,
            friction=_FRICTION,
            solref=_SOLREF,
            solimp=_SOLIMP,
            group=_TOUCHING,
            rgba=[0.8, 0.3, 0.3, 1],
        )

    def touching(
        self, body: mujoco.MjsBody, start: Vec, end: Vec, radius: float, part: str = "limb"
    ) -> None:
        """A capsule that meets the floor and other limbs."""
        self._limb(
            body, part, mujoco.mjtGeom.mjGEOM_CAPSULE,
            fromto=[*start, *end], size=[radius, 0, 0],
        )  # fmt: skip

    def touching_box(self, body: mujoco.MjsBody, pos: Vec, size: Vec, part: str = "limb") -> None:
        """A box that does, of full width, depth and height `size`."""
        self._limb(body, part, mujoco.mjtGeom.mjGEOM_BOX, pos=pos, size=0.5 * np.asarray(size))

    def _limb(self, body: mujoco.MjsBody, part: str, kind: mujoco.mjtGeom, **shape: object) -> None:
        body.add_geom(
            name=f"{body.name}_{part}",
            type=kind,
            **shape,
            mass=0.0,
            contype=_LIMB_CLASS,
            conaffinity=_LIMB_CLASS,
            condim=3,
            friction=(0.5, 0.005, 0.0001),
            group=_TOUCHING,
            rgba=[0.3, 0.4, 0.8, 0.4],
        )

    def apart(self, first: str, second: str) -> None:
        """Two bodies with a joint of several servos between them never meet."""
        self.spec.add_exclude(name=f"{first}-{second}", bodyname1=first, bodyname2=second)

    def mark(self, body: mujoco.MjsBody, name: str, pos: Vec) -> None:
        """A point that notation and rules speak of."""
        body.add_site(group=_MARKS, name=name, pos=pos)


def quat_to(axis: Vec, along: Vec) -> NDArray[np.float64]:
    """w x y z of the rotation that puts z on `axis` and y as near to `along` as it can."""
    z = np.asarray(axis, dtype=float) / np.linalg.norm(axis)
    y = np.asarray(along, dtype=float)
    y = y - (y @ z) * z
    y /= np.linalg.norm(y)
    quat = np.zeros(4)
    mujoco.mju_mat2Quat(quat, np.column_stack([np.cross(y, z), y, z]).ravel())
    return quat
