"""What a sweep may change about the body and its stage, and what it drew for one run.

Each disturbance has an amount, drawn evenly from a range for every run. The controller keeps its
own picture of the dancer; only the simulated body, its floor and its senses are changed.
"""

from __future__ import annotations

import copy
from collections.abc import Mapping
from dataclasses import dataclass, field

import mujoco
import numpy as np
from numpy.random import Generator, SeedSequence, default_rng
from numpy.typing import NDArray

from enpointe.errors import EnpointeError
from enpointe.models.soles import sole_geoms
from enpointe.sim.push import Push

__all__ = ["KINDS", "USUAL", "Disturbances", "Factors", "Kind", "draw"]

Array = NDArray[np.float64]
PUSH_DURATION = 0.1
"""s."""
RECOVERY = 1.0
"""No push comes later than this before the end, s: she must have time to fall, or not to. In a
dance of less than twice that, none in its second half."""


@dataclass(frozen=True, slots=True)
class Kind:
    """A kind of disturbance.

    Attributes:
        usual: Range of its amount where only its name is given.
        legal: What an amount may be.
        unit: Of the amount.
        meaning: What the amount is of.
    """

    usual: tuple[float, float]
    legal: tuple[float, float]
    unit: str
    meaning: str


KINDS: Mapping[str, Kind] = {
    "mass": Kind((0.1, 0.1), (0.0, 0.9), "", "share that each body may be heavier or lighter"),
    "com": Kind((0.01, 0.01), (0.0, 0.1), "m", "from each body's centre of mass, any way"),
    "friction": Kind((0.6, 1.2), (0.01, 5.0), "", "of the floor under the soles"),
    "noise": Kind(
        (1.0, 1.0), (0.0, 100.0), "times", "0.1° and 0.05 rad/s, of joints and of the pelvis' turn"
    ),
    "delay": Kind((0.002, 0.002), (0.0, 0.2), "s", "before the controller learns of the body"),
    "push": Kind((5.0, 5.0), (0.0, 200.0), "N s", "level at the pelvis in 0.1 s, any time and way"),
    "rate": Kind((200.0, 1000.0), (20.0, 1000.0), "Hz", "of the controller"),
    "softness": Kind((0.005, 0.02), (0.002, 0.1), "s", "time constant of the floor's contacts"),
}
"""By name, in the order in which they are told."""
USUAL = ("mass", "com", "friction", "noise", "delay", "push")
"""Those that are asked for where none is named."""
ANGLE_NOISE, VELOCITY_NOISE = float(np.radians(0.1)), 0.05
"""Standard deviations at noise 1, rad and rad/s."""


@dataclass(frozen=True, slots=True)
class Disturbances:
    """The disturbances asked for.

    Attributes:
        ranges: Least and greatest amount by the names of `KINDS`.
    """

    ranges: Mapping[str, tuple[float, float]]

    def __post_init__(self) -> None:
        """Check names and amounts.

        Raises:
            EnpointeError: An unknown name, or an amount that makes no sense.
        """
        for name, (low, high) in self.ranges.items():
            if name not in KINDS:
                raise EnpointeError(
                    f"no disturbance {name!r}; there are {', '.join(KINDS)} (or all, or none)"
                )
            least, most = KINDS[name].legal
            if not least <= low <= high <= most:
                raise EnpointeError(
                    f"{name}={low:g}:{high:g} makes no sense; write amounts from {least:g} to"
                    f" {most:g}{_unit(name)}, the lesser first"
                )

    @classmethod
    def parse(cls, text: str | None) -> Disturbances:
        """Read "mass,push=8,friction=.4:1"; the usual ones if None; "all" and "none" are words.

        Raises:
            EnpointeError: An unknown name, or an amount that is no number or makes no sense.
        """
        names = {"all": tuple(KINDS), "none": ()}.get((text or "").strip())
        if text is None or names is not None:
            return cls({n: KINDS[n].usual for n in (USUAL if names is None else names)})
        ranges: dict[str, tuple[float, float]] = {}
        for part in text.split(","):
            name, given, amount = part.strip().partition("=")
            usual = KINDS[name].usual if name in KINDS else (0.0, 0.0)
            ranges[name] = _amounts(part, amount) if given else usual
        return cls({name: ranges[name] for name in sorted(ranges, key=_order)})

    def words(self) -> list[str]:
        """Each in a line for people."""
        return [
            f"{name} {f'{low:g}' if low == high else f'{low:g} to {high:g}'}{_unit(name)}"
            f" ({KINDS[name].meaning})"
            for name, (low, high) in self.ranges.items()
        ]


def _unit(name: str) -> str:
    unit = KINDS[name].unit
    return f" {unit}" if unit else ""


def _order(name: str) -> int:
    return [*KINDS].index(name) if name in KINDS else len(KINDS)


def _amounts(part: str, text: str) -> tuple[float, float]:
    try:
        low, _, high = text.partition(":")
        return float(low), float(high or low)
    except ValueError:
        raise EnpointeError(
            f"{part.strip()!r} is no disturbance; write NAME, NAME=AMOUNT or NAME=LEAST:GREATEST"
        ) from None


@dataclass(frozen=True)
class Factors:
    """What was drawn for one run; None for what is left as it is.

    Attributes:
        mass: (nbody,), what each body's mass and inertia are multiplied by.
        com: (nbody, 3), how far each body's centre of mass is moved, m.
        friction: Sliding friction of floor and soles.
        noise: Standard deviations over `ANGLE_NOISE` and `VELOCITY_NOISE`.
        delay: s.
        impulse: Of one push, N s.
        push_at: When it begins, s.
        push_direction: Which way, rad to the left of forward.
        period: s between commands.
        softness: Time constant of contact, s.
        senses: Seed of the noise.
    """

    mass: Array | None = None
    com: Array | None = None
    friction: float | None = None
    noise: float | None = None
    delay: float | None = None
    impulse: float | None = None
    push_at: float = 0.0
    push_direction: float = 0.0
    period: float | None = None
    softness: float | None = None
    senses: SeedSequence = field(default_factory=lambda: SeedSequence(0))

    @property
    def push(self) -> Push | None:
        """The push, level at the pelvis."""
        if self.impulse is None:
            return None
        forward, left = np.cos(self.push_direction), np.sin(self.push_direction)
        level = (self.impulse * float(forward), self.impulse * float(left), 0.0)
        return Push(self.push_at, level, PUSH_DURATION)

    def applied(self, model: mujoco.MjModel) -> mujoco.MjModel:
        """A changed copy of the model."""
        own = copy.copy(model)
        if self.mass is not None:
            own.body_mass[:] *= self.mass
            own.body_inertia[:] *= self.mass[:, None]
        if self.com is not None:
            own.body_ipos[:] += self.com
        standing = np.append(sole_geoms(model), _floors(model))
        if self.friction is not None:
            own.geom_friction[standing, 0] = self.friction
        if self.softness is not None:
            own.geom_solref[standing, 0] = self.softness
        mujoco.mj_setConst(own, mujoco.MjData(own))
        return own

    def figures(self, model: mujoco.MjModel, qpos: Array) -> dict[str, float | None]:
        """The factors as numbers, SI units, None for what is left as it is.

        Args:
            model: As it was before.
            qpos: (nq,), the pose in which the whole body's centre of mass is compared.
        """
        heavier = moved = None
        if self.mass is not None or self.com is not None:
            own = self.applied(model)
            heavier = float(own.body_mass.sum() / model.body_mass.sum() - 1.0)
            moved = _com(own, qpos) - _com(model, qpos)
        pushed = self.impulse is not None
        return {
            "mass_error": heavier,
            "com_forward": None if moved is None else float(moved[0]),
            "com_left": None if moved is None else float(moved[1]),
            "friction": self.friction,
            "noise": self.noise,
            "delay": self.delay,
            "push": self.impulse,
            "push_at": self.push_at if pushed else None,
            "push_direction": self.push_direction if pushed else None,
            "rate": None if self.period is None else 1.0 / self.period,
            "softness": self.softness,
        }


def draw(
    disturbances: Disturbances, model: mujoco.MjModel, duration: float, seed: SeedSequence
) -> Factors:
    """Draw the factors of one run.

    Every kind has its own stream, so that leaving one out leaves the others as they were.

    Args:
        disturbances: What is asked for.
        model: The dancer.
        duration: Of the dance, s.
        seed: Of this run.
    """
    *streams, senses = seed.spawn(len(KINDS) + 1)
    drawn: dict[str, tuple[float, Generator]] = {}
    for name, stream in zip(KINDS, streams, strict=True):
        if name in disturbances.ranges:
            rng = default_rng(stream)
            low, high = disturbances.ranges[name]
            drawn[name] = (float(rng.uniform(low, high)), rng)

    def amount(name: str) -> float | None:
        return drawn[name][0] if name in drawn else None

    moment, direction = _push(drawn["push"][1], duration) if "push" in drawn else (0.0, 0.0)
    return Factors(
        mass=_masses(*drawn["mass"], model.nbody) if "mass" in drawn else None,
        com=_shifts(*drawn["com"], model.nbody) if "com" in drawn else None,
        friction=amount("friction"),
        noise=amount("noise"),
        delay=amount("delay"),
        impulse=amount("push"),
        push_at=moment,
        push_direction=direction,
        period=_period(disturbances.ranges["rate"], drawn["rate"][1], model.opt.timestep)
        if "rate" in drawn
        else None,
        softness=amount("softness"),
        senses=senses,
    )


def _masses(share: float, rng: Generator, bodies: int) -> Array:
    return 1.0 + rng.uniform(-share, share, bodies)


def _shifts(length: float, rng: Generator, bodies: int) -> Array:
    """Of one length, in directions spread evenly over the sphere."""
    ways = rng.standard_normal((bodies, 3))
    shifts = length * ways / np.linalg.norm(ways, axis=1, keepdims=True)
    shifts[0] = 0.0
    return np.asarray(shifts)


def _push(rng: Generator, duration: float) -> tuple[float, float]:
    """When, s, and which way, rad."""
    start = rng.uniform(0.0, max(duration - RECOVERY, 0.5 * duration))
    return float(start), float(rng.uniform(-np.pi, np.pi))


def _period(rates: tuple[float, float], rng: Generator, step: float) -> float:
    """One of the whole numbers of physics steps whose rate is in the range, or the nearest."""
    slowest = max(int(1.0 / (rates[0] * step) + 1e-9), 1)
    quickest = min(max(int(np.ceil(1.0 / (rates[1] * step) - 1e-9)), 1), slowest)
    return float(step * rng.integers(quickest, slowest, endpoint=True))


def _floors(model: mujoco.MjModel) -> NDArray[np.int64]:
    return np.flatnonzero(model.geom_type == mujoco.mjtGeom.mjGEOM_PLANE)


def _com(model: mujoco.MjModel, qpos: Array) -> Array:
    data = mujoco.MjData(model)
    data.qpos[:] = qpos
    mujoco.mj_kinematics(model, data)
    mujoco.mj_comPos(model, data)
    return np.array(data.subtree_com[0])
