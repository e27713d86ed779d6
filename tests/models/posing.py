"""Helpers of the model tests: targets and key poses solved once, mirror images, measures."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from functools import cache

import mujoco
import numpy as np
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from enpointe.models import (
    Anthropometry,
    Figure,
    KeyPose,
    KeyPoseSolver,
    PoseTarget,
    Sex,
    Style,
    dancer_model,
    pose_target,
)
from enpointe.models.stances import Ground, StanceTracker
from enpointe.notation import (
    ResolvedFrame,
    Score,
    load_score,
    mirrored,
    parse_score,
    shipped_scores,
)
from enpointe.posing import vocabulary_score

_HEADER = "benesh 1\ntitle: Test\nmethod: Cecchetti\nmetre: 4/4\ntempo: 60\n"

DANCERS = {
    "default": Anthropometry(),
    "tall man": Anthropometry(1.84, 76.0, Sex.MALE),
    "small woman": Anthropometry(1.52, 44.0, Sex.FEMALE),
}
PERFECT, REAL = Style(), Style(real=True)
STYLES = {"perfect": PERFECT, "real": REAL}


@st.composite
def measures(draw: st.DrawFn) -> Anthropometry:
    """Any body that may be built."""
    height = draw(st.floats(1.30, 2.10))
    index = draw(st.floats(14.01, 34.99))
    return Anthropometry(height, index * height**2, draw(st.sampled_from(Sex)))


def written_score(*frames: tuple[str, ...]) -> Score:
    """A score of these frames, each the lines under its beat, one beat apart."""
    text = _HEADER
    for beat, lines in enumerate(frames):
        text += f"\nbeat {beat}:\n" + "".join(f"  {line}\n" for line in lines)
    return parse_score(text)


def written(*lines: str) -> ResolvedFrame:
    """The frame that these lines of a score mean."""
    return written_score(lines).resolved()[0]


def grounds(score: Score, figure: Figure, style: Style = PERFECT) -> list[Ground]:
    """The floor under each frame of a score, followed from its start."""
    tracker = StanceTracker(figure, style.turnout_deg)
    return [tracker.follow(frame) for frame in score.resolved()]


def score_called(name: str) -> Score:
    """A shipped score, or the score of one position of the vocabulary."""
    if name in shipped_scores():
        return load_score(name)
    score = vocabulary_score(name)
    assert score is not None, name
    return score


def shipped(name: str, index: int) -> ResolvedFrame:
    """One frame of a shipped score."""
    return load_score(name).resolved()[index]


@cache
def targets_of(
    name: str, dancer: str = "default", style: Style = PERFECT, other_side: bool = False
) -> tuple[PoseTarget, ...]:
    """What each frame of a score or position asks, on the ground where the score leads."""
    score, figure = score_called(name), solver_of(dancer).figure
    score = mirrored(score) if other_side else score
    return tuple(
        pose_target(frame, figure, style, ground=ground, name=f"{name}, beat {frame.beat}")
        for frame, ground in zip(score.resolved(), grounds(score, figure, style), strict=True)
    )


@cache
def solved(
    name: str,
    index: int = 0,
    dancer: str = "default",
    style: Style = PERFECT,
    other_side: bool = False,
) -> KeyPose:
    """A key pose of a score or position, solved cold and once."""
    return solver_of(dancer).solve(targets_of(name, dancer, style, other_side)[index])


@cache
def solver_of(dancer: str) -> KeyPoseSolver:
    """The solver of one of `DANCERS`, with the problems it has built so far."""
    return KeyPoseSolver(dancer_model(DANCERS[dancer]))


def _distinct_frames() -> list[tuple[str, int]]:
    """Frames that ask what no frame before them asks; many a score returns to where it was."""
    seen: list[ResolvedFrame] = []
    chosen = []
    for name in shipped_scores():
        for index, frame in enumerate(load_score(name).resolved()):
            pose = replace(
                frame,
                beat=Fraction(0),
                travel=None,
                turn=None,
                paths={},
                locomotion={},
                jump=None,
                pose=None,
            )
            if pose not in seen:
                seen.append(pose)
                chosen.append((name, index))
    return chosen


SHIPPED = _distinct_frames()
"""Every key pose that is shipped, once: name of the score and index of the frame."""


def other_side(name: str) -> str:
    """The name of the same part on the other side; of a part in the middle, its own."""
    if name.startswith("left_"):
        return "right_" + name.removeprefix("left_")
    if name.startswith("right_"):
        return "left_" + name.removeprefix("right_")
    return name


def mirrored_qpos(model: mujoco.MjModel, qpos: np.ndarray) -> np.ndarray:
    """The configuration of the dancer in the mirror, across the plane y = 0."""
    image = np.array(qpos)
    image[1] = -qpos[1]
    image[3:7] = qpos[3:7] * [1, -1, 1, -1]
    for j in range(1, model.njnt):
        name = model.joint(j).name
        sign = -1.0 if name.endswith(("_turn", "_tilt")) and other_side(name) == name else 1.0
        image[model.jnt_qposadr[j]] = sign * qpos[model.joint(other_side(name)).qposadr[0]]
    return image


def same_pose(one: np.ndarray, other: np.ndarray, atol: float) -> bool:
    """Whether two configurations agree, m and rad; q and -q are one rotation."""
    turned = Rotation.from_quat(one[3:7], scalar_first=True).inv() * Rotation.from_quat(
        other[3:7], scalar_first=True
    )
    rest = np.delete(np.abs(one - other), np.s_[3:7])
    return bool(turned.magnitude() < 2 * atol and rest.max() < atol)


def tangent(qpos: np.ndarray, facing: float = 0.0) -> np.ndarray:
    """Root position, root rotation vector from `facing` and hinge angles (nv,)."""
    upright = Rotation.from_euler("z", facing)
    turned = upright.inv() * Rotation.from_quat(qpos[3:7], scalar_first=True)
    return np.concatenate([qpos[:3], turned.as_rotvec(), qpos[7:]])


def at(model: mujoco.MjModel, qpos: np.ndarray) -> mujoco.MjData:
    """MuJoCo's data of a configuration, with its contacts."""
    data = mujoco.MjData(model)
    data.qpos[:] = qpos
    mujoco.mj_forward(model, data)
    return data


def standing(model: mujoco.MjModel) -> np.ndarray:
    return np.array(model.key("standing").qpos)


def random_qpos(model: mujoco.MjModel, rng: np.random.Generator) -> np.ndarray:
    """A dancer anywhere, turned any way, with every hinge anywhere in its range."""
    low, high = model.jnt_range[1:].T
    quaternion = rng.normal(size=4)
    return np.concatenate(
        [
            rng.uniform(-1, 1, 3),
            quaternion / np.linalg.norm(quaternion),
            rng.uniform(low, high),
        ]
    )


def random_tangent(model: mujoco.MjModel, rng: np.random.Generator) -> np.ndarray:
    """Root, rotation vector up to nearly a half turn, and hinges (nv,), anywhere."""
    vector = rng.normal(size=3)
    vector *= rng.uniform(0.1, 3.0) / np.linalg.norm(vector)
    return np.concatenate([rng.uniform(-1, 1, 3), vector, random_qpos(model, rng)[7:]])


def hinge(model: mujoco.MjModel, qpos: np.ndarray, name: str) -> float:
    """The angle of a hinge, degrees."""
    return float(np.degrees(qpos[model.joint(name).qposadr[0]]))


def contact_pairs(model: mujoco.MjModel, data: mujoco.MjData) -> list[tuple[str, str, float]]:
    """Names of the geoms in each contact, in alphabetical order, and the distance, m."""
    pairs = []
    for contact in data.contact[: data.ncon]:
        first, second = sorted(model.geom(int(g)).name for g in contact.geom)
        pairs.append((first, second, float(contact.dist)))
    return pairs


def overlaps(model: mujoco.MjModel, qpos: np.ndarray) -> dict[frozenset[str], float]:
    """Limbs more than 2 mm in one another and soles more than 3 mm in the floor: depth, mm."""
    found: dict[frozenset[str], float] = {}
    for first, second, distance in contact_pairs(model, at(model, qpos)):
        allowed = 3e-3 if "floor" in (first, second) else 2e-3
        if distance < -allowed:
            pair = frozenset((first.removesuffix("_limb"), second.removesuffix("_limb")))
            found[pair] = max(found.get(pair, 0.0), -1e3 * distance)
    return found


def rotation_between(data: mujoco.MjData, outer: str, inner: str) -> Rotation:
    one, two = (Rotation.from_matrix(data.body(b).xmat.reshape(3, 3)) for b in (outer, inner))
    return one.inv() * two


def in_frame(data: mujoco.MjData, body: str, point: np.ndarray) -> np.ndarray:
    seen: np.ndarray = data.body(body).xmat.reshape(3, 3).T @ (point - data.body(body).xpos)
    return seen
