"""A movement at another rate: places on straight lines, rotations on the shortest arcs."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from enpointe.errors import MotionError
from enpointe.motion.formats.convert import angles_of
from enpointe.motion.formats.markers import MarkerMotion
from enpointe.motion.formats.skeleton import IDENTITY, SkeletonMotion
from enpointe.motion.formats.winding import nearest_angles
from enpointe.motion.motion import Motion

__all__ = ["resampled"]

Array = NDArray[np.float64]
Sampled = Motion | SkeletonMotion | MarkerMotion
_SLACK = 1e-9
_MOST = 10_000_000


def resampled(movement: Sampled, rate: float) -> Sampled:
    """The movement sampled from its first frame on, at most to its last.

    Places, scales and angles of joints with one or two axes are linear between frames, rotations of
    three axes go at even speed about one axis (Shoemake 1985). Nothing is filtered: what is faster
    than half the new rate comes out as something slower. Marks that a frame either has or not
    (cameras) are those of the nearest frame; a marker that is missing in one of two frames is
    missing between them. Analog signals and events stay as they are.

    Args:
        movement: A dancer's motion, a skeleton's or a marker set's.
        rate: Frames per second.

    Raises:
        MotionError: A rate that is none, or makes more than ten million frames.
    """
    if not np.isfinite(rate) or rate <= 0:
        raise MotionError(f"a rate must be above 0, got {rate:g}")
    if isinstance(movement, Motion):
        return _motion(movement, rate)
    if rate == movement.rate:
        return movement
    at = _At(movement.frames, rate / movement.rate)
    start = round(movement.start * rate / movement.rate)
    if isinstance(movement, SkeletonMotion):
        return replace(movement, rate=rate, values=_joints(movement, at), start=start)
    return replace(_markers(movement, at), rate=rate, start=start)


class _At:
    """Between which frames, and how far from the first to the second, new frames stand."""

    def __init__(self, frames: int, ratio: float) -> None:
        count = int((frames - 1) * ratio * (1 + _SLACK)) + 1
        if count > _MOST:
            raise MotionError(f"more than {_MOST} frames at that rate")
        places = np.arange(count) / ratio
        # New frames that all but stand on old ones are these, whatever comes behind them.
        places = np.where(np.abs(places - np.rint(places)) < _SLACK, np.rint(places), places)
        self.before = np.minimum(places.astype(np.intp), frames - 1)
        self.share = np.where(self.before < frames - 1, places - self.before, 0.0)
        self.after = np.minimum(self.before + 1, frames - 1)

    def linear(self, values: NDArray[Any]) -> Array:
        share = self.share.reshape(-1, *[1] * (values.ndim - 1))
        kept: Array = np.where(
            share > 0,
            (1 - share) * values[self.before] + share * values[self.after],
            values[self.before],
        )
        return kept

    @property
    def nearest(self) -> NDArray[np.intp]:
        """The nearer of the two frames."""
        return np.where(self.share < 0.5, self.before, self.after)

    def turned(self, quaternions: Array) -> Array:
        """(T, 4) w x y z on the shortest arcs; NaN where one of the two is."""
        gaps = np.asarray(~np.isfinite(quaternions).all(axis=1))
        quaternions = np.where(gaps[:, None], IDENTITY, quaternions)
        turns = Rotation.from_quat(quaternions, scalar_first=True)
        first, second = turns[self.before], turns[self.after]
        step = (first.inv() * second).as_rotvec() * self.share[:, None]
        whole: Array = (first * Rotation.from_rotvec(step)).as_quat(scalar_first=True)
        whole[gaps[self.before] | (gaps[self.after] & (self.share > 0))] = np.nan
        return whole


def _joints(motion: SkeletonMotion, at: _At) -> Array:
    values = at.linear(motion.values)
    unit = motion.skeleton.space.radians_per_unit
    for index, joint in enumerate(motion.skeleton.joints):
        if not joint.turning:
            continue
        first = motion.skeleton.columns(index).start
        columns = [joint.channels.index(f"{axis}rotation") + first for axis in joint.product]
        angles = motion.values[:, columns]
        between = _arcs(joint.product, angles * unit, at) / unit
        # Where a new frame stands on an old one its numbers are the file's own.
        values[:, columns] = np.where(at.share[:, None] > 0, between, angles[at.before])
    return values


def _arcs(order: str, angles: Array, at: _At) -> Array:
    if len(order) < 3:
        step = angles[at.after] - angles[at.before]
        step -= 2 * np.pi * np.round(step / (2 * np.pi))
        way: Array = angles[at.before] + at.share[:, None] * step
        return way
    turns = Rotation.from_euler(order, angles).as_quat(scalar_first=True)
    between = Rotation.from_quat(at.turned(turns), scalar_first=True)
    return nearest_angles(angles_of(between, order), angles[at.before])


def _markers(motion: MarkerMotion, at: _At) -> MarkerMotion:
    turns = motion.orientations
    if turns is not None:
        turns = np.stack([at.turned(turns[:, i]) for i in range(turns.shape[1])], axis=1)
    return replace(
        motion,
        positions=at.linear(motion.positions),
        orientations=turns,
        residuals=None if motion.residuals is None else at.linear(motion.residuals),
        cameras=None if motion.cameras is None else motion.cameras[at.nearest],
    )


def _motion(motion: Motion, rate: float) -> Motion:
    count = int(motion.duration * rate * (1 + _SLACK)) + 1
    if count > _MOST:
        raise MotionError(f"more than {_MOST} frames at that rate")
    time = np.arange(count) / rate
    rows = [motion.sample(t) for t in np.minimum(time, motion.duration)]
    qpos, qvel, qacc = (np.array(each) for each in zip(*rows, strict=True))
    return replace(motion, time=time, qpos=qpos, qvel=qvel, qacc=qacc)
