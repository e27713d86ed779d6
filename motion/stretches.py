"""Which stretches of a movement can be danced on feet, and what stands between them.

A body that starts from standing, cannot jump yet and has only its feet on the floor can dance the
times between flights, falls to the knees and hands on the floor. A stretch begins and ends where
she can stand still: on a whole foot, or on both.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import mujoco
import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import binary_closing, find_objects, label

from enpointe.models.anatomy import SIDES
from enpointe.models.soles import sole_geoms
from enpointe.motion.contact_schedule import ContactSchedule
from enpointe.motion.motion import Motion
from enpointe.motion.weight_plan import MARGIN, WeightPlan

__all__ = ["IN_THE_AIR", "Obstacle", "Stretch", "obstacles", "outside_the_feet", "stretches"]

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]
IN_THE_AIR = "in the air, and jumps are not danced from files yet"
SHORTEST_STRETCH = 0.5
"""s: less is not worth standing up for."""
_LOOKED_AT = 25.0
"""Times a second at which is looked for what else is on the floor."""
_TOUCH = 0.005
"""m: what is this deep in the floor is on it; a sole's edge or a hanging hand may brush it."""
_PAUSE = 0.2
"""s: two obstacles of one kind with less between them are one."""


@dataclass(frozen=True, slots=True)
class Obstacle:
    """A time that can't be danced.

    Attributes:
        start: s.
        end: s.
        why: In words.
    """

    start: float
    end: float
    why: str


@dataclass(frozen=True, slots=True)
class Stretch:
    """A time that may be danced, s."""

    start: float
    end: float

    @property
    def length(self) -> float:
        """s."""
        return self.end - self.start


def obstacles(motion: Motion, contacts: ContactSchedule) -> tuple[Obstacle, ...]:
    """Flights, and times with more than feet on the floor, in order.

    Args:
        motion: What moves.
        contacts: Which soles stand, of the same samples, with chatter gone (`stances`).
    """
    aloft = np.asarray(~contacts.bears.any(axis=1))
    found = [Obstacle(start, end, IN_THE_AIR) for start, end in _spans(aloft, motion.time)]
    return tuple(sorted([*found, *_on_the_floor(motion)], key=lambda each: each.start))


def outside_the_feet(weight: WeightPlan, source: Array) -> tuple[Obstacle, ...]:
    """Where the best plan of the weight would have the floor push outside the feet.

    Args:
        weight: The plan; what it is outside of is drawn in by `MARGIN` already.
        source: (K,), the moment of the movement at each of its knots, s.
    """
    width = 2 * int(0.5 * _PAUSE / float(weight.time[1] - weight.time[0])) + 1
    beyond = _closed(weight.outside > MARGIN, width)
    found = []
    for (span,) in find_objects(label(beyond)[0]):
        most = 1000 * (float(weight.outside[span].max()) - MARGIN)
        why = f"the floor would have to push {most:.0f} mm outside the feet"
        found.append(Obstacle(float(source[span][0]), float(source[span][-1]), why))
    return tuple(found)


def stretches(
    motion: Motion,
    contacts: ContactSchedule,
    hindrances: Iterable[Obstacle],
    span: tuple[float, float],
) -> tuple[Stretch, ...]:
    """What is left of a span between obstacles, in order, each from and to a safe stand."""
    free = (motion.time >= span[0] - 1e-9) & (motion.time <= span[1] + 1e-9)
    for each in hindrances:
        free &= (motion.time < each.start - 1e-9) | (motion.time > each.end + 1e-9)
    safe = _stands_safely(motion.model, contacts)
    found = []
    for start, end in _spans(free, motion.time):
        stands = motion.time[safe & (motion.time >= start) & (motion.time <= end)]
        if len(stands) and stands[-1] - stands[0] >= SHORTEST_STRETCH:
            found.append(Stretch(float(stands[0]), float(stands[-1])))
    return tuple(found)


def _stands_safely(model: mujoco.MjModel, contacts: ContactSchedule) -> Mask:
    """When one foot at least is down from heel to ball, or both bear."""
    bodies = model.geom_bodyid[contacts.soles]
    bearing = {}
    for part in ("foot", "toe"):
        for side in SIDES:
            mine = np.asarray(bodies == model.body(f"{side}_{part}").id)
            bearing[side, part] = contacts.bears[:, mine].any(axis=1)
    flat = [bearing[side, "foot"] & bearing[side, "toe"] for side in SIDES]
    down = [bearing[side, "foot"] | bearing[side, "toe"] for side in SIDES]
    return np.asarray(np.any(flat, axis=0) | np.all(down, axis=0))


def _on_the_floor(motion: Motion) -> list[Obstacle]:
    """Times at which a part of the body other than a foot is on the floor."""
    model, data = motion.model, mujoco.MjData(motion.model)
    times = np.arange(0.0, motion.duration + 0.5 / _LOOKED_AT, 1.0 / _LOOKED_AT)
    soles = set(sole_geoms(model).tolist())
    seen: dict[str, Mask] = {}
    for i, t in enumerate(times):
        data.qpos[:] = motion.sample(float(t))[0]
        mujoco.mj_kinematics(model, data)
        mujoco.mj_collision(model, data)
        for name in _touching(model, data, soles):
            seen.setdefault(name, np.zeros(len(times), dtype=bool))[i] = True
    width = 2 * int(0.5 * _PAUSE * _LOOKED_AT) + 1
    return [
        Obstacle(start, end, f"{name} on the floor, where only feet are danced on")
        for name, when in seen.items()
        for start, end in _spans(_closed(when, width), times)
    ]


def _touching(model: mujoco.MjModel, data: mujoco.MjData, soles: set[int]) -> Sequence[str]:
    names = set()
    for pair in data.contact.geom[data.contact.dist < -_TOUCH]:
        planes = model.geom_type[pair] == mujoco.mjtGeom.mjGEOM_PLANE
        if planes.any() and int(other := pair[~planes][0]) not in soles:
            body = model.body(int(model.geom_bodyid[other])).name
            if not body.endswith(("_foot", "_toe")):
                names.add(body.replace("_", " "))
    return sorted(names)


def _closed(mask: Mask, width: int) -> Mask:
    padded = np.pad(mask, width)
    return np.asarray(binary_closing(padded, np.ones(width, dtype=bool))[width:-width])


def _spans(mask: Mask, time: Array) -> list[tuple[float, float]]:
    return [
        (float(time[found][0]), float(time[found][-1])) for (found,) in find_objects(label(mask)[0])
    ]
