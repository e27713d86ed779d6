"""What a reader gives back, and the interface of a format."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Literal

from enpointe.motion.formats.markers import MarkerMotion
from enpointe.motion.formats.skeleton import SkeletonMotion
from enpointe.motion.gesture.scene import Scene

__all__ = ["Content", "Format", "Kind", "Payload"]

Payload = SkeletonMotion | MarkerMotion | Scene
Kind = Literal["skeleton", "markers", "scene"]


@dataclass(frozen=True)
class Content:
    """A file that was read whole.

    Attributes:
        motion: The movement.
        warnings: What was doubtful and how it was taken, one line each.
        lost: What the file holds and the movement does not, one line each.
    """

    motion: Payload
    warnings: tuple[str, ...] = ()
    lost: tuple[str, ...] = ()


@dataclass(frozen=True)
class Format:
    """One file format.

    Attributes:
        name: Its short name in capitals, "BVH".
        suffixes: Usual endings, with the dot, lower case.
        kind: What it holds.
        sniff: Whether the first 4096 bytes of a file are of this format.
        read: A path to what is in it. Raises FormatError with a line or byte, nothing else.
        write: A movement to a path, beside and renamed; gives back what the format can't hold, one
            line each. Raises FormatError where it can't hold the movement at all. None where there
            is only a reader.
        companion: Ending of the second file that belongs to it (".asf" to ".amc"), or None.
    """

    name: str
    suffixes: tuple[str, ...]
    kind: Kind
    sniff: Callable[[bytes], bool]
    read: Callable[[Path], Content]
    write: Callable[[Payload, Path], tuple[str, ...]] | None
    companion: str | None = None
