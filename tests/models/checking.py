"""What a certificate says and promises, the latter measured anew by MuJoCo."""

from __future__ import annotations

import mujoco
import numpy as np
import pytest

from enpointe.models import Figure, KeyPose, PoseTarget
from enpointe.models.contact_geometry import PLATFORM, PLATFORM_RISE
from enpointe.models.foot_positions import Footprint, support_hull
from enpointe.models.leg_target import (
    FOOT_JOINTS,
    POINTED_DEG,
    InAir,
    LegTarget,
    OnPointe,
    Passing,
    Standing,
    ToeOnFloor,
    ToeOnLeg,
)
from enpointe.models.rules.balance import centroid, half_planes
from enpointe.notation import ResolvedFrame, Side

from .exceptions import OVERLAPS, allowed
from .posing import at, hinge, in_frame, overlaps

EDGES = ("inner", "outer")
MM = 1e-3
TOE = 0.011
"""Flesh under the tip of a stretched toe, m."""


def check_certified(found: KeyPose, frame: ResolvedFrame, who: str) -> None:
    """Legal, and every rule held but those that the table of exceptions names."""
    broken = {r.rule.removeprefix("left ").removeprefix("right ") for r in found.certificate.broken}
    assert found.certificate.legal, str(found.certificate)
    assert broken <= allowed(frame, who), str(found.certificate)
    assert found.held is (not broken)
    if found.held:
        assert str(found.certificate) == f"all {len(found.certificate.results)} rules held"


def check_in_mujoco(model: mujoco.MjModel, found: KeyPose) -> None:
    """All that a legal pose promises."""
    data, target = at(model, found.qpos), found.target
    assert np.linalg.norm(found.qpos[3:7]) == pytest.approx(1)
    low, high = model.jnt_range[1:].T
    assert (found.qpos[7:] >= low).all()
    assert (found.qpos[7:] <= high).all()
    for side in Side:
        _check_arm(data, target, side)
        _check_leg(model, data, found, side)
    if target.com is None:
        room = support_margin(data, target)
        assert room > min(0.010, 0.5 * _most_room(data, target)) - 0.1 * MM
    else:
        assert np.linalg.norm(data.subtree_com[0] - target.com) < MM


def _check_arm(data: mujoco.MjData, target: PoseTarget, side: Side) -> None:
    wrist = in_frame(data, "torso", data.site(f"{side}_wrist").xpos)
    elbow = in_frame(data, "torso", data.site(f"{side}_elbow").xpos)
    assert np.linalg.norm(wrist - target.arms[side].wrist) < 2 * MM
    assert np.linalg.norm(elbow - target.arms[side].elbow) < 30 * MM


def _check_leg(model: mujoco.MjModel, data: mujoco.MjData, found: KeyPose, side: Side) -> None:
    leg: LegTarget = found.target.legs[side]
    knee = hinge(model, found.qpos, f"{side}_knee_bend")
    if isinstance(leg, Standing | OnPointe):
        assert knee == pytest.approx(np.degrees(leg.knee_bend), abs=1.1)
        if isinstance(leg, Standing):
            check_sole(model, data, leg, found.target.figure, side)
        else:
            check_pointe(data, leg, found.target.figure, side)
        return
    if isinstance(leg, Passing):
        return
    for joint, angle in zip(FOOT_JOINTS, POINTED_DEG, strict=True):
        assert hinge(model, found.qpos, f"{side}_{joint}") == pytest.approx(angle, abs=3)
    tip = data.site(f"{side}_toe_tip").xpos
    upright = found.target.upright
    if isinstance(leg, InAir):
        ankle = data.site(f"{side}_ankle").xpos - data.site(f"{side}_hip").xpos
        wanted = leg.ankle - found.target.figure.hips[side]
        assert np.linalg.norm(upright.T @ ankle - wanted) < 3.5 * MM
        assert leg.knee is not None or knee < 4
    elif isinstance(leg, ToeOnFloor):
        assert tip[2] == pytest.approx(TOE, abs=2 * MM)
        assert knee < 4
        place = upright.T @ (tip - data.body("pelvis").xpos)
        assert abs(np.dot(leg.across, place[:2])) < 2 * MM
    else:
        assert isinstance(leg, ToeOnLeg)
        gap = upright.T @ (tip - data.site(f"{side.other}_{leg.site}").xpos)
        outward = 1.0 if side is Side.LEFT else -1.0
        ahead, aside, up = leg.offset
        assert np.linalg.norm(gap - [ahead, outward * aside, up]) < 3.5 * MM


def check_sole(
    model: mujoco.MjModel, data: mujoco.MjData, leg: Standing, figure: Figure, side: Side
) -> None:
    """Ball and toes on the floor and on their mark; the heel down, or raised by the angle."""
    for part in ("ball", "tip") if leg.rise else ("heel", "ball", "tip"):
        for edge in EDGES:
            sphere = data.geom(f"{side}_{part}_{edge}")
            radius = model.geom(f"{side}_{part}_{edge}").size[0]
            assert abs(sphere.xpos[2] - radius) < MM
    joint = data.body(f"{side}_toe").xpos[:2]
    assert np.linalg.norm(joint - leg.footprint.point(figure.ball_forward)) < MM
    assert heading(data, f"{side}_toe", 0) @ along(leg.footprint) > np.cos(np.radians(0.6))
    foot = data.body(f"{side}_foot").xmat.reshape(3, 3)[:, 0]
    assert np.arcsin(-foot[2]) == pytest.approx(leg.rise, abs=np.radians(0.6))
    if not leg.rise:
        ankle = data.site(f"{side}_ankle").xpos[:2]
        assert np.linalg.norm(ankle - leg.footprint.ankle) < MM


def check_pointe(data: mujoco.MjData, leg: OnPointe, figure: Figure, side: Side) -> None:
    """The tip on the floor and on its mark, the toes within 15 degrees of the vertical.

    The foot over them stands less upright, by what the toes carry on of the line.
    """
    tip = data.site(f"{side}_toe_tip").xpos
    mark = leg.footprint.point(figure.ball_forward + figure.toe_length)
    assert np.linalg.norm(tip - [*mark, 0.0]) < 2 * MM
    foot = data.site(f"{side}_ball").xpos - data.site(f"{side}_heel").xpos
    assert -foot[2] / np.linalg.norm(foot) > np.cos(np.radians(25))
    toes = data.body(f"{side}_toe").xmat.reshape(3, 3)[:, 0]
    assert -toes[2] > np.cos(np.radians(15))
    aside = heading(data, f"{side}_toe", 1)
    across = np.array([-along(leg.footprint)[1], along(leg.footprint)[0]])
    assert aside @ across > np.cos(np.radians(0.6))


def heading(data: mujoco.MjData, body: str, axis: int) -> np.ndarray:
    """An axis of a body seen from above, (2,), of unit length."""
    seen = data.body(body).xmat.reshape(3, 3)[:2, axis]
    return np.asarray(seen / np.linalg.norm(seen))


def along(footprint: Footprint) -> np.ndarray:
    return np.array([np.cos(footprint.direction), np.sin(footprint.direction)])


def _ground(data: mujoco.MjData, target: PoseTarget) -> np.ndarray:
    """Hull of what bears weight: the spheres of the soles, or a pointe shoe's platform."""
    points = []
    for side, leg in target.legs.items():
        if isinstance(leg, OnPointe):
            ahead, tip = along(leg.footprint), data.site(f"{side}_toe_tip").xpos[:2]
            middle = tip + PLATFORM_RISE * ahead
            aside = np.array([-ahead[1], ahead[0]])
            long, broad = (0.5 * size for size in PLATFORM)
            points += [
                middle + a * long * ahead + b * broad * aside for a in (-1, 1) for b in (-1, 1)
            ]
        elif isinstance(leg, Standing):
            parts = ("ball", "tip") if leg.rise else ("heel", "ball", "tip")
            points += [data.geom(f"{side}_{p}_{e}").xpos[:2] for p in parts for e in EDGES]
    return support_hull(np.array(points))


def support_margin(data: mujoco.MjData, target: PoseTarget) -> float:
    """Distance of the CoM from the edge of the support, m; + inside."""
    normals, offsets = half_planes(_ground(data, target))
    return float((offsets - normals @ data.subtree_com[0][:2]).min())


def _most_room(data: mujoco.MjData, target: PoseTarget) -> float:
    hull = _ground(data, target)
    normals, offsets = half_planes(hull)
    return float((offsets - normals @ centroid(hull)).min())


def too_deep(model: mujoco.MjModel, qpos: np.ndarray) -> dict[tuple[str, str], float]:
    """Parts deeper in one another, or in the floor, than is let pass: depth, mm."""
    found = {}
    for pair, depth in overlaps(model, qpos).items():
        one, other = sorted(_without_side(part) for part in pair)
        if depth > OVERLAPS.get((one, other), 0.0):
            found[one, other] = depth
    return found


def _without_side(geom: str) -> str:
    words = [word for word in geom.split("_") if word not in ("left", "right", *EDGES)]
    return "_".join(words)
