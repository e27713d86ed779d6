"""MNM: other names for the segments of a BVH file or the markers of a CSM file.

ENACTIVE D.RD3.3.1 section 2.4; 3ds Max's manual ("matches custom marker names in a CSM or BVH file
with the standard marker names used by a biped"). Each line pairs a name with another, in two
columns or about an equals sign. Sources disagree which column is whose: names are changed from
the column that knows more of a movement's names to the other.
"""

from __future__ import annotations

import re
from collections import Counter
from dataclasses import replace
from pathlib import Path

from enpointe.errors import FormatError
from enpointe.motion.formats.markers import MarkerMotion
from enpointe.motion.formats.skeleton import SkeletonMotion
from enpointe.motion.formats.text import read_text, refuse_merge_marks
from enpointe.motion.formats.writing import write_lines

__all__ = ["read_names", "renamed", "write_names"]

_COLUMNS = re.compile(r"\t+|\s{2,}")


def read_names(path: str | Path) -> dict[str, str]:
    """Reads pairs of names.

    Args:
        path: The MNM file.

    Returns:
        The second column's names by the first's.

    Raises:
        FormatError: A line that is no pair, or a name that is paired twice; with the line.
    """
    path = Path(path)
    names: dict[str, str] = {}
    seconds: set[str] = set()
    for line, content in enumerate(read_text(path).split("\n"), start=1):
        content = content.strip()
        if not content or content.startswith((";", "#", "//")):
            continue
        refuse_merge_marks(content, path, line)
        pair = _pair(content)
        if len(pair) != 2 or not all(pair):
            raise FormatError(f"a pair of names expected, got {content[:40]!r}", path, line=line)
        first, second = pair
        if first in names or second in seconds:
            twice = first if first in names else second
            raise FormatError(f"{twice[:40]!r} for the second time", path, line=line)
        names[first] = second
        seconds.add(second)
    if not names:
        raise FormatError("there are no names", path, line=1)
    return names


def _pair(content: str) -> list[str]:
    if "=" in content:
        return [name.strip().strip('"') for name in content.split("=")]
    columns = [column for column in _COLUMNS.split(content) if column]
    return columns if len(columns) > 1 else content.split()


def write_names(names: dict[str, str], path: str | Path) -> None:
    """Writes pairs of names about equals signs.

    Raises:
        FormatError: A name that a line can't hold.
        EnpointeError: The file can't be written there.
    """
    path = Path(path)
    for name in (*names, *names.values()):
        if not name.strip() or name != name.strip() or set(name) & set("=\n\r"):
            raise FormatError(f"no line can hold the name {name[:40]!r}", path)
    write_lines(path, (f"{first} = {second}" for first, second in names.items()))


def renamed(
    payload: SkeletonMotion | MarkerMotion, names: dict[str, str]
) -> tuple[SkeletonMotion | MarkerMotion, tuple[str, ...]]:
    """A movement whose joints or markers go by other names.

    Args:
        payload: The movement.
        names: Pairs of names, as `read_names` gives them.

    Returns:
        The movement, and one warning a pair of which it has neither name, or both.
    """
    own = payload.skeleton.names if isinstance(payload, SkeletonMotion) else payload.names
    known = set(own)
    other = {second: first for first, second in names.items()}
    if len(known & other.keys()) > len(known & names.keys()):
        names = other
    warnings = tuple(
        f"no {first!r} to call {second!r}" for first, second in names.items() if first not in known
    )
    fresh = [names.get(name, name) for name in own]
    counts = Counter(fresh)
    for index, name in enumerate(own):
        if counts[fresh[index]] > 1 and fresh[index] != name:
            counts[fresh[index]] -= 1
            counts[name] += 1
            warnings += (f"{name!r} keeps its name: another is called {fresh[index]!r}",)
            fresh[index] = name
    if isinstance(payload, SkeletonMotion):
        joints = tuple(
            replace(joint, name=name)
            for joint, name in zip(payload.skeleton.joints, fresh, strict=True)
        )
        return replace(payload, skeleton=replace(payload.skeleton, joints=joints)), warnings
    return replace(payload, names=tuple(fresh)), warnings
