"""ASF: Acclaim's skeleton, whose movements are in AMC files.

ENACTIVE D.RD3.3.1 section 2.6; J. Lander, "Working with motion capture file formats", Game
Developer, January 1998; the Acclaim documentation kept at the University of Wisconsin. A bone
starts where its parent ends and reaches `length` along `direction`, given in the world at rest. It
turns about axes of its own (`axis`, angles applied x first where it says XYZ) by the angles that
`dof` lists, the first applied first. A length in the file, over `length` of its units, is inches.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from math import isfinite
from pathlib import Path

import numpy as np
from scipy.spatial.transform import Rotation

from enpointe.errors import FormatError
from enpointe.motion.formats.content import Content, Format
from enpointe.motion.formats.skeleton import IDENTITY, Joint, Skeleton, SkeletonMotion
from enpointe.motion.formats.space import DEGREES, Space
from enpointe.motion.formats.text import finite_number, read_text, refuse_merge_marks
from enpointe.motion.formats.units import INCH, stature

__all__ = ["ASF", "BONE", "Figure", "axis_quaternion", "read_figure"]

BONE = "bone "
"""Before a bone's name, the note with its direction, length and axis as the file has them."""

_CHANNELS = {
    **{f"t{axis}": f"{axis.upper()}position" for axis in "xyz"},
    **{f"r{axis}": f"{axis.upper()}rotation" for axis in "xyz"},
}
_ROOT = "root"
_PEOPLE = (0.5, 2.6)


@dataclass
class _Bone:
    name: str
    line: int
    words: dict[str, list[str]] = field(default_factory=dict)
    lines: dict[str, int] = field(default_factory=dict)


@dataclass(frozen=True)
class Figure:
    """What an ASF file holds.

    Attributes:
        skeleton: Its joints, the root's first.
        notes: What else it says, by name.
        warnings: What was doubtful.
        lost: What it holds and the skeleton does not.
    """

    skeleton: Skeleton
    notes: dict[str, str]
    warnings: tuple[str, ...]
    lost: tuple[str, ...]


def _sniff(head: bytes) -> bool:
    words = head.lower()
    return any(key in words for key in (b":bonedata", b":hierarchy")) or (
        b":version" in words and (b":units" in words or b":root" in words)
    )


def _read(path: Path) -> Content:
    found = read_figure(path)
    rest = np.zeros((1, found.skeleton.width))
    motion = SkeletonMotion(found.skeleton, 120.0, rest, notes=found.notes)
    alone = "an ASF file holds no movement: one frame at rest; read the AMC file beside it"
    return Content(motion, (*found.warnings, alone), found.lost)


def read_figure(path: Path) -> Figure:
    """Reads a skeleton.

    Raises:
        FormatError: It is no whole ASF file, with the line.
    """
    return _Reader(path).read(read_text(path))


class _Reader:
    """Takes an ASF file section by section."""

    def __init__(self, path: Path) -> None:
        self.path = path
        self.sections: dict[str, list[tuple[int, str]]] = {}
        self.last = 1
        self.length = 1.0
        self.radians = DEGREES
        self.warnings: list[str] = []
        self.lost: list[str] = []
        self.notes: dict[str, str] = {}

    def read(self, text: str) -> Figure:
        self.split(text)
        for name in (":root", ":bonedata", ":hierarchy"):
            if name not in self.sections:
                raise self.error(f"there is no {name}: is the file whole?", self.last)
        self.units()
        bones = self.bones()
        parents = self.parents(bones)
        joints = (self.root(), *self.joints(bones, parents))
        joints = self.with_ends(joints, bones, parents)
        unit = INCH / self.length
        tall = stature(joints) * unit
        if tall > 0 and not _PEOPLE[0] < tall < _PEOPLE[1]:
            self.warnings.append(
                f"lengths taken as inches / {self.length:g}, by which the figure is {tall:.3g} m"
            )
        skeleton = Skeleton(joints, Space(unit), positions_replace_offset=False)
        return Figure(skeleton, self.notes, tuple(self.warnings), tuple(self.lost))

    def split(self, text: str) -> None:
        name = ""
        for line, content in enumerate(text.split("\n"), start=1):
            stripped = content.strip()
            if stripped.startswith("#"):
                self.lost[:] = ["comments"]
            if not stripped or stripped.startswith("#"):
                continue
            self.last = line
            refuse_merge_marks(stripped, self.path, line)
            if stripped.startswith(":"):
                name, _, rest = stripped.partition(" ")
                name = name.lower()
                if name in self.sections:
                    raise self.error(f"{name} for the second time", line)
                self.sections[name] = [(line, rest.strip())] if rest.strip() else []
            elif not name:
                raise self.error(f"a section such as :version expected: {stripped[:40]!r}", line)
            else:
                self.sections[name].append((line, stripped))
        known = {":units", ":root", ":bonedata", ":hierarchy"}
        for name, lines in self.sections.items():
            if name not in known:
                self.notes[name] = "\n".join(content for _, content in lines)

    def units(self) -> None:
        for line, content in self.sections.get(":units", []):
            words = content.split()
            if len(words) != 2:
                raise self.error(f"a unit and its value expected, got {content[:40]!r}", line)
            key = words[0].lower()
            if key == "length":
                self.length = self.number(words[1], line, "length")
                if not 1e-6 < self.length < 1e6:
                    raise self.error(f"length must be above 0, got {words[1]}", line)
            elif key == "angle":
                if words[1].lower()[:3] not in ("deg", "rad"):
                    raise self.error(f"angle is deg or rad, got {words[1][:40]!r}", line)
                self.radians = DEGREES if words[1].lower().startswith("deg") else 1.0
            self.notes[f":units {key}"] = words[1]

    def root(self) -> Joint:
        order, axis = ["tx", "ty", "tz", "rx", "ry", "rz"], "XYZ"
        place, turn = (0.0, 0.0, 0.0), (0.0, 0.0, 0.0)
        for line, content in self.sections[":root"]:
            key, *words = content.split()
            if key.lower() == "order":
                order = [word.lower() for word in words]
            elif key.lower() == "axis":
                axis = self.letters(words[-1:], line)
            elif key.lower() in ("position", "orientation"):
                three = self.three(words, line, key)
                place, turn = (three, turn) if key.lower() == "position" else (place, three)
            else:
                self.notes[f":root {key}"] = " ".join(words)
            if key.lower() == "order":
                self.channels(order, line)
        channels = self.channels(order, 0)
        return Joint(
            _ROOT,
            -1,
            place,
            channels,
            order=_reversed(channels),
            axis=axis_quaternion(turn, axis, self.radians),
        )

    def bones(self) -> dict[str, _Bone]:
        bones: dict[str, _Bone] = {}
        words: dict[str, list[str]] | None = None
        lines: dict[str, int] = {}
        begun, key = 0, ""
        for line, content in self.sections[":bonedata"]:
            first, *rest = content.split()
            if first.lower() == "begin":
                if words is not None:
                    raise self.error("begin before the bone above has its end", line)
                words, lines, begun, key = {}, {}, line, ""
            elif words is None:
                raise self.error(f"begin expected, got {content[:40]!r}", line)
            elif first.lower() == "end":
                name = " ".join(words.get("name", []))
                if not name or name in bones or name == _ROOT:
                    raise self.error(f"a bone needs a name of its own, got {name[:40]!r}", begun)
                bones[name] = _Bone(name, begun, words, lines)
                words = None
            elif first.startswith("(") and key == "limits":
                words[key] += content.split()
            else:
                key = first.lower()
                if key in words:
                    raise self.error(f"{key} for the second time in a bone", line)
                words[key], lines[key] = rest, line
        if words is not None:
            raise self.error("the file ends within a bone", begun)
        return bones

    def parents(self, bones: dict[str, _Bone]) -> dict[str, str]:
        """Each bone's parent, a parent before its children."""
        children: dict[str, list[tuple[str, int]]] = {}
        parents: dict[str, str] = {}
        for line, content in self.sections[":hierarchy"]:
            words = content.split()
            if len(words) == 1 and words[0].lower() in ("begin", "end"):
                continue
            if words[0] != _ROOT and words[0] not in bones:
                raise self.error(f"no bone is called {words[0][:40]!r}", line)
            for word in words[1:]:
                if word not in bones:
                    raise self.error(f"no bone is called {word[:40]!r}", line)
                if word in parents:
                    raise self.error(f"{word[:40]!r} hangs on two bones", line)
                parents[word] = words[0]
                children.setdefault(words[0], []).append((word, line))
        ordered: dict[str, str] = {}
        waiting = [word for word, _ in children.get(_ROOT, [])][::-1]
        while waiting:
            bone = waiting.pop()
            ordered[bone] = parents[bone]
            waiting += [word for word, _ in children.get(bone, [])][::-1]
        loose = next((bone for bone in bones.values() if bone.name not in ordered), None)
        if loose is not None:
            raise self.error(f"{loose.name[:40]!r} does not hang on the root", loose.line)
        return ordered

    def joints(self, bones: dict[str, _Bone], parents: dict[str, str]) -> list[Joint]:
        places = {_ROOT: 0} | {name: index for index, name in enumerate(parents, start=1)}
        joints = []
        for name, parent in parents.items():
            bone = bones[name]
            self.note_bone(bone)
            offset = (0.0, 0.0, 0.0) if parent == _ROOT else self.reach(bones[parent])
            channels = self.channels(bone.words.get("dof", []), bone.lines.get("dof", 0))
            axis = bone.words.get("axis", ["0", "0", "0", "XYZ"])
            line = bone.lines.get("axis", bone.line)
            turn = self.three(axis[:3], line, "axis")
            letters = self.letters(axis[3:] or ["XYZ"], line)
            joints.append(
                Joint(
                    name,
                    places[parent],
                    offset,
                    channels,
                    order=_reversed(channels),
                    axis=axis_quaternion(turn, letters, self.radians),
                    limits=self.limits(bone, len(bone.words.get("dof", []))),
                )
            )
        return joints

    def with_ends(
        self, joints: tuple[Joint, ...], bones: dict[str, _Bone], parents: dict[str, str]
    ) -> tuple[Joint, ...]:
        """Bones on which none hangs end somewhere too."""
        inner = set(parents.values())
        return tuple(
            Joint(
                joint.name,
                joint.parent,
                joint.offset,
                joint.channels,
                joint.order,
                joint.axis,
                ends=(self.reach(bones[joint.name]),),
                limits=joint.limits,
            )
            if joint.name in bones and joint.name not in inner
            else joint
            for joint in joints
        )

    def reach(self, bone: _Bone) -> tuple[float, float, float]:
        line = bone.lines.get("direction", bone.line)
        x, y, z = self.three(bone.words.get("direction", []), line, "direction")
        words = bone.words.get("length", [])
        line = bone.lines.get("length", bone.line)
        if len(words) != 1:
            raise self.error(f"{bone.name[:40]!r} needs a length", line)
        length = self.number(words[0], line, "length")
        reach = (x * length, y * length, z * length)
        if not all(map(isfinite, reach)):
            raise self.error(f"{bone.name[:40]!r} has no length that a body could have", line)
        return reach

    def note_bone(self, bone: _Bone) -> None:
        self.reach(bone)
        axis = bone.words.get("axis", [])
        words = [*bone.words["direction"], *bone.words["length"], *axis]
        self.notes[f"{BONE}{bone.name}"] = " ".join(words)
        known = {"name", "direction", "length", "axis", "dof", "limits"}
        for key in bone.words.keys() - known:
            self.notes[f"{key} of {bone.name}"] = " ".join(bone.words[key])

    def channels(self, words: list[str], line: int) -> tuple[str, ...]:
        names = []
        for word in words:
            if word.lower() == "l":
                raise self.error("a bone that changes its length (l) is not known here", line)
            if word.lower() not in _CHANNELS:
                raise self.error(f"tx ty tz rx ry rz expected, got {word[:40]!r}", line)
            names.append(_CHANNELS[word.lower()])
        if len(set(names)) < len(names):
            raise self.error(f"a channel twice: {' '.join(words)[:60]}", line)
        return tuple(names)

    def limits(self, bone: _Bone, count: int) -> tuple[tuple[float, float], ...]:
        if "limits" not in bone.words:
            return ()
        line = bone.lines["limits"]
        words = " ".join(bone.words["limits"]).replace("(", " ").replace(")", " ").split()
        if len(words) != 2 * count:
            raise self.error(f"{count} limits (low high) expected, one a dof", line)
        values = [self.limit(word, line) for word in words]
        return tuple(zip(values[0::2], values[1::2], strict=True))

    def limit(self, word: str, line: int) -> float:
        if word.lower().lstrip("+-") == "inf":
            return float(word)
        return self.number(word, line, "a limit")

    def letters(self, words: list[str], line: int) -> str:
        letters = "".join(words).upper()
        if sorted(letters) != ["X", "Y", "Z"]:
            raise self.error(f"an order of axes such as XYZ expected, got {letters[:40]!r}", line)
        return letters

    def three(self, words: list[str], line: int, what: str) -> tuple[float, float, float]:
        if len(words) != 3:
            raise self.error(f"{what} needs 3 numbers, got {len(words)}", line)
        x, y, z = (self.number(word, line, what) for word in words)
        return x, y, z

    def number(self, word: str, line: int, what: str) -> float:
        return finite_number(word, self.path, line, what)

    def error(self, message: str, line: int) -> FormatError:
        return FormatError(message, self.path, line=line)


def _reversed(channels: tuple[str, ...]) -> str:
    """The first angle is applied first, so it is the innermost of the product."""
    return "".join(c[0] for c in channels if c.endswith("rotation"))[::-1]


def axis_quaternion(
    angles: tuple[float, float, float], letters: str, radians: float
) -> tuple[float, float, float, float]:
    """The turn that `axis` or `orientation` says, x first where the letters are XYZ."""
    if angles == (0.0, 0.0, 0.0):
        return IDENTITY
    turns = [radians * angles["XYZ".index(letter)] for letter in letters]
    turn = Rotation.from_euler(letters.lower(), turns)
    w, x, y, z = turn.as_quat(scalar_first=True)
    return float(w), float(x), float(y), float(z)


ASF = Format("ASF", (".asf",), "skeleton", _sniff, _read, None)
