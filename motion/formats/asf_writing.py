"""Any skeleton as ASF describes one, and the lines of an ASF file."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field, replace
from math import hypot

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from enpointe.motion.formats.asf import BONE, axis_quaternion
from enpointe.motion.formats.convert import depth_first, plain
from enpointe.motion.formats.skeleton import IDENTITY, Joint, Skeleton, SkeletonMotion
from enpointe.motion.formats.space import DEGREES
from enpointe.motion.formats.tree import Vector, unlike
from enpointe.motion.formats.units import INCH
from enpointe.motion.formats.writing import note_numbers, one_word

__all__ = ["as_figure", "asf_lines", "held"]

_ROOT = "root"
_NONE = (0.0, 0.0, 0.0)
_UNIT = ":units length"
_POSITIONS = ("Xposition", "Yposition", "Zposition")


def held(note: str) -> bool:
    """Whether an ASF or AMC file has a place for a note of that name."""
    return note.startswith((":", BONE)) or " of " in note


def as_figure(motion: SkeletonMotion) -> tuple[SkeletonMotion, tuple[str, ...]]:
    """A movement of bones that start where their parents end, and what of it falls.

    A joint on which several hang in different places becomes a bone without length that turns and
    rigid bones without angles that reach to them.
    """
    motion = depth_first(motion)
    if _is_figure(motion.skeleton):
        return motion, ()
    motion, lost = plain(motion)
    bones = _Bones(motion)
    root = motion.skeleton.joints[0]
    if root.name != _ROOT:
        lost += (f"the root's name, {root.name!r} (it is 'root' there)",)
    return bones.built(), lost


def _is_figure(skeleton: Skeleton) -> bool:
    joints = skeleton.joints
    root, others = joints[0], joints[1:]
    return (
        not skeleton.positions_replace_offset
        and skeleton.space.up == "y"
        and root.name == _ROOT
        and not root.ends
        and all(joint.parent >= 0 for joint in others)
        and all(joints[child].offset == _NONE for child in skeleton.children[0])
        and all(
            joint.rest == IDENTITY
            and joint.product == "".join(joint.turning)[::-1]
            and one_word(joint.name) == joint.name
            and not any(channel.endswith("scale") for channel in joint.channels)
            for joint in joints
        )
        and all(
            len({*joint.ends, *(joints[child].offset for child in children)}) == 1
            for joint, children in zip(others, skeleton.children[1:], strict=True)
        )
    )


@dataclass
class _Bones:
    """Builds a figure out of a plain movement, depth first."""

    motion: SkeletonMotion
    joints: list[Joint] = field(default_factory=list)
    columns: list[NDArray[np.float64]] = field(default_factory=list)

    def built(self) -> SkeletonMotion:
        skeleton = self.motion.skeleton
        roots = [index for index, joint in enumerate(skeleton.joints) if joint.parent < 0]
        moved, _ = self.motion.local()
        # Where each joint's children start: at the end of the bone that leads to them.
        if len(roots) == 1:
            self.add_root(moved[:, 0], 0)
            leads = {0: self.lead(0, 0, skeleton.joints[0].ends)}
        else:
            self.add_root(np.zeros((self.motion.frames, 3)), None)
            leads = {-1: {index: self.rigid(0, index) for index in roots}}
        for index, joint in enumerate(skeleton.joints):
            if joint.parent < 0 and len(roots) == 1:
                continue
            parent, offset = leads[joint.parent][index]
            own = self.add(joint, parent, offset, moved[:, index], index)
            leads[index] = self.lead(own, index, joint.ends)
        names, _ = unlike([one_word(joint.name) for joint in self.joints])
        joints = tuple(
            replace(joint, name=name) for joint, name in zip(self.joints, names, strict=True)
        )
        built = Skeleton(joints, skeleton.space, positions_replace_offset=False)
        return replace(self.motion, skeleton=built, values=np.concatenate(self.columns, axis=1))

    def lead(self, own: int, index: int, ends: tuple[Vector, ...]) -> dict[int, tuple[int, Vector]]:
        """Of each child of joint `index`, which is bone `own`, the bone it hangs on and where."""
        skeleton = self.motion.skeleton
        children = skeleton.children[index]
        offsets = [skeleton.joints[child].offset for child in children]
        if own and len({*offsets, *ends}) == 1 and (not ends or not children):
            self.joints[own] = replace(self.joints[own], ends=() if children else (*ends[:1],))
            return {child: (own, offset) for child, offset in zip(children, offsets, strict=True)}
        for number, end in enumerate(ends):
            self.joints.append(Joint(f"{self.joints[own].name}_end{number}", own, ends=(end,)))
        if own and not children and not ends:
            self.joints[own] = replace(self.joints[own], ends=(_NONE,))
        return {child: self.rigid(own, child) for child in children}

    def rigid(self, own: int, child: int) -> tuple[int, Vector]:
        """A bone that leads from the end of another to a joint."""
        joint = self.motion.skeleton.joints[child]
        if joint.offset == _NONE:
            return own, _NONE
        self.joints.append(Joint(f"{self.joints[own].name}_to_{joint.name}", own))
        return len(self.joints) - 1, joint.offset

    def add_root(self, moved: NDArray[np.float64], index: int | None) -> None:
        channels: tuple[str, ...] = _POSITIONS
        self.columns.append(moved)
        if index is not None:
            turning, values = self.turning(index)
            channels += turning
            self.columns.append(values)
        self.joints.append(Joint(_ROOT, -1, channels=channels, order=_order(channels)))

    def add(
        self, joint: Joint, parent: int, offset: Vector, moved: NDArray[np.float64], index: int
    ) -> int:
        channels, values = self.turning(index)
        if any(channel.endswith("position") for channel in joint.channels):
            channels = (*_POSITIONS, *channels)
            self.columns.append(moved - np.array(joint.offset))
        self.columns.append(values)
        name = "root_" if joint.name == _ROOT else joint.name
        self.joints.append(Joint(name, parent, offset, channels, _order(channels)))
        return len(self.joints) - 1

    def turning(self, index: int) -> tuple[tuple[str, ...], NDArray[np.float64]]:
        """A joint's rotation channels, the innermost first, and their values."""
        joint = self.motion.skeleton.joints[index]
        channels = tuple(f"{axis}rotation" for axis in joint.product[::-1])
        own = self.motion.values[:, self.motion.skeleton.columns(index)]
        return channels, own[:, [joint.channels.index(channel) for channel in channels]]


def _order(channels: tuple[str, ...]) -> str:
    return "".join(c[0] for c in channels if c.endswith("rotation"))[::-1]


def asf_lines(motion: SkeletonMotion) -> Iterator[str]:
    """The ASF file of a figure."""
    skeleton, notes = motion.skeleton, motion.notes
    own_angle = notes.get(":units angle", "deg")
    angle = DEGREES if own_angle.lower().startswith("deg") else 1.0
    yield f":version {notes.get(':version', '1.10')}"
    yield f":name {notes.get(':name', 'enpointe')}"
    yield ":units"
    yield f"  mass {notes.get(':units mass', '1.0')}"
    yield f"  length {_length(motion)}"
    yield f"  angle {own_angle}"
    for key, text in notes.items():
        if key.startswith(":") and " " not in key and key not in (":version", ":name", ":amc"):
            yield key
            yield from (f"  {line}" for line in text.split("\n"))
    yield ":root"
    root = skeleton.joints[0]
    yield f"  order {_dof(root).upper()}"
    yield "  axis XYZ"
    yield f"  position {_words(root.offset)}"
    yield f"  orientation {_words(_axis(root, angle))}"
    for key, text in notes.items():
        if key.startswith(":root "):
            yield f"  {key.removeprefix(':root ')} {text}"
    yield ":bonedata"
    scale = skeleton.space.radians_per_unit / angle
    for index, joint in enumerate(skeleton.joints[1:], start=1):
        yield from _bone(skeleton, index, joint, notes, angle, scale)
    yield ":hierarchy"
    yield "  begin"
    for joint, children in zip(skeleton.joints, skeleton.children, strict=True):
        if children:
            names = " ".join(skeleton.joints[child].name for child in children)
            yield f"    {joint.name} {names}"
    yield "  end"


def _bone(
    skeleton: Skeleton,
    index: int,
    joint: Joint,
    notes: dict[str, str],
    angle: float,
    scale: float,
) -> Iterator[str]:
    children = skeleton.children[index]
    reach = skeleton.joints[children[0]].offset if children else joint.ends[0]
    words = notes.get(f"{BONE}{joint.name}", "").split()
    if not _same(words, reach, joint, angle):
        direction, length = _direction(reach)
        words = [_words(direction), repr(length), _words(_axis(joint, angle)), "XYZ"]
    else:
        words = [" ".join(words[:3]), words[3], " ".join(words[4:]) or "0 0 0 XYZ", ""]
    yield "  begin"
    yield f"    id {notes.get(f'id of {joint.name}', index)}"
    yield f"    name {joint.name}"
    yield f"    direction {words[0]}"
    yield f"    length {words[1]}"
    yield f"    axis {words[2]} {words[3]}".rstrip()
    if joint.channels:
        yield f"    dof {_dof(joint)}"
    for number, (low, high) in enumerate(joint.limits):
        yield f"    {'limits' if not number else '      '} ({low * scale!r} {high * scale!r})"
    for key, text in notes.items():
        if key.endswith(f" of {joint.name}") and not key.startswith("id "):
            yield f"    {key.removesuffix(f' of {joint.name}')} {text}"
    yield "  end"


def _same(words: list[str], reach: Vector, joint: Joint, angle: float) -> bool:
    """Whether the words of a note still say what the joint is."""
    letters = "".join(words[7:]).upper() or "XYZ"
    try:
        numbers = [float(word) for word in words[:7]]
    except ValueError:
        return False
    if len(numbers) not in (4, 7) or sorted(letters) != ["X", "Y", "Z"]:
        return False
    x, y, z, length, *turns = numbers
    a, b, c = turns or _NONE
    kept = axis_quaternion((a, b, c), letters, angle) == joint.axis
    return kept and (x * length, y * length, z * length) == reach


def _direction(reach: Vector) -> tuple[Vector, float]:
    """A unit vector and a length whose product is `reach` but for rounding."""
    length = hypot(*reach)
    if length == 0:
        return (0.0, 1.0, 0.0), 0.0
    x, y, z = (value / length for value in reach)
    return (x, y, z), length


def _axis(joint: Joint, angle: float) -> Vector:
    if joint.axis == IDENTITY:
        return _NONE
    x, y, z = Rotation.from_quat(joint.axis, scalar_first=True).as_euler("xyz") / angle
    return float(x), float(y), float(z)


def _length(motion: SkeletonMotion) -> str:
    """Inches over this are the unit."""
    unit, written = motion.skeleton.space.metres_per_unit, note_numbers(motion, _UNIT)
    kept = len(written) == 1 and written[0] > 0 and INCH / written[0] == unit
    return motion.notes[_UNIT] if kept else repr(INCH / unit)


def _dof(joint: Joint) -> str:
    return " ".join(
        ("t" if channel.endswith("position") else "r") + channel[0].lower()
        for channel in joint.channels
    )


def _words(vector: Vector) -> str:
    return " ".join(map(repr, vector))
