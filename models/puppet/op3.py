"""ROBOTIS OP3, 20 XM430-W350, from the published numbers; drawn with our own primitives.

Names, axes, offsets, masses, centres of mass and inertias: ROBOTIS-OP3-Common (op3_description),
with the principal inertias of mujoco_menagerie (robotis_op3) turned into the links' axes. Joint
limits: ROBOTIS-OP3, op3_kinematics_dynamics; the knee's there is 126 degrees, but ROBOTIS' own
initial pose bends it 142, so that it is 145 here. At zero the legs are straight and the arms level
out to the sides.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import mujoco

from enpointe.models.puppet.building import DARK, Workbench
from enpointe.models.puppet.servos import SERVOS

__all__ = ["op3_model", "op3_spec"]

Vec = tuple[float, float, float]
_HIP_HEIGHT = 0.0285 + 0.11015 + 0.110 + 0.0305
"""Origin of the body above the soles with straight legs, m."""
_SOLE = -0.0305
_RADIUS = 0.005
_WHITE = (0.88, 0.89, 0.90, 1.0)


@dataclass(frozen=True, slots=True)
class _Link:
    """A link with the joint that turns it, for the left side.

    Attributes:
        name: Of the joint, without its side; the link's is that and "_link".
        parent: Another link's, or "body".
        place: From the parent's frame, m.
        axis: Of the joint on the left.
        right: Of the joint on the right, if it isn't the same.
        range_deg: On the left.
        mass: kg.
        com: m.
        inertia: xx, yy, zz, xy, xz, yz, 1e-6 kg m^2.
    """

    name: str
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
    _Link("sho_pitch", "body", (-0.001, 0.06, 0.111), _Y, _minus(_Y), (-90, 90), 0.01176,
          (0, 0.00823, -0.00233), (1.65, 3.87, 3.97, 0, 0, 0.31)),
    _Link("sho_roll", "sho_pitch", (0.019, 0.0285, -0.010), _minus(_X), _minus(_X), (-54, 90),
          0.17758, (-0.01844, 0.04514, 0.00028), (228.04, 30.42, 234.74, -0.01, 0.03, 0.59)),
    _Link("el", "sho_roll", (0, 0.0904, -0.0001), _X, _X, (-90, 90), 0.04127,
          (-0.019, 0.07033, 0.0038), (61.96, 12.31, 68.54, 0, 0, -3.72)),
    _Link("hip_yaw", "body", (0, 0.035, 0), _minus(_Z), _minus(_Z), (-81, 81), 0.01181,
          (-0.00157, 0, -0.00774), (1.51, 4.3, 4.12, 0, 0.01, 0)),
    _Link("hip_roll", "hip_yaw", (-0.024, 0, -0.0285), _minus(_X), _minus(_X), (-54, 54), 0.17886,
          (0.00388, 0.00028, -0.01214), (46.61, 125.23, 108.57, -1.01, -1.31, -0.06)),
    _Link("hip_pitch", "hip_roll", (0.0241, 0.019, 0), _Y, _minus(_Y), (-72, 72), 0.11543,
          (0.00059, -0.01901, -0.08408), (104.99, 96.13, 24.93, -0.01, -0.71, 3.53)),
    _Link("knee", "hip_pitch", (0, 0, -0.11015), _Y, _minus(_Y), (-18, 145), 0.04015,
          (0, -0.02151, -0.055), (37.15, 27.51, 15.11, 0, 0, 0)),
    _Link("ank_pitch", "knee", (0, 0, -0.110), _minus(_Y), _Y, (-81, 81), 0.17886,
          (-0.02022, -0.01872, 0.01214), (46.61, 125.23, 108.57, -1.01, 1.31, 0.06)),
    _Link("ank_roll", "ank_pitch", (-0.0241, -0.019, 0), _X, _X, (-81, 81), 0.06934,
          (0.02373, 0.01037, -0.0276), (40.34, 78.74, 115.79, -0.19, 0.12, 1.01)),
)  # fmt: skip
_HEAD = (
    _Link("head_pan", "body", (-0.001, 0, 0.1365), _Z, _Z, (-90, 90), 0.01176,
          (0.00233, 0, 0.00823), (3.97, 1.65, 3.87, 0, -0.31, 0)),
    _Link("head_tilt", "head_pan", (0.010, 0.019, 0.0285), _minus(_Y), _minus(_Y), (-90, 90),
          0.13631, (0.0023, -0.01863, 0.0277), (106.12, 87.21, 45.29, 0.11, -9.1, 0.84)),
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
    body = bench.spec.worldbody.add_body(name="body_link", pos=[0, 0, _HIP_HEIGHT])
    body.add_freejoint(name="root")
    _weigh(body, 1.34928, (-0.01501, 0.00013, 0.06582), _BODY_INERTIA)
    links = {"body": body}
    for link in _HEAD:
        links[link.name] = _add(bench, links[link.parent], link, "")
    for side in ("l_", "r_"):
        for link in _LIMBS:
            parent = links[link.parent if link.parent == "body" else side + link.parent]
            links[side + link.name] = _add(bench, parent, link, side)
    _draw_trunk(bench, links)
    for side in ("l_", "r_"):
        _draw_arm(bench, links, side)
        _draw_leg(bench, links, side)
        _add_soles(bench, links[f"{side}ank_roll"], side)
    bench.add_motors()
    standing = [0, 0, _HIP_HEIGHT, 1, 0, 0, 0, *[0.0] * len(bench.motors)]
    bench.spec.add_key(name="standing", qpos=standing)
    return bench.spec


def _add(bench: Workbench, parent: mujoco.MjsBody, link: _Link, side: str) -> mujoco.MjsBody:
    s = -1.0 if side == "r_" else 1.0
    name = side + link.name
    x, y, z = link.place
    body = parent.add_body(name=f"{name}_link", pos=(x, s * y, z))
    low, high = link.range_deg
    axis = link.right if side == "r_" else link.axis
    same = side != "r_" or _turns_alike(link)
    bench.hinge(body, name, axis, (low, high) if same else (-high, -low), SERVOS["op3"][name])
    xx, yy, zz, xy, xz, yz = link.inertia
    cx, cy, cz = link.com
    _weigh(body, link.mass, (cx, s * cy, cz), (xx, yy, zz, s * xy, xz, s * yz))
    return body


def _turns_alike(link: _Link) -> bool:
    """Whether equal angles left and right are mirrored poses."""
    (x, y, z), right = link.axis, link.right
    return right == (-x, y, -z)


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


def _draw_trunk(bench: Workbench, links: dict[str, mujoco.MjsBody]) -> None:
    body, head, pan = links["body"], links["head_tilt"], links["head_pan"]
    bench.box(body, "chest", 0, (-0.012, 0, 0.085), (0.075, 0.090, 0.085), _WHITE)
    bench.box(body, "hip_block", 0, (-0.020, 0, 0.020), (0.060, 0.100, 0.040), DARK)
    bench.bar(pan, "neck", 0, (0, 0, 0), (0, 0, 0.02), 0.012, DARK)
    bench.ball(head, "face", 0, (0.005, -0.019, 0.045), (0.045, 0.042, 0.040), _WHITE)
    bench.box(head, "visor", 0, (0.044, -0.019, 0.050), (0.010, 0.050, 0.018), DARK)
    bench.touching(body, (-0.015, -0.03, 0.03), (-0.015, 0.03, 0.03), 0.035)
    bench.touching(body, (-0.012, -0.02, 0.09), (-0.012, 0.02, 0.09), 0.038, "chest")
    bench.touching(head, (0.003, -0.019, 0.035), (0.003, -0.019, 0.055), 0.040)
    bench.mark(body, "pelvis", (0, 0, 0))
    bench.mark(body, "torso", (-0.001, 0, 0.111))
    bench.mark(head, "head", (0, -0.019, 0.080))


def _draw_arm(bench: Workbench, links: dict[str, mujoco.MjsBody], side: str) -> None:
    s = -1.0 if side == "r_" else 1.0
    upper, lower, shoulder = (links[side + n] for n in ("sho_roll", "el", "sho_pitch"))
    bench.box(shoulder, f"{side}shoulder_block", 0, (0.0, s * 0.018, -0.004),
              (0.034, 0.026, 0.034), DARK)  # fmt: skip
    bench.box(upper, f"{side}upper_arm_shell", 0, (-0.0185, s * 0.030, 0), (0.030, 0.046, 0.036),
              _WHITE)  # fmt: skip
    bench.box(upper, f"{side}elbow_servo", 0, (-0.0185, s * 0.082, 0), (0.034, 0.046, 0.0285), DARK)
    hand = (-0.019, s * 0.140, 0.004)
    bench.bar(lower, f"{side}forearm_shell", 0, (-0.019, s * 0.025, 0.002), hand, 0.016, _WHITE)
    bench.touching(upper, (-0.0185, s * 0.01, 0), (-0.0185, s * 0.08, 0), 0.018)
    bench.touching(lower, (-0.019, s * 0.03, 0.002), hand, 0.016)
    bench.mark(upper, f"{side}shoulder", (-0.019, 0, 0))
    bench.mark(lower, f"{side}elbow", (-0.019, 0, 0))
    bench.mark(lower, f"{side}hand", (-0.019, s * 0.150, 0.004))
    bench.apart("body_link", f"{side}sho_roll_link")


def _draw_leg(bench: Workbench, links: dict[str, mujoco.MjsBody], side: str) -> None:
    s = -1.0 if side == "r_" else 1.0
    hip, thigh, shank, ankle, foot = (
        links[side + n] for n in ("hip_roll", "hip_pitch", "knee", "ank_pitch", "ank_roll")
    )
    inward = -s * 0.019
    bench.box(hip, f"{side}hip_servos", 0, (0.010, 0, -0.010), (0.050, 0.034, 0.046), DARK)
    bench.box(thigh, f"{side}thigh_shell", 0, (0, inward, -0.055), (0.034, 0.034, 0.070), _WHITE)
    bench.box(thigh, f"{side}knee_servo", 0, (0, inward, -0.100), (0.0285, 0.034, 0.0465), DARK)
    bench.box(shank, f"{side}shank_shell", 0, (0, inward, -0.055), (0.030, 0.040, 0.080), _WHITE)
    bench.box(ankle, f"{side}ankle_servos", 0, (-0.018, inward, 0.008), (0.050, 0.034, 0.046), DARK)
    bench.box(foot, f"{side}foot_plate", 0, (0.024, s * 0.0125, -0.0265), (0.127, 0.070, 0.008),
              _WHITE)  # fmt: skip
    bench.touching(thigh, (0, inward, -0.035), (0, inward, -0.095), 0.021)
    bench.touching(shank, (0, inward, -0.025), (0, inward, -0.085), 0.020)
    bench.touching(foot, (-0.010, s * 0.0125, -0.010), (0.060, s * 0.0125, -0.016), 0.010)
    bench.mark(thigh, f"{side}hip", (0, inward, 0))
    bench.mark(shank, f"{side}knee", (0, inward, 0))
    bench.mark(foot, f"{side}ankle", (0.0241, 0, 0))
    bench.apart("body_link", f"{side}hip_pitch_link")


def _add_soles(bench: Workbench, foot: mujoco.MjsBody, side: str) -> None:
    """Studs at the corners of the foot's outline: two boxes in mujoco_menagerie, 8 mm thick."""
    s = -1.0 if side == "r_" else 1.0
    for part, x, half in (("heel", -0.0345, 0.028), ("ball", 0.070, 0.034), ("tip", 0.0825, 0.023)):
        for edge, t in (("inner", -s), ("outer", s)):
            place = (x, s * 0.0125 + t * half, _SOLE + _RADIUS)
            bench.sole(foot, f"{side}{part}_{edge}", place, _RADIUS)
