"""Landmarks found by how a skeleton branches, where its names tell nothing.

Two chains that hang on one joint and mirror one another are limbs; the pair whose ends are lowest
is the legs, and the pair highest up the spine the arms. Left and right follow from where the toes
point.
"""

from __future__ import annotations

from itertools import combinations, pairwise

import numpy as np
from numpy.typing import NDArray

from enpointe.motion.formats.skeleton import Skeleton
from enpointe.motion.retargeting.joint_map import END, JointMap
from enpointe.motion.retargeting.naming import frames_of

__all__ = ["map_skeleton_by_structure"]

Array = NDArray[np.float64]
_ALIKE = 0.25
"""Two limbs are a pair if their lengths differ by less than this share."""
_ZERO = 1e-6
"""A bone shorter than this share of the skeleton is none."""


def map_skeleton_by_structure(skeleton: Skeleton, world: Array) -> JointMap:
    """A map from hierarchy and places alone.

    Args:
        skeleton: The joints.
        world: (T, J, 3), where they are, m, z up.
    """
    places = np.median(world - world[:, :1], axis=0)
    chains = _Chains(skeleton, places)
    pairs = chains.pairs()
    points: dict[str, tuple[str, ...]] = {}
    if not pairs:
        return JointMap(points, {}, "structure")
    legs = min(pairs, key=lambda pair: sum(chains.foot(limb) for limb in pair))
    hung = chains.hung(legs)
    others = [pair for pair in pairs if not set(pair[0]) & set(hung) and pair != legs]
    arms = max(others, key=lambda pair: chains.length(pair[0]), default=None)
    forward = sum(world[:, limb[-1]] - world[:, limb[-2]] for limb in legs)
    left = np.cross([0.0, 0.0, 1.0], forward)
    for pair, names in ((legs, ("hip", "knee", "ankle", "toe")), (arms, _ARM)):
        if pair is None:
            continue
        one, other = (world[:, list(limb)].mean(axis=1) for limb in pair)
        ordered = pair if np.sum((one - other) * left) >= 0 else pair[::-1]
        for side, limb in zip(("left", "right"), ordered, strict=True):
            points |= chains.named(limb, names, side)
    if arms is not None:
        spine = chains.above(arms[0][0])
        points["chest"] = (skeleton.names[spine],)
        head = chains.head(spine, arms)
        if head is not None:
            points["head"] = (skeleton.names[head],)
    return JointMap(points, frames_of(skeleton, points), "structure")


_ARM = ("shoulder", "elbow", "wrist", "hand")


class _Chains:
    """The unbranched ways from a joint that branches to the ends of limbs."""

    def __init__(self, skeleton: Skeleton, places: Array) -> None:
        self._skeleton, self._places = skeleton, places
        self._size = float(np.ptp(places, axis=0).max()) * _ZERO

    def foot(self, limb: tuple[int, ...]) -> float:
        return float(self._places[limb[-1], 2])

    def length(self, limb: tuple[int, ...]) -> float:
        return float(np.linalg.norm(np.diff(self._places[list(limb)], axis=0), axis=1).sum())

    def above(self, joint: int) -> int:
        """The joint that a limb hangs on: the nearest that branches."""
        parent = self._skeleton.joints[joint].parent
        while parent > 0 and len(self._skeleton.children[parent]) < 2:
            parent = self._skeleton.joints[parent].parent
        return max(parent, 0)

    def hung(self, pair: tuple[tuple[int, ...], ...]) -> list[int]:
        return [joint for limb in pair for joint in limb]

    def pairs(self) -> list[tuple[tuple[int, ...], tuple[int, ...]]]:
        """Mirrored limbs of four joints or more, ends counted."""
        found = []
        for children in self._skeleton.children:
            limbs = [self._limb(child) for child in children]
            for one, other in combinations([limb for limb in limbs if len(limb) >= 3], 2):
                lengths = self.length(one), self.length(other)
                if len(one) == len(other) and abs(lengths[0] - lengths[1]) < _ALIKE * max(lengths):
                    found.append((one, other))
        return found

    def _limb(self, joint: int) -> tuple[int, ...]:
        """Down the longest branch, joints in the same place counted once."""
        limb = [joint]
        while self._skeleton.children[limb[-1]]:
            limb.append(max(self._skeleton.children[limb[-1]], key=self._depth))
        moved = [
            here
            for here, below in pairwise(limb)
            if np.linalg.norm(self._places[below] - self._places[here]) > self._size
        ]
        return (*moved, limb[-1])

    def _depth(self, joint: int) -> float:
        below = self._skeleton.children[joint]
        own = [
            float(np.linalg.norm(self._places[b] - self._places[joint])) + self._depth(b)
            for b in below
        ]
        return max(own, default=0.0)

    def named(
        self, limb: tuple[int, ...], names: tuple[str, ...], side: str
    ) -> dict[str, tuple[str, ...]]:
        """The two longest bones in a row are thigh and shank, or upper arm and forearm."""
        joints = list(limb)
        places = self._places[joints]
        bones = np.linalg.norm(np.diff(places, axis=0), axis=1)
        first = int(np.argmax(bones[:-1] + bones[1:])) if len(bones) > 1 else 0
        chosen = joints[first : first + len(names)]
        points: dict[str, tuple[str, ...]] = {
            f"{side}_{name}": (self._skeleton.names[joint],)
            for name, joint in zip(names, chosen, strict=False)
        }
        if len(chosen) == len(names) - 1 and self._skeleton.joints[chosen[-1]].ends:
            points[f"{side}_{names[-1]}"] = (self._skeleton.names[chosen[-1]] + END,)
        return points

    def head(self, spine: int, arms: tuple[tuple[int, ...], ...]) -> int | None:
        """The end of what goes up from where the arms hang, and is no arm."""
        rest = [
            self._limb(child)
            for child in self._skeleton.children[spine]
            if not any(child in limb or self._within(limb[0], child) for limb in arms)
        ]
        return max((limb[-1] for limb in rest), key=lambda j: self._places[j, 2], default=None)

    def _within(self, joint: int, above: int) -> bool:
        while joint >= 0 and joint != above:
            joint = self._skeleton.joints[joint].parent
        return joint == above
