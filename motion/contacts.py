"""When feet leave the floor and come to it on the way from one key pose to the next.

Where the weight goes from foot to foot, one foot arrives before the other leaves. Where it has a
long way to go from both feet to one, or a foot slides out under it, the other foot leaves late; and
arrives early where it goes the other way about. Then both legs yield to the weight that passes.
"""

from __future__ import annotations

from dataclasses import replace

import mujoco
import numpy as np
from numpy.typing import NDArray

from enpointe.models.keypose import KeyPose
from enpointe.motion.clock import Clock
from enpointe.motion.effort import Effort
from enpointe.motion.leg_path import LegPath
from enpointe.notation import Side

__all__ = ["centre_of_mass", "leg_paths"]

Array = NDArray[np.float64]
WEIGHT_SHIFT = 0.25
"""Share of the time in which weight moves before a foot leaves, or after it arrives."""
STEP = (0.5, 0.6)
"""Shares of a step's time, from one foot to the other, at which the one arrives and the other
leaves."""
SHIFT = 0.4
"""Share of the time in which the weight goes a long way before a foot leaves, or after one has
arrived."""
SLID = 0.06
"""A foot that stays and is moved farther than this slides, m."""
FAR = 0.06
"""A weight that is moved farther than this passes over yielding legs, m."""


def leg_paths(
    model: mujoco.MjModel, start: KeyPose, end: KeyPose, effort: Effort
) -> dict[Side, LegPath]:
    """Both legs' ways between two key poses, with the moments of their feet."""

    clock = Clock(effort)
    at = clock.share
    paths = {side: LegPath(model, side, start, end) for side in Side}
    leaves = any(path.leaves for path in paths.values())
    arrives = any(path.arrives for path in paths.values())
    if not (leaves or arrives):
        return paths
    paths = {side: _at_moments(path, clock) for side, path in paths.items()}
    if leaves and arrives:
        arrival, leaving = STEP
        return {
            side: replace(
                path, arrives_at=at(arrival), leaves_at=at(leaving), yields=True, steps=True
            )
            for side, path in paths.items()
        }
    way = centre_of_mass(model, end.qpos) - centre_of_mass(model, start.qpos)
    slides = any(path.travels > SLID for path in paths.values())
    if not (slides or float(np.hypot(*way[:2])) > FAR):
        return paths
    late, early = at(SHIFT), at(1.0 - SHIFT)
    window = (0.0, late) if leaves else (early, 1.0)
    return {
        side: replace(
            path,
            leaves_at=late,
            arrives_at=early,
            slides=window,
            yields=slides or not path.stays,
            steps=slides,
        )
        for side, path in paths.items()
    }


def _at_moments(path: LegPath, clock: Clock) -> LegPath:
    early, late = clock.share(WEIGHT_SHIFT), clock.share(1.0 - WEIGHT_SHIFT)
    return replace(path, clock=clock, leaves_at=early, arrives_at=late)


def centre_of_mass(model: mujoco.MjModel, qpos: Array) -> Array:
    """Centre of mass (3,) of a configuration (nq,), m."""
    data = mujoco.MjData(model)
    data.qpos[:] = qpos
    mujoco.mj_kinematics(model, data)
    mujoco.mj_comPos(model, data)
    return np.array(data.subtree_com[0])
