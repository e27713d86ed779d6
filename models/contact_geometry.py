"""What of the dancer can touch: soles on the floor, and limbs one another.

Three collision classes. The floor meets soles and limbs (a fallen dancer lies on it); soles meet
the floor alone; limbs meet limbs. Bodies joined by a joint never meet (MuJoCo's parent filter).
Limb shapes are slimmer than the flesh, by what flesh gives way.
"""

from __future__ import annotations

import mujoco

from enpointe.models.anatomy import NECK_RISE, SIDES, SOLE_RADIUS, Skeleton, side_sign

__all__ = [
    "FLOOR",
    "PLATFORM",
    "PLATFORM_RISE",
    "SOLE_CLASS",
    "add_floor",
    "add_limb_contacts",
    "add_pointe_shoes",
    "add_soles",
]

FLOOR = "floor"
SOLE_CLASS = 2
_FLOOR_CLASS, _LIMB_CLASS = 1, 4
COLLISION_GROUP = 3
FRICTION = (1.0, 0.005, 0.0001)
"""Sliding friction 1: a dry studio floor under canvas shoes; a parameter, not a finding."""
# Softer contacts lost one-foot demi-pointe in trials; these are a hard floor's.
_SOLREF = (0.01, 1.0)
_SOLIMP = (0.95, 0.99, 0.001, 0.5, 2.0)


def add_floor(spec: mujoco.MjSpec) -> None:
    """A sprung studio floor, wood coloured, with the light that shows it."""
    spec.add_texture(
        name="boards",
        type=mujoco.mjtTexture.mjTEXTURE_2D,
        builtin=mujoco.mjtBuiltin.mjBUILTIN_CHECKER,
        rgb1=[0.80, 0.74, 0.66],
        rgb2=[0.77, 0.71, 0.63],
        width=256,
        height=256,
    )
    textures = [""] * mujoco.mjtTextureRole.mjNTEXROLE
    textures[mujoco.mjtTextureRole.mjTEXROLE_RGB] = "boards"
    spec.add_material(name="boards", textures=textures, texrepeat=[2, 2], texuniform=True)
    spec.add_texture(
        name="backdrop",
        type=mujoco.mjtTexture.mjTEXTURE_SKYBOX,
        builtin=mujoco.mjtBuiltin.mjBUILTIN_GRADIENT,
        rgb1=[0.93, 0.92, 0.90],
        rgb2=[0.70, 0.69, 0.70],
        width=64,
        height=384,
    )
    spec.worldbody.add_geom(
        name=FLOOR,
        type=mujoco.mjtGeom.mjGEOM_PLANE,
        size=[20, 20, 0.1],
        material="boards",
        contype=_FLOOR_CLASS,
        conaffinity=SOLE_CLASS | _LIMB_CLASS,
        friction=FRICTION,
        solref=_SOLREF,
        solimp=_SOLIMP,
    )
    directional = mujoco.mjtLightType.mjLIGHT_DIRECTIONAL
    spec.worldbody.add_light(
        name="key",
        type=directional,
        pos=[2.5, 2.0, 5.0],
        dir=[-0.4, -0.25, -0.88],
        diffuse=[0.42, 0.41, 0.38],
    )
    spec.worldbody.add_light(
        name="fill",
        type=directional,
        pos=[2.0, -3.0, 3.0],
        dir=[-0.6, 0.55, -0.58],
        diffuse=[0.16, 0.17, 0.19],
        castshadow=False,
    )


def add_soles(spec: mujoco.MjSpec, skeleton: Skeleton) -> None:
    """Six spheres a foot: heel, ball and tip of the toes, an inner and an outer one of each.

    The ball's lie on the axis of the toe joint, so that one set serves the flat foot and
    demi-pointe, and belong to the toes, which stay where they are while the foot rises over them.
    """
    half = skeleton.ball_half_breadth - SOLE_RADIUS
    lift = SOLE_RADIUS - skeleton.ankle_height
    for side in SIDES:
        foot, toe = spec.body(f"{side}_foot"), spec.body(f"{side}_toe")
        for edge, s in (("inner", -side_sign(side)), ("outer", side_sign(side))):
            heel = [-skeleton.heel_back + SOLE_RADIUS, s * 0.55 * half, lift]
            _add_sole(foot, f"{side}_heel_{edge}", heel)
            _add_sole(toe, f"{side}_ball_{edge}", [0, s * half, 0])
            tip = [skeleton.toe_length - SOLE_RADIUS, s * 0.5 * half, 0]
            _add_sole(toe, f"{side}_tip_{edge}", tip)


def add_pointe_shoes(spec: mujoco.MjSpec, skeleton: Skeleton) -> None:
    """The corners of the platform at the toes' end, four small spheres a foot.

    In soft shoes the tip is a line of two spheres, on which nobody stands.
    """
    long, broad = PLATFORM
    end = skeleton.toe_length - _PLATFORM_RADIUS
    middle = PLATFORM_RISE - SOLE_RADIUS
    for side in SIDES:
        for edge, s in (("inner", -side_sign(side)), ("outer", side_sign(side))):
            for part, rise in (("under", -0.5 * long), ("upper", 0.5 * long)):
                corner = [end, s * 0.5 * broad, middle + rise]
                name = f"{side}_platform_{part}_{edge}"
                _add_sole(spec.body(f"{side}_toe"), name, corner, _PLATFORM_RADIUS)


PLATFORM = (0.03, 0.04)
"""Length and breadth of a pointe shoe's platform, m: 12 cm^2, ours, of a square box. Makers sell
narrow and broad ones; no measured area was found."""
PLATFORM_RISE = 0.025
"""Its middle above the sole, m: its lower edge is 7 mm off the floor when the foot is flat."""
_PLATFORM_RADIUS = 0.003


def _add_sole(
    body: mujoco.MjsBody, name: str, pos: list[float], radius: float = SOLE_RADIUS
) -> None:
    body.add_geom(
        name=name,
        type=mujoco.mjtGeom.mjGEOM_SPHERE,
        size=[radius, 0, 0],
        pos=pos,
        contype=SOLE_CLASS,
        conaffinity=_FLOOR_CLASS,
        condim=3,
        friction=FRICTION,
        solref=_SOLREF,
        solimp=_SOLIMP,
        group=COLLISION_GROUP,
        rgba=[0.8, 0.3, 0.3, 1],
    )


def add_limb_contacts(spec: mujoco.MjSpec, skeleton: Skeleton) -> None:
    """Capsules within the flesh of trunk, head and limbs."""
    size = skeleton.measures.height / 1.68
    torso = skeleton.torso_length
    hip, shoulder = skeleton.hip_half_width, skeleton.shoulder_half_width
    capsule = _CapsuleAdder(spec, size)
    capsule.add("pelvis", (0, -0.5 * hip, 0.06), (0, 0.5 * hip, 0.06), 0.085)
    capsule.add("torso", (0, 0, 0.02), (0, 0, 0.55 * torso), 0.085)
    top = torso - 0.075
    capsule.add("torso", (0, -0.45 * shoulder, top), (0, 0.45 * shoulder, top), 0.075, "chest")
    crown = skeleton.head_and_neck - NECK_RISE
    capsule.add("head", (0.0, 0, crown - 0.16), (0.005, 0, crown - 0.1), 0.075)
    for side in SIDES:
        capsule.add(f"{side}_upper_arm", (0, 0, -0.05), (0, 0, -skeleton.upper_arm + 0.02), 0.032)
        capsule.add(f"{side}_forearm", (0, 0, -0.03), (0, 0, -skeleton.forearm + 0.02), 0.025)
        capsule.add(f"{side}_hand", (0, 0, -0.03), (0, 0, -0.13), 0.017)
        capsule.add(f"{side}_thigh", (0, 0, -0.10), (0, 0, -skeleton.thigh + 0.05), 0.040)
        capsule.add(f"{side}_shank", (0, 0, -0.05), (0, 0, -skeleton.shank + 0.03), 0.030)
        sole = -skeleton.ankle_height
        heel = (-0.5 * skeleton.heel_back, 0, sole + 0.032 * size)
        ball = (skeleton.ball_forward - 0.02 * size, 0, sole + 0.03 * size)
        capsule.add(f"{side}_foot", heel, ball, 0.022)


class _CapsuleAdder:
    def __init__(self, spec: mujoco.MjSpec, size: float) -> None:
        self._spec = spec
        self._size = size

    def add(
        self,
        body: str,
        start: tuple[float, float, float],
        end: tuple[float, float, float],
        radius: float,
        part: str = "limb",
    ) -> None:
        """A capsule of `radius` (at a stature of 1.68 m) between two points of `body`."""
        self._spec.body(body).add_geom(
            name=f"{body}_{part}",
            type=mujoco.mjtGeom.mjGEOM_CAPSULE,
            fromto=[*start, *end],
            size=[radius * self._size, 0, 0],
            contype=_LIMB_CLASS,
            conaffinity=_LIMB_CLASS,
            condim=3,
            friction=(0.5, 0.005, 0.0001),
            group=COLLISION_GROUP,
            rgba=[0.3, 0.4, 0.8, 0.4],
        )
