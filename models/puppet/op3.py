"""ROBOTIS OP3, 20 XM430-W350, from the published numbers; drawn with our own primitives.

Names, axes, offsets, masses, centres of mass and inertias: ROBOTIS-OP3-Common (op3_description),
with the principal inertias of mujoco_menagerie (robotis_op3) turned into the links' axes. Joint
limits: ROBOTIS-OP3, op3_kinematics_dynamics; the knee's there is 126 degrees, but ROBOTIS' own
initial pose bends it 142, so that it is 145 here; the published meshes of thigh and shank meet at
148. What of shank and foot touches follows the meshes too: they say that the ankle has all of its
range, unless it is rolled as well. At zero the legs are straight and the arms level
out to the sides. Joints have ROBOTIS' names; bodies and sites have those of the dancer's parts, so
that whatever moves, balances and measures the dancer does the same with OP3.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import mujoco

from enpointe.models.anatomy import SIDES, side_sign
from enpointe.models.puppet.building import DARK, Workbench
from enpointe.models.puppet.servos import SERVOS

__all__ = ["op3_model", "op3_spec"]

Vec = tuple[float, float, float]
_HIP_HEIGHT = 0.0285 + 0.11015 + 0.110 + 0.0305
"""Origin of the body above the soles with straight legs, m."""
_SOLE = -0.0305
_RADIUS = 0.005
_BALL = 0.070
"""Of the foot's outline, in front of the roll axis, m: where it is broad no more."""
_TIP = 0.0825
_WHITE = (0.88, 0.89, 0.90, 1.0)


@dataclass(frozen=True, slots=True)
class _Link:
    """A link with the joint that turns it, for the left side.

    Attributes:
        name: Of the joint, without its side.
        body: What the dancer's part of that kind is called.
        parent: Another link's joint, or "body".
        place: From the parent's frame, m.
        axis: Of the joint on the left.
        right: Of the joint on the right, if it isn't the same.
        range_deg: On the left.
        mass: kg.
        com: m.
        inertia: xx, yy, zz, xy, xz, yz, 1e-6 kg m^2.
    """

    name: str
    body: str
    parent: str
    place: Vec
    axis: Vec
    right: Vec
    range_deg: tuple[float, float]
    mass: float
    com: Vec
    inertia: tuple[float, float, float, float, float, float]


_X, _Y, _Z = (1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0)


def _minus(axis: Vec) -> Vec:
    return (-axis[0], -axis[1], -axis[2])


_BODY_INERTIA = (3404.99, 2969.39, 3173.31, 5.72, -42.56, -0.59)
_LIMBS = (
    _Link("sho_pitch", "shoulder_yoke", "body", (-0.001, 0.06, 0.111), _Y, _minus(_Y),
          (-90, 90), 0.01176, (0, 0.00823, -0.00233),
          (1.65, 3.87, 3.97, 0, 0, 0.31)),
    _Link("sho_roll", "upper_arm", "sho_pitch", (0.019, 0.0285, -0.010), _minus(_X), _minus(_X),
          (-54, 90), 0.17758, (-0.01844, 0.04514, 0.00028),
          (228.04, 30.42, 234.74, -0.01, 0.03, 0.59)),
    _Link("el", "forearm", "sho_roll", (0, 0.0904, -0.0001), _X, _X,
          (-90, 90), 0.04127, (-0.019, 0.07033, 0.0038),
          (61.96, 12.31, 68.54, 0, 0, -3.72)),
    _Link("hip_yaw", "hip_yoke", "body", (0, 0.035, 0), _minus(_Z), _minus(_Z),
          (-81, 81), 0.01181, (-0.00157, 0, -0.00774),
          (1.51, 4.3, 4.12, 0, 0.01, 0)),
    _Link("hip_roll", "hip_shaft", "hip_yaw", (-0.024, 0, -0.0285), _minus(_X), _minus(_X),
          (-54, 54), 0.17886, (0.00388, 0.00028, -0.01214),
          (46.61, 125.23, 108.57, -1.01, -1.31, -0.06)),
    _Link("hip_pitch", "thigh", "hip_roll", (0.0241, 0.019, 0), _Y, _minus(_Y),
          (-72, 72), 0.11543, (0.00059, -0.01901, -0.08408),
          (104.99, 96.13, 24.93, -0.01, -0.71, 3.53)),
    _Link("knee", "shank", "hip_pitch", (0, 0, -0.11015), _Y, _minus(_Y),
          (-18, 145), 0.04015, (0, -0.02151, -0.055),
          (37.15, 27.51, 15.11, 0, 0, 0)),
    _Link("ank_pitch", "ankle_yoke", "knee", (0, 0, -0.110), _minus(_Y), _Y,
          (-81, 81), 0.17886, (-0.02022, -0.01872, 0.01214),
          (46.61, 125.23, 108.57, -1.01, 1.31, 0.06)),
    _Link("ank_roll", "foot", "ank_pitch", (-0.0241, -0.019, 0), _X, _X,
          (-81, 81), 0.06934, (0.02373, 0.01037, -0.0276),
          (40.34, 78.74, 115.79, -0.19, 0.12, 1.01)),
)  # fmt: skip
_HEAD = (
    _Link("head_pan", "neck", "body", (-0.001, 0, 0.1365), _Z, _Z,
          (-90, 90), 0.01176, (0.00233, 0, 0.00823),
          (3.97, 1.65, 3.87, 0, -0.31, 0)),
    _Link("head_tilt", "head", "head_pan", (0.010, 0.019, 0.0285), _minus(_Y), _minus(_Y),
          (-90, 90), 0.13631, (0.0023, -0.01863, 0.0277),
          (106.12, 87.21, 45.29, 0.11, -9.1, 0.84)),
)  # fmt: skip


@lru_cache(maxsize=1)
def op3_model() -> mujoco.MjModel:
    """OP3 compiled, once a process: 20 hinges on a free root (nq 27, nv 26, nu 20).

    Treat it as read-only; copy it to change it.
    """
    return op3_spec().compile()


def op3_spec() -> mujoco.MjSpec:
    """OP3 as an `MjSpec`, for those who want to change it before compiling."""
    bench = Workbench.named("op3")
    body = bench.spec.worldbody.add_body(name="pelvis", pos=[0, 0, _HIP_HEIGHT])
    body.add_freejoint(name="root")
    _weigh(body, 1.34928, (-0.01501, 0.00013, 0.06582), _BODY_INERTIA)
    links = {"body": body}
    for link in _HEAD:
        links[link.name] = _add(bench, links[link.parent], link, None)
    _shape_trunk(bench, links)
    for side in SIDES:
        own = {"body": body}
        for link in _LIMBS:
            own[link.name] = _add(bench, own[link.parent], link, side)
        _shape_arm(bench, own, side)
        _shape_leg(bench, own, side)
    bench.add_motors()
    standing = [0, 0, _HIP_HEIGHT, 1, 0, 0, 0, *[0.0] * len(bench.motors)]
    bench.spec.add_key(name="standing", qpos=standing)
    return bench.spec


def _add(bench: Workbench, parent: mujoco.MjsBody, link: _Link, side: str | None) -> mujoco.MjsBody:
    s = 1.0 if side is None else side_sign(side)
    x, y, z = link.place
    body = parent.add_body(
        name=link.body if side is None else f"{side}_{link.body}", pos=(x, s * y, z)
    )
    name = link.name if side is None else f"{side[0]}_{link.name}"
    low, high = link.range_deg
    if side == "right" and not _turns_alike(link):
        low, high = -high, -low
    axis = link.right if side == "right" else link.axis
    bench.hinge(body, name, axis, (low, high), SERVOS["op3"][name])
    xx, yy, zz, xy, xz, yz = link.inertia
    cx, cy, cz = link.com
    _weigh(body, link.mass, (cx, s * cy, cz), (xx, yy, zz, s * xy, xz, s * yz))
    return body


def _turns_alike(link: _Link) -> bool:
    """Whether equal angles left and right are mirrored poses."""
    x, y, z = link.axis
    return link.right == (-x, y, -z)


def _weigh(
    body: mujoco.MjsBody,
    mass: float,
    com: Vec,
    inertia: tuple[float, float, float, float, float, float],
) -> None:
    body.explicitinertial = True
    body.mass = mass
    body.ipos = com
    body.fullinertia = [1e-6 * value for value in inertia]


def _shape_trunk(bench: Workbench, links: dict[str, mujoco.MjsBody]) -> None:
    body, head, neck = links["body"], links["head_tilt"], links["head_pan"]
    torso = body.add_body(name="torso", pos=(-0.001, 0, 0.060))
    bench.box(torso, "chest", 0, (-0.011, 0, 0.030), (0.078, 0.094, 0.078), _WHITE)
    bench.box(torso, "back", 0, (-0.040, 0, 0.020), (0.030, 0.070, 0.080), DARK)
    bench.box(body, "hip_block", 0, (-0.014, 0, 0.022), (0.066, 0.104, 0.050), DARK)
    bench.bar(neck, "neck_post", 0, (0, 0, 0), (0, 0, 0.024), 0.014, DARK)
    bench.ball(head, "skull", 0, (0.002, -0.019, 0.036), (0.046, 0.044, 0.040), _WHITE)
    bench.box(head, "visor", 0, (0.040, -0.019, 0.040), (0.014, 0.050, 0.016), DARK)
    bench.touching(body, (-0.015, -0.022, 0.03), (-0.015, 0.022, 0.03), 0.032)
    bench.touching(torso, (-0.012, -0.012, 0.03), (-0.012, 0.012, 0.03), 0.038)
    bench.touching(head, (0.003, -0.019, 0.03), (0.003, -0.019, 0.045), 0.040)
    bench.mark(head, "crown", (0, -0.019, 0.076))
    bench.mark(head, "eyes", (0.046, -0.019, 0.040))
    bench.apart("pelvis", "torso")


def _shape_arm(bench: Workbench, links: dict[str, mujoco.MjsBody], side: str) -> None:
    s = side_sign(side)
    shoulder, upper, lower = (links[name] for name in ("sho_pitch", "sho_roll", "el"))
    bench.box(shoulder, f"{side}_shoulder_block", 0, (0.0, s * 0.016, -0.005),
              (0.036, 0.030, 0.036), DARK)  # fmt: skip
    # The bones run along the middle of the links, 19 mm behind the joints' published origins.
    middle = -0.019
    bench.box(upper, f"{side}_upper_arm_shell", 0, (middle, s * 0.034, 0), (0.030, 0.060, 0.034),
              _WHITE)  # fmt: skip
    bench.box(
        upper, f"{side}_elbow_servo", 0, (middle, s * 0.082, 0), (0.034, 0.0465, 0.0285), DARK
    )
    wrist = (middle, s * 0.110, 0.003)
    bench.bar(lower, f"{side}_forearm_shell", 0, (middle, s * 0.028, 0.002), wrist, 0.015, _WHITE)
    bench.touching(upper, (middle, s * 0.012, 0), (middle, s * 0.082, 0), 0.017)
    bench.touching(lower, (middle, s * 0.030, 0.002), wrist, 0.015)
    bench.mark(upper, f"{side}_shoulder", (middle, 0, 0))
    bench.mark(lower, f"{side}_elbow", (middle, 0, 0))
    hand = lower.add_body(name=f"{side}_hand", pos=wrist)
    bench.mark(hand, f"{side}_wrist", (0, 0, 0))
    bench.ball(hand, f"{side}_gripper", 0, (0, s * 0.022, 0.001), (0.013, 0.024, 0.016), DARK)
    bench.mark(hand, f"{side}_fingertips", (0, s * 0.040, 0.001))
    for part in ("pelvis", "torso"):
        bench.apart(part, f"{side}_upper_arm")


def _shape_leg(bench: Workbench, links: dict[str, mujoco.MjsBody], side: str) -> None:
    s = side_sign(side)
    shaft, thigh, shank, ankle, foot = (
        links[name] for name in ("hip_roll", "hip_pitch", "knee", "ank_pitch", "ank_roll")
    )
    # The legs hang 19 mm inside the origins of their pitch joints.
    middle = -s * 0.019
    bench.box(shaft, f"{side}_hip_servos", 0, (0.012, 0, -0.010), (0.060, 0.034, 0.046), DARK)
    bench.box(thigh, f"{side}_thigh_shell", 0, (0, middle, -0.055), (0.036, 0.036, 0.074), _WHITE)
    bench.box(thigh, f"{side}_knee_servo", 0, (0, middle, -0.102), (0.0285, 0.034, 0.0465), DARK)
    bench.box(shank, f"{side}_shank_shell", 0, (0, middle, -0.055), (0.032, 0.042, 0.086), _WHITE)
    bench.box(
        ankle, f"{side}_ankle_servos", 0, (-0.016, middle, 0.006), (0.060, 0.034, 0.046), DARK
    )
    bench.box(foot, f"{side}_foot_plate", 0, (0.024, s * 0.0125, -0.0265), (0.127, 0.056, 0.008),
              _WHITE)  # fmt: skip
    bench.box(foot, f"{side}_foot_broad", 0, (0.024, s * 0.0125, -0.0265), (0.114, 0.078, 0.007),
              _WHITE)  # fmt: skip
    bench.touching(thigh, (0, middle, -0.040), (0, middle, -0.095), 0.020)
    # Two plates 44 mm apart over all and 22 mm deep, with a bridge of 30 mm between them.
    bench.touching_box(shank, (0, s * -0.020, -0.0425), (0.025, 0.044, 0.075))
    bench.touching(foot, (-0.010, s * 0.0125, -0.020), (0.060, s * 0.0125, -0.020), 0.008)
    bench.mark(thigh, f"{side}_hip", (0, middle, 0))
    bench.mark(shank, f"{side}_knee", (0, middle, 0))
    bench.mark(foot, f"{side}_ankle", (0.0241, 0, 0))
    bench.mark(foot, f"{side}_heel", (-0.0395, s * 0.0125, _SOLE))
    bench.mark(foot, f"{side}_ball", (_BALL, s * 0.0125, _SOLE))
    bench.apart("pelvis", f"{side}_thigh")
    toe = foot.add_body(name=f"{side}_toe", pos=(_BALL, s * 0.0125, _SOLE + _RADIUS))
    bench.mark(toe, f"{side}_toe_tip", (_TIP + _RADIUS - _BALL, 0, -_RADIUS))
    # Studs at the corners of the outline: two plates of 127 by 56 mm and 114 by 78 mm.
    for edge, t in (("inner", -s), ("outer", s)):
        bench.sole(foot, f"{side}_heel_{edge}",
                   (-0.0345, s * 0.0125 + t * 0.023, _SOLE + _RADIUS), _RADIUS)  # fmt: skip
        bench.sole(toe, f"{side}_ball_{edge}", (0, t * 0.034, 0), _RADIUS)
        bench.sole(toe, f"{side}_tip_{edge}", (_TIP - _BALL, t * 0.023, 0), _RADIUS)
