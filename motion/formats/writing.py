"""What writers of text files share: numbers that read back the same, and files whole or not."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from enpointe.errors import FormatError
from enpointe.files import atomic_path
from enpointe.motion.formats.content import Payload
from enpointe.motion.formats.skeleton import Skeleton, SkeletonMotion

__all__ = [
    "END_SITE",
    "hierarchy_lines",
    "number_lines",
    "one_word",
    "skeleton_of",
    "unheld",
    "write_lines",
]


FRAME_TIME = "Frame Time"
"""The note with a frame's time as a file writes it."""

END_SITE = "end site "
"""Before a joint's name and a number, the note with what a file calls an end site."""

# Notes that only keep the digits in which a file writes what the movement has anyway.
_ONLY_DIGITS = ("bone ", "id of ", FRAME_TIME)


def skeleton_of(payload: Payload, path: Path, name: str) -> SkeletonMotion:
    """The payload where it is a skeleton's movement with at least one frame.

    Raises:
        FormatError: It is a set of markers or a scene, or has no frame.
    """
    if not isinstance(payload, SkeletonMotion):
        raise FormatError(f"{name} holds a skeleton's movement, and this is none", path)
    if not payload.frames:
        raise FormatError("there is no frame to write", path)
    return payload


def number_lines(values: NDArray[np.float64], path: Path) -> Iterator[str]:
    """Rows as text, each number in the fewest digits that read back the same.

    Raises:
        FormatError: A number that is not finite, with its frame.
    """
    if not np.isfinite(values).all():
        row = int(np.flatnonzero(~np.isfinite(values).all(axis=1))[0])
        raise FormatError(f"frame {row} (from 0) has a value that is no finite number", path)
    return (" ".join(map(repr, row.tolist())) for row in values)


def write_lines(path: Path, *parts: Iterable[str]) -> None:
    """Writes lines to a file, whole or not at all.

    Raises:
        EnpointeError: The file can't be written there.
    """
    with atomic_path(path) as beside, beside.open("w", encoding="utf-8", newline="\n") as file:
        for part in parts:
            file.writelines(line + "\n" for line in part)


def note_numbers(motion: SkeletonMotion, name: str) -> list[float]:
    """The numbers of a note, or none where it is not there or holds anything else."""
    try:
        numbers = [float(word) for word in motion.notes.get(name, "").split()]
    except ValueError:
        return []
    return numbers if np.isfinite(numbers).all() else []


def frame_time(motion: SkeletonMotion) -> str:
    """Seconds a frame, in the digits of the file where they still are the rate's."""
    written = note_numbers(motion, FRAME_TIME)
    kept = len(written) == 1 and written[0] > 0 and 1 / written[0] == motion.rate
    return motion.notes[FRAME_TIME].strip() if kept else repr(1 / motion.rate)


def one_word(name: str) -> str:
    """A name as a file of words between blanks can hold it."""
    return re.sub(r"[\s{}#]+", "_", name.strip()) or "joint"


def unheld(motion: SkeletonMotion, used: Iterable[str], first: int) -> tuple[str, ...]:
    """What of a movement's notes and counting falls in a format that counts from `first`."""
    lost = []
    if motion.start != first:
        lost.append(f"the number of the first frame, {motion.start}")
    kept = set(used)
    others = [key for key in motion.notes if key not in kept and not key.startswith(_ONLY_DIGITS)]
    if others:
        lost.append(f"notes: {', '.join(others)}")
    return tuple(lost)


def hierarchy_lines(skeleton: Skeleton, names: list[str], notes: dict[str, str]) -> list[str]:
    """The tree of BVH and ASK, without recursion: chains may be long.

    Args:
        skeleton: Joints depth first.
        names: One a joint, in one word each.
        notes: Names of end sites, where they are others than "Site".
    """
    lines = ["HIERARCHY"]
    open_joints: list[int] = []

    def close(until: int) -> None:
        while open_joints and open_joints[-1] != until:
            lines.append("\t" * (len(open_joints) - 1) + "}")
            open_joints.pop()

    for index, joint in enumerate(skeleton.joints):
        close(joint.parent)
        tabs = "\t" * len(open_joints)
        lines += [f"{tabs}{'JOINT' if open_joints else 'ROOT'} {names[index]}", f"{tabs}{{"]
        lines.append(f"{tabs}\tOFFSET {_three(joint.offset)}")
        if joint.channels:
            lines.append(f"{tabs}\tCHANNELS {len(joint.channels)} {' '.join(joint.channels)}")
        for number, end in enumerate(joint.ends):
            name = notes.get(f"{END_SITE}{joint.name} {number}", "Site")
            lines += [f"{tabs}\tEnd {name}", f"{tabs}\t{{", f"{tabs}\t\tOFFSET {_three(end)}"]
            lines.append(f"{tabs}\t}}")
        open_joints.append(index)
    close(-1)
    return lines


def _three(vector: tuple[float, float, float]) -> str:
    return " ".join(repr(value) for value in vector)
