"""Motions as NPZ files: our own format, which loses nothing."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

import mujoco
import numpy as np
from numpy.typing import NDArray

from enpointe.errors import FormatError, MotionError
from enpointe.files import atomic_path
from enpointe.motion.motion import Event, Motion

__all__ = [
    "is_motion",
    "load_arrays",
    "load_motion",
    "motion_arrays",
    "motion_from_arrays",
    "save_motion",
]

Arrays = Mapping[str, NDArray[np.generic]]
_FORMAT = "enpointe motion 1"


def save_motion(motion: Motion, path: Path) -> None:
    """Write a motion, all but its model, beside and renamed."""
    with atomic_path(path) as beside:
        np.savez_compressed(
            beside, format=np.array(_FORMAT), allow_pickle=False, **motion_arrays(motion)
        )


def load_motion(path: Path, model: mujoco.MjModel) -> Motion:
    """Read what `save_motion` wrote.

    Raises:
        FormatError: Not such a file, or of another body.
    """
    return motion_from_arrays(load_arrays(path, _FORMAT), model, path)


def is_motion(path: Path) -> bool:
    """Whether a file says that it is a motion; what it says else is for its own reader to judge.

    Raises:
        FormatError: There is no such file, or it is no NPZ file.
    """
    return _stated(_opened(path)) == _FORMAT


def motion_arrays(motion: Motion, prefix: str = "") -> dict[str, NDArray[np.generic]]:
    """A motion as named arrays."""
    arrays: dict[str, NDArray[np.generic]] = {
        "time": motion.time,
        "qpos": motion.qpos,
        "qvel": motion.qvel,
        "qacc": motion.qacc,
        "event_time": np.array([e.time for e in motion.events]),
        "event_beat": np.array(
            [np.nan if e.beat is None else e.beat for e in motion.events], dtype=float
        ),
        "event_kind": np.array([e.kind for e in motion.events], dtype=str),
        "event_name": np.array([e.name for e in motion.events], dtype=str),
        "name": np.array(motion.name),
    }
    return {prefix + name: array for name, array in arrays.items()}


def motion_from_arrays(
    arrays: Arrays, model: mujoco.MjModel, path: Path, prefix: str = ""
) -> Motion:
    """The motion in what `motion_arrays` made.

    Raises:
        FormatError: Something is missing, or the motion is another body's.
    """
    try:
        own = {
            name: np.asarray(arrays[prefix + name], dtype=np.float64)
            for name in ("time", "qpos", "qvel", "qacc")
        }
        events = tuple(
            Event(float(t), str(kind), str(name), None if np.isnan(beat) else float(beat))
            for t, kind, name, beat in zip(
                *(arrays[f"{prefix}event_{n}"] for n in ("time", "kind", "name", "beat")),
                strict=True,
            )
        )
        name = str(arrays[prefix + "name"])
    except KeyError as error:
        raise FormatError(f"{error} is missing; the file is damaged or not ours", path) from None
    except (ValueError, TypeError, IndexError) as error:
        raise FormatError(f"parts of the motion do not fit each other ({error})", path) from None
    if own["qpos"].ndim != 2 or own["qpos"].shape[1] != model.nq:
        raise FormatError(
            f"a motion of a body with coordinates {own['qpos'].shape}, not {model.nq}", path
        )
    try:
        return Motion(model, own["time"], own["qpos"], own["qvel"], own["qacc"], events, name)
    except (MotionError, ValueError, TypeError, IndexError) as error:
        raise FormatError(f"not a motion: {error}", path) from None


def load_arrays(path: Path, expected: str) -> dict[str, NDArray[np.generic]]:
    """All arrays of an NPZ file that says it is `expected`.

    Raises:
        FormatError: No NPZ file, or another format or version.
    """
    arrays = _opened(path)
    found = _stated(arrays)
    if found != expected:
        raise FormatError(f"expected {expected!r}, found {found or 'no format'!r}", path)
    return arrays


def _opened(path: Path) -> dict[str, NDArray[np.generic]]:
    where = ""
    try:
        # Opened here, as numpy leaves a file open that it can't read.
        with path.open("rb") as file, np.load(file, allow_pickle=False) as stored:
            arrays = {}
            for where in stored.files:
                arrays[where] = stored[where]
            return arrays
    except FileNotFoundError:
        raise FormatError("there is no such file", path) from None
    except Exception as error:  # numpy and zipfile raise many kinds on damaged files
        what = f"its {where}: {error}" if where else str(error)
        line = " ".join(what.split())
        raise FormatError(f"not an NPZ file that can be read ({line})", path) from None


def _stated(arrays: Arrays) -> str:
    return str(arrays.get("format", ""))
