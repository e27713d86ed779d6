"""The puppet: a table-top ballet dancer of 25 X-series servos.

Body frames are upright (x forward, y left, z up) when all joints are zero, and she then stands as
the dancer does: feet parallel, arms hanging. Joints that she shares with the dancer have the
dancer's names, axes and signs; waist tilt, forearm, wrist, ankle turn and toe she has not. Every
mass is a part that can be put on scales (docs/puppet.md lists them), where that part is.
"""

from __future__ import annotations

from functools import lru_cache

import mujoco
import numpy as np

from enpointe.models import anatomy
from enpointe.models.anatomy import SIDES, Hinge, mirrored, side_sign
from enpointe.models.puppet import frame
from enpointe.models.puppet.building import ALUMINIUM, Workbench
from enpointe.models.puppet.servos import SERVOS

__all__ = ["puppet_model", "puppet_spec"]

_SERVOS = SERVOS["puppet"]
_SHELL = (0.93, 0.86, 0.84, 1.0)
_TUNIC = (0.74, 0.52, 0.58, 1.0)
_HAIR = (0.30, 0.22, 0.18, 1.0)
_SHOE = (0.86, 0.68, 0.67, 1.0)
_UP = (0.0, 0.0, 1.0)
_AXES: dict[str, Hinge] = {
    hinge.name: hinge
    for joint in (anatomy.WAIST, anatomy.NECK, anatomy.SHOULDER, anatomy.ELBOW, anatomy.HIP,
                  anatomy.KNEE, anatomy.ANKLE)
    for hinge in joint
}  # fmt: skip


@lru_cache(maxsize=1)
def puppet_model() -> mujoco.MjModel:
    """The puppet compiled, once a process: 25 hinges on a free root (nq 32, nv 31, nu 25).

    Treat it as read-only; copy it to change it.
    """
    return puppet_spec().compile()


def puppet_spec() -> mujoco.MjSpec:
    """The puppet as an `MjSpec`, for those who want to change her before compiling."""
    bench = Workbench.named("puppet")
    pelvis = _add_trunk(bench)
    torso = bench.spec.body("torso")
    for side in SIDES:
        _Arm(bench, side).hang(torso)
    for side in SIDES:
        _Leg(bench, side).hang(pelvis)
    bench.add_motors()
    standing = [0, 0, frame.HIP_HEIGHT, 1, 0, 0, 0, *[0.0] * len(bench.motors)]
    bench.spec.add_key(name="standing", qpos=standing)
    return bench.spec


def _axis(name: str, side: str | None) -> tuple[float, float, float]:
    axis = _AXES[name].axis
    return axis if side is None else mirrored(axis, side)


class _Limb:
    """What hangs from a joint of several servos, each in a body of its own."""

    def __init__(self, bench: Workbench, side: str | None) -> None:
        self.bench, self.side = bench, side
        self.s = 1.0 if side is None else side_sign(side)
        self.prefix = "" if side is None else f"{side}_"

    def out(self, x: float, y: float, z: float) -> tuple[float, float, float]:
        """A place given for the left."""
        return (x, self.s * y, z)

    def link(
        self, parent: mujoco.MjsBody, name: str, joint: str, pos: tuple[float, float, float]
    ) -> mujoco.MjsBody:
        """A body turned by one servo."""
        body = parent.add_body(name=self.prefix + name, pos=pos)
        full = self.prefix + joint
        degrees = frame.RANGES_DEG[joint]
        self.bench.hinge(body, full, _axis(joint, self.side), degrees, _SERVOS[full])
        return body

    def case(
        self,
        body: mujoco.MjsBody,
        joint: str,
        pos: tuple[float, float, float],
        along: tuple[float, float, float],
    ) -> None:
        """The case of a joint's servo, screwed to `body`."""
        full = self.prefix + joint
        self.bench.case(body, full, _SERVOS[full], pos, _axis(joint, self.side), along)

    def beside(
        self, place: tuple[float, float, float], along: float, joint: str
    ) -> tuple[float, float, float]:
        """A place so far along a joint's axis, on the left, and its mirror image on the right."""
        x, y, z = np.asarray(_AXES[joint].axis) * along
        return (place[0] + float(x), place[1] + self.s * float(y), place[2] + float(z))

    def name(self, part: str) -> str:
        return self.prefix + part


def _add_trunk(bench: Workbench) -> mujoco.MjsBody:
    trunk = _Limb(bench, None)
    pelvis = bench.spec.worldbody.add_body(name="pelvis", pos=[0, 0, frame.HIP_HEIGHT])
    pelvis.add_freejoint(name="root")
    bench.box(pelvis, "pelvis_plate", 0.070, (-0.012, 0, 0.020), (0.030, 0.100, 0.030), ALUMINIUM)
    bench.ball(pelvis, "pelvis_shell", 0.020, (0, 0, 0.014), (0.040, 0.066, 0.030), _TUNIC)
    trunk.case(pelvis, "waist_turn", (0, 0, 0.035), (0, 1, 0))
    bench.touching(pelvis, (0, -0.022, 0.022), (0, 0.022, 0.022), 0.032)

    waist = trunk.link(pelvis, "waist", "waist_turn", (0, 0, frame.WAIST_HEIGHT))
    trunk.case(waist, "waist_bend", (0, 0, 0), (1, 0, 0))
    bench.box(waist, "waist_bracket", 0.025, (0, 0, -0.010), (0.034, 0.056, 0.006), ALUMINIUM)

    torso = trunk.link(waist, "torso", "waist_bend", (0, 0, 0))
    _fill_torso(bench, torso)
    neck = trunk.link(torso, "neck", "neck_turn", (0, 0, frame.NECK_HEIGHT))
    trunk.case(torso, "neck_turn", (0, 0, frame.NECK_HEIGHT - 0.020), (1, 0, 0))
    trunk.case(neck, "neck_tilt", (-0.020, 0, 0.012), (0, 0, 1))
    bench.bar(neck, "neck_bracket", 0.008, (0, 0, 0.0), (0, 0, 0.012), 0.010, _SHELL)
    yoke = trunk.link(neck, "neck_yoke", "neck_tilt", (0, 0, 0.014))
    trunk.case(yoke, "neck_bend", (0, 0, 0.004), (1, 0, 0))
    bench.box(yoke, "neck_yoke_bracket", 0.008, (0, 0, -0.006), (0.026, 0.030, 0.004), ALUMINIUM)
    head = trunk.link(yoke, "head", "neck_bend", (0, 0, 0.004))
    bench.ball(head, "head_shell", 0.050, (0.004, 0, 0.048), (0.037, 0.031, 0.042), _SHELL)
    bench.ball(head, "head_bun", 0.010, (-0.030, 0, 0.072), (0.017, 0.017, 0.016), _HAIR)
    bench.ball(head, "head_hair", 0.0, (-0.005, 0, 0.054), (0.037, 0.0335, 0.0405), _HAIR)
    bench.mark(head, "crown", (0, 0, 0.090))
    bench.mark(head, "eyes", (0.038, 0, 0.052))
    bench.touching(head, (0, 0, 0.040), (0, 0, 0.055), 0.034)
    return pelvis


def _fill_torso(bench: Workbench, torso: mujoco.MjsBody) -> None:
    bench.box(torso, "torso_plate", 0.080, (-0.014, 0, 0.070), (0.004, 0.080, 0.105), ALUMINIUM)
    bench.box(torso, "hub_and_adapter", 0.050, (-0.026, 0, 0.065), (0.018, 0.050, 0.070), ALUMINIUM)
    bench.ball(torso, "chest_shell", 0.045, (0.002, 0, 0.098), (0.034, 0.056, 0.042), _TUNIC)
    bench.ball(torso, "rib_shell", 0.015, (0.002, 0, 0.050), (0.030, 0.043, 0.045), _TUNIC)
    bench.touching(torso, (0, 0, 0.038), (0, 0, 0.06), 0.032)
    bench.touching(torso, (0, -0.024, 0.095), (0, 0.024, 0.095), 0.030, "chest")


class _Arm(_Limb):
    def hang(self, torso: mujoco.MjsBody) -> None:
        bench, name = self.bench, self.name
        place = self.out(0, frame.SHOULDER_HALF_WIDTH, frame.SHOULDER_HEIGHT)
        self.case(torso, "shoulder_raise", self.beside(place, 0.020, "shoulder_raise"), _UP)
        yoke = self.link(torso, "shoulder_yoke", "shoulder_raise", place)
        bench.mark(yoke, name("shoulder"), (0, 0, 0))
        self.case(yoke, "shoulder_cross", self.beside((0, 0, 0), -0.020, "shoulder_cross"), _UP)
        bench.ball(yoke, name("shoulder_bracket"), 0.010, (0, 0, 0), (0.015,) * 3, _SHELL)
        shaft = self.link(yoke, "shoulder_shaft", "shoulder_cross", (0, 0, 0))
        self.case(shaft, "shoulder_turn", (0, 0, -0.024), self.out(0, 1, 0))
        bench.bar(
            shaft, name("shoulder_frame"), 0.008, (0, 0, -0.010), (0, 0, -0.030), 0.013, _SHELL
        )
        upper = self.link(shaft, "upper_arm", "shoulder_turn", (0, 0, 0))
        bench.bar(
            upper, name("upper_arm_shell"), 0.018, (0, 0, -0.045), (0, 0, -0.080), 0.013, _SHELL
        )
        self.case(upper, "elbow_bend", (0, 0, -frame.UPPER_ARM + 0.007), (0, 0, 1))
        bench.touching(upper, (0, 0, -0.030), (0, 0, -0.080), 0.014)

        forearm = self.link(upper, "forearm", "elbow_bend", (0, 0, -frame.UPPER_ARM))
        bench.mark(forearm, name("elbow"), (0, 0, 0))
        end = (0, 0, -frame.FOREARM)
        bench.bar(forearm, name("forearm_shell"), 0.020, (0, 0, -0.014), end, 0.0095, _SHELL)
        bench.touching(forearm, (0, 0, -0.020), end, 0.010)
        hand = forearm.add_body(name=name("hand"), pos=end)
        bench.mark(hand, name("wrist"), (0, 0, 0))
        bench.ball(hand, name("hand_shell"), 0.010, self.out(0.003, 0, -0.024),
                   (0.012, 0.006, 0.031), _SHELL)  # fmt: skip
        bench.mark(hand, name("fingertips"), (0, 0, -frame.HAND))
        bench.touching(hand, (0, 0, -0.012), (0, 0, -0.042), 0.006)
        bench.apart("torso", name("upper_arm"))


class _Leg(_Limb):
    def hang(self, pelvis: mujoco.MjsBody) -> None:
        bench, name = self.bench, self.name
        place = self.out(0, frame.HIP_HALF_WIDTH, 0)
        behind = self.beside(place, -0.030, "hip_raise")
        self.case(pelvis, "hip_raise", behind, _UP)
        yoke = self.link(pelvis, "hip_yoke", "hip_raise", place)
        bench.mark(yoke, name("hip"), (0, 0, 0))
        before = self.beside((0, 0, 0), -0.030, "hip_cross")
        self.case(yoke, "hip_cross", before, _UP)
        bench.ball(yoke, name("hip_bracket"), 0.030, (0, 0, 0), (0.020,) * 3, ALUMINIUM)
        shaft = self.link(yoke, "hip_shaft", "hip_cross", (0, 0, 0))
        self.case(shaft, "hip_turn", (0, 0, -0.034), self.out(0, 1, 0))
        bench.bar(shaft, name("hip_frame"), 0.025, (0, 0, -0.010), (0, 0, -0.040), 0.016, ALUMINIUM)
        thigh = self.link(shaft, "thigh", "hip_turn", (0, 0, 0))
        knee = (0, 0, -frame.THIGH)
        bench.bar(thigh, name("thigh_shell"), 0.045, (0, 0, -0.060), (0, 0, -0.115), 0.019, _SHELL)
        self.case(thigh, "knee_bend", (0, 0, -frame.THIGH + 0.012), _UP)
        bench.touching(thigh, (0, 0, -0.055), (0, 0, -0.110), 0.020)

        shank = self.link(thigh, "shank", "knee_bend", knee)
        bench.mark(shank, name("knee"), (0, 0, 0))
        bench.bar(shank, name("shank_shell"), 0.045, (0, 0, -0.020), (0, 0, -0.100), 0.0165, _SHELL)
        self.case(shank, "ankle_point", (0, 0, -frame.SHANK + 0.012), _UP)
        bench.touching(shank, (0, 0, -0.025), (0, 0, -0.112), 0.018)
        self._add_foot(shank)
        bench.apart("pelvis", name("thigh"))

    def _add_foot(self, shank: mujoco.MjsBody) -> None:
        bench, name = self.bench, self.name
        ankle = self.link(shank, "ankle_yoke", "ankle_point", (0, 0, -frame.SHANK))
        bench.mark(ankle, name("ankle"), (0, 0, 0))
        bench.box(ankle, name("ankle_bracket"), 0.012, (0, 0, 0), (0.020, 0.020, 0.020), ALUMINIUM)
        foot = self.link(ankle, "foot", "ankle_roll", (0, 0, 0))
        # The case lies behind the axis that it turns, its long side along the foot's height.
        self.case(foot, "ankle_roll", (-0.020, 0, -0.012), (0, 1, 0))
        sole = -frame.ANKLE_HEIGHT
        length = frame.HEEL_BACK + frame.BALL_FORWARD
        middle = 0.5 * (frame.BALL_FORWARD - frame.HEEL_BACK)
        breadth = 2 * frame.BALL_HALF_BREADTH
        bench.box(foot, name("foot_plate"), 0.035, (middle, 0, sole + 0.004),
                  (length, 0.8 * breadth, 0.006), _SHOE)  # fmt: skip
        bench.mark(foot, name("heel"), (-frame.HEEL_BACK, 0, sole))
        bench.mark(foot, name("ball"), (frame.BALL_FORWARD, 0, sole))
        radius = frame.SOLE_RADIUS
        bench.touching(foot, (-0.022, 0, sole + 0.014), (0.036, 0, sole + 0.014), 0.012)
        toe = foot.add_body(name=name("toe"), pos=(frame.BALL_FORWARD, 0, sole + radius))
        angle = frame.FACET_ANGLE
        rise = np.array([np.cos(angle), 0.0, np.sin(angle)])
        tilted = (np.cos(0.5 * angle), 0.0, -np.sin(0.5 * angle), 0.0)
        half = 0.5 * frame.FACET_LENGTH * rise
        bench.box(
            toe, name("toe_plate"), 0.015, half, (frame.FACET_LENGTH, 0.8 * breadth, 0.006), _SHOE,
            quat=tilted,
        )  # fmt: skip
        tip = frame.FACET_LENGTH * rise
        bench.mark(toe, name("toe_tip"), tip)
        for edge, s in (("inner", -self.s), ("outer", self.s)):
            y = s * (frame.BALL_HALF_BREADTH - radius)
            heel = (
                -frame.HEEL_BACK + radius,
                s * (frame.HEEL_HALF_BREADTH - radius),
                sole + radius,
            )
            bench.sole(foot, name(f"heel_{edge}"), heel, radius)
            bench.sole(toe, name(f"ball_{edge}"), (0, y, 0), radius)
            bench.sole(toe, name(f"tip_{edge}"), (tip[0], 0.8 * y, tip[2]), radius)
