"""How feet stand: flat, on demi-pointe and on pointe, straight and in plié."""

from __future__ import annotations

from functools import cache
from math import radians

import mujoco
import numpy as np
import pytest

from enpointe.models import KeyPose, KeyPoseSolver, Style, dancer_model, pose_target
from enpointe.models.contact_geometry import PLATFORM_RISE
from enpointe.models.leg_target import DEMI_POINTE_DEG, OnPointe, Standing
from enpointe.models.stances import StanceTracker
from enpointe.notation import Side

from .checking import along, check_certified, check_in_mujoco, heading, too_deep
from .posing import STYLES, at, hinge, rotation_between, solver_of, written

STANCES = ("first", "second", "third", "fourth", "fourth open", "fifth", "one foot")
ON_FLOOR = (
    "straight",
    "demi-plié",
    "grand plié",
    "demi-pointe, straight",
    "demi-pointe, demi-plié",
    "pointe, straight",
    "pointe, demi-plié",
)
CROSSED = ("third", "fourth", "fourth open", "fifth")


def lines_of(stance: str, floor: str) -> tuple[str, ...]:
    if stance == "one foot":
        return (f"left leg: {floor}", "right leg: retiré devant", "arms: à la seconde")
    front = " right front" if stance in CROSSED else ""
    return (f"feet: {stance}{front}, {floor}", "arms: à la seconde")


@cache
def stood(stance: str, floor: str, style: str) -> KeyPose:
    solver = solver_of("default")
    return solver.solve(
        pose_target(written(*lines_of(stance, floor)), solver.figure, STYLES[style])
    )


def every(stances: tuple[str, ...], floors: tuple[str, ...]) -> pytest.MarkDecorator:
    return pytest.mark.parametrize(
        ("stance", "floor"),
        [(stance, floor) for stance in stances for floor in floors],
    )


@every(STANCES, ON_FLOOR)
@pytest.mark.parametrize("style", STYLES)
def test_every_stance_is_certified_and_so_in_mujoco(
    stance: str, floor: str, style: str, model: mujoco.MjModel
) -> None:
    found = stood(stance, floor, style)
    check_certified(found, written(*lines_of(stance, floor)), style)
    check_in_mujoco(model, found)
    assert too_deep(model, found.qpos) == {}


@every(STANCES, ("demi-pointe, straight", "demi-pointe, demi-plié"))
def test_on_demi_pointe_the_heel_is_raised_over_a_ball_that_stays(
    stance: str, floor: str, model: mujoco.MjModel
) -> None:
    """Ball and toes of each sole on the floor and where they were flat; the heel by the angle."""
    raised = at(model, stood(stance, floor, "perfect").qpos)
    flat = at(model, stood(stance, "straight", "perfect").qpos)
    for side in (Side.LEFT,) if stance == "one foot" else Side:
        for part in ("ball", "tip"):
            for edge in ("inner", "outer"):
                sphere = f"{side}_{part}_{edge}"
                assert np.allclose(raised.geom(sphere).xpos, flat.geom(sphere).xpos, atol=2e-3)
        foot = raised.body(f"{side}_foot").xmat.reshape(3, 3)[:, 0]
        assert np.degrees(np.arcsin(-foot[2])) == pytest.approx(DEMI_POINTE_DEG, abs=0.6)
        length = np.linalg.norm(raised.site(f"{side}_heel").xpos - raised.site(f"{side}_ball").xpos)
        rise = raised.site(f"{side}_heel").xpos[2] - raised.site(f"{side}_ball").xpos[2]
        assert rise == pytest.approx(length * np.sin(radians(DEMI_POINTE_DEG)), abs=3e-3)


@every(STANCES, ("pointe, straight", "pointe, demi-plié"))
@pytest.mark.parametrize("style", STYLES)
def test_on_pointe_only_the_tips_are_on_the_floor(
    stance: str, floor: str, style: str, model: mujoco.MjModel
) -> None:
    """The tips at height 0, the toes upright under a foot that leans back over them.

    Within 15 degrees, the more the legs open, and 25.
    """
    data = at(model, stood(stance, floor, style).qpos)
    for side in (Side.LEFT,) if stance == "one foot" else Side:
        tip, ball, heel = (data.site(f"{side}_{p}").xpos for p in ("toe_tip", "ball", "heel"))
        assert abs(tip[2]) < 2e-3
        assert 0.03 < ball[2] < heel[2]
        for part in (ball - tip, heel - ball):
            assert part[2] / np.linalg.norm(part) > np.cos(radians(25))
        toes = data.body(f"{side}_toe").xmat.reshape(3, 3)[:, 0]
        assert -toes[2] > np.cos(radians(15))


@cache
def shod() -> KeyPoseSolver:
    return KeyPoseSolver(dancer_model(flesh=False, pointe_shoes=True))


@every(STANCES, ("pointe, straight", "pointe, demi-plié"))
def test_pointe_shoes_stand_on_the_floor_and_not_in_it(stance: str, floor: str) -> None:
    """All four corners where the legs hardly lean, an edge in second and fourth."""
    solver = shod()
    pose = solver.solve(pose_target(written(*lines_of(stance, floor)), solver.figure))
    data = at(solver.model, pose.qpos)
    for side in (Side.LEFT,) if stance == "one foot" else Side:
        corners = [
            data.geom(f"{side}_platform_{part}_{edge}").xpos[2]
            - solver.model.geom(f"{side}_platform_{part}_{edge}").size[0]
            for part in ("under", "upper")
            for edge in ("inner", "outer")
        ]
        opens = floor.endswith("straight") and stance in ("second", "fourth", "fourth open")
        assert min(corners) == pytest.approx(0.0, abs=5e-4)
        assert max(corners) < (0.01 if opens else 5e-4)


@pytest.mark.parametrize("floor", ["demi-pointe, straight", "pointe, straight"])
@pytest.mark.parametrize("stance", [s for s in STANCES if s != "second"])
def test_a_rise_lifts_the_dancer_and_a_plie_lowers_her(stance: str, floor: str) -> None:
    heights = [
        stood(stance, f, "perfect").qpos[2]
        for f in (
            "grand plié",
            "demi-plié",
            "straight",
            "demi-pointe, straight",
            "pointe, straight",
        )
    ]
    assert heights == sorted(heights)
    assert min(np.diff(heights)) > 0.02


@every(STANCES, ("demi-plié",))
@pytest.mark.parametrize("style", STYLES)
def test_in_a_demi_plie_the_heels_stay_down_under_knees_bent_as_asked(
    stance: str, floor: str, style: str, model: mujoco.MjModel
) -> None:
    found = stood(stance, floor, style)
    data = at(model, found.qpos)
    for side in (Side.LEFT,) if stance == "one foot" else Side:
        for edge in ("inner", "outer"):
            assert data.geom(f"{side}_heel_{edge}").xpos[2] == pytest.approx(0.012, abs=1e-3)
        bend = hinge(model, found.qpos, f"{side}_knee_bend")
        apart = stance.startswith("fourth")
        asked = Style().demi_plie_in_fourth_deg if apart else Style().demi_plie_deg
        assert bend == pytest.approx(asked, abs=1)


@pytest.mark.parametrize("degrees", [30.0, 45.0, 58.0])
def test_a_plie_is_as_deep_as_the_method_has_it(degrees: float, model: mujoco.MjModel) -> None:
    solver = solver_of("default")
    frame = written("feet: first, demi-plié", "arms: demi-seconde")
    target = pose_target(frame, solver.figure, Style(demi_plie_deg=degrees))
    found = solver.solve(target)
    assert found.held, str(found.certificate)
    for side in Side:
        bend = hinge(model, found.qpos, f"{side}_knee_bend")
        assert bend == pytest.approx(degrees, abs=0.2)


@every(STANCES, ("grand plié",))
def test_a_grand_plie_is_deep_with_heels_down_only_where_the_feet_are_wide(
    stance: str, floor: str, model: mujoco.MjModel
) -> None:
    found, style = stood(stance, floor, "perfect"), Style()
    wanted = 0.0 if stance == "second" else style.grand_plie_rise_deg
    data = at(model, found.qpos)
    for side in (Side.LEFT,) if stance == "one foot" else Side:
        foot = data.body(f"{side}_foot").xmat.reshape(3, 3)[:, 0]
        assert np.degrees(np.arcsin(-foot[2])) == pytest.approx(wanted, abs=0.6)
        bend = hinge(model, found.qpos, f"{side}_knee_bend")
        assert bend == pytest.approx(style.grand_plie_deg, abs=1)


KNEES_MM = {"perfect": 90.0, "real": 130.0}
"""Farthest that the certificate's table lets a knee fall in beside its toes."""


@every(STANCES, ("demi-plié", "grand plié", "demi-pointe, demi-plié"))
@pytest.mark.parametrize("style", STYLES)
def test_the_knees_are_over_the_toes_by_as_much_as_the_certificate_says(
    stance: str, floor: str, style: str, model: mujoco.MjModel
) -> None:
    """Measured in MuJoCo: how far the knee is beside the foot's line, seen from above."""
    found = stood(stance, floor, style)
    data = at(model, found.qpos)
    results = {result.rule: result for result in found.certificate.results}
    for side in (Side.LEFT,) if stance == "one foot" else Side:
        leg = found.target.legs[side]
        assert isinstance(leg, Standing)
        across = np.array([-along(leg.footprint)[1], along(leg.footprint)[0]])
        beside = across @ (data.site(f"{side}_knee").xpos - data.body(f"{side}_toe").xpos)[:2]
        result = results[f"{side} knee over the toe"]
        assert result.value == pytest.approx(1e3 * abs(beside), abs=1.0)
        assert result.held is bool(result.value <= 30.0)
        assert result.value < KNEES_MM[style]
        ahead = (
            along(leg.footprint)
            @ (data.site(f"{side}_knee").xpos - data.site(f"{side}_heel").xpos)[:2]
        )
        assert ahead > 0.05  # in front of the heel, not behind it


def test_a_foot_that_rises_on_pointe_draws_in(model: mujoco.MjModel) -> None:
    """Sous-sus: both tips come nearer to one another than flat feet have them."""
    solver = solver_of("default")
    apart = {}
    for floor in ("straight", "pointe, straight"):
        frame = written(*lines_of("fifth", floor))
        ground = StanceTracker(solver.figure, 66.0).follow(frame)
        tips = [
            p.point(solver.figure.ball_forward + solver.figure.toe_length)
            for p in ground.prints.values()
        ]
        apart[floor] = np.linalg.norm(tips[0] - tips[1])
    assert apart["pointe, straight"] < 0.6 * apart["straight"]


@pytest.mark.parametrize("style", STYLES)
@every(("first", "third", "fourth", "fifth"), ("straight", "demi-pointe, straight"))
def test_standing_feet_are_turned_out_alike_and_the_hips_are_square(
    stance: str, floor: str, style: str, model: mujoco.MjModel
) -> None:
    data = at(model, stood(stance, floor, style).qpos)
    left, right = (heading(data, f"{side}_toe", 0) for side in Side)
    assert np.allclose(left * [1, -1], right, atol=0.02)
    assert np.degrees(rotation_between(data, "world", "pelvis").magnitude()) < 5


def test_a_footprint_on_pointe_bears_on_its_platform() -> None:
    """3 x 4 cm, as far before the tip of the sole as it is above it in a flat foot."""
    target = stood("one foot", "pointe, straight", "perfect").target
    leg = target.legs[Side.LEFT]
    assert isinstance(leg, OnPointe)
    figure = target.figure
    corners = leg.soles(figure)
    middle = leg.footprint.point(figure.ball_forward + figure.toe_length + PLATFORM_RISE)
    assert np.allclose(corners.mean(axis=0), middle)
    local = (corners - middle) @ along(leg.footprint)
    assert sorted(np.round(local, 6)) == [-0.015, -0.015, 0.015, 0.015]
    assert np.allclose(np.linalg.norm(corners - middle, axis=1), np.hypot(0.015, 0.02))
