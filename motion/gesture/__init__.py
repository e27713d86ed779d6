"""Gesture scenes, positions and forces at the rates of haptic devices, and their GST files."""

from __future__ import annotations

from typing import TYPE_CHECKING

from enpointe.lazy import lazy

if TYPE_CHECKING:
    from enpointe.motion.gesture.scene import Channel as Channel
    from enpointe.motion.gesture.scene import Dimension as Dimension
    from enpointe.motion.gesture.scene import Scene as Scene
    from enpointe.motion.gesture.scene import Track as Track
    from enpointe.motion.gesture.scene import Unit as Unit
    from enpointe.motion.gesture.scene import Variable as Variable
    from enpointe.motion.gesture.scene import merged as merged

_HOMES = {
    name: "enpointe.motion.gesture.scene"
    for name in ("Channel", "Dimension", "Scene", "Track", "Unit", "Variable", "merged")
}

__all__ = ["Channel", "Dimension", "Scene", "Track", "Unit", "Variable", "merged"]
__getattr__, __dir__ = lazy(__name__, _HOMES)
