"""Where soles and centre of mass are in every sample of a shipped score's dance, solved once."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache, cached_property
from itertools import pairwise

import mujoco
import numpy as np
from numpy.typing import NDArray

from enpointe.models.leg_target import LegTarget, OnPointe, Standing
from enpointe.motion import PRESETS, Choreography, Motion, interpolate
from enpointe.motion.interpolation import COUNT_IN, LEG_ROUNDING
from enpointe.motion.stations import Law, Station
from enpointe.notation import Side

from .dancing import solved

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]
PARTS = ("heel", "ball", "tip")
MARGIN = LEG_ROUNDING / 2
"""So far the rounding of corners reaches into a passage, s."""


@dataclass(frozen=True)
class Dance:
    """A shipped score moved at its own tempo with natural effort.

    Attributes:
        choreography: Solved.
        motion: Kinematic.
        soles: Lowest points of each side's heel, ball and tip, inner and outer, (T, 6, 3), m.
        com: (T, 3), m.
    """

    choreography: Choreography
    motion: Motion
    soles: dict[Side, Array]
    com: Array

    @cached_property
    def stations(self) -> tuple[Station, ...]:
        return self.choreography.stations

    def moment(self, station: Station) -> float:
        """s from the start of the motion."""
        return COUNT_IN + station.time

    def within(self, start: Station, end: Station, margin: float = 0.0) -> Mask:
        """The samples between two stations."""
        time = self.motion.time
        return np.asarray(
            (time >= self.moment(start) + margin - 1e-9)
            & (time <= self.moment(end) - margin + 1e-9)
        )

    def flights(self) -> Iterator[tuple[Station, Station]]:
        """Each jump's take-off and touch, whatever is shown between them."""
        take_off = None
        for start, end in pairwise(self.stations):
            if end.flight is None:
                continue
            if end.span[0] == 0.0:
                take_off = start
            if end.span[1] == 1.0:
                assert take_off is not None
                yield take_off, end

    def planted(self, side: Side) -> Iterator[tuple[Station, Station]]:
        """The stretches in which a foot stands on one place, each as long as it lasts."""
        begin = None
        for start, end in pairwise(self.stations):
            stays = end.flight is None and _one_place(*(leg(s, side) for s in (start, end)))
            if stays and begin is None:
                begin = start
            if not stays and begin is not None:
                yield begin, start
                begin = None
        if begin is not None:
            yield begin, self.stations[-1]

    def joint_speeds(self) -> dict[str, Array]:
        """Angular speed of each hinged body against its parent, (T,), rad/s.

        Of all the hinges between them together: one hinge of three may be fast near its singular
        line where the limb is not.
        """
        model = self.motion.model
        hinges: dict[str, list[int]] = {}
        for joint in range(1, model.njnt):
            hinges.setdefault(model.body(int(model.jnt_bodyid[joint])).name, []).append(joint)
        speeds = {body: np.empty(len(self.motion.time)) for body in hinges}
        data = mujoco.MjData(model)
        for i, (qpos, qvel) in enumerate(zip(self.motion.qpos, self.motion.qvel, strict=True)):
            data.qpos[:] = qpos
            mujoco.mj_kinematics(model, data)
            for body, joints in hinges.items():
                turning = qvel[model.jnt_dofadr[joints]] @ data.xaxis[joints]
                speeds[body][i] = np.linalg.norm(turning)
        return speeds

    def between_the_legs(self, every: int) -> Array:
        """Least distance between the limbs of the two legs in every so-manyeth sample, m."""
        model = self.motion.model
        limbs = {
            side: [model.geom(f"{side}_{part}_limb").id for part in ("thigh", "shank", "foot")]
            for side in Side
        }
        data, ends = mujoco.MjData(model), np.empty(6)
        gaps = []
        for qpos in self.motion.qpos[::every]:
            data.qpos[:] = qpos
            mujoco.mj_kinematics(model, data)
            gaps.append(
                min(
                    mujoco.mj_geomDistance(model, data, one, other, 0.1, ends)
                    for one in limbs[Side.LEFT]
                    for other in limbs[Side.RIGHT]
                )
            )
        return np.array(gaps)

    def springing(self) -> Mask:
        """The samples in the air or on the way there and back: pushed off, landed, given way."""
        out = np.zeros(len(self.motion.time), dtype=bool)
        for i, (start, end) in enumerate(pairwise(self.stations)):
            leaps = i + 2 < len(self.stations) and self.stations[i + 2].flight is not None
            gives = start.flight is not None and leg_bears(start)
            if end.flight is not None or leaps or gives or end.law in (Law.PUSH, Law.GIVE):
                out |= self.within(start, end)
        return out


def leg(station: Station, side: Side) -> LegTarget:
    return station.pose.target.legs[side]


def leg_bears(station: Station) -> bool:
    return any(isinstance(leg(station, side), Standing | OnPointe) for side in Side)


def _one_place(before: LegTarget, after: LegTarget) -> bool:
    if type(before) is not type(after) or not isinstance(before, Standing | OnPointe):
        return False
    assert isinstance(after, Standing | OnPointe)
    one, other = before.footprint, after.footprint
    return bool(
        np.allclose(one.ankle, other.ankle, atol=1e-6)
        and abs(one.direction - other.direction) < 1e-6
    )


@cache
def dance(score: str) -> Dance:
    chosen = solved(score)
    reference = interpolate(chosen, PRESETS["natural"].effort)
    model = reference.model
    data = mujoco.MjData(model)
    geoms = {
        side: [
            model.geom(f"{side}_{part}_{rim}").id for part in PARTS for rim in ("inner", "outer")
        ]
        for side in Side
    }
    soles = {side: np.empty((len(reference.time), 6, 3)) for side in Side}
    com = np.empty((len(reference.time), 3))
    for i, pose in enumerate(reference.qpos):
        data.qpos[:] = pose
        mujoco.mj_kinematics(model, data)
        mujoco.mj_comPos(model, data)
        com[i] = data.subtree_com[0]
        for side, ids in geoms.items():
            soles[side][i] = data.geom_xpos[ids] - np.outer(model.geom_size[ids, 0], [0, 0, 1])
    return Dance(chosen, reference, soles, com)
