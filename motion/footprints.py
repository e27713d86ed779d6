"""Where the feet of another body stand when it dances what a dancer danced.

Each stretch of standing has one footprint: the dancer's, on the body's scale. A body of servos has
feet that are large for its size; a footprint that would lie in that of the other foot is moved out
of it: to its own side where the dancer's feet are beside each other, as in first, and forward or
back where they are before each other, as in fifth. A heel rises in proportion to the dancer's, so
that at her highest the foot stands on its second sole, and stays down if there is none.
"""

from __future__ import annotations

from dataclasses import dataclass

import mujoco
import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from enpointe.models.anatomy import SIDES, side_sign
from enpointe.models.soles import sole_geoms
from enpointe.motion.retargeting.body import Body
from enpointe.motion.retargeting.holding import ramped, runs

__all__ = ["Footing", "Sole", "footings"]

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]
_STEADY = np.radians(25.0)
"""A standing foot that turns by less than this does not turn."""
_FLAT, _RISEN = np.radians(5.0), np.radians(25.0)
"""A heel up by less than the first is down; up by more than the second it is in demi-pointe."""
_SETTLE = 0.2
"""s in which a foot comes from where it was led in the air to where it stands."""
_CLEAR = 0.004
"""m between two footprints."""
_ASKEW = 0.1
"""An axis on which a way goes less than this share of itself does not part two footprints."""


@dataclass(frozen=True)
class Sole:
    """What of a rigid foot can be stood on, from the ankle, the foot lying flat.

    Attributes:
        edge: Middle of the axis that the heel rises about, (3,), m.
        radius: Of the studs, m.
        rise: How far the heel is up when the second sole lies on the floor, rad; 0 without one.
        outline: Corners of the footprint, (4, 2), m.
    """

    edge: Array
    radius: float
    rise: float
    outline: Array

    @classmethod
    def of(cls, body: Body, side: str) -> Sole:
        """The sole of a body's foot."""
        model = body.model
        geoms = sole_geoms(model)
        mine = [body.bodies[f"{side}_{part}"] for part in ("foot", "toe")]
        geoms = geoms[np.isin(model.geom_bodyid[geoms], mine)]
        data = mujoco.MjData(model)
        data.qpos[:] = body.rest
        mujoco.mj_kinematics(model, data)
        places = data.geom_xpos[geoms] - body.at_rest[f"{side}_ankle"]
        radius = float(model.geom_size[geoms[0], 0])
        flat = places[:, 2] < places[:, 2].min() + 1e-3
        front = places[flat][:, 0].max()
        edge = places[flat & (places[:, 0] > front - 2 * radius)].mean(axis=0)
        edge[0] = front
        rise = 0.0
        if not flat.all():
            ahead = places[~flat].mean(axis=0) - edge
            rise = float(np.arctan2(ahead[2], ahead[0]))
        (x0, y0), (x1, y1) = places[:, :2].min(axis=0), places[:, :2].max(axis=0)
        corners = [(x0, y0), (x1, y0), (x1, y1), (x0, y1)]
        grown = np.array(corners) + radius * np.array([(-1, -1), (1, -1), (1, 1), (-1, 1)])
        return cls(edge, radius, rise, grown)


@dataclass(frozen=True)
class Footing:
    """One foot over T samples.

    Attributes:
        standing: (T,), whether it stands.
        laid: (T,), 1 where it stands, falling to 0 in the air.
        moved: (T, 2), m, how far a mark is from the dancer's own, on this body's scale.
        ankle: (T, 3), m; where it does not stand, on the way from one footprint to the next.
        turn: (T, 3, 3), of the foot.
    """

    standing: Mask
    laid: Array
    moved: Array
    ankle: Array
    turn: Array


def footings(
    feet: dict[str, tuple[Array, Array, Array, Array]],
    standing: dict[str, Mask],
    body: Body,
    scale: float,
    rate: float,
    aside: dict[str, Array] | None = None,
) -> dict[str, Footing]:
    """Footings of both feet.

    Args:
        feet: By side, the dancer's ball (T, 3), m, the frames of toes and foot (T, 3, 3), and her
            ankle (T, 3), m.
        standing: By side, (T,), whether it stands.
        body: Whose feet are to stand.
        scale: Its size over the dancer's.
        rate: Samples a second.
        aside: By side, (T, 2), m: marks are moved by so much more, alike through a stretch of
            standing, because limbs are in each other's way.
    """
    soles = {side: Sole.of(body, side) for side in SIDES}
    balls = {side: scale * feet[side][0][:, :2] for side in SIDES}
    yaws = {side: _headings(feet[side][1], standing[side]) for side in SIDES}
    _settle(balls, standing)
    drawn = {side: ball.copy() for side, ball in balls.items()}
    ankles = {side: scale * feet[side][3][:, :2] for side in SIDES}
    _stand_clear(balls, yaws, ankles, standing, soles)
    for side, more in ({} if aside is None else aside).items():
        balls[side] += more
    made = {}
    for side in SIDES:
        rise = _risen(feet[side][2], standing[side], soles[side].rise)
        place, yaw, rise = (
            _led(track, standing[side]) for track in (balls[side], yaws[side], rise)
        )
        turn = Rotation.from_euler("ZY", np.column_stack([yaw, rise])).as_matrix()
        edge = np.column_stack([place, np.full(len(place), soles[side].radius)])
        laid = ramped(standing[side], _SETTLE, rate)
        moved = np.where(standing[side][:, None], balls[side] - drawn[side], 0.0)
        ankle = edge - turn @ soles[side].edge
        made[side] = Footing(standing[side], laid, moved, ankle, turn)
    return made


def _headings(toes: Array, standing: Mask) -> Array:
    yaw = np.unwrap(np.arctan2(toes[:, 1, 0], toes[:, 0, 0]))
    for run in runs(standing):
        if np.ptp(yaw[run]) < _STEADY:
            yaw[run] = np.median(yaw[run])
    return yaw


def _risen(foot: Array, standing: Mask, most: float) -> Array:
    pitch = np.maximum(-np.arcsin(np.clip(foot[:, 2, 0], -1.0, 1.0)) - _FLAT, 0.0)
    rise = np.zeros_like(pitch)
    for run in runs(standing & (pitch > 0.0)):
        highest = float(pitch[run].max()) + _FLAT
        share = pitch[run] / pitch[run].max()
        rise[run] = share * (most if highest > _RISEN else min(highest, most))
    return np.asarray(rise)


def _led(track: Array, standing: Mask) -> Array:
    """A track where a foot stands, straight from one such time to the next."""
    at = np.flatnonzero(standing)
    if not len(at):
        return track
    columns = track.reshape(len(track), -1)
    led = [np.interp(np.arange(len(track)), at, column[at]) for column in columns.T]
    return np.asarray(np.column_stack(led).reshape(track.shape))


def _settle(balls: dict[str, Array], standing: dict[str, Mask]) -> None:
    """Give every stretch of standing one place."""
    for side in SIDES:
        for run in runs(standing[side]):
            balls[side][run] = np.median(balls[side][run], axis=0)


def _stand_clear(
    balls: dict[str, Array],
    yaws: dict[str, Array],
    ankles: dict[str, Array],
    standing: dict[str, Mask],
    soles: dict[str, Sole],
) -> None:
    """Move every stretch of standing, in place, out of the other foot's way."""
    order = sorted((run.start, side, run) for side in SIDES for run in runs(standing[side]))
    taken: dict[str, list[slice]] = {side: [] for side in SIDES}
    for _, side, run in order:
        other = SIDES[1 - SIDES.index(side)]
        for beside in taken[other]:
            first, last = max(run.start, beside.start), min(run.stop, beside.stop)
            if first < last:
                mine = _footprint(soles[side], balls[side][first], yaws[side][first])
                theirs = _footprint(soles[other], balls[other][first], yaws[other][first])
                facing = 0.5 * (yaws[side][first] + yaws[other][first])
                away = ankles[side][first] - ankles[other][first]
                balls[side][run] += _way_out(mine, theirs, _way(away, facing, side))
        taken[side].append(run)


def _footprint(sole: Sole, ball: Array, yaw: float) -> Array:
    c, s = np.cos(yaw), np.sin(yaw)
    return np.asarray(ball + (sole.outline - sole.edge[:2]) @ np.array([[c, s], [-s, c]]))


def _way(away: Array, facing: float, side: str) -> Array:
    """Where a foot goes to be clear of the other: to its side, or forward or back.

    Args:
        away: (2,), from the other ankle to its own, of the dancer.
        facing: Between the two feet, rad.
        side: Of the foot.
    """
    ahead = np.array([np.cos(facing), np.sin(facing)])
    outward = side_sign(side) * np.array([-ahead[1], ahead[0]])
    along = float(away @ ahead)
    if float(away @ outward) > abs(along):
        return outward
    return ahead if along >= 0.0 else -ahead


def _way_out(mine: Array, theirs: Array, way: Array) -> Array:
    """How far, (2,), one rectangle must go along a way to be clear of another."""
    least = np.inf
    for corners in (mine, theirs):
        for side in (corners[1] - corners[0], corners[2] - corners[1]):
            axis = side / np.linalg.norm(side)
            if axis @ way < 0.0:
                axis = -axis
            own, other = mine @ axis, theirs @ axis
            if own.min() > other.max() + _CLEAR or other.min() > own.max() + _CLEAR:
                return np.zeros(2)
            if (speed := float(axis @ way)) > _ASKEW:
                least = min(least, float(other.max() - own.min() + _CLEAR) / speed)
    return least * way
