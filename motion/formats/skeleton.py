"""A skeleton that moves, in a file's own units and axes."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from enpointe.errors import MotionError
from enpointe.motion.formats.space import Space

__all__ = ["CHANNELS", "IDENTITY", "Joint", "Skeleton", "SkeletonMotion"]

Array = NDArray[np.float64]
CHANNELS = (
    *(f"{axis}position" for axis in "XYZ"),
    *(f"{axis}rotation" for axis in "XYZ"),
    *(f"{axis}scale" for axis in "XYZ"),
)
IDENTITY = (1.0, 0.0, 0.0, 0.0)


@dataclass(frozen=True, slots=True)
class Joint:
    """One joint of a skeleton at rest.

    Attributes:
        name: As in the file.
        parent: Index of the parent in the skeleton, or -1; always smaller than the joint's own.
        offset: From the parent's origin, in the parent's frame, file units.
        channels: Names out of `CHANNELS`, in the order in which the file has them.
        order: Letters of the axes in the order in which their rotations are multiplied, the first
            outermost: "ZXY" is R = Rz @ Rx @ Ry. Empty where that is the order of the channels
            (BVH); ASF applies the first channel innermost, BVA lists X Y Z and multiplies ZXY.
        axis: Quaternion w x y z of the frame in which the channels turn, in the joint's frame at
            rest (ASF's `axis`).
        rest: Quaternion w x y z of the joint's frame at rest in its parent's (HTR's base
            position). The joint's rotation is rest @ axis @ R @ axis^-1.
        ends: Offsets of end sites in the joint's frame, file units.
        limits: One (low, high) a channel, file units, or empty where the file has none.
    """

    name: str
    parent: int
    offset: tuple[float, float, float] = (0.0, 0.0, 0.0)
    channels: tuple[str, ...] = ()
    order: str = ""
    axis: tuple[float, float, float, float] = IDENTITY
    rest: tuple[float, float, float, float] = IDENTITY
    ends: tuple[tuple[float, float, float], ...] = ()
    limits: tuple[tuple[float, float], ...] = ()

    @property
    def turning(self) -> tuple[str, ...]:
        """Axes of the rotation channels, as the file has them."""
        return tuple(c[0] for c in self.channels if c.endswith("rotation"))

    @property
    def product(self) -> str:
        """Axes in the order in which their rotations are multiplied, the first outermost."""
        return self.order or "".join(self.turning)

    @property
    def plain(self) -> bool:
        """Whether the channels, in the file's order, are the joint's whole rotation."""
        return self.product == "".join(self.turning) and self.axis == IDENTITY == self.rest


@dataclass(frozen=True)
class Skeleton:
    """Joints in an order in which every parent comes before its children.

    Attributes:
        joints: The joints.
        space: Units and axes of all lengths and angles.
        positions_replace_offset: Whether a joint's position channels stand in place of its offset
            (BVH as nearly everybody writes it) or are added to it (ASF, HTR).
    """

    joints: tuple[Joint, ...]
    space: Space = field(default_factory=Space)
    positions_replace_offset: bool = True

    def __post_init__(self) -> None:
        """Check parents, names and channels.

        Raises:
            MotionError: A parent after its child, a name twice, a channel that there is not.
        """
        if not self.joints:
            raise MotionError("a skeleton needs one joint at least")
        name, times = Counter(joint.name for joint in self.joints).most_common(1)[0]
        if times > 1:
            raise MotionError(f"two joints are called {name!r}")
        for index, joint in enumerate(self.joints):
            if not -1 <= joint.parent < index:
                raise MotionError(f"the parent of {joint.name!r} must come before it")
            strange = [c for c in joint.channels if c not in CHANNELS]
            if strange or len(set(joint.channels)) < len(joint.channels):
                raise MotionError(f"{joint.name!r} has channels {joint.channels}; see CHANNELS")
            if sorted(joint.product) != sorted(joint.turning):
                raise MotionError(f"{joint.name!r} can't turn {joint.product} by {joint.turning}")

    @property
    def names(self) -> tuple[str, ...]:
        """The joints' names."""
        return tuple(joint.name for joint in self.joints)

    @property
    def width(self) -> int:
        """Number of channels of all joints."""
        return int(self._firsts[-1])

    @cached_property
    def _firsts(self) -> NDArray[np.intp]:
        return np.cumsum([0, *(len(joint.channels) for joint in self.joints)])

    @cached_property
    def children(self) -> tuple[tuple[int, ...], ...]:
        """Of each joint, the joints that hang on it."""
        found: list[list[int]] = [[] for _ in self.joints]
        for index, joint in enumerate(self.joints):
            if joint.parent >= 0:
                found[joint.parent].append(index)
        return tuple(tuple(each) for each in found)

    def columns(self, joint: int) -> slice:
        """Where a joint's channels stand in a row of values."""
        return slice(int(self._firsts[joint]), int(self._firsts[joint + 1]))


@dataclass(frozen=True)
class SkeletonMotion:
    """What a skeleton does, channel by channel, as the file has it.

    Attributes:
        skeleton: Who moves.
        rate: Frames per second.
        values: (T, skeleton.width), file units; the numbers of the file, so that writing them
            again loses nothing.
        start: Number of the first frame in the file.
        notes: What else the file says, by name.
    """

    skeleton: Skeleton
    rate: float
    values: Array
    start: int = 0
    notes: dict[str, str] = field(default_factory=dict)

    def __post_init__(self) -> None:
        """Check the shape and the rate.

        Raises:
            MotionError: Values that do not fit the skeleton, a rate that is no rate.
        """
        if self.values.ndim != 2 or self.values.shape[1] != self.skeleton.width:
            raise MotionError(
                f"values must have shape (T, {self.skeleton.width}), got {self.values.shape}"
            )
        if not np.isfinite(self.rate) or self.rate <= 0:
            raise MotionError(f"a rate must be above 0, got {self.rate}")

    @property
    def frames(self) -> int:
        """T."""
        return len(self.values)

    def local(self) -> tuple[Array, Array]:
        """Every joint in its parent's frame.

        Returns:
            Translations (T, J, 3) in file units and rotations (T, J, 4) as quaternions w x y z.
        """
        count, joints = self.frames, self.skeleton.joints
        translations = np.empty((count, len(joints), 3))
        rotations = np.empty((count, len(joints), 4))
        for index, joint in enumerate(joints):
            values = self.values[:, self.skeleton.columns(index)]
            translations[:, index] = self._translation(joint, values)
            rotations[:, index] = self._rotation(joint, values)
        return translations, rotations

    def world(self) -> tuple[Array, Array]:
        """Every joint in the file's world.

        Returns:
            Positions (T, J, 3) in file units and rotations (T, J, 4) as quaternions w x y z.
        """
        translations, rotations = self.local()
        for index, joint in enumerate(self.skeleton.joints):
            if joint.parent < 0:
                continue
            parent = Rotation.from_quat(rotations[:, joint.parent], scalar_first=True)
            own = Rotation.from_quat(rotations[:, index], scalar_first=True)
            translations[:, index] = translations[:, joint.parent] + parent.apply(
                translations[:, index]
            )
            rotations[:, index] = (parent * own).as_quat(scalar_first=True)
        return translations, rotations

    def _translation(self, joint: Joint, values: Array) -> Array:
        moved = np.tile(np.asarray(joint.offset), (self.frames, 1))
        for column, channel in enumerate(joint.channels):
            if channel.endswith("position"):
                axis = "XYZ".index(channel[0])
                base = 0.0 if self.skeleton.positions_replace_offset else moved[:, axis]
                moved[:, axis] = base + values[:, column]
        return moved

    def _rotation(self, joint: Joint, values: Array) -> Array:
        turning = [i for i, c in enumerate(joint.channels) if c.endswith("rotation")]
        if not turning:
            return np.tile(joint.rest, (self.frames, 1))
        angles = values[:, turning] * self.skeleton.space.radians_per_unit
        columns = [joint.turning.index(axis) for axis in joint.product]
        turned = Rotation.from_euler(joint.product, angles[:, columns])
        rest = Rotation.from_quat(joint.rest, scalar_first=True)
        frame = Rotation.from_quat(joint.axis, scalar_first=True)
        whole: Array = (rest * frame * turned * frame.inv()).as_quat(scalar_first=True)
        return whole
