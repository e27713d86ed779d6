"""The dancer's movements as files: of a motion, of a performance, or keyframes of MuJoCo."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import mujoco

    from enpointe.models import Anthropometry
    from enpointe.motion import Motion

__all__ = ["is_stored", "load_own", "load_stored"]

_ARCHIVE, _HEAD = b"PK\x03\x04", 4096


def is_stored(path: Path) -> bool:
    """Whether a file is of the kinds that hold the dancer's own movements, by its first bytes."""
    head = _head(path)
    return head.startswith(_ARCHIVE) or b"<mujoco" in head


def load_stored(path: Path, dancer: Anthropometry | None = None, *, flesh: bool = False) -> Motion:
    """Reads a movement of the dancer.

    Args:
        path: As `enpointe perform` or `enpointe convert` wrote it.
        dancer: Whose; a dancer of 1.68 m and 54 kg if None.
        flesh: Whether her model has the shapes that are drawn, and not only those that touch.

    Raises:
        FormatError: It can't be read, or is another body's.
    """
    from enpointe.controllers import Recording
    from enpointe.models.dancer import dancer_model
    from enpointe.motion.formats.mjcf import read_keyframes
    from enpointe.motion.npz import is_motion, load_motion

    model = dancer_model(dancer, flesh=flesh)
    if b"<mujoco" in _head(path):
        return read_keyframes(path, model)
    if is_motion(path):
        return load_motion(path, model)
    return Recording.load(path, model).as_motion()


def load_own(path: Path, model: mujoco.MjModel) -> Motion | None:
    """Reads a motion or a recording of another body; None if the file is of none such."""
    from enpointe.controllers import Recording
    from enpointe.errors import FormatError
    from enpointe.motion.npz import is_motion, load_motion

    try:
        if is_motion(path):
            return load_motion(path, model)
        return Recording.load(path, model).as_motion()
    except FormatError:
        return None


def _head(path: Path) -> bytes:
    try:
        with path.open("rb") as file:
            return file.read(_HEAD)
    except (OSError, ValueError):
        return b""
