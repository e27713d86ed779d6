"""Rules and their derivatives: every one, for every structure of a pose, on both dancers."""

from __future__ import annotations

from dataclasses import replace

import casadi as ca
import mujoco
import numpy as np
import pytest

from enpointe.models import Figure, PoseTarget, Style, dancer_model, pose_target
from enpointe.models.kinematics import SymbolicBody, qpos_from_tangent
from enpointe.models.leg_target import InAir, Passing, Standing
from enpointe.models.rules import (
    Rule,
    Symbols,
    arms,
    balance,
    clearance,
    feet,
    hip,
    legs,
    rules_for,
    stance,
)

from .posing import random_tangent, written

ARMS = {
    "rounded": ("arms: à la seconde",),
    "straight": ("arms: second arabesque left leads",),
    "written elbow": (
        "left elbow: 0.45 wide, 4 high, level",
        "left hand: 0.45 wide, 4.5 high, front",
        "right elbow: 0.5 wide, 3.6 high, behind",
        "right hand: 0.28 wide, 3.1 high, front",
    ),
}
LEGS = {
    "on the floor": ("feet: fifth right front",),
    "in the air": ("left foot: 0.09 wide, 1 high, level", "right foot: 0.1 wide, 2 high, front"),
    "demi-plié": ("feet: second, demi-plié",),
    "grand plié": ("feet: fifth left front, grand plié",),
    "demi-pointe": ("feet: fifth right front, demi-pointe",),
    "pointe": ("feet: first, pointe",),
    "pointe in plié": ("left leg: pointe, demi-plié", "right leg: attitude derrière"),
    "tendu": ("left leg: straight", "right leg: tendu derrière"),
    "tendu in fondu": ("left leg: demi-plié", "right leg: tendu seconde"),
    "retiré": ("right leg: straight, demi-pointe", "left leg: retiré devant"),
    "cou-de-pied": ("left leg: demi-plié", "right leg: cou-de-pied derrière"),
    "jumping": ("left leg: pointed derrière", "right leg: raised devant 90"),
    "bent in the air": (
        "left foot: 0.09 wide, 1 high, level",
        "right knee: 0.4 wide, 2.4 high, level",
        "right foot: 0.05 wide, 1.9 high, behind",
    ),
}
OTHERS = ("head: turn left 20, tilt right 10", "body: bend back 10", "pelvis: turn right 5")


def on_its_way(target: PoseTarget) -> PoseTarget:
    """The same pose with its legs in the air passing, and those on the floor yielding."""
    angles = np.radians([30.0, -5.0, 40.0, 20.0, 40.0, 5.0, -3.0, 2.0])
    legs = {
        side: Passing(angles)
        if isinstance(leg, InAir)
        else replace(leg, yields=True, rise=0.3)
        if isinstance(leg, Standing)
        else leg
        for side, leg in target.legs.items()
    }
    standing = any(isinstance(leg, Standing) for leg in legs.values())
    com = np.array([0.1, 0.05, 0.9]) if standing else target.com
    return replace(target, legs=legs, com=com)


def targets(figure: Figure) -> dict[str, PoseTarget]:
    """One of every structure: each arm on both legs, each leg of both dancers, passing legs."""
    on_floor = LEGS["on the floor"]
    found = {
        f"{shape} arms": pose_target(written(*on_floor, *lines, *OTHERS), figure)
        for shape, lines in ARMS.items()
    }
    for way, lines in LEGS.items():
        frame = written(*lines, *ARMS["rounded"], *OTHERS, "face: corner 2")
        for style in (Style(), Style(real=True)):
            target = pose_target(frame, figure, style)
            dancer = "real" if style.real else "perfect"
            found[f"{way}, {dancer}"] = target
            if any(isinstance(leg, InAir) for leg in target.legs.values()):
                found[f"{way}, {dancer}, passing"] = on_its_way(target)
    return found


TARGETS = targets(Figure.of(dancer_model()))


def test_every_rule_is_among_those_differentiated() -> None:
    """No rule of the package is left out of the test below."""
    used = {type(rule) for target in TARGETS.values() for rule in rules_for(target)}
    written_down = {
        value
        for module in (arms, balance, clearance, feet, hip, legs, stance)
        for value in vars(module).values()
        if isinstance(value, type) and issubclass(value, Rule) and hasattr(value, "name")
    }
    assert written_down == used


@pytest.mark.parametrize("name", TARGETS)
def test_every_rule_s_jacobian_agrees_with_finite_differences(
    name: str, model: mujoco.MjModel, rng: np.random.Generator
) -> None:
    target = TARGETS[name]
    x, symbols = ca.SX.sym("x", model.nv), Symbols()
    facing = symbols("facing")
    body = SymbolicBody(model, qpos_from_tangent(model, x, facing))
    rules = rules_for(target)
    residuals = [rule.residual(body, symbols) for rule in rules]
    labels = [
        rule.label for rule, r in zip(rules, residuals, strict=True) for _ in range(r.numel())
    ]
    stacked, p = ca.vertcat(*residuals), symbols.vector
    measure = ca.Function("r", [x, p], [stacked])
    jacobian = ca.Function("J", [x, p], [ca.jacobian(stacked, x)])
    values = {"facing": np.array(target.facing)}
    for rule in rules:
        values |= rule.values(target)
    numbers = symbols.fill(values)
    for _ in range(3):
        point = random_tangent(model, rng)
        exact = np.asarray(jacobian(point, numbers))
        slope = central_difference(measure, point, numbers)
        assert np.isfinite(exact).all()
        wrong = ~np.isclose(exact, slope, rtol=1e-4, atol=1e-7).all(axis=1)
        assert not wrong.any(), {label for label, bad in zip(labels, wrong, strict=True) if bad}


def central_difference(
    function: ca.Function, point: np.ndarray, numbers: np.ndarray, step: float = 1e-6
) -> np.ndarray:
    columns = []
    for shift in step * np.eye(len(point)):
        ahead, behind = function(point + shift, numbers), function(point - shift, numbers)
        columns.append(np.asarray(ahead - behind).ravel() / (2 * step))
    return np.stack(columns, axis=1)


def test_a_target_moves_the_residual_by_as_much(
    model: mujoco.MjModel, figure: Figure, rng: np.random.Generator
) -> None:
    """A sign moved by 3 cm moves the residual of the hand by 3 cm, in any configuration."""
    target = pose_target(written("feet: first", "arms: à la seconde"), figure)
    rule = next(r for r in rules_for(target) if r.label == "left hand on its sign")
    x, symbols = ca.SX.sym("x", model.nv), Symbols()
    residual = rule.residual(SymbolicBody(model, qpos_from_tangent(model, x)), symbols)
    measure = ca.Function("r", [x, symbols.vector], [residual])

    def at_target(goal: PoseTarget, point: np.ndarray) -> np.ndarray:
        return np.asarray(measure(point, symbols.fill(rule.values(goal)))).ravel()

    left, right = target.arms.values()
    moved = replace(
        target,
        arms=dict(
            zip(
                target.arms,
                (replace(left, wrist=left.wrist + np.array([0, 0.03, 0])), right),
                strict=True,
            )
        ),
    )
    point = random_tangent(model, rng)
    assert np.allclose(at_target(target, point) - at_target(moved, point), [0, 0.03, 0])
