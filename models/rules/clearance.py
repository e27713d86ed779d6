"""Limbs keep clear of one another: the distance of capsules, as smooth expressions."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import product
from typing import ClassVar

import casadi as ca
import numpy as np
from numpy.typing import NDArray

from enpointe.models.kinematics import Capsule, SymbolicBody
from enpointe.models.rules.base import Kind, Rule, Symbols
from enpointe.models.target import PoseTarget
from enpointe.notation import Side

__all__ = ["ArmsClearOfLegs", "ArmsClearOfTheBody", "LegsApart", "gap"]

_SOFTNESS = 0.02
"""Over this share of a limb's length the end of a capsule is rounded off."""
_PARALLEL = 1e-3
"""Squared sine of the angle below which two limbs are taken for parallel: 2 degrees."""
_LEG = ("thigh", "shank", "foot")
_SOURCE = "Neagle 2005 §4.5.3 (limbs through the body); the compiled capsules"


@dataclass(frozen=True)
class _Clearance(Rule):
    """The gap between the surfaces of every pair of capsules."""

    unit: ClassVar[str] = "mm"
    bound: ClassVar[float] = 1.0
    source: ClassVar[str] = _SOURCE

    @property
    def pairs(self) -> tuple[tuple[str, str], ...]:
        """Names of the geoms that are kept apart."""
        raise NotImplementedError

    def residual(self, body: SymbolicBody, symbols: Symbols) -> ca.SX:
        return ca.vertcat(*(gap(body.capsule(a), body.capsule(b)) for a, b in self.pairs))

    def values(self, target: PoseTarget) -> dict[str, NDArray[np.float64]]:
        return {}


@dataclass(frozen=True)
class LegsApart(_Clearance):
    """No leg goes through the other: gap(thigh, shank, foot; thigh, shank, foot) >= 1 mm."""

    name: ClassVar[str] = "legs clear of each other"
    kind: ClassVar[Kind] = Kind.AT_LEAST

    @property
    def pairs(self) -> tuple[tuple[str, str], ...]:
        return tuple((f"left_{a}_limb", f"right_{b}_limb") for a, b in product(_LEG, _LEG))


@dataclass(frozen=True)
class ArmsClearOfLegs(_Clearance):
    """Hands and forearms stay out of the thighs, and of the shanks of the legs that are lifted."""

    name: ClassVar[str] = "arms clear of the legs"
    kind: ClassVar[Kind] = Kind.AT_LEAST
    lifted: tuple[Side, ...] = ()

    @property
    def pairs(self) -> tuple[tuple[str, str], ...]:
        legs = [f"{side}_thigh" for side in Side] + [f"{side}_shank" for side in self.lifted]
        arms = [f"{side}_{part}" for side in Side for part in ("forearm", "hand")]
        return tuple((f"{arm}_limb", f"{leg}_limb") for arm, leg in product(arms, legs))


@dataclass(frozen=True)
class ArmsClearOfTheBody(_Clearance):
    """Hands and forearms stay out of head, trunk and each other.

    Measured and not solved for: the signs of arms and head leave them no freedom to give way with.
    """

    name: ClassVar[str] = "arms clear of the body"
    kind: ClassVar[Kind] = Kind.CHECK_AT_LEAST

    @property
    def pairs(self) -> tuple[tuple[str, str], ...]:
        trunk = ("head_limb", "torso_limb", "torso_chest", "pelvis_limb")
        left, right = ([f"{side}_{part}_limb" for part in ("forearm", "hand")] for side in Side)
        return (*product((*left, *right), trunk), *product(left, right))


def gap(one: Capsule, other: Capsule) -> ca.SX:
    """Distance between the surfaces of two capsules, m; negative where they overlap.

    The nearest points p = a + s u and q = b + t v of the axes by Ericson (2005, Real-Time Collision
    Detection, §5.1.9): the lines' own s, then t for it, then s for that t, each clamped to [0, 1].
    The clamp is rounded off, so that derivatives exist everywhere; any s and t give a distance that
    is never too short, and too long only by the square of what the rounding moves them: 0.3 mm.
    """
    u, v = one.end - one.start, other.end - other.start
    apart = one.start - other.start
    uu, vv, uv = ca.sumsqr(u), ca.sumsqr(v), ca.dot(u, v)
    au, av = ca.dot(apart, u), ca.dot(apart, v)
    square = uu * vv
    across = square - uv * uv
    middle = uv * av - au * vv - 0.5 * across
    s = _clamped(0.5 + middle / (across + _PARALLEL * square))
    t = _clamped((uv * s + av) / vv)
    s = _clamped((uv * t - au) / uu)
    between = apart + s * u - t * v
    return ca.sqrt(ca.sumsqr(between) + 1e-10) - (one.radius + other.radius)


def _clamped(share: ca.SX) -> ca.SX:
    """A share held within 0 and 1, smoothly."""
    square = _SOFTNESS**2
    return 0.5 * (1 + ca.sqrt(share**2 + square) - ca.sqrt((share - 1) ** 2 + square))
