"""Gears with play: between the motor's side and the horn there is an angle in which nothing holds.

Each servo's rotor becomes a body of its own, beside the puppet and weightless, that turns with the
rotor's inertia (as the horn feels it) and the gears' friction; horn and rotor are tied by a limit
on the angle between them. Within the play no torque passes; at its ends teeth meet, and hardly
bounce. It is the dead zone of Nordin and Gutman (2002), *Controlling mechanical systems with
backlash: a survey*, Automatica 38(10):1633-1649, with teeth as stiff as a step of 1 ms allows. The
limit pulls both ways alike, between a joint's two sides, so that nothing acts on the root; without
any play it would be the joint with armature that it was. Floor and stops stay as stiff as they
were, too: MuJoCo reckons their stiffness from inertias (invweight0), rotors included.

That friction is all on the motor's side is ours; of a gear train of 1:350 most of it is.
"""

from __future__ import annotations

from collections.abc import Mapping

import mujoco
import numpy as np

from enpointe.errors import BodyError

__all__ = ["rotor_of", "with_play"]

_ROTOR, _GEARS = "_rotor", "_gears"
_WEIGHTLESS = 1e-9
"""kg and kg m^2 of a rotor's body: MuJoCo wants some, the inertia that counts is its armature."""
_TEETH = (0.002, 1.0)
"""MuJoCo's solref, the stiffest that steps of 1 ms follow, critically damped."""
_TEETH_GIVE = (0.95, 0.99, 1e-4, 0.5, 2.0)
"""Its solimp: under a servo's stall torque teeth give less than a hundredth of a degree."""


def with_play(spec: mujoco.MjSpec, play: Mapping[str, float]) -> mujoco.MjModel:
    """The model of a body whose servos' gears have play.

    Places and dofs of the body come first, as they were; those of its rotors come after them. With
    any play at all, poses kept in it (keyframes) are left out.

    Args:
        spec: A body with a hinge for each servo; copied, never changed.
        play: rad from one end of the play to the other, by joint; joints that are not there, or
            have 0, stay as they are.

    Raises:
        BodyError: No such joint, or a play that is none.
    """
    rigid = spec.compile()
    if not any(play.values()):
        return rigid
    geared = spec.copy()
    joints = {joint.name: joint for joint in geared.joints}
    for name, width in play.items():
        if name not in joints:
            raise BodyError(f"the body has no joint {name}")
        if not 0.0 <= width < np.pi:
            raise BodyError(f"the play of {name} must be an angle of 0 or more, not {width:g} rad")
        if width:
            _loosen(geared, joints[name], width)
    for key in list(geared.keys):
        geared.delete(key)
    model = geared.compile()
    model.body_invweight0[: rigid.nbody] = rigid.body_invweight0
    model.dof_invweight0[: rigid.nv] = rigid.dof_invweight0
    for name, width in play.items():
        if width:
            armature = float(rigid.dof_armature[rigid.joint(name).dofadr[0]])
            model.tendon_invweight0[model.tendon(name + _GEARS).id] = 1.0 / armature
    return model


def rotor_of(model: mujoco.MjModel, joint: str) -> int:
    """The hinge that a joint's motor turns: its rotor's, or its own where gears have no play."""
    rotor = mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_JOINT, joint + _ROTOR)
    return rotor if rotor >= 0 else int(model.joint(joint).id)


def _loosen(spec: mujoco.MjSpec, joint: mujoco.MjsJoint, width: float) -> None:
    name = joint.name + _ROTOR
    body = spec.worldbody.add_body(
        name=name, mass=_WEIGHTLESS, inertia=[_WEIGHTLESS] * 3, explicitinertial=True
    )
    body.add_joint(
        name=name,
        type=mujoco.mjtJoint.mjJNT_HINGE,
        axis=[0, 0, 1],
        armature=joint.armature,
        frictionloss=joint.frictionloss,
    )
    joint.armature = 0.0
    joint.frictionloss = 0.0
    for actuator in spec.actuators:
        if actuator.target == joint.name:
            actuator.target = name
    gears = spec.add_tendon(
        name=joint.name + _GEARS,
        limited=mujoco.mjtLimited.mjLIMITED_TRUE,
        range=[-0.5 * width, 0.5 * width],
        solref_limit=_TEETH,
        solimp_limit=_TEETH_GIVE,
    )
    gears.wrap_joint(joint.name, 1.0)
    gears.wrap_joint(name, -1.0)
