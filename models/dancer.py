"""The dancer: an MJCF humanoid with a free root, built from anthropometry.

Every body frame is upright (x forward, y left, z up) when all joints are zero: the dancer then
stands with parallel feet and hanging arms, palms to the thighs. Names are `left_hand`,
`right_shank` and so on; joints as in `enpointe.models.anatomy`; sites mark the points that
notation and rules speak of: wrists, elbows, fingertips, heels, balls and toes.
"""

from __future__ import annotations

from collections.abc import Iterable
from functools import lru_cache

import mujoco
import numpy as np

from enpointe.models import anatomy
from enpointe.models.anatomy import (
    NECK_RISE,
    SIDES,
    SOLE_RADIUS,
    Hinge,
    Skeleton,
    mirrored,
    side_sign,
)
from enpointe.models.anthropometry import Anthropometry, Segment
from enpointe.models.contact_geometry import (
    add_floor,
    add_limb_contacts,
    add_pointe_shoes,
    add_soles,
)

__all__ = ["TIMESTEP", "build_dancer", "dancer_model", "dancer_spec"]

TIMESTEP = 0.001
"""Physics step, s. With light hands and toes, PD torques need 1 ms (see docs/physics.md)."""


def build_dancer(
    measures: Anthropometry | None = None, *, flesh: bool = True, pointe_shoes: bool = False
) -> mujoco.MjModel:
    """Compile the dancer.

    Args:
        measures: Height, mass and sex; a dancer of 1.68 m and 54 kg without.
        flesh: Clothe her; a bare one moves the same and is built and copied faster.
        pointe_shoes: Give her a platform to stand on pointe; soft shoes without.

    Returns:
        A model of 36 hinges on a free root (nq 43, nv 42, nu 36), with its floor.
    """
    return dancer_spec(
        measures or Anthropometry(), flesh=flesh, pointe_shoes=pointe_shoes
    ).compile()


@lru_cache(maxsize=4)
def dancer_model(
    measures: Anthropometry | None = None, *, flesh: bool = True, pointe_shoes: bool = False
) -> mujoco.MjModel:
    """The same dancer, compiled once a process. Treat it as read-only; copy it to change it."""
    return build_dancer(measures, flesh=flesh, pointe_shoes=pointe_shoes)


def dancer_spec(
    measures: Anthropometry, *, flesh: bool = True, pointe_shoes: bool = False
) -> mujoco.MjSpec:
    """The dancer as an `MjSpec`, for those who want to change it before compiling."""
    skeleton = Skeleton(measures)
    spec = mujoco.MjSpec()
    spec.modelname = "dancer"
    _set_options(spec)
    add_floor(spec)
    pelvis = _add_trunk(spec, skeleton)
    torso = spec.body("torso")
    for side in SIDES:
        _add_arm(torso, skeleton, side)
    for side in SIDES:
        _add_leg(pelvis, skeleton, side)
    add_limb_contacts(spec, skeleton)
    add_soles(spec, skeleton)
    if pointe_shoes:
        add_pointe_shoes(spec, skeleton)
    if flesh:
        from enpointe.models.flesh import add_flesh

        add_flesh(spec, skeleton)
    _add_muscles(spec, skeleton)
    spec.add_key(name="standing", qpos=_standing(skeleton))
    return spec


def _set_options(spec: mujoco.MjSpec) -> None:
    spec.option.timestep = TIMESTEP
    spec.option.integrator = mujoco.mjtIntegrator.mjINT_IMPLICITFAST
    spec.option.cone = mujoco.mjtCone.mjCONE_ELLIPTIC
    # MuJoCo 4.0.0 gives Newton a wrong Hessian when the constraint Jacobian is sparse.
    spec.option.jacobian = mujoco.mjtJacobian.mjJAC_DENSE
    spec.compiler.degree = False
    # Soft light from the eye: raised arms turn away from every lamp and would go dark.
    spec.visual.headlight.ambient = [0.42, 0.41, 0.40]
    spec.visual.headlight.diffuse = [0.34, 0.34, 0.34]
    spec.visual.headlight.specular = [0.0, 0.0, 0.0]
    # Wide enough that the shadow map's edge does not speckle the floor in the picture.
    spec.visual.map.shadowclip = 4.0
    spec.visual.global_.offwidth = 1920
    spec.visual.global_.offheight = 1080


def _add_trunk(spec: mujoco.MjSpec, skeleton: Skeleton) -> mujoco.MjsBody:
    measures = skeleton.measures
    pelvis = spec.worldbody.add_body(name="pelvis", pos=[0, 0, skeleton.hip_height])
    pelvis.add_freejoint(name="root")
    lower = measures.segment("lower_trunk")
    _set_inertia(pelvis, lower, (0, 0, lower.length - lower.com))

    torso = pelvis.add_body(name="torso", pos=[0, 0, skeleton.waist_height])
    _add_hinges(torso, anatomy.WAIST, side=None)
    _set_torso_inertia(torso, skeleton)

    head = torso.add_body(name="head", pos=[0, 0, skeleton.torso_length + NECK_RISE])
    _add_hinges(head, anatomy.NECK, side=None)
    skull = measures.segment("head")
    # De Leva measures the head's centre down from the vertex.
    above_neck = skeleton.head_and_neck - NECK_RISE - skull.com
    _set_inertia(head, skull, (0.005, 0, above_neck))
    crown = skeleton.head_and_neck - NECK_RISE
    head.add_site(group=SITE_GROUP, name="crown", pos=[0, 0, crown])
    head.add_site(group=SITE_GROUP, name="eyes", pos=[0.09, 0, crown - 0.115])
    return pelvis


SITE_GROUP = 4
"""Hidden by default in MuJoCo's viewers."""


def _set_torso_inertia(torso: mujoco.MjsBody, skeleton: Skeleton) -> None:
    """Join the middle and upper trunk into one rigid torso (parallel-axis theorem)."""
    middle = skeleton.measures.segment("middle_trunk")
    upper = skeleton.measures.segment("upper_trunk")
    heights = np.array([middle.length - middle.com, middle.length + upper.length - upper.com])
    masses = np.array([middle.mass, upper.mass])
    centre = float(masses @ heights / masses.sum())
    shifts = masses * (heights - centre) ** 2
    sagittal, transverse, longitudinal = np.array(middle.inertia) + np.array(upper.inertia)
    _set_explicit(
        torso,
        float(masses.sum()),
        (0, 0, centre),
        (sagittal + shifts.sum(), transverse + shifts.sum(), longitudinal),
    )


def _hang(
    parent: mujoco.MjsBody,
    place: tuple[float, float, float],
    measures: Anthropometry,
    side: str,
    segment: str,
    joint: str,
    hinges: tuple[Hinge, ...],
) -> mujoco.MjsBody:
    """One segment of a limb, hanging from its joint at a place of its parent."""
    body = parent.add_body(name=f"{side}_{segment}", pos=place)
    _add_hinges(body, hinges, side)
    _set_hanging_inertia(body, measures.segment(segment))
    body.add_site(group=SITE_GROUP, name=f"{side}_{joint}", pos=[0, 0, 0])
    return body


def _add_arm(torso: mujoco.MjsBody, skeleton: Skeleton, side: str) -> None:
    s = side_sign(side)
    measures = skeleton.measures
    shoulder = (0, s * skeleton.shoulder_half_width, skeleton.torso_length - skeleton.shoulder_drop)
    upper = _hang(torso, shoulder, measures, side, "upper_arm", "shoulder", anatomy.SHOULDER)
    elbow = (0, 0, -skeleton.upper_arm)
    forearm = _hang(upper, elbow, measures, side, "forearm", "elbow", anatomy.ELBOW)
    wrist = (0, 0, -skeleton.forearm)
    hand = _hang(forearm, wrist, measures, side, "hand", "wrist", anatomy.WRIST)
    hand.add_site(group=SITE_GROUP, name=f"{side}_fingertips", pos=[0, 0, -0.101 * measures.height])


def _add_leg(pelvis: mujoco.MjsBody, skeleton: Skeleton, side: str) -> None:
    s = side_sign(side)
    measures = skeleton.measures
    hip = (0, s * skeleton.hip_half_width, 0)
    thigh = _hang(pelvis, hip, measures, side, "thigh", "hip", anatomy.HIP)
    knee = (0, 0, -skeleton.thigh)
    shank = _hang(thigh, knee, measures, side, "shank", "knee", anatomy.KNEE)

    foot = shank.add_body(name=f"{side}_foot", pos=[0, 0, -skeleton.shank])
    _add_hinges(foot, anatomy.ANKLE, side)
    sole = -skeleton.ankle_height
    segment = measures.segment("foot")
    com = -skeleton.heel_back + segment.com / segment.length * skeleton.foot_length
    _set_explicit(
        foot,
        segment.mass * (1 - TOE_MASS_SHARE),
        (com - 0.012, 0, sole + 0.035),
        (segment.inertia[2], segment.inertia[1], segment.inertia[0]),
    )
    foot.add_site(group=SITE_GROUP, name=f"{side}_ankle", pos=[0, 0, 0])
    foot.add_site(group=SITE_GROUP, name=f"{side}_heel", pos=[-skeleton.heel_back, 0, sole])
    foot.add_site(group=SITE_GROUP, name=f"{side}_ball", pos=[skeleton.ball_forward, 0, sole])

    toe = foot.add_body(name=f"{side}_toe", pos=[skeleton.ball_forward, 0, sole + SOLE_RADIUS])
    _add_hinges(toe, anatomy.TOE, side)
    mass = segment.mass * TOE_MASS_SHARE
    size = np.array([skeleton.toe_length, 2 * skeleton.ball_half_breadth, 0.025])
    box = mass / 12 * (np.sum(size**2) - size**2)
    _set_explicit(toe, mass, (0.5 * skeleton.toe_length, 0, 0.003), tuple(box))
    toe.add_site(
        group=SITE_GROUP, name=f"{side}_toe_tip", pos=[skeleton.toe_length, 0, -SOLE_RADIUS]
    )


TOE_MASS_SHARE = 0.15
"""Share of the foot's mass in front of the toe joint: a box of a fifth of its volume, rounded."""


def _add_hinges(body: mujoco.MjsBody, hinges: Iterable[Hinge], side: str | None) -> None:
    for hinge in hinges:
        body.add_joint(
            name=hinge.name if side is None else f"{side}_{hinge.name}",
            type=mujoco.mjtJoint.mjJNT_HINGE,
            axis=hinge.axis if side is None else mirrored(hinge.axis, side),
            range=np.deg2rad(hinge.range_deg),
            limited=mujoco.mjtLimited.mjLIMITED_TRUE,
            armature=hinge.armature,
            damping=[hinge.damping, 0, 0],
        )


def _set_inertia(body: mujoco.MjsBody, segment: Segment, com: tuple[float, float, float]) -> None:
    _set_explicit(body, segment.mass, com, segment.inertia)


def _set_hanging_inertia(body: mujoco.MjsBody, segment: Segment) -> None:
    """A limb that hangs from its proximal joint."""
    _set_inertia(body, segment, (0, 0, -segment.com))


def _set_explicit(
    body: mujoco.MjsBody,
    mass: float,
    com: tuple[float, float, float],
    inertia: tuple[float, ...],
) -> None:
    body.explicitinertial = True
    body.mass = mass
    body.ipos = com
    body.inertia = inertia


def _add_muscles(spec: mujoco.MjSpec, skeleton: Skeleton) -> None:
    """A torque source at every hinge, bounded by what a trained dancer has."""
    for name, hinge in skeleton.hinges():
        limit = hinge.strength * skeleton.measures.mass
        actuator = spec.add_actuator(
            name=name,
            target=name,
            trntype=mujoco.mjtTrn.mjTRN_JOINT,
            forcerange=[-limit, limit],
            forcelimited=mujoco.mjtLimited.mjLIMITED_TRUE,
            ctrlrange=[-limit, limit],
            ctrllimited=mujoco.mjtLimited.mjLIMITED_TRUE,
        )
        actuator.set_to_motor()


def _standing(skeleton: Skeleton) -> list[float]:
    return [0, 0, skeleton.hip_height, 1, 0, 0, 0] + [0.0] * sum(1 for _ in skeleton.hinges())
