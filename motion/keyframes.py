"""The moments of a motion that a notator would write: where its extremities pause or turn.

Neagle 2005 §5.2.1: key frames of a dance are the positions that it goes through, and movement lines
replace the frames in between. A position shows as a pause: all that moved slows down together and
goes on in another direction.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import gaussian_filter1d
from scipy.signal import find_peaks, peak_prominences

from enpointe.models.footing import footing, lowest_sole
from enpointe.models.joints import Joints
from enpointe.models.limbs import orientation
from enpointe.notation import Side

__all__ = ["LEAST_SPACING", "Flight", "KeyMoment", "MotionOutline", "key_moments"]

Array = NDArray[np.float64]
_SMOOTHING = 0.025
"""Standard deviation of the window that speeds are smoothed over, s."""
STILL = 0.01
"""What moves slower than this share of the fastest moment stands still."""
_STILL_SPEED = 0.012
"""The same for a motion without fast moments, m/s."""
_PAUSE = 0.45
"""A least speed is a pause if it is below this share of the lower of the peaks about it."""
_SLIGHT_PAUSE = 0.8
"""A slighter one may be a pause, and so may one of a limb by itself below the next share."""
_LIMB_PAUSE = 0.35
_LIMB_MOVES = 0.12
"""Slower than this, m/s, a limb is not taken to have been on its way at all."""
_UNSEEN = 0.001
"""Slower than this, m/s, a part rests: no eye sees it move, and of a part that rests only the
rounding of its numbers would say where it pauses."""
LEAST_SPACING = 0.15
"""Closest key moments, s: a third of a beat at the pace of an allegro."""
_SHORTEST_HOLD = 0.5
"""A stillness shorter than this, s, is a pause and not a hold."""
_SLOW_START = 0.15
"""Neither is one shorter than this share of the movement that follows, which may start too slowly
to be seen."""
_CLEAR = 0.01
"""Soles higher than this, m, are off the floor next to a moment that is in the air for certain."""
_HEAD = 0.25
_TRUNK = 0.5
"""Radii at which the turns of head and trunk count as ways, m."""


@dataclass(frozen=True, slots=True)
class Flight:
    """A time in the air.

    Attributes:
        start: The last moment on the floor, s.
        end: The first moment back on it, s.
    """

    start: float
    end: float


@dataclass(frozen=True, slots=True)
class KeyMoment:
    """A moment to write.

    Attributes:
        time: s from the start of the motion.
        holds: Whether she stood still up to here: a frame that begins a movement.
        depth: How marked the pause is, from 0 to 1 (still).
        sure: Whether everything pauses; one limb that pauses while others move on, or all that
            merely slow down, are a position only if the pose is one.
    """

    time: float
    holds: bool
    depth: float
    sure: bool = True


class MotionOutline:
    """How fast the parts of a dancer move, and when she is in the air.

    Args:
        time: (T,), s, evenly spaced.
        joints: One for each moment.
    """

    def __init__(self, time: Array, joints: Sequence[Joints]) -> None:
        self.time = time
        self._step = float(time[1] - time[0])
        ways = {}
        for side in Side:
            ways[f"{side} hand"] = _relative(joints, f"{side}_wrist", f"{side}_shoulder", "torso")
            ways[f"{side} foot"] = _relative(joints, f"{side}_ankle", f"{side}_hip", "upright")
        ways["head"] = _HEAD * np.array([_axes(j.torso.T @ j.head) for j in joints])
        ways["trunk"] = _TRUNK * np.array([_axes(j.torso) for j in joints])
        self.speeds = {name: self._speed(way) for name, way in ways.items()}
        self.speed = np.sqrt(np.sum([v**2 for v in self.speeds.values()], axis=0))
        # Where a plie or a jump turns: it slows nothing else down.
        self.speeds["rise"] = self._speed(np.array([j.com[2] for j in joints]))
        self.turned = np.unwrap([np.radians(orientation(j.pelvis).turn) for j in joints])
        self.flights = tuple(_flights(time, joints))

    @property
    def still(self) -> NDArray[np.bool_]:
        """Where she stands still, (T,)."""
        return np.asarray(self.speed < max(STILL * float(self.speed.max()), _STILL_SPEED))

    def _speed(self, way: Array) -> Array:
        flat = way.reshape(len(way), -1)
        speed = np.linalg.norm(np.gradient(flat, self._step, axis=0), axis=1)
        return np.asarray(gaussian_filter1d(speed, _SMOOTHING / self._step))


def key_moments(outline: MotionOutline) -> tuple[KeyMoment, ...]:
    """The first pose, every pause and turn, and the last pose, in order.

    Returns:
        At least the first and the last moment.
    """
    time, still = outline.time, outline.still
    moving = [(a, b) for a, b in _runs(~still) if time[b - 1] - time[a] > LEAST_SPACING]
    if not moving:
        return (KeyMoment(float(time[0]), True, 1.0), KeyMoment(float(time[-1]), False, 1.0))
    moments: list[KeyMoment] = []
    for a, b in moving:
        start, end = float(time[a]), float(time[b - 1])
        hold = max(_SHORTEST_HOLD, _SLOW_START * (end - start))
        if not moments or start - moments[-1].time > hold:
            moments.append(KeyMoment(start, True, 1.0))
        whole = _pauses(outline.speed[a:b], _PAUSE, ripples=False)
        inside = [(i, 1.0 + depth) for i, depth in whole]
        inside += _pauses(outline.speed[a:b], _SLIGHT_PAUSE)
        for speed in outline.speeds.values():
            if speed[a:b].max() > _LIMB_MOVES:
                inside += _pauses(speed[a:b], _LIMB_PAUSE)
        rise = outline.speeds["rise"][a:b]
        if rise.max() > _LIMB_MOVES:
            inside += _arrivals(rise, _LIMB_PAUSE)
        moments += _spaced([(float(time[a + i]), depth) for i, depth in inside], start, end)
        moments.append(KeyMoment(end, False, 1.0))
    return tuple(moments)


def _pauses(speed: Array, below: float, *, ripples: bool = True) -> list[tuple[int, float]]:
    """Where a speed dips between two peaks to less than a share of the lower one, and how deep.

    What rests in the dip pauses where it comes to rest. Without ripples a peak in a slow stretch is
    none, which would hide the pause about it.
    """
    speed = _seen(speed)
    padded = np.concatenate([[0.0], speed, [0.0]])
    peaks, _ = find_peaks(padded)
    if not ripples:
        peaks = peaks[peak_prominences(padded, peaks)[0] > (1.0 - _SLIGHT_PAUSE) * padded[peaks]]
    found = []
    for before, after in zip(peaks[:-1] - 1, peaks[1:] - 1, strict=True):
        low = before + int(np.argmin(speed[before : after + 1]))
        share = speed[low] / min(speed[before], speed[after])
        if share < below:
            found.append((low, 1.0 - float(share)))
    return found


def _arrivals(speed: Array, below: float) -> list[tuple[int, float]]:
    """Where a speed first dips to less than a share of the peak before, whatever follows it.

    A dancer who comes down into a plié may glide on in it, so that no peak follows, or rest there.
    """
    speed = _seen(speed)
    peaks, _ = find_peaks(np.concatenate([[0.0], speed, [0.0]]))
    found = []
    for before in peaks - 1:
        _, dips = find_peaks([*-speed[before:], -np.inf], plateau_size=1)
        for dip in before + dips["left_edges"][:1]:
            share = speed[dip] / speed[before]
            if share < below:
                found.append((int(dip), 1.0 - float(share)))
    return found


def _seen(speed: Array) -> Array:
    """A speed, and none where no eye would see it."""
    return np.where(speed < _UNSEEN, 0.0, speed)


def _spaced(found: Sequence[tuple[float, float]], start: float, end: float) -> list[KeyMoment]:
    """The most marked moments first, none closer to another than `LEAST_SPACING`.

    Args:
        found: Times, and how marked each is, with 1 added where everything pauses.
        start: Of the movement, s.
        end: Of the movement, s.
    """
    kept: list[KeyMoment] = []
    taken = [start, end]
    for time, depth in sorted(found, key=lambda each: -each[1]):
        if all(abs(time - other) >= LEAST_SPACING for other in taken):
            kept.append(KeyMoment(time, False, min(depth, 1.0), depth > 1.0))
            taken.append(time)
    return sorted(kept, key=lambda each: each.time)


def _relative(joints: Sequence[Joints], end: str, root: str, frame: str) -> Array:
    """The way of a point as seen from its limb's root, (T, 3), m."""
    way = []
    for each in joints:
        if frame == "torso":
            axes = each.torso
        else:
            turn = np.radians(orientation(each.pelvis).turn)
            c, s = np.cos(turn), np.sin(turn)
            axes = np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])
        way.append(axes.T @ (each[end] - each[root]))
    return np.array(way)


def _axes(rotation: Array) -> Array:
    """Two of the axes that a rotation carries along: how they move is how fast it turns."""
    return np.asarray(rotation[:, (0, 2)] / np.sqrt(2.0))


def _flights(time: Array, joints: Sequence[Joints]) -> Iterator[Flight]:
    """The times in the air: off the floor for certain somewhere, and from there as far as clear."""
    aloft = np.array([all(foot.floor is None for foot in footing(j).values()) for j in joints])
    clear = np.array([lowest_sole(j) > _CLEAR for j in joints])
    for a, b in _runs(clear | aloft):
        if aloft[a:b].sum() > 1:
            yield Flight(float(time[max(a - 1, 0)]), float(time[min(b, len(time) - 1)]))


def _runs(mask: NDArray[np.bool_]) -> list[tuple[int, int]]:
    """Starts and ends (exclusive) of the stretches where a mask holds."""
    edges = np.flatnonzero(np.diff(np.concatenate([[0], mask.astype(int), [0]])))
    return [(int(a), int(b)) for a, b in edges.reshape(-1, 2)]
