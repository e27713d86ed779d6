"""BAP, MPEG-4 body animation parameters as text: a table of angles with the standard's own names.

ISO/IEC 14496-2 numbers 186 parameters of the H-Anim joints in 1e-5 rad and mm (ENACTIVE D.RD3.3.1
§2.12). Their names, joints and axes are public in the headers of visage|SDK (BAPs.h, FBAPs.h) and
in Greta (BAPType, JointType), whose files we read: a line of version, name, frames a second and
count of frames, then two lines a frame, which parameters it has and their values.

A parameter that turns against its axis is negated, so that all angles are right-handed; the two
sources differ on the fingers' axes, and visage's are taken. No body is in such a file.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from enpointe.errors import FormatError
from enpointe.files import write_text
from enpointe.motion.formats.columns import number_text
from enpointe.motion.formats.content import Content, Format, Payload
from enpointe.motion.formats.skeleton import Joint, Skeleton, SkeletonMotion
from enpointe.motion.formats.space import Space
from enpointe.motion.formats.text import finite_number, read_text, whole_number

__all__ = ["BAP", "PARAMETERS", "Parameter", "read_bap", "write_bap"]

Array = NDArray[np.float64]
_ANGLE, _LENGTH = 1e-5, 1e-3
_SPACE = Space(metres_per_unit=_LENGTH, up="y", radians_per_unit=_ANGLE)
_LARGEST = 2**31 - 1
_VERSION = "version"
_NAME = "name"


@dataclass(frozen=True, slots=True)
class Parameter:
    """One body animation parameter.

    Attributes:
        name: As the standard has it.
        joint: The H-Anim joint.
        channel: Out of `CHANNELS`.
        sign: -1 where it turns against the channel's axis.
    """

    name: str
    joint: str
    channel: str
    sign: float


_BOTH_SIDES = (
    ("hip", "flexion -X, abduct +Z, twisting -Y"),
    ("knee", "flexion -X, twisting -Y"),
    ("ankle", "flexion -X, twisting -Y"),
    ("subtalar", "flexion +Z"),
    ("midtarsal", "twisting +Z"),
    ("metatarsal", "flexion -X"),
    ("sternoclavicular", "abduct +Z, rotate +Y"),
    ("acromioclavicular", "abduct +Z, rotate +Y"),
    ("shoulder", "flexion -X, abduct +Z, twisting -Y"),
    ("elbow", "flexion -X, twisting -Y"),
    ("wrist", "flexion -Z, pivot -X, twisting -Y"),
)
_SPINE = (
    "skullbase",
    *(f"vc{n}" for n in range(1, 8)),
    *(f"vt{n}" for n in range(1, 13)),
    *(f"vl{n}" for n in range(1, 6)),
)
_KNUCKLE = "flexion -X, pivot +Z, twisting -Y"
_FINGERS = (
    *(
        (f"{finger}{n}", _KNUCKLE if n == 1 else "flexion -X")
        for finger in ("pinky", "ring", "middle", "index")
        for n in range(4)
    ),
    *((f"thumb{n}", _KNUCKLE if n == 1 else "flexion -X") for n in range(1, 4)),
)
_ROOT = "HumanoidRoot"


def _listed() -> Iterator[Parameter]:
    yield from _turns("sacroiliac", "tilt -X, torsion +Y, roll +Z")
    yield from _pairs(_BOTH_SIDES)
    for joint in _SPINE:
        yield from _turns(joint, "roll +Z, torsion +Y, tilt -X")
    yield from _pairs(_FINGERS)
    for name, axis in (("vertical", "Y"), ("lateral", "X"), ("frontal", "Z")):
        yield Parameter(f"{_ROOT}_tr_{name}", _ROOT, f"{axis}position", 1.0)
    for name, axis in (("turn", "Y"), ("roll", "Z"), ("tilt", "X")):
        yield Parameter(f"{_ROOT}_rt_body_{name}", _ROOT, f"{axis}rotation", 1.0)


def _pairs(joints: tuple[tuple[str, str], ...]) -> Iterator[Parameter]:
    for joint, turns in joints:
        sides = (tuple(_turns(f"{side}_{joint}", turns)) for side in "lr")
        for left, right in zip(*sides, strict=True):
            yield left
            yield right


def _turns(joint: str, turns: str) -> Iterator[Parameter]:
    for turn in turns.split(", "):
        name, axis = turn.split()
        yield Parameter(f"{joint}_{name}", joint, f"{axis[1]}rotation", float(f"{axis[0]}1"))


PARAMETERS = tuple(_listed())
"""All 186, in the standard's order."""


def _parents() -> Iterator[tuple[str, str | None]]:
    """The H-Anim joints that have parameters, every parent before its children."""
    yield _ROOT, None
    yield "sacroiliac", _ROOT
    for side in "lr":
        above = "sacroiliac"
        for joint in ("hip", "knee", "ankle", "subtalar", "midtarsal", "metatarsal"):
            yield f"{side}_{joint}", above
            above = f"{side}_{joint}"
    above = _ROOT
    for joint in reversed(_SPINE):
        yield joint, above
        above = joint
    for side in "lr":
        above = "vt1"
        for joint in ("sternoclavicular", "acromioclavicular", "shoulder", "elbow", "wrist"):
            yield f"{side}_{joint}", above
            above = f"{side}_{joint}"
        for joint, _ in _FINGERS:
            first = joint in ("thumb1", "pinky0", "ring0", "middle0", "index0")
            below = f"{joint[:-1]}{int(joint[-1]) - 1}"
            yield f"{side}_{joint}", f"{side}_{'wrist' if first else below}"


def read_bap(path: Path) -> Content:
    """Read a BAP file: the parameters that any frame has are the channels of H-Anim joints.

    A frame without one of them keeps the value before it.

    Raises:
        FormatError: No BAP file, or a frame whose values do not fit its mask.
    """
    lines = read_text(path).split("\n")
    head = lines[0].split()
    if len(head) < 4:
        raise FormatError("the first line must be: version name rate frames", path, line=1)
    rate = finite_number(head[-2], path, 1, "frames a second")
    declared = whole_number(head[-1], path, 1, "the count of frames")
    if rate <= 0:
        raise FormatError(f"frames a second must be above 0, got {rate:g}", path, line=1)
    masks, values, numbers = _frames(lines, path)
    warnings = ["a BAP file has no body: all joints stand at one point"]
    if declared != len(values):
        warnings.append(f"the file says {declared} frames, and there are {len(values)}")
    if (np.diff(numbers) != 1).any():
        warnings.append("frame numbers do not count up by one; the frames are taken in their order")
    present = np.flatnonzero(
        np.any([masks[mask] for mask in dict.fromkeys(m for m, _ in values)], axis=0)
    )
    known = present[present < len(PARAMETERS)]
    table = _held(masks, values, known, warnings)
    lost = (
        [f"{len(present) - len(known)} extension parameters"] if len(present) > len(known) else []
    )
    joints, columns = _joints(known)
    signs = np.array([PARAMETERS[known[column]].sign for column in columns])
    notes = {_VERSION: head[0], _NAME: " ".join(head[1:-2])}
    skeleton = Skeleton(joints, _SPACE)
    motion = SkeletonMotion(skeleton, rate, table[:, columns] * signs, numbers[0], notes)
    return Content(motion, tuple(warnings), tuple(lost))


def write_bap(payload: Payload, path: Path) -> tuple[str, ...]:
    """Write the channels of H-Anim joints that are body animation parameters.

    Returns:
        What a BAP file can't hold.

    Raises:
        FormatError: No skeleton, or none of its channels is a parameter.
    """
    if not isinstance(payload, SkeletonMotion):
        raise FormatError("BAP holds a skeleton's angles, and these are markers", path)
    numbers = {(p.joint, p.channel): i for i, p in enumerate(PARAMETERS)}
    space = payload.skeleton.space
    columns: dict[int, Array] = {}
    lost = []
    for index, joint in enumerate(payload.skeleton.joints):
        values = payload.values[:, payload.skeleton.columns(index)]
        for channel, column in zip(joint.channels, values.T, strict=True):
            number = numbers.get((joint.name, channel)) if joint.plain else None
            if number is None:
                lost.append(f"the channel {joint.name}.{channel}")
                continue
            turning = channel.endswith("rotation")
            size = space.radians_per_unit / _ANGLE if turning else space.metres_per_unit / _LENGTH
            columns[number] = column * size * PARAMETERS[number].sign
    if not columns or not payload.frames:
        raise FormatError("no channel of an H-Anim joint is a body animation parameter", path)
    present = sorted(columns)
    table = np.stack([columns[number] for number in present], axis=1)
    whole = np.rint(table)
    if np.abs(whole).max() > _LARGEST:
        raise FormatError("an angle or a position is too large", path)
    if not np.allclose(whole, table, rtol=0, atol=1e-3):
        lost.append("values are rounded to 1e-5 rad and 1 mm")
    if any(any(joint.offset) for joint in payload.skeleton.joints):
        lost.append("offsets of the joints")
    mask = " ".join("1" if number in columns else "0" for number in range(len(PARAMETERS)))
    name = "_".join(payload.notes.get(_NAME, path.stem).split()) or "motion"
    version = "_".join(payload.notes.get(_VERSION, "2.1").split()) or "2.1"
    lines = [f"{version} {name} {number_text(payload.rate)} {payload.frames}"]
    for index, row in enumerate(whole.astype(int).tolist(), start=payload.start):
        lines += [mask, " ".join(map(str, (index, *row)))]
    write_text(path, "\n".join(lines) + "\n")
    return (*lost, *(f"the note {n!r}" for n in payload.notes if n not in (_VERSION, _NAME)))


def _sniff(start: bytes) -> bool:
    lines = start.split(b"\n", 2)
    if len(lines) < 2 or len(lines[0].split()) < 4:
        return False
    mask = lines[1].split()[: len(PARAMETERS)]
    return len(mask) > 60 and set(mask) <= {b"0", b"1"}


def _frames(
    lines: list[str], path: Path
) -> tuple[dict[str, NDArray[np.bool_]], list[tuple[str, list[int]]], list[int]]:
    """Masks by their text, the mask and values of each frame, and the frames' numbers."""
    masks: dict[str, NDArray[np.bool_]] = {}
    values: list[tuple[str, list[int]]] = []
    numbers: list[int] = []
    mask: str | None = None
    for line, text in enumerate(lines[1:], start=2):
        if not text.strip():
            continue
        if mask is None:
            mask = text
            if mask not in masks:
                masks[mask] = _mask(mask, path, line)
                if len(masks[mask]) != len(next(iter(masks.values()))):
                    raise FormatError("masks of different lengths", path, line=line)
            continue
        tokens = text.split()
        if len(tokens) != 1 + int(masks[mask].sum()):
            raise FormatError(
                f"the mask has {int(masks[mask].sum())} parameters, and the frame "
                f"{len(tokens) - 1} values",
                path,
                line=line,
            )
        row = [_integer(token, path, line) for token in tokens]
        numbers.append(row[0])
        values.append((mask, row[1:]))
        mask = None
    if mask is not None:
        raise FormatError("the last mask has no values", path, line=len(lines))
    if not values:
        raise FormatError("there are no frames", path, line=1)
    return masks, values, numbers


def _mask(text: str, path: Path, line: int) -> NDArray[np.bool_]:
    tokens = text.split()
    if len(tokens) < len(PARAMETERS) or not set(tokens) <= {"0", "1"}:
        raise FormatError(
            f"a mask must be {len(PARAMETERS)} or more of 0 and 1, got {len(tokens)} words",
            path,
            line=line,
        )
    return np.array([token == "1" for token in tokens], dtype=bool)


def _integer(token: str, path: Path, line: int) -> int:
    value = finite_number(token, path, line, "a value")
    if value != int(value) or abs(value) > _LARGEST:
        raise FormatError(f"a value must be whole, got {token[:40]!r}", path, line=line)
    return int(value)


def _held(
    masks: dict[str, NDArray[np.bool_]],
    values: list[tuple[str, list[int]]],
    known: NDArray[np.intp],
    warnings: list[str],
) -> Array:
    """(T, known), a value that a frame lacks as in the frame before it."""
    table = np.zeros((len(values), len(known)))
    places = {}
    for text, mask in masks.items():
        own = mask[known]
        places[text] = own, (np.cumsum(mask) - 1)[known[own]]
    if any(not own.all() for own, _ in places.values()):
        warnings.append("a parameter that a frame lacks keeps its value")
    for index, (text, row) in enumerate(values):
        own, where = places[text]
        if index:
            table[index] = table[index - 1]
        table[index, own] = np.asarray(row, dtype=float)[where]
    return table


def _joints(known: NDArray[np.intp]) -> tuple[tuple[Joint, ...], list[int]]:
    """All joints, with channels for the known parameters, and where each channel stands."""
    channels: dict[str, list[int]] = {}
    for column, number in enumerate(known.tolist()):
        channels.setdefault(PARAMETERS[number].joint, []).append(column)
    names: dict[str, int] = {}
    joints: list[Joint] = []
    columns: list[int] = []
    for name, parent in _parents():
        own = channels.get(name, [])
        columns += own
        names[name] = len(joints)
        told = tuple(PARAMETERS[known[column]].channel for column in own)
        joints.append(Joint(name, -1 if parent is None else names[parent], channels=told))
    return tuple(joints), columns


BAP = Format("BAP", (".bap",), "skeleton", _sniff, read_bap, write_bap)
