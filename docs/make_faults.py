"""Measures what people found wrong with the thesis's dancer on ours, and draws it.

Neagle (2005) compares his dancer with a manual (§4.5) and shows it to teachers and notators (§4.7).
Every fault that they found stands in docs/faults.toml with what cures it, how that is measured on a
solved pose, and a joint to put out of place so that a rule must break.

    python docs/make_faults.py            # the table between the markers of docs/faults.md
    python docs/make_faults.py --pictures # and docs/images/faults.png, which needs OpenGL
"""

from __future__ import annotations

import functools
import re
import sys
import tomllib
from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path

import mujoco
import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from enpointe.models import KeyPose, KeyPoseSolver, Style, dancer_model, pose_target
from enpointe.models.joints import Joints
from enpointe.models.limbs import orientation
from enpointe.models.reading import read_joints
from enpointe.notation import Side, parse_score
from enpointe.posing import vocabulary_score

DOCS = Path(__file__).parent
LIST = DOCS / "faults.toml"
PAGE = DOCS / "faults.md"
PICTURE = DOCS / "images" / "faults.png"
MARKED = re.compile(r"(<!-- made by docs/make_faults\.py -->\n).*?(<!-- end -->)", flags=re.DOTALL)
_HEADER = "benesh 1\ntitle: T\nmethod: Cecchetti\nmetre: 4/4\ntempo: 60\nbeat 0:\n"

POSES = {
    "inclined": "feet: first\narms: fifth en haut\nhead: turn left 25, tilt left 15\n",
    "back": "feet: fifth right front\narms: fifth en haut\nbody: bend back 5\n",
    "third line": "left leg: straight\nright foot: 0.1 wide, 3 high, front\narms: à la seconde\n",
}
"""Poses that the vocabulary has no name for, as the lines of a score."""


@dataclass(frozen=True)
class Seen:
    """A solved pose with all that a measure looks at."""

    pose: KeyPose
    joints: Joints
    data: mujoco.MjData

    @classmethod
    def of(cls, pose: KeyPose) -> Seen:
        model = solver().model
        data = mujoco.MjData(model)
        data.qpos[:] = pose.qpos
        mujoco.mj_forward(model, data)
        return cls(pose, Joints.of(model, pose.qpos), data)

    def angle(self, start: str, middle: str, end: str) -> float:
        """Bend at a joint, degrees."""
        one, other = self.joints.between(start, middle), self.joints.between(middle, end)
        return _between(one, other)

    def tip(self, finger: str) -> NDArray[np.float64]:
        """The far end of a finger's last bone, world, m."""
        geom = self.data.geom(finger)
        half = solver().model.geom(finger).size[1]
        ends = [geom.xpos + s * half * geom.xmat.reshape(3, 3)[:, 2] for s in (-1, 1)]
        wrist = self.joints[f"{finger.split('_')[0]}_wrist"]
        return max(ends, key=lambda end: float(np.linalg.norm(end - wrist)))


@dataclass(frozen=True)
class Fault:
    """One fault of the thesis's dancer, as docs/faults.toml explains its fields."""

    section: str
    fault: str
    cure: str
    pose: str
    what: str
    measure: str
    unit: str
    least: float
    most: float
    joint: str
    by: float
    azimuth: float
    site: str
    rule: str | None = None
    real: bool = False

    def measured(self, pose: KeyPose) -> float:
        """The figure of a pose, mm or degrees."""
        measure: Callable[[Seen], float] = globals()[self.measure]
        return measure(Seen.of(pose))

    def figure(self) -> str:
        """The measured figure as the table has it."""
        return said(self.measured(solved(self.pose, self.real)), self.unit)


def said(value: float, unit: str) -> str:
    return f"{value:.0f} mm" if unit == "mm" else f"{value:.1f}°".replace("-0.0", "0.0")


@functools.cache
def solver() -> KeyPoseSolver:
    return KeyPoseSolver(dancer_model())


@functools.cache
def solved(pose: str, real: bool = False) -> KeyPose:
    """A pose of `POSES` or of the vocabulary."""
    score = parse_score(_HEADER + POSES[pose]) if pose in POSES else vocabulary_score(pose)
    assert score is not None
    target = pose_target(score.resolved()[0], solver().figure, Style(real=real), name=pose)
    return solver().solve(target)


def put_wrong(fault: Fault) -> KeyPose:
    """The pose with one joint out of place, certified anew."""
    found = solved(fault.pose, fault.real)
    qpos, upright = np.array(found.qpos), Rotation.from_euler("z", found.target.facing)
    rotation = Rotation.from_quat(qpos[3:7], scalar_first=True)
    if fault.joint == "root":
        rotation = Rotation.from_euler("z", fault.by, degrees=True) * rotation
        qpos[3:7] = rotation.as_quat(scalar_first=True)
    else:
        qpos[solver().model.joint(fault.joint).qposadr[0]] += np.radians(fault.by)
    unknowns = np.concatenate([qpos[:3], (upright.inv() * rotation).as_rotvec(), qpos[7:]])
    problem = solver().problem(found.target)
    certificate = problem.certify(unknowns, problem.parameters(found.target))
    return replace(found, qpos=qpos, certificate=certificate)


def _between(one: NDArray[np.float64], other: NDArray[np.float64]) -> float:
    cosine = one @ other / (np.linalg.norm(one) * np.linalg.norm(other))
    return float(np.degrees(np.arccos(np.clip(cosine, -1.0, 1.0))))


def upright_head(seen: Seen) -> float:
    return _between(seen.joints.head[:, 2], np.array([0.0, 0.0, 1.0]))


def thumb_to_middle(seen: Seen) -> float:
    return 1e3 * float(np.linalg.norm(seen.tip("left_thumb_2") - seen.tip("left_middle_2")))


def chest(seen: Seen) -> float:
    """How far the leotard stands out at the chest beyond the waist."""
    model = solver().model
    mesh = model.geom("leotard").dataid[0]
    start, count = model.mesh_vertadr[mesh], model.mesh_vertnum[mesh]
    geom = seen.data.geom("leotard")
    points = model.mesh_vert[start : start + count] @ geom.xmat.reshape(3, 3).T + geom.xpos
    waist, shoulder = solver().figure.lines[2], solver().figure.lines[3]

    def front(share: float) -> float:
        height = waist + share * (shoulder - waist)
        near = np.abs(points[:, 2] - height) < 0.03
        return float(points[near, 0].max())

    return 1e3 * (max(front(share) for share in (0.4, 0.5, 0.6, 0.7)) - front(0.1))


def pointed(seen: Seen) -> float:
    return seen.angle("right_knee", "right_ankle", "right_toe_tip")


def heels_apart(seen: Seen) -> float:
    gap = seen.joints["left_heel"] - seen.joints["right_heel"]
    return 1e3 * float(np.linalg.norm(gap))


def overlap(seen: Seen) -> float:
    depth = [0.0]
    for contact in seen.data.contact[: seen.data.ncon]:
        names = [solver().model.geom(int(g)).name for g in contact.geom]
        if "floor" not in names:
            depth.append(-1e3 * float(contact.dist))
    return max(depth)


def below_floor(seen: Seen) -> float:
    soles = [f"{side}_{part}" for side in Side for part in ("heel", "ball", "toe_tip")]
    return max(0.0, -1e3 * min(float(seen.joints[sole][2]) for sole in soles))


def rolled(seen: Seen) -> float:
    feet = [seen.data.body(f"{side}_foot").xmat.reshape(3, 3)[:, 2] for side in Side]
    return max(_between(foot, np.array([0.0, 0.0, 1.0])) for foot in feet)


def off_its_mark(seen: Seen) -> float:
    results = seen.pose.certificate.results
    return max(r.value for r in results if r.rule.endswith("foot on its mark"))


def head_off_what_is_written(seen: Seen) -> float:
    wanted = Rotation.from_euler("ZXY", [25.0, -15.0, 0.0], degrees=True).as_matrix()
    head = seen.joints.torso.T @ seen.joints.head
    return float(np.degrees(Rotation.from_matrix(wanted.T @ head).magnitude()))


def pelvis_turned(seen: Seen) -> float:
    return abs(orientation(seen.joints.pelvis).turn)


def pelvis_off_upright(seen: Seen) -> float:
    facing = Rotation.from_euler("z", seen.pose.target.facing).as_matrix()
    return float(np.degrees(Rotation.from_matrix(facing.T @ seen.joints.pelvis).magnitude()))


def shoulders_turned(seen: Seen) -> float:
    facing = Rotation.from_euler("z", seen.pose.target.facing).as_matrix()
    return abs(orientation(facing.T @ seen.joints.torso).turn)


def hands_apart(seen: Seen) -> float:
    left, right = (seen.data.site(f"{side}_fingertips").xpos for side in Side)
    return 1e3 * float(np.linalg.norm(left - right))


def back_bend(seen: Seen) -> float:
    return -read_joints(seen.joints, solver().figure).body.bend


def face_raised(seen: Seen) -> float:
    return float(np.degrees(np.arcsin(seen.joints.head[2, 0])))


def wrist_break(seen: Seen) -> float:
    arm = seen.joints.between("right_elbow", "right_wrist")
    hand = -seen.data.body("right_hand").xmat.reshape(3, 3)[:, 2]
    return _between(arm, hand)


def elbow(seen: Seen) -> float:
    return seen.angle("left_shoulder", "left_elbow", "left_wrist")


def knee(seen: Seen) -> float:
    return max(seen.angle(f"{s}_hip", f"{s}_knee", f"{s}_ankle") for s in Side)


def leg_height(seen: Seen) -> float:
    leg = seen.joints["right_ankle"] - seen.joints["right_hip"]
    return _between(leg, np.array([0.0, 0.0, -1.0]))


FAULTS = tuple(Fault(**entry) for entry in tomllib.loads(LIST.read_text(encoding="utf-8"))["fault"])


def table() -> str:
    """Every fault with its cure and its figure."""
    lines = ["| | where | fault | cure | measured | on | may be |", "| --- " * 7 + "|"]
    for number, fault in enumerate(FAULTS, 1):
        gap = " " if fault.unit == "mm" else ""
        low, high = (f"{x:g}{gap}{fault.unit}" for x in (fault.least, fault.most))
        bounds = f"{low} to {high}" if fault.least > 0 else f"at most {high}"
        who = ", the real dancer" if fault.real else ""
        lines.append(
            f"| {number} | {fault.section} | {fault.fault} | {fault.cure} | {fault.what}: "
            f"**{fault.figure()}** | {fault.pose}{who} | {bounds} |"
        )
    return "\n" + "\n".join(lines) + "\n\n"


if __name__ == "__main__":
    page = PAGE.read_text(encoding="utf-8")
    PAGE.write_text(MARKED.sub(lambda m: m[1] + table() + m[2], page), encoding="utf-8")
    if "--pictures" in sys.argv:
        sys.path.insert(0, str(DOCS))
        from fault_pictures import draw

        draw(FAULTS, solved, solver().model, PICTURE)
