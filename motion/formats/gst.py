"""GST, the gesture file of ENACTIVE D.RD3.3.1 §4.5.4, among the other formats."""

from __future__ import annotations

from pathlib import Path

from enpointe.errors import FormatError, MotionError
from enpointe.motion.formats.content import Content, Format, Payload
from enpointe.motion.formats.markers import MarkerMotion
from enpointe.motion.formats.scenes import scene_of_markers, scene_of_skeleton
from enpointe.motion.formats.skeleton import SkeletonMotion
from enpointe.motion.gesture.files import write_scene
from enpointe.motion.gesture.reader import GestureReader

__all__ = ["GST"]


def _sniff(begin: bytes) -> bool:
    return begin[:4] == b"FORM" and begin[8:12] == b"GST "


def _read(path: Path) -> Content:
    with GestureReader(path) as reader:
        return Content(reader.scene(), reader.warnings, reader.lost)


def _write(motion: Payload, path: Path) -> tuple[str, ...]:
    lost: tuple[str, ...] = ()
    try:
        if isinstance(motion, MarkerMotion):
            motion, lost = scene_of_markers(motion, path.stem)
        elif isinstance(motion, SkeletonMotion):
            motion, lost = scene_of_skeleton(motion, path.stem)
    except MotionError as error:
        raise FormatError(str(error), path) from None
    write_scene(motion, path)
    return lost


GST = Format("GST", (".gst",), "scene", _sniff, _read, _write)
