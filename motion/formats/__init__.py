"""Gesture and motion-capture files: one file a format, one small interface."""

from __future__ import annotations

from enpointe.motion.formats.content import Content, Format
from enpointe.motion.formats.markers import Analog, Label, MarkerMotion
from enpointe.motion.formats.registry import formats, read, write
from enpointe.motion.formats.skeleton import Joint, Skeleton, SkeletonMotion
from enpointe.motion.formats.space import Space

__all__ = [
    "Analog",
    "Content",
    "Format",
    "Joint",
    "Label",
    "MarkerMotion",
    "Skeleton",
    "SkeletonMotion",
    "Space",
    "formats",
    "read",
    "write",
]
