"""Each foot by itself: the force under it, and what it stands on."""

from __future__ import annotations

from collections.abc import Mapping
from enum import StrEnum
from functools import lru_cache
from types import MappingProxyType

import mujoco
import numpy as np
from numpy.typing import NDArray

from enpointe.controllers.plant import Plant
from enpointe.sim.balance import LOADED

__all__ = ["FootState", "foot_states", "ground_forces", "sole_sides"]

Array = NDArray[np.float64]
SIDES = ("left", "right")


class FootState(StrEnum):
    """What of a foot bears weight."""

    AIR = "air"
    FLAT = "flat"
    """Heel, and ball or tip."""
    DEMI_POINTE = "demi-pointe"
    """Ball or tip of the toes, the heel free."""
    POINTE = "pointe"
    """The upper half of the platform at the toes' end, which no other foot touches down."""
    HEEL = "heel"
    """The heel alone."""


def ground_forces(model: mujoco.MjModel, forces: Array) -> Array:
    """Force of the floor on each foot, (..., 2, 3), N, left and then right; up is positive.

    Args:
        model: The dancer; a sole belongs to the foot that its name begins with.
        forces: (..., S, 3), floor on sole.
    """
    sides = sole_sides(model)
    return np.stack([forces[..., sides == side, :].sum(axis=-2) for side in SIDES], axis=-2)


def foot_states(model: mujoco.MjModel, forces: Array) -> Mapping[str, FootState]:
    """What each foot stands on, by side, at one moment.

    Args:
        model: The dancer, whose soles are named side_part_...
        forces: (S, 3), floor on sole.
    """
    return _standing(_sole_names(model), tuple((forces[:, 2] > LOADED).tolist()))


@lru_cache(maxsize=1024)
def _standing(names: tuple[str, ...], bears: tuple[bool, ...]) -> Mapping[str, FootState]:
    """From one sample to the next mostly the same soles bear."""
    loaded = {name for name, loaded in zip(names, bears, strict=True) if loaded}
    return MappingProxyType({side: _state(loaded, side) for side in SIDES})


def _state(loaded: set[str], side: str) -> FootState:
    def bears(part: str) -> bool:
        return any(name.startswith(f"{side}_{part}") for name in loaded)

    if bears("heel"):
        return FootState.FLAT if bears("ball") or bears("tip") else FootState.HEEL
    if bears("platform_upper"):
        return FootState.POINTE
    risen = bears("ball") or bears("tip") or bears("platform")
    return FootState.DEMI_POINTE if risen else FootState.AIR


@lru_cache(maxsize=4)
def _sole_names(model: mujoco.MjModel) -> tuple[str, ...]:
    return tuple(model.geom(int(g)).name for g in Plant(model).sole_geoms)


def sole_sides(model: mujoco.MjModel) -> NDArray[np.str_]:
    """Side of each sole, (S,)."""
    return np.array([name.partition("_")[0] for name in _sole_names(model)])
