"""What a marker format can hold of a movement, and what it has to leave out."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np

from enpointe.errors import FormatError
from enpointe.motion.formats.content import Payload
from enpointe.motion.formats.markers import MarkerMotion

__all__ = ["left_out", "lost_notes", "markers_of", "plain_names"]


def markers_of(payload: Payload, path: Path, format_name: str) -> MarkerMotion:
    """The movement as markers.

    Raises:
        FormatError: It is a skeleton's or a scene, or has no frame or no marker.
    """
    if not isinstance(payload, MarkerMotion):
        raise FormatError(f"{format_name} holds markers, and this is not a set of them", path)
    if not payload.frames or not payload.names:
        raise FormatError(f"{format_name} needs one frame and one marker at least", path)
    return payload


def left_out(motion: MarkerMotion, *held: str) -> list[str]:
    """A line for each part of a movement that is not among `held`."""
    parts = {
        "orientations": motion.orientations is not None,
        "residuals": motion.residuals is not None,
        "cameras": motion.cameras is not None,
        "analog": motion.analog is not None,
        "labels": bool(motion.labels),
        "gaps": not bool(np.isfinite(motion.positions).all()),
    }
    lines = {
        "orientations": "orientations of the markers",
        "residuals": "residuals of the markers",
        "cameras": "cameras that saw the markers",
        "analog": "analog signals",
        "labels": "events",
        "gaps": "gaps are written as NaN, which few readers of this format know",
    }
    return [lines[part] for part, present in parts.items() if present and part not in held]


def lost_notes(motion: MarkerMotion, *held: str) -> list[str]:
    """A line for each note that is not among `held`."""
    return [f"the note {name!r}" for name in motion.notes if name not in held]


def plain_names(
    names: tuple[str, ...], allowed: Callable[[str], str]
) -> tuple[tuple[str, ...], list[str]]:
    """Names as a format can hold them, and a line for each that had to change."""
    plain = tuple(allowed(name) or "_" for name in names)
    changed = [
        f"the name {old!r} became {new!r}"
        for old, new in zip(names, plain, strict=True)
        if old != new
    ]
    return plain, changed
