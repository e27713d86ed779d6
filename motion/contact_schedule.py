"""Which soles a motion means to stand on, and when: the contact schedule.

Read from the motion itself, so that it serves a score and a captured motion alike: a sole is
planted while it is on the floor and at rest. A toe that touches the floor beside a standing foot,
as in a tendu, is not stood on.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import mujoco
import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import binary_closing, binary_opening

from enpointe.models.soles import sole_geoms, sole_points
from enpointe.motion.motion import Motion

__all__ = ["ContactSchedule", "contact_schedule", "trace_soles", "without_chatter"]

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]

ON_FLOOR = 0.002
"""A sole nearer to the floor than this, m, is on it. A heel that is counted on before it is there
leaves the weight planned over nothing: with 5 mm, eight relevés on one foot fell."""
AT_REST = 0.05
"""A sole slower than this, m/s, is not sliding."""
SHORTEST = 0.04
"""A contact, or a gap in one, shorter than this is chatter, s: nobody shifts weight in it."""


@dataclass(frozen=True)
class ContactSchedule:
    """Planned contacts of a motion of T samples with S soles.

    Attributes:
        time: (T,), s.
        soles: (S,), geoms.
        points: (T, S, 3), lowest points of the soles, m.
        bears: (T, S), whether weight may be on a sole.
    """

    time: Array
    soles: NDArray[np.int64]
    points: Array
    bears: Mask

    @property
    def steps(self) -> bool:
        """Whether any sole leaves the floor or comes to it."""
        return bool(np.any(self.bears != self.bears[0]))

    def index(self, t: float) -> int:
        """The sample at or just before `t` seconds, held beyond both ends."""
        after = int(np.searchsorted(self.time, t + 1e-9, side="right"))
        return min(max(after - 1, 0), len(self.time) - 1)

    def at(self, t: float) -> Mask:
        """(S,), whether weight may be on each sole at `t` seconds."""
        return np.asarray(self.bears[self.index(t)])

    def slowed(self, time_scale: float) -> ContactSchedule:
        """The schedule of the motion in `time_scale` times its time."""
        return replace(self, time=self.time * time_scale)

    def shares(self, seconds: float) -> Array:
        """(T, S), how readily each sole bears: 0 where none, rising to 1 in a time and down again.

        Weight so leaves a sole before it is lifted, and comes to it only after it is down. A sole
        that bears from the beginning, or to the end, bears in full there.
        """
        found = np.zeros(self.bears.shape)
        for sole, bears in enumerate(self.bears.T):
            edges = np.flatnonzero(np.diff(np.concatenate([[0], bears.astype(np.int8), [0]])))
            for first, end in zip(edges[::2].tolist(), edges[1::2].tolist(), strict=True):
                time = self.time[first:end]
                since = np.full(len(time), np.inf) if first == 0 else time - time[0]
                until = np.full(len(time), np.inf) if end == len(bears) else time[-1] - time
                found[first:end, sole] = np.minimum(np.minimum(since, until) / seconds, 1.0)
        return found


def contact_schedule(
    motion: Motion, *, on_floor: float = ON_FLOOR, at_rest: float = AT_REST
) -> ContactSchedule:
    """Plan the contacts of a motion from its heights and speeds.

    Args:
        motion: What is to be danced, or what somebody drew or captured.
        on_floor: A sole nearer to the floor than this, m, is on it.
        at_rest: A sole slower than this, m/s, is not sliding.
    """
    model = motion.model
    soles = sole_geoms(model)
    points = trace_soles(motion, soles)
    speed = np.linalg.norm(np.gradient(points[:, :, :2], motion.time, axis=0), axis=2)
    down = points[:, :, 2] < on_floor
    planted = without_chatter(down & (speed < at_rest), float(np.median(np.diff(motion.time))))
    planted = _held_over(planted, down)
    return ContactSchedule(motion.time, soles, points, _stood_on(model, soles, planted))


def trace_soles(motion: Motion, soles: NDArray[np.int64]) -> Array:
    """Lowest points (T, S, 3) of some soles over a motion, m."""
    data = mujoco.MjData(motion.model)
    points = np.empty((len(motion.time), len(soles), 3))
    for row, qpos in zip(points, motion.qpos, strict=True):
        data.qpos[:] = qpos
        mujoco.mj_kinematics(motion.model, data)
        row[:] = sole_points(motion.model, data, soles)
    return points


def without_chatter(planted: Mask, period: float) -> Mask:
    """Contacts (T, S) without those, and without gaps, that are shorter than `SHORTEST`."""
    width = max(round(SHORTEST / period), 1)
    window = np.ones((width, 1), dtype=bool)
    padded = np.pad(planted, ((width, width), (0, 0)), mode="edge")
    smooth = binary_opening(binary_closing(padded, window), window)
    return np.asarray(smooth[width:-width])


def _held_over(planted: Mask, down: Mask) -> Mask:
    """Where all that is on the floor slides, what stood last carries until the next stands."""
    held = planted.copy()
    standing = np.flatnonzero(np.any(planted, axis=1))
    sliding = np.flatnonzero(~np.any(planted, axis=1) & np.any(down, axis=1))
    if len(standing) == 0:
        return down
    before = standing[np.maximum(np.searchsorted(standing, sliding) - 1, 0)]
    held[sliding] = planted[before]
    return held


def _stood_on(model: mujoco.MjModel, soles: NDArray[np.int64], planted: Mask) -> Mask:
    """A foot with its heel up is stood on only when no foot has its heel down.

    So demi-pointe and pointe bear, and a toe stretched to the floor beside a flat foot does not;
    nor, which is cautious, does a foot that rolls down to the floor until its heel is there.
    """
    body = model.geom_bodyid[soles]
    parent = model.body_parentid[body]
    of_toes = np.array(np.isin(parent, body))
    foot: NDArray[np.int64] = np.where(of_toes, parent, body)
    flat = np.zeros_like(planted)
    for one in np.unique(foot):
        mine = np.array(foot == one)
        flat[:, mine] = np.any(planted[:, mine & ~of_toes], axis=1, keepdims=True)
    nobody = ~np.any(flat, axis=1, keepdims=True)
    return np.asarray(planted & (flat | nobody))
