"""Limbs that jump to the other side of their line for a few frames, led over instead.

Skeletons fitted to markers lose one: from one frame to the next a knee is then on the other side of
the line from hip to ankle, the foot turned about with it, and as suddenly back. No body did that,
and whoever follows it whirls the hip. Such a time is bridged from the last sample before it to the
first after it: the limb as a whole turns the short way, and its joints go straight in its frame.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation, Slerp

from enpointe.models.anatomy import SIDES
from enpointe.motion.retargeting.directions import unit
from enpointe.motion.retargeting.source import Source

__all__ = ["mended"]

Array = NDArray[np.float64]
_IMPOSSIBLE, _LEAST = 40.0, np.radians(10.0)
"""rad/s: no thigh and no shank turns faster; a football kick's shank reaches 30 to 35 (Lees & Nolan
1998, The biomechanics of soccer). And rad: less from frame to frame is noise at high rates."""
_AWAY = 0.3
"""s: a limb that was on the other side for longer may have been so before, too."""
_RETURNS = 0.5
"""What jumped has come back if this share of the jump, at most, is left."""
_UNHURRIED = 10.0
"""rad/s: a bridge is long enough to turn no faster on average."""
_WIDEST = 0.2
"""s that a bridge reaches out to each side at most."""
_HINGE = 0.05
"""Weight of what a foot says of the side that a knee bends to, against a knee bent by 90 degrees:
a straight one says nothing."""
_LIMBS = {
    "leg": ("hip", "knee", "ankle", "toe"),
    "arm": ("shoulder", "elbow", "wrist", "hand"),
}


@dataclass(frozen=True)
class _Bridge:
    """From sample `first` to sample `last`; those in between are doubted."""

    first: int
    last: int


def mended(source: Source) -> Source:
    """The same movement, limbs that jumped led over, with a warning for each limb."""
    points, frames, lines = dict(source.points), dict(source.frames), []
    for side in SIDES:
        for name, joints in _LIMBS.items():
            chain = [f"{side}_{joint}" for joint in joints if f"{side}_{joint}" in points]
            if len(chain) < 3:
                continue
            foot = f"{side}_foot" if name == "leg" and f"{side}_foot" in frames else None
            turns = _frames(points, chain, None if foot is None else frames[foot])
            jumps = _jumps(points, chain, source.rate)
            bridges = _bridges(turns, jumps, source.rate)
            if not bridges:
                continue
            led = _led(turns, bridges)
            _carry(points, chain, turns, led, bridges)
            if foot is not None:
                frames[foot] = _carried(frames[foot], turns, led, bridges)
            lines.append(_told(f"{side} {name}", bridges, source.time))
    return replace(source, points=points, frames=frames, warnings=(*source.warnings, *lines))


def _told(limb: str, bridges: list[_Bridge], time: Array) -> str:
    longest = max(bridges, key=lambda each: each.last - each.first)
    when = f"{time[longest.first]:.2f} to {time[longest.last]:.2f} s"
    if len(bridges) == 1:
        return f"the {limb} jumps, faster than limbs can turn; it is led over from {when}"
    return (
        f"the {limb} jumps {len(bridges)} times, faster than limbs can turn; it is led over, for"
        f" longest from {when}"
    )


def _jumps(points: Mapping[str, Array], chain: list[str], rate: float) -> NDArray[np.int64]:
    """Samples from which to the next one a bone of the limb turns as none can."""
    jumps = np.zeros(len(points[chain[0]]) - 1, dtype=bool)
    for one, other in pairwise(chain[:3]):
        turned = _angle(unit(points[other] - points[one]))
        jumps |= (turned > _LEAST) & (turned * rate > _IMPOSSIBLE)
    return np.flatnonzero(jumps)


def _frames(points: Mapping[str, Array], chain: list[str], foot: Array | None) -> Rotation:
    """A limb as a whole: x from its root to its end, y along the hinge in between."""
    root, middle, end = (points[name] for name in chain[:3])
    along = unit(end - root)
    hinge = np.cross(unit(middle - root), unit(end - middle))
    if foot is not None:
        hinge = hinge + _HINGE * foot[:, :, 1]
    across = unit(hinge - np.sum(hinge * along, axis=1, keepdims=True) * along)
    turns = np.stack([along, across, np.cross(along, across)], axis=2)
    return Rotation.from_matrix(turns)


def _bridges(turns: Rotation, jumps: NDArray[np.int64], rate: float) -> list[_Bridge]:
    """Times away from between two jumps, the shortest first; and what is left of jumps."""
    left, found = [int(jump) for jump in jumps], []

    def returns(jump: int, back: int) -> bool:
        gone = max(_between(turns, jump, jump + 1), _between(turns, back, back + 1))
        return _between(turns, jump, back + 1) < _RETURNS * gone

    while True:
        pairs = [
            (one, other)
            for one, other in pairwise(left)
            if other - one <= _AWAY * rate and returns(one, other)
        ]
        if not pairs:
            break
        away = min(pairs, key=lambda pair: pair[1] - pair[0])
        found.append(_Bridge(away[0], away[1] + 1))
        left = [jump for jump in left if jump not in away]
    found += [_Bridge(jump, jump + 1) for jump in left]
    return _joined([_widened(turns, each, rate) for each in found])


def _widened(turns: Rotation, bridge: _Bridge, rate: float) -> _Bridge:
    first, last = bridge.first, bridge.last
    for _ in range(round(_WIDEST * rate)):
        if _between(turns, first, last) * rate <= _UNHURRIED * (last - first):
            break
        first, last = max(first - 1, 0), min(last + 1, len(turns) - 1)
    return _Bridge(first, last)


def _joined(bridges: list[_Bridge]) -> list[_Bridge]:
    """Without overlaps, in order."""
    joined: list[_Bridge] = []
    for each in sorted(bridges, key=lambda bridge: bridge.first):
        if joined and each.first < joined[-1].last:
            joined[-1] = _Bridge(joined[-1].first, max(joined[-1].last, each.last))
        else:
            joined.append(each)
    return joined


def _led(turns: Rotation, bridges: list[_Bridge]) -> Rotation:
    """The turns of a limb, smoothly over its bridges."""
    quaternions = turns.as_quat()
    for each in bridges:
        way = Slerp([0.0, 1.0], turns[[each.first, each.last]])
        quaternions[each.first : each.last + 1] = way(_shares(each)).as_quat()
    return Rotation.from_quat(quaternions)


def _carry(
    points: dict[str, Array],
    chain: list[str],
    turns: Rotation,
    led: Rotation,
    bridges: list[_Bridge],
) -> None:
    """Lead the joints of a limb over its bridges, in its frame."""
    root = points[chain[0]]
    for name in chain[1:]:
        place = points[name].copy()
        for each in bridges:
            ends = [each.first, each.last]
            start, end = turns[ends].inv().apply(points[name][ends] - root[ends])
            share = _shares(each)[:, None]
            rows = slice(each.first, each.last + 1)
            place[rows] = root[rows] + led[rows].apply((1.0 - share) * start + share * end)
        points[name] = place


def _carried(frame: Array, turns: Rotation, led: Rotation, bridges: list[_Bridge]) -> Array:
    """The frame (T, 3, 3) of what ends a limb, led over its bridges with it."""
    found = frame.copy()
    for each in bridges:
        ends = [each.first, each.last]
        within = turns[ends].inv() * Rotation.from_matrix(frame[ends])
        rows = slice(each.first, each.last + 1)
        found[rows] = (led[rows] * Slerp([0.0, 1.0], within)(_shares(each))).as_matrix()
    return found


def _shares(bridge: _Bridge) -> Array:
    share = np.linspace(0.0, 1.0, bridge.last - bridge.first + 1)
    return np.asarray(share**2 * (3.0 - 2.0 * share))


def _between(turns: Rotation, one: int, other: int) -> float:
    return float((turns[one].inv() * turns[other]).magnitude())


def _angle(directions: Array) -> Array:
    """By how much directions (T, 3) turn from each sample to the next, (T - 1,), rad."""
    chord = np.linalg.norm(np.diff(directions, axis=0), axis=1)
    return np.asarray(2.0 * np.arcsin(np.clip(0.5 * chord, 0.0, 1.0)))
