"""A skeleton that moves, in a file's own units and axes."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from enpointe.errors import MotionError
from enpointe.motion.formats.space import Space

__all__ = ["CHANNELS", "Joint", "Skeleton", "SkeletonMotion"]

Array = NDArray[np.float64]
CHANNELS = (
    *(f"{axis}position" for axis in "XYZ"),
    *(f"{axis}rotation" for axis in "XYZ"),
    *(f"{axis}scale" for axis in "XYZ"),
)
_IDENTITY = (1.0, 0.0, 0.0, 0.0)


@dataclass(frozen=True, slots=True)
class Joint:
    """One joint of a skeleton at rest.

    Attributes:
        name: As in the file.
        parent: Index of the parent in the skeleton, or -1; always smaller than the joint's own.
        offset: From the parent's origin, in the parent's frame, file units.
        channels: Names out of `CHANNELS`, in the order in which the file has them. Rotations are
            intrinsic: the first named is applied outermost, R = R_first @ R_second @ R_third.
        axis: Quaternion w x y z of the frame in which the channels turn, in the parent's frame
            at rest (ASF's `axis`, HTR's base rotation); a joint's rotation is
            axis @ channels @ axis^-1 before its parent's.
        ends: Offsets of end sites in the joint's frame, file units.
        limits: One (low, high) a channel, file units, or empty where the file has none.
    """

    name: str
    parent: int
    offset: tuple[float, float, float] = (0.0, 0.0, 0.0)
    channels: tuple[str, ...] = ()
    axis: tuple[float, float, float, float] = _IDENTITY
    ends: tuple[tuple[float, float, float], ...] = ()
    limits: tuple[tuple[float, float], ...] = ()


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
        names = [joint.name for joint in self.joints]
        if not names:
            raise MotionError("a skeleton needs one joint at least")
        if len(set(names)) < len(names):
            twice = next(name for name in names if names.count(name) > 1)
            raise MotionError(f"two joints are called {twice!r}")
        for index, joint in enumerate(self.joints):
            if not -1 <= joint.parent < index:
                raise MotionError(f"the parent of {joint.name!r} must come before it")
            strange = [c for c in joint.channels if c not in CHANNELS]
            if strange or len(set(joint.channels)) < len(joint.channels):
                raise MotionError(f"{joint.name!r} has channels {joint.channels}; see CHANNELS")

    @property
    def names(self) -> tuple[str, ...]:
        """The joints' names."""
        return tuple(joint.name for joint in self.joints)

    @property
    def width(self) -> int:
        """Number of channels of all joints."""
        return sum(len(joint.channels) for joint in self.joints)

    def columns(self, joint: int) -> slice:
        """Where a joint's channels stand in a row of values."""
        first = sum(len(earlier.channels) for earlier in self.joints[:joint])
        return slice(first, first + len(self.joints[joint].channels))


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
        """Every joint in the file's world: positions (T, J, 3), file units, quaternions (T, J, 4)."""
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
            return np.tile(_IDENTITY, (self.frames, 1))
        order = "".join(joint.channels[i][0] for i in turning)
        angles = values[:, turning] * self.skeleton.space.radians_per_unit
        turned = Rotation.from_euler(order, angles if len(turning) > 1 else angles[:, 0])
        frame = Rotation.from_quat(joint.axis, scalar_first=True)
        whole: Array = (frame * turned * frame.inv()).as_quat(scalar_first=True)
        return whole
