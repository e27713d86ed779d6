"""Helpers of the model tests: frames from a few lines of score, mirror images, measures."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import mujoco
import numpy as np
import pytest
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from enpointe.models import Anthropometry, KeyPose, KeyPoseSolver, Sex, dancer_model
from enpointe.models.foot_positions import support_hull
from enpointe.models.rules.balance import half_planes
from enpointe.notation import (
    Orientation,
    ResolvedFrame,
    Side,
    load_score,
    parse_score,
    shipped_scores,
)

_HEADER = "benesh 1\ntitle: Test\nmethod: Cecchetti\nmetre: 4/4\ntempo: 60\n\nbeat 0:\n"

SHIPPED = [
    (name, index) for name in shipped_scores() for index in range(len(load_score(name).resolved()))
]
"""Every key pose that is shipped: name of the score and index of the frame."""

DANCERS = {
    "default": Anthropometry(),
    "tall man": Anthropometry(1.84, 76.0, Sex.MALE),
    "small woman": Anthropometry(1.52, 44.0, Sex.FEMALE),
}


@st.composite
def measures(draw: st.DrawFn) -> Anthropometry:
    """Any body that may be built."""
    height = draw(st.floats(1.30, 2.10))
    index = draw(st.floats(14.01, 34.99))
    return Anthropometry(height, index * height**2, draw(st.sampled_from(Sex)))


def written(*lines: str) -> ResolvedFrame:
    """The frame that these lines of a score mean."""
    return parse_score(_HEADER + "".join(f"  {line}\n" for line in lines)).resolved()[0]


def shipped(name: str, index: int) -> ResolvedFrame:
    """One frame of a shipped score."""
    return load_score(name).resolved()[index]


def mirrored_frame(frame: ResolvedFrame) -> ResolvedFrame:
    """What the dancer in the mirror does."""

    def turned(o: Orientation) -> Orientation:
        return Orientation(-o.turn, -o.tilt, o.bend)

    feet = frame.feet
    if feet is not None and feet.front is not None:
        feet = replace(feet, front=feet.front.other)
    return replace(
        frame,
        feet=feet,
        arms={side: frame.arms[side.other] for side in Side},
        foot_signs={side.other: sign for side, sign in frame.foot_signs.items()},
        knees={side.other: sign for side, sign in frame.knees.items()},
        head=turned(frame.head),
        body=turned(frame.body),
        pelvis=turned(frame.pelvis),
    )


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


def tangent(qpos: np.ndarray) -> np.ndarray:
    """Root position, root rotation vector and hinge angles (nv,) of a configuration (nq,)."""
    vector = Rotation.from_quat(qpos[3:7], scalar_first=True).as_rotvec()
    return np.concatenate([qpos[:3], vector, qpos[7:]])


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


def contact_pairs(model: mujoco.MjModel, data: mujoco.MjData) -> list[tuple[str, str, float]]:
    """Names of the geoms in each contact, in alphabetical order, and the distance, m."""
    pairs = []
    for contact in data.contact[: data.ncon]:
        first, second = sorted(model.geom(int(g)).name for g in contact.geom)
        pairs.append((first, second, float(contact.dist)))
    return pairs


SOLES = ("heel", "ball", "tip")


@cache
def solver_of(dancer: str) -> KeyPoseSolver:
    """The solver of one of `DANCERS`, with the problems it has built so far."""
    return KeyPoseSolver(dancer_model(DANCERS[dancer]))


def rotation_between(data: mujoco.MjData, outer: str, inner: str) -> Rotation:
    one, two = (Rotation.from_matrix(data.body(b).xmat.reshape(3, 3)) for b in (outer, inner))
    return one.inv() * two


def in_frame(data: mujoco.MjData, body: str, point: np.ndarray) -> np.ndarray:
    return data.body(body).xmat.reshape(3, 3).T @ (point - data.body(body).xpos)


def support_margin(data: mujoco.MjData, sides: list[Side]) -> float:
    """Distance of the CoM from the edge of the hull of the sole spheres, m; + inside."""
    points = [
        data.geom(f"{side}_{part}_{edge}").xpos[:2]
        for side in sides
        for part in SOLES
        for edge in ("inner", "outer")
    ]
    normals, offsets = half_planes(support_hull(np.array(points)))
    return float((offsets - normals @ data.subtree_com[0][:2]).min())


def check_in_mujoco(model: mujoco.MjModel, found: KeyPose) -> None:
    """All that a certificate promises, measured anew by MuJoCo."""
    target = found.target
    data = at(model, found.qpos)
    assert np.linalg.norm(found.qpos[3:7]) == pytest.approx(1)
    low, high = model.jnt_range[1:].T
    assert (found.qpos[7:] >= low).all()
    assert (found.qpos[7:] <= high).all()
    for side in Side:
        wrist = in_frame(data, "torso", data.site(f"{side}_wrist").xpos)
        elbow = in_frame(data, "torso", data.site(f"{side}_elbow").xpos)
        assert np.linalg.norm(wrist - target.arms[side].wrist) < 2e-3
        assert np.linalg.norm(elbow - target.arms[side].elbow) < 0.03
        leg = target.legs[side]
        if leg.footprint is not None:
            for part in SOLES:
                for edge in ("inner", "outer"):
                    sphere = data.geom(f"{side}_{part}_{edge}")
                    radius = model.geom(f"{side}_{part}_{edge}").size[0]
                    assert abs(sphere.xpos[2] - radius) < 1e-3
            ankle = data.site(f"{side}_ankle").xpos
            assert np.linalg.norm(ankle[:2] - leg.footprint.ankle) < 1e-3
            axis = data.body(f"{side}_foot").xmat.reshape(3, 3)[:2, 0]
            heading = np.array([np.cos(leg.footprint.direction), np.sin(leg.footprint.direction)])
            assert axis @ heading > np.cos(np.radians(0.6))
        else:
            ankle = in_frame(data, "pelvis", data.site(f"{side}_ankle").xpos)
            assert np.linalg.norm(ankle - leg.ankle) < 3e-3
    grounded = [side for side in Side if target.legs[side].footprint is not None]
    assert support_margin(data, grounded) > 0.0099
