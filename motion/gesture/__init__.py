"""Gesture scenes, positions and forces at the rates of haptic devices, and their GST files."""

from __future__ import annotations

from typing import TYPE_CHECKING

from enpointe.lazy import lazy

if TYPE_CHECKING:
    from enpointe.motion.gesture.encoding import Encoding as Encoding
    from enpointe.motion.gesture.files import read_scene as read_scene
    from enpointe.motion.gesture.files import write_scene as write_scene
    from enpointe.motion.gesture.of_motion import scene_of_motion as scene_of_motion
    from enpointe.motion.gesture.parsing import GestureHead as GestureHead
    from enpointe.motion.gesture.reader import GestureReader as GestureReader
    from enpointe.motion.gesture.scene import Channel as Channel
    from enpointe.motion.gesture.scene import Dimension as Dimension
    from enpointe.motion.gesture.scene import Scene as Scene
    from enpointe.motion.gesture.scene import Track as Track
    from enpointe.motion.gesture.scene import Unit as Unit
    from enpointe.motion.gesture.scene import Variable as Variable
    from enpointe.motion.gesture.scene import merged as merged
    from enpointe.motion.gesture.writer import GestureWriter as GestureWriter

_HOMES = {
    "Channel": "enpointe.motion.gesture.scene",
    "Dimension": "enpointe.motion.gesture.scene",
    "Encoding": "enpointe.motion.gesture.encoding",
    "GestureHead": "enpointe.motion.gesture.parsing",
    "GestureReader": "enpointe.motion.gesture.reader",
    "GestureWriter": "enpointe.motion.gesture.writer",
    "Scene": "enpointe.motion.gesture.scene",
    "Track": "enpointe.motion.gesture.scene",
    "Unit": "enpointe.motion.gesture.scene",
    "Variable": "enpointe.motion.gesture.scene",
    "merged": "enpointe.motion.gesture.scene",
    "read_scene": "enpointe.motion.gesture.files",
    "scene_of_motion": "enpointe.motion.gesture.of_motion",
    "write_scene": "enpointe.motion.gesture.files",
}

__all__ = [
    "Channel",
    "Dimension",
    "Encoding",
    "GestureHead",
    "GestureReader",
    "GestureWriter",
    "Scene",
    "Track",
    "Unit",
    "Variable",
    "merged",
    "read_scene",
    "scene_of_motion",
    "write_scene",
]
__getattr__, __dir__ = lazy(__name__, _HOMES)
